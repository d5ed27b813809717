"""Which actions can play on a layer, and the way from stance to stance."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from metagraph.graph.model import Action
from metagraph.playback.plan import MetaAction, MetaRequest
from metagraph.playback.planning.choice import pick
from metagraph.playback.planning.layer_state import LayerState


@dataclass(frozen=True, slots=True)
class SamplingStep:
    """One action of a chain: the candidates for it and, for a transition on the way, the stance
    it leads to.
    """

    candidates: Sequence[Action]
    hop: str = ""


def may_play(state: LayerState, action: Action) -> bool:
    return action.likelihood > 0 and arrives(state, action)


def arrives(state: LayerState, action: Action) -> bool:
    """Return whether an action leaves the layer in a stance that has a loop."""
    end = action.end_stance
    if action.kind != "transition":
        return True
    return end is not None and end in state.graph.stances and len(state.graph.of(end, "stance")) > 0


def find_hops(state: LayerState, goal: str) -> list[str]:
    """Return the stances after the current one on the shortest way of transitions that can play, the goal
    last; empty if there is no way. Among equally short ways, the one whose transitions were placed first.
    """
    before = {state.stance: ""}
    queue = [state.stance]
    at = 0  # what is before it was looked at
    while at < len(queue) and goal not in before:
        stance = queue[at]
        at += 1
        for action in state.graph.of(stance, "transition"):
            end = action.end_stance
            if end is None or end in before or end not in state.graph.stances:
                continue
            if may_play(state, action):
                before[end] = stance
                queue.append(end)
    way: list[str] = []
    if goal not in before:
        return way
    step = goal
    while step != state.stance:
        way.append(step)
        step = before[step]
    return list(reversed(way))


def name_elsewhere(state: LayerState, request: MetaRequest) -> str:
    for action in state.graph.actions.values():
        fits = (
            action.kind == request.kind
            and all(tag in action.tags for tag in request.tags)
            and (request.limb is None or request.limb == action.limb)
        )
        if fits and action.stance in state.graph.stances:
            return f"; there is one in '{state.graph.stances[action.stance].name}'"
    return ""


def draw_loop(state: LayerState, stance: str, key: str) -> Action | None:
    """Return one of a stance's loops, drawn by likelihood; None if it has none."""
    loops = state.graph.of(stance, "stance")
    if len(loops) == 1:
        return loops[0]
    weights = {a.id: a.likelihood for a in loops if a.likelihood > 0}
    if len(weights) == 0:
        return loops[0] if len(loops) > 0 else None
    chosen = pick(state.seed, key, "loop", weights)
    return next(a for a in loops if a.id == chosen)


def find_route(state: LayerState, meta: MetaAction, goal: str) -> list[SamplingStep] | None:
    """Return the transitions hop by hop from the current stance to `goal`."""
    if goal == state.stance:
        name = state.graph.stances[goal].name
        state.tell(meta, "already-there", f"the layer is in '{name}' already", True)
        return None
    stances = find_hops(state, goal)
    if len(stances) == 0:
        a = state.graph.stances[state.stance].name
        b = state.graph.stances[goal].name
        state.tell(meta, "no-way", f"no chain of transitions leads from '{a}' to '{b}'")
        return None
    steps: list[SamplingStep] = []
    at = state.stance
    for following in stances:
        hops = [
            a for a in state.graph.of(at, "transition") if a.end_stance == following and may_play(state, a)
        ]
        steps.append(SamplingStep(hops, following))
        at = following
    return steps
