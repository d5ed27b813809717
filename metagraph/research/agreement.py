"""How far two people who annotated the same recording agree: by time, and annotation by annotation.

By time, each moment has one label of either person, or none. Cohen's kappa (1960) is the share of time in
which both are the same, corrected for what chance gives: (seen - chance) / (1 - chance). Annotation by
annotation, two belong together if their starts and their ends are not farther apart than a tolerance; kappa
is then that of the labels of those that do, and unmatched ones are counted, as Holle and Rein (2015) do.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from metagraph.playback.learning.annotation import (
    Annotation,
    AnnotationInterval,
    AnnotationTier,
    label_of,
    split_tier_names,
)

NOTHING = ""  # the label of a moment at which nothing is annotated
TOLERANCE = 0.25  # seconds that starts, and ends, may lie apart


@dataclass(frozen=True)
class Agreement:
    """What two tiers have in common. seconds: how much time was looked at. same: share of it with one label,
    0..1; kappa: corrected for chance, at most 1, None if chance alone gives all. counts: annotations of
    either. matched: pairs within the tolerance. labels_same: share of those pairs with one label;
    labels_kappa: as kappa. starts, ends: median seconds by which the second is later, None without pairs.
    confusion: (label of the first, of the second) -> seconds, the longest first.
    """

    tiers: tuple[str, str]
    seconds: float
    same: float
    kappa: float | None
    counts: tuple[int, int]
    matched: int
    labels_same: float | None
    labels_kappa: float | None
    starts: float | None
    ends: float | None
    confusion: Mapping[tuple[str, str], float]


def measure_agreement(one: AnnotationTier, other: AnnotationTier, tolerance: float = TOLERANCE) -> Agreement:
    """Return how far two tiers agree, over the time that both lie in. Raises ValueError for a tolerance below
    0 and for tiers without annotations.
    """
    if not 0 <= tolerance < 60:
        raise ValueError("the tolerance is from 0 to 60 seconds")
    if not one.intervals or not other.intervals:
        empty = one if not one.intervals else other
        raise ValueError(f"the tier '{empty.name}' has no annotations")
    times = _share_time(one.intervals, other.intervals)
    pairs = _match(one.intervals, other.intervals, tolerance)
    labels = Counter((label_of(a.text), label_of(b.text)) for a, b in pairs)
    same, kappa = _agree(times)
    labels_same, labels_kappa = _agree(labels) if pairs else (None, None)
    starts, ends = ([getattr(b, end) - getattr(a, end) for a, b in pairs] for end in ("start", "end"))
    return Agreement(
        tiers=(one.name, other.name),
        seconds=float(sum(times.values())),
        same=same,
        kappa=kappa,
        counts=(len(one.intervals), len(other.intervals)),
        matched=len(pairs),
        labels_same=labels_same,
        labels_kappa=labels_kappa,
        starts=float(np.median(starts)) if pairs else None,
        ends=float(np.median(ends)) if pairs else None,
        confusion=dict(sorted(times.items(), key=lambda item: (-item[1], item[0]))),
    )


def match_tiers(
    one: Annotation, other: Annotation | None, chosen: Sequence[tuple[str, str]] = ()
) -> list[tuple[AnnotationTier, AnnotationTier]]:
    """Return the tiers to compare: those chosen by name; else, of two files, those with one name, and of one
    file, those that are called the same but for the annotator. If nothing says who annotated, those with the
    same name before an @ or the last _.

    Raises ValueError for a name that is not there, and where nothing can be paired.
    """
    second = other if other is not None else one
    if chosen:
        return [(_named(one, a), _named(second, b)) for a, b in chosen]
    if other is not None:
        theirs = {tier.name.casefold(): tier for tier in other.tiers}
        pairs = [(t, theirs[t.name.casefold()]) for t in one.tiers if t.name.casefold() in theirs]
    else:
        groups: dict[str, list[AnnotationTier]] = {}
        called = split_tier_names(one)
        told = any(x.annotator and x.stem != name for name, x in called.items())
        for tier in one.tiers:
            base = tier.name.partition("@")[0] if "@" in tier.name else tier.name.rpartition("_")[0]
            base = called[tier.name].stem if told else base
            if base.strip():
                groups.setdefault(base.strip().casefold(), []).append(tier)
        pairs = [(some[0], later) for some in groups.values() for later in some[1:]]
    pairs = [(a, b) for a, b in pairs if a.intervals and b.intervals]
    if not pairs:
        names = ", ".join(f"'{t.name}'" for t in (*one.tiers, *(other.tiers if other else ()))[:12])
        raise ValueError(f"no two tiers belong together; name them with --tiers A=B. There are {names}")
    return pairs


def list_unpaired(
    one: Annotation, other: Annotation | None, pairs: Sequence[tuple[AnnotationTier, AnnotationTier]]
) -> list[str]:
    """Return the names of tiers with annotations that are in none of the pairs."""
    used = {id(tier) for pair in pairs for tier in pair}
    every = (*one.tiers, *(other.tiers if other is not None else ()))
    return [tier.name for tier in every if tier.intervals and id(tier) not in used]


def _named(annotation: Annotation, name: str) -> AnnotationTier:
    for tier in annotation.tiers:
        if tier.name == name:
            return tier
    raise ValueError(
        f"there is no tier '{name}'; there are {', '.join(repr(t.name) for t in annotation.tiers)}"
    )


def _share_time(
    one: Sequence[AnnotationInterval], other: Sequence[AnnotationInterval]
) -> dict[tuple[str, str], float]:
    """Return seconds by both labels, from the first annotation's start to the last one's end."""
    edges = sorted({t for i in (*one, *other) for t in (i.start, i.end)})
    out: dict[tuple[str, str], float] = {}
    labels = [_labels_between(some, edges) for some in (one, other)]
    for begin, end, a, b in zip(edges, edges[1:], *labels, strict=False):
        out[a, b] = out.get((a, b), 0.0) + end - begin
    return out


def _labels_between(some: Sequence[AnnotationInterval], edges: Sequence[float]) -> list[str]:
    """Return the label in each span between two edges; of annotations that overlap, the later one's."""
    out = [NOTHING] * (len(edges) - 1)
    place = {time: n for n, time in enumerate(edges)}
    for interval in sorted(some, key=lambda i: i.start):
        for n in range(place[interval.start], place[interval.end]):
            out[n] = label_of(interval.text)
    return out


