/**
 * The mouth over time: from pieces of speech, each with one mouth shape, to smooth weights of all shapes.
 *
 * Coarticulation after Cohen and Massaro (1993): every piece rules the mouth around its own time, begins before it is heard and
 * lingers after it; what the mouth shows is the mean of all pieces weighted by how much each rules.
 */

import { begunBy } from "../basics.js";
import { VISEMES } from "../words.js";
import { ease } from "./gaze.js";

// How much a shape rules its neighbours, in the order of VISEMES: closed lips must be seen, tongue and palate need not.
const RULE = [0.8, 6, 4, 1, 0.7, 0.5, 1.6, 1.2, 0.7, 0.9, 1.5, 1.3, 1.2, 1.7, 1.9];
const [EARLY, LATE] = [0.075, 0.065]; // seconds over which a shape comes before its sound begins and goes after it ends
const STEP = 1 / 50; // seconds between the keys of a track
const LEAST = 0.02; // how much rest rules everywhere
const CLOSING = 0.12; // seconds the mouth takes to close where speech was cut
const COUNT = VISEMES.length;

/** Return the weights `[K, 15]` of the shapes at evenly spaced times, summing to 1; shut at both ends. */
export function mouthTrack(pieces, duration) {
  const keys = Math.max(2, Math.ceil(duration / STEP) + 1);
  const step = Math.max(duration, 1e-3) / (keys - 1);
  const rule = new Float64Array(keys * COUNT);
  const made = new Float64Array(keys);
  for (const { start, end, viseme, strength } of pieces) {
    const place = VISEMES.indexOf(viseme);
    // Short sounds are not left out: their ramps overlap and still reach the top in the middle.
    const inside = Math.min(0.5 * (end - start), 0.04);
    for (let k = Math.max(0, Math.ceil((start - EARLY) / step)); k < keys && k * step < end + LATE; k++) {
      const here = Math.min(ease((k * step - start + EARLY) / (EARLY + inside)), ease((end + LATE - k * step) / (LATE + inside)));
      made[k] += here;
      rule[k * COUNT + place] += here * RULE[place] * strength;
      rule[k * COUNT] += here * RULE[place] * (1 - strength);
    }
  }
  const weights = new Float32Array(keys * COUNT);
  for (let k = 0; k < keys; k++) {
    const row = rule.subarray(k * COUNT, (k + 1) * COUNT);
    row[0] += LEAST + RULE[0] * Math.max(1 - made[k], 0); // where no sound rules, rest does
    if (k === 0 || k === keys - 1) row.fill(0).fill(1, 0, 1);
    const sum = row.reduce((a, b) => a + b);
    row.forEach((x, n) => (weights[k * COUNT + n] = x / sum));
  }
  return weights;
}

/**
 * Add to `out [14]` how much of each shape but silence the mouth shows at a time; return whether anything is said.
 * @param {import("../graph.js").Graph} graph @param {object[]} speeches @param {number} time @param {Float64Array} out
 */
export function mouthAt(graph, speeches, time, out) {
  const smoothing = graph.life.lip_smoothing;
  let said = false;
  for (let n = begunBy(speeches, time + smoothing) - 1; n >= 0; n--) {
    const speech = speeches[n];
    if (speech.end + CLOSING + smoothing <= time) break;
    if (time <= speech.start - smoothing) continue;
    const voice = graph.voiceOf(speech);
    said = true;
    // The weighted mean over `smoothing` seconds before and after.
    if (smoothing > 0) {
      addShown(voice, speech, time - smoothing, 0.25, out);
      addShown(voice, speech, time, 0.5, out);
      addShown(voice, speech, time + smoothing, 0.25, out);
    } else {
      addShown(voice, speech, time, 1, out);
    }
  }
  let sum = 0;
  for (let k = 0; k < COUNT - 1; k++) sum += out[k];
  if (sum > 1) for (let k = 0; k < COUNT - 1; k++) out[k] /= sum; // two speeches may meet; together they are one mouth
  return said;
}

function addShown(voice, speech, time, share, out) {
  if (time < speech.start) return;
  const kept = share * (1 - ease((time - speech.end) / CLOSING));
  const { weights } = voice;
  const last = weights.length / COUNT - 1;
  const at = ((Math.min(time, speech.end) - speech.start) / Math.max(voice.duration, 1e-3)) * last;
  const low = Math.min(Math.max(Math.floor(at), 0), last - 1);
  const part = Math.min(Math.max(at - low, 0), 1);
  for (let k = 1, a = low * COUNT + 1; k < COUNT; k++, a++) out[k - 1] += kept * (weights[a] * (1 - part) + weights[a + COUNT] * part);
}
