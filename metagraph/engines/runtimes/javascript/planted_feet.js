/**
 * Find where the feet of a standing body should be while the body's layer blends. They do not glide from one pose to the
 * other: they are held, and move one after the other in a step.
 *
 * A clip gives the positions of its feet, and when they stand. A pose depends only on plan and time, so each step's time,
 * order and height follow from the two poses that it joins.
 *
 * Translated from metagraph/playback/posing/planted_feet.py; change that, and translate anew.
 */

import { FootGoal, footWay } from "./feet_solve.js";
import { dot, minus, plus, scaled, unitTurn } from "./plain_vectors.js";
import { cueSeconds, ease, loopSpot } from "./cue_times.js";
import { range } from "./basics.js";

export const FOOT_RATE = 10; // rows of a track in a second of its clip
export const FOOT_UNIT = 1e-05; // the value of 1 in a row
export const FOOT_NUMBERS = 8; // in a row, for each foot
export const STEPPING = 0.5; // seconds that two steps take if a cue leaves them time
export const LEAST_PART = 0.15; // of that time for the foot with the shorter way
export const NEARBY = 0.015; // metres: feet with a shorter way move together, slowly
export const WAITS = 0.12; // of a step's time: the foot is lifted before it moves and lowered after it
export const LIFT = 0.25; // how high a foot is lifted for a short step, as a share of its way
export const MOST_LIFT = 0.08; // metres: the limit that no foot reaches
export const FAR = 0.25; // of the height: no foot steps that much farther
export const TOO_FAR = 0.1;
export const QUICK = 0.65; // of the height, a second: above, feet step less and glide more
export const TOO_QUICK = 0.2; // as much quicker, they only glide

/**
 * Where a clip's feet are.
 *
 * `rows` has a row for each tenth of a second, with the left foot and then the right: whether it stands (0 to 1), its
 * joint's position and rotation in the character's space; in units of `FOOT_UNIT`.
 *
 * rows: number[][].
 */
export class FootTrack {
  constructor(rows) {
    this.rows = rows;
  }
}

/**
 * Return where both feet should be at a time; an empty list if nothing blends or it is unknown.
 *
 * `tracks` are by action. `height` is the figure's. `plan` is the body's layer. `cue` is the one that plays, if it has
 * motion, and `place` the index of the rest in force, -1 for none.
 * @param {Project} project
 * @param {Map<string, FootTrack>} tracks
 * @param {number} height
 * @param {LayerPlan} plan
 * @param {?Cue} cue
 * @param {number} place
 * @param {number} time
 * @returns {FootGoal[]}
 */
export function footGoals(project, tracks, height, plan, cue, place, time) {
  if (place < 0) {
    return [];
  }
  if (cue === null) {
    if (!_changes(project, plan, place, time)) {
      return [];
    }
    return _stance(project, tracks, height, plan, place, time);
  }
  const track = tracks.get(cue.action.id) ?? null;
  const masked = cue.action.joints.length > 0 || cue.action.jointWeights.length > 0;
  if (track === null || track.rows.length === 0 || masked) {
    return [];
  }
  const came = cue.start + _entering(track, cue);
  const goes = cue.end - _leaving(track, cue);
  if (time >= came && time < goes) {
    return [];
  }
  const here = footRow(track, cueSeconds(cue, time));
  let at;
  let first;
  let last;
  if (time < came) {
    at = Math.min(time, cue.start + cue.blendIn);
    const before = _stance(project, tracks, height, plan, place, at);
    first = _stance(project, tracks, height, plan, place, cue.start);
    last = footRow(track, cueSeconds(cue, came));
    return stepped(height, before, here, first, last, time - cue.start, came - cue.start);
  }
  at = Math.max(time, cue.end - cue.blendOut);
  const after = _stance(project, tracks, height, plan, place, at);
  first = footRow(track, cueSeconds(cue, goes));
  last = _stance(project, tracks, height, plan, place, cue.end);
  return stepped(height, here, after, first, last, time - goes, cue.end - goes);
}

/**
 * Return how long the feet take to enter a cue: its blend, and longer while it stands.
 * @param {FootTrack} track
 * @param {Cue} cue
 * @returns {number}
 */
