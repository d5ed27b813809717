/**
 * The life layers at a time: what they add to the pose the layers have composed. Turns are multiplied on the right of a joint's
 * rotation, shifts are added to its translation.
 *
 *     breath(t) = depth e(min(x / 0.4, (1 - x) / 0.6)),  x: how far the breath has gone, e(x) = 3 x^2 - 2 x^3
 *     blink(t)  = e(min(x / close, (close + open - x) / open)),  x: seconds since the blink began
 *     lid       = follow x pitch of the eye + blink x (1 - how far it is shut already)
 */

import { bisect } from "../basics.js";
import { FaceShown, answer, settle, shownFace } from "../expressions.js";
import { Bearing, bearing, shown, shutIn } from "../mood.js";
import { ease, fromVector, multiply } from "../rotation.js";
import { HALF } from "../schedule.js";
import { SHOWN } from "../shown.js";
import { CHANNELS, LIDS, MOUTH } from "../words.js";
import { Gaze } from "./gaze.js";
import { mouthAt } from "./lips.js";
import { Solver, lid, partAlong } from "./solve.js";

const INHALE = 0.4; // of a breath
const RADIANS = Math.PI / 180;
const MORPH_LOOK = 30 * RADIANS; // the turn of an eye that a morph target of a look stands for
const MORPH_FOLLOWS = [0.6 / (40 * RADIANS), 0.6 / (40 * RADIANS), 0, 0]; // how far morph targets shut for an eye that looks down a radian
const MORPH_WIDE = 0.6; // of a target that opens wide, for a lid as far open as it would be shut
const BLINK = LIDS.length; // place among CHANNELS
const VISEME = CHANNELS.length - 14; // place of the first mouth shape but silence

const UNMOVED = new Bearing();

/** What the life layers make of one body: `find` works a time out, `apply` and `morphs` use what it found. */
export class Enlivener {
  /** @param {import("../graph.js").Graph} graph with a body */
  constructor(graph) {
    const { body } = graph;
    this.graph = graph;
    this.body = body;
    this.solver = new Solver(body);
    this.results = new Float64Array(4 * body.joints.length);
    this.turn = new Float64Array(4);
    this.channels = new Float64Array(CHANNELS.length);
    this.said = new Float64Array(14);
    this.shut = new Float64Array(LIDS.length);
    this.full = 0; // how full the chest is
    this.bears = UNMOVED;
    this.feels = new FaceShown();
    this.values = new Float64Array(SHOWN.length);
    this.added = new Float64Array(graph.morphs.length);
    this.targets = body.face.morphs
      .map(({ channel, name, weight }) => ({ value: SHOWN.indexOf(channel), morph: graph.morphs.indexOf(name), weight }))
      .filter(({ value }) => value >= 0);
  }

  /** Return the gaze of a schedule, null for a body without a head; it is good for as long as the schedule is. */
  gazeOf(schedule) {
    return this.body.lookers.length && schedule.targets.length ? new Gaze(schedule, this.graph.life, this.body, this.graph.points) : null;
  }

  /** Work out what happens at a time on a composed pose: rotations [J, 4] and translations [J, 3], which are only read. */
  find(rotations, translations, plan, gaze, time) {
    const { body, graph, solver, channels } = this;
    const { life } = graph;
    const { chain, places } = solver;
    this.full = breathAt(plan.life.breaths, life, time);
    const mood = shown(plan.life.moods.times, plan.life.moods.rows, time);
    this.bears = mood.neutral ? UNMOVED : bearing(mood);
    for (let n = 0; n < body.chain.length; n++) {
      const joint = body.chain[n];
      for (let k = 0; k < 4; k++) chain[4 * n + k] = rotations[4 * joint + k];
      for (let k = 0; k < 3; k++) places[3 * n + k] = translations[3 * joint + k];
      const half = 0.5 * (this.full * body.breath[4 * n + 3] + this.bears.droop * body.bowed[n] + this.bears.thrust * body.thrust[n]);
      if (half === 0) continue;
      const s = Math.sin(half);
      for (let k = 0; k < 3; k++) this.turn[k] = s * body.breath[4 * n + k];
      this.turn[3] = Math.cos(half);
      multiply(chain, 4 * n, chain, 4 * n, this.turn, 0);
    }
    if (gaze) {
      gaze.at(time);
      solver.look(gaze, life.gaze, 1 - life.stillness, life.headShare);
    } else {
      solver.turns.fill(0);
      solver.eyes.fill(0);
    }
    this.lids(rotations, shutIn(blinkAt(plan.life.blinks, life, time), this.bears.lids));
    channels.fill(0, VISEME);
    this.said.fill(0);
    if (life.lips > 0 && mouthAt(graph, plan.track.speeches, time, this.said)) {
      for (let k = 0; k < 14; k++) channels[VISEME + k] = this.said[k] * life.lips;
    }
  }

  lids(rotations, blink) {
    const { body, shut, channels, solver } = this;
    const { lids, shutBy } = body.face;
    const follows = lids.some((joint) => joint >= 0) ? body.face.follows : MORPH_FOLLOWS;
    for (let n = 0; n < LIDS.length; n++) {
      const side = n % 2;
      const eye = body.eyes[side];
      let down = -solver.eyes[2 * side + 1];
      if (eye.isJoint) down += partAlong(rotations, 4 * eye.joint, eye.down);
      const already = lids[n] >= 0 ? partAlong(rotations, 4 * lids[n], shutBy[n]) : 0;
      shut[n] = lid(down, this.graph.life.lids * follows[n], already, blink);
      channels[n] = shut[n] - already;
    }
    channels[BLINK] = blink;
  }

