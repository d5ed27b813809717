/**
 * The one evaluator: what pose a plan gives at a time. Layers add their offsets from the base pose (Borer et al., section 5): a joint's
 * rotation is `base * body^w * arms^w * head^w`, its translation a sum; then the body answers its arms, the other life layers are
 * added, and hands kept in contact and out of the body.
 */

import { turnExtent } from "./mood.js";
import { seamLeft } from "./cue_times.js";
import { clipSeconds } from "./plan.js";
import { ease, multiply, nlerp, normalize, power } from "./rotation.js";
import { SHOWN } from "./shown.js";
import { LAYERS } from "./words.js";

// A clip is led while no joint is farther from the stance than the first, and crossfaded where one is farther than the second: cosines
// of half that turn.
const LEAD_WITHIN = 0.966;
const FADE_BEYOND = 0.866;
const UNSHOWN = new Float64Array(SHOWN.length);

/** Room for working in, one for each graph: a pose is worked out whole before the next is begun. */
class Room {
  constructor(graph) {
    const count = graph.joints.length;
    const sample = () => ({ rotations: new Float64Array(4 * count), translations: new Float64Array(3 * count) });
    this.pose = sample();
    this.shown = sample();
    this.stance = sample();
    this.other = sample();
    this.spare = sample();
    this.turn = new Float64Array(4);
    this.base = { rotations: Float64Array.from(graph.baseRotations), translations: Float64Array.from(graph.baseTranslations) };
    this.life = graph.body ? new graph.living.Enlivener(graph) : null;
    this.found = { player: null, plan: null, time: 0 }; // what `life` has found last
  }
}

const rooms = new WeakMap();

function roomOf(graph) {
  let room = rooms.get(graph);
  if (!room) rooms.set(graph, (room = new Room(graph)));
  return room;
}

/**
 * Plays one plan after the other. It remembers where it was, so that asking for one time after another costs next to no search; any
 * times in any order give the same.
 */
export class Player {
  /** @param {import("./graph.js").Graph} graph @param {import("./plan.js").Plan} plan */
  constructor(graph, plan) {
    this.graph = graph;
    this.room = roomOf(graph);
    this.cursors = LAYERS.map(() => ({ cue: 0, rest: 0 }));
    this.swaying = graph.weightRig ? new graph.weighing.Swaying(graph) : null;
    this.setPlan(plan);
  }

  /** @param {import("./plan.js").Plan} plan */
  setPlan(plan) {
    if (this.plan === plan) return;
    if (this.plan?.life !== plan.life) this.gaze = this.room.life?.gazeOf(plan.life) ?? null;
    this.plan = plan;
    this.swaying?.clear();
  }

  /**
   * Write the pose at a time: `rotations` [J, 4] xyzw and `translations` [J, 3] metres, both local, of the graph's joints.
   *
   * alive: with the life layers, as far as the export has them on. Times before 0 and after the plan's end rest in the first and last
   * stance. Actions whose clip is missing show their stance.
   * @param {number} time seconds @param {Float32Array} rotations @param {Float32Array} translations
   */
  pose(time, rotations, translations, alive = true) {
    const { pose, life } = this.room;
    this.compose(time);
    if (alive) this.weigh(time);
    if (alive && this.lives) {
      this.find(time);
      life.apply(pose.rotations, pose.translations);
    }
    if (this.graph.contactRig) this.graph.touching.touch(this.graph, this.playing(time), time, pose.rotations, pose.translations);
    rotations.set(pose.rotations);
    translations.set(pose.translations);
  }

