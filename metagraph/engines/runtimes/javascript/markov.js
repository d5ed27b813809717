/** The Markov model that performs when nobody asks for anything: a first-order chain over (limb, kind). */

import { pick, uniform } from "./choice.js";
import { WRITTEN, makeRequest } from "./plan.js";
import { MODES } from "./words.js";

/**
 * Return the meta actions that start before `until` seconds, from the cursor on, and the cursor before the first one left out.
 *
 * Each draw is keyed by the meta action's number, so a longer horizon only appends. kinds: what the graph has; states of other
 * kinds are passed over. A row of zeros starts again from any state.
 * @param {object} model @param {string} layer @param {number} seed @param {number} until @param {Set<string>} kinds
 * @param {{number: number, state: number, time: number}} cursor
 */
export function write(model, layer, seed, until, kinds, cursor) {
  let { number, state, time } = cursor;
  const open = model.states.map(([, kind]) => (kinds.has(kind) ? 1 : 0));
  const places = open.map((_, n) => String(n));
  const metas = [];
  while (open.some((x) => x > 0)) {
    const key = `auto/${layer}/${number}`;
    const start = time + model.gap * (0.35 + 1.3 * uniform(seed, key, "gap"));
    if (!(start < until)) break; // nor when it is no number
    const row = state >= 0 && state < open.length ? model.matrix[state].map((p, n) => p * open[n]) : open;
    state = Number(pick(seed, key, "state", places, row.some((p) => p > 0) ? row : open));
    const [limb, kind] = model.states[state];
    const seconds = lengthOf(model, state, seed, key);
    let tags = (model.tags[state] ?? "").split(/\s+/).filter(Boolean);
    if (kind === "gesture" && !model.tags.length) {
      const draw = uniform(seed, key, "tag");
      if (draw < model.positive) tags = ["positive"];
      else if (draw < model.positive + model.negative) tags = ["negative"];
    }
    const request = makeRequest({ id: key, layer, kind, start, duration: seconds, tags, limb, priority: WRITTEN });
    metas.push({ request, start, end: start + seconds, part: 0, written: true });
    number += 1;
    time = start + seconds;
  }
  return { metas, cursor: { number, state, time } };
}

/** Return how many seconds a meta action lasts: 1 to 3, evenly, where the model has no lengths, else log-normal (Box and Muller). */
function lengthOf(model, state, seed, key) {
  const u = uniform(seed, key, "length");
  if (!model.lengths.length) return 1 + 2 * u;
  const [mean, deviation] = model.lengths[state];
  const spread = Math.log1p((deviation / mean) ** 2);
  const z = Math.sqrt(-2 * Math.log(u)) * Math.cos(2 * Math.PI * uniform(seed, key, "length2"));
  return mean * Math.exp(Math.sqrt(spread) * z - spread / 2);
}

const PERFORMED = ["gesture", "fidget", "transition"]; // as in a row of `modes`

/** Whether something the model wrote is performed while somebody idles, listens or talks; null where that is not known. */
export function performs(model, seed, meta, mode) {
  const place = PERFORMED.indexOf(meta.request.kind);
  if (!model.modes.length || mode === null || place < 0) return true;
  const share = model.modes[MODES.indexOf(mode)][place];
  return share >= 1 || uniform(seed, meta.request.id, "mode") < share;
}
