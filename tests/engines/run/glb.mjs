// Reads a GLB's nodes and animations as plain arrays; tests run engines' own state machines on them.
import fs from "node:fs";

const WIDE = { SCALAR: 1, VEC3: 3, VEC4: 4 };

export function readGlb(file) {
  const bytes = fs.readFileSync(file);
  const length = bytes.readUInt32LE(12);
  const json = JSON.parse(bytes.subarray(20, 20 + length).toString("utf8"));
  const start = bytes.byteOffset + 20 + length + 8;
  const array = (index) => {
    const accessor = json.accessors[index], view = json.bufferViews[accessor.bufferView];
    const at = start + (view.byteOffset ?? 0) + (accessor.byteOffset ?? 0), count = accessor.count * WIDE[accessor.type];
    if (accessor.componentType === 5126) return new Float32Array(bytes.buffer.slice(at, at + 4 * count));
    const short = new Int16Array(bytes.buffer.slice(at, at + 2 * count)); // normalised
    return Float32Array.from(short, (x) => Math.max(x / 32767, -1));
  };
  const parents = new Map();
  json.nodes.forEach((node, n) => (node.children ?? []).forEach((child) => parents.set(child, n)));
  const animations = (json.animations ?? []).map((animation) => ({
    name: animation.name,
    channels: animation.channels.map(({ sampler, target }) => ({
      node: target.node, path: target.path,
      times: array(animation.samplers[sampler].input), values: array(animation.samplers[sampler].output),
    })),
  }));
  return { json, nodes: json.nodes, parents, animations };
}
