/**
 * Which actions meet the moment that a request names, and when an action has to be over for the next one.
 *
 * Translated from metagraph/playback/planning/punctuality.py; change that, and translate anew.
 */

import { begins } from "./bounds.js";
import { FITS, hurried, lateness, mayShare, meets, slackOf } from "./cue_shapes.js";
import { findMood, findTempo, shapeInMood } from "./manner.js";
import { drag } from "./mood.js";
import { mayPlay } from "./routes.js";
import { findPhases } from "./phases.js";
import { minOf } from "./basics.js";

/**
 * Return the candidates that come least late, if that is not too late; among them those that leave the following requests
 * the most time and serve the most of them.
 * @param {LayerState} state
 * @param {Bound} bound
 * @param {Action[]} fitting
 * @param {number} now
 * @returns {Action[]}
 */
export function keepTimely(state, bound, fitting, now) {
  const meta = bound.meta;
  const request = meta.request;
  const allowed = slackOf(request);
  const mood = findMood(state, request, now);
  const late = new Map(fitting.map((a) =>
    [a.id, lateness(state.project, a, request, shapeInMood(state, a, request, now, mood))]));
  const least = minOf(fitting.map((a) => late.get(a.id)));
  let waits;
  if (least > allowed + FITS) {
    waits = tellCause(state, request, now);
    state.tell(
      meta,
      "too-late",
      `would come ${least.toFixed(2)} s late, ${allowed.toFixed(2)} s are allowed; it waits for ${waits}`,
      false,
      least,
    );
    return [];
  }
  if (least > FITS) {
    waits = tellCause(state, request, now);
    state.tell(meta, "late", `comes ${least.toFixed(2)} s late; it waits for ${waits}`, true, least);
  }
  let timely = fitting.filter((a) => late.get(a.id) <= Math.max(least, 0) + FITS);
  for (const other of bound.after) {
    if (!mayShare(request, other.request)) {
      continue;
    }
    const both = timely.filter((a) => meets(a, other.request));
    let behind = 0;
    if (request.stroke !== null && other.request.stroke !== null) {
      behind = Math.max(0, request.stroke + Math.max(least, 0) - other.request.stroke);
    }
    if (both.length > 0 && other.request.late !== null && behind <= other.request.late + FITS) {
      timely = both;
      state.served.add(other.key);
      const message = `shares the stroke of '${request.id}'`;
      state.tell(other, "shared", message, true, behind, meta.key);
    }
  }
  const following = bound.after.filter((other) => !state.served.has(other.key));
  for (const other of following) {
    for (const slack of [0, slackOf(other.request)]) {
      const by = findLatest(state, other.request) + slack;
      const over = timely.filter((a) => findOver(state, a, request, now) <= by);
      if (over.length > 0) {
        return over;
      }
    }
  }
  return timely;
}

/**
 * Return the reason why a request comes late.
 * @param {LayerState} state
 * @param {MetaRequest} request
 * @param {number} now
 * @returns {string}
 */
export function tellCause(state, request, now) {
  if (now <= request.start + FITS) {
    return "its own preparation";
  }
  if (state.cues.length > 0 && state.ready >= now - FITS && state.cues[state.cues.length - 1].end >= state.free - FITS) {
    return `'${state.cues[state.cues.length - 1].action.name}', which plays until ${state.free.toFixed(2)} s`;
  }
  return state.cues.length > 0 ? "what comes before it" : "the time it became known at";
}

/**
 * Return the latest time at which a requested action has to begin to be on time; never in the past.
 * @param {LayerState} state
 * @param {MetaRequest} request
 * @returns {number}
 */
export function findLatest(state, request) {
  if (request.stroke === null) {
    return request.start;
  }
  let least = Infinity;
  for (const action of state.graph.of(state.stance, request.kind)) {
    let fits = meets(action, request);
    if (request.action !== null) {
      fits = action.id === request.action;
    }
    if (!fits || !mayPlay(state, action)) {
      continue;
    }
    if (action.kind !== "gesture") { // it has no stroke: it should begin when its request does
      least = Math.min(least, request.stroke - request.start);
    } else {
      const found = findPhases(state.project, action);
      const lead = found.stroke - found.skip(action.timing.blendIn);
      const speed = findTempo(action, findMood(state, request, request.stroke));
      least = Math.min(least, lead + drag(lead, speed));
    }
  }
  return request.stroke - least;
}

/**
 * Return the earliest time at which the next action could begin after this one.
 * @param {LayerState} state
 * @param {Action} action
 * @param {MetaRequest} request
 * @param {number} now
 * @returns {number}
 */
export function findOver(state, action, request, now) {
  const shape = shapeInMood(state, action, request, now, findMood(state, request, now));
  return shape.start + hurried(state.project, action, shape) + state.project.settings.rest - FITS;
}

/**
 * Return when an action that should play to its end is left early all the same: early enough for the first following request
 * that can then be in time, late enough for its own stroke; infinity for never.
 * @param {LayerState} state
 * @param {Action} action
 * @param {CueShape} shape
 * @param {Bound} bound
 * @returns {number}
 */
export function findUntil(state, action, shape, bound) {
  if (bound.after.length === 0) {
    return Infinity;
  }
  const rest = state.project.settings.rest;
  const soonest = shape.start + hurried(state.project, action, shape);
  for (const other of bound.after) {
    const inTime = findLatest(state, other.request) + slackOf(other.request);
    if (!state.served.has(other.key) && soonest + rest <= inTime + FITS) {
      return Math.max(soonest, begins(other) - rest);
    }
  }
  return Infinity;
}
