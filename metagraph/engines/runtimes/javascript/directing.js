/**
 * What the character does of its own accord: when it acts, rests and thinks, and what it does not repeat. The times are
 * those of `director`.
 *
 * Translated from metagraph/playback/planning/directing.py; change that, and translate anew.
 */

import { modeAt } from "./wanted.js";
import { uniform } from "./choice.js";
import { 
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
  findLull,
  freshness,
  musing,
  posture,
  repeatInterval,
} from "./director.js";
import { performs } from "./markov.js";
import { moodAt, stirs } from "./mood.js";
import { measureProminence } from "./prominence.js";
import { findHops, mayPlay } from "./routes.js";

/**
 * Return whether what a model wrote is performed at a time: not out of a stance that a request holds, and as often as mode
 * and mood say. Anything may begin a long thought, or end it.
 * @param {LayerState} state
 * @param {MetaAction} meta
 * @param {number} now
 * @returns {boolean}
 */
export function performsWritten(state, meta, now) {
  if (!stirs(moodAt(state.moods, now), state.seed, meta.request.id)) {
    return false;
  }
  if (meta.request.kind === "transition" && state.track.staysAt(state.graph.layer, now)) {
    return false;
  }
  if (state.model === null || muses(state, now) || hasMused(state, now)) {
    return true;
  }
  return performs(state.model, state.seed, meta, modeAt(state.track, now));
}

/**
 * Return whether what a model wrote begins at a time, which may be later than it was written for: not soon after an
 * interruption, and nothing that would end a thought.
 * @param {LayerState} state
 * @param {MetaAction} meta
 * @param {number} now
 * @returns {boolean}
 */
export function mayBegin(state, meta, now) {
  if (state.track.hushedAt(now) || !performsWritten(state, meta, now)) {
    return false;
  }
  if (state.model === null || findLead(state, now) !== "") {
    return true;
  }
  if (lulls(state, now)) {
    return false;
  }
  const there = state.stance === musing(state.graph.stances);
  if (there && meta.request.kind === "transition" && muses(state, now)) {
    return false;
  }
  return performs(state.model, state.seed, meta, modeAt(state.track, now));
}

/**
 * Return whether the arms rest at a time: after a burst of one who talks, else after any act. In a thought acts are rare
 * anyway.
 * @param {LayerState} state
 * @param {number} now
 * @returns {boolean}
 */
export function lulls(state, now) {
  const variety = state.project.settings.variety;
  if (state.graph.layer !== "arms" || variety <= 0 || state.cues.length === 0 || hasMused(state, now)) {
    return false;
  }
  const last = state.cues[state.cues.length - 1];
  const mode = modeAt(state.track, now);
  if (now >= last.end + MOST_LULL || mode === "thinking") {
    return false;
  }
  const talks = mode === "talking";
  if (talks && last.action.kind === "transition") { // it opens a burst
    return false;
  }
  return now < last.end + findLull(state.seed, last.meta, talks, variety);
}

/**
 * Return whether the arms take or keep the stance in which the character thinks.
 * @param {LayerState} state
 * @param {number} now
 * @returns {boolean}
 */
export function muses(state, now) {
  if (modeAt(state.track, now) !== "thinking" || modeAt(state.track, now + MUSES) !== "thinking") {
    return false;
  }
  if (state.graph.layer !== "arms" || state.project.settings.variety <= 0) {
    return false;
  }
  return !state.track.staysAt("arms", now) && musing(state.graph.stances) !== "";
}

/**
 * Return whether a thought of the character has ended just now.
 * @param {LayerState} state
 * @param {number} now
 * @returns {boolean}
 */
export function hasMused(state, now) {
  if (state.graph.layer !== "arms" || modeAt(state.track, now) === "thinking") {
    return false;
  }
  return state.project.settings.variety > 0 && modeAt(state.track, now - MUSED) === "thinking";
}

/**
 * Return the stance that the arms go to whatever a model wrote: the one in which the character thinks, and from there home
 * as soon as the thought is over; "" for none.
 * @param {LayerState} state
 * @param {number} now
 * @returns {string}
 */
export function findLead(state, now) {
  if (state.graph.layer !== "arms" || state.project.settings.variety <= 0) {
    return "";
  }
  const thoughtful = musing(state.graph.stances);
  if (thoughtful === "" || state.track.staysAt("arms", now)) {
    return "";
  }
  const home = state.graph.start;
  let goal = "";
  if (muses(state, now)) {
    goal = thoughtful;
  } else if (state.stance === thoughtful && home !== null && modeAt(state.track, now) !== "thinking") {
    const came = state.moved();
    if (came >= 0 && modeAt(state.track, came) === "thinking") {
      goal = home;
    }
  }
  if (goal === state.stance || goal === "" || findHops(state, goal).length === 0) {
    return "";
  }
  return goal;
}

/**
 * Return the actions that the character may do by itself; see `director`.
 * @param {LayerState} state
 * @param {MetaAction} meta
 * @param {Action[]} candidates
 * @param {number} now
 * @returns {Action[]}
 */
