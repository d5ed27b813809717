/**
 * How a standing body reacts to its arms: the hips give way, spine and legs compensate, and the feet stay.
 *
 * Rotations are quaternions xyzw, lengths metres; a place is an index into a rig's list of joints. The code computes one
 * pose at a time, with plain numbers, the same in all languages.
 *
 * How much: a standing person keeps the centre of mass over the feet, so the hips move back as far as the arms move it
 * ahead. The weight of each segment is from de Leva 1996. That trunk and legs move against a raised arm is from Bouisset and
 * Zattara 1987. The other amounts are ours, chosen by eye on the sample.
 *
 * Translated from metagraph/motion/weight_solve.py; change that, and translate anew.
 */

import { REACHED, bring, spread } from "./contact_solve.js";
import { back, dot, length, minus, plus, rotated, scaled, times } from "./plain_vectors.js";

export const BALANCE = 1.4; // factor of the arms' shift of the centre of mass by which the hips compensate
export const HASTE = 0.12; // seconds of the arms' speed that are added to the shift
export const DIP = 0.05; // seconds: arms that rise this fast press the body down, half as far at most
export const SPIN = 30; // seconds: how far the pelvis turns against what arms turn about the vertical
export const ROLL = 3; // radians that the pelvis rolls for a shift to a side of its own height, and
export const PITCH = 2; // bends for one ahead or back
export const MOST_SHIFT = 0.02; // of the height
export const MOST_TURN = 0.1; // radians
export const SITTING = 0.75; // how high a hip is above its ankle, of the leg's length: below this it does not stand
export const STANDING = 0.15; // and this much above it stands altogether
export const GIVE = 0.5; // of a shift: over so much a leg's full length makes itself felt

/**
 * A joint that turns. left, up, ahead: the character's directions in its own space. share: of the hips' rotation, below 0
 * for the opposite direction.
 *
 * place: number; left: [number, number, number]; up: [number, number, number]; ahead: [number, number, number]; share:
 * number.
 */
export class WeightBend {
  constructor(place, left, up, ahead, share) {
    this.place = place;
    this.left = left;
    this.up = up;
    this.ahead = ahead;
    this.share = share;
  }
}

/**
 * A collar bone. upper: the place of its arm. axis: what lifts it, in its own space. side: 0 left, 1 right.
 *
 * place: number; upper: number; axis: [number, number, number]; side: number.
 */
export class WeightCollar {
  constructor(place, upper, axis, side) {
    this.place = place;
    this.upper = upper;
    this.axis = axis;
    this.side = side;
  }
}

/**
 * The part of a skeleton that reacts to its arms. body: its joints; its `arms` are the legs, left and right, its `hands` the
 * names of the hands. bends: from the hips up. knees: the direction in which straight legs bend, in the upper legs' own
 * spaces. levers: how far the arms are to the left and ahead of the hips. up: the character's up direction. height: of the
 * figure, metres. strength: how much of the arms' layer counts, 0..1.
 *
 * body: ContactRig; bends: WeightBend[]; collars: WeightCollar[]; knees: [number, number, number][]; levers: [number,
 * number][]; up: [number, number, number]; height: number; strength: number.
 */
export class WeightRig {
  constructor(body, bends, collars, knees, levers, up, height, strength) {
    this.body = body;
    this.bends = bends;
    this.collars = collars;
    this.knees = knees;
    this.levers = levers;
    this.up = up;
    this.height = height;
    this.strength = strength;
  }
}

/**
 * Return whether there is anything to react to.
 * @param {number[]} drive
 * @returns {boolean}
 */
export function movesBody(drive) {
  return drive.some((x) => x !== 0);
}

/**
 * Change a pose of the rig's joints in reaction to its arms; return whether it changed.
 *
 * drive: as `posing.follow_through.driven` returns it. follow, lift: the user's dials. You need not call `spread` first.
 * @param {WeightRig} rig
 * @param {ContactPose} pose
 * @param {number[]} drive
 * @param {number} follow
 * @param {number} lift
 * @returns {boolean}
 */
export function answerArms(rig, pose, drive, follow, lift) {
  follow = follow * rig.strength;
  lift = lift * rig.strength;
  if ((follow <= 0 && lift <= 0) || !movesBody(drive)) {
    return false;
  }
  for (const collar of rig.collars) {
    const turn = _turn(collar.axis, lift * drive[6 + collar.side]);
    pose.local[collar.place] = times(pose.local[collar.place], turn);
    pose.local[collar.upper] = times(back(turn), pose.local[collar.upper]);
  }
  if (follow <= 0) {
    return true;
  }
  spread(rig.body, pose);
  follow = follow * standsBy(rig, pose);
  if (follow <= 0) {
    return true;
  }
  _giveWay(rig, pose, drive, follow);
  return true;
}

/**
 * Return how much a figure stands: 0 if it sits or lies, 1 on straight legs.
 * @param {WeightRig} rig
 * @param {ContactPose} pose
 * @returns {number}
 */
