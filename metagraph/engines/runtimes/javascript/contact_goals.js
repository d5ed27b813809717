/**
 * Find the goals that contacts set for the hands at a time: contacts of the cue that plays and of the loops under it, each
 * weighted by how much of it shows.
 *
 * Translated from metagraph/playback/posing/contact_goals.py; change that, and translate anew.
 */

import { HandGoal } from "./contact_solve.js";
import { HANDS, contactKey, contactWeight } from "./contact_spans.js";
import { cueSeconds, cueWeight, ease, seamLeft } from "./cue_times.js";

export const LEAST = 1e-06; // of a hand: goals with less weight are not solved

/**
 * Return a layer's goals for the hands at a time.
 *
 * `cue` is the one that plays, if it has motion. `place` is the index of the rest in force, -1 for none. `strength` is how
 * much of the arms the layer moves, 0..1.
 * @param {ContactRig} rig
 * @param {Project} project
 * @param {LayerPlan} plan
 * @param {?Cue} cue
 * @param {number} place
 * @param {number} time
 * @param {number} strength
 * @returns {HandGoal[]}
 */
export function layerGoals(rig, project, plan, cue, place, time, strength) {
  const out = [];
  const shown = [0, 0];
  if (cue !== null) {
    const weight = cueWeight(cue, time);
    for (const { 0: arm, 1: hand } of HANDS.entries()) {
      if (_moves(rig, cue.action, arm, hand)) {
        shown[arm] = weight;
      }
    }
    if (cue.action.contacts.length > 0) {
      const left = seamLeft(cue, time);
      if (left > 0) { // the goals at the end of the previous cycle, as far as its pose still shows
        out.push(..._goals(rig, project, cue.action, cue.cycleTo, shown.map((w) => strength * left * w)));
      }
      const share = strength * (1 - left);
      out.push(..._goals(rig, project, cue.action, cueSeconds(cue, time), shown.map((w) => share * w)));
    }
  }
  if (place >= 0) {
    const rest = plan.rests[place];
    let over = 1;
    if (place > 0 && rest.fadeStart + rest.fade > time) {
      over = ease((time - rest.fadeStart) / rest.fade);
      out.push(..._loopGoals(rig, project, plan.rests[place - 1], time, strength * (1 - over), shown));
    }
    out.push(..._loopGoals(rig, project, rest, time, strength * over, shown));
  }
  return out;
}

/**
 * Return a loop's goals for the hands, reduced by the cue above it.
 * @param {ContactRig} rig
 * @param {Project} project
 * @param {Rest} rest
 * @param {number} time
 * @param {number} strength
 * @param {number[]} shown
 * @returns {HandGoal[]}
 */
function _loopGoals(rig, project, rest, time, strength, shown) {
  const out = [];
  const action = rest.action;
  if (action.contacts.length === 0) {
    return out;
  }
  const left = shown.map((w) => strength * (1 - w));
  const { 0: start, 1: end } = project.span(action);
  const seam = Math.min(Math.max(0, action.timing.blendIn), (end - start) / 2);
  const period = end - start - seam;
  if (period <= 0) {
    return _goals(rig, project, action, start, left);
  }
  const elapsed = time - rest.start;
  let phase = seam > 0 ? Math.max(elapsed, 0) : elapsed;
  phase = phase - period * Math.floor(phase / period);
  let old = 0;
  if (seam > 0 && elapsed >= period) {
    old = 1 - ease(phase / seam);
  }
  if (old > 0) {
    const before = start + Math.min(period + phase, end - start);
    out.push(..._goals(rig, project, action, before, left.map((w) => old * w)));
  }
  out.push(..._goals(rig, project, action, start + phase, left.map((w) => (1 - old) * w)));
  return out;
}

/**
 * Return the goals of an action at a second of its clip. `shares` says how much of it shows at the left and the right hand.
 * @param {ContactRig} rig
 * @param {Project} project
 * @param {Action} action
 * @param {number} seconds
 * @param {number[]} shares
 * @returns {HandGoal[]}
 */
function _goals(rig, project, action, seconds, shares) {
  const out = [];
  const { 0: start, 1: end } = project.span(action);
  for (const span of action.contacts) {
    const arm = _arm(span);
    const to = rig.places.get(span.to) ?? null;
    if (to === null || span.keys.length === 0 || shares[arm] <= LEAST) {
      continue;
    }
    const weight = shares[arm] * contactWeight(span, seconds, start, end);
    if (weight > LEAST) {
      const key = contactKey(span, seconds);
      out.push(new HandGoal(arm, to, key.at, key.turn, weight));
    }
  }
  return out;
}

/**
 * @param {ContactSpan} span
 * @returns {number}
 */
function _arm(span) {
  return span.hand === "left" ? 0 : 1;
}

/**
 * Return whether an action moves a hand, instead of leaving it in the stance.
 * @param {ContactRig} rig
 * @param {Action} action
 * @param {number} arm
 * @param {string} hand
 * @returns {boolean}
 */
function _moves(rig, action, arm, hand) {
  if (!["both", hand].includes(action.limb)) {
    return false;
  }
  return action.joints.length === 0 || action.joints.includes(rig.hands[arm]);
}