  /** Add what was found to a composed pose, in place. */
  apply(rotations, translations) {
    const { body, results, solver } = this;
    const full = this.full + this.bears.lift;
    const { tension: tight, closed: close } = this.bears;
    const { chain, eyes } = solver;
    const count = body.joints.length;
    const chained = body.chain.length;
    // First all from the pose as it was, then written: a joint may be in it twice, and then the last counts.
    results.set(chain);
    for (let n = chained; n < count; n++) for (let k = 0; k < 4; k++) results[4 * n + k] = rotations[4 * body.joints[n] + k];
    for (let n = 0; n < body.lookers.length; n++) {
      this.add(body.lookers[n].place, solver.turns[3 * n], solver.turns[3 * n + 1], solver.turns[3 * n + 2]);
    }
    let place = chained;
    for (let n = 0; n < body.shoulders.length; n++) {
      const { turn, tense, closed } = body.shoulders[n];
      const x = full * turn[0] + tight * tense[0] + close * closed[0];
      const y = full * turn[1] + tight * tense[1] + close * closed[1];
      const z = full * turn[2] + tight * tense[2] + close * closed[2];
      this.add(place++, x, y, z);
    }
    for (let n = 0; n < 2; n++) {
      const { isJoint, turnLeft: a, turnUp: b } = body.eyes[n];
      const left = eyes[2 * n], up = eyes[2 * n + 1];
      if (isJoint) this.add(place++, left * a[0] + up * b[0], left * a[1] + up * b[1], left * a[2] + up * b[2]);
    }
    this.face(translations);
    for (let n = 0; n < count; n++) for (let k = 0; k < 4; k++) rotations[4 * body.joints[n] + k] = results[4 * n + k];
  }

  /** Turn the face's joints and shift them: sums over channels. */
  face(translations) {
    const { body, channels } = this;
    const { joints, turns, shifts, moves } = body.face;
    for (let f = 0; f < joints.length; f++) {
      let x = 0, y = 0, z = 0;
      for (let c = 0; c < channels.length; c++) {
        if (channels[c] === 0 || !moves[c]) continue;
        const at = 3 * (c * joints.length + f);
        x += channels[c] * turns[at];
        y += channels[c] * turns[at + 1];
        z += channels[c] * turns[at + 2];
        for (let k = 0; k < 3; k++) translations[3 * joints[f] + k] += channels[c] * shifts[at + k];
      }
      this.add(body.turned + f, x, y, z);
    }
  }

  /** Turn a result by a rotation vector. */
  add(place, x, y, z) {
    if (x === 0 && y === 0 && z === 0) return;
    fromVector(this.turn, 0, x, y, z);
    multiply(this.results, 4 * place, this.results, 4 * place, this.turn, 0);
  }

  /**
   * Add the morph target weights of what was found, by their places in `graph.morphs`: as far as clips leave them room.
   * @param {Float32Array} out @param {import("../plan.js").Plan} plan @param {number} time @param {object[]} cues those that play then
   */
  morphs(out, plan, time, cues) {
    const { added } = this;
    const values = this.work(plan, time, cues);
    added.fill(0);
    for (let n = 0; n < this.targets.length; n++) {
      const { value, morph, weight } = this.targets[n];
      if (values[value] > 1e-4) added[morph] += values[value] * weight;
    }
    for (let n = 0; n < added.length; n++) out[n] += Math.min(1, added[n]) * (1 - Math.min(1, Math.max(0, out[n])));
  }

  /** Return how far each of SHOWN is shown, of what was found; its own array. */
  work(plan, time, cues) {
    const { shut, channels, values } = this;
    values[0] = Math.max((shut[0] + shut[1]) / 2, channels[BLINK]);
    for (let side = 0; side < 2; side++) {
      const left = this.solver.eyes[2 * side] / MORPH_LOOK, up = this.solver.eyes[2 * side + 1] / MORPH_LOOK;
      const at = 1 + 6 * side;
      values[at] = shut[side];
      values[at + 1] = -MORPH_WIDE * shut[side];
      values[at + 2] = left;
      values[at + 3] = -left;
      values[at + 4] = up;
      values[at + 5] = -up;
    }
    for (let k = 0; k < MOUTH.length; k++) values[13 + k] = channels[BLINK + 1 + k];
    const { life } = this.graph;
    const face = this.feels;
    shownFace(face, life, plan.life.swells, plan.life.emphases, this.bears, time);
    for (const cue of cues) answer(face, life, cue.action.tags, cue.start, cue.end, time);
    settle(face);
    values.set([face.smile, face.frown, face.browDown, face.browUp, face.brows, face.cheeks], 13 + MOUTH.length);
    return values;
  }
}

/** Return how full the chest is, 0 at rest, about 1 at the top of a breath. */
function breathAt({ times, rows }, life, time) {
  const n = bisect(times, time, true) - 1;
  if (n < 0) return 0;
  const gone = (time - times[n]) / rows[n][0];
  return life.breathing * (1 - life.stillness) * rows[n][1] * ease(Math.min(gone / INHALE, (1 - gone) / (1 - INHALE)));
}

/** Return how far a blink has shut the eyes, 0..1. */
function blinkAt({ times, rows }, life, time) {
  const whole = life.blinkClose + life.blinkOpen;
  let out = 0;
  // A slow one may still be opening when the next begins.
  for (let n = bisect(times, time, true) - 1; n >= 0 && time - times[n] < whole; n--) {
    const gone = time - times[n];
    const far = rows[n][0] === 3 ? HALF : 1; // some are incomplete
    out = Math.max(out, far * ease(Math.min(gone / life.blinkClose, (whole - gone) / life.blinkOpen)));
  }
  return out;
}
