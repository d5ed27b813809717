/** Reading the export's GLB: joint nodes and animations, as far as a runtime needs them. */

import { normalize, slerp } from "./rotation.js";

const [HEADER, JSON_CHUNK, BIN_CHUNK, MAGIC] = [12, 0x4e4f534a, 0x004e4942, 0x46546c67];
const WIDTHS = { SCALAR: 1, VEC2: 2, VEC3: 3, VEC4: 4 };
// Component type: bytes, reader, and the largest integer, by which normalised ones are divided.
const COMPONENTS = {
  5120: [1, "getInt8", 127], 5121: [1, "getUint8", 255], 5122: [2, "getInt16", 32767], 5123: [2, "getUint16", 65535],
  5126: [4, "getFloat32", 1],
};

const KNOWN = ["KHR_mesh_quantization", "EXT_meshopt_compression"];

/** What is wrong with a file, in words; `load` says which. */
export class GlbError extends Error {}

/** A parsed GLB. Throws GlbError for what is not a GLB, is cut short, or uses what this reader does not know. */
export class Glb {
  /** @param {Uint8Array | ArrayBuffer} bytes */
  constructor(bytes) {
    const raw = bytes instanceof Uint8Array ? bytes : new Uint8Array(bytes);
    const view = new DataView(raw.buffer, raw.byteOffset, raw.byteLength);
    this.byteLength = raw.byteLength;
    if (raw.byteLength < HEADER + 8 || view.getUint32(0, true) !== MAGIC) throw new GlbError("is no GLB");
    if (view.getUint32(8, true) > raw.byteLength) throw new GlbError(`is cut short: ${raw.byteLength} of ${view.getUint32(8, true)} bytes`);
    for (let at = HEADER; at + 8 <= view.getUint32(8, true); ) {
      const [length, kind] = [view.getUint32(at, true), view.getUint32(at + 4, true)];
      if (at + 8 + length > raw.byteLength) throw new GlbError("is cut short");
      const chunk = raw.subarray(at + 8, at + 8 + length);
      if (kind === JSON_CHUNK) this.document = parse(chunk);
      if (kind === BIN_CHUNK) this.binary = new DataView(chunk.buffer, chunk.byteOffset, chunk.byteLength);
      at += 8 + length;
    }
    if (!this.document) throw new GlbError("has no JSON");
    const needed = this.document.extensionsRequired ?? [];
    if (needed.some((name) => !KNOWN.includes(name))) throw new GlbError(`needs ${needed.join(", ")}`);
    this.nodes = this.document.nodes ?? [];
    this.animations = this.document.animations ?? [];
    this.unpacked = new Map(); // views
    this.packing = null; // the part of the runtime that unpacks them
  }

  /** Return where an accessor's values lie and how they are read. Throws GlbError for what is not read here, or not there. */
  placed(index) {
    const accessor = this.document.accessors?.[index];
    const source = this.document.bufferViews?.[accessor?.bufferView];
    const [size, read, most] = COMPONENTS[accessor?.componentType] ?? [];
    const width = WIDTHS[accessor?.type];
    if (!source || !size || !width || !this.binary) throw new GlbError(`accessor ${index} is of a kind that is not read here`);
    const packed = source.extensions?.EXT_meshopt_compression;
    const data = packed ? this.unpack(accessor.bufferView, packed) : this.binary;
    const begin = (packed ? 0 : source.byteOffset ?? 0) + (accessor.byteOffset ?? 0);
    const stride = source.byteStride ?? size * width;
    if (begin + (accessor.count - 1) * stride + size * width > data.byteLength) throw new GlbError("is cut short");
    return { data, begin, stride, size, width, read, count: accessor.count, normalized: accessor.normalized, scale: accessor.normalized ? most : 1 };
  }

  /** Return a packed view's bytes. @returns {DataView} */
  unpack(view, { byteOffset = 0, byteLength, count, byteStride, mode, filter }) {
    if (!this.unpacked.has(view)) {
      const { buffer, byteOffset: from, byteLength: size } = this.binary;
      if (byteOffset + byteLength > size) throw new GlbError("is cut short");
      const { MeshoptError, unpacked } = this.packing;
      try {
        this.unpacked.set(view, new DataView(unpacked(new Uint8Array(buffer, from + byteOffset, byteLength), count, byteStride, mode, filter).buffer));
      } catch (error) {
        throw error instanceof MeshoptError ? new GlbError(error.message) : error;
      }
    }
    return this.unpacked.get(view);
  }

  /** Return an accessor's values as numbers, those of normalised integers from -1 to 1. @returns {Float32Array} */
  values(index) {
    const { data, begin, stride, size, width, read, count, normalized, scale } = this.placed(index);
    const out = new Float32Array(count * width);
    for (let n = 0; n < out.length; n++) {
      const at = begin + Math.floor(n / width) * stride + (n % width) * size;
      out[n] = Math.max(data[read](at, true) / scale, normalized ? -1 : -Infinity);
    }
    return out;
  }

  /** Return a node's own translation or rotation. @param {"translation" | "rotation"} path */
  own(node, path) {
    return this.nodes[node][path] ?? (path === "rotation" ? [0, 0, 0, 1] : [0, 0, 0]);
  }

  /** Return the channels of an animation, node and path, once all they need is there and of a kind that is read. */
  checked(animation) {
    const { channels, samplers } = this.animations[animation];
    return channels.map(({ sampler, target }) => {
      const { input, output, interpolation = "LINEAR" } = samplers[sampler] ?? {};
      if (interpolation === "CUBICSPLINE") throw new GlbError("has cubic animations; Metagraph writes linear ones");
      this.placed(input);
      this.placed(output);
      return { node: target.node, path: target.path };
    });
  }

  /** Return the tracks of an animation: node, path, key times (seconds) and values. @param {(target: object) => boolean} [wanted] */
  tracks(animation, wanted = () => true) {
    const { channels, samplers } = this.animations[animation];
    return channels
      .filter(({ target }) => wanted(target))
      .map(({ sampler, target }) => {
        const { input, output, interpolation } = samplers[sampler];
        const [times, values] = [this.values(input), this.values(output)];
        return { node: target.node, path: target.path, times, values, steps: interpolation === "STEP" };
      });
  }

  /** Return the names of a mesh node's morph targets. */
  morphNames(node) {
    return this.document.meshes?.[this.nodes[node]?.mesh]?.extras?.targetNames ?? [];
  }
}

function parse(chunk) {
  try {
    return JSON.parse(new TextDecoder().decode(chunk));
  } catch {
    throw new GlbError("has a JSON part that cannot be read");
  }
}

/**
 * Return a track's values at the frames n / fps: rotations by slerp, all else by straight lines, held before the first key and after
 * the last.
 * @returns {Float32Array} [frames, width]
 */
export function resample({ path, times, values, steps }, frames, fps) {
  const width = values.length / times.length;
  const out = new Float32Array(frames * width);
  for (let frame = 0, key = 0; frame < frames; frame++) {
    const time = frame / fps;
    while (key + 1 < times.length && times[key + 1] <= time) key += 1;
    const next = Math.min(key + 1, times.length - 1);
    const span = times[next] - times[key];
    const part = steps || span <= 0 ? 0 : Math.min(Math.max((time - times[key]) / span, 0), 1);
    const [o, a, b] = [frame * width, key * width, next * width];
    if (path === "rotation") {
      slerp(out, o, values, a, values, b, part);
      normalize(out, o);
    } else {
      for (let k = 0; k < width; k++) out[o + k] = values[a + k] * (1 - part) + values[b + k] * part;
    }
  }
  return out;
}
