/**
 * The parts of the runtime that only some exports need. `load` has all of them; `core.js` fetches those that an export needs.
 *
 * life: breathing, gaze, blinks, lips, and what `saySound` and `spoken` of a character need. touching: hands that stay where they touch. weighing: hips, spine and legs that answer the
 * arms, and planted feet. packing: GLBs that are packed.
 * @typedef {{life?: object, touching?: object, weighing?: object, packing?: object}} Parts
 */

/** How each part is fetched. @type {Record<string, () => Promise<object>>} */
export const FETCH = {
  life: () => import("./life/part.js"),
  touching: () => import("./contacts.js"),
  weighing: () => import("./weight.js"),
  packing: () => import("./meshopt.js"),
};

/** Return which parts an export needs; which of them a program needs it says itself. @param {object} data its JSON @param {object} document of its GLB @returns {string[]} */
export function neededParts(data, document) {
  const packed = (document.extensionsUsed ?? []).includes("EXT_meshopt_compression");
  const needs = { life: data.rig || data.weight_rig, touching: data.contact_rig, weighing: data.weight_rig, packing: packed };
  return Object.keys(FETCH).filter((name) => needs[name]);
}
