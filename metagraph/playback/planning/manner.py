"""How an action plays in a mood: how fast, how large, for how long."""

from __future__ import annotations

from metagraph.graph.model import Action
from metagraph.playback.plan import MetaRequest
from metagraph.playback.planning.cue_shapes import CueShape, shape_of
from metagraph.playback.planning.layer_state import LayerState
from metagraph.playback.planning.mood import HELD, Mood, changed, extent, made_for, mood_at, tempo


def shape_in_mood(
    state: LayerState, action: Action, request: MetaRequest | None, now: float, mood: Mood
) -> CueShape:
    """Return how an action would play for a request from `now` on, or as a step on the way to it."""
    return shape_of(state.project, action, request, now, find_tempo(action, mood))


def find_mood(state: LayerState, request: MetaRequest | None, at: float) -> Mood:
    """Return the mood in which a request is played from `at` on, or at its stroke."""
    if request is None:
        return mood_at(state.moods, at)
    mood = mood_at(state.moods, at if request.stroke is None else request.stroke)
    if request.valence is None and request.arousal is None and request.intensity is None:
        return mood
    return changed(mood, request.valence, request.arousal, request.intensity)


def find_tempo(action: Action, mood: Mood) -> float:
    """Return the speed of an action in a mood, 1 if it was made for the mood."""
    return 1.0 if mood.neutral or made_for(mood, action.tags) else tempo(mood)


def find_extent(state: LayerState, action: Action, mood: Mood) -> float:
    """Return the extent of an action in a mood. Actions that move the feet, lead to another stance, touch
    something or were made for the mood keep their extent.
    """
    if state.graph.layer == "body" or action.kind == "transition" or mood.neutral:
        return 1.0
    return (
        1.0
        if len(action.contacts) > 0 or HELD in action.tags or made_for(mood, action.tags)
        else extent(mood)
    )
