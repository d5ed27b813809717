/**
 * How an action would play for a request: when it begins, how long it lasts and how late it is.
 *
 * A gesture waits for its stroke or cuts its preparation to catch up with it; its hold is stretched, and its retraction may
 * be cut (Borer et al., section 6.2).
 *
 * Translated from metagraph/playback/planning/cue_shapes.py; change that, and translate anew.
 */

import { LONGEST_REPEAT, cycleOf, timesPlayed } from "./repeating.js";
import { drag } from "./mood.js";
import { findPhases } from "./phases.js";
import { but } from "./basics.js";

export const FITS = 1e-06; // seconds by which sums of times may be off
export const HURRY = 2; // a hold is played at most this many times as fast as it was made
export const STOPPED = 0.3; // seconds in which an action that is taken back goes back to its stance, from where it is
export const RETRACTION = 0.4; // seconds in which an action whose retraction is cut goes back to its stance, at the least
export const SHARED = 0.25; // seconds within which two strokes may be one

/**
 * How an action would play: from `start` on, for `length` seconds, at least `shortest`; the other fields are those of a cue.
 *
 * start: number; entry: number; length: number; shortest: number; holdFrom: number; holdTo: number; hold: number; tempo:
 * number.
 */
export class CueShape {
  constructor(start, entry, length, shortest, holdFrom = 0, holdTo = 0, hold = 0, tempo = 1) {
    this.start = start;
    this.entry = entry;
    this.length = length;
    this.shortest = shortest;
    this.holdFrom = holdFrom;
    this.holdTo = holdTo;
    this.hold = hold;
    this.tempo = tempo;
  }
}

/**
 * Return how an action would play for a request from `now` on, or as a step on the way to it. speed: a factor of the
 * action's own speed.
 * @param {Project} project
 * @param {Action} action
 * @param {?MetaRequest} request
 * @param {number} now
 * @param {number} speed
 * @returns {CueShape}
 */
export function shapeOf(project, action, request, now, speed) {
  const { 0: start, 1: end } = project.span(action);
  let begin = now;
  let entry = start;
  let holdFrom = 0;
  let holdTo = 0;
  let hold = 0;
  const cycle = cycleOf(action.kind, action.timing, start, end);
  if (request !== null
    && action.kind === "gesture"
    && (request.hold !== null || request.stroke !== null || !request.prepare)) {
    const found = findPhases(project, action);
    const latest = found.skip(action.timing.blendIn);
    entry = request.prepare ? start : latest;
    // Wait for the stroke, or catch up with it by cutting the preparation.
    if (request.stroke !== null) {
      begin = Math.max(now, request.stroke - (found.stroke - entry) / speed);
      const missed = found.stroke - Math.max(0, request.stroke - begin) * speed;
      entry = Math.min(Math.max(entry, missed), Math.max(entry, latest));
    }
    if (request.hold !== null && cycle <= 0) {
      holdFrom = found.strokeEnd;
      holdTo = found.relax;
      hold = Math.max(request.hold, (holdTo - holdFrom) / HURRY);
      if (hold <= 0) {
        holdFrom = 0;
        holdTo = 0;
      }
    }
  }
  const natural = holdTo - holdFrom;
  let length = end - entry + hold - natural + drag(end - entry - natural, speed);
  let shortest = length;
  let exitAt = action.timing.earliestExit;
  if (cycle > 0) {
    let wanted = Math.min(action.timing.repeat, LONGEST_REPEAT);
    if (request !== null && request.hold !== null) {
      wanted = request.hold; // what repeats goes on for as long as another gesture would be held
    }
    if (request !== null && request.duration !== null) {
      wanted = request.duration;
    }
    length += (timesPlayed(cycle, wanted * speed) - 1) * cycle / speed;
    exitAt = exitAt === null ? end : exitAt;
  }
  if (exitAt !== null) {
    let left = exitAt - entry + (exitAt >= holdTo ? hold - natural : 0);
    left += drag(exitAt - entry - (exitAt >= holdTo ? natural : 0), speed);
    shortest = Math.min(length, Math.max(0, left) + action.timing.blendOut);
  }
  return new CueShape(begin, entry, length, shortest, holdFrom, holdTo, hold, speed);
}

/**
 * Return whether something with this shape is over by a limit.
 * @param {CueShape} shape
 * @param {number} limit
 * @returns {boolean}
 */
export function fitsBefore(shape, limit) {
  return shape.start + shape.shortest <= limit + FITS;
}

/**
 * Return by how many seconds an action with this shape comes late, measured at its stroke if the request has one; below 0 if
 * it comes early.
 * @param {Project} project
 * @param {Action} action
 * @param {MetaRequest} request
 * @param {CueShape} shape
 * @returns {number}
 */
export function lateness(project, action, request, shape) {
  if (request.stroke !== null && action.kind === "gesture") {
    const found = findPhases(project, action);
    const until = found.stroke - shape.entry;
    return shape.start + found.stroke - shape.entry + drag(until, shape.tempo) - request.stroke;
  }
  return shape.start - request.start;
}

/**
 * Return by how many seconds a request may come late, 0 if it does not say.
 * @param {MetaRequest} request
 * @returns {number}
 */
export function slackOf(request) {
  return request.late === null ? 0 : request.late;
}

/**
 * Return how many seconds a gesture takes if its retraction is cut and its hold is left out, unless the request has a hold.
 * @param {Project} project
 * @param {Action} action
 * @param {CueShape} shape
 * @returns {number}
 */
export function hurried(project, action, shape) {
  const { 0: start, 1: end } = project.span(action);
  const repeats = cycleOf(action.kind, action.timing, start, end) > 0;
  if (action.kind !== "gesture" || action.timing.earliestExit !== null || repeats) {
    return shape.shortest;
  }
  const found = findPhases(project, action);
  let left = found.relax - shape.entry + shape.hold - (shape.holdTo - shape.holdFrom);
  let moving = found.relax - shape.entry - (shape.holdTo - shape.holdFrom);
  if (shape.hold <= 0) {
    left = found.strokeEnd - shape.entry;
    moving = left;
  }
  left += drag(moving, shape.tempo);
  return Math.min(shape.length, left + Math.max(action.timing.blendOut, RETRACTION));
}

/**
 * Return whether one stroke may meet two requests.
 * @param {MetaRequest} request
 * @param {MetaRequest} other
 * @returns {boolean}
 */
export function mayShare(request, other) {
  if (request.stroke === null || other.stroke === null) {
    return false;
  }
  return request.action === null
    && other.action === null
    && request.kind === other.kind
    && (other.hold === null || other.hold === request.hold)
    && Math.abs(request.stroke - other.stroke) <= SHARED;
}

/**
 * Return whether an action fits a request that does not name one.
 * @param {Action} action
 * @param {MetaRequest} request
 * @returns {boolean}
 */
export function meets(action, request) {
  return request.tags.every((tag) => action.tags.includes(tag))
    && (request.limb === null || action.limb === request.limb)
    && (request.among.length === 0 || request.among.includes(action.id));
}

/**
 * Return the request of a meta action; for a remainder, with the duration that is left. What a model wrote has no duration.
 * @param {MetaAction} meta
 * @param {number} now
 * @returns {MetaRequest}
 */
export function remaining(meta, now) {
  const request = meta.request;
  if (request.duration === null || (meta.part === 0 && !meta.written)) {
    return request;
  }
  return but(request, { duration: meta.written ? null : Math.max(0, meta.end - now) });
}
