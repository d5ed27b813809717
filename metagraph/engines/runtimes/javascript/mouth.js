/**
 * The mouth over time: turn pieces of speech, each with one mouth shape, into smooth weights of all shapes.
 *
 * Coarticulation after Cohen and Massaro (1993): every piece dominates the mouth around its own time, begins before it is
 * heard and lingers after it. The mouth shows the mean of all pieces, weighted by their dominance. A mean never closes a
 * mouth. So lips that meet (p, b, m) and teeth on the lip (f, v) are added on top (`_closed`): in their middle nothing else
 * shows, however quick the speech is. Lips round for a rounded vowel as soon as the consonants before it begin (look-ahead,
 * Henke 1966), at most a quarter of a second before it (Bell-Berti and Harris 1981 found it begin at about a fixed time
 * before the vowel). The numbers are ours.
 *
 * Translated from metagraph/playback/life/mouth.py; change that, and translate anew.
 */

import { VISEMES } from "./words.js";
import { range, sorted, sortedBy, sum } from "./basics.js";

// How much each of VISEMES rules its neighbours: tongue and palate need not be seen. What closes the mouth
// does not take part in the mean.
export const RULE = [0.8, 0, 0, 1, 0.7, 0.5, 1.6, 1.2, 0.7, 0.9, 1.5, 1.3, 1.2, 1.7, 1.9];
export const CLOSURES = ["PP", "FF"];
export const VOWELS = ["aa", "E", "I", "O", "U"];
export const ROUNDED = ["O", "U"];
export const EARLY = 0.075; // seconds over which a shape comes before its sound begins
export const LATE = 0.065; // and goes after it ends
export const STEP = 0.02; // seconds between the rows of a track
export const LOOK_AHEAD = 0.25; // seconds by which a rounded vowel may come before its sound
export const PAUSE = 0.03; // seconds without a sound that end a run of consonants
export const HELD = 0.02; // seconds before and after its middle that a closure lasts at least: a row on each side
export const SHUTTING = 0.09; // seconds it takes to close and to open again
export const PARTING = 0.03; // seconds one closure takes to make way for the other
export const LEAST = 0.02; // how much rest rules everywhere
export const ACCENT = 2; // seconds round a stressed syllable without another: blinks come as often as people's

/**
 * A sound from `start` to `end` seconds: its mouth shape and how fully it is made, 0..1.
 *
 * start: number; end: number; viseme: string; strength: number.
 */
export class MouthPiece {
  constructor(start, end, viseme, strength = 1) {
    this.start = start;
    this.end = end;
    this.viseme = viseme;
    this.strength = strength;
  }
}

/**
 * Return rows `[K][15]` of the shapes' weights, which sum to 1; the mouth is shut at both ends. Their times are evenly
 * spaced from 0 to the duration, at least 1 ms.
 * @param {MouthPiece[]} pieces
 * @param {number} duration
 * @returns {number[][]}
 */
export function mouthTrack(pieces, duration) {
  // as many for 0.88 s as languages that divide otherwise
  const count = Math.max(2, Math.ceil(duration / STEP - 1e-06) + 1);
  const step = Math.max(duration, 0.001) / (count - 1);
  const rows = range(count).map((row) => range(VISEMES.length).map((shape) => 0));
  const made = range(count).map((row) => 0);
  let begun = 0;
  let last = -1; // of a run of consonants; where the sound before ended
  for (const piece of pieces) {
    const place = VISEMES.indexOf(piece.viseme);
    if (piece.start - last > PAUSE) {
      begun = piece.start;
    }
    let early = EARLY;
    if (ROUNDED.includes(piece.viseme)) {
      early = Math.min(Math.max(piece.start - begun, EARLY), LOOK_AHEAD);
    }
    last = piece.end;
    if (VOWELS.includes(piece.viseme)) {
      begun = piece.end;
    }
    // Short sounds are not left out: their ramps overlap and still reach the top in the middle.
    const inside = Math.min(0.5 * (piece.end - piece.start), 0.04);
    const first = Math.max(0, Math.ceil((piece.start - early) / step));
    for (let k = first; k < Math.min(count, Math.ceil((piece.end + LATE) / step)); k++) {
      const rise = _ease((k * step - piece.start + early) / (early + inside));
      const fall = _ease((piece.end + LATE - k * step) / (LATE + inside));
      const here = Math.min(rise, fall);
      made[k] += here;
      rows[k][place] += here * RULE[place] * piece.strength;
      rows[k][0] += here * RULE[place] * (1 - piece.strength);
    }
  }
  const shut = CLOSURES.map((name) => _gates(pieces, name, count, step));
  const out = [rest()];
  for (let k = 1; k < count - 1; k++) {
    rows[k][0] += LEAST + RULE[0] * Math.max(1 - made[k], 0); // where no sound rules, rest does
    const whole = sum(rows[k]);
    out.push(_closed(rows[k].map((weight) => weight / whole), shut[0][k], shut[1][k]));
  }
  out.push(rest());
  return out;
}

