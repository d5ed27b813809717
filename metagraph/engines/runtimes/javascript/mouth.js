/**
 * The mouth over time: from pieces of speech, each with one mouth shape, to smooth weights of all shapes.
 *
 * Coarticulation after Cohen and Massaro (1993): every piece rules the mouth around its own time, begins before it is heard
 * and lingers after it; what the mouth shows is the mean of all pieces weighted by how much each rules. Lips that must meet
 * rule more than a tongue nobody sees.
 *
 * Translated from metagraph/playback/life/mouth.py; change that, and translate anew.
 */

import { VISEMES } from "./words.js";
import { range, sorted, sortedBy, sum } from "./basics.js";

// How much each of VISEMES rules its neighbours: closed lips and teeth on the lip must be seen, tongue and
// palate need not.
export const RULE = [0.8, 6, 4, 1, 0.7, 0.5, 1.6, 1.2, 0.7, 0.9, 1.5, 1.3, 1.2, 1.7, 1.9];
export const EARLY = 0.075; // seconds over which a shape comes before its sound begins
export const LATE = 0.065; // and goes after it ends
export const STEP = 0.02; // seconds between the rows of a track
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
 * Return rows `[K][15]` of the shapes' weights, summing to 1; shut at both ends. Their times are evenly spaced from 0 to the
 * duration, at least 1 ms.
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
  for (const piece of pieces) {
    const place = VISEMES.indexOf(piece.viseme);
    // Short sounds are not left out: their ramps overlap and still reach the top in the middle.
    const inside = Math.min(0.5 * (piece.end - piece.start), 0.04);
    const first = Math.max(0, Math.ceil((piece.start - EARLY) / step));
    for (let k = first; k < Math.min(count, Math.ceil((piece.end + LATE) / step)); k++) {
      const rise = _ease((k * step - piece.start + EARLY) / (EARLY + inside));
      const fall = _ease((piece.end + LATE - k * step) / (LATE + inside));
      const here = Math.min(rise, fall);
      made[k] += here;
      rows[k][place] += here * RULE[place] * piece.strength;
      rows[k][0] += here * RULE[place] * (1 - piece.strength);
    }
  }
  const out = [rest()];
  for (let k = 1; k < count - 1; k++) {
    rows[k][0] += LEAST + RULE[0] * Math.max(1 - made[k], 0); // where no sound rules, rest does
    const whole = sum(rows[k]);
    out.push(rows[k].map((weight) => weight / whole));
  }
  out.push(rest());
  return out;
}

/**
 * Return the weights of a shut mouth.
 * @returns {number[]}
 */
export function rest() {
  return range(VISEMES.length).map((n) => n === 0 ? 1 : 0);
}

/**
 * Return the times of stressed syllables: the first peak, then the strongest that have no stronger one within `ACCENT`
 * seconds. People blink and gesture on these, not on every syllable.
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
