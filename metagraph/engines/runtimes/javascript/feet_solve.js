/**
 * Move feet to where they should stand, with two-bone legs whose knees keep their direction. The hips move along and sink,
 * so that no leg snaps straight.
 *
 * Rotations are quaternions xyzw, lengths metres. The code computes one pose at a time, with plain numbers, the same in all
 * languages. All amounts are ours, chosen by eye.
 *
 * Translated from metagraph/motion/feet_solve.py; change that, and translate anew.
 */

import { bring, spread } from "./contact_solve.js";
import { back, dot, length, minus, plus, rotated, scaled, times, unitTurn } from "./plain_vectors.js";
import { GIVE, hipsSink, standsBy } from "./weight_solve.js";

export const NEAR = 0.0001; // metres that a foot may be away before it is brought
export const NEARLY = 0.001; // radians that it may be turned away
export const FOLLOWS = 0.7; // of the feet's way the hips come along
export const LEANS = 0.1; // of the way to the foot that stands, while the other is
export const HIGH = 0.05; // metres in the air
export const TURNING = 0.15; // metres that a turn of a radian counts as way

/**
 * Where a foot's joint should be, in the character's space. planted: how firmly it stands there, 0..1. lift: height of a
 * step above that, metres.
 *
 * at: [number, number, number]; turn: [number, number, number, number]; planted: number; lift: number.
 */
export class FootGoal {
  constructor(at, turn, planted, lift) {
    this.at = at;
    this.turn = turn;
    this.planted = planted;
    this.lift = lift;
  }
}

/**
 * Return the distance between two places of a foot, in metres; a rotation counts as a distance, too.
 * @param {FootGoal} a
 * @param {FootGoal} b
 * @returns {number}
 */
export function footWay(a, b) {
  const { 0: ax, 1: ay, 2: az, 3: aw } = a.turn;
  const { 0: bx, 1: by, 2: bz, 3: bw } = b.turn;
  const along = Math.abs(ax * bx + ay * by + az * bz + aw * bw);
  const turn = 2 * Math.sqrt(Math.max(0, 2 - 2 * along));
  return length(minus(b.at, a.at)) + TURNING * turn;
}

/**
 * Move feet to their goals, as far as these are planted; return whether anything moved. goals: left and right, or none.
 * strength: the user's dial. You need not call `spread` first.
 * @param {WeightRig} rig
 * @param {ContactPose} pose
 * @param {FootGoal[]} goals
 * @param {number} strength
 * @returns {boolean}
 */
export function plantFeet(rig, pose, goals, strength) {
  if (goals.length !== 2 || strength <= 0) {
    return false;
  }
  const body = rig.body;
  spread(body, pose);
  strength = strength * standsBy(rig, pose);
  if (strength <= 0) {
    return false;
  }
  const feet = body.arms.map((leg) => pose.at[leg.hand]);
  const soles = body.arms.map((leg) => pose.turned[leg.hand]);
  const reaches = body.arms.map((leg) => length(minus(pose.at[leg.hand], pose.at[leg.upper])));
  const hips = rig.bends[0].place;
  const middle = pose.at[hips];
  let shift = [0, 0, 0];
  let size = 0;
  let moved = false;
  for (let side = 0; side < 2; side++) {
    const goal = goals[side];
    const part = strength * goal.planted;
    let way = minus(plus(goal.at, scaled(rig.up, goal.lift)), feet[side]);
    const far = length(way);
    if (far > NEAR && part > 0) {
      way = scaled(way, part * (far - NEAR) / far);
      const lean = LEANS * part * goal.lift / HIGH;
      shift = plus(shift, plus(scaled(way, 0.5 * FOLLOWS), scaled(minus(feet[1 - side], middle), lean)));
      feet[side] = plus(feet[side], way);
      size += length(way);
      moved = true;
    }
    const { 0: x, 1: y, 2: z, 3: w } = times(goal.turn, back(soles[side]));
    const turn = 2 * Math.sqrt(x * x + y * y + z * z);
    if (turn > NEARLY && part > 0) {
      const k = part * (turn - NEARLY) / turn;
      const along = w < 0 ? -k : k; // the shorter way
      const turned = unitTurn([x * along, y * along, z * along, 1 - k + Math.abs(w) * k]);
      soles[side] = times(turned, soles[side]);
      moved = true;
    }
  }
  if (!moved) {
    return false;
  }
  shift = minus(shift, scaled(rig.up, dot(shift, rig.up)));
  const above = body.parents[hips];
  const space = above < 0 ? [0, 0, 0, 1] : back(pose.turned[above]);
  pose.moved[hips] = plus(pose.moved[hips], rotated(space, shift));
  spread(body, pose);
  const soft = GIVE * (size + length(shift));
  let low = 0;
  for (let side = 0; side < 2; side++) {
    low = Math.max(low, hipsSink(rig, pose, side, feet[side], reaches[side], soft));
  }
  if (low > 0) {
    pose.moved[hips] = plus(pose.moved[hips], rotated(space, scaled(rig.up, -low)));
    spread(body, pose);
  }
  for (let side = 0; side < 2; side++) {
    bring(body, pose, side, feet[side], soles[side], rig.knees[side]);
  }
  return true;
}
