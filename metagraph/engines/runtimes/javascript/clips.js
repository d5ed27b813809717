/** The motions of an export's clips: checked when it is read, and made of the GLB when they are first played. */

import { GlbError, resample } from "./glb.js";
import { multiply } from "./rotation.js";
import { inRange } from "./words.js";

const MOVED = 1e-7; // metres below which a translation is none

/** One clip. `morphs`: the targets it moves, by name, `place` among the graph's and `weights` [F]. */
export class ClipMotion {
  /** @param {import("./glb.js").Glb} glb @param {number} animation @param {object} skeleton nodes, and the rest pose of each joint */
  constructor(glb, animation, skeleton, frames, fps) {
    Object.assign(this, { glb, animation, skeleton, frames, fps });
    const tracks = glb.checked(animation).filter(({ path }) => path === "weights");
    this.morphs = tracks.flatMap(({ node }, track) => glb.morphNames(node).map((name, n) => new ClipMorph(this, name, track, n)));
    this.columns = null;
  }

  /** Return its tracks at its frames: node, path, width, values [F, width]. @param {(track: object) => boolean} wanted */
  sampled(wanted) {
    return this.glb.tracks(this.animation, wanted).map((track) => {
      const values = resample(track, this.frames, this.fps);
      return { node: track.node, path: track.path, width: values.length / this.frames, values };
    });
  }

  /** Return the weights of a morph target: of the n-th track of such, its column. */
  column(track, n) {
    this.columns ??= this.sampled(({ path }) => path === "weights");
    const { width, values } = this.columns[track];
    return Float32Array.from({ length: this.frames }, (_, f) => values[f * width + n]);
  }

  /** Return all local rotations [F, J, 4] and translations [F, J, 3]; joints it does not turn stay as in the rest pose. */
  pose() {
    const { nodes, rest } = this.skeleton;
    const repeated = (path) => {
      const row = rest.flatMap((joint) => joint[path]);
      const out = new Float32Array(this.frames * row.length);
      for (let f = 0; f < this.frames; f++) out.set(row, f * row.length);
      return out;
    };
    const pose = { rotation: repeated("rotation"), translation: repeated("translation") };
    const joint = new Map(nodes.map((node, n) => [node, n]));
    for (const { node, path, width, values } of this.sampled(({ node, path }) => path in pose && joint.has(node))) {
      for (let f = 0; f < this.frames; f++) {
        pose[path].set(values.subarray(f * width, (f + 1) * width), (f * nodes.length + joint.get(node)) * width);
      }
    }
    return pose;
  }
}

/** What a clip does to one morph target. */
class ClipMorph {
  constructor(clip, name, track, column) {
    Object.assign(this, { clip, name, track, column, place: -1, found: null });
  }

  get weights() {
    return (this.found ??= this.clip.column(this.track, this.column));
  }
}

/**
 * A clip relative to the base pose, for the joints a layer reaches: rotations [F, n, 4], neighbours on the same side; translations
 * [F, m, 3] for the places `moved` [m] in the reach.
 */
export class Offsets {
  /** @param {ClipMotion} motion @param {Int32Array} reach @param {import("./graph.js").Graph} graph */
  constructor(motion, reach, graph) {
    Object.assign(this, { motion, reach, graph, found: null });
  }

  get value() {
    return (this.found ??= offsetsOf(this.motion.frames, this.motion.pose(), this.reach, this.graph));
  }
}

function offsetsOf(frames, { rotation, translation }, reach, graph) {
  const { baseRotations: base, baseTranslations, joints } = graph;
  const inverse = base.map((x, n) => (n % 4 === 3 ? x : -x));
  const turned = new Float32Array(frames * reach.length * 4);
  for (let f = 0, o = 0; f < frames; f++) {
    for (let n = 0; n < reach.length; n++, o += 4) {
      multiply(turned, o, inverse, 4 * reach[n], rotation, 4 * (f * joints.length + reach[n]));
      const before = o - 4 * reach.length;
      if (f === 0) continue;
      let dot = 0;
      for (let k = 0; k < 4; k++) dot += turned[o + k] * turned[before + k];
      if (dot < 0) for (let k = 0; k < 4; k++) turned[o + k] *= -1;
    }
  }
  const away = (f, n, k) => translation[3 * (f * joints.length + reach[n]) + k] - baseTranslations[3 * reach[n] + k];
  const moves = (n) => {
    for (let f = 0; f < frames; f++) for (let k = 0; k < 3; k++) if (Math.abs(away(f, n, k)) > MOVED) return true;
    return false;
  };
  const moved = Int32Array.from(reach.keys()).filter(moves);
  const shifted = new Float32Array(frames * moved.length * 3);
  for (let f = 0, o = 0; f < frames; f++) for (const n of moved) for (let k = 0; k < 3; k++) shifted[o++] = away(f, n, k);
  return { rotations: turned, translations: shifted, moved };
}

/** Return clip id -> ClipMotion of those that the GLB has; `problems` gets what it lacks, in words. */
export function readClips(data, glb, joints, problems) {
  const nodes = joints.map((joint) => glb.nodes.findIndex((node) => node.name === joint));
  if (nodes.every((node) => node < 0)) throw new GlbError("has none of the export's joints; it is another's");
  nodes.forEach((node, n) => {
    if (node < 0) problems.push(`the GLB has no joint '${joints[n]}'; it stays as in the rest pose`);
  });
  const rest = data.joints.map((joint, n) =>
    nodes[n] < 0 ? joint : { translation: glb.own(nodes[n], "translation"), rotation: glb.own(nodes[n], "rotation") },
  );
  const out = new Map();
  for (const { id, name, animation, fps, frames } of data.clips) {
    inRange(fps, 1e-3, 1e6, `clip ${id}'s fps`);
    inRange(frames, 1, 1e6, `clip ${id}'s frames`);
    const place = glb.animations[animation]?.name === name ? animation : glb.animations.findIndex((found) => found.name === name);
    if (place < 0) problems.push(`the GLB has no animation '${name}'; its actions show their stance`);
    else out.set(id, new ClipMotion(glb, place, { nodes, rest }, frames, fps));
  }
  return out;
}
