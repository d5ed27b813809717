"""From a meta plan to specific actions: candidates, the three temporal cases, cues and rests (Borer et al.,
section 6.2).
"""

from __future__ import annotations

from collections.abc import Sequence

from metagraph.graph.model import Action, MetaGraph, Project
from metagraph.graph.repeating import cycle_of
from metagraph.playback.life.track import Track
from metagraph.playback.plan import Cue, MetaAction, MetaRequest, Past, Rest
from metagraph.playback.planning.bounds import Bound, begins, bounds
from metagraph.playback.planning.cue_shapes import FITS, RETRACTION, CueShape, fits_before, remaining
from metagraph.playback.planning.directing import (
    may_begin,
    performs_written,
)
from metagraph.playback.planning.director import beat_interval
from metagraph.playback.planning.drawing import draw_action, find_cooled
from metagraph.playback.planning.hashing import Bits
from metagraph.playback.planning.layer_state import LayerState
from metagraph.playback.planning.manner import find_extent, find_mood, shape_in_mood
from metagraph.playback.planning.mood import Mood, Moods
from metagraph.playback.planning.punctuality import find_until, keep_timely
from metagraph.playback.planning.routes import (
    SamplingStep,
    draw_loop,
)
from metagraph.playback.planning.steps import choose_steps
from metagraph.playback.timing.phase_times import LEAST_BLEND

ON_TIME = 0.1  # seconds by which a request may begin later and still be on time
LOOP_FADE = 0.6  # seconds of crossfade when a long rest changes from one loop of its stance to another


def resume_layer(
    project: Project,
    graph: MetaGraph,
    seed: Bits,
    begin: str,
    past: Past,
    cues: Sequence[Cue],
    moods: Moods,
    track: Track,
) -> LayerState:
    """Return the layer as it is after a past and the cues that played since."""
    stance = past.stance if past.stance in graph.stances else begin
    out = LayerState(
        project, graph, seed, stance, moods, track, past.free, past.free,
        dict(past.uses), dict(past.recent), dict(past.ended),
    )  # fmt: skip
    out.beats = beat_interval(graph.layer, len([a for a in graph.actions.values() if a.kind == "gesture"]))
    for cue in cues:
        out.note(cue, cue.then if cue.then in graph.stances else begin)
    return out


def begin_layer(state: LayerState, stance: str) -> bool:
    """Lay the first loop down; return whether the layer can perform at all."""
    loop = draw_loop(state, stance, f"rest/{state.graph.layer}")
    if loop is None:
        return False
    state.rests.append(Rest(stance, loop, 0.0, 0.0, 0.0))
    return True


def perform_metas(state: LayerState, metas: Sequence[MetaAction], end: float) -> None:
    """Realise in order those meta actions of a conflict-free meta plan that start before `end`."""
    performed = [m for m in metas if not m.written or performs_written(state, m, m.start)]
    for bound in bounds(performed):
        meta = bound.meta
        if begins(meta) >= end:
            continue
        if len(state.served) > 0 and meta.key in state.served:
            continue
        if meta.request.late is not None:
            _realise(state, bound, max(state.ready, begins(meta)))
            continue
        ready = state.ready
        if meta.start < ready and meta.key not in state.begun:
            running = "the running action"
            if len(state.cues) > 0:
                running = f"'{state.cues[-1].action.name}'"
            waits = ready - meta.start
            if meta.end <= ready + FITS:
                waits = ready - meta.request.start
                # What is wanted for a certain time is over; what is wanted once may come late.
                wanted = meta.written or meta.request.duration is not None
                if wanted or waits > state.project.settings.wait:
                    why = f"wholly covered by {running}, which plays until {state.free:.2f} s"
                    state.tell(meta, "covered", why)
                    continue
            # What a model wrote is wanted at no certain time.
            if not meta.written and waits > ON_TIME:
                state.tell(meta, "queued", f"waits {waits:.2f} s for {running}", True)
        _realise(state, bound, max(ready, meta.start))


def _realise(state: LayerState, bound: Bound, now: float) -> None:
    meta = bound.meta
    if meta.written and meta.key not in state.begun and not may_begin(state, meta, now):
        return
    steps = choose_steps(state, meta, now)
    if steps is None:
        return
    cues: list[Cue] = []
    stance = state.stance
    for step in steps:
        hops = step.hop != ""
        asked = None if hops else remaining(meta, now)
        mood = find_mood(state, asked, now)
        fitting = _fit(state, bound, step, asked, now, mood)
        if len(fitting) == 0:
            return
        # On the way to a stance it counts when that begins.
        if meta.request.late is not None and (
            not hops or (len(cues) == 0 and steps[len(steps) - 1].hop != "")
        ):
            fitting = keep_timely(state, bound, fitting, now)
            if len(fitting) == 0:
                return
        action = draw_action(state, fitting, f"{meta.key}/{step.hop}" if hops else meta.key, now, mood)
        shape = shape_in_mood(state, action, asked, now, mood)
        cue = _cue(state, action, shape, bound, hops, stance, mood)
        cues.append(cue)
        now, stance = cue.end, cue.then
    for one in cues:
        _keep(state, one)