function _entering(track, cue) {
  return _lasting(track, cue, cue.blendIn, cue.start, 1);
}

/**
 * Return how long the feet take to leave a cue.
 * @param {FootTrack} track
 * @param {Cue} cue
 * @returns {number}
 */
function _leaving(track, cue) {
  return _lasting(track, cue, cue.blendOut, cue.end, -1);
}

/**
 * @param {FootTrack} track
 * @param {Cue} cue
 * @param {number} blend
 * @param {number} edge
 * @param {number} way
 * @returns {number}
 */
function _lasting(track, cue, blend, edge, way) {
  if (blend <= 0) {
    return 0;
  }
  const spare = Math.max(0, cue.end - cue.start - cue.blendIn - cue.blendOut);
  const most = Math.min(STEPPING, blend + 0.5 * spare);
  let out = blend;
  const step = 1 / FOOT_RATE;
  while (out < most && _stands(track, cueSeconds(cue, edge + way * Math.min(out + step, most)))) {
    out = Math.min(out + step, most);
  }
  return out;
}

/**
 * @param {FootTrack} track
 * @param {number} seconds
 * @returns {boolean}
 */
function _stands(track, seconds) {
  const goals = footRow(track, seconds);
  return goals[0].planted >= 1 && goals[1].planted >= 1;
}

/**
 * Return both feet during a step, after `passed` of its `seconds`. `first` and `last` are their places when it begins and
 * ends, which decide the order and size of the steps.
 * @param {number} height
 * @param {FootGoal[]} before
 * @param {FootGoal[]} after
 * @param {FootGoal[]} first
 * @param {FootGoal[]} last
 * @param {number} passed
 * @param {number} seconds
 * @returns {FootGoal[]}
 */
export function stepped(height, before, after, first, last, passed, seconds) {
  if (before.length === 0 || after.length === 0 || first.length === 0 || last.length === 0) {
    return [];
  }
  const ways = [];
  for (let side = 0; side < 2; side++) { // a foot that does not stand before or after needs no time for a step
    const stands = first[side].planted * last[side].planted;
    ways.push(stands * footWay(first[side], last[side]));
  }
  let part = 0.5;
  if (ways[0] + ways[1] > 0) {
    part = Math.min(Math.max(ways[0] / (ways[0] + ways[1]), LEAST_PART), 1 - LEAST_PART);
  }
  // To the left, the left foot goes first: the right foot would have to pass it.
  const moved = plus(minus(last[0].at, first[0].at), minus(last[1].at, first[1].at));
  const leftFirst = dot(moved, minus(first[0].at, first[1].at)) >= -1e-09;
  const longer = Math.max(ways[0], ways[1]);
  let far = 1 - ease((longer / height - FAR) / TOO_FAR);
  const apart = ease(longer / NEARBY);
  const shares = [1 - apart * (1 - part), 1 - apart * part];
  const quickest = Math.max(ways[0] / shares[0], ways[1] / shares[1]);
  far *= 1 - ease((quickest / (height * Math.max(seconds, 0.001)) - QUICK) / TOO_QUICK);
  const u = seconds > 0 ? passed / seconds : 1;
  const out = [];
  for (let side = 0; side < 2; side++) {
    const share = shares[side];
    const begin = leftFirst === (side === 0) ? 0 : 1 - share;
    const x = Math.min(Math.max((u - begin) / share, 0), 1);
    const go = ease((x - WAITS) / (1 - 2 * WAITS));
    const rise = LIFT * ways[side];
    const air = 16 * x * x * (1 - x) * (1 - x) * rise / (1 + rise / MOST_LIFT);
    out.push(_mixed(before[side], after[side], go, air, far));
  }
  return out;
}

/**
 * Return a foot between two places.
 * @param {FootGoal} a
 * @param {FootGoal} b
 * @param {number} x
 * @param {number} air
 * @param {number} share
 * @returns {FootGoal}
 */
function _mixed(a, b, x, air, share) {
  const { 0: ax, 1: ay, 2: az, 3: aw } = a.turn;
  const { 0: bx, 1: by, 2: bz, 3: bw } = b.turn;
  const k = ax * bx + ay * by + az * bz + aw * bw < 0 ? -x : x;
  const rest = 1 - x;
  const turn = unitTurn([ax * rest + bx * k, ay * rest + by * k, az * rest + bz * k, aw * rest + bw * k]);
  const at = plus(a.at, scaled(minus(b.at, a.at), x));
  return new FootGoal(at, turn, share * a.planted * b.planted, a.lift * rest + b.lift * x + air);
}