/**
 * Return rows (how far a closure has progressed, how far it suppresses the other one), 0..1.
 * @param {MouthPiece[]} pieces
 * @param {string} viseme
 * @param {number} count
 * @param {number} step
 * @returns {[number, number][]}
 */
function _gates(pieces, viseme, count, step) {
  const out = range(count).map((row) => [0, 0]);
  for (const piece of pieces) {
    if (piece.viseme !== viseme) {
      continue;
    }
    const middle = 0.5 * (piece.start + piece.end);
    const held = Math.max(HELD, 0.5 * (piece.end - piece.start) - 0.01);
    const first = Math.max(0, Math.ceil((middle - held - SHUTTING) / step));
    for (let k = first; k < Math.min(count, Math.ceil((middle + held + SHUTTING) / step)); k++) {
      const away = Math.max(0, Math.abs(k * step - middle) - held);
      const wide = piece.strength * _ease(1 - away / SHUTTING);
      const narrow = piece.strength * _ease(1 - away / PARTING);
      out[k] = [Math.max(out[k][0], wide), Math.max(out[k][1], narrow)];
    }
  }
  return out;
}

/**
 * Return a row with the closures on top: they suppress the rest as far as they are closed.
 * @param {number[]} row
 * @param {[number, number]} lips
 * @param {[number, number]} teeth
 * @returns {number[]}
 */
function _closed(row, lips, teeth) {
  const most = Math.max(lips[0], teeth[0]);
  if (most <= 0) {
    return row;
  }
  let one = lips[0] * (1 - teeth[1]);
  let other = teeth[0] * (1 - lips[1]);
  if (one + other <= 0) {
    one = lips[0];
    other = teeth[0];
  }
  const out = row.map((weight) => (1 - most) * weight);
  out[1] += most * one / (one + other);
  out[2] += most * other / (one + other);
  return out;
}

/**
 * Write the shapes without silence `[14]`, smoothed over three moments. Shapes that close the mouth keep their present
 * weights, and the others share what is left: smoothing must not part lips that meet.
 * @param {number[]} out
 * @param {number[]} before
 * @param {number[]} now
 * @param {number[]} after
 */
export function soften(out, before, now, after) {
  for (let n = 0; n < out.length; n++) {
    out[n] = 0.25 * before[n] + 0.5 * now[n] + 0.25 * after[n];
  }
  const open = 1 - out[0] - out[1];
  out[0] = now[0];
  out[1] = now[1];
  const left = open > 1e-09 ? Math.max(0, 1 - out[0] - out[1]) / open : 0;
  for (let n = 2; n < out.length; n++) {
    out[n] *= Math.min(1, left);
  }
}

/**
 * Return the weights of a shut mouth.
 * @returns {number[]}
 */
export function rest() {
  return range(VISEMES.length).map((n) => n === 0 ? 1 : 0);
}

/**
 * Return the times of stressed syllables: the first peak, then those with no stronger one within `ACCENT` seconds. People
 * blink and gesture on these, not on every syllable.
 * @param {number[]} peaks
 * @param {number[]} strengths
 * @returns {number[]}
 */
export function accentsOf(peaks, strengths) {
  const taken = [];
  for (const i of sortedBy(range(peaks.length), (i) => [i === 0 ? 0 : 1, -strengths[i], peaks[i]])) {
    if (taken.every((t) => Math.abs(peaks[i] - t) >= ACCENT)) {
      taken.push(peaks[i]);
    }
  }
  return sorted(taken);
}

/**
 * @param {number} x
 * @returns {number}
 */
function _ease(x) {
  if (x <= 0) {
    return 0;
  }
  return x >= 1 ? 1 : x * x * (3 - 2 * x);
}
