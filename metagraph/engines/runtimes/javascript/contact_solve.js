/**
 * Keep hands in contact with the body, and outside it, by moving two-bone arms to their goals.
 *
 * The body's parts are capsules, each fixed to a joint. Rotations are quaternions xyzw, lengths metres; a place is an index
 * into a rig's list of joints. The code computes one pose at a time, with plain numbers, the same in all languages.
 *
 * Translated from metagraph/motion/contact_solve.py; change that, and translate anew.
 */

import { back, between, dot, length, minus, plus, rotated, scaled, times, unit, unitTurn } from "./plain_vectors.js";
import { range } from "./basics.js";

export const REACHED = 0.995; // of an arm's length: it does not snap straight
export const FOLDED = 0.906; // cosine of the least angle inside an elbow, 25 degrees
export const WRIST = 0.819; // cosine of half of how far a contact may turn a hand from where it was, 70 degrees
export const SOFT = 0.006; // metres of depth over which the push out of the body sets in
export const FIRM = 0.03; // metres of depth from which on a part resists what pushes towards it
export const THROUGH = 0.25; // of both radii: who is nearer to the other's line passes through it
export const FULL = 0.9; // from here on, it is pushed all the way
export const EVEN = 0.05; // how much the middle counts where lines are side by side
export const STRAIGHT = [0.31, 0.52, 0.8]; // where a straight arm bends to: no side in particular, but always one
export const ELBOW = 0.3; // how little a forearm is pushed near its elbow, which a wrist cannot move
export const PASSES = 3; // of the guard
export const OBSTACLE = 0; // what a capsule is to the guard: others are pushed out of it
export const FOREARM = 1; // pushed out, from the elbow to the wrist
export const HAND = 2; // pushed out

/**
 * The places of an arm's joints, and of all joints from its upper arm on, parents first.
 *
 * upper: number; lower: number; hand: number; below: number[].
 */
export class ContactArm {
  constructor(upper, lower, hand, below) {
    this.upper = upper;
    this.lower = lower;
    this.hand = hand;
    this.below = below;
  }
}

/**
 * A part of the body. joint, to: the places of the joints that carry the ends of its line; a, b: where the ends are, in the
 * spaces of those joints. arm: 0 left, 1 right, -1 neither. kind: whether it is pushed out of others: an OBSTACLE is not; a
 * FOREARM, from the elbow to the wrist, and a HAND are.
 *
 * joint: number; a: [number, number, number]; to: number; b: [number, number, number]; radius: number; arm: number; kind:
 * number.
 */
export class BodyCapsule {
  constructor(joint, a, to, b, radius, arm = -1, kind = 0) {
    this.joint = joint;
    this.a = a;
    this.to = to;
    this.b = b;
    this.radius = radius;
    this.arm = arm;
    this.kind = kind;
  }
}

/**
 * The part of a skeleton that contacts need. joints: parents first. parents: for each joint, the place of its parent, -1 for
 * a root. places: joint name -> place. arms: left, right; hands: the names of their hands. contacts, guard: whether each is
 * on.
 *
 * joints: number[]; parents: number[]; places: Map<string, number>; arms: ContactArm[]; hands: string[]; capsules:
 * BodyCapsule[]; contacts: boolean; guard: boolean.
 */
export class ContactRig {
  constructor(joints, parents, places, arms, hands, capsules, contacts = true, guard = true) {
    this.joints = joints;
    this.parents = parents;
    this.places = places;
    this.arms = arms;
    this.hands = hands;
    this.capsules = capsules;
    this.contacts = contacts;
    this.guard = guard;
  }
}

/**
 * Where a wrist should be. arm: 0 left, 1 right. to: a place; at, turn: in its space. weight: 0..1.
 *
 * arm: number; to: number; at: [number, number, number]; turn: [number, number, number, number]; weight: number.
 */
export class HandGoal {
  constructor(arm, to, at, turn, weight) {
    this.arm = arm;
    this.to = to;
    this.at = at;
    this.turn = turn;
    this.weight = weight;
  }
}

/**
 * A pose of a rig's joints: `local` rotations and `moved` translations are in the parents' space; `turned` and `at` are in
 * the character's space, and `spread` computes them.
 *
 * local: [number, number, number, number][]; moved: [number, number, number][]; turned: [number, number, number, number][];
 * at: [number, number, number][].
 */
export class ContactPose {
  constructor(local = [], moved = [], turned = [], at = []) {
    this.local = local;
    this.moved = moved;
    this.turned = turned;
    this.at = at;
  }
}

