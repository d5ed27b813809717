/**
 * How a listener takes up the mood of its partner and laughs along. The result is moods, which posture, face and life show
 * like any others.
 *
 * What is known and followed here: faces take up others' expressions weakly, within about a second of seeing them (Dimberg
 * 1982), as far as they are friendly: happy and sad ones, hardly angry ones (Hess and Fischer 2013); laughter brings smiles
 * and laughter, often but not always (Provine 1992). How much, how late and how often is ours. Neutral moods are not taken
 * up: a character with a mood of its own keeps it in front of a calm face.
 *
 * Translated from metagraph/playback/life/sympathy.py; change that, and translate anew.
 */

import { uniform } from "./choice.js";
import { Mood, MoodFrom, moodAt, moodEdges } from "./mood.js";
import { sorted } from "./basics.js";

export const DELAY = 0.7; // seconds until a mood is taken up, at least; as much again by chance
export const SHORTEST = 0.5; // seconds: what passes sooner is not taken up
export const HOSTILE = 0.4; // of how much, for moods that are unpleasant and excited
// Laughing along.
export const LAUGH_DELAY = 0.25; // seconds, at least; as much again by chance
export const LAUGH_LASTS = 2.6; // seconds, at least
export const LAUGH_RINGS = 1; // seconds a smile stays after the other's laugh, at least; as much again by chance
export const LAUGH_VALENCE = 0.9;
export const LAUGH_AROUSAL = 0.45;

/**
 * A laugh of the other character, in seconds.
 *
 * start: number; end: number.
 */
export class Laugh {
  constructor(start, end) {
    this.start = start;
    this.end = end;
  }
}

/**
 * Return the mood of a character that sees another's: `share`, 0..1, of the way to it; its own mood if the other's is
 * neutral.
 * @param {Mood} own
 * @param {Mood} other
 * @param {number} share
 * @returns {Mood}
 */
export function takenUp(own, other, share) {
  if (other.valence === 0 && other.arousal === 0) {
    return own;
  }
  const part = (other.valence < 0 && other.arousal > 0.3) ? share * HOSTILE : share;
  return new Mood(
    own.valence + part * (other.valence - own.valence),
    own.arousal + part * (other.arousal - own.arousal),
    own.intensity,
  );
}

/**
 * Return the moods of a character that sees the other's, from 0 to `end` seconds, by start. own: its mood without the other;
 * who: the key of the other, from which each delay is drawn.
 * @param {Moods} own
 * @param {Moods} other
 * @param {number} end
 * @param {number} share
 * @param {number} seed
 * @param {string} who
 * @returns {MoodFrom[]}
 */
export function moodsTakenUp(own, other, end, share, seed, who) {
  let edges = moodEdges(other, 0, end);
  for (const edge of moodEdges(own, 0, end)) {
    if (!edges.includes(edge)) {
      edges.push(edge);
    }
  }
  edges = sorted(edges);
  const out = [];
  for (const { 0: n, 1: edge } of edges.entries()) {
    const until = n + 1 < edges.length ? edges[n + 1] : end;
    const mine = moodAt(own, edge);
    const mood = takenUp(mine, moodAt(other, edge), share);
    if (until - edge < SHORTEST || mood.like(mine)) {
      continue;
    }
    const late = edge <= 0 ? 0 : DELAY + DELAY * uniform(seed, who, String(n), "mood");
    const start = Math.min(edge + late, until);
    out.push(new MoodFrom(`${who} mood ${n}`, start, mood.valence, mood.arousal, null, until));
  }
  return out;
}

/**
 * Return the moods of a character that laughs along with `share`, 0..1, of the other's laughs, by start.
 * @param {Moods} own
 * @param {Laugh[]} laughs
 * @param {number} share
 * @param {number} seed
 * @param {string} who
 * @returns {MoodFrom[]}
 */
export function laughsAlong(own, laughs, share, seed, who) {
  const out = [];
  for (const { 0: n, 1: laugh } of laughs.entries()) {
    if (uniform(seed, who, String(n), "laugh") >= share) {
      continue;
    }
    const start = laugh.start + LAUGH_DELAY + LAUGH_DELAY * uniform(seed, who, String(n), "late");
    const rings = LAUGH_RINGS + LAUGH_RINGS * uniform(seed, who, String(n), "rings");
    const mine = moodAt(own, start);
    out.push(new MoodFrom(
      `${who} laugh ${n}`,
      start,
      Math.max(mine.valence, LAUGH_VALENCE),
      Math.max(mine.arousal, LAUGH_AROUSAL),
      null,
      Math.max(start + LAUGH_LASTS, laugh.end + rings),
    ));
  }
  return out;
}