  /** Write the weight of each of the graph's morph targets at a time, 0..1. @param {number} time @param {Float32Array} out */
  morphs(time, out, alive = true) {
    out.fill(0);
    if (!out.length) return;
    const cues = [];
    for (let n = 0; n < LAYERS.length; n++) {
      const layer = this.plan.layers[LAYERS[n]];
      const cue = this.cueAt(n, layer, time);
      const rest = layer.rests.length ? layer.rests[this.restAt(n, layer, time)] : null;
      const weight = cue ? cueWeight(cue, time) : 0;
      if (cue) {
        cues.push(cue);
        addMorphs(cue.action, clipSeconds(cue, time), weight, out);
      }
      if (rest) addLoopedMorphs(rest, time, 1 - weight, out);
    }
    if (alive && this.lives && this.graph.body.face.morphs.length) {
      this.enliven(time);
      this.room.life.morphs(out, this.plan, time, cues);
    }
    for (let n = 0; n < out.length; n++) out[n] = Math.min(1, Math.max(0, out[n]));
  }

  /** Return how far each of `SHOWN` (life/evaluate.js) is shown at a time, for faces other than the graph's; zeros without life. */
  channels(time) {
    if (!this.lives) return UNSHOWN;
    this.enliven(time);
    const cues = LAYERS.map((name, n) => this.cueAt(n, this.plan.layers[name], time)).filter(Boolean);
    return this.room.life.work(this.plan, time, cues);
  }

  /** Find what the life layers do at a time, on the pose composed for it; again only if a pose of that time has not just done so. */
  enliven(time) {
    const { found } = this.room;
    if (found.player === this && found.plan === this.plan && found.time === time) return;
    this.compose(time); // eyes made of morph targets hold while the head moves
    this.weigh(time);
    this.find(time);
  }

  find(time) {
    const { pose, life, found } = this.room;
    life.find(pose.rotations, pose.translations, this.plan, this.gaze, time);
    found.player = this;
    found.plan = this.plan;
    found.time = time;
  }

  /** Return what plays at a time: of each layer its name, plan, cue with motion or null, and the place of its rest. */
  playing(time) {
    return LAYERS.map((name) => [name, this.plan.layers[name], ...this.playingIn(time, name)]);
  }

  /** Return the cue with motion that plays in a layer, or null, and the place of its rest, -1 for none. */
  playingIn(time, name) {
    const n = LAYERS.indexOf(name);
    const layer = this.plan.layers[name];
    const cue = this.cueAt(n, layer, time);
    return [cue?.action.offsets ? cue : null, layer.rests.length ? this.restAt(n, layer, time) : -1];
  }

  /** Let the body in the composed pose answer its arms. */
  weigh(time) {
    const { rotations, translations } = this.room.pose;
    if (!this.swaying || !this.graph.life.on || !(this.plan.life?.end > 0)) return;
    this.swaying.answer(this.plan, (at, name) => this.playingIn(at, name), time, rotations, translations);
  }

  get lives() {
    return this.graph.life.on && this.graph.body !== null && this.plan.life?.end > 0;
  }

  /** Leave the composed pose at a time in the room, without the life layers. */
  compose(time) {
    const { graph, room } = this;
    const { rotations, translations } = room.pose;
    rotations.set(room.base.rotations);
    translations.set(room.base.translations);
    for (let n = 0; n < LAYERS.length; n++) {
      const layer = this.plan.layers[LAYERS[n]];
      if (!layer.rests.length) continue;
      const { reach, weights } = graph.layers[LAYERS[n]];
      const added = this.layer(n, layer, time, reach.length);
      for (let i = 0; i < reach.length; i++) {
        const joint = reach[i];
        if (weights !== null && weights[i] !== 1) power(added.rotations, 4 * i, weights[i]);
        const w = weights === null ? 1 : weights[i];
        multiply(rotations, 4 * joint, rotations, 4 * joint, added.rotations, 4 * i);
        for (let k = 0; k < 3; k++) translations[3 * joint + k] += w * added.translations[3 * i + k];
      }
    }
    for (let q = 0; q < rotations.length; q += 4) normalize(rotations, q);
  }