def _fit(
    state: LayerState, bound: Bound, step: SamplingStep, asked: MetaRequest | None, now: float, mood: Mood
) -> list[Action]:
    """Return the candidates of a step that are over in time and have cooled down. If none, tell why."""
    meta = bound.meta
    fitting = list(step.candidates)
    if bound.limit < float("inf"):  # else all fit
        fitting = [
            a for a in step.candidates if fits_before(shape_in_mood(state, a, asked, now, mood), bound.limit)
        ]
    if len(fitting) == 0:
        before = "" if meta.written else " before something more important"
        left = max(0.0, bound.limit - now)
        state.tell(meta, "no-room", f"nothing fits into the {left:.2f} s{before}")
        return fitting
    if step.hop != "" or meta.request.action is not None:
        return fitting
    warm = [
        a
        for a in fitting
        if a.cooldown <= 0 or find_cooled(state, a) <= shape_in_mood(state, a, asked, now, mood).start + FITS
    ]
    if len(warm) == 0:
        soonest = min([find_cooled(state, a) for a in fitting])
        why = f"all that fit are cooling down; the first may play again at {soonest:.2f} s"
        state.tell(meta, "cooling", why)
    return warm


def _cue(
    state: LayerState, action: Action, shape: CueShape, bound: Bound, hops: bool, stance: str, mood: Mood
) -> Cue:
    """hops: whether it is a transition on the way to the requested action."""
    length = shape.length
    into = max(0.0, action.timing.blend_in)
    out = max(0.0, action.timing.blend_out)
    begin, until = state.project.span(action)
    cycle = cycle_of(action.kind, action.timing, begin, until)
    if action.timing.earliest_exit is not None or cycle > 0:
        wish = float("inf") if hops else bound.wish
        length = min(length, max(shape.shortest, min(bound.limit, wish) - shape.start))
    elif not hops:
        length = min(length, find_until(state, action, shape, bound) - shape.start)
        if length < shape.length:
            out = max(out, RETRACTION)
    if shape.entry > begin:
        into = max(into, LEAST_BLEND)
    squeeze = min(1.0, length / (into + out)) if into + out > 0 else 1.0
    then = stance
    if action.kind == "transition" and action.end_stance is not None:
        then = action.end_stance
    end = shape.start + length
    return Cue(
        action, shape.start, end, shape.entry, into * squeeze, out * squeeze, stance, then,
        bound.meta.key,
        shape.hold_from, shape.hold_to, shape.hold, find_extent(state, action, mood), shape.tempo,
        begin if cycle > 0 else 0.0, begin + cycle if cycle > 0 else 0.0,
    )  # fmt: skip


def _keep(state: LayerState, cue: Cue) -> None:
    state.note(cue, cue.then)
    loop = draw_loop(state, cue.then, cue.meta)
    if loop is not None:
        # The loop begins again under the action, so that the action's last pose meets the loop's first.
        # On joints that the action does not move, the change shows. It takes its time there, like a
        # transition.
        partial = cue.action.limb != "both" or len(cue.action.joints) > 0 or len(cue.action.joint_weights) > 0
        begin = cue.start + cue.blend_in
        until = cue.end - cue.blend_out
        fade = max(0.0, until - begin)
        if partial:
            fade = cue.end - cue.start if cue.then != cue.stance else min(LOOP_FADE, cue.end - cue.start)
            begin = max(cue.start, until - fade)
        state.rests.append(Rest(cue.then, loop, until, begin, fade))


def vary_rests(state: LayerState, end: float) -> None:
    """Change between the loops of a stance in long rests, at the end of a loop."""
    out: list[Rest] = []
    for place, rest in enumerate(state.rests):
        out.append(rest)
        loops = state.graph.of(rest.stance, "stance")
        if len(loops) < 2:
            continue
        until = state.rests[place + 1].fade_start if place + 1 < len(state.rests) else end
        current, change = rest, rest.start
        while True:
            start, stop = state.project.span(current.action)
            change += max(1.0, stop - start - current.action.timing.blend_in)
            if not change <= until:  # nor when it is no number
                break
            loop = draw_loop(state, rest.stance, f"{state.graph.layer}/{change:.3f}")
            if loop is not None and loop.id != current.action.id:
                current = Rest(rest.stance, loop, change, change - LOOP_FADE, LOOP_FADE)
                out.append(current)
    state.rests = out
