/**
 * Keyed randomness: every draw is a hash of (seed, key, purpose), in 32-bit integers that any language mixes in the same
 * way.
 *
 * Draws remember nothing, so a change of one request does not change the draws of the others.
 *
 * Translated from metagraph/playback/planning/choice.py; change that, and translate anew.
 */

import { absorb, begun, mix } from "./hashing.js";
import { compareText } from "./basics.js";

export const ALL = 4294967296; // numbers of 32 bits

/**
 * Return the 32-bit hash of a seed and words: FNV-1a over their UTF-8 bytes, each word closed by a zero byte, then mixed.
 *
 * The mixed seed is xored into FNV's offset basis.
 * @param {number} seed
 * @param {...string} words
 * @returns {number}
 */
export function key32(seed, ...words) {
  return mix(keyed(seed, ...words));
}

/**
 * Return the hash of a seed and words before it is mixed, which all draws of one key share.
 * @param {number} seed
 * @param {...string} words
 * @returns {number}
 */
export function keyed(seed, ...words) {
  let value = begun(seed);
  for (const word of words) {
    value = absorb(value, word);
  }
  return value;
}

/**
 * Return a number in the open interval (0, 1).
 * @param {number} seed
 * @param {...string} words
 * @returns {number}
 */
export function uniform(seed, ...words) {
  return (mix(keyed(seed, ...words)) + 0.5) / ALL;
}

/**
 * Return the number that `uniform` returns for a key and one more word.
 * @param {number} key
 * @param {string} purpose
 * @returns {number}
 */
export function chanceOf(key, purpose) {
  return (mix(absorb(key, purpose)) + 0.5) / ALL;
}

/**
 * Return a log-normal number from two uniform ones in (0, 1) by Box and Muller, in a way that any language can compute: `a =
 * ln(1 + (s / m)^2)`, `z = sqrt(-2 ln u) cos(2 pi v)`, `m exp(sqrt(a) z - a / 2)`.
 * @param {number} mean
 * @param {number} deviation
 * @param {number} u
 * @param {number} v
 * @returns {number}
 */
export function logNormal(mean, deviation, u, v) {
  const share = deviation / mean;
  const spread = Math.log1p(share * share);
  const z = Math.sqrt(-2 * Math.log(u)) * Math.cos(2 * Math.PI * v);
  return mean * Math.exp(Math.sqrt(spread) * z - spread / 2);
}

/**
 * Return one of the ids, chosen as by `picked`.
 * @param {number} seed
 * @param {string} key
 * @param {string} purpose
 * @param {Map<string, number>} weights
 * @returns {string}
 */
export function pick(seed, key, purpose, weights) {
  return picked(keyed(seed, key), purpose, weights);
}

/**
 * Return one of the ids, id k with probability weight_k / sum.
 *
 * Each id draws its own exponential time, -log(u_k) / weight_k, and the shortest wins. So adding or removing a candidate
 * changes the choice only if that candidate wins. Raises ValueError when no weight is positive.
 * @param {number} key
 * @param {string} purpose
 * @param {Map<string, number>} weights
 * @returns {string}
 */
export function picked(key, purpose, weights) {
  let best = "";
  let shortest = Infinity;
  const start = absorb(key, purpose);
  for (const { 0: ident, 1: weight } of weights) {
    if (weight > 0) {
      const time = -Math.log((mix(absorb(start, ident)) + 0.5) / ALL) / weight;
      if (time < shortest || (time === shortest && compareText(ident, best) < 0)) {
        best = ident;
        shortest = time;
      }
    }
  }
  if (best === "") {
    throw new Error("nothing to choose from");
  }
  return best;
}