def _match(
    one: Sequence[AnnotationInterval], other: Sequence[AnnotationInterval], tolerance: float
) -> list[tuple[AnnotationInterval, AnnotationInterval]]:
    """Return pairs whose starts and ends lie within the tolerance, the nearest first; each is in one pair."""
    near = sorted(
        (max(abs(a.start - b.start), abs(a.end - b.end)), n, m)
        for n, a in enumerate(one)
        for m, b in enumerate(other)
        if abs(a.start - b.start) <= tolerance and abs(a.end - b.end) <= tolerance
    )
    left, right, out = set[int](), set[int](), []
    for _, n, m in near:
        if n not in left and m not in right:
            left.add(n)
            right.add(m)
            out.append((one[n], other[m]))
    return out


def _agree(counts: Mapping[tuple[str, str], float]) -> tuple[float, float | None]:
    """Return the share that is the same, and Cohen's kappa; None if chance alone makes all the same."""
    total = float(sum(counts.values()))
    seen = sum(v for (a, b), v in counts.items() if a == b) / total
    first, second = Counter[str](), Counter[str]()
    for (a, b), value in counts.items():
        first[a] += value  # type: ignore[assignment]
        second[b] += value  # type: ignore[assignment]
    chance = sum(first[label] * second[label] for label in first) / total**2
    return seen, (seen - chance) / (1 - chance) if chance < 1 - 1e-12 else None
