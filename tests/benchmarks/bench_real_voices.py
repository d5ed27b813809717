"""Recordings of people, and a model: python tests/benchmarks/bench_real_voices.py MODEL FOLDER [options]

Each sound in FOLDER is a recording: of one person, or of two who have a channel each; a transcript of the
same name is read with it. Who says what when is read as for any user's recording, and the driver performs it
on the sample project's graph. Printed for each who speaks:

    peaks      hand speed within 0.25 s of the speaker's own stresses, over its mean; `chance` is that of the
               same stresses moved in time, round the end: its 95th percentile over 200 of them
    loud       the same at loud moments, which the product has no part in finding: maxima of loudness over
               0.7 s, among the louder half of them
    speaking   hand speed while this side speaks, over that while it does not
    nods       how fast the head nods within 1 s after own responses, over its mean; with their number
    rate       stretches in which a hand is more than 0.15 m above its usual height, a minute
    speed      mean hand speed, m/s

What a name has before its first hyphen, `en` of `en-allison.wav`, is its language; `all` is the mean of a
language's recordings, weighed by their length.

options: --seeds 3; --ahead FRAMES of sound, all unless given; --unmarked, the model hears the sound alone, as
live; --no-driver; --json FILE.

python tests/benchmarks/bench_real_voices.py --join OUT.wav FOLDER [FOLDER] [--seconds 75] [--skip 0]
makes a recording of short ones: the sounds of one person, in an order that is always the same, with pauses;
or of two who talk by turns, where the second one's shortest sounds are responses while the first one talks.
"""

from __future__ import annotations

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import argparse
import json
import sys
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))

import numpy as np  # noqa: E402
from msgspec.structs import replace as changed  # noqa: E402
from numpy.typing import NDArray  # noqa: E402

from app.cli.command_output import open_for_command  # noqa: E402
from metagraph.formats.conversations.files import SOUNDS, read_conversation  # noqa: E402
from metagraph.formats.transcripts.registry import TRANSCRIPT_SUFFIXES  # noqa: E402
from metagraph.generation.features import (  # noqa: E402
    RATE,
    compute_features,
    count_sound_frames,
    resample_for_features,
    tell_conversation,
)
from metagraph.generation.landmarks import WRISTS  # noqa: E402
from metagraph.generation.networks import ACTIVITY, FPS  # noqa: E402
from metagraph.generation.performing import read_side_sound  # noqa: E402
from metagraph.generation.poses import encode_clip  # noqa: E402
from metagraph.generation.sampler import generate_recording_poses  # noqa: E402
from metagraph.generation.statistics import NEAR, MotionSample, compute_measures, make_motion_sample  # noqa: E402
from metagraph.generation.stored import read_model  # noqa: E402
from metagraph.generation.takes import Take, TakeSource, _marks  # noqa: E402
from metagraph.graph.conversation.model import Conversation  # noqa: E402
from metagraph.research.generation.planted import perform_planted  # noqa: E402
from metagraph.speech.sound import read_recording  # noqa: E402

Array = NDArray[Any]

SHOWN = ("peaks", "chance", "loud", "loud chance", "speaking", "nods", "rate", "speed")
RAISED, SHIFTS = 0.15, 200


def measure_hands(motion: MotionSample, loud: Array, of: Array) -> dict[str, float]:
    """Return the measures of a motion. loud: seconds; of: chance of its own for the shifts."""
    hands = motion.landmarks[:, list(WRISTS)]
    speed = np.linalg.norm(np.diff(hands, axis=0), axis=-1).mean(1) * FPS
    at = (np.arange(len(speed)) + 0.5) / FPS
    mean = float(speed.mean())
    out = {"speed": mean}
    for name, moments in (("peaks", np.asarray(motion.marks.peaks)), ("loud", loud)):
        found = [
            float(speed[(np.abs(at[:, None] - (moments + shift) % at[-1]) < NEAR).any(1)].mean()) / mean
            for shift in (0.0, *of * at[-1])
        ]
        out[name] = found[0]
        out["chance" if name == "peaks" else "loud chance"] = float(np.nanpercentile(found[1:], 95))
    own = motion.activity[1:, (0, 2)].sum(1) > 0.5
    out["speaking"] = float(speed[own].mean() / speed[~own].mean()) if own.any() and not own.all() else np.nan
    height = hands[..., 1]
    up = (height > np.median(height, 0) + RAISED).any(1)
    out["rate"] = float((up[1:] & ~up[:-1]).sum()) / (len(up) / FPS) * 60
    return out


