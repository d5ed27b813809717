/**
 * A pose of the graph's character brought onto another figure: turns are carried over relative to either rest pose, hips and feet go where
 * the character's are, scaled by the legs' length, and wrists by the arms' length. As metagraph/motion/retarget.py, a pose at a time, but
 * without contacts of the hands with the figure's own body.
 *
 * All is computed in the character's axes: +X to its left, +Y up, +Z ahead.
 */

import { back, between, dot, length, minus, plus, rotated, scaled, times, unit, unitTurn } from "../plain_vectors.js";
import { Figure, SIDES, STILL, alignRests, easeReach, fadeAboveHalf, partOf, solveLimb } from "./figure.js";
import { ARM, LEG, TRUNK, rolesOfGraph } from "./roles.js";

const LOWEST = 0.25; // of the leg: how far hips may be lowered so that legs of other proportions reach
const STRAIGHT = 0.96; // of the arm: from here on it stretches ever less for a place that only wider shoulders put so far
const ASIDE = (50 * Math.PI) / 180; // how far at most a foot turned from the hips' heading is followed in setting it apart
const UPTURNED = 0.5, LIFTED = 0.3; // 1 - cosine of the sole's tilt, and of the leg: from there a foot bears no weight
// Beside the trunk, of the left side: directions whose opposites no hand and no foot comes near.
const OUTWARDS = { arm: [0.6, -0.3, 0.75], leg: [0, -1, 0] };
const LIDS = /_lid$/;

/** Return rotations and positions [J] in the file's space of local ones. @param {number[]} parents before their children */
function walkRest(parents, rotations, translations) {
  const turns = [], places = [];
  parents.forEach((parent, j) => {
    turns.push(parent < 0 ? rotations[j] : times(turns[parent], rotations[j]));
    places.push(parent < 0 ? translations[j] : plus(places[parent], rotated(turns[parent], translations[j])));
  });
  return { turns, places };
}

const rows = (flat, width) => Array.from({ length: flat.length / width }, (_, n) => Array.from(flat.subarray(n * width, n * width + width)));

/** Return the graph's character in its rest pose, or in its base pose where that alone stands. @throws {AvatarError} */
export function figureOf(graph) {
  const roles = rolesOfGraph(graph);
  const stood = (rotations, translations) => {
    const { turns, places } = walkRest(graph.parents, rows(rotations, 4), rows(translations, 3));
    return new Figure(roles, turns, places, "the graph's character");
  };
  try {
    return stood(graph.restRotations, graph.restTranslations);
  } catch {
    return stood(graph.baseRotations, graph.baseTranslations);
  }
}

export class Retarget {
  /**
   * @param {import("../graph.js").Graph} graph @param {Figure} source as `figureOf` returns it @param {Figure} target
   * @param {{parents: number[], names: string[]}} joints the target's, parents before children; metres
   */
  constructor(graph, source, target, joints) {
    Object.assign(this, { graph, source, target });
    const roles = [...source.roles.keys()].filter((role) => target.roles.has(role) && !LIDS.test(role));
    this.align = alignRests(source, target, roles);
    this.scale = target.legLength / source.legLength;
    this.chest = ["upper_chest", "chest", "spine", "hips"].find((role) => this.align.has(role));
    const pairs = new Map(roles.map((role) => [target.roles.get(role), [source.roles.get(role), role]]));
    const tops = [source, target].map((figure) => ["upper_chest", "chest", "spine"].find((role) => figure.roles.has(role)));
    if (tops[0] && tops[1] && tops[0] !== tops[1] && !pairs.has(target.roles.get(tops[1]))) {
      pairs.set(target.roles.get(tops[1]), [source.roles.get(tops[0]), ""]); // both carry the arms
    }
    const taken = new Set([...pairs.values()].map(([joint]) => joint));
    joints.names.forEach((name, j) => {
      const same = graph.joints.indexOf(name); // faces, above all
      if (same >= 0 && !pairs.has(j) && !taken.has(same)) pairs.set(j, [same, ""]);
    });
    /** Joints of the graph that move nothing of the target. @type {string[]} */
    this.missing = graph.joints.filter((_, j) => ![...pairs.values()].some(([joint]) => joint === j));
    this.lay(joints.parents, pairs);
    const count = graph.joints.length;
    this.fromTurns = new Array(count);
    this.fromPlaces = new Array(count);
    const based = walkRest(graph.parents, rows(graph.baseRotations, 4), rows(graph.baseTranslations, 3)).places;
    const lowest = Math.min(...SIDES.map((side) => based[source.roles.get(`${side}_foot`)][1]));
    // A rest pose that floats or hangs where the motion does not is stood on the ground.
    this.fromAnkle = source.ankle - (Math.abs(lowest - source.ankle) > 0.25 * source.legLength ? source.floating : 0);
    this.toAnkle = target.ankle - target.floating;
  }

