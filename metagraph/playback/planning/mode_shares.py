"""What of a model is performed while one idles, listens and talks, learned from an annotation that has
speech.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import replace
from statistics import fmean

from metagraph.graph.model import Markov, Mode
from metagraph.graph.words import MODES
from metagraph.playback.learning.learn import LEAST_GAP, Act
from metagraph.playback.planning.markov import DEFAULTS, KINDS

Span = tuple[float, float]

PAUSE = 0.6  # seconds of one's own silence in which one still talks
QUIET = 2.0  # seconds after the other has spoken in which one still listens
LEAST = 10.0  # seconds in a mode below which nothing is learned of it


def find_mode_spans(own: Sequence[Span], partner: Sequence[Span], end: float) -> list[tuple[float, Mode]]:
    """Return from when on somebody idles, listens or talks, by when the two speak; from 0 to end seconds."""
    mine = [(a, b + PAUSE) for a, b in own]
    others = [(a, b + QUIET) for a, b in partner]
    edges = sorted({0.0, *(x for a, b in (*mine, *others) for x in (a, b) if 0 < x < end)})
    out: list[tuple[float, Mode]] = []
    for at in edges:
        talks = any(a <= at < b for a, b in mine)
        mode: Mode = "talking" if talks else "listening" if any(a <= at < b for a, b in others) else "idle"
        if not out or out[-1][1] != mode:
            out.append((at, mode))
    return out


def with_modes(
    model: Markov, observed: Sequence[Act], own: Sequence[Span], partner: Sequence[Span], end: float
) -> Markov:
    """Return a model that was learned from acts with what is performed of it in each mode: it writes as often
    as each kind was seen in the mode in which it was seen most, and of that so much is performed as was seen.
    Of modes seen for less than `LEAST` seconds it has the layer's default. Without speech it stays as it is.
    """
    if not own or not observed or end <= 0:
        return model
    spans = find_mode_spans(own, partner, end)
    ends = [at for at, _ in spans[1:]] + [end]
    seconds: Counter[Mode] = Counter()
    for (at, mode), until in zip(spans, ends, strict=True):
        seconds[mode] += until - at  # type: ignore[assignment]
    counts: Counter[tuple[Mode, str]] = Counter()
    for act in observed:
        mode = next((m for at, m in reversed(spans) if at <= act.start), spans[0][1])
        counts[mode, act.kind] += 1
    overall = {k: sum(counts[m, k] for m in MODES) / end for k in KINDS}
    known = [m for m in MODES if seconds[m] >= LEAST]
    rates = {(m, k): counts[m, k] / seconds[m] for m in known for k in KINDS}
    most = {k: max((rates[m, k] for m in known), default=overall[k]) for k in KINDS}
    faster = max((most[k] / overall[k] for k in KINDS if overall[k] > 0), default=1.0)
    length = fmean(act.length for act in observed)
    gap = max(LEAST_GAP, (model.gap + length) / faster - length)
    reached = (model.gap + length) / (gap + length)  # where acts follow each other without rest, no more
    usual = dict(zip(MODES, DEFAULTS[model.layer].modes, strict=True))
    rows = tuple(
        tuple(
            min(1.0, round(rates[m, k] / (overall[k] * reached), 4)) if overall[k] > 0 else 1.0 for k in KINDS
        )
        if m in known
        else usual[m]
        for m in MODES
    )
    return replace(model, gap=round(gap, 4), modes=rows)