export function keepFresh(state, meta, candidates, now) {
  const variety = state.project.settings.variety;
  const layer = state.graph.layer;
  if (meta.request.kind === "transition") {
    if (now < state.moved() + posture(layer) * variety) {
      return [];
    }
    if (layer === "arms" && now < state.acted + LEAST_LULL * variety) {
      return [];
    }
    if (layer !== "head") {
      return [...candidates];
    }
    if (state.stance === state.graph.start) {
      const leaves = uniform(state.seed, meta.key, "leaves") < LEAVES_HOME;
      return leaves ? [...candidates] : [];
    }
    const home = candidates.filter((a) => a.endStance === state.graph.start);
    const returns = home.length > 0 && uniform(state.seed, meta.key, "home") < GOES_HOME;
    return returns ? home : [...candidates];
  }
  const share = now < state.acted + LONG_REST * variety ? variety : variety * SHORTER;
  const reminded = hasShown(state, now - APART * variety);
  const converses = meta.request.kind === "fidget" && modeAt(state.track, now) !== "idle";
  const out = [];
  for (const action of candidates) {
    const shows = measureShowing(state, action);
    if ((reminded || converses) && shows >= STANDS_OUT) {
      continue;
    }
    const needed = repeatInterval(action.kind, shows, state.beats) * share;
    if (!state.ended.has(action.id) || now >= state.ended.get(action.id) + needed) {
      out.push(action);
    }
  }
  return out;
}

/**
 * Return the candidates for a requested fidget in a conversation without those that stand out, if others are left and no
 * tags are requested; else all.
 * @param {LayerState} state
 * @param {MetaAction} meta
 * @param {Action[]} candidates
 * @param {number} now
 * @returns {Action[]}
 */
export function keepModest(state, meta, candidates, now) {
  const request = meta.request;
  const every = [...candidates];
  if (request.kind !== "fidget" || request.tags.length > 0 || state.project.settings.variety <= 0) {
    return every;
  }
  if (meta.written || modeAt(state.track, now) === "idle") {
    return every;
  }
  const left = every.filter((a) => measureShowing(state, a) < STANDS_OUT);
  return left.length > 0 ? left : every;
}

/**
 * Return the transitions of the arms that may play for a gesture where all gestures of the stance have played too recently,
 * and others of another stance have not.
 * @param {LayerState} state
 * @param {MetaAction} meta
 * @param {number} now
 * @returns {Action[]}
 */
export function findMoves(state, meta, now) {
  const out = [];
  if (state.graph.layer !== "arms" || meta.request.kind !== "gesture" || state.track.staysAt("arms", now)) {
    return out;
  }
  const variety = state.project.settings.variety;
  if (now < state.moved() + posture("arms") * variety || now < state.acted + LEAST_LULL * variety) {
    return out;
  }
  for (const action of state.graph.of(state.stance, "transition")) {
    if (mayPlay(state, action) && countFresh(state, action.endStance, now) > 0) {
      out.push(action);
    }
  }
  return out;
}

/**
 * Return how many gestures of a stance have not played for long enough.
 * @param {LayerState} state
 * @param {?string} stance
 * @param {number} now
 * @returns {number}
 */
export function countFresh(state, stance, now) {
  if (stance === null) {
    return 0;
  }
  const variety = state.project.settings.variety;
  let count = state.graph.of(stance, "gesture").length;
  for (const { 0: ident, 1: end } of state.ended) {
    const action = state.graph.actions.get(ident) ?? null;
    if (action === null || action.kind !== "gesture" || action.stance !== stance) {
      continue;
    }
    const shows = measureShowing(state, action);
    if (now < end + repeatInterval("gesture", shows, state.beats) * variety) {
      count -= 1;
    }
  }
  return count;
}

/**
 * Return whether an act that stands out was done since a time.
 * @param {LayerState} state
 * @param {number} since
 * @returns {boolean}
 */
export function hasShown(state, since) {
  for (const { 0: ident, 1: end } of state.ended) {
    const action = state.graph.actions.get(ident) ?? null;
    if (action === null || action.kind === "transition" || end < since) {
      continue;
    }
    if (measureShowing(state, action) >= STANDS_OUT) {
      return true;
    }
  }
  return false;
}

/**
 * Return how much an action stands out.
 * @param {LayerState} state
 * @param {Action} action
 * @returns {number}
 */
export function measureShowing(state, action) {
  if (!state.prominences.has(action.id)) {
    state.prominences.set(action.id, measureProminence(state.project, action));
  }
  return state.prominences.get(action.id);
}

/**
 * Return the factor by which variety changes an action's likelihood.
 * @param {LayerState} state
 * @param {Action} action
 * @param {number} now
 * @returns {number}
 */
export function weighVariety(state, action, now) {
  const variety = state.project.settings.variety;
  if (variety <= 0) {
    return 1;
  }
  if (action.kind === "transition") {
    const talks = state.graph.layer === "arms" && modeAt(state.track, now) === "talking";
    return talks ? 1 + countFresh(state, action.endStance, now) : 1;
  }
  if (!state.ended.has(action.id)) {
    return 1;
  }
  const shows = measureShowing(state, action);
  const needed = repeatInterval(action.kind, shows, state.beats) * variety;
  return freshness(now - state.ended.get(action.id), needed);
}
