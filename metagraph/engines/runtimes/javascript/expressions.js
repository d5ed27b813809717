/**
 * Small events of the face: drawn with the other life layers, shown by `shown_face`, `answer` and `settle`.
 *
 * What is known and followed here: speakers raise their brows on stressed words (Cave et al. 1996), from about 60 ms before
 * the accent (Flecha-Garcia 2010), and where they ask (Ekman 1979); greeting, people flash their brows for about a third of
 * a second (Eibl-Eibesfeldt 1972); felt smiles come and go in 2/3 to 4 s and raise the cheeks (Ekman and Friesen 1982),
 * posed ones may stay. So the face of a mood rises and falls back to a part of it, instead of being constant. How much, how
 * often and for which tags is ours.
 *
 * If `Life.expressions` is 0, or at full stillness, the face of a mood is constant and nothing else is added.
 *
 * Translated from metagraph/playback/life/expressions.py; change that, and translate anew.
 */

import { findLineStart, measureLine } from "./items.js";
import { stressed } from "./voice.js";
import { chanceOf, keyed, uniform } from "./choice.js";
import { faded, within } from "./mood.js";
import { bisectRight, partedLast, sortedBy } from "./basics.js";

// Swells: how the face of a mood comes up; rows: length s, amount, 1 where the mode was listening.
export const SWELL_GAP = 3.5; // seconds between two, on average
export const SHORTEST_SWELL = 0.9;
export const LONGEST_SWELL = 4;
export const SWELL_RISES = 0.35; // of its length
export const KEPT = 0.75; // of a mood's face between swells
export const WARMTH = 0.35; // of a smile that a listener's swell is
// Emphases: brows raised in speech, and where somebody reacts to something; rows: length s, amount, rise s.
export const EARLY = 0.06; // seconds a raise begins before its syllable
export const RAISE = 0.35; // seconds it takes at least
export const RAISE_CHANCE = 0.3; // and what chance adds
export const RAISE_RISES = 0.12;
export const ASKING = 0.8; // seconds before the end of a question that its brows begin to rise, but in its second half
export const ASKING_ON = 0.5; // seconds they take to sink after it
export const ASKING_LIFTS = 0.8; // of a full raise
export const REACTING = 1.2; // seconds they take where a reaction begins
export const LONGEST_EMPHASIS = 1.5; // seconds
// Cues: what those with certain tags show.
export const CUE_RISES = 0.25; // seconds
export const CUE_LASTS = 1.8;
export const CUE_FALLS = 0.6;
export const FLASH_FROM = 0.1; // seconds after a greeting begins
export const FLASH_RISES = 0.08;
export const FLASH_LASTS = 0.4;
export const GREETING = "greeting";
// Of smile, frown, brow_down, brow_up, brows.
export const SHOWN = new Map([
  ["greeting", [0.6, 0, 0, 0, 0.1]],
  ["positive", [0.3, 0, 0, 0, 0.15]],
  ["agree", [0.1, 0, 0, 0, 0.1]],
  ["negative", [0, 0.2, 0.35, 0, 0]],
  ["surprise", [0, 0, 0, 0, 0.9]],
  ["question", [0, 0, 0, 0, 0.6]],
  ["unsure", [0, 0.3, 0, 0.2, 0.5]],
  ["thinking", [0, 0.1, 0.35, 0, 0]],
]);
export const MARKS = ["?", "？", "؟"]; // at the end of questions
export const DUCHENNE = 0.2; // the smile from which on cheeks rise

/**
 * The weights of a face's channels, without lids and lips. brow_up raises only the inner ends of the brows, brows the whole
 * of them. The same object is filled again for each time (`shown_face`, `answer`, `settle`).
 *
 * smile: number; frown: number; browDown: number; browUp: number; brows: number; cheeks: number.
 */
export class FaceShown {
  constructor(smile = 0, frown = 0, browDown = 0, browUp = 0, brows = 0, cheeks = 0) {
    this.smile = smile;
    this.frown = frown;
    this.browDown = browDown;
    this.browUp = browUp;
    this.brows = brows;
    this.cheeks = cheeks;
  }
}

/**
 * Return the lane of swells filled from `cut` to `drawn` seconds.
 * @param {Track} track
 * @param {number} seed
 * @param {number} cut
 * @param {number} drawn
 * @param {Lane} before
 * @returns {Lane}
 */
export function swellsOn(track, seed, cut, drawn, before) {
  const times = [];
  const rows = [];
  let number = before.next;
  let over = before.times.length > 0 ? before.times[before.times.length - 1] + before.rows[before.rows.length - 1][0] : 0;
  while (true) {
    const key = keyed(seed, "swell", String(number));
    const gap = SWELL_GAP * (0.3 + 1.4 * chanceOf(key, "gap"));
    const at = Math.max(cut, over + gap);
    if (at >= drawn) {
      return before.plus(times, rows);
    }
    let length = SHORTEST_SWELL;
    length += (LONGEST_SWELL - SHORTEST_SWELL) * chanceOf(key, "length");
    const amount = 0.6 + 0.4 * chanceOf(key, "amount");
    times.push(at);
    rows.push([length, amount, track.toldMode(at) === "listening" ? 1 : 0]);
    over = at + length;
    number += 1;
  }
}

/**
 * Return the lane of emphases filled from `cut` to `drawn` seconds: on the share of stressed syllables that `accent_brows`
 * says, at the end of questions, and where a reaction begins.
 * @param {Life} life
 * @param {Track} track
 * @param {Voices} voices
 * @param {number} seed
 * @param {number} cut
 * @param {number} drawn
 * @param {Lane} before
 * @returns {Lane}
 */
