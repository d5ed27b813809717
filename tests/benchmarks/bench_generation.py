"""Learned motion: python tests/benchmarks/bench_generation.py [seconds]

How many times faster than they play poses are made by models of each kind and size: of a whole recording
(`whole`, with loudness, features and the clip; then the numbers of poses alone), as the sound comes in, 40 ms
at a time, and live with 5 frames of look-ahead, piece of work by piece. The best of three of the first two.
The weights have learned nothing, which takes as long. One thread.
"""

from __future__ import annotations

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import sys
import time
from collections.abc import Callable
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))

import numpy as np  # noqa: E402

from metagraph.generation.features import compute_conversation_activity, compute_features, count_sound_frames  # noqa: E402
from metagraph.generation.loudness import compute_gain  # noqa: E402
from metagraph.generation.networks import FPS, count_parameters, make_sizes  # noqa: E402
from metagraph.generation.sampler import TakeSampler, generate_recording_poses, sample_whole  # noqa: E402
from tests.generation.makers import babble, conversation, untrained  # noqa: E402

SYSTEMS = (
    ("flow-vae", "small", 1.0),
    ("moglow", "small", 1.0),
    ("cvae", "small", 1.0),
    ("matching", "small", 1.0),
    ("cvae", "paper", 1.0),
    ("flow-vae", "paper", 0.3),
    ("moglow", "paper", 0.03),
)


def main(seconds: float) -> None:
    sound = np.stack([babble(seconds, 1), babble(seconds, 2)])
    told = compute_conversation_activity(conversation(seconds), 0, count_sound_frames(sound.shape[1]))
    began = time.process_time()
    gains = [compute_gain(channel, 16000) for channel in sound]
    measured = time.process_time() - began
    began = time.process_time()
    frames = compute_features(sound, told, gains=gains)
    heard = time.process_time() - began
    print(f"{seconds:g} s: loudness {seconds / measured:.0f} x real time, features {seconds / heard:.0f} x")
    for kind, name, share in SYSTEMS:
        sizes = make_sizes(kind, name)
        model = untrained(kind, 0.0, sizes)
        count = int(share * seconds * FPS)
        size = 640 * count
        speeds = [
            count / FPS / min(spent(run) for _ in range(3))
            for run in (
                lambda model=model, n=count, size=size: sample_whole(model, sound[:, :size], told[:n]),
                lambda model=model, n=count: generate_recording_poses(model, frames[:n]),
            )
        ]
        sampler = TakeSampler(model, gains=gains)
        worst, total, made = 0.0, 0.0, 0
        for n in range(count):
            began = time.process_time()
            made += len(sampler.push(sound[:, n * 640 : (n + 1) * 640], told[n : n + 1]))
            took = time.process_time() - began
            worst, total = max(worst, took), total + took
        live = TakeSampler(model, gains=gains, lookahead=5)
        pieces = []
        for n in range(count):
            live.feed(sound[:, n * 640 : (n + 1) * 640], told[n : n + 1])
            while True:
                began = time.process_time()
                if live.advance() is None:
                    break
                pieces.append(1000 * (time.process_time() - began))
        print(
            f"{kind:9} {name:6} {count_parameters(sizes) / 1e6:7.2f} M  whole {speeds[0]:6.1f} x real time, "
            f"poses {speeds[1]:6.1f} x; pushed {made / FPS / total:6.1f} x, "
            f"{1000 * total / max(made, 1):6.2f} ms a frame, at most {1000 * worst:6.1f} ms a push, "
            f"{sampler.delay} frames late; live piece {np.median(pieces):5.2f} ms, "
            f"95 % {np.quantile(pieces, 0.95):5.2f} ms"
        )


def spent(run: Callable[[], object]) -> float:
    """Seconds of processor time."""
    began = time.process_time()
    run()
    return time.process_time() - began


if __name__ == "__main__":
    main(float(sys.argv[1]) if len(sys.argv) > 1 else 30.0)
