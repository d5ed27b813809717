/**
 * Which actions can play on a layer, and the way from stance to stance.
 *
 * Translated from metagraph/playback/planning/routes.py; change that, and translate anew.
 */

import { pick } from "./choice.js";

/**
 * One action of a chain: the candidates for it and, for a transition on the way, the stance it leads to.
 *
 * candidates: Action[]; hop: string.
 */
export class SamplingStep {
  constructor(candidates, hop = "") {
    this.candidates = candidates;
    this.hop = hop;
  }
}

/**
 * @param {LayerState} state
 * @param {Action} action
 * @returns {boolean}
 */
export function mayPlay(state, action) {
  return action.likelihood > 0 && arrives(state, action);
}

/**
 * Return whether an action leaves the layer in a stance that has a loop.
 * @param {LayerState} state
 * @param {Action} action
 * @returns {boolean}
 */
export function arrives(state, action) {
  const end = action.endStance;
  if (action.kind !== "transition") {
    return true;
  }
  return end !== null && state.graph.stances.has(end) && state.graph.of(end, "stance").length > 0;
}

/**
 * Return the stances after the current one on the shortest way of transitions that can play, the goal last; empty if there
 * is no way. Among equally short ways, the one whose transitions were placed first.
 * @param {LayerState} state
 * @param {string} goal
 * @returns {string[]}
 */
export function findHops(state, goal) {
  const before = new Map([[state.stance, ""]]);
  const queue = [state.stance];
  let at = 0; // what is before it was looked at
  while (at < queue.length && !before.has(goal)) {
    const stance = queue[at];
    at += 1;
    for (const action of state.graph.of(stance, "transition")) {
      const end = action.endStance;
      if (end === null || before.has(end) || !state.graph.stances.has(end)) {
        continue;
      }
      if (mayPlay(state, action)) {
        before.set(end, stance);
        queue.push(end);
      }
    }
  }
  const way = [];
  if (!before.has(goal)) {
    return way;
  }
  let step = goal;
  while (step !== state.stance) {
    way.push(step);
    step = before.get(step);
  }
  return [...[...way].reverse()];
}

/**
 * @param {LayerState} state
 * @param {MetaRequest} request
 * @returns {string}
 */
export function nameElsewhere(state, request) {
  for (const action of [...state.graph.actions.values()]) {
    const fits = action.kind === request.kind
      && request.tags.every((tag) => action.tags.includes(tag))
      && (request.limb === null || request.limb === action.limb);
    if (fits && state.graph.stances.has(action.stance)) {
      return `; there is one in '${state.graph.stances.get(action.stance).name}'`;
    }
  }
  return "";
}

/**
 * Return one of a stance's loops, drawn by likelihood; None if it has none.
 * @param {LayerState} state
 * @param {string} stance
 * @param {string} key
 * @returns {?Action}
 */
export function drawLoop(state, stance, key) {
  const loops = state.graph.of(stance, "stance");
  if (loops.length === 1) {
    return loops[0];
  }
  const weights = new Map(loops.filter((a) => a.likelihood > 0).map((a) => [a.id, a.likelihood]));
  if (weights.size === 0) {
    return loops.length > 0 ? loops[0] : null;
  }
  const chosen = pick(state.seed, key, "loop", weights);
  return loops.find((a) => a.id === chosen);
}

/**
 * Return the transitions hop by hop from the current stance to `goal`.
 * @param {LayerState} state
 * @param {MetaAction} meta
 * @param {string} goal
 * @returns {?SamplingStep[]}
 */
export function findRoute(state, meta, goal) {
  if (goal === state.stance) {
    const name = state.graph.stances.get(goal).name;
    state.tell(meta, "already-there", `the layer is in '${name}' already`, true);
    return null;
  }
  const stances = findHops(state, goal);
  if (stances.length === 0) {
    const a = state.graph.stances.get(state.stance).name;
    const b = state.graph.stances.get(goal).name;
    state.tell(meta, "no-way", `no chain of transitions leads from '${a}' to '${b}'`);
    return null;
  }
  const steps = [];
  let at = state.stance;
  for (const following of stances) {
    const hops = state.graph.of(at, "transition").filter((a) => a.endStance === following && mayPlay(state, a));
    steps.push(new SamplingStep(hops, following));
    at = following;
  }
  return steps;
}
