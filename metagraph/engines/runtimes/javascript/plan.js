/**
 * Plans: what the planner gives. Values, never changed once made; times are seconds.
 *
 * @typedef {import("./meta_plan.js").MetaRequest} Request
 * @typedef {import("./meta_plan.js").MetaAction} MetaAction
 * @typedef {import("./meta_plan.js").Report} Report
 * @typedef {import("./meta_plan.js").Cue} Cue
 * @typedef {import("./meta_plan.js").LayerPlan} LayerPlan
 * @typedef {{seed: number, end: number, layers: Record<string, LayerPlan>, reports: Report[], requests: Request[], track: object,
 *   life: object}} Plan
 */

import { emptySchedule } from "./life/schedule.js";
import { emptyTrack } from "./life/track.js";
import { LayerPlan, MetaRequest } from "./meta_plan.js";
import { LAYERS } from "./words.js";

/** Return what is asked for, by the names of its fields. @returns {Request} */
export function makeRequest(fields) {
  return Object.assign(new MetaRequest(fields.id, fields.layer, fields.kind, fields.start), fields);
}

/** Return a plan of nothing, up to 0 seconds. @param {number} seed 32 bits @returns {Plan} */
export function emptyPlan(seed) {
  const layers = Object.fromEntries(LAYERS.map((name) => [name, new LayerPlan(name)]));
  return { seed: seed >>> 0, end: 0, layers, reports: [], requests: [], track: emptyTrack(), life: emptySchedule() };
}

/** What keys a meta action's random draws. @param {MetaAction} meta */
export const keyOf = (meta) => meta.key;

/** Return the clip seconds a cue shows at a time: its own speed, but for its hold. @param {Cue} cue @param {number} time */
export function clipSeconds(cue, time) {
  const elapsed = time - cue.start;
  if (cue.hold <= 0) return cue.entry + elapsed;
  const held = Math.min(Math.max(elapsed - (cue.holdFrom - cue.entry), 0), cue.hold);
  return cue.entry + elapsed - held + held * ((cue.holdTo - cue.holdFrom) / cue.hold);
}
