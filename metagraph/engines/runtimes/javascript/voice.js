/** What is known of a spoken line's sound: how long it is, where it is stressed, and which mouth shapes it goes through. */

import { ALPHABET } from "./alphabet.js";
import { readAloud, spelled } from "./graphemes.js";
import { measureLine } from "./items.js";
import { timedSounds } from "./line_timing.js";
import { accentsOf, mouthTrack } from "./mouth.js";
import { inRange } from "./words.js";

/**
 * @typedef {{duration: number, accents: number[], weights: Float32Array}} Voice duration: seconds. accents: times of the stressed
 *   syllables. weights `[K, 15]`: how much of each of VISEMES the mouth shows, evenly spaced over 0..max(duration, 0.001).
 */

/** @returns {Voice} */
function readVoice({ duration, accents, weights }, where) {
  for (const x of [duration, ...accents]) inRange(x, 0, 1e9, where);
  return { duration, accents, weights: Float32Array.from(weights.flat(), (x) => inRange(x, 0, 1, where)) };
}

/** Return a voice guessed from letters alone. @param {string} text @param {?number} duration seconds @returns {Voice} */
export function voiceFromText(text, duration) {
  const length = duration === null ? readAloud(ALPHABET, text) : Math.max(duration, 0);
  return voiced(spelled(ALPHABET, text, length), length);
}

/** Return the voice of a line whose words and shapes are told with their times. @returns {Voice} */
function voiceFromTiming(timing, duration) {
  return voiced(timedSounds(ALPHABET, timing), duration);
}

function voiced({ pieces, peaks, strengths }, duration) {
  const rows = mouthTrack(pieces, pieces.length ? duration : 0);
  return { duration, accents: accentsOf(peaks, strengths), weights: Float32Array.from(rows.flat()) };
}

/**
 * Returns the voice of something said: as its words and shapes were told, as its line's was read from the sound, else one guessed from
 * its text; what was made is remembered.
 */
export class Voices {
  /** @param {Record<string, object>} data of the export */
  constructor(data = {}) {
    this.known = new Map(Object.entries(data).map(([line, voice]) => [line, readVoice(voice, `voices.${line}`)]));
    this.guessed = new WeakMap();
  }

  /** @returns {Voice} */
  of(speech) {
    if (speech.timing) return this.guess(speech, () => voiceFromTiming(speech.timing, measureLine(speech)));
    const known = speech.line === null ? undefined : this.known.get(speech.line);
    if (known) return known;
    return this.guess(speech, () => voiceFromText(speech.text, Math.max(0, measureLine(speech))));
  }

  guess(speech, made) {
    if (!this.guessed.has(speech)) this.guessed.set(speech, made());
    return this.guessed.get(speech);
  }
}

/** Return the times of the stressed syllables of something said. @param {Voices} voices */
export const stressed = (voices, speech) => voices.of(speech).accents;

/** Return whether lines sound the same. */
export const areSameVoices = (a, b) => a === b;
