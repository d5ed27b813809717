/**
 * Requests, meta actions and plans: what the planner takes and gives. Values, never changed once made; times are seconds.
 *
 * @typedef {{id: string, layer: string, kind: string, start: number, duration: ?number, action: ?string, tags: string[],
 *   limb: ?string, stance: ?string, priority: number, resume: boolean, stroke: ?number, hold: ?number, prepare: boolean,
 *   among: string[]}} Request what is asked for. `duration`: how long the activity is wanted, null for one action. `stroke`: when
 *   a gesture's stroke should come. `among`: ids of the only actions it may be, any where empty.
 * @typedef {{request: Request, start: number, end: number, part: number, written: boolean}} MetaAction a request placed in
 *   time. `written`: by the Markov model. `part`: 0 for the request itself, n for its n-th remainder after a cut.
 * @typedef {{action: object, start: number, end: number, entry: number, blendIn: number, blendOut: number, stance: string,
 *   then: string, meta: string, holdFrom: number, holdTo: number, hold: number}} Cue one action in the plan; `entry`, `holdFrom`
 *   and `holdTo` are clip seconds. `stance`: before it, `then`: after it. `meta`: key of the meta action it realises.
 * @typedef {{stance: string, action: object, start: number, fadeStart: number, fade: number}} Rest the stance loop under the
 *   cues from `start` on; when and for how many seconds it takes over from the loop before.
 * @typedef {{request: string, outcome: string, message: string, layer: string, at: number, played: boolean, written: boolean}} Report
 * @typedef {{layer: string, metas: MetaAction[], cues: Cue[], rests: Rest[], past: object, cursor: object, written: MetaAction[]}}
 *   LayerPlan cues never overlap and ascend. `past`: what planning needs of forgotten cues. `cursor`: where the model writes on.
 * @typedef {{seed: number, end: number, layers: Record<string, LayerPlan>, reports: Report[], requests: Request[], track: object,
 *   life: object}} Plan
 */

import { emptySchedule } from "./life/schedule.js";
import { emptyTrack } from "./life/track.js";
import { LAYERS } from "./words.js";

export const ASKED = 1; // default priority of a request
export const WRITTEN = 0; // priority of what the Markov model writes
export const TEMPORAL = new Set(["late", "cut", "resumed", "past"]); // outcomes that temporal replanning tells, once

/** @returns {Request} */
export function makeRequest(fields) {
  return {
    duration: null, action: null, tags: [], limb: null, stance: null, priority: ASKED, resume: false, stroke: null, hold: null,
    prepare: true, among: [], ...fields,
  };
}

/** What planning on needs of cues that were forgotten: when the last ended, in which stance, and how actions were used. */
const noPast = () => ({ free: 0, stance: "", uses: new Map(), recent: new Map(), ended: new Map() });

/** Return a plan of nothing, up to 0 seconds. @param {number} seed 32 bits @returns {Plan} */
export function emptyPlan(seed) {
  const layer = (name) => ({
    layer: name, metas: [], cues: [], rests: [], past: noPast(), cursor: { number: 0, state: -1, time: 0 }, written: [],
  });
  const layers = Object.fromEntries(LAYERS.map((name) => [name, layer(name)]));
  return { seed: seed >>> 0, end: 0, layers, reports: [], requests: [], track: emptyTrack(), life: emptySchedule() };
}

/** What keys a meta action's random draws. @param {MetaAction} meta */
export const keyOf = (meta) => (meta.part === 0 ? meta.request.id : `${meta.request.id}+${meta.part}`);

/** How important it is: what a model wrote gives way to all that is asked for. @param {MetaAction} meta */
export const rankOf = (meta) => (meta.written ? -Infinity : meta.request.priority);

/** Return the clip seconds a cue shows at a time: its own speed, but for its hold. @param {Cue} cue @param {number} time */
export function clipSeconds(cue, time) {
  const elapsed = time - cue.start;
  if (cue.hold <= 0) return cue.entry + elapsed;
  const held = Math.min(Math.max(elapsed - (cue.holdFrom - cue.entry), 0), cue.hold);
  return cue.entry + elapsed - held + held * ((cue.holdTo - cue.holdFrom) / cue.hold);
}

/** @returns {Report} */
export function report(meta, outcome, message, played = false) {
  const { request, start, written } = meta;
  return { request: request.id, outcome, message, layer: request.layer, at: start, played, written };
}

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