  /** Lay out the target: its tree with limbs that are apart in its file attached to the body, and what turns each joint. */
  lay(own, pairs) {
    const { roles, rotations, positions } = this.target;
    const chain = (joint) => {
      const line = [];
      for (let j = joint; j >= 0; j = own[j]) line.push(j);
      return line;
    };
    this.own = own;
    this.parents = [...own];
    const hips = roles.get("hips");
    const carries = roles.get(["upper_chest", "chest", "spine", "hips"].find((role) => roles.has(role)));
    for (const side of SIDES) {
      const [upperLeg, lowerLeg, foot, upperArm, lowerArm, hand] = [...LEG, ...ARM].map((part) => roles.get(`${side}_${part}`));
      const wants = [
        [upperLeg, hips, hips], [lowerLeg, upperLeg, upperLeg], [foot, lowerLeg, lowerLeg],
        [upperArm, hips, carries], [lowerArm, upperArm, upperArm], [hand, lowerArm, lowerArm],
      ]; // joint, below which it should be, and where it is attached if it is not
      for (const [joint, over, to] of wants) {
        // Legs below the spine, as in bipeds of 3ds Max, follow the hips, too.
        const lumbar = joint === upperLeg && roles.has("spine") && chain(joint).includes(roles.get("spine"));
        if (lumbar || (!chain(joint).includes(over) && !chain(over).includes(joint))) this.parents[joint] = to;
      }
    }
    const depth = (joint) => (this.parents[joint] < 0 ? 0 : 1 + depth(this.parents[joint]));
    this.order = own.map((_, j) => [depth(j), j]).sort((a, b) => a[0] - b[0] || a[1] - b[1]).map(([, j]) => j);
    const hangs = (joint) => joint >= 0 && (joint === hips || hangs(this.parents[joint]));
    this.carried = this.order.filter(hangs);
    this.localTurns = own.map((_, j) => (this.parents[j] < 0 ? rotations[j] : times(back(rotations[this.parents[j]]), rotations[j])));
    this.localPlaces = own.map((_, j) => {
      return this.parents[j] < 0 ? positions[j] : rotated(back(rotations[this.parents[j]]), minus(positions[j], positions[this.parents[j]]));
    });
    this.fixed = new Map(); // joint -> [joint of the graph, the turn on its right]
    for (const [joint, [from, role]] of pairs) {
      this.fixed.set(joint, [from, times(times(back(this.source.rotations[from]), this.align.get(role) ?? STILL), rotations[joint])]);
    }
    const line = TRUNK.filter((role) => roles.has(role)).map((role) => roles.get(role)).filter((joint) => this.fixed.has(joint));
    this.between = []; // joint, the joints it lies between, how far up it is
    line.slice(1).forEach((high, n) => {
      const up = chain(high);
      if (!up.includes(line[n])) return;
      const free = up.slice(1, up.indexOf(line[n])).filter((joint) => !this.fixed.has(joint)).reverse();
      free.forEach((joint, m) => this.between.push([joint, line[n], high, (m + 1) / (free.length + 1)]));
    });
    this.shifted = []; // faces' joints that the graph shifts: joint, of the graph, the turn that its shift is brought over by
    for (const [joint, [from, role]] of pairs) {
      const [above, over] = [this.graph.parents[from], this.parents[joint]];
      if (role || above < 0 || over < 0) continue;
      this.shifted.push([joint, from, times(back(rotations[over]), this.source.rotations[above])]);
    }
    this.apart = own.flatMap((parent, j) => (parent !== this.parents[j] ? [j] : []));
    this.turns = [...rotations];
    this.places = [...positions];
    this.moves = [...this.localPlaces];
    this.given = new Set([...this.fixed.keys(), ...this.between.map(([joint]) => joint)]);
  }

