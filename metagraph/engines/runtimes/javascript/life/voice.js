/** What is known of a spoken line's sound: how long it is, where it is stressed, and which mouth shapes it goes through. */

import { ALPHABET } from "../alphabet.js";
import { readAloud, spelled } from "../graphemes.js";
import { accentsOf, mouthTrack } from "../mouth.js";
import { inRange } from "../words.js";

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
  const { pieces, peaks, strengths } = spelled(ALPHABET, text, length);
  const rows = mouthTrack(pieces, pieces.length ? length : 0);
  return { duration: length, accents: accentsOf(peaks, strengths), weights: Float32Array.from(rows.flat()) };
}

/** Returns the voice of something said: its line's as read from the sound, else one guessed from its text; guesses are remembered. */
export class Voices {
  /** @param {Record<string, object>} data of the export */
  constructor(data = {}) {
    this.known = new Map(Object.entries(data).map(([line, voice]) => [line, readVoice(voice, `voices.${line}`)]));
    this.guessed = new WeakMap();
  }

  /** @returns {Voice} */
  of(speech) {
    const known = speech.line === null ? undefined : this.known.get(speech.line);
    if (known) return known;
    let guess = this.guessed.get(speech);
    if (!guess) {
      guess = voiceFromText(speech.text, Math.max(0, speech.length ?? speech.end - speech.start));
      this.guessed.set(speech, guess);
    }
    return guess;
  }
}
