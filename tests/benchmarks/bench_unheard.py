"""Models and sounds they were not learned from:
python tests/benchmarks/bench_unheard.py MODEL FOLDER [takes] [--unmarked]

FOLDER holds planted takes. Of those that MODEL has not learned from the sound is made otherwise - another
voice, a telephone, noise, a room, the partner in one's own microphone, the channels' loudness - and the
model's motion is measured beside the recorded motion, which stays the same. `deaf` hears silence and is told
who speaks: what remains then was not learned from the sound. Stresses, responses and hesitations are those
that were found in the sound as it was; with --unmarked the model does not know them.
"""

from __future__ import annotations

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))

import numpy as np  # noqa: E402
from numpy.typing import NDArray  # noqa: E402

from metagraph.generation.features import RATE, TOLD, compute_features  # noqa: E402
from metagraph.generation.statistics import compute_measures, make_motion_sample, mismatch_speech  # noqa: E402
from metagraph.generation.stored import read_model  # noqa: E402
from metagraph.generation.take_files import find_takes, read_speech, read_take_batch  # noqa: E402
from metagraph.research.generation.evaluation import SamplingManner, find_unseen_takes, generate_poses  # noqa: E402

Array = NDArray[Any]

SHOWN = ("speed", "acceleration", "role", "stroke", "nods_responses", "nods_hesitations", "profile")
SIZE = 1024


def pieces(change: Callable[[Array], Array]) -> Callable[[Array], Array]:
    """Return what changes a sound `[N]` by its spectra `[n, SIZE // 2 + 1]`, a hop of a quarter."""

    def changed(sound: Array) -> Array:
        hop, window = SIZE // 4, np.hanning(SIZE)
        padded = np.pad(sound, SIZE)
        cut = np.lib.stride_tricks.sliding_window_view(padded, SIZE)[::hop] * window
        back = np.fft.irfft(change(np.fft.rfft(cut, axis=1)), SIZE, axis=1) * window
        out = np.zeros(len(padded))
        for n, piece in enumerate(back):
            out[n * hop : n * hop + SIZE] += piece
        return np.asarray(out[SIZE:-SIZE] / 1.5, np.float32)

    return changed


def shifted(factor: float) -> Callable[[Array], Array]:
    """Return another voice: all frequencies `factor` times as high."""

    def change(spectra: Array) -> Array:
        at = np.arange(spectra.shape[1]) / factor
        low = np.minimum(at.astype(int), spectra.shape[1] - 1)
        return np.where(at < spectra.shape[1] - 1, spectra[:, low], 0)

    return pieces(change)


def band(low: float, high: float) -> Callable[[Array], Array]:
    """Return what a line lets through, hertz."""
    hertz = np.fft.rfftfreq(SIZE, 1 / RATE)
    return pieces(lambda spectra: spectra * ((hertz > low) & (hertz < high)))


def noisy(decibels: float) -> Callable[[Array], Array]:
    """Return the sound with noise so far below its own level."""

    def changed(sound: Array) -> Array:
        loud = np.sqrt(np.mean(sound[np.abs(sound) > 1e-3] ** 2)) if np.any(np.abs(sound) > 1e-3) else 0
        noise = np.random.default_rng(1).standard_normal(len(sound))
        return np.asarray(sound + loud * 10 ** (-decibels / 20) * noise, np.float32)

    return changed


def room(sound: Array) -> Array:
    """Return the sound in a room that takes half a second to fall silent."""
    t = np.arange(RATE // 2) / RATE
    tail = np.random.default_rng(2).standard_normal(len(t)) * np.exp(-13.8 * t) * 0.08
    tail[0] = 1.0
    size = 1 << (len(sound) + len(tail)).bit_length()
    out = np.fft.irfft(np.fft.rfft(sound, size) * np.fft.rfft(tail, size), size)
    return np.asarray(out[: len(sound)], np.float32)


def each(change: Callable[[Array], Array]) -> Callable[[Array], Array]:
    return lambda samples: np.stack([change(channel) for channel in samples])


HEARD: dict[str, Callable[[Array], Array]] = {
    "as recorded": lambda s: s,
    "voices a fifth higher": each(shifted(1.2)),
    "voices a fifth lower": each(shifted(0.8)),
    "telephone": each(band(300, 3400)),
    "noise at -15 dB": each(noisy(15)),
    "a room": each(room),
    "partner in own microphone": lambda s: s + 0.1 * s[::-1],
    "own voice at -20 dB": lambda s: s * np.array([[0.1], [1.0]], np.float32),
    "deaf": lambda s: np.zeros_like(s),
}


def main(path: Path, folder: Path, count: int, marked: bool = True) -> None:
    model = read_model(path)
    files, _ = find_takes([folder])
    held = {t.name for t in model.card.held_out}
    files = [f for f in files if f.clip.stem in held][:count] or files[:count]
    batch = read_take_batch(files, model.rig, tracks=model.card.tracks)
    takes, _ = find_unseen_takes(model, batch.takes)
    by_name = {f.clip.stem: f for f in files}
    true = [make_motion_sample(model.rig, t.poses, t) for t in takes]
    print(f"{path.name}: {len(takes)} takes, {sum(t.seconds for t in takes) / 60:.1f} min")
    print(f"{'':28}" + "".join(f"{name.replace('nods_', '')[:10]:>12}" for name in SHOWN))

    def show(name: str, values: dict[str, float]) -> None:
        print(f"{name:28}" + "".join(f"{values[s]:12.2f}" for s in SHOWN), flush=True)

    show("recorded motion", compute_measures(true, true))
    show("motion to other speech", compute_measures(mismatch_speech(true), true))
    for name, change in HEARD.items():
        made = []
        for n, take in enumerate(takes):
            samples = change(read_speech(by_name[take.source.name]).samples)
            sound = compute_features(samples, np.zeros((0, 4)), model.card.tracks)[: len(take.features)]
            told = take.features[:, -TOLD:].copy()
            told[:, :-4] *= marked
            heard = replace(take, features=np.concatenate([sound[:, :-TOLD], told], 1))
            poses = generate_poses(model, heard.features, 1, n, SamplingManner(seeds=1))
            made.append(make_motion_sample(model.rig, poses, take))
        show(name, compute_measures(made, true))


if __name__ == "__main__":
    words = [w for w in sys.argv[1:] if w != "--unmarked"]
    most = int(words[2]) if len(words) > 2 else 4
    main(Path(words[0]), Path(words[1]), most, "--unmarked" not in sys.argv)
