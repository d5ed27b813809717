/**
 * Compute how far the arms of a plan have moved their mass away from its stance at a time.
 *
 * The body reacts with a delay. So it does not follow the arms at one moment, but a cubic B-spline through their places at
 * four earlier fixed times. This is smooth, and depends only on plan and time.
 *
 * Translated from metagraph/playback/posing/follow_through.py; change that, and translate anew.
 */

import { cueSeconds, cueWeight, ease, loopSpot, seamLeft } from "./cue_times.js";
import { range } from "./basics.js";

export const STEP = 0.08; // seconds between the sampled times; the answer comes two of them late
export const OFFSET = 0.0111; // seconds by which they are shifted from whole steps, where cues begin and end
export const KNOTS = 4;
export const RATE = 10; // rows of a track in a second of its clip
export const UNIT = 1e-05; // metres, or radians, of 1 in a row
export const NUMBERS = 8; // in a row

/**
 * How the arms of a clip move their mass.
 *
 * `clip` is its id. `rows` has a row for each tenth of a second, relative to the base pose: how far the left arm shifts the
 * centre of mass of the whole body to the left, up and ahead, the same for the right arm, and how far each collar bone lags
 * behind its arm; in units of `UNIT`.
 *
 * clip: string; rows: number[][].
 */
export class ArmTrack {
  constructor(clip, rows) {
    this.clip = clip;
    this.rows = rows;
  }
}

/**
 * Return the number of the last sampled time for a pose at `time`.
 * @param {number} time
 * @returns {number}
 */
export function knotBefore(time) {
  return Math.floor((time - OFFSET) / STEP);
}

/**
 * Return the time of a sample, in seconds.
 * @param {number} number
 * @returns {number}
 */
export function knotTime(number) {
  return number * STEP + OFFSET;
}

/**
 * Return how far the arms are from their stance at a time, as a row of a track, in metres and radians.
 *
 * `tracks` are by action. `hands` names the joints of the hands. `cue` is that of the arms' layer, if it has motion, and
 * `place` the index of the rest in force, -1 for none; `body_cue` and `body_place` are the same for the body's layer. A cue
 * whose clip the body's layer also shows moves the hips itself and does not count.
 * @param {Project} project
 * @param {Map<string, ArmTrack>} tracks
 * @param {string[]} hands
 * @param {LayerPlan} arms
 * @param {?Cue} cue
 * @param {number} place
 * @param {LayerPlan} body
 * @param {?Cue} bodyCue
 * @param {number} bodyPlace
 * @param {number} time
 * @returns {number[]}
 */
export function armSway(project, tracks, hands, arms, cue, place, body, bodyCue, bodyPlace, time) {
  const out = range(NUMBERS).map((n) => 0);
  if (cue === null) {
    return out;
  }
  const track = tracks.get(cue.action.id) ?? null;
  if (track === null || track.rows.length === 0) {
    return out;
  }
  const weight = cueWeight(cue, time);
  const share = cue.extent * (1 - _shown(tracks, body, bodyCue, bodyPlace, track.clip, time));
  if (weight <= 0 || share <= 0) {
    return out;
  }
  let row = _row(track, cueSeconds(cue, time));
  const rest = _stance(project, tracks, arms, place, time);
  const entering = time < cue.start + cue.blendIn;
  if (cue.repeats) {
    const back = seamLeft(cue, time);
    const ends = _row(track, cue.cycleTo);
    const begins = _row(track, cue.cycleFrom);
    row = range(NUMBERS).map((n) => row[n] + back * (ends[n] - begins[n]));
    row = range(NUMBERS).map((n) => rest[n] + weight * (row[n] - rest[n]));
  } else if (entering || time >= cue.end - cue.blendOut) {
    const edge = _row(track, entering ? cue.entry : cueSeconds(cue, cue.end));
    row = range(NUMBERS).map((n) => row[n] + (1 - weight) * (rest[n] - edge[n]));
  }
  const left = _moves(cue.action, "left", hands[0]) ? share * UNIT : 0;
  const right = _moves(cue.action, "right", hands[1]) ? share * UNIT : 0;
  for (let n = 0; n < NUMBERS; n++) {
    out[n] = (row[n] - rest[n]) * ((n < 3 || n === 6) ? left : right);
  }
  return out;
}

/**
 * Return the eight numbers that move the body at a time, and their change per second. `sways` has the rows of the last
 * `KNOTS` times before it.
 * @param {number[][]} sways
 * @param {number} time
 * @returns {number[]}
 */
