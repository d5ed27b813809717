/** What is known of a spoken line's sound: how long it is, where it is stressed, and which mouth shapes it goes through. */

import { inRange } from "../words.js";
import { spelled } from "./letters.js";
import { mouthTrack } from "./mouth.js";

/**
 * @typedef {{duration: number, accents: number[], weights: Float32Array}} Voice duration: seconds. accents: times of the stressed
 *   syllables. weights `[K, 15]`: how much of each of VISEMES the mouth shows, evenly spaced over 0..max(duration, 0.001).
 */

const ACCENT = 2; // seconds round a stressed syllable without another: with it, speakers blink as often as people do

/** @returns {Voice} */
function readVoice({ duration, accents, weights }, where) {
  for (const x of [duration, ...accents]) inRange(x, 0, 1e9, where);
  return { duration, accents, weights: Float32Array.from(weights.flat(), (x) => inRange(x, 0, 1, where)) };
}

/** Return a voice guessed from letters alone. @param {string} text @param {?number} duration seconds @returns {Voice} */
export function voiceFromText(text, duration) {
  const { pieces, peaks, strengths, length } = spelled(text, duration);
  const weights = mouthTrack(pieces, pieces.length ? length : 0);
  return { duration: length, accents: accentsOf(peaks, strengths), weights };
}

/** The first peak, then the loudest ones that have no louder one near. People blink and gesture on these, not on every syllable. */
function accentsOf(peaks, strengths) {
  const order = peaks.map((_, n) => n).sort((a, b) => (a > 0) - (b > 0) || strengths[b] - strengths[a] || peaks[a] - peaks[b]);
  const taken = [];
  for (const n of order) if (taken.every((time) => Math.abs(peaks[n] - time) >= ACCENT)) taken.push(peaks[n]);
  return taken.sort((a, b) => a - b);
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
