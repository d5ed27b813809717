/**
 * How a running action is left early: for a request that can then be in time, or because it was stopped.
 *
 * Translated from metagraph/playback/planning/leaving.py; change that, and translate anew.
 */

import { begins } from "./bounds.js";
import { CueShape, FITS, RETRACTION, STOPPED, hurried, slackOf } from "./cue_shapes.js";
import { findLatest } from "./punctuality.js";
import { but } from "./basics.js";

/**
 * Leave the running action early for the first request that can then be in time, or if it was `stopped`. An action that a
 * model wrote, or that is less important, is left at once; others are left where their retraction begins.
 * @param {LayerState} state
 * @param {?MetaAction} running
 * @param {MetaAction[]} asked
 * @param {number} now
 * @param {boolean} stopped
 */
export function makeWay(state, running, asked, now, stopped) {
  if (stopped) {
    retract(state, now);
    return;
  }
  const cue = state.cues[state.cues.length - 1];
  if (running === null || cue.action.kind === "transition" || cue.end - cue.blendOut <= now) {
    return;
  }
  const atOnce = now + Math.max(cue.blendOut, RETRACTION);
  let retracts = atOnce;
  if (!running.written) {
    let once = cue.end - cue.start;
    if (cue.repeats) {
      once = Math.min(once, (cue.cycleTo - cue.entry) / cue.tempo + Math.max(cue.blendOut, RETRACTION));
    }
    const shape = new CueShape(
      cue.start,
      cue.entry,
      cue.end - cue.start,
      once,
      cue.holdFrom,
      cue.holdTo,
      cue.hold,
      cue.tempo,
    );
    retracts = Math.max(atOnce, cue.start + hurried(state.project, cue.action, shape));
  }
  const rest = state.project.settings.rest;
  for (const meta of asked) {
    const request = meta.request;
    const inTime = findLatest(state, request) + slackOf(request);
    const soonest = meta.rank > running.rank ? atOnce : retracts;
    if (request.late === null || meta.rank < running.rank || inTime < soonest + rest - FITS) {
      continue;
    }
    const end = Math.max(soonest, begins(meta) - rest);
    if (end < cue.end) {
      const out = Math.max(cue.blendOut, RETRACTION);
      const into = Math.min(cue.blendIn, Math.max(0, end - out - cue.start));
      state.cues[state.cues.length - 1] = but(cue, { end: end, blendIn: into, blendOut: out });
      state.free = end;
      state.ended.set(cue.action.id, end);
    }
    return;
  }
}

/**
 * Leave the running action: it returns to its stance from where it is. A transition ends in the stance it leads to.
 * @param {LayerState} state
 * @param {number} now
 */
export function retract(state, now) {
  const cue = state.cues[state.cues.length - 1];
  const end = now + STOPPED;
  if (cue.action.kind === "transition" || cue.end - cue.blendOut <= now || cue.end <= end) {
    return;
  }
  state.cues[state.cues.length - 1] = but(cue, { end: end, blendOut: STOPPED });
  state.free = end;
  state.ended.set(cue.action.id, end);
}