  /** Return a layer's offsets at a time, on the joints it reaches; the room's own arrays. */
  layer(n, layer, time, count) {
    const { shown, stance, other } = this.room;
    const cue = this.cueAt(n, layer, time);
    const action = cue?.action;
    if (!cue || !action.offsets) return this.stance(n, layer, time, count);
    this.cue(cue, time, count);
    const entering = time < cue.start + cue.blendIn;
    const blending = entering || time >= cue.end - cue.blendOut;
    if (!blending && !action.partly.length && cue.extent === 1) return shown;
    this.stance(n, layer, time, count);
    if (blending && cue.repeats) mix(shown, stance, shown, cueWeight(cue, time), count); // at its ends it moves
    else if (blending) {
      sample(action, entering ? cue.entry : clipSeconds(cue, cue.end), other, count);
      this.blend(cueWeight(cue, time), count);
    }
    if (cue.extent !== 1) this.extend(cue.extent, this.graph.layers[LAYERS[n]], count);
    for (let s = 0; s < action.partly.length; s++) {
      const [i, moved] = action.partly[s];
      let along = 0;
      for (let q = 4 * i; q < 4 * i + 4; q++) along += shown.rotations[q] * stance.rotations[q];
      const w = along < 0 ? -moved : moved;
      for (let q = 4 * i; q < 4 * i + 4; q++) shown.rotations[q] = (1 - moved) * stance.rotations[q] + w * shown.rotations[q];
      normalize(shown.rotations, 4 * i);
      for (let k = 3 * i; k < 3 * i + 3; k++) {
        shown.translations[k] = stance.translations[k] + moved * (shown.translations[k] - stance.translations[k]);
      }
    }
    return shown;
  }

  /** Show what a cue plays of its clip, without its blends. Where it repeats, it goes on from where the cycle before it ended. */
  cue(cue, time, count) {
    const { shown, other, spare } = this.room;
    sample(cue.action, clipSeconds(cue, time), shown, count);
    const left = seamLeft(cue, time);
    if (left <= 0) return;
    sample(cue.action, cue.cycleFrom, other, count);
    sample(cue.action, cue.cycleTo, spare, count);
    this.lead(spare, left, count);
  }

  /**
   * Blend what is shown in from, or out to, its stance; the clip's pose at that edge is the room's other. Where that is near the stance,
   * lead the clip: add what the stance differs from it. A crossfade would hold the clip back and then hurry it. Where a joint has far to
   * turn, crossfade: led, it would do its whole movement around a pose that the clip never has.
   */
  blend(weight, count) {
    const { shown, stance, other, spare } = this.room;
    let near = 1;
    for (let q = 0; q < 4 * count; q += 4) {
      let along = 0;
      for (let k = q; k < q + 4; k++) along += other.rotations[k] * stance.rotations[k];
      near = Math.min(near, Math.abs(along));
    }
    const far = ease((LEAD_WITHIN - near) / (LEAD_WITHIN - FADE_BEYOND));
    if (far > 0) mix(spare, stance, shown, weight, count);
    this.lead(stance, 1 - weight, count);
    if (far > 0) mix(shown, shown, spare, far, count);
  }

  /** Add to what is shown a part of the way from the room's other pose to a pose. */
  lead(to, weight, count) {
    const { shown, other, turn } = this.room;
    for (let q = 0; q < 4 * count; q += 4) {
      turnBack(other.rotations, q);
      multiply(turn, 0, other.rotations, q, to.rotations, q);
      const w = turn[3] < 0 ? -weight : weight;
      for (let k = 0; k < 4; k++) turn[k] *= w;
      turn[3] += 1 - weight;
      normalize(turn, 0);
      multiply(shown.rotations, q, shown.rotations, q, turn, 0);
    }
    for (let k = 0; k < 3 * count; k++) shown.translations[k] += weight * (to.translations[k] - other.translations[k]);
  }

