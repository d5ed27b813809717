/** What translated modules need of the language: texts, lists, and places in them. */

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

/** Return how many of ascending numbers are at most `value`. */
export const bisectRight = (list, value) => bisect(list, value, true);

/** Compare keys, which are numbers, texts or lists of them. @returns {number} below, above or 0 */
export function compareKeys(a, b) {
  if (typeof a === "string") return compareText(a, b);
  if (!Array.isArray(a)) return a - b || 0;
  for (let n = 0; n < a.length; n++) {
    // Infinities that are alike differ by no number.
    const order = a[n] === b[n] ? 0 : compareKeys(a[n], b[n]);
    if (order) return order;
  }
  return 0;
}

/** Return items by what a key gives; those alike stay as they were. */
export function sortedBy(items, key) {
  const keyed = Array.from(items, (item) => [key(item), item]);
  return keyed.sort((a, b) => compareKeys(a[0], b[0])).map(([, item]) => item);
}

/** Put an item into an ordered list, from place `low` on, behind those alike. */
export function insort(list, item, low, key) {
  const own = key(item);
  let first = low;
  let last = list.length;
  while (first < last) {
    const middle = (first + last) >> 1;
    if (compareKeys(own, key(list[middle])) < 0) last = middle;
    else first = middle + 1;
  }
  list.splice(first, 0, item);
}

/** Return a record with some fields changed. */
export function but(record, changes) {
  return Object.assign(Object.create(Object.getPrototypeOf(record)), record, changes);
}

/** Return the words of a text. */
export const splitWords = (text) => text.split(/\s+/).filter((word) => word.length > 0);

/** Return a text before the last of another, that, and what is behind it; nothing of the first two where it has none. */
export function partedLast(text, by) {
  const place = text.lastIndexOf(by);
  return place < 0 ? ["", "", text] : [text.slice(0, place), by, text.slice(place + by.length)];
}

/** Return whether a text is digits alone. */
export const isDigits = (text) => /^[0-9]+$/.test(text);

/** Return pairs of the items at the same places of two lists. */
export const zip = (a, b) => a.map((item, n) => [item, b[n]]);

/** Return how many of ascending numbers are below `value`. */
export const bisectLeft = (list, value) => bisect(list, value, false);

/** Return the largest of some numbers, or `other` of none. */
export const maxOf = (items, other) => (items.length ? items.reduce((a, b) => (b > a ? b : a)) : other);

/** Return the smallest of some numbers, or `other` of none. */
export const minOf = (items, other) => (items.length ? items.reduce((a, b) => (b < a ? b : a)) : other);

/** Return the sum of some numbers. */
export const sum = (items) => items.reduce((a, b) => a + b, 0);

/** Return what is left of a division, as far above a multiple of `b`. */
export const modulo = (a, b) => a - b * Math.floor(a / b);

/** Return the whole numbers from `first` to before `last`, or from 0. @returns {number[]} */
export function range(first, last) {
  const [low, high] = last === undefined ? [0, first] : [first, last];
  return Array.from({ length: Math.max(0, high - low) }, (_, n) => low + n);
}

/** Return numbers, texts or lists of them in order. */
export const sorted = (items) => [...items].sort(compareKeys);

/** Return seconds with three decimals, halves to even: `toFixed` rounds them up, and this text keys a draw. */
export function thousandths(seconds) {
  const halves = (seconds * 16) % 2 === 1 || (seconds * 16) % 2 === -1; // only odd sixteenths lie midway
  const low = Math.floor(seconds * 1000);
  return halves && low % 2 === 0 ? (low / 1000).toFixed(3) : seconds.toFixed(3);
}
