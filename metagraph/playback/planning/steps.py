"""Which actions a meta action may become: the transitions on the way, then the candidates."""

from __future__ import annotations

from metagraph.graph.model import Action
from metagraph.playback.plan import MetaAction
from metagraph.playback.planning.directing import find_lead, find_moves, keep_fresh, keep_modest
from metagraph.playback.planning.layer_state import LayerState
from metagraph.playback.planning.remembering import node
from metagraph.playback.planning.routes import SamplingStep, arrives, find_route, may_play, name_elsewhere


def choose_steps(state: LayerState, meta: MetaAction, now: float) -> list[SamplingStep] | None:
    """Return each action in turn: the transitions to get there, then the action itself; None if it is
    impossible or not needed, or if the model wrote it and every candidate played too recently.
    """
    request = meta.request
    graph = state.graph
    if request.action is not None:
        action = graph.actions.get(request.action)
        if action is None or action.stance not in graph.stances:
            state.tell(
                meta,
                "unknown-action",
                f"there is no action '{request.action}' in the {graph.layer} layer",
            )
            return None
        if action.kind == "stance":
            return find_route(state, meta, action.stance)
        if not arrives(state, action):
            state.tell(meta, "no-stance", f"'{action.name}' ends in a stance that has no loop")
            return None
        if action.stance == state.stance:
            return [SamplingStep([action])]
        way = find_route(state, meta, action.stance)
        return None if way is None else [*way, SamplingStep([action])]
    if request.stance is not None and request.kind in ("transition", "stance"):
        if request.stance not in graph.stances:
            state.tell(meta, "no-stance", f"there is no stance '{request.stance}' in the {graph.layer} layer")
            return None
        return find_route(state, meta, request.stance)
    leads = find_lead(state, now) if meta.written else ""
    if leads != "":
        return find_route(state, meta, leads)
    found = _find_candidates(state, meta, now)
    return None if len(found) == 0 else [SamplingStep(found)]


def _find_candidates(state: LayerState, meta: MetaAction, now: float) -> list[Action]:
    """Return the actions of the current stance that fit, none if every one played too recently for what the
    model wrote.
    """
    request = meta.request
    graph = state.graph
    here = node(state.stance, request.kind)
    if here not in state.candidates:
        state.candidates[here] = [a for a in graph.of(state.stance, request.kind) if may_play(state, a)]
    every = state.candidates[here]
    if len(request.among) > 0:
        every = [a for a in every if a.id in request.among]
    found = every
    if len(request.tags) > 0:
        found = [a for a in every if all(tag in a.tags for tag in request.tags)]
    exact = found
    if request.limb is not None:
        exact = [a for a in found if a.limb == request.limb]
    directed = meta.written and state.project.settings.variety > 0
    if directed:  # the model's limb and tags are wishes, not orders
        every = keep_fresh(state, meta, every, now)
        fresh = {a.id for a in every}
        found = [a for a in found if a.id in fresh]
        exact = [a for a in exact if a.id in fresh]
        if len(every) == 0:
            return find_moves(state, meta, now)
        if len(exact) == 0:
            exact = found if len(found) > 0 else every
    elif meta.written:  # nor worth playing the same again
        again = state.recent.get(here, ())[-1:]
        if not any(a.id not in again for a in exact):
            exact = found if any(a.id not in again for a in found) else every
    exact = keep_modest(state, meta, exact, now)
    if len(exact) == 0:
        name = graph.stances[state.stance].name
        asked = " ".join([*request.tags, request.kind])
        if request.limb is not None:
            asked = f"{request.limb} {asked}"
        if len(found) > 0:  # whose limb is a wish, too
            state.tell(meta, "other-limb", f"stance '{name}' has no {asked}; another will do", True)
            return found
        hint = "" if meta.written else name_elsewhere(state, request)
        state.tell(meta, "no-candidate", f"stance '{name}' has no {asked}{hint}")
    return exact
