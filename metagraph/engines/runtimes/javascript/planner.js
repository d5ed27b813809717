/**
 * The planner: requests at any level in, a plan of specific actions out.
 *
 * Meta actions -> temporal replanning -> sampling, layer by layer (Borer et al., section 6). Planning from nothing and extending
 * a running plan are the same function.
 */

import { draft } from "./layer_planning.js";
import { moodsOf } from "./wanted.js";
import { LAYERS } from "./words.js";

/**
 * Return the plan with new requests worked in, others withdrawn, and the horizon moved to `end`.
 *
 * What starts before `now` stays exactly as it was. What was planned for later is taken back to its meta actions, merged with
 * the new ones and planned again. An extension in many steps gives what one in a single step does. leave: layers that are
 * planned to `end` already and that nothing new concerns.
 * @param {import("./graph.js").Graph} graph @param {import("./plan.js").Plan} plan @param {number} now
 * @param {import("./plan.js").Request[]} requests @param {number} end
 * @param {{stances?: Record<string, string>, idle?: boolean}} options @param {Set<string>} withdrawn @param {string[]} leave
 * @param {Set<string>} [stopped] those withdrawn whose running action is left, too
 * @returns {import("./plan.js").Plan}
 */
export function extend(graph, plan, now, requests, end, { stances = {}, idle = true } = {}, withdrawn = new Set(), leave = [], stopped = new Set()) {
  const fresh = [...new Map(requests.map((r) => [r.id, r])).values()]; // of two with one id the later counts
  const again = new Set([...fresh.map((r) => r.id), ...withdrawn]);
  const layers = {};
  const reports = [];
  const moods = moodsOf(graph.life, plan.track);
  for (const layer of LAYERS) {
    if (leave.includes(layer)) {
      layers[layer] = plan.layers[layer];
      reports.push(...plan.reports.filter((r) => r.layer === layer && !again.has(r.request)));
      continue;
    }
    const of = graph.layers[layer];
    const chain = idle ? of.markov : null;
    const stance = stances?.[layer] ?? null;
    const drafted = draft(
      graph, of, chain, of.kinds, plan.layers[layer], plan.reports, plan.seed, now, fresh, again, stopped, end, stance, moods, plan.track,
    );
    layers[layer] = drafted.performed(drafted.placed, end);
    reports.push(...drafted.reports);
  }
  return {
    seed: plan.seed, end, layers, track: plan.track,
    reports: reports.sort((a, b) => a.at - b.at),
    requests: [...plan.requests.filter((r) => !again.has(r.id)), ...fresh],
    life: livedOn(graph, plan, end, now),
  };
}

/** Return the events of life up to `end`; null where the graph has none. */
function livedOn({ living, life, voices }, plan, end, now) {
  return living ? living.schedule(life, plan.track, voices, plan.seed, end, plan.life ?? new living.Schedule(), now) : null;
}
