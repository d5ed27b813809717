/**
 * Compute how much of a cue, or of a stance's loop, shows at a time, with plain numbers. `player` and `Cue.clip_seconds` do
 * the same with arrays.
 *
 * Translated from metagraph/playback/posing/cue_times.py; change that, and translate anew.
 */


export const SEAM = 0.4; // clip seconds in which a cue that repeats makes its cycle's ends meet, at most half of the cycle

/**
 * Where a loop is.
 *
 * `seconds` is the time in its clip, `other` the time on the other side of its seam. `over` is how far it has blended from
 * there to here, 1 if no seam shows. `leaves` and `meets` are the clip seconds at which the two sides of the seam begin and
 * end.
 *
 * seconds: number; other: number; over: number; leaves: number; meets: number.
 */
export class LoopSpot {
  constructor(seconds, other, over, leaves, meets) {
    this.seconds = seconds;
    this.other = other;
    this.over = over;
    this.leaves = leaves;
    this.meets = meets;
  }
}

/**
 * Return where a stance's loop is at a time, as `layers.compute_loop_seconds` does.
 * @param {Project} project
 * @param {Rest} rest
 * @param {number} time
 * @returns {LoopSpot}
 */
export function loopSpot(project, rest, time) {
  const action = rest.action;
  const { 0: start, 1: end } = project.span(action);
  const seam = Math.min(Math.max(0, action.timing.blendIn), (end - start) / 2);
  const period = end - start - seam;
  if (period <= 0) {
    return new LoopSpot(start, start, 1, start, start);
  }
  const elapsed = time - rest.start;
  let phase = seam > 0 ? Math.max(elapsed, 0) : elapsed;
  phase = phase - period * Math.floor(phase / period);
  const over = (seam > 0 && elapsed >= period && phase < seam) ? phase / seam : 1;
  const other = start + Math.min(period + phase, end - start);
  return new LoopSpot(start + phase, other, over, start + period, start + seam);
}

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
  if (cue.repeats) {
    const cycle = cue.cycleTo - cue.cycleFrom;
    const into = cue.entry - cue.cycleFrom + elapsed * cue.tempo;
    return cue.cycleFrom + into - cycle * Math.floor(into / cycle);
  }
  if (cue.hold <= 0) {
    return cue.entry + elapsed * cue.tempo;
  }
  const held = Math.min(Math.max(elapsed - (cue.holdFrom - cue.entry) / cue.tempo, 0), cue.hold);
  const more = (elapsed - held) * (cue.tempo - 1);
  return cue.entry + elapsed - held + more + held * ((cue.holdTo - cue.holdFrom) / cue.hold);
}

/**
 * Return the share, 0..1, of the offset between the end of one cycle and the beginning of the next that is still added at a
 * time, so that a cue that repeats does not jump.
 * @param {Cue} cue
 * @param {number} time
 * @returns {number}
 */
export function seamLeft(cue, time) {
  const cycle = cue.cycleTo - cue.cycleFrom;
  const into = cue.entry - cue.cycleFrom + (time - cue.start) * cue.tempo;
  if (!cue.repeats || Math.floor(into / cycle) < 1) {
    return 0;
  }
  return 1 - ease((into - cycle * Math.floor(into / cycle)) / Math.min(SEAM, 0.5 * cycle));
}

/**
 * Return 3 x^2 - 2 x^3 of x clamped to 0..1.
 * @param {number} x
 * @returns {number}
 */
export function ease(x) {
  x = Math.min(Math.max(x, 0), 1);
  return x * x * (3 - 2 * x);
}
