/**
 * What of a cue shows at a time, in plain numbers: `player` and `Cue.clip_seconds` have it for arrays.
 *
 * Translated from metagraph/playback/cue_times.py; change that, and translate anew.
 */


/**
 * Return how much of a cue shows at a time, 0..1.
 * @param {Cue} cue
 * @param {number} time
 * @returns {number}
 */
export function cueWeight(cue, time) {
  if (time < cue.start || time >= cue.end) {
    return 0;
  }
  const rise = cue.blendIn > 0 ? ease((time - cue.start) / cue.blendIn) : 1;
  const fall = cue.blendOut > 0 ? ease((cue.end - time) / cue.blendOut) : 1;
  return rise * fall;
}

/**
 * Return the second of its clip that a cue plays at a time.
 * @param {Cue} cue
 * @param {number} time
 * @returns {number}
 */
export function cueSeconds(cue, time) {
  const elapsed = time - cue.start;
  if (cue.hold <= 0) {
    return cue.entry + elapsed * cue.tempo;
  }
  const held = Math.min(Math.max(elapsed - (cue.holdFrom - cue.entry) / cue.tempo, 0), cue.hold);
  const more = (elapsed - held) * (cue.tempo - 1);
  return cue.entry + elapsed - held + more + held * ((cue.holdTo - cue.holdFrom) / cue.hold);
}

/**
 * Return 3 x^2 - 2 x^3 of x within 0..1.
 * @param {number} x
 * @returns {number}
 */
export function ease(x) {
  x = Math.min(Math.max(x, 0), 1);
  return x * x * (3 - 2 * x);
}