  /** Bring a pose of the graph over, local rotations [J, 4] and translations [J, 3]: `turns` and `places` of the target's joints. */
  bring(rotations, translations) {
    const { graph, source, target, fromTurns, fromPlaces, turns } = this;
    graph.parents.forEach((parent, j) => {
      const own = [rotations[4 * j], rotations[4 * j + 1], rotations[4 * j + 2], rotations[4 * j + 3]];
      const at = [translations[3 * j], translations[3 * j + 1], translations[3 * j + 2]];
      fromTurns[j] = times(parent < 0 ? source.turn : fromTurns[parent], own);
      fromPlaces[j] = parent < 0 ? rotated(source.turn, at) : plus(fromPlaces[parent], rotated(fromTurns[parent], at));
    });
    for (const [joint, [from, right]] of this.fixed) turns[joint] = unitTurn(times(fromTurns[from], right));
    for (const [joint, low, high, part] of this.between) {
      const [first, last] = [low, high].map((end) => times(turns[end], back(target.rotations[end])));
      turns[joint] = times(times(first, partOf(times(back(first), last), part)), target.rotations[joint]);
    }
    for (const [joint, from, turn] of this.shifted) {
      const shift = [0, 1, 2].map((k) => translations[3 * from + k] - graph.restTranslations[3 * from + k]);
      this.moves[joint] = plus(this.localPlaces[joint], scaled(rotated(turn, shift), this.scale));
    }
    this.moves[target.roles.get("hips")] = this.localPlaces[target.roles.get("hips")];
    this.walk();
    this.moveHips();
    for (const side of SIDES) {
      this.reach(side, LEG, this.footGoal(side), [0, 0, 1]);
      this.reach(side, ARM, plus(this.placeOf(`${side}_upper_arm`), this.handGoal(side)), [0, 0, -1]);
    }
    this.walk();
  }

  placeOf(role) {
    return this.places[this.target.roles.get(role)];
  }

  fromOf(role) {
    return this.fromPlaces[this.source.roles.get(role)];
  }

  /** Return how a joint of the character is turned from its rest pose. */
  turned(role) {
    const joint = this.source.roles.get(role);
    return times(this.fromTurns[joint], back(this.source.rotations[joint]));
  }

  /** Compute the turns of joints that are not given, and all places. */
  walk() {
    const { parents, turns, places } = this;
    for (const j of this.order) {
      const over = parents[j];
      if (!this.given.has(j)) turns[j] = over < 0 ? this.localTurns[j] : times(turns[over], this.localTurns[j]);
      places[j] = over < 0 ? this.moves[j] : plus(places[over], rotated(turns[over], this.moves[j]));
    }
  }

  /** Return where a place near the character's legs comes to: scaled, the ankles of a standing figure on the ground. */
  placed(point) {
    const { source, target } = this;
    const away = minus(point, [source.hip[0], this.fromAnkle, source.hip[2]]);
    return plus([target.hip[0], this.toAnkle, target.hip[2]], scaled(away, this.scale));
  }

  /** Put the hips where the character's are, as low as both legs need to reach. */
  moveHips() {
    const { target } = this;
    const middle = (at) => scaled(plus(at("left_upper_leg"), at("right_upper_leg")), 0.5);
    const shift = minus(this.placed(middle((role) => this.fromOf(role))), middle((role) => this.placeOf(role)));
    let drop = 0;
    for (const side of SIDES) {
      const away = minus(minus(this.footGoal(side), this.placeOf(`${side}_upper_leg`)), shift);
      const [one, two] = target.bones(side, LEG);
      drop = Math.max(drop, -away[1] - Math.sqrt(Math.max(0, (one + two) ** 2 - away[0] ** 2 - away[2] ** 2)));
    }
    shift[1] -= Math.min(drop, LOWEST * target.legLength);
    for (const joint of this.carried) this.places[joint] = plus(this.places[joint], shift);
    const hips = target.roles.get("hips"), over = this.parents[hips];
    const goal = this.places[hips];
    this.moves[hips] = over < 0 ? goal : rotated(back(this.turns[over]), minus(goal, this.places[over]));
  }

