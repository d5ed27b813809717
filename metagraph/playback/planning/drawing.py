"""The draw of one action among the candidates that did not play too recently (Borer et al., section 6.2)."""

from __future__ import annotations

from metagraph.graph.model import Action
from metagraph.playback.planning.choice import pick
from metagraph.playback.planning.directing import weigh_variety
from metagraph.playback.planning.layer_state import LayerState
from metagraph.playback.planning.mood import Mood, favour
from metagraph.playback.planning.remembering import node, rested
from metagraph.playback.planning.vigour import measure_vigour


def draw_action(state: LayerState, candidates: list[Action], key: str, now: float, mood: Mood) -> Action:
    """Draw with p_k ~ likelihood_k / max(c_k, 1), times the factors of mood and variety. Actions used too
    recently are left out as long as others are left.
    """
    left = keep_spaced(state, candidates)
    if len(left) == 1:
        return left[0]
    neutral = mood.neutral
    weights: dict[str, float] = {}
    for a in left:
        favoured = 1.0 if neutral else favour(mood, a.tags, measure_vigour(state.project, a))
        weight = a.likelihood / max(count_uses(state, a.id, now), 1.0) * favoured
        weights[a.id] = weight * weigh_variety(state, a, now)
    if not any(w > 0 for w in weights.values()):
        return left[0]
    chosen = pick(state.seed, key, "action", weights)
    return next(a for a in left if a.id == chosen)


def keep_spaced(state: LayerState, candidates: list[Action]) -> list[Action]:
    """Leave out actions that need more other actions before they play again. If nothing is left, all need
    one less, and so on.
    """
    default = 1 if state.project.settings.never_twice else 0
    first = candidates[0]
    before = state.recent.get(node(first.stance, first.kind), ())
    if len(candidates) < 2 or len(before) == 0:
        return candidates
    needs = {a.id: default if a.spacing is None else a.spacing for a in candidates}
    for less in range(max([needs[a.id] for a in candidates]) + 1):
        left = [a for a in candidates if rested(before, a.id, needs[a.id] - less)]
        if len(left) > 0:
            return left
    return candidates


def count_uses(state: LayerState, ident: str, now: float) -> float:
    """Return c_k of section 6.2, alpha times the uses, over the settings' memory."""
    memory = state.project.settings.memory
    alpha = state.project.settings.alpha
    if memory <= 0:
        return alpha * state.uses.get(ident, 0)
    used = 0
    for cue in reversed(state.cues):
        if cue.start < now - memory:
            break
        if cue.action.id == ident:
            used += 1
    return alpha * used


def find_cooled(state: LayerState, action: Action) -> float:
    """Return the time from which an action may be drawn again."""
    if action.cooldown > 0 and action.id in state.ended:
        return state.ended[action.id] + action.cooldown
    return float("-inf")
