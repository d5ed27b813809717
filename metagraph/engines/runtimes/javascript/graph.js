/** The exported graph and its clips, loaded once and shared by all characters that use them. */

import { Offsets, readClips } from "./clips.js";
import { Glb, GlbError } from "./glb.js";
import { hear } from "./hear.js";
import { readLife } from "./life.js";
import { Markov, Settings, Stance, Timing } from "./model.js";
import { readParameters } from "./parameters.js";
import { Phases } from "./phase_times.js";
import { emptyPlan } from "./plan.js";
import { morphsAt, poseAt } from "./pose.js";
import { Voices } from "./voice.js";
import { LAYERS, inRange } from "./words.js";

export const FORMAT = 1; // the newest version of the export that is read here

/** What cannot be loaded: which file, where in it, what is wrong, and what to do about it. */
export class MetagraphError extends Error {
  constructor(file, where, what, remedy) {
    super(`${file}${where ? ` at ${where}` : ""}: ${what}. ${remedy}`);
    this.name = "MetagraphError";
  }
}

/**
 * Return the graph of an export. choose: gives the parts (see parts.js) for what the JSON and the GLB say, null to make no graph.
 * @param {string} json @param {Uint8Array | ArrayBuffer} glb @param {string} file
 * @param {(data: object, document: object) => ?import("./parts.js").Parts} choose @returns {?Graph} @throws {MetagraphError}
 */
export function read(json, glb, file, choose) {
  let data;
  try {
    data = JSON.parse(json);
  } catch (error) {
    throw new MetagraphError(file, "", `is not JSON (${error.message})`, "Export it again.");
  }
  if (typeof data?.metagraph !== "number") {
    throw new MetagraphError(file, "metagraph", "is missing", "Choose the JSON that Metagraph exported.");
  }
  if (data.metagraph > FORMAT) {
    throw new MetagraphError(file, "metagraph", `is ${data.metagraph}, and this runtime knows ${FORMAT}`, "Update the runtime.");
  }
  for (const field of ["joints", "base", "clips", "layers", "planner", ...LAYERS.map((layer) => `layers.${layer}`)]) {
    const value = field.split(".").reduce((at, name) => at?.[name], data);
    if (typeof value !== "object" || value === null) throw new MetagraphError(file, field, "is missing", "Export it again.");
  }
  try {
    const opened = new Glb(glb);
    const parts = choose(data, opened.document);
    if (parts === null) return null;
    opened.packing = parts.packing ?? null;
    return tried(new Graph(data, opened, parts));
  } catch (error) {
    const again = "Export it again, and copy both files.";
    if (error instanceof GlbError) throw new MetagraphError(data.glb ?? "the GLB", "", error.message, again);
    throw new MetagraphError(file, "", `cannot be understood (${error.message})`, "Export it again.");
  }
}

/** Plan and pose once, so that what does not fit together shows now rather than in a game's loop. */
function tried(graph) {
  const plan = hear(graph, emptyPlan(graph.settings.seed), 0, [], 10);
  for (const time of [0]) {
    const { rotations, translations } = poseAt(graph, plan, time);
    const weights = Object.values(morphsAt(graph, plan, time));
    if (![...rotations, ...translations, ...weights].every(Number.isFinite)) throw new Error("its poses are no numbers");
  }
  return graph;
}

/** Say that a GLB is not the one that the JSON was written with. */
function otherGlb(data, bytes) {
  return `'${data.glb}' is not the GLB that this JSON was written with (${bytes} bytes, not ${data.glb_bytes}): export again, and copy both files`;
}

