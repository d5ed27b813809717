"""What of a cue shows at a time, in plain numbers: `player` and `Cue.clip_seconds` have it for arrays."""

from __future__ import annotations

from metagraph.playback.plan import Cue


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
    if cue.hold <= 0.0:
        return cue.entry + elapsed * cue.tempo
    held = min(max(elapsed - (cue.hold_from - cue.entry) / cue.tempo, 0.0), cue.hold)
    more = (elapsed - held) * (cue.tempo - 1.0)
    return cue.entry + elapsed - held + more + held * ((cue.hold_to - cue.hold_from) / cue.hold)


def ease(x: float) -> float:
    """Return 3 x^2 - 2 x^3 of x within 0..1."""
    x = min(max(x, 0.0), 1.0)
    return x * x * (3.0 - 2.0 * x)
