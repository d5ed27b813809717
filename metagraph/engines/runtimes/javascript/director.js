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


export const STANDS_OUT = 0.65; // prominence from which on an act is one that a viewer remembers
export const APART = 30; // seconds between two of those on one layer
export const LONG_REST = 30; // seconds of rest after which actions need to have rested only `SHORTER` as long
export const SHORTER = 0.3;
export const STALE = 0.05; // least factor of the likelihood of what has just been played
export const LEAVES_HOME = 0.2; // share of the written tilts of the head that leave the stance it begins in
export const GOES_HOME = 0.7; // share of the written moves of a tilted head that go back there

/**
 * Return after how many seconds an action may be done again.
 *
 * That is 18 s for a beat that hardly shows, six minutes for a gesture that stands out, and 4 to 10 minutes for fidgets,
 * which only time calls for. prominence: 0..1.
 * @param {string} kind
 * @param {number} prominence
 * @returns {number}
 */
export function repeatInterval(kind, prominence) {
  if (kind === "gesture") {
    return 18 * Math.exp(Math.log(20) * prominence);
  }
  return 240 * Math.exp(Math.log(2.5) * prominence);
}

/**
 * Return how many seconds a stance is kept at least before the model changes it.
 * @param {string} layer
 * @returns {number}
 */
export function posture(layer) {
  if (layer === "body") {
    return 15;
  }
  return layer === "arms" ? 10 : 8;
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
