"""How a running action is left early: for a request that can then be in time, or because it was stopped."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from metagraph.playback.plan import MetaAction
from metagraph.playback.planning.bounds import begins
from metagraph.playback.planning.cue_shapes import FITS, RETRACTION, STOPPED, CueShape, hurried, slack_of
from metagraph.playback.planning.layer_state import LayerState
from metagraph.playback.planning.punctuality import find_latest


def make_way(
    state: LayerState, running: MetaAction | None, asked: Sequence[MetaAction], now: float, stopped: bool
) -> None:
    """Leave the running action early for the first request that can then be in time, or if it was
    `stopped`. An action that a model wrote, or that is less important, is left at once; others are left
    where their retraction begins.
    """
    if stopped:
        retract(state, now)
        return
    cue = state.cues[-1]
    if running is None or cue.action.kind == "transition" or cue.end - cue.blend_out <= now:
        return
    at_once = now + max(cue.blend_out, RETRACTION)
    retracts = at_once
    if not running.written:
        once = cue.end - cue.start
        if cue.repeats:
            once = min(once, (cue.cycle_to - cue.entry) / cue.tempo + max(cue.blend_out, RETRACTION))
        shape = CueShape(
            cue.start, cue.entry, cue.end - cue.start, once,
            cue.hold_from, cue.hold_to, cue.hold, cue.tempo,
        )  # fmt: skip
        retracts = max(at_once, cue.start + hurried(state.project, cue.action, shape))
    rest = state.project.settings.rest
    for meta in asked:
        request = meta.request
        in_time = find_latest(state, request) + slack_of(request)
        soonest = at_once if meta.rank > running.rank else retracts
        if request.late is None or meta.rank < running.rank or in_time < soonest + rest - FITS:
            continue
        end = max(soonest, begins(meta) - rest)
        if end < cue.end:
            out = max(cue.blend_out, RETRACTION)
            into = min(cue.blend_in, max(0.0, end - out - cue.start))
            state.cues[-1] = replace(cue, end=end, blend_in=into, blend_out=out)
            state.free = end
            state.ended[cue.action.id] = end
        return


def retract(state: LayerState, now: float) -> None:
    """Leave the running action: it returns to its stance from where it is. A transition ends in the
    stance it leads to.
    """
    cue = state.cues[-1]
    end = now + STOPPED
    if cue.action.kind == "transition" or cue.end - cue.blend_out <= now or cue.end <= end:
        return
    state.cues[-1] = replace(cue, end=end, blend_out=STOPPED)
    state.free = end
    state.ended[cue.action.id] = end