export function driven(sways, time) {
  let u = (time - OFFSET) / STEP;
  u = u - Math.floor(u);
  const back = 1 - u;
  const weights = [
    back * back * back / 6,
    (3 * u * u * u - 6 * u * u + 4) / 6,
    (3 * u + 3 * u * u - 3 * u * u * u + 1) / 6,
    u * u * u / 6,
  ];
  const slopes = [-back * back / 2, (3 * u * u - 4 * u) / 2, (1 + 2 * u - 3 * u * u) / 2, u * u / 2];
  const out = range(2 * NUMBERS).map((n) => 0);
  for (let n = 0; n < NUMBERS; n++) {
    for (let k = 0; k < KNOTS; k++) {
      out[n] += weights[k] * sways[k][n];
      out[NUMBERS + n] += slopes[k] * sways[k][n] / STEP;
    }
  }
  return out;
}

/**
 * Return whether an action moves an arm, instead of leaving it in the stance.
 * @param {Action} action
 * @param {string} side
 * @param {string} hand
 * @returns {boolean}
 */
function _moves(action, side, hand) {
  if (!["both", side].includes(action.limb)) {
    return false;
  }
  return action.joints.length === 0 || action.joints.includes(hand);
}

/**
 * Return how much a layer shows of a clip, 0..1.
 * @param {Map<string, ArmTrack>} tracks
 * @param {LayerPlan} plan
 * @param {?Cue} cue
 * @param {number} place
 * @param {string} clip
 * @param {number} time
 * @returns {number}
 */
function _shown(tracks, plan, cue, place, clip, time) {
  let left = 1;
  let out = 0;
  if (cue !== null) {
    const weight = cueWeight(cue, time);
    left = 1 - weight;
    if (_isOf(tracks, cue.action, clip)) {
      out += weight;
    }
  }
  if (place >= 0) {
    const rest = plan.rests[place];
    let over = 1;
    if (place > 0 && rest.fadeStart + rest.fade > time) {
      over = ease((time - rest.fadeStart) / rest.fade);
      if (_isOf(tracks, plan.rests[place - 1].action, clip)) {
        out += left * (1 - over);
      }
    }
    if (_isOf(tracks, rest.action, clip)) {
      out += left * over;
    }
  }
  return Math.min(1, out);
}

/**
 * @param {Map<string, ArmTrack>} tracks
 * @param {Action} action
 * @param {string} clip
 * @returns {boolean}
 */
function _isOf(tracks, action, clip) {
  const track = tracks.get(action.id) ?? null;
  return track !== null && track.clip === clip;
}

/**
 * Return the row of the stance under the cues.
 * @param {Project} project
 * @param {Map<string, ArmTrack>} tracks
 * @param {LayerPlan} plan
 * @param {number} place
 * @param {number} time
 * @returns {number[]}
 */
function _stance(project, tracks, plan, place, time) {
  if (place < 0) {
    return range(NUMBERS).map((n) => 0);
  }
  const rest = plan.rests[place];
  let row = _loop(project, tracks, rest, time);
  if (place > 0 && rest.fadeStart + rest.fade > time) {
    const over = ease((time - rest.fadeStart) / rest.fade);
    const before = _loop(project, tracks, plan.rests[place - 1], time);
    row = range(NUMBERS).map((n) => before[n] + (row[n] - before[n]) * over);
  }
  return row;
}

/**
 * Return the row of a loop, with its end blended into its beginning.
 * @param {Project} project
 * @param {Map<string, ArmTrack>} tracks
 * @param {Rest} rest
 * @param {number} time
 * @returns {number[]}
 */
function _loop(project, tracks, rest, time) {
  const track = tracks.get(rest.action.id) ?? null;
  if (track === null || track.rows.length === 0) {
    return range(NUMBERS).map((n) => 0);
  }
  const spot = loopSpot(project, rest, time);
  let row = _row(track, spot.seconds);
  if (spot.over < 1) {
    const old = 1 - ease(spot.over);
    const before = _row(track, spot.other);
    row = range(NUMBERS).map((n) => row[n] + (before[n] - row[n]) * old);
  }
  return row;
}

/**
 * Return a track's row at a second of the clip, interpolated linearly.
 * @param {ArmTrack} track
 * @param {number} seconds
 * @returns {number[]}
 */
function _row(track, seconds) {
  const last = track.rows.length - 1;
  const at = Math.min(Math.max(seconds * RATE, 0), last);
  const low = Math.min(Math.floor(at), Math.max(0, last - 1));
  const part = at - low;
  const a = track.rows[low];
  const b = track.rows[Math.min(low + 1, last)];
  return range(NUMBERS).map((n) => a[n] + (b[n] - a[n]) * part);
}