/**
 * Compute where all joints are.
 * @param {ContactRig} rig
 * @param {ContactPose} pose
 */
export function spread(rig, pose) {
  pose.turned = [...pose.local];
  pose.at = [...pose.moved];
  for (let place = 0; place < rig.parents.length; place++) {
    _join(rig, pose, place);
  }
}

/**
 * @param {ContactRig} rig
 * @param {ContactPose} pose
 * @param {number} place
 */
function _join(rig, pose, place) {
  const above = rig.parents[place];
  if (above < 0) {
    pose.turned[place] = pose.local[place];
    pose.at[place] = pose.moved[place];
  } else {
    const turn = pose.turned[above];
    const { 0: x, 1: y, 2: z } = rotated(turn, pose.moved[place]);
    const { 0: ax, 1: ay, 2: az } = pose.at[above];
    pose.turned[place] = times(turn, pose.local[place]);
    pose.at[place] = [ax + x, ay + y, az + z];
  }
}

/**
 * Move hands to their goals, then push hands and forearms out of the body; return whether anything moved. Call `spread`
 * first.
 * @param {ContactRig} rig
 * @param {ContactPose} pose
 * @param {HandGoal[]} goals
 * @returns {boolean}
 */
export function solveContacts(rig, pose, goals) {
  let moved = false;
  const held = [0, 0];
  let across = 0; // how much one arm is held on the other
  for (const goal of goals) {
    held[goal.arm] = Math.min(1, held[goal.arm] + goal.weight);
    if (_onArm(rig, goal.to, 1 - goal.arm)) {
      across = Math.max(across, goal.weight);
    }
  }
  let rounds = goals.length === 0 ? 0 : across > 0 ? 2 : 1;
  const wrists = rig.arms.map((arm) => pose.at[arm.hand]);
  const hands = rig.arms.map((arm) => pose.turned[arm.hand]);
  while (rounds > 0) {
    rounds -= 1;
    for (let side = 0; side < rig.arms.length; side++) {
      if (held[side] > 0) {
        _hold(rig, pose, goals, side, wrists[side], hands[side]);
        moved = true;
      }
    }
  }
  const kept = rig.arms.map((arm) => pose.at[arm.hand]);
  if (rig.guard && _guarded(rig, pose, held, across)) {
    moved = true;
    for (let side = 0; side < rig.arms.length; side++) {
      if (across > 0 && held[side] > 0) {
        const pushed = minus(pose.at[rig.arms[side].hand], kept[side]);
        _hold(rig, pose, goals, side, plus(wrists[side], pushed), hands[side]);
      }
    }
  }
  return moved;
}

/**
 * @param {ContactRig} rig
 * @param {number} place
 * @param {number} arm
 * @returns {boolean}
 */
function _onArm(rig, place, arm) {
  return rig.arms[arm].below.some((below) => place === below);
}

/**
 * Move a hand to the weighted mean of its goals. wrist, hand: its position and rotation without goals.
 * @param {ContactRig} rig
 * @param {ContactPose} pose
 * @param {HandGoal[]} goals
 * @param {number} side
 * @param {[number, number, number]} wrist
 * @param {[number, number, number, number]} hand
 */
function _hold(rig, pose, goals, side, wrist, hand) {
  let total = 0;
  let x = 0;
  let y = 0;
  let z = 0;
  let a = 0;
  let b = 0;
  let c = 0;
  let d = 0;
  const { 0: hx, 1: hy, 2: hz, 3: hw } = hand;
  let k;
  for (const goal of goals) {
    if (goal.arm === side && goal.weight > 0) {
      k = goal.weight;
      const { 0: px, 1: py, 2: pz } = plus(pose.at[goal.to], rotated(pose.turned[goal.to], goal.at));
      const { 0: qx, 1: qy, 2: qz, 3: qw } = times(pose.turned[goal.to], goal.turn);
      x = x + k * px;
      y = y + k * py;
      z = z + k * pz;
      total = total + k;
      if (qx * hx + qy * hy + qz * hz + qw * hw < 0) {
        k = -k;
      }
      a = a + k * qx;
      b = b + k * qy;
      c = c + k * qz;
      d = d + k * qw;
    }
  }
  const weight = Math.min(1, total);
  const mean = [x / total, y / total, z / total];
  let turn = _withinWrist(hand, unitTurn([a, b, c, d]));
  const { 0: tx, 1: ty, 2: tz, 3: tw } = turn;
  const rest = 1 - weight;
  k = tx * hx + ty * hy + tz * hz + tw * hw < 0 ? -weight : weight;
  turn = unitTurn([hx * rest + tx * k, hy * rest + ty * k, hz * rest + tz * k, hw * rest + tw * k]);
  bring(rig, pose, side, plus(wrist, scaled(minus(mean, wrist), weight)), turn, STRAIGHT);
}