export function standsBy(rig, pose) {
  let least = 1;
  for (const leg of rig.body.arms) {
    const hip = pose.at[leg.upper];
    const knee = pose.at[leg.lower];
    const ankle = pose.at[leg.hand];
    const whole = length(minus(knee, hip)) + length(minus(ankle, knee));
    if (whole > 1e-06) {
      least = Math.min(least, dot(minus(hip, ankle), rig.up) / whole);
    }
  }
  const x = Math.min(Math.max((least - SITTING) / STANDING, 0), 1);
  return x * x * (3 - 2 * x);
}

/**
 * Shift and rotate the hips, undo that in the spine, and move the legs so that the feet stay.
 * @param {WeightRig} rig
 * @param {ContactPose} pose
 * @param {number[]} drive
 * @param {number} follow
 */
function _giveWay(rig, pose, drive, follow) {
  const body = rig.body;
  const vx = drive[8] + drive[11];
  const vy = drive[9] + drive[12];
  const vz = drive[10] + drive[13];
  let spin = 0;
  for (const { 0: side, 1: lever } of rig.levers.entries()) {
    const { 0: lx, 1: lz } = lever;
    spin += lz * drive[8 + 3 * side] - lx * drive[10 + 3 * side];
  }
  const most = MOST_SHIFT * rig.height;
  const x = _soft(-follow * BALANCE * (drive[0] + drive[3] + HASTE * vx), most);
  const y = _soft(-follow * DIP * vy, 0.5 * most);
  const z = _soft(-follow * BALANCE * (drive[2] + drive[5] + HASTE * vz), most);
  const yaw = _soft(-follow * SPIN * spin / (rig.height * rig.height), MOST_TURN);
  const roll = ROLL * x / rig.height;
  const pitch = -PITCH * z / rig.height;
  const feet = body.arms.map((leg) => pose.at[leg.hand]);
  const soles = body.arms.map((leg) => pose.turned[leg.hand]);
  const reaches = body.arms.map((leg) => length(minus(pose.at[leg.hand], pose.at[leg.upper])));
  const hips = rig.bends[0];
  let shift = plus(plus(scaled(hips.left, x), scaled(hips.up, y)), scaled(hips.ahead, z));
  shift = rotated(pose.turned[hips.place], shift);
  for (const bend of rig.bends) {
    const axis = plus(plus(scaled(bend.left, pitch), scaled(bend.up, yaw)), scaled(bend.ahead, roll));
    pose.local[bend.place] = times(pose.local[bend.place], _turn(axis, bend.share));
  }
  const above = body.parents[hips.place];
  const space = above < 0 ? [0, 0, 0, 1] : back(pose.turned[above]);
  pose.moved[hips.place] = plus(pose.moved[hips.place], rotated(space, shift));
  spread(body, pose);
  const size = length([x, y, z]) + 0.1 * rig.height * length([yaw, roll, pitch]);
  let low = 0;
  for (let side = 0; side < feet.length; side++) {
    low = Math.max(low, hipsSink(rig, pose, side, feet[side], reaches[side], GIVE * size));
  }
  if (low > 0) {
    const down = rotated(space, scaled(rig.up, -low));
    pose.moved[hips.place] = plus(pose.moved[hips.place], down);
    spread(body, pose);
  }
  for (let side = 0; side < feet.length; side++) {
    bring(body, pose, side, feet[side], soles[side], rig.knees[side]);
  }
}

/**
 * Return how far the hips have to sink so that the leg reaches the foot. It sets in gently, a little before the limit.
 * reach: the distance of hip and foot before.
 * @param {WeightRig} rig
 * @param {ContactPose} pose
 * @param {number} side
 * @param {[number, number, number]} foot
 * @param {number} reach
 * @param {number} soft
 * @returns {number}
 */
export function hipsSink(rig, pose, side, foot, reach, soft) {
  const leg = rig.body.arms[side];
  const hip = pose.at[leg.upper];
  const knee = pose.at[leg.lower];
  const ankle = pose.at[leg.hand];
  const whole = length(minus(knee, hip)) + length(minus(ankle, knee));
  const most = Math.max(REACHED * whole, reach);
  const way = minus(hip, foot);
  const high = dot(way, rig.up);
  const aside = dot(way, way) - high * high;
  if (high <= 0 || aside >= most * most || soft <= 0) {
    return 0;
  }
  const over = high - Math.sqrt(most * most - aside);
  if (over >= soft) {
    return over;
  }
  return over <= -soft ? 0 : (over + soft) * (over + soft) / (4 * soft);
}

/**
 * Return a number limited smoothly to below `most`; small numbers stay almost as they are.
 * @param {number} x
 * @param {number} most
 * @returns {number}
 */
function _soft(x, most) {
  return x / Math.sqrt(1 + x / most * (x / most));
}

/**
 * Return the rotation about an axis by its length times an angle, radians.
 * @param {[number, number, number]} axis
 * @param {number} angle
 * @returns {[number, number, number, number]}
 */
function _turn(axis, angle) {
  const { 0: x, 1: y, 2: z } = axis;
  const size = length(axis);
  if (size <= 0) {
    return [0, 0, 0, 1];
  }
  const half = 0.5 * size * angle;
  const k = Math.sin(half) / size;
  return [x * k, y * k, z * k, Math.cos(half)];
}