  /** Play what is shown larger or smaller round the stance. */
  extend(extent, { larger, smaller }, count) {
    const { shown, stance, turn } = this.room;
    const takesPart = extent > 1 ? larger : smaller;
    for (let i = 0, q = 0; i < count; i++, q += 4) {
      if (!takesPart[i]) continue;
      for (let k = 0; k < 4; k++) turn[k] = k < 3 ? -stance.rotations[q + k] : stance.rotations[q + 3];
      multiply(turn, 0, turn, 0, shown.rotations, q);
      power(turn, 0, turnExtent(extent, turn[3]));
      multiply(shown.rotations, q, stance.rotations, q, turn, 0);
      for (let k = 3 * i; k < 3 * i + 3; k++) shown.translations[k] = stance.translations[k] + (shown.translations[k] - stance.translations[k]) * extent;
    }
  }

  /** Return the offsets of the stance that lies under the cues. */
  stance(n, layer, time, count) {
    const { stance, other, spare } = this.room;
    const at = this.restAt(n, layer, time);
    const rest = layer.rests[at];
    this.rest(rest, time, stance, other, count);
    if (at === 0 || rest.fadeStart + rest.fade <= time) return stance;
    this.rest(layer.rests[at - 1], time, other, spare, count);
    mix(stance, other, stance, ease((time - rest.fadeStart) / rest.fade), count);
    return stance;
  }

  /** Write the offsets of a loop, its end faded into its beginning. */
  rest({ action, start }, time, out, room, count) {
    if (!action.offsets) return clear(out, count);
    const [phase, other, old] = loopSeconds(action, time - start);
    sample(action, action.start + phase, out, count);
    if (old === 0) return;
    sample(action, action.start + other, room, count);
    mix(out, out, room, old, count);
  }

  /** Return the cue playing at a time, null while the stance rests. */
  cueAt(n, { cues }, time) {
    const cursor = this.cursors[n];
    cursor.cue = Math.min(cursor.cue, cues.length);
    while (cursor.cue > 0 && cues[cursor.cue - 1].start > time) cursor.cue -= 1;
    while (cursor.cue < cues.length && cues[cursor.cue].start <= time) cursor.cue += 1;
    const cue = cursor.cue > 0 ? cues[cursor.cue - 1] : null;
    return cue !== null && time < cue.end ? cue : null;
  }

  /** Return the place of the rest that a time is in, or that is taking over. */
  restAt(n, { rests }, time) {
    const cursor = this.cursors[n];
    cursor.rest = Math.min(cursor.rest, rests.length - 1);
    while (cursor.rest > 0 && rests[cursor.rest].fadeStart > time) cursor.rest -= 1;
    while (cursor.rest + 1 < rests.length && rests[cursor.rest + 1].fadeStart <= time) cursor.rest += 1;
    return cursor.rest;
  }
}

/** Return how much of a cue shows at a time within it: rising over its blend in, falling over its blend out. */
function cueWeight(cue, time) {
  const rise = cue.blendIn > 0 ? ease((time - cue.start) / cue.blendIn) : 1;
  const fall = cue.blendOut > 0 ? ease((cue.end - time) / cue.blendOut) : 1;
  return rise * fall;
}

/**
 * Return how far into a loop it is, seconds after it began, how far on its seam's other side, and how much of that shows. Its last seconds
 * fade into its first, and its period is that much shorter. Before its beginning a loop runs as if it had gone on for ever; one with a seam
 * waits in its first pose, so that it starts without a jump.
 */
function loopSeconds(action, elapsed) {
  const length = action.end - action.start;
  const seam = Math.min(action.timing.blendIn, length / 2);
  const period = length - seam;
  if (period <= 0) return [0, 0, 0];
  const rest = (seam > 0 ? Math.max(elapsed, 0) : elapsed) % period;
  const phase = rest < 0 ? rest + period : rest;
  const old = seam > 0 && elapsed >= period ? 1 - ease(phase / seam) : 0;
  return [phase, Math.min(period + phase, length), old];
}