def find_loud_moments(samples: Array) -> Array:
    """Return seconds of the loud moments of a voice `[N]`."""
    hop = RATE // 100
    rows = samples[: len(samples) // hop * hop].reshape(-1, hop)
    level = 10 * np.log10(np.convolve((rows**2).mean(1), np.ones(9) / 9, "same") + 1e-9)
    around = np.lib.stride_tricks.sliding_window_view(np.pad(level, 35, constant_values=-99), 71).max(1)
    tops = np.flatnonzero((level == around) & (level > np.percentile(level, 60)))
    return np.asarray(tops[level[tops] >= np.median(level[tops])] / 100 + hop / 2 / RATE)


def read_sides(path: Path) -> tuple[Conversation, list[int]]:
    """Return a recording as a conversation, and the sides that speak."""
    beside = sorted(p for p in path.parent.glob(f"{path.stem}.*") if p.suffix.lower() in TRANSCRIPT_SUFFIXES)
    read = read_conversation([path], beside[:1], path.parent).conversation
    return changed(read, seed=1), [n for n, s in enumerate(read.sides) if s.segments]


def measure_all(options: argparse.Namespace) -> None:
    model = read_model(options.paths[0])
    opened = open_for_command(ROOT / "sample_clips" / "sample.metagraph.yaml")
    project = getattr(opened, "project", opened)
    rows: dict[str, list[tuple[str, float, dict[str, float]]]] = {}
    print(f"{options.paths[0].name}: {options.seeds} seeds")
    print(f"{'':34}" + "".join(f"{name:>12}" for name in ("seconds", "stresses", *SHOWN)))

    def show(name: str, seconds: float, count: float, told: dict[str, float]) -> None:
        numbers = "".join(f"{told.get(s, np.nan):12.2f}" for s in SHOWN)
        print(f"{name:34}{seconds:12.0f}{count:12.0f}{numbers}", flush=True)

    sounds = sorted(p for p in options.paths[1].iterdir() if p.suffix.lower() in SOUNDS)
    for path in sounds:
        talk, speaking = read_sides(path)
        for side in speaking:
            samples, _ = read_side_sound(talk, side, path.parent)
            told = tell_conversation(talk, side, count_sound_frames(samples.shape[1]))
            heard = compute_features(samples, told[:, -ACTIVITY:] if options.unmarked else told)
            marks = _marks(talk, side)
            if not marks.peaks:
                continue
            loud = find_loud_moments(samples[0])
            clip = perform_planted(project, talk, side)
            count = min(len(heard), len(encode_clip(model.rig, clip, FPS)))
            driven = Take(
                TakeSource(path.stem), encode_clip(model.rig, clip, FPS)[:count], heard[:count], marks
            )
            seen = make_motion_sample(model.rig, driven.poses, driven)
            shifts = np.random.default_rng(0).uniform(0.02, 0.98, SHIFTS)
            found = []
            for seed in range(1, options.seeds + 1):
                poses = generate_recording_poses(model, heard, seed, take=side, lookahead=options.ahead)[
                    :count
                ]
                made = make_motion_sample(model.rig, poses, driven)
                nods = compute_measures([made], [seen])["nods_responses"]
                found.append({**measure_hands(made, loud, shifts), "nods": nods})
            name = f"{path.stem} {side + 1}" if len(speaking) > 1 else path.stem
            mean = {s: float(np.nanmean([f[s] for f in found])) for s in found[0]}
            seconds = count / FPS
            show(name, seconds, len(marks.peaks), mean)
            rows.setdefault(path.stem.partition("-")[0], []).append(("model", seconds, mean))
            if options.driver:
                nods = compute_measures([seen], [seen])["nods_responses"]
                driver = {**measure_hands(seen, loud, shifts), "nods": nods}
                show("    driver", seconds, len(marks.responses), driver)
                rows[path.stem.partition("-")[0]].append(("driver", seconds, driver))
    for language, of in rows.items():
        for who in ("model", "driver"):
            some = [(s, t) for w, s, t in of if w == who]
            if some:
                total = sum(s for s, _ in some)
                told = {}
                for key in SHOWN:
                    known = [(s, t[key]) for s, t in some if np.isfinite(t.get(key, np.nan))]
                    told[key] = sum(s * v for s, v in known) / sum(s for s, _ in known) if known else np.nan
                show(f"{language}, all, {who}", total, len(some), told)
    if options.json is not None:
        options.json.write_text(json.dumps(rows))


def join_recordings(options: argparse.Namespace) -> None:
    """Write a recording that is joined of short ones."""
    import soundfile

    out, *folders = options.paths
    chance = np.random.default_rng(3)
    voices = []
    for folder in folders:
        sounds = [p for p in sorted(folder.rglob("*")) if p.suffix.lower() in SOUNDS]
        recordings = [read_recording(p) for p in sounds]
        read = [resample_for_features(r.samples.mean(0)[None], r.rate)[0] for r in recordings]
        voices.append([trim_silence(r) for r in read if np.abs(r).max() > 0.05])
    long = [[r for r in v if 1.2 * RATE < len(r) < 12 * RATE] or v for v in voices]
    short = [r for r in voices[-1] if 0.25 * RATE < len(r) < 0.55 * RATE]
    rows = np.zeros((len(voices), round((options.seconds + 30) * RATE)), np.float32)
    at, who, after = round(0.5 * RATE), 0, [options.skip] * len(voices)
    while at < options.seconds * RATE:
        for _ in range(int(chance.integers(2, 5)) if len(voices) > 1 else 1):
            piece = long[who][after[who] % len(long[who])]
            after[who] += 1
            rows[who, at : at + len(piece)] = piece
            if len(voices) > 1 and who == 0 and short and len(piece) > 2.5 * RATE and chance.random() < 0.6:
                answer = short[int(chance.integers(len(short)))]
                begin = at + len(piece) // 2
                rows[1, begin : begin + len(answer)] = answer
            at += len(piece) + round(chance.uniform(0.25, 0.9) * RATE)
        who = (who + 1) % len(voices)
    soundfile.write(out, rows[:, :at].T, RATE, subtype="PCM_16")
    print(f"{out}: {at / RATE:.0f} s")


def trim_silence(samples: Array) -> Array:
    """Return samples without the silence before and after, brought to one loudness."""
    loud = np.flatnonzero(np.abs(samples) > 0.03 * np.abs(samples).max())
    cut = samples[loud[0] : loud[-1] + 1]
    return np.asarray(cut * (0.08 / max(float(np.sqrt((cut**2).mean())), 1e-4)), np.float32)


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("paths", type=Path, nargs="+")
    parser.add_argument("--join", action="store_true")
    parser.add_argument("--seconds", type=float, default=75.0)
    parser.add_argument("--skip", type=int, default=0)
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("--ahead", type=int)
    parser.add_argument("--unmarked", action="store_true")
    parser.add_argument("--no-driver", dest="driver", action="store_false")
    parser.add_argument("--json", type=Path)
    asked = parser.parse_args()
    join_recordings(asked) if asked.join else measure_all(asked)