/**
 * Return a hand's rotation, limited to what the wrist allows from the hand's earlier rotation.
 * @param {[number, number, number, number]} hand
 * @param {[number, number, number, number]} turn
 * @returns {[number, number, number, number]}
 */
function _withinWrist(hand, turn) {
  let { 0: x, 1: y, 2: z, 3: w } = times(turn, back(hand));
  if (w < 0) {
    x = -x;
    y = -y;
    z = -z;
    w = -w;
  }
  if (w >= WRIST) {
    return turn;
  }
  const k = Math.sqrt(1 - WRIST * WRIST) / Math.max(Math.sqrt(x * x + y * y + z * z), 1e-12);
  return times([x * k, y * k, z * k, WRIST], hand);
}

/**
 * Move a wrist to a goal, or as near as the arm reaches, with the elbow on the side to which it is bent; rotate the hand.
 * side_of: the direction in which a straight arm bends, in the upper arm's own space.
 * @param {ContactRig} rig
 * @param {ContactPose} pose
 * @param {number} side
 * @param {[number, number, number]} goal
 * @param {[number, number, number, number]} hand
 * @param {[number, number, number]} sideOf
 */
export function bring(rig, pose, side, goal, hand, sideOf) {
  const arm = rig.arms[side];
  const root = pose.at[arm.upper];
  const elbow = pose.at[arm.lower];
  const wrist = pose.at[arm.hand];
  const bone = minus(elbow, root);
  const fore = minus(wrist, elbow);
  const aboveElbow = length(bone);
  const belowElbow = length(fore);
  const now = length(minus(wrist, root));
  if (aboveElbow < 1e-06 || belowElbow < 1e-06 || now < 1e-06) {
    return;
  }
  const way = minus(goal, root);
  const most = Math.max(REACHED * (aboveElbow + belowElbow), now);
  const least = Math.min(
    Math.sqrt(aboveElbow * aboveElbow + belowElbow * belowElbow - 2 * FOLDED * aboveElbow * belowElbow),
    now
  );
  const far = Math.min(Math.max(length(way), least), most);
  const ahead = unit(way);
  const before = scaled(minus(wrist, root), 1 / now);
  let aside = minus(bone, scaled(before, dot(bone, before)));
  // A straight arm has no side: it bends to one that goes with its bone.
  let spare = rotated(pose.turned[arm.upper], sideOf);
  spare = minus(spare, scaled(before, dot(spare, before)));
  aside = plus(aside, scaled(spare, Math.max(0, 0.01 * aboveElbow - length(aside))));
  aside = unit(rotated(between(before, ahead), aside));
  const along = (aboveElbow * aboveElbow + far * far - belowElbow * belowElbow) / (2 * far);
  const high = Math.sqrt(Math.max(0, aboveElbow * aboveElbow - along * along));
  const knee = plus(scaled(ahead, along), scaled(aside, high));
  const swing = between(unit(bone), unit(knee));
  const fold = between(unit(rotated(swing, fore)), unit(minus(scaled(ahead, far), knee)));
  const both = times(fold, swing);
  let above = _above(rig, pose, arm.upper);
  pose.local[arm.upper] = times(back(above), times(swing, pose.turned[arm.upper]));
  above = times(swing, _above(rig, pose, arm.lower));
  pose.local[arm.lower] = times(back(above), times(both, pose.turned[arm.lower]));
  above = times(both, _above(rig, pose, arm.hand));
  pose.local[arm.hand] = times(back(above), hand);
  for (const place of arm.below) {
    _join(rig, pose, place);
  }
}

/**
 * @param {ContactRig} rig
 * @param {ContactPose} pose
 * @param {number} place
 * @returns {[number, number, number, number]}
 */
function _above(rig, pose, place) {
  const above = rig.parents[place];
  return above < 0 ? [0, 0, 0, 1] : pose.turned[above];
}

/**
 * Push forearms and hands out of the capsules they are inside, by the smallest shift of the wrists; return whether any was
 * inside. held: how much a contact holds each hand, which is then not pushed.
 *
 * An arm that passes through a capsule is pushed to one side before the middle and to the other side after it. The push gets
 * weaker towards the middle, so that the arm does not jump.
 * @param {ContactRig} rig
 * @param {ContactPose} pose
 * @param {number[]} held
 * @param {number} across
 * @returns {boolean}
 */
