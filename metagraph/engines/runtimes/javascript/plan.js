/**
 * Plans: what the planner gives. Values, never changed once made; times are seconds.
 *
 * @typedef {import("./meta_plan.js").MetaRequest} Request
 * @typedef {import("./meta_plan.js").MetaAction} MetaAction
 * @typedef {import("./meta_plan.js").Report} Report
 * @typedef {import("./meta_plan.js").Cue} Cue
 * @typedef {import("./meta_plan.js").LayerPlan} LayerPlan
 * @typedef {{seed: number, end: number, layers: Record<string, LayerPlan>, reports: Report[], requests: Request[], track: import("./track.js").Track,
 *   life: ?import("./schedule.js").Schedule}} Plan
 */

import { cueSeconds } from "./cue_times.js";
import { LayerPlan } from "./meta_plan.js";
import { Track } from "./track.js";
import { LAYERS } from "./words.js";

/** Return a plan of nothing, up to 0 seconds. @param {number} seed 32 bits @returns {Plan} */
export function emptyPlan(seed) {
  const layers = Object.fromEntries(LAYERS.map((name) => [name, new LayerPlan(name)]));
  return { seed: seed >>> 0, end: 0, layers, reports: [], requests: [], track: new Track(), life: null };
}

/** What keys a meta action's random draws. @param {MetaAction} meta */
export const keyOf = (meta) => meta.key;

/** Return the clip seconds a cue shows at a time: its tempo, but for its hold; again and again what it repeats. @param {Cue} cue @param {number} time */
export function clipSeconds(cue, time) {
  if (cue.repeats) return cueSeconds(cue, time);
  const elapsed = time - cue.start;
  if (cue.hold <= 0) return cue.entry + elapsed * cue.tempo;
  const held = Math.min(Math.max(elapsed - (cue.holdFrom - cue.entry) / cue.tempo, 0), cue.hold);
  return cue.entry + (elapsed - held) * cue.tempo + held * ((cue.holdTo - cue.holdFrom) / cue.hold);
}
