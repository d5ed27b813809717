/**
 * The core for pages that should load fast: a Character, and a `load` that fetches those parts of the runtime that the export needs. It
 * plays the same as index.js.
 */

import { read } from "./graph.js";
import { FETCH, neededParts } from "./parts.js";

export { Character } from "./character.js";
export { FORMAT, Graph, MetagraphError } from "./graph.js";
export { LAYERS } from "./words.js";

/**
 * Return the graph of an export, with a promise: the parts that it needs are fetched first. more: parts that the program needs, too;
 * "life" for `saySound` and `spoken` of exports that have no face.
 * @param {string} json the export's text @param {Uint8Array | ArrayBuffer} glb the bytes of its GLB
 * @param {string} [file] what to call the JSON in errors @param {string[]} [more] @returns {Promise<import("./graph.js").Graph>} rejected as `load` of index.js throws
 */
export async function load(json, glb, file = "the export", more = []) {
  let needed = [];
  read(json, glb, file, (data, document) => {
    needed = [...new Set([...neededParts(data, document), ...more])];
    return null; // nothing is made yet
  });
  const parts = Object.fromEntries(await Promise.all(needed.map(async (name) => [name, await FETCH[name]()])));
  return read(json, glb, file, () => parts);
}
