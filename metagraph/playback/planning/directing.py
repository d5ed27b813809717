"""What the character does of its own accord: when it acts, rests and thinks, and what it does not repeat. The
times are those of `director`.
"""

from __future__ import annotations

from collections.abc import Sequence

from metagraph.graph.model import Action
from metagraph.playback.life.wanted import mode_at
from metagraph.playback.plan import MetaAction
from metagraph.playback.planning.choice import uniform
from metagraph.playback.planning.director import (
    APART,
    GOES_HOME,
    LEAST_LULL,
    LEAVES_HOME,
    LONG_REST,
    MOST_LULL,
    MUSED,
    MUSES,
    SHORTER,
    STANDS_OUT,
    find_lull,
    freshness,
    musing,
    posture,
    repeat_interval,
)
from metagraph.playback.planning.layer_state import LayerState
from metagraph.playback.planning.markov import performs
from metagraph.playback.planning.mood import mood_at, stirs
from metagraph.playback.planning.prominence import measure_prominence
from metagraph.playback.planning.routes import find_hops, may_play


def performs_written(state: LayerState, meta: MetaAction, now: float) -> bool:
    """Return whether what a model wrote is performed at a time: not out of a stance that a request holds,
    and as often as mode and mood say. Anything may begin a long thought, or end it.
    """
    if not stirs(mood_at(state.moods, now), state.seed, meta.request.id):
        return False
    if meta.request.kind == "transition" and state.track.stays_at(state.graph.layer, now):
        return False
    if state.model is None or muses(state, now) or has_mused(state, now):
        return True
    return performs(state.model, state.seed, meta, mode_at(state.track, now))


def may_begin(state: LayerState, meta: MetaAction, now: float) -> bool:
    """Return whether what a model wrote begins at a time, which may be later than it was written for: not
    soon after an interruption, and nothing that would end a thought.
    """
    if state.track.hushed_at(now) or not performs_written(state, meta, now):
        return False
    if state.model is None or find_lead(state, now) != "":
        return True
    if lulls(state, now):
        return False
    there = state.stance == musing(state.graph.stances)
    if there and meta.request.kind == "transition" and muses(state, now):
        return False
    return performs(state.model, state.seed, meta, mode_at(state.track, now))


def lulls(state: LayerState, now: float) -> bool:
    """Return whether the arms rest at a time: after a burst of one who talks, else after any act. In a
    thought acts are rare anyway.
    """
    variety = state.project.settings.variety
    if state.graph.layer != "arms" or variety <= 0 or len(state.cues) == 0 or has_mused(state, now):
        return False
    last = state.cues[-1]
    mode = mode_at(state.track, now)
    if now >= last.end + MOST_LULL or mode == "thinking":
        return False
    talks = mode == "talking"
    if talks and last.action.kind == "transition":  # it opens a burst
        return False
    return now < last.end + find_lull(state.seed, last.meta, talks, variety)


def muses(state: LayerState, now: float) -> bool:
    """Return whether the arms take or keep the stance in which the character thinks."""
    if mode_at(state.track, now) != "thinking" or mode_at(state.track, now + MUSES) != "thinking":
        return False
    if state.graph.layer != "arms" or state.project.settings.variety <= 0:
        return False
    return not state.track.stays_at("arms", now) and musing(state.graph.stances) != ""


def has_mused(state: LayerState, now: float) -> bool:
    """Return whether a thought of the character has ended just now."""
    if state.graph.layer != "arms" or mode_at(state.track, now) == "thinking":
        return False
    return state.project.settings.variety > 0 and mode_at(state.track, now - MUSED) == "thinking"


def find_lead(state: LayerState, now: float) -> str:
    """Return the stance that the arms go to whatever a model wrote: the one in which the character
    thinks, and from there home as soon as the thought is over; "" for none.
    """
    if state.graph.layer != "arms" or state.project.settings.variety <= 0:
        return ""
    thoughtful = musing(state.graph.stances)
    if thoughtful == "" or state.track.stays_at("arms", now):
        return ""
    home = state.graph.start
    goal = ""
    if muses(state, now):
        goal = thoughtful
    elif state.stance == thoughtful and home is not None and mode_at(state.track, now) != "thinking":
        came = state.moved()
        if came >= 0 and mode_at(state.track, came) == "thinking":
            goal = home
    if goal == state.stance or goal == "" or len(find_hops(state, goal)) == 0:
        return ""
    return goal


