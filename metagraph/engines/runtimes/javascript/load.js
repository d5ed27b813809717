/** Loading with all parts of the runtime at hand; core.js has the one that fetches them. */

import * as touching from "./contacts.js";
import { read } from "./graph.js";
import * as life from "./life/part.js";
import * as packing from "./meshopt.js";
import * as weighing from "./weight.js";

const PARTS = { life, touching, weighing, packing };

/**
 * Return the graph of an export.
 *
 * A clip that the GLB lacks is no error: `graph.problems` lists it, and its actions show their stance.
 * @param {string} json the export's text @param {Uint8Array | ArrayBuffer} glb the bytes of its GLB
 * @param {string} [file] what to call the JSON in errors @returns {import("./graph.js").Graph}
 * @throws {import("./graph.js").MetagraphError} when it is newer than this runtime, or no export, or its GLB is truncated or another's
 */
export function load(json, glb, file = "the export") {
  return read(json, glb, file, () => PARTS);
}