  /** Turn the two bones of a limb so that its end reaches a place. */
  reach(side, parts, goal, beside) {
    const names = parts.map((part) => `${side}_${part}`);
    const [upper, lower, end] = names.map((role) => this.target.roles.get(role));
    const root = this.places[upper];
    const knee = minus(this.places[lower], root), tip = minus(this.places[end], root);
    const [one, two] = this.target.bones(side, parts);
    const outwards = parts === LEG ? OUTWARDS.leg : OUTWARDS.arm;
    const start = rotated(this.turned(parts === LEG ? "hips" : this.chest), side === "left" ? outwards : [-outwards[0], outwards[1], outwards[2]]);
    const pole = rotated(this.turned(names[0]), beside);
    const [middle, to] = solveLimb(minus(goal, root), one, two, start, names.map((role) => this.fromOf(role)), pole);
    this.turns[upper] = times(swing(knee, middle), this.turns[upper]);
    this.turns[lower] = times(swing(minus(tip, knee), minus(to, middle)), this.turns[lower]);
  }

  /** Return where an ankle goes. Wider hips set it further out: a foot flat on the ground as it points, any other as the hips lie. */
  footGoal(side) {
    const { source, target } = this;
    const wide = (side === "left" ? 1 : -1) * (target.halfHips - this.scale * source.halfHips);
    const foot = source.roles.get(`${side}_foot`);
    const half = partOf(this.align.get(`${side}_foot`), 0.5);
    const q = times(this.fromTurns[foot], times(back(source.rotations[foot]), half));
    const hips = unit(minus(this.fromOf("left_upper_leg"), this.fromOf("right_upper_leg")));
    const body = Math.atan2(-hips[2], hips[0]), aim = 2 * Math.atan2(q[1], q[3]);
    const aside = modulo(aim - body + Math.PI, 2 * Math.PI) - Math.PI;
    const heading = body + Math.sign(aside) * ASIDE * easeReach(Math.abs(aside) / ASIDE, 0.6);
    const tilt = 1 - 2 * (q[0] ** 2 + q[2] ** 2); // of the sole: 1 flat, 0 upright
    const high = Math.abs(this.fromPlaces[foot][1] - this.fromAnkle) / source.legLength;
    const planted = fadeAboveHalf((1 - tilt) / UPTURNED) * fadeAboveHalf(high / LIFTED);
    const out = plus(scaled([Math.cos(heading), 0, -Math.sin(heading)], planted), scaled([hips[0], 0, hips[2]], 1 - planted)); // an ankle keeps its height
    return plus(this.placed(this.fromPlaces[foot]), scaled(out, wide));
  }

  /** Return where a wrist goes from its shoulder: as it was, scaled by the arm's length, and towards the middle by the shoulders' width. */
  handGoal(side) {
    const { source, target } = this;
    const sum = (figure) => figure.bones(side, ARM).reduce((a, b) => a + b);
    const scale = sum(target) / sum(source), sign = side === "left" ? 1 : -1;
    let away = minus(this.fromOf(`${side}_hand`), this.fromOf(`${side}_upper_arm`));
    const level = this.acrossChest();
    const out = sign * dot(away, level) + source.halfShoulders;
    const inside = Math.min(Math.max(out, -source.halfShoulders), source.halfShoulders);
    const extra = (target.halfShoulders / source.halfShoulders - scale) * (inside - source.halfShoulders);
    away = scaled(away, scale);
    const inwards = scaled(level, sign * extra);
    // As far inwards as the arm is long enough for: a hand that cannot come to the middle stays in front.
    const reached = sum(target);
    const free = Math.max(length(away) / reached, STRAIGHT);
    const reach = easeReach(length(plus(away, inwards)) / reached, free) * reached;
    const room = reach * reach - dot(away, away);
    const along = dot(away, inwards), square = Math.max(dot(inwards, inwards), 1e-12);
    const most = Math.min(Math.max((Math.sqrt(Math.max(0, along * along + square * Math.max(0, room))) - along) / square, 0), 1);
    return plus(away, scaled(inwards, most));
  }

  /** Return the level direction to the left of the chest. */
  acrossChest() {
    const [x, , z] = rotated(this.turned(this.chest), [1, 0, 0]);
    return scaled([x, 0, z], 1 / Math.max(Math.hypot(x, z), 0.3));
  }
}

const swing = (a, b) => between(unit(a), unit(b));
const modulo = (a, b) => a - b * Math.floor(a / b);
