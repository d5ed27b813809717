/**
 * The mouth shapes of a voice, detected from its samples as they come in, from the levels of four bands relative to the
 * loudest so far. The only delay is the shortest length of a shape, so every engine can analyse the sound that it plays.
 *
 * Open vowels have more energy around 800 Hz, the first formant of an open mouth, than around 300 Hz. Front vowels have more
 * around 2200 Hz, their second formant. Sibilants have most above 3500 Hz. The bounds are ours, chosen by comparison with
 * the results of `speech.sound` on whole recordings.
 *
 * Translated from metagraph/playback/life/streamed_voice.py; change that, and translate anew.
 */

import { VisemeMark } from "./line_timing.js";
import { zip } from "./basics.js";

export const HOP = 0.01; // seconds that are judged together
export const HERTZ = [300, 800, 2200, 5000]; // middles of the bands
export const QUALITY = [0.7, 1, 1, 0.7]; // and how narrow they are
export const HIGHEST = 0.42; // of the rate: bands higher than this are left out
export const LOUDEST = -32; // dB of full scale: a voice is taken to be at least as loud as this
export const FORGET = 3; // dB a second by which the loudest is forgotten
export const SHUT = -25; // dB beside the loudest: softer than this the mouth is shut
export const SONOROUS = -16; // louder than this it is open
export const HISSING = -33; // softer than this nothing hisses
export const HISS = 3; // dB by which the highest band is above the lower ones where it does
export const OPEN = -1.7; // dB of the second band beside the first: an open mouth, and
export const HALF = -5; // half open
export const FRONT_HALF = -6; // dB of the third band beside the second: the tongue is in front, of half open mouths
export const FRONT = -8.5; // and of others
export const LEAST = 0.03; // seconds: anything shorter is not a shape
export const STEP = 0.06; // seconds after which a shape that gets stronger or weaker
export const GROWS = 0.15; // by this much is reported again
export const BEHIND = 0.25; // seconds by which a piece may come late; a later one is heard when it comes

/**
 * The state of a voice that is analysed. rate: samples a second, 8000 or more. seconds: how much of it was heard. missed:
 * seconds of the line in which no sound came. The other fields are memory.
 *
 * rate: number; seconds: number; missed: number; shape: string; told: number; weight: number; coming: string; since: number;
 * loudest: number; judged: number; inside: number; filters: number[]; memory: number[]; energy: number[].
 */
export class StreamedVoice {
  constructor(
    rate,
    seconds = 0,
    missed = 0,
    shape = "sil",
    told = 0,
    weight = 1,
    coming = "sil",
    since = 0,
    loudest = -120,
    judged = 0,
    inside = 0,
    filters = [],
    memory = [],
    energy = [],
  ) {
    this.rate = rate;
    this.seconds = seconds;
    this.missed = missed;
    this.shape = shape;
    this.told = told;
    this.weight = weight;
    this.coming = coming;
    this.since = since;
    this.loudest = loudest;
    this.judged = judged;
    this.inside = inside;
    this.filters = filters;
    this.memory = memory;
    this.energy = energy;
  }

  /**
   * Analyse the next samples, -1..1; return the shapes that begin in them: visemes of the set "oculus", at seconds from the
   * line's start.
   */
  hear(samples) {
    const out = [];
    if (this.filters.length === 0) {
      this.begin();
    }
    const size = Math.max(1, Math.trunc(HOP * this.rate));
    const count = this.energy.length;
    for (const sample of samples) {
      for (let band = 0; band < count; band++) {
        // A band-pass of two poles, in the transposed direct form II.
        const f = 3 * band;
        const m = 2 * band;
        const y = this.filters[f] * sample + this.memory[m];
        this.memory[m] = this.memory[m + 1] - this.filters[f + 1] * y;
        this.memory[m + 1] = -this.filters[f] * sample - this.filters[f + 2] * y;
        this.energy[band] = this.energy[band] + y * y;
      }
      this.inside += 1;
      if (this.inside === size && this.judge(size)) {
        out.push(new VisemeMark(this.told + this.missed, this.shape, this.weight));
      }
    }
    this.seconds = (this.judged * size + this.inside) / this.rate + this.missed;
    return out;
  }

  /** Skip to where the line is if its sound came too late. said: seconds of the line that are over. */
  follow(said) {
    if (this.seconds < said - BEHIND) {
      this.missed += said - this.seconds;
      this.seconds = said;
    }
  }

  begin() {
    for (const { 0: hertz, 1: quality } of zip(HERTZ, QUALITY)) {
      if (hertz <= HIGHEST * this.rate) {
        const turn = 2 * Math.PI * hertz / this.rate;
        const wide = Math.sin(turn) / (2 * quality);
        this.filters.push(wide / (1 + wide));
        this.filters.push(-2 * Math.cos(turn) / (1 + wide));
        this.filters.push((1 - wide) / (1 + wide));
        this.memory.push(0);
        this.memory.push(0);
        this.energy.push(0);
      }
    }
  }

  /** Classify the last moment; return whether a shape begins or changes, at `told`. */
  judge(size) {
    const now = this.judged * size / this.rate;
    const levels = this.energy.map((energy) => 10 / Math.log(10) * Math.log(energy / size + 1e-12));
    for (let band = 0; band < this.energy.length; band++) {
      this.energy[band] = 0;
    }
    this.inside = 0;
    this.judged += 1;
    const voiced = Math.max(levels[0], levels[1], levels[2]);
    this.loudest = Math.max(voiced, LOUDEST, this.loudest - FORGET * size / this.rate);
    const shape = this.shapeOf(levels);
    if (shape !== this.coming) {
      this.coming = shape;
      this.since = now;
    }
    let weight = 1;
    if (shape !== "sil" && shape !== "SS" && shape !== "nn") {
      weight = 0.35 + 0.65 * Math.min(1, Math.max(0, 1 + (voiced - this.loudest) / -SONOROUS));
    }
    const begins = shape !== this.shape && now + size / this.rate - this.since >= LEAST;
    if (begins || (shape === this.shape && Math.abs(weight - this.weight) >= GROWS && now - this.told >= STEP)) {
      this.shape = shape;
      this.told = begins ? this.since : now;
      this.weight = weight;
      return true;
    }
    return false;
  }

  /** Return the shape of a moment. levels: dB of the bands, without the highest band at low rates. */
  shapeOf(levels) {
    const low = levels[0];
    const middle = levels[1];
    const high = levels[2];
    if (levels.length > 3 && levels[3] > this.loudest + HISSING && levels[3] > Math.max(low, middle) + HISS) {
      return "SS";
    }
    const loud = Math.max(low, middle, high) - this.loudest;
    if (loud < SHUT) {
      return "sil";
    }
    if (loud < SONOROUS) {
      return "nn";
    }
    if (middle - low > OPEN) {
      return "aa";
    }
    if (middle - low > HALF) {
      return high - middle > FRONT_HALF ? "E" : "O";
    }
    return high - middle > FRONT ? "I" : "U";
  }
}
