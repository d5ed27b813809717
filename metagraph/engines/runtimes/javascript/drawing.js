/**
 * The draw of one action among the candidates that did not play too recently (Borer et al., section 6.2).
 *
 * Translated from metagraph/playback/planning/drawing.py; change that, and translate anew.
 */

import { pick } from "./choice.js";
import { weighVariety } from "./directing.js";
import { favour } from "./mood.js";
import { node, rested } from "./remembering.js";
import { measureVigour } from "./vigour.js";
import { maxOf } from "./basics.js";

/**
 * Draw with p_k ~ likelihood_k / max(c_k, 1), times the factors of mood and variety. Actions used too recently are left out
 * as long as others are left.
 * @param {LayerState} state
 * @param {Action[]} candidates
 * @param {string} key
 * @param {number} now
 * @param {Mood} mood
 * @returns {Action}
 */
export function drawAction(state, candidates, key, now, mood) {
  const left = keepSpaced(state, candidates);
  if (left.length === 1) {
    return left[0];
  }
  const neutral = mood.neutral;
  const weights = new Map();
  for (const a of left) {
    const favoured = neutral ? 1 : favour(mood, a.tags, measureVigour(state.project, a));
    const weight = a.likelihood / Math.max(countUses(state, a.id, now), 1) * favoured;
    weights.set(a.id, weight * weighVariety(state, a, now));
  }
  if (![...weights.values()].some((w) => w > 0)) {
    return left[0];
  }
  const chosen = pick(state.seed, key, "action", weights);
  return left.find((a) => a.id === chosen);
}

/**
 * Leave out actions that need more other actions before they play again. If nothing is left, all need one less, and so on.
 * @param {LayerState} state
 * @param {Action[]} candidates
 * @returns {Action[]}
 */
export function keepSpaced(state, candidates) {
  const default_ = state.project.settings.neverTwice ? 1 : 0;
  const first = candidates[0];
  const before = state.recent.get(node(first.stance, first.kind)) ?? [];
  if (candidates.length < 2 || before.length === 0) {
    return candidates;
  }
  const needs = new Map(candidates.map((a) => [a.id, a.spacing === null ? default_ : a.spacing]));
  for (let less = 0; less < maxOf(candidates.map((a) => needs.get(a.id))) + 1; less++) {
    const left = candidates.filter((a) => rested(before, a.id, needs.get(a.id) - less));
    if (left.length > 0) {
      return left;
    }
  }
  return candidates;
}

/**
 * Return c_k of section 6.2, alpha times the uses, over the settings' memory.
 * @param {LayerState} state
 * @param {string} ident
 * @param {number} now
 * @returns {number}
 */
export function countUses(state, ident, now) {
  const memory = state.project.settings.memory;
  const alpha = state.project.settings.alpha;
  if (memory <= 0) {
    return alpha * (state.uses.get(ident) ?? 0);
  }
  let used = 0;
  for (const cue of [...state.cues].reverse()) {
    if (cue.start < now - memory) {
      break;
    }
    if (cue.action.id === ident) {
      used += 1;
    }
  }
  return alpha * used;
}

/**
 * Return the time from which an action may be drawn again.
 * @param {LayerState} state
 * @param {Action} action
 * @returns {number}
 */
export function findCooled(state, action) {
  if (action.cooldown > 0 && state.ended.has(action.id)) {
    return state.ended.get(action.id) + action.cooldown;
  }
  return -Infinity;
}