/** Write a clip's offsets at clip seconds, straight lines between its frames. */
function sample({ motion, offsets }, seconds, out, count) {
  const at = Math.min(Math.max(seconds * motion.fps, 0), motion.frames - 1);
  const low = Math.min(Math.floor(at), Math.max(0, motion.frames - 2));
  const part = at - low;
  const { rotations, translations, moved } = offsets;
  const size = 4 * count;
  let a = low * size;
  let b = Math.min(low + 1, motion.frames - 1) * size;
  const q = out.rotations;
  for (let o = 0; o < size; o += 4, a += 4, b += 4) {
    // Neighbours are on the same side.
    const x = rotations[a] + (rotations[b] - rotations[a]) * part;
    const y = rotations[a + 1] + (rotations[b + 1] - rotations[a + 1]) * part;
    const z = rotations[a + 2] + (rotations[b + 2] - rotations[a + 2]) * part;
    const w = rotations[a + 3] + (rotations[b + 3] - rotations[a + 3]) * part;
    const k = 1 / Math.sqrt(x * x + y * y + z * z + w * w);
    q[o] = x * k;
    q[o + 1] = y * k;
    q[o + 2] = z * k;
    q[o + 3] = w * k;
  }
  const t = out.translations;
  t.fill(0, 0, 3 * count);
  a = low * moved.length * 3;
  b = Math.min(low + 1, motion.frames - 1) * moved.length * 3;
  for (let m = 0; m < moved.length; m++) {
    for (let k = 0; k < 3; k++, a++, b++) t[3 * moved[m] + k] = translations[a] + (translations[b] - translations[a]) * part;
  }
}

/** Write a crossfade of two samples, `weight` of the second; may write into either. */
function mix(out, a, b, weight, count) {
  for (let q = 0; q < 4 * count; q += 4) nlerp(out.rotations, q, a.rotations, q, b.rotations, q, weight);
  for (let k = 0; k < 3 * count; k++) out.translations[k] = a.translations[k] + (b.translations[k] - a.translations[k]) * weight;
}

function clear(out, count) {
  out.translations.fill(0, 0, 3 * count);
  for (let q = 0; q < 4 * count; q++) out.rotations[q] = q % 4 === 3 ? 1 : 0;
}

function turnBack(q, i) {
  for (let k = 0; k < 3; k++) q[i + k] = -q[i + k];
}

function addMorphs({ motion }, seconds, share, out) {
  if (!motion || share <= 0) return;
  const at = Math.min(Math.max(seconds * motion.fps, 0), motion.frames - 1);
  const low = Math.min(Math.floor(at), Math.max(0, motion.frames - 2));
  const high = Math.min(low + 1, motion.frames - 1);
  for (let n = 0; n < motion.morphs.length; n++) {
    const { place, weights } = motion.morphs[n];
    out[place] += share * (weights[low] * (1 - (at - low)) + weights[high] * (at - low));
  }
}

/** Add the morph target weights of a loop, its end faded into its beginning. */
function addLoopedMorphs({ action, start }, time, share, out) {
  const [phase, other, old] = loopSeconds(action, time - start);
  addMorphs(action, action.start + phase, share * (1 - old), out);
  addMorphs(action, action.start + other, share * old, out);
}

const players = new WeakMap();

function playerOf(graph, plan) {
  let player = players.get(plan);
  if (player?.graph !== graph) players.set(plan, (player = new Player(graph, plan)));
  return player;
}

/**
 * Return the pose of a plan at a time: local `rotations` [J, 4] xyzw and `translations` [J, 3], metres. For many characters and many
 * times use a Player, which writes into arrays of yours.
 * @param {import("./graph.js").Graph} graph @param {import("./plan.js").Plan} plan @param {number} time seconds
 */
export function poseAt(graph, plan, time, alive = true) {
  const [rotations, translations] = [new Float32Array(4 * graph.joints.length), new Float32Array(3 * graph.joints.length)];
  playerOf(graph, plan).pose(time, rotations, translations, alive);
  return { rotations, translations };
}

/** Return the weights of morph targets at a time, by name, 0..1. @returns {Record<string, number>} */
export function morphsAt(graph, plan, time, alive = true) {
  const out = new Float32Array(graph.morphs.length);
  playerOf(graph, plan).morphs(time, out, alive);
  return Object.fromEntries(graph.morphs.map((name, n) => [name, out[n]]));
}