function _guarded(rig, pose, held, across) {
  const local = [...pose.local];
  const turned = [...pose.turned];
  const at = [...pose.at];
  const whole = [1, 1];
  let moved = false;
  for (let number = 0; number < PASSES; number++) {
    const ends = capsuleEnds(rig, pose);
    const balls = _balls(rig, ends);
    let found = false;
    const first = number === 0;
    const shifts = range(rig.arms.length).map((side) => _shift(rig, ends, balls, side, held, across, whole, first));
    for (const { 0: side, 1: shift } of shifts.entries()) {
      if (length(shift) > 0) {
        const hand = rig.arms[side].hand;
        bring(rig, pose, side, plus(pose.at[hand], shift), pose.turned[hand], STRAIGHT);
        found = true;
      }
    }
    if (!found) {
      break;
    }
    moved = true;
  }
  if (moved && Math.min(whole[0], whole[1]) < 1) {
    const goals = rig.arms.map((arm) => pose.at[arm.hand]);
    pose.local = local;
    pose.turned = turned;
    pose.at = at;
    for (const { 0: side, 1: arm } of rig.arms.entries()) {
      const way = minus(goals[side], pose.at[arm.hand]);
      if (length(way) > 0) {
        const goal = plus(pose.at[arm.hand], scaled(way, whole[side]));
        bring(rig, pose, side, goal, pose.turned[arm.hand], STRAIGHT);
      }
    }
  }
  return moved;
}

/**
 * Return both ends of every capsule's line, one after the other.
 * @param {ContactRig} rig
 * @param {ContactPose} pose
 * @returns {[number, number, number][]}
 */
export function capsuleEnds(rig, pose) {
  const out = [];
  for (const capsule of rig.capsules) {
    out.push(plus(pose.at[capsule.joint], rotated(pose.turned[capsule.joint], capsule.a)));
    out.push(plus(pose.at[capsule.to], rotated(pose.turned[capsule.to], capsule.b)));
  }
  return out;
}

/**
 * Return a ball round each capsule: its middle and radius.
 * @param {ContactRig} rig
 * @param {[number, number, number][]} ends
 * @returns {[number, number, number, number][]}
 */
function _balls(rig, ends) {
  const out = [];
  for (const { 0: n, 1: capsule } of rig.capsules.entries()) {
    const { 0: ax, 1: ay, 2: az } = ends[2 * n];
    const { 0: bx, 1: by, 2: bz } = ends[2 * n + 1];
    const x = bx - ax;
    const y = by - ay;
    const z = bz - az;
    const size = 0.5 * Math.sqrt(x * x + y * y + z * z) + capsule.radius;
    out.push([ax + 0.5 * x, ay + 0.5 * y, az + 0.5 * z, size]);
  }
  return out;
}

/**
 * Return the shift of a wrist that brings its arm out of all other capsules, or closer to that. whole: for each side, the
 * share of the shift to apply, which the first pass finds.
 * @param {ContactRig} rig
 * @param {[number, number, number][]} ends
 * @param {[number, number, number, number][]} balls
 * @param {number} side
 * @param {number[]} held
 * @param {number} across
 * @param {number[]} whole
 * @param {boolean} first
 * @returns {[number, number, number]}
 */
function _shift(rig, ends, balls, side, held, across, whole, first) {
  let shift = [0, 0, 0];
  const own = 1 - held[side];
  if (own <= 0) {
    return shift;
  }
  for (const { 0: i, 1: mine } of rig.capsules.entries()) {
    if (mine.arm !== side || mine.kind === OBSTACLE) {
      continue;
    }
    const { 0: mx, 1: my, 2: mz, 3: size } = balls[i];
    for (let k = 0; k < balls.length; k++) {
      const { 0: ox, 1: oy, 2: oz, 3: most } = balls[k];
      const dx = ox - mx;
      const dy = oy - my;
      const dz = oz - mz;
      const reach = most + size;
      if (dx * dx + dy * dy + dz * dz >= reach * reach) {
        continue; // most are nowhere near
      }
      const other = rig.capsules[k];
      if (other.arm === side) {
        continue;
      }
      let share = own;
      if (other.arm >= 0) {
        share = Math.min(own, 1 - across);
        if (other.kind !== OBSTACLE) { // both give way
          share = share * (1 - 0.5 * (1 - held[other.arm]));
        }
      }
      if (share <= 0) {
        continue;
      }
      const { 0: x, 1: y, 2: z, 3: gap } = apart(ends, 2 * i, 2 * k);
      const radii = mine.radius + other.radius;
      if (gap >= radii || gap < 1e-09) {
        continue;
      }
      const depth = radii - gap;
      let amount = depth > SOFT ? depth - 0.5 * SOFT : depth * depth / (2 * SOFT);
      // Near to the line it is not pushed all the way, and about it not at all.
      let inner = Math.min(1, Math.max(0, (gap / radii - THROUGH) / (FULL - THROUGH)));
      inner = inner * inner * (3 - 2 * inner);
      if (first) {
        whole[side] = Math.min(whole[side], 1 - share * (1 - inner));
        inner = 1;
      }
      amount = amount * share * inner;
      const part = mine.kind === FOREARM ? _along(ends, 2 * i, 2 * k) : 1;
      const way = [x / gap, y / gap, z / gap];
      let pushed = part * dot(way, shift);
      if (pushed < 0) { // others push towards it: what hardly touches or hardly counts hardly resists
        pushed = pushed * share * Math.min(1, depth / FIRM);
      }
      const left = amount - pushed;
      if (left > 0) {
        shift = plus(shift, scaled(way, left * part / (part * part + ELBOW * (1 - part))));
      }
    }
  }
  return shift;
}

