/** The core of the runtime, which fetches the parts that an export needs; it plays the same as index.js. */

import type { Graph } from "./index.js";

export { Character, FORMAT, LAYERS, MetagraphError } from "./index.js";
export type * from "./index.js";

/** A part of the runtime: life (with `saySound` and `spoken`), hands that touch, weight and planted feet, packed GLBs. */
export type Part = "life" | "touching" | "weighing" | "packing";

/**
 * Return an export's graph, once the parts that it needs are fetched. `file`: what to call the JSON in errors. `more`: parts that your
 * program needs, too. Rejected with a MetagraphError.
 */
export function load(json: string, glb: Uint8Array | ArrayBuffer, file?: string, more?: readonly Part[]): Promise<Graph>;
