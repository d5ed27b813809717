"""Takes as one row of frames, and random crops of it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor

from metagraph.generation import vae
from metagraph.generation.features import MELS, STRANGEST, as_heard, with_edges
from metagraph.generation.networks import ACTIVITY, Control, FlowSizes, MatchingSizes, Sizes
from metagraph.generation.poses import NUMBERS, Standardisation
from metagraph.generation.takes import Take
from metagraph.generation.training.voices import vary_voices

Array = NDArray[Any]

STILL = 0.01  # standardised, a frame: what is slower counts as this fast
TURNS = 4  # changes of who speaks in a crop at most: more say nothing more
AVERAGED = 3  # frames over which speeds are averaged


class TrainingCorpus:
    """Standardised takes, one after the other. Around each is what is heard and seen before it begins and
    after it ends: silence, and the mean pose. poses: `[N, X]`; heard: `[N, audio + 4]`; speeds: of each joint
    `[N, X / 6]`, logarithms, standardised; first: of each take, the number of its first frame; counts: frames
    of each.
    """

    def __init__(
        self, takes: Sequence[Take], poses: Standardisation, audio: Standardisation, before: int, after: int
    ) -> None:
        rows, heard, speeds, first, counts, at = [], [], [], [], [], 0
        for take in takes:
            count = len(take.poses)
            standard = poses.apply(take.poses)
            rows.append(np.pad(standard, ((before, after), (0, 0))))
            heard.append(as_heard(with_edges(take.features, before, after), audio))
            speeds.append(np.pad(_speeds(standard), ((before, after), (0, 0))))
            first.append(at + before)
            counts.append(count)
            at += before + count + after
        self.poses = torch.from_numpy(np.concatenate(rows))
        self.heard = torch.from_numpy(np.concatenate(heard))
        self.audio = torch.from_numpy(audio.mean), torch.from_numpy(audio.deviation)
        inside = np.concatenate([np.arange(f, f + c) for f, c in zip(first, counts, strict=True)])
        told_speeds = np.concatenate(speeds)
        known = told_speeds[inside]
        spread = (told_speeds - known.mean(0)) / np.maximum(known.std(0), 1e-3)
        self.speeds = torch.from_numpy(spread.astype(np.float32))
        self.first, self.counts = np.array(first), np.array(counts)
        self._crops: dict[tuple[int, float], tuple[Tensor, Tensor]] = {}

    def each(self) -> Iterator[Array]:
        """Yield the poses `[T, X]` of each take."""
        for first, count in zip(self.first, self.counts, strict=True):
            yield self.poses[first : first + count].numpy()

    def starts(self, chance: torch.Generator, count: int, length: int, turns: float = 0.0) -> Tensor:
        """Return numbers of the first frames `[count]` of crops that lie within a take. turns: what a crop in
        which who speaks changes n times weighs, (1 + n)^turns; n is TURNS at most.
        """
        if (length, turns) not in self._crops:
            self._crops[length, turns] = self._weighed(length, turns)
        first, ends = self._crops[length, turns]
        at = torch.rand(count, generator=chance, dtype=torch.float64) * ends[-1]
        return first[torch.searchsorted(ends, at, right=True).clamp(max=len(first) - 1)]

    def _weighed(self, length: int, turns: float) -> tuple[Tensor, Tensor]:
        """Return the first frames of all crops `[N]`, and what they weigh, summed up `[N]`."""
        who = self.heard[:, -ACTIVITY:].argmax(1)
        changes = torch.zeros(len(who) + 1, dtype=torch.float64)
        changes[2:] = torch.cumsum(who[1:] != who[:-1], 0)
        rooms = zip(self.first.tolist(), self.counts.tolist(), strict=True)
        first = torch.cat([torch.arange(f, f + max(0, c - length + 1)) for f, c in rooms])
        often = (changes[first + length] - changes[first + 1]).clamp(max=TURNS)
        return first, torch.cumsum((1 + often) ** turns, 0)

    def rows(self, what: Tensor, starts: Tensor, first: int, last: int) -> Tensor:
        """Return rows first to last, excluded, counted from starts `[B]`: `[B, last - first, ...]`."""
        return what[starts[:, None] + torch.arange(first, last)]

    def hear(self, starts: Tensor, first: int, last: int, voices: float, chance: torch.Generator) -> Tensor:
        """Return what is heard, as `rows`, a share `voices` of the crops as though others spoke elsewhere."""
        rows = self.rows(self.heard, starts, first, last)
        chosen = torch.rand(len(starts), generator=chance) < voices
        if not chosen.any():
            return rows
        numbers = len(self.audio[0]) // MELS * MELS
        mean, deviation = (some[:numbers] for some in self.audio)
        audio = rows[chosen, :, :numbers] * deviation + mean
        count, frames, _ = audio.shape
        tracks = audio.reshape(count, frames, -1, MELS).transpose(1, 2).reshape(-1, frames, MELS)
        tracks = vary_voices(tracks, chance).reshape(count, -1, frames, MELS).transpose(1, 2)
        other = (tracks.reshape(count, frames, numbers) - mean) / deviation
        rows[chosen, :, :numbers] = other.clamp(-STRANGEST, STRANGEST)
        return rows

    def longest_crop(self, wanted: int) -> int:
        """Return how many frames a crop has, so that every take has one."""
        return min(wanted, int(self.counts.min()))


def _speeds(standard: Array) -> Array:
    """Return how fast each joint turns `[T, X / 6]`, natural logarithms. standard: `[T, X]`."""
    steps = np.diff(standard, axis=0, prepend=standard[:1]).reshape(len(standard), -1, NUMBERS)
    fast = np.linalg.norm(steps, axis=-1)
    reach = AVERAGED // 2
    padded = np.pad(fast, ((reach, reach), (0, 0)), "edge")
    even = np.mean([padded[n : n + len(fast)] for n in range(AVERAGED)], 0)
    return np.asarray(np.log(even + STILL))


def count_edge_frames(sizes: Sizes) -> tuple[int, int]:
    """Return how many frames before a crop and after it are looked at."""
    if isinstance(sizes, MatchingSizes):
        return sizes.past * sizes.frames, sizes.ahead * sizes.frames
    control: Control = sizes.control
    past = sizes.before if isinstance(sizes, FlowSizes) else control.past
    return max(control.before, past), control.ahead


def take_stretches(corpus: TrainingCorpus, span: int, most: int = 60000) -> Array:
    """Return rows of `span` frames, flat, from evenly spread places: at most about `most`."""
    out = []
    step = max(1, int(corpus.counts.sum()) // most)
    for rows in corpus.each():
        for shift in range(span):
            out.append(vae.list_spans(rows[shift:], span)[:: max(1, step)])
    return np.concatenate(out)