/**
 * Return the index of the rest in force at a time, searching from another.
 * @param {LayerPlan} plan
 * @param {number} place
 * @param {number} time
 * @returns {number}
 */
function _resting(plan, place, time) {
  while (place > 0 && plan.rests[place].fadeStart > time) {
    place -= 1;
  }
  while (place + 1 < plan.rests.length && plan.rests[place + 1].fadeStart <= time) {
    place += 1;
  }
  return place;
}

/**
 * @param {LayerPlan} plan
 * @param {number} place
 * @param {number} time
 * @returns {boolean}
 */
function _fades(plan, place, time) {
  const rest = plan.rests[place];
  return place > 0 && rest.fadeStart + rest.fade > time;
}

/**
 * Return whether a stance blends: between two rests, or at a loop's seam.
 * @param {Project} project
 * @param {LayerPlan} plan
 * @param {number} place
 * @param {number} time
 * @returns {boolean}
 */
function _changes(project, plan, place, time) {
  const rest = plan.rests[place];
  if (_fades(plan, place, time)) {
    return true;
  }
  return loopSpot(project, rest, time).over < 1;
}

/**
 * Return where the feet of the stance under the cues are at a time.
 * @param {Project} project
 * @param {Map<string, FootTrack>} tracks
 * @param {number} height
 * @param {LayerPlan} plan
 * @param {number} place
 * @param {number} time
 * @returns {FootGoal[]}
 */
function _stance(project, tracks, height, plan, place, time) {
  place = _resting(plan, place, time);
  const rest = plan.rests[place];
  const goals = _loop(project, tracks, height, rest, time);
  if (!_fades(plan, place, time)) {
    return goals;
  }
  const old = plan.rests[place - 1];
  const ends = rest.fadeStart + rest.fade;
  return stepped(
    height,
    _loop(project, tracks, height, old, time),
    goals,
    _loop(project, tracks, height, old, rest.fadeStart),
    _loop(project, tracks, height, rest, ends),
    time - rest.fadeStart,
    rest.fade,
  );
}

/**
 * Return where the feet of a loop are. They also go from its end to its beginning in steps.
 * @param {Project} project
 * @param {Map<string, FootTrack>} tracks
 * @param {number} height
 * @param {Rest} rest
 * @param {number} time
 * @returns {FootGoal[]}
 */
function _loop(project, tracks, height, rest, time) {
  const track = tracks.get(rest.action.id) ?? null;
  if (track === null || track.rows.length === 0) {
    return [];
  }
  const spot = loopSpot(project, rest, time);
  const here = footRow(track, spot.seconds);
  if (spot.over >= 1) {
    return here;
  }
  const seam = spot.meets - project.span(rest.action)[0];
  const before = footRow(track, spot.other);
  const leaves = footRow(track, spot.leaves);
  const meets = footRow(track, spot.meets);
  return stepped(height, before, here, leaves, meets, spot.over * seam, seam);
}

/**
 * Return where a clip's feet are at a second of the clip, interpolated linearly.
 * @param {FootTrack} track
 * @param {number} seconds
 * @returns {FootGoal[]}
 */
export function footRow(track, seconds) {
  const last = track.rows.length - 1;
  const at = Math.min(Math.max(seconds * FOOT_RATE, 0), last);
  const low = Math.min(Math.floor(at), Math.max(0, last - 1));
  const part = at - low;
  const a = track.rows[low];
  const b = track.rows[Math.min(low + 1, last)];
  const v = range(2 * FOOT_NUMBERS).map((n) => FOOT_UNIT * (a[n] + (b[n] - a[n]) * part));
  const out = [];
  for (let side = 0; side < 2; side++) {
    const n = FOOT_NUMBERS * side;
    const turn = unitTurn([v[n + 4], v[n + 5], v[n + 6], v[n + 7]]);
    out.push(new FootGoal([v[n + 1], v[n + 2], v[n + 3]], turn, v[n], 0));
  }
  return out;
}
