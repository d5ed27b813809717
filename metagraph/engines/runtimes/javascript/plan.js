/**
 * Requests, meta actions and plans: what the planner takes and gives. Values, never changed once made; times are seconds.
 *
 * @typedef {import("./meta_plan.js").MetaRequest} Request
 * @typedef {import("./meta_plan.js").MetaAction} MetaAction
 * @typedef {import("./meta_plan.js").Report} Report
 * @typedef {{action: object, start: number, end: number, entry: number, blendIn: number, blendOut: number, stance: string,
 *   then: string, meta: string, holdFrom: number, holdTo: number, hold: number}} Cue one action in the plan; `entry`, `holdFrom`
 *   and `holdTo` are clip seconds. `stance`: before it, `then`: after it. `meta`: key of the meta action it realises.
 * @typedef {{stance: string, action: object, start: number, fadeStart: number, fade: number}} Rest the stance loop under the
 *   cues from `start` on; when and for how many seconds it takes over from the loop before.
 * @typedef {{layer: string, metas: MetaAction[], cues: Cue[], rests: Rest[], past: object, cursor: object, written: MetaAction[]}}
 *   LayerPlan cues never overlap and ascend. `past`: what planning needs of forgotten cues. `cursor`: where the model writes on.
 * @typedef {{seed: number, end: number, layers: Record<string, LayerPlan>, reports: Report[], requests: Request[], track: object,
 *   life: object}} Plan
 */

import { emptySchedule } from "./life/schedule.js";
import { emptyTrack } from "./life/track.js";
import { BEGIN } from "./markov.js";
import { MetaRequest } from "./meta_plan.js";
import { LAYERS } from "./words.js";

export const TEMPORAL = new Set(["late", "cut", "resumed", "past"]); // outcomes that temporal replanning tells, once

/** Return what is asked for, by the names of its fields. @returns {Request} */
export function makeRequest(fields) {
  return Object.assign(new MetaRequest(fields.id, fields.layer, fields.kind, fields.start), fields);
}

/** What planning on needs of cues that were forgotten: when the last ended, in which stance, and how actions were used. */
const noPast = () => ({ free: 0, stance: "", uses: new Map(), recent: new Map(), ended: new Map() });

/** Return a plan of nothing, up to 0 seconds. @param {number} seed 32 bits @returns {Plan} */
export function emptyPlan(seed) {
  const layer = (name) => ({
    layer: name, metas: [], cues: [], rests: [], past: noPast(), cursor: BEGIN, written: [],
  });
  const layers = Object.fromEntries(LAYERS.map((name) => [name, layer(name)]));
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

/** Return a time as reports say it. @param {number} seconds */
export const s = (seconds) => `${seconds.toFixed(2)} s`;

export const REMEMBERED = 32; // draws of a stance and kind that spacing can look back on
export const nodeOf = (stance, kind) => `${kind} ${stance}`;

/** Note that a cue was played: how often its action was, lately, and until when. Changes the maps of `past`. */
export function remember(cue, past) {
  const { id, kind } = cue.action;
  const node = nodeOf(cue.stance, kind);
  past.uses.set(id, (past.uses.get(id) ?? 0) + 1);
  past.recent.set(node, [...(past.recent.get(node) ?? []).slice(1 - REMEMBERED), id]);
  past.ended.set(id, cue.end);
}
