/**
 * How a figure stands: the rest pose that turns are computed from, its measures, and what brings one figure's rest pose to another's.
 *
 * All is in the character's axes: +X to its left, +Y up, +Z ahead; metres. As metagraph/motion/standing.py and limbs.py, a pose at a time.
 */

import { back, between, dot, length, minus, plus, rotated, scaled, times, unit, unitTurn } from "../plain_vectors.js";
import { ARM, FINGERS, LEG, NEEDED } from "./roles.js";

export const STILL = [0, 0, 0, 1];
export const SIDES = ["left", "right"];
const SHORT = 1e-4; // metres: a bone shorter than this has no direction

/** What a figure cannot be used for, in words. */
export class AvatarError extends Error {}

/** A rest pose: `rotations` and `positions` of its joints, by role. */
export class Figure {
  /**
   * @param {Map<string, number>} roles @param {number[][]} rotations [J] @param {number[][]} positions [J] in the file's axes
   * @param {string} whose for what goes wrong @throws {AvatarError}
   */
  constructor(roles, rotations, positions, whose) {
    const missing = NEEDED.filter((role) => !roles.has(role)).map((role) => role.replaceAll("_", " "));
    if (missing.length) {
      const more = missing.length > 3 ? ` and ${missing.length - 3} more` : "";
      throw new AvatarError(`${whose} is no humanoid: no joint was found for ${missing.slice(0, 3).join(", ")}${more}`);
    }
    this.roles = roles;
    this.positions = positions;
    const across = ["upper_leg", "upper_arm"].map((part) => minus(this.at(`left_${part}`), this.at(`right_${part}`))).reduce(plus);
    // Axes are those of the file, turned by quarters: a figure that looks a little aside does look aside.
    const quarter = (Math.round(Math.atan2(across[2], across[0]) / (Math.PI / 2)) * Math.PI) / 2;
    this.turn = [0, Math.sin(quarter / 2), 0, Math.cos(quarter / 2)];
    this.rotations = rotations.map((q) => times(this.turn, q));
    this.positions = positions.map((p) => rotated(this.turn, p));
    const legs = SIDES.map((side) => minus(this.at(`${side}_upper_leg`), this.at(`${side}_foot`)));
    const upright = Math.min(...[minus(this.at("head"), this.at("hips")), ...legs].map((v) => unit(v)[1]));
    if (!(upright > 0.5)) throw new AvatarError(`${whose} does not stand in its rest pose`);
    this.legLength = this.limb(LEG);
    this.armLength = this.limb(ARM);
    this.hip = this.middle("upper_leg");
    this.ankle = this.middle("foot")[1];
    this.halfHips = this.half("upper_leg");
    this.halfShoulders = this.half("upper_arm");
  }

  at(role) {
    return this.positions[this.roles.get(role)];
  }

  middle(part) {
    return scaled(plus(this.at(`left_${part}`), this.at(`right_${part}`)), 0.5);
  }

  half(part) {
    return Math.max(1e-3, length(minus(this.at(`left_${part}`), this.at(`right_${part}`))) / 2);
  }

  /** Return how long the bones of a side's limb are. */
  bones(side, [upper, lower, end]) {
    const [a, b, c] = [upper, lower, end].map((part) => this.at(`${side}_${part}`));
    return [length(minus(b, a)), length(minus(c, b))].map((x) => Math.max(1e-4, x));
  }

  /** Return the mean length of both sides' limbs. */
  limb(parts) {
    return Math.max(1e-3, SIDES.flatMap((side) => this.bones(side, parts)).reduce((a, b) => a + b) / 2);
  }

  /** Return how much the figure is lifted so that it stands on the ground: a rest pose may float. */
  get floating() {
    const low = Math.min(...this.positions.map((p) => p[1]));
    return Math.abs(low) > 0.25 * this.legLength ? low : 0;
  }
}

/** Return the turn whose Y lies along `first` and whose X as near as can be along `second`. */
function frameOf(first, second) {
  const y = unit(first);
  const x = unit(minus(second, scaled(y, dot(second, y))));
  const z = [x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]];
  const raise = between([0, 1, 0], y); // then about y until X fits
  const from = rotated(raise, [1, 0, 0]);
  const angle = Math.atan2(-dot(from, z), dot(from, x));
  return times([...scaled(y, -Math.sin(angle / 2)), Math.cos(angle / 2)], raise);
}