export function emphasesOn(life, track, voices, seed, cut, drawn, before) {
  const found = [];
  let chance;
  for (const speech of track.speeches) {
    if (speech.end <= cut || speech.start >= drawn) {
      continue;
    }
    let at;
    for (const { 0: n, 1: peak } of stressed(voices, speech).entries()) {
      const begin = findLineStart(speech);
      at = Math.max(speech.start, begin + peak - EARLY);
      if (at >= speech.end || begin + peak < speech.start) {
        continue;
      }
      if (uniform(seed, speech.id, "brows", String(n)) >= life.accentBrows) {
        continue;
      }
      chance = uniform(seed, speech.id, "raise", String(n));
      found.push([at, RAISE + RAISE_CHANCE * chance, 0.5 + 0.5 * chance, RAISE_RISES]);
    }
    if (asks(speech)) {
      const length = measureLine(speech);
      const lead = Math.min(ASKING, 0.5 * length);
      at = Math.max(speech.start, findLineStart(speech) + length - lead);
      if (at < speech.end) {
        found.push([at, lead + ASKING_ON, ASKING_LIFTS, lead]);
      }
    }
  }
  for (const change of track.modes) {
    if (change.mode === "reacting" && life.accentBrows > 0) {
      chance = uniform(seed, change.id, "raise");
      found.push([change.start, REACTING, 0.6 + 0.4 * chance, RAISE_RISES]);
    }
  }
  const times = [];
  const rows = [];
  for (const event of sortedBy(found, (x) => [x[0], x[3]])) {
    if (cut <= event[0] && event[0] < drawn) {
      times.push(event[0]);
      rows.push(event.slice(1));
    }
  }
  return before.plus(times, rows);
}

/**
 * Return whether a speech is a question, by its last sign.
 * @param {Speech} speech
 * @returns {boolean}
 */
export function asks(speech) {
  const text = speech.text.trim();
  return text !== "" && MARKS.some((mark) => partedLast(text, mark)[2] === "");
}

/**
 * Fill in the face at a time, from the mood and the drawn events.
 * @param {FaceShown} face
 * @param {Life} life
 * @param {Lane} swells
 * @param {Lane} emphases
 * @param {Bearing} bears
 * @param {number} seconds
 */
export function shownFace(face, life, swells, emphases, bears, seconds) {
  const calm = 1 - life.stillness;
  let swell = 0;
  let warm = 0;
  let n = bisectRight(swells.times, seconds) - 1;
  let length;
  let amount;
  let gone;
  let rise;
  if (n >= 0) {
    length = swells.rows[n][0];
    amount = swells.rows[n][1];
    const listens = swells.rows[n][2];
    gone = seconds - swells.times[n];
    rise = SWELL_RISES * length;
    swell = amount * faded(Math.min(gone / rise, (length - gone) / (length - rise)));
    warm = listens * swell;
  }
  const share = 1 - calm * Math.min(1, life.expressions) * (1 - KEPT) * (1 - swell);
  const much = calm * life.expressions;
  let brows = 0;
  n = bisectRight(emphases.times, seconds) - 1;
  while (n >= 0 && seconds - emphases.times[n] < LONGEST_EMPHASIS) {
    length = emphases.rows[n][0];
    amount = emphases.rows[n][1];
    rise = emphases.rows[n][2];
    gone = seconds - emphases.times[n];
    brows = Math.max(brows, amount * faded(Math.min(gone / rise, (length - gone) / (length - rise))));
    n -= 1;
  }
  face.smile = share * bears.smile + much * WARMTH * warm * (1 - bears.frown);
  face.frown = share * bears.frown;
  face.browDown = share * bears.browDown;
  face.browUp = share * bears.browUp;
  face.brows = share * bears.brows + much * brows;
}

/**
 * Add what a cue with these tags, from `start` to `end`, shows on a face at a time.
 * @param {FaceShown} face
 * @param {Life} life
 * @param {string[]} tags
 * @param {number} start
 * @param {number} end
 * @param {number} seconds
 */
export function answer(face, life, tags, start, end, seconds) {
  const much = (1 - life.stillness) * life.expressions;
  if (much <= 0 || seconds <= start || seconds >= Math.min(end, start + CUE_LASTS)) {
    return;
  }
  const gone = seconds - start;
  const shows = much * faded(Math.min(gone / CUE_RISES, (Math.min(end, start + CUE_LASTS) - seconds) / CUE_FALLS));
  for (const tag of tags) {
    if (SHOWN.has(tag)) {
      const of = SHOWN.get(tag);
      face.smile += shows * of[0];
      face.frown += shows * of[1];
      face.browDown += shows * of[2];
      face.browUp += shows * of[3];
      face.brows += shows * of[4];
    }
    if (tag === GREETING) {
      const flash = gone - FLASH_FROM;
      const left = FLASH_LASTS - flash;
      face.brows += much * faded(Math.min(flash / FLASH_RISES, left / (FLASH_LASTS - FLASH_RISES)));
    }
  }
}

/**
 * Clamp all weights to 0..1, and raise the cheeks with a smile.
 * @param {FaceShown} face
 */
export function settle(face) {
  face.smile = within(face.smile, 0, 1);
  face.frown = within(face.frown, 0, 1);
  face.browDown = within(face.browDown, 0, 1);
  face.browUp = within(face.browUp, 0, 1);
  face.brows = within(face.brows, 0, 1);
  face.cheeks = within((face.smile - DUCHENNE) / (1 - DUCHENNE), 0, 1);
}
