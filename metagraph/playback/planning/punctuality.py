"""Which actions meet the moment that a request names, and when an action has to be over for the next one."""

from __future__ import annotations

from collections.abc import Sequence

from metagraph.graph.model import Action
from metagraph.playback.plan import MetaRequest
from metagraph.playback.planning.bounds import Bound, begins
from metagraph.playback.planning.cue_shapes import (
    FITS,
    CueShape,
    hurried,
    lateness,
    may_share,
    meets,
    slack_of,
)
from metagraph.playback.planning.layer_state import LayerState
from metagraph.playback.planning.manner import find_mood, find_tempo, shape_in_mood
from metagraph.playback.planning.mood import drag
from metagraph.playback.planning.routes import may_play
from metagraph.playback.timing.phases import find_phases


def keep_timely(state: LayerState, bound: Bound, fitting: Sequence[Action], now: float) -> list[Action]:
    """Return the candidates that come least late, if that is not too late; among them those that leave
    the following requests the most time and serve the most of them.
    """
    meta = bound.meta
    request = meta.request
    allowed = slack_of(request)
    mood = find_mood(state, request, now)
    late = {
        a.id: lateness(state.project, a, request, shape_in_mood(state, a, request, now, mood))
        for a in fitting
    }
    least = min([late[a.id] for a in fitting])
    if least > allowed + FITS:
        waits = tell_cause(state, request, now)
        state.tell(
            meta,
            "too-late",
            f"would come {least:.2f} s late, {allowed:.2f} s are allowed; it waits for {waits}",
            False,
            least,
        )
        return []
    if least > FITS:
        waits = tell_cause(state, request, now)
        state.tell(meta, "late", f"comes {least:.2f} s late; it waits for {waits}", True, least)
    timely = [a for a in fitting if late[a.id] <= max(least, 0.0) + FITS]
    for other in bound.after:
        if not may_share(request, other.request):
            continue
        both = [a for a in timely if meets(a, other.request)]
        behind = 0.0
        if request.stroke is not None and other.request.stroke is not None:
            behind = max(0.0, request.stroke + max(least, 0.0) - other.request.stroke)
        if len(both) > 0 and other.request.late is not None and behind <= other.request.late + FITS:
            timely = both
            state.served.add(other.key)
            message = f"shares the stroke of '{request.id}'"
            state.tell(other, "shared", message, True, behind, meta.key)
    following = [other for other in bound.after if other.key not in state.served]
    for other in following:
        for slack in (0.0, slack_of(other.request)):
            by = find_latest(state, other.request) + slack
            over = [a for a in timely if find_over(state, a, request, now) <= by]
            if len(over) > 0:
                return over
    return timely


def tell_cause(state: LayerState, request: MetaRequest, now: float) -> str:
    """Return the reason why a request comes late."""
    if now <= request.start + FITS:
        return "its own preparation"
    if len(state.cues) > 0 and state.ready >= now - FITS and state.cues[-1].end >= state.free - FITS:
        return f"'{state.cues[-1].action.name}', which plays until {state.free:.2f} s"
    return "what comes before it" if len(state.cues) > 0 else "the time it became known at"


def find_latest(state: LayerState, request: MetaRequest) -> float:
    """Return the latest time at which a requested action has to begin to be on time; never in
    the past.
    """
    if request.stroke is None:
        return request.start
    least = float("inf")
    for action in state.graph.of(state.stance, request.kind):
        fits = meets(action, request)
        if request.action is not None:
            fits = action.id == request.action
        if not fits or not may_play(state, action):
            continue
        if action.kind != "gesture":  # it has no stroke: it should begin when its request does
            least = min(least, request.stroke - request.start)
        else:
            found = find_phases(state.project, action)
            lead = found.stroke - found.skip(action.timing.blend_in)
            speed = find_tempo(action, find_mood(state, request, request.stroke))
            least = min(least, lead + drag(lead, speed))
    return request.stroke - least


def find_over(state: LayerState, action: Action, request: MetaRequest, now: float) -> float:
    """Return the earliest time at which the next action could begin after this one."""
    shape = shape_in_mood(state, action, request, now, find_mood(state, request, now))
    return shape.start + hurried(state.project, action, shape) + state.project.settings.rest - FITS


def find_until(state: LayerState, action: Action, shape: CueShape, bound: Bound) -> float:
    """Return when an action that should play to its end is left early all the same: early enough for the
    first following request that can then be in time, late enough for its own stroke; infinity for never.
    """
    if len(bound.after) == 0:
        return float("inf")
    rest = state.project.settings.rest
    soonest = shape.start + hurried(state.project, action, shape)
    for other in bound.after:
        in_time = find_latest(state, other.request) + slack_of(other.request)
        if other.key not in state.served and soonest + rest <= in_time + FITS:
            return max(soonest, begins(other) - rest)
    return float("inf")