/** Everything of an export that planning and posing need. Joints are told by their place; layers by name, in the order of LAYERS. */
export class Graph {
  /** @param {object} data the export @param {Glb} glb @param {import("./parts.js").Parts} parts */
  constructor(data, glb, parts) {
    this.touching = parts.touching ?? null; // parts of the runtime, null where the export does not need them
    this.living = parts.life ?? null;
    this.weighing = parts.weighing ?? null;
    const p = data.planner;
    const constant = (name, usual, low = 0, high = 1e9) => inRange(p[name] ?? usual, low, high, `planner.${name}`);
    this.name = data.name;
    this.problems = [];
    this.settings = new Settings(
      constant("alpha", 4), constant("seed", 1, 0, 0xffffffff), p.never_twice ?? true, constant("shortest", 0.4), constant("wait", 4),
      constant("memory", 0), constant("rest", 0), constant("lookahead", 0.1), constant("variety", 0, 0, 4),
    );
    this.joints = data.joints.map((joint) => joint.name);
    this.parts = data.joints.map((joint) => joint.part);
    this.parents = data.joints.map((joint) => (joint.parent === null ? -1 : this.joints.indexOf(joint.parent)));
    this.baseRotations = Float32Array.from(data.base.rotations.flat()); // [J, 4], local
    this.baseTranslations = Float32Array.from(data.base.translations.flat()); // [J, 3], local, metres
    if (this.baseRotations.length !== 4 * this.joints.length || this.baseTranslations.length !== 3 * this.joints.length) {
      throw new Error(`the base pose is not one of ${this.joints.length} joints`);
    }
    this.restRotations = Float32Array.from(data.joints.flatMap((joint) => joint.rotation ?? [0, 0, 0, 1])); // [J, 4], local, of the rest pose
    this.restTranslations = Float32Array.from(data.joints.flatMap((joint) => joint.translation ?? [0, 0, 0])); // [J, 3]
    this.roles = data.roles ?? {}; // role -> joint, where the user corrected it
    this.life = readLife(data.life);
    this.points = new Map(Object.entries(data.points ?? {}));
    this.lines = new Map(Object.entries(data.lines ?? {}));
    this.parameters = readParameters(data.parameters); // what games set, by name
    this.voices = new Voices(data.voices);
    this.unmade = []; // offsets that nobody has needed yet
    if (Number.isInteger(data.glb_bytes) && glb.byteLength !== data.glb_bytes) this.problems.push(otherGlb(data, glb.byteLength));
    this.clips = readClips(data, glb, this.joints, this.problems);
    const durations = new Map(data.clips.map((clip) => [clip.id, (clip.frames - 1) / clip.fps]));
    const layerGraph = (layer) => new LayerGraph(layer, data.layers[layer], data.joints, durations, this);
    this.layers = Object.fromEntries(LAYERS.map((layer) => [layer, layerGraph(layer)]));
    this.body = data.rig && this.living ? this.living.readBody(data.rig) : null;
    this.contactRig = this.touching?.readContactRig(data.contact_rig, this.joints) ?? null;
    this.weightRig = this.weighing?.readWeightRig(data.weight_rig, this.joints.length) ?? null;
    this.armTracks = this.weighing?.readArmTracks(this.layers, data.clips) ?? new Map();
    this.feetLayer = data.weight_rig?.feet_layer in this.layers ? data.weight_rig.feet_layer : "body"; // it moves the legs
    this.footTracks = this.weighing?.readFootTracks(this.layers[this.feetLayer], data.clips) ?? new Map();
    const own = [...this.clips.values()].flatMap((clip) => clip.morphs.map((morph) => morph.name));
    /** Names of all morph targets that anything here moves. */
    this.morphs = [...new Set([...own, ...(this.body?.face.morphs ?? []).map((morph) => morph.name)])];
    for (const clip of this.clips.values()) for (const morph of clip.morphs) morph.place = this.morphs.indexOf(morph.name);
  }

  /**
   * Make motions that were not played yet, which otherwise is done when they first play, for so many milliseconds and one at least.
   * Returns how many are left. @param {number} [milliseconds] all of them where it is left out
   */
  prepare(milliseconds = Infinity) {
    const end = performance.now() + milliseconds;
    while (this.unmade.length && void this.unmade.pop().value === undefined && performance.now() < end);
    return this.unmade.length;
  }

  /** Return the seconds of its clip between which an action plays. */
  span(action) {
    return [action.start, action.end];
  }

  /** @returns {import("./voice.js").Voice} */
  voiceOf(speech) {
    return this.voices.of(speech);
  }
}

