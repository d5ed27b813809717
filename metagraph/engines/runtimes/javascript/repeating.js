/**
 * Say how long actions play that repeat a part of their clip, such as one cycle of a wave.
 *
 * Translated from metagraph/graph/repeating.py; change that, and translate anew.
 */


export const LEAST_CYCLE = 0.1; // seconds of a part that can repeat
export const MOST_TIMES = 1000000; // that a cycle plays in a row
export const LONGEST_REPEAT = 60; // most seconds that an action repeats if no request says how long

/**
 * Return the length in seconds of the part from `start` to `end` that an action repeats, 0 if it plays once.
 * @param {string} kind
 * @param {Timing} timing
 * @param {number} start
 * @param {number} end
 * @returns {number}
 */
export function cycleOf(kind, timing, start, end) {
  const repeats = timing.repeat > 0 && ["gesture", "fidget"].includes(kind);
  return (repeats && end - start >= LEAST_CYCLE) ? end - start : 0;
}

/**
 * Return how many whole times, at least one, a cycle must play to last as close to `seconds` as possible.
 * @param {number} cycle
 * @param {number} seconds
 * @returns {number}
 */
export function timesPlayed(cycle, seconds) {
  return Math.max(1, Math.floor(Math.min(seconds / cycle, MOST_TIMES) + 0.5));
}

/**
 * Return how many seconds an action plays at its own speed if no request says how long.
 * @param {string} kind
 * @param {Timing} timing
 * @param {number} start
 * @param {number} end
 * @returns {number}
 */
export function secondsPlayed(kind, timing, start, end) {
  const cycle = cycleOf(kind, timing, start, end);
  if (cycle <= 0) {
    return end - start;
  }
  return cycle * timesPlayed(cycle, Math.min(timing.repeat, LONGEST_REPEAT));
}
