/** What is said, heard in step with the lips: lines with their own sounds, and sounds given for one thing that is said. */

import { findLineStart } from "./items.js";

export class Sounds {
  /** @param {Record<string, {audio?: string}>} lines @param {URL} base what their paths are relative to */
  constructor(lines, base) {
    this.lines = new Map(Object.entries(lines).flatMap(([id, { audio }]) => (audio ? [[id, new URL(audio, base).href]] : [])));
    this.given = new Map(); // id of what is said -> address of its sound
    this.playing = null;
  }

  /** Play a sound with what is said under an id. @param {string} id @param {string} url */
  give(id, url) {
    this.given.set(id, url);
  }

  of({ id, line }) {
    return this.given.get(id) ?? this.lines.get(line);
  }

  /** @param {import("./character.js").Character} character @param {boolean} [paused] */
  update({ plan, now }, paused = false) {
    const speech = paused ? undefined : plan.track.speeches.find((one) => this.of(one) && one.start <= now && now < one.end);
    const key = speech ? `${speech.id}@${speech.start}` : null;
    if (this.playing?.key === key || (!speech && !this.playing)) return;
    this.silence();
    if (!speech) return;
    const sound = new Audio(this.of(speech));
    sound.currentTime = Math.max(0, now - findLineStart(speech));
    sound.play().catch(() => {}); // a browser keeps still until somebody has clicked
    this.playing = { key, sound };
  }

  silence() {
    this.playing?.sound.pause();
    this.playing = null;
  }
}