def keep_fresh(state: LayerState, meta: MetaAction, candidates: Sequence[Action], now: float) -> list[Action]:
    """Return the actions that the character may do by itself; see `director`."""
    variety = state.project.settings.variety
    layer = state.graph.layer
    if meta.request.kind == "transition":
        if now < state.moved() + posture(layer) * variety:
            return []
        if layer == "arms" and now < state.acted + LEAST_LULL * variety:
            return []
        if layer != "head":
            return list(candidates)
        if state.stance == state.graph.start:
            leaves = uniform(state.seed, meta.key, "leaves") < LEAVES_HOME
            return list(candidates) if leaves else []
        home = [a for a in candidates if a.end_stance == state.graph.start]
        returns = len(home) > 0 and uniform(state.seed, meta.key, "home") < GOES_HOME
        return home if returns else list(candidates)
    share = variety if now < state.acted + LONG_REST * variety else variety * SHORTER
    reminded = has_shown(state, now - APART * variety)
    converses = meta.request.kind == "fidget" and mode_at(state.track, now) != "idle"
    out: list[Action] = []
    for action in candidates:
        shows = measure_showing(state, action)
        if (reminded or converses) and shows >= STANDS_OUT:
            continue
        needed = repeat_interval(action.kind, shows, state.beats) * share
        if action.id not in state.ended or now >= state.ended[action.id] + needed:
            out.append(action)
    return out


def keep_modest(
    state: LayerState, meta: MetaAction, candidates: Sequence[Action], now: float
) -> list[Action]:
    """Return the candidates for a requested fidget in a conversation without those that stand out, if
    others are left and no tags are requested; else all.
    """
    request = meta.request
    every = list(candidates)
    if request.kind != "fidget" or len(request.tags) > 0 or state.project.settings.variety <= 0:
        return every
    if meta.written or mode_at(state.track, now) == "idle":
        return every
    left = [a for a in every if measure_showing(state, a) < STANDS_OUT]
    return left if len(left) > 0 else every


def find_moves(state: LayerState, meta: MetaAction, now: float) -> list[Action]:
    """Return the transitions of the arms that may play for a gesture where all gestures of the stance
    have played too recently, and others of another stance have not.
    """
    out: list[Action] = []
    if state.graph.layer != "arms" or meta.request.kind != "gesture" or state.track.stays_at("arms", now):
        return out
    variety = state.project.settings.variety
    if now < state.moved() + posture("arms") * variety or now < state.acted + LEAST_LULL * variety:
        return out
    for action in state.graph.of(state.stance, "transition"):
        if may_play(state, action) and count_fresh(state, action.end_stance, now) > 0:
            out.append(action)
    return out


def count_fresh(state: LayerState, stance: str | None, now: float) -> int:
    """Return how many gestures of a stance have not played for long enough."""
    if stance is None:
        return 0
    variety = state.project.settings.variety
    count = len(state.graph.of(stance, "gesture"))
    for ident, end in state.ended.items():
        action = state.graph.actions.get(ident)
        if action is None or action.kind != "gesture" or action.stance != stance:
            continue
        shows = measure_showing(state, action)
        if now < end + repeat_interval("gesture", shows, state.beats) * variety:
            count -= 1
    return count


def has_shown(state: LayerState, since: float) -> bool:
    """Return whether an act that stands out was done since a time."""
    for ident, end in state.ended.items():
        action = state.graph.actions.get(ident)
        if action is None or action.kind == "transition" or end < since:
            continue
        if measure_showing(state, action) >= STANDS_OUT:
            return True
    return False


def measure_showing(state: LayerState, action: Action) -> float:
    """Return how much an action stands out."""
    if action.id not in state.prominences:
        state.prominences[action.id] = measure_prominence(state.project, action)
    return state.prominences[action.id]


def weigh_variety(state: LayerState, action: Action, now: float) -> float:
    """Return the factor by which variety changes an action's likelihood."""
    variety = state.project.settings.variety
    if variety <= 0:
        return 1.0
    if action.kind == "transition":
        talks = state.graph.layer == "arms" and mode_at(state.track, now) == "talking"
        return 1.0 + count_fresh(state, action.end_stance, now) if talks else 1.0
    if action.id not in state.ended:
        return 1.0
    shows = measure_showing(state, action)
    needed = repeat_interval(action.kind, shows, state.beats) * variety
    return freshness(now - state.ended[action.id], needed)
