/**
 * What keeps a performance from repeating itself and from being restless: how soon an action is done again, how long a
 * posture is kept, how far apart acts are that stand out.
 *
 * Only what the Markov model writes is held back. Requests always play; of the actions that fit a request, those that have
 * not played for long enough are likelier. `Settings.variety` multiplies every time here; 0 turns all of it off, as in Borer
 * et al. The times are ours, chosen by what an hour of the sample then does (`docs/researchers/behaviour.md`).
 *
 * Translated from metagraph/playback/planning/director.py; change that, and translate anew.
 */

import { logNormal, uniform } from "./choice.js";
import { partedLast, splitWords } from "./basics.js";

export const STANDS_OUT = 0.65; // prominence from which on an act is one that a viewer remembers
export const APART = 30; // seconds between two of those on one layer
export const LONG_REST = 30; // seconds of rest after which actions need to have rested only `SHORTER` as long
export const SHORTER = 0.3;
export const LEAST_BEATS = 18; // seconds after which a gesture that hardly shows is done again, at least
export const MOST_BEATS = 180; // and at most
export const EACH = 7; // seconds of those for each gesture of the arms that the character has
export const STALE = 0.05; // least factor of the likelihood of what has just been played
export const ENDS_BURST = 0.25; // share of the acts of one who talks that end a burst: some 2.5 acts, then a rest
export const LEAST_LULL = 5; // seconds of that rest at least
export const MOST_LULL = 30; // and at most
export const LULL = 8; // its mean before it is clamped
export const LULL_SPREAD = 14; // and its standard deviation
export const LEAVES_HOME = 0.2; // share of the written tilts of the head that leave the stance it begins in
export const GOES_HOME = 0.7; // share of the written moves of a tilted head that go back there
export const MUSES = 2; // seconds that a thought goes on at least for which a hand goes to the chin
export const MUSED = 10; // seconds after a thought in which anything that is written takes the hand away again
export const THOUGHTFUL = ["chin", "thinking", "pondering", "musing"]; // words of such a stance's name

/**
 * Return the first stance of the arms whose name says that one thinks in it; "" for none.
 * @param {Map<string, Stance>} stances
 * @returns {string}
 */
export function musing(stances) {
  for (const { 0: ident, 1: stance } of stances) {
    for (const word of splitWords(stance.name.toLowerCase())) {
      if (THOUGHTFUL.includes(word) || THOUGHTFUL.includes(partedLast(word, "_")[2])) {
        return ident;
      }
    }
  }
  return "";
}

/**
 * Return after how many seconds a gesture that hardly shows may be done again: with many gestures of the arms, not for
 * minutes; with few, soon. gestures: how many the layer has.
 * @param {string} layer
 * @param {number} gestures
 * @returns {number}
 */
export function beatInterval(layer, gestures) {
  if (layer !== "arms") {
    return LEAST_BEATS;
  }
  return Math.min(MOST_BEATS, Math.max(LEAST_BEATS, EACH * gestures));
}

/**
 * Return after how many seconds an action may be done again.
 *
 * That is from `beats` (`beat_interval`) to six minutes for gestures, the longer the more they stand out, and 5 to 10
 * minutes for fidgets, which only time calls for. prominence: 0..1.
 * @param {string} kind
 * @param {number} prominence
 * @param {number} beats
 * @returns {number}
 */
export function repeatInterval(kind, prominence, beats) {
  if (kind === "gesture") {
    return beats * Math.exp(Math.log(360 / beats) * prominence);
  }
  return 300 * Math.exp(Math.log(2) * prominence);
}

/**
 * Return how many seconds a stance is kept at least before the model changes it.
 * @param {string} layer
 * @returns {number}
 */
export function posture(layer) {
  if (layer === "body") {
    return 25;
  }
  return layer === "arms" ? 10 : 8;
}

/**
 * Return how many seconds the arms rest at least after an act of theirs: nothing within a burst of one who talks, else from
 * `LEAST_LULL` to `MOST_LULL`. key: of the act's meta action.
 * @param {number} seed
 * @param {string} key
 * @param {boolean} talks
 * @param {number} variety
 * @returns {number}
 */
export function findLull(seed, key, talks, variety) {
  if (talks && uniform(seed, key, "burst") >= ENDS_BURST) {
    return 0;
  }
  const drawn = logNormal(LULL, LULL_SPREAD, uniform(seed, key, "lull"), uniform(seed, key, "lull2"));
  return Math.min(MOST_LULL, Math.max(LEAST_LULL, drawn) * variety);
}

/**
 * Return the factor of an action's likelihood. since: seconds since it ended; needed: its interval.
 * @param {number} since
 * @param {number} needed
 * @returns {number}
 */
export function freshness(since, needed) {
  if (since >= needed) {
    return 1;
  }
  return Math.max(STALE, since / needed);
}
