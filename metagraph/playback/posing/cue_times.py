"""Compute how much of a cue, or of a stance's loop, shows at a time, with plain numbers. `player` and
`Cue.clip_seconds` do the same with arrays.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import floor

from metagraph.graph.model import Project
from metagraph.playback.plan import Cue, Rest

SEAM = 0.4  # clip seconds in which a cue that repeats makes its cycle's ends meet, at most half of the cycle


@dataclass(frozen=True, slots=True)
class LoopSpot:
    """Where a loop is.

    `seconds` is the time in its clip, `other` the time on the other side of its seam. `over` is how far it
    has blended from there to here, 1 if no seam shows. `leaves` and `meets` are the clip seconds at which the
    two sides of the seam begin and end.
    """

    seconds: float
    other: float
    over: float
    leaves: float
    meets: float


def loop_spot(project: Project, rest: Rest, time: float) -> LoopSpot:
    """Return where a stance's loop is at a time, as `layers.compute_loop_seconds` does."""
    action = rest.action
    start, end = project.span(action)
    seam = min(max(0.0, action.timing.blend_in), (end - start) / 2.0)
    period = end - start - seam
    if period <= 0.0:
        return LoopSpot(start, start, 1.0, start, start)
    elapsed = time - rest.start
    phase = max(elapsed, 0.0) if seam > 0.0 else elapsed
    phase = phase - period * floor(phase / period)
    over = phase / seam if seam > 0.0 and elapsed >= period and phase < seam else 1.0
    other = start + min(period + phase, end - start)
    return LoopSpot(start + phase, other, over, start + period, start + seam)


def cue_weight(cue: Cue, time: float) -> float:
    """Return how much of a cue shows at a time, 0..1."""
    if time < cue.start or time >= cue.end:
        return 0.0
    rise = ease((time - cue.start) / cue.blend_in) if cue.blend_in > 0.0 else 1.0
    fall = ease((cue.end - time) / cue.blend_out) if cue.blend_out > 0.0 else 1.0
    return rise * fall


def cue_seconds(cue: Cue, time: float) -> float:
    """Return the second of its clip that a cue plays at a time."""
    elapsed = time - cue.start
    if cue.repeats:
        cycle = cue.cycle_to - cue.cycle_from
        into = cue.entry - cue.cycle_from + elapsed * cue.tempo
        return cue.cycle_from + into - cycle * floor(into / cycle)
    if cue.hold <= 0.0:
        return cue.entry + elapsed * cue.tempo
    held = min(max(elapsed - (cue.hold_from - cue.entry) / cue.tempo, 0.0), cue.hold)
    more = (elapsed - held) * (cue.tempo - 1.0)
    return cue.entry + elapsed - held + more + held * ((cue.hold_to - cue.hold_from) / cue.hold)


def seam_left(cue: Cue, time: float) -> float:
    """Return the share, 0..1, of the offset between the end of one cycle and the beginning of the next that
    is still added at a time, so that a cue that repeats does not jump.
    """
    cycle = cue.cycle_to - cue.cycle_from
    into = cue.entry - cue.cycle_from + (time - cue.start) * cue.tempo
    if not cue.repeats or floor(into / cycle) < 1:
        return 0.0
    return 1.0 - ease((into - cycle * floor(into / cycle)) / min(SEAM, 0.5 * cycle))


def ease(x: float) -> float:
    """Return 3 x^2 - 2 x^3 of x clamped to 0..1."""
    x = min(max(x, 0.0), 1.0)
    return x * x * (3.0 - 2.0 * x)
