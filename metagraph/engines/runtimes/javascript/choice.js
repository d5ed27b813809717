/**
 * Keyed randomness: every draw is a hash of (seed, words), in 32-bit integers. Nothing is remembered between draws, so
 * changing one request leaves the draws of all others as they were.
 */

const OFFSET = 0x811c9dc5; // FNV-1a's, 32 bits
const PRIME = 0x01000193;
const UTF8 = new TextEncoder();

/** Scramble 32 bits: two rounds of shift-xor and odd multiplication (MurmurHash3's finaliser). @param {number} value */
export function mix(value) {
  value ^= value >>> 16;
  value = Math.imul(value, 0x85ebca6b);
  value ^= value >>> 13;
  value = Math.imul(value, 0xc2b2ae35);
  return (value ^ (value >>> 16)) >>> 0;
}

/** FNV-1a over a word's UTF-8 bytes. */
function absorb(value, word) {
  let plain = value;
  for (let n = 0; n < word.length; n++) {
    const code = word.charCodeAt(n);
    if (code > 127) return close(UTF8.encode(word).reduce((x, byte) => Math.imul(x ^ byte, PRIME), value));
    plain = Math.imul(plain ^ code, PRIME);
  }
  return close(plain);
}

/** A zero byte closes every word, so that "ab", "" and "a", "b" differ. */
function close(value) {
  return Math.imul(value, PRIME);
}

function begin(seed, words) {
  return words.reduce(absorb, OFFSET ^ mix(seed));
}

/** Return the 32-bit hash of a seed and words. @param {number} seed @param {...string} words */
export function key32(seed, ...words) {
  return mix(begin(seed, words));
}

const unit = (hash) => (hash + 0.5) / 4294967296;

/** Return a number in the open interval (0, 1). @param {number} seed @param {...string} words */
export function uniform(seed, ...words) {
  return unit(mix(begin(seed, words)));
}

/**
 * Return one of the ids, id k with probability weight_k / sum; "" when no weight is positive.
 *
 * Each id runs its own race, the shortest of exponential times -log(u_k) / weight_k wins; so adding or removing one candidate
 * changes the choice only where that candidate wins.
 * @param {number} seed @param {string} key @param {string} purpose @param {string[]} ids @param {number[]} weights
 */
export function pick(seed, key, purpose, ids, weights) {
  const begun = begin(seed, [key, purpose]);
  let best = "";
  let shortest = Infinity;
  ids.forEach((id, n) => {
    if (!(weights[n] > 0)) return;
    const time = -Math.log(unit(mix(absorb(begun, id)))) / weights[n];
    if (time < shortest || (time === shortest && compareText(id, best) < 0)) [best, shortest] = [id, time];
  });
  return best;
}

/** Order texts by code points, as UTF-8 does; JavaScript's own order is that of UTF-16. @returns {number} below, above or 0 */
export function compareText(a, b) {
  const length = Math.min(a.length, b.length);
  for (let n = 0; n < length; n++) {
    const x = a.charCodeAt(n);
    const y = b.charCodeAt(n);
    if (x !== y) return rank(x) - rank(y);
  }
  return a.length - b.length;
}

/** Surrogates stand for what comes after all other units. */
const rank = (unit16) => (unit16 < 0xd800 ? unit16 : unit16 < 0xe000 ? unit16 + 0x2000 : unit16 - 0x800);

/** Return how many of an ascending list of numbers come before `value`; with `after`, also those equal to it. */
export function bisect(list, value, after) {
  let low = 0;
  let high = list.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    const x = list[middle];
    if (x < value || (after && x === value)) low = middle + 1;
    else high = middle;
  }
  return low;
}

/** Return how many of items that ascend by `start` begin before `time`, or with `after` no later. */
export function begunBy(items, time, after = true) {
  let low = 0;
  let high = items.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    const x = items[middle].start;
    if (x < time || (after && x === time)) low = middle + 1;
    else high = middle;
  }
  return low;
}
