"""Find the goals that contacts set for the hands at a time: contacts of the cue that plays and of the loops
under it, each weighted by how much of it shows.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import floor

from metagraph.graph.model import Action, Project
from metagraph.motion.contact_solve import ContactRig, HandGoal
from metagraph.motion.contact_spans import HANDS, ContactSpan, contact_key, contact_weight
from metagraph.playback.plan import Cue, LayerPlan, Rest
from metagraph.playback.posing.cue_times import cue_seconds, cue_weight, ease, seam_left

LEAST = 1e-6  # of a hand: goals with less weight are not solved


def layer_goals(
    rig: ContactRig,
    project: Project,
    plan: LayerPlan,
    cue: Cue | None,
    place: int,
    time: float,
    strength: float,
) -> list[HandGoal]:
    """Return a layer's goals for the hands at a time.

    `cue` is the one that plays, if it has motion. `place` is the index of the rest in force, -1 for none.
    `strength` is how much of the arms the layer moves, 0..1.
    """
    out: list[HandGoal] = []
    shown = [0.0, 0.0]
    if cue is not None:
        weight = cue_weight(cue, time)
        for arm, hand in enumerate(HANDS):
            if _moves(rig, cue.action, arm, hand):
                shown[arm] = weight
        if len(cue.action.contacts) > 0:
            left = seam_left(cue, time)
            if left > 0.0:  # the goals at the end of the previous cycle, as far as its pose still shows
                out += _goals(rig, project, cue.action, cue.cycle_to, [strength * left * w for w in shown])
            share = strength * (1.0 - left)
            out += _goals(rig, project, cue.action, cue_seconds(cue, time), [share * w for w in shown])
    if place >= 0:
        rest = plan.rests[place]
        over = 1.0
        if place > 0 and rest.fade_start + rest.fade > time:
            over = ease((time - rest.fade_start) / rest.fade)
            out += _loop_goals(rig, project, plan.rests[place - 1], time, strength * (1.0 - over), shown)
        out += _loop_goals(rig, project, rest, time, strength * over, shown)
    return out


def _loop_goals(
    rig: ContactRig,
    project: Project,
    rest: Rest,
    time: float,
    strength: float,
    shown: Sequence[float],
) -> list[HandGoal]:
    """Return a loop's goals for the hands, reduced by the cue above it."""
    out: list[HandGoal] = []
    action = rest.action
    if len(action.contacts) == 0:
        return out
    left = [strength * (1.0 - w) for w in shown]
    start, end = project.span(action)
    seam = min(max(0.0, action.timing.blend_in), (end - start) / 2.0)
    period = end - start - seam
    if period <= 0.0:
        return _goals(rig, project, action, start, left)
    elapsed = time - rest.start
    phase = max(elapsed, 0.0) if seam > 0.0 else elapsed
    phase = phase - period * floor(phase / period)
    old = 0.0
    if seam > 0.0 and elapsed >= period:
        old = 1.0 - ease(phase / seam)
    if old > 0.0:
        before = start + min(period + phase, end - start)
        out += _goals(rig, project, action, before, [old * w for w in left])
    out += _goals(rig, project, action, start + phase, [(1.0 - old) * w for w in left])
    return out


def _goals(
    rig: ContactRig, project: Project, action: Action, seconds: float, shares: Sequence[float]
) -> list[HandGoal]:
    """Return the goals of an action at a second of its clip. `shares` says how much of it shows at the left
    and the right hand.
    """
    out: list[HandGoal] = []
    start, end = project.span(action)
    for span in action.contacts:
        arm = _arm(span)
        to = rig.places.get(span.to)
        if to is None or len(span.keys) == 0 or shares[arm] <= LEAST:
            continue
        weight = shares[arm] * contact_weight(span, seconds, start, end)
        if weight > LEAST:
            key = contact_key(span, seconds)
            out.append(HandGoal(arm, to, key.at, key.turn, weight))
    return out


def _arm(span: ContactSpan) -> int:
    return 0 if span.hand == "left" else 1


def _moves(rig: ContactRig, action: Action, arm: int, hand: str) -> bool:
    """Return whether an action moves a hand, instead of leaving it in the stance."""
    if action.limb not in ("both", hand):
        return False
    return len(action.joints) == 0 or rig.hands[arm] in action.joints