/** One layer: its stances and actions, and how it reaches the joints. */
export class LayerGraph {
  constructor(layer, data, joints, durations, graph) {
    this.layer = layer;
    this.start = data.start;
    this.stances = new Map(data.stances.map(({ id, name }) => [id, new Stance(id, layer, name)]));
    this.strength = Math.min(1, data.weights.arms ?? 0); // how much of the arms it moves, 0..1
    const weights = joints.map((joint) => data.weights[joint.part] ?? 0);
    /** Places of the joints this layer moves [n], and its weights on them, null where all are 1. */
    this.reach = Int32Array.from(joints.keys()).filter((joint) => weights[joint] > 0);
    this.weights = [...this.reach].every((joint) => weights[joint] === 1) ? null : Float32Array.from(this.reach, (joint) => weights[joint]);
    /** Which of them turn farther, and which less far, where a cue is played larger or smaller than made. */
    this.larger = Uint8Array.from(this.reach, (joint) => (joints[joint].scales ?? "both") === "both");
    this.smaller = Uint8Array.from(this.reach, (joint) => joints[joint].scales !== "neither");
    const offsets = new Map(); // by clip
    this.actions = new Map(data.actions.map((action) => [action.id, this.action(action, joints, durations, graph, offsets)]));
    this.index = new Map();
    for (const action of this.actions.values()) {
      const key = `${action.kind} ${action.stance}`;
      if (!this.index.has(key)) this.index.set(key, []);
      this.index.get(key).push(action);
    }
    this.kinds = new Set([...this.actions.values()].map((action) => action.kind));
    const { states, matrix, gap, positive, negative, tags, lengths, modes } = data.markov;
    this.markov = new Markov(layer, states, matrix, gap, positive, negative, tags, lengths, modes);
    inRange(this.markov.gap, 1e-3, 1e9, `layers.${layer}.markov.gap`);
    for (const row of this.markov.modes) for (const p of row) inRange(p, 0, 1, `layers.${layer}.markov.modes`);
    for (const row of this.markov.matrix) for (const p of row) inRange(p, 0, 1, `layers.${layer}.markov.matrix`);
  }

  /** Return the actions of a kind placed on a stance. */
  of(stance, kind) {
    return this.index.get(`${kind} ${stance}`) ?? NOTHING;
  }

  /**
   * Return an action: times of its clip in seconds, `phases` of them, `motion` (null where its clip is missing), `offsets` of the
   * motion from the base pose, and `partly`, the places in the reach of joints that it does not move wholly, each with how far it does, 0..1.
   */
  action(data, joints, durations, graph, offsets) {
    const { id, name, clip, kind, stance, limb } = data;
    const number = (field, usual) => inRange(data[field] ?? usual, 0, 1e15, `action ${id}'s ${field}`);
    const length = durations.get(clip) ?? 0;
    const start = Math.min(number("start"), length);
    const end = Math.max(start, data.whole_end ? length : Math.min(number("end"), length));
    // Where none are told, all of them are at the stroke, and that is halfway unless it was set.
    const told = Math.min(Math.max(data.stroke ?? (start + end) / 2, start), end);
    const [ready, stroke, strokeEnd, relax] = data.phases?.length === 4 ? data.phases : [told, told, told, told];
    const motion = graph.clips.get(clip) ?? null;
    if (motion && !offsets.has(clip)) {
      offsets.set(clip, new Offsets(motion, this.reach, graph));
      graph.unmade.push(offsets.get(clip));
    }
    const held = offsets.get(clip) ?? null;
    const other = { left: "right", right: "left" }[limb];
    const masked = (joint) => data.joints.length > 0 && !data.joints.includes(joint.name);
    const weights = Object.entries(data.joint_weights ?? {}).map(([joint, w]) => [joint, inRange(w, 0, 1, `action ${id}'s joint weight`)]);
    const weightOf = new Map(weights);
    const moves = (joint) => ((joint.part === "arms" && joint.side === other) || masked(joint) ? 0 : weightOf.get(joint.name) ?? 1);
    const partly = Array.from(this.reach, (joint, place) => [place, moves(joints[joint])]).filter(([, weight]) => weight < 1);
    return {
      id, name, clip, kind, layer: this.layer, stance, limb, likelihood: number("likelihood"), start, end, motion,
      tags: data.tags, joints: data.joints, jointWeights: weights, contacts: graph.touching?.readContacts(data.contacts) ?? [],
      endStance: data.end_stance ?? null,
      timing: new Timing(
        start, end, number("blend_in"), number("blend_out"), kind === "stance", data.earliest_exit ?? null, null, null, null, null, number("repeat", 0),
      ),
      phases: new Phases(start, ready, stroke, strokeEnd, relax, end), cooldown: number("cooldown", 0), spacing: data.spacing ?? null,
      vigour: inRange(data.vigour ?? 0, -1, 1, `action ${id}'s vigour`),
      prominence: inRange(data.prominence ?? 0, 0, 1, `action ${id}'s prominence`),
      /** Made when they are first needed; null where the clip is missing. */
      get offsets() {
        return held && (held.found ?? held.value);
      },
      partly,
    };
  }
}

const NOTHING = [];