/** Return for each shared role the turn that brings the target's rest pose to the source's. @returns {Map<string, number[]>} */
export function alignRests(source, target, shared) {
  const out = new Map(shared.map((role) => [role, STILL]));
  const bone = (figure, role, tips) => minus(scaled(tips.map((tip) => figure.at(tip)).reduce(plus), 1 / tips.length), figure.at(role));
  const follow = (role, before, ...tips) => {
    const known = tips.filter((tip) => out.has(tip));
    let turn = before;
    if (known.length) {
      const [wanted, own] = [bone(source, role, known), bone(target, role, known)];
      if (Math.min(length(wanted), length(own)) > SHORT) turn = times(between(unit(rotated(before, own)), unit(wanted)), before);
    }
    out.set(role, turn);
    return turn;
  };
  for (const side of SIDES) {
    const name = (part) => `${side}_${part}`;
    follow(name("lower_leg"), follow(name("upper_leg"), STILL, name("lower_leg")), name("foot"));
    out.set(name("foot"), out.has(name("toes")) ? headingBetween(source, target, side) : STILL);
    if (out.has(name("toes"))) out.set(name("toes"), out.get(name("foot")));
    let hand = follow(name("lower_arm"), follow(name("upper_arm"), STILL, name("lower_arm")), name("hand"));
    const knuckles = FINGERS.slice(1).map((finger) => name(`${finger}_1`)).filter((role) => out.has(role));
    hand = follow(name("hand"), hand, ...knuckles);
    if (knuckles.length > 1) {
      const [a, b] = [source, target].map((figure) => {
        return frameOf(bone(figure, name("hand"), knuckles), minus(figure.at(knuckles[0]), figure.at(knuckles.at(-1))));
      });
      hand = times(a, back(b));
      out.set(name("hand"), hand);
    }
    for (const finger of FINGERS) {
      let turn = hand;
      for (const n of [1, 2, 3]) if (out.has(name(`${finger}_${n}`))) turn = follow(name(`${finger}_${n}`), turn, name(`${finger}_${n + 1}`));
    }
  }
  return out;
}

/** Return the turn about the vertical from where the target's foot points to where the source's does; soles stay flat. */
function headingBetween(source, target, side) {
  const angles = [source, target].map((figure) => {
    const ahead = minus(figure.at(`${side}_toes`), figure.at(`${side}_foot`));
    return Math.hypot(ahead[0], ahead[2]) < 1e-3 ? null : Math.atan2(ahead[0], ahead[2]);
  });
  if (angles.includes(null)) return STILL;
  const half = (angles[0] - angles[1]) / 2;
  return [0, Math.sin(half), 0, Math.cos(half)];
}

/** Return a turn to a part of its angle, the short way. */
export function partOf(q, weight) {
  const sign = q[3] < 0 ? -1 : 1;
  const s = Math.hypot(q[0], q[1], q[2]);
  if (s < 1e-9) return STILL;
  const half = weight * Math.atan2(s, sign * q[3]);
  return unitTurn([...scaled([q[0], q[1], q[2]], (sign * Math.sin(half)) / s), Math.cos(half)]);
}

const STRAIGHT = 0.02; // of the upper bone: a joint less than this beside the line of its limb that has to bend further bends to its pole

/**
 * Return where the middle joint and the end of a limb of two bones come to, from its root. It bends as `source` does, three places, or to
 * `pole` where that is straight; `start`: the direction from which turns about the limb are computed.
 */
export function solveLimb(goal, one, two, start, [root, middle, end], pole) {
  const to = intoReach(goal, Math.abs(one - two) + 1e-3 * (one + two), one + two);
  const far = length(to);
  const ahead = scaled(to, 1 / far);
  const way = unit(minus(end, root)), knee = unit(minus(middle, root));
  let aside = minus(knee, scaled(way, dot(knee, way)));
  aside = rotated(between(unit(start), ahead), rotated(back(between(unit(start), way)), aside));
  const square = minus(pole, scaled(ahead, dot(pole, ahead)));
  const along = (one * one + far * far - two * two) / (2 * far);
  const out = Math.sqrt(Math.max(0, one * one - along * along));
  const size = length(aside);
  const more = Math.min(Math.max((out / one - size) / STRAIGHT, 0), 1);
  aside = unit(plus(aside, scaled(square, Math.max(0, STRAIGHT - size) * more)));
  return [plus(scaled(ahead, along), scaled(aside, out)), to];
}

/** Return a place moved into reach sideways, so that its height stays. */
function intoReach([x, y, z], least, most) {
  const high = Math.min(Math.max(y, -most), most);
  let flat = Math.hypot(x, z);
  const fit = Math.min(1, Math.sqrt(Math.max(0, most * most - high * high)) / Math.max(flat, 1e-9));
  let [a, b] = [x * fit, z * fit];
  flat *= fit;
  if (flat < 1e-6) b = flat = 1e-6; // straight above or below: out to the front
  const out = Math.max(1, Math.sqrt(Math.max(0, least * least - high * high)) / flat);
  return [a * out, high, b * out];
}

/** Return a reach, of a limb's length, slowed down from `free` on so that it never quite gets to 1: no elbow snaps straight. */
export function easeReach(reach, free) {
  const left = Math.max(1 - free, 1e-6);
  return reach > free ? free + left * (1 - Math.exp(-(reach - free) / left)) : reach;
}

/** Return 1 for an amount up to 0.5, 0 from 1 on, smoothly less between. */
export function fadeAboveHalf(amount) {
  const x = Math.min(Math.max(2 - 2 * amount, 0), 1);
  return x * x * (3 - 2 * x);
}
