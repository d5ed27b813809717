/**
 * How an action plays in a mood: how fast, how large, for how long.
 *
 * Translated from metagraph/playback/planning/manner.py; change that, and translate anew.
 */

import { shapeOf } from "./cue_shapes.js";
import { HELD, changed, extent, madeFor, moodAt, tempo } from "./mood.js";

/**
 * Return how an action would play for a request from `now` on, or as a step on the way to it.
 * @param {LayerState} state
 * @param {Action} action
 * @param {?MetaRequest} request
 * @param {number} now
 * @param {Mood} mood
 * @returns {CueShape}
 */
export function shapeInMood(state, action, request, now, mood) {
  return shapeOf(state.project, action, request, now, findTempo(action, mood));
}

/**
 * Return the mood in which a request is played from `at` on, or at its stroke.
 * @param {LayerState} state
 * @param {?MetaRequest} request
 * @param {number} at
 * @returns {Mood}
 */
export function findMood(state, request, at) {
  if (request === null) {
    return moodAt(state.moods, at);
  }
  const mood = moodAt(state.moods, request.stroke === null ? at : request.stroke);
  if (request.valence === null && request.arousal === null && request.intensity === null) {
    return mood;
  }
  return changed(mood, request.valence, request.arousal, request.intensity);
}

/**
 * Return the speed of an action in a mood, 1 if it was made for the mood.
 * @param {Action} action
 * @param {Mood} mood
 * @returns {number}
 */
export function findTempo(action, mood) {
  return (mood.neutral || madeFor(mood, action.tags)) ? 1 : tempo(mood);
}

/**
 * Return the extent of an action in a mood. Actions that move the feet, lead to another stance, touch something or were made
 * for the mood keep their extent.
 * @param {LayerState} state
 * @param {Action} action
 * @param {Mood} mood
 * @returns {number}
 */
export function findExtent(state, action, mood) {
  if (state.graph.layer === "body" || action.kind === "transition" || mood.neutral) {
    return 1;
  }
  return (action.contacts.length > 0 || action.tags.includes(HELD) || madeFor(mood, action.tags)) ? 1 : extent(mood);
}
