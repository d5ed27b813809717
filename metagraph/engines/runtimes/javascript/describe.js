/** What may be asked of a character, as plain data. */

import { WORDS } from "./asks.js";
import { compareText } from "./basics.js";
import { describeParameters } from "./parameters.js";
import { secondsPlayed } from "./repeating.js";
import { LAYERS, MODES } from "./words.js";

/**
 * Return what may be asked for: `project`, `words` (what `do` may be), `modes`, `joints` (name, parent, part), `layers` (each `start`,
 * `stances`, `actions` but loops of stances, `tags` with the number of their actions), `lines` (id, text), `points` by name, metres, and, where
 * there are any, `parameters` by name (type, about, initial, least, most, choices).
 * @param {import("./graph.js").Graph} graph
 */
export function describe(graph) {
  return {
    project: graph.name, words: WORDS, modes: [...MODES],
    joints: graph.joints.map((name, n) => ({ name, parent: graph.joints[graph.parents[n]] ?? null, part: graph.parts[n] })),
    layers: Object.fromEntries(LAYERS.map((layer) => [layer, describeLayer(graph.layers[layer])])),
    lines: [...graph.lines.keys()].sort(compareText).map((id) => ({ id, text: graph.lines.get(id).text ?? "" })),
    points: Object.fromEntries(graph.points),
    ...(Object.keys(graph.parameters).length > 0 && { parameters: describeParameters(graph.parameters) }),
  };
}

function describeLayer({ start, stances, actions }) {
  const tags = {};
  for (const action of actions.values()) for (const tag of action.tags) tags[tag] = (tags[tag] ?? 0) + 1;
  return {
    start, stances: [...stances.values()].map(({ id, name }) => ({ id, name })),
    actions: [...actions.values()].filter((action) => action.kind !== "stance").map(describeAction), tags,
  };
}

function describeAction({ id, name, kind, stance, start, end, endStance, limb, tags, timing }) {
  return {
    id, name, kind, stance, seconds: secondsPlayed(kind, timing, start, end), ...(kind === "transition" && { to: endStance }),
    ...(limb !== "both" && { limb }),
    ...(tags.length > 0 && { tags }),
  };
}
