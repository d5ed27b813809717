/** Which shape the mouth has: the voices of what is said, at any time. */

import { begunBy } from "../basics.js";
import { findLineStart } from "../items.js";
import { soften } from "../mouth.js";
import { VISEMES } from "../words.js";
import { ease } from "../rotation.js";

const CLOSING = 0.12; // seconds the mouth takes to close where speech was cut
const COUNT = VISEMES.length;

/**
 * Add to `out [14]` how much of each shape but silence the mouth shows at a time; return whether anything is said.
 * @param {import("../graph.js").Graph} graph @param {object[]} speeches @param {number} time @param {Float64Array} out
 */
export function mouthAt(graph, speeches, time, out) {
  const smoothing = graph.life.lipSmoothing;
  let said = false;
  for (let n = begunBy(speeches, time + smoothing) - 1; n >= 0; n--) {
    const speech = speeches[n];
    if (speech.end + CLOSING + smoothing <= time) break;
    if (time <= speech.start - smoothing) continue;
    const voice = graph.voiceOf(speech);
    said = true;
    const now = shownOf(voice, speech, time);
    const shown = [...now];
    if (smoothing > 0) soften(shown, shownOf(voice, speech, time - smoothing), now, shownOf(voice, speech, time + smoothing));
    for (let k = 0; k < COUNT - 1; k++) out[k] += shown[k];
  }
  let sum = 0;
  for (let k = 0; k < COUNT - 1; k++) sum += out[k];
  if (sum > 1) for (let k = 0; k < COUNT - 1; k++) out[k] /= sum; // two speeches may meet; together they are one mouth
  return said;
}

function shownOf(voice, speech, time) {
  const out = new Array(COUNT - 1).fill(0);
  if (time < speech.start) return out;
  const kept = 1 - ease((time - speech.end) / CLOSING);
  const { weights } = voice;
  const last = weights.length / COUNT - 1;
  const at = ((Math.min(time, speech.end) - findLineStart(speech)) / Math.max(voice.duration, 1e-3)) * last;
  const low = Math.min(Math.max(Math.floor(at), 0), last - 1);
  const part = Math.min(Math.max(at - low, 0), 1);
  for (let k = 1, a = low * COUNT + 1; k < COUNT; k++, a++) out[k - 1] = kept * (weights[a] * (1 - part) + weights[a + COUNT] * part);
  return out;
}