/**
 * Return where on the line that begins at `ends[i]` the shortest way from the line at `ends[k]` ends, 0..1. For nearly
 * parallel lines, where it could end anywhere, the result moves towards the middle.
 * @param {[number, number, number][]} ends
 * @param {number} i
 * @param {number} k
 * @returns {number}
 */
function _along(ends, i, k) {
  const a = ends[i];
  const c = ends[k];
  const u = minus(ends[i + 1], a);
  const v = minus(ends[k + 1], c);
  const w = minus(a, c);
  const uu = dot(u, u);
  const uv = dot(u, v);
  const vv = dot(v, v);
  const uw = dot(u, w);
  const vw = dot(v, w);
  if (uu <= 1e-12) {
    return 0;
  }
  const stiff = (1 + EVEN) * uu;
  const middle = 0.5 * EVEN * uu - uw;
  if (vv <= 1e-12) {
    return Math.min(Math.max(middle / stiff, 0), 1);
  }
  let s = Math.min(Math.max((vv * middle + uv * vw) / (stiff * vv - uv * uv), 0), 1);
  const t = (uv * s + vw) / vv;
  if (t < 0 || t > 1) {
    s = Math.min(Math.max((uv * Math.min(Math.max(t, 0), 1) + middle) / stiff, 0), 1);
  }
  return s;
}

/**
 * Return the shortest way from the line that begins at `ends[k]` to the one at `ends[i]`, and its length. Its vectors are
 * written out, since a guarded pose asks some thirty times.
 * @param {[number, number, number][]} ends
 * @param {number} i
 * @param {number} k
 * @returns {[number, number, number, number]}
 */
export function apart(ends, i, k) {
  const { 0: ax, 1: ay, 2: az } = ends[i];
  const { 0: bx, 1: by, 2: bz } = ends[i + 1];
  const { 0: cx, 1: cy, 2: cz } = ends[k];
  const { 0: dx, 1: dy, 2: dz } = ends[k + 1];
  const ux = bx - ax;
  const uy = by - ay;
  const uz = bz - az;
  const vx = dx - cx;
  const vy = dy - cy;
  const vz = dz - cz;
  const wx = ax - cx;
  const wy = ay - cy;
  const wz = az - cz;
  const uu = ux * ux + uy * uy + uz * uz;
  const uv = ux * vx + uy * vy + uz * vz;
  const vv = vx * vx + vy * vy + vz * vz;
  const uw = ux * wx + uy * wy + uz * wz;
  const vw = vx * wx + vy * wy + vz * wz;
  let s = 0;
  let t = 0;
  if (uu > 1e-12) {
    const below = uu * vv - uv * uv;
    if (below > 1e-09 * uu * vv) {
      s = Math.min(Math.max((uv * vw - vv * uw) / below, 0), 1);
    }
    if (vv > 1e-12) {
      t = (uv * s + vw) / vv;
      if (t < 0 || t > 1) {
        t = Math.min(Math.max(t, 0), 1);
        s = Math.min(Math.max((uv * t - uw) / uu, 0), 1);
      }
    } else {
      s = Math.min(Math.max(-uw / uu, 0), 1);
    }
  } else if (vv > 1e-12) {
    t = Math.min(Math.max(vw / vv, 0), 1);
  }
  const x = wx + ux * s - vx * t;
  const y = wy + uy * s - vy * t;
  const z = wz + uz * s - vz * t;
  return [x, y, z, Math.sqrt(x * x + y * y + z * z)];
}
