/**
 * Which actions a meta action may become: the transitions on the way, then the candidates.
 *
 * Translated from metagraph/playback/planning/steps.py; change that, and translate anew.
 */

import { findLead, findMoves, keepFresh, keepModest } from "./directing.js";
import { node } from "./remembering.js";
import { SamplingStep, arrives, findRoute, mayPlay, nameElsewhere } from "./routes.js";

/**
 * Return each action in turn: the transitions to get there, then the action itself; None if it is impossible or not needed,
 * or if the model wrote it and every candidate played too recently.
 * @param {LayerState} state
 * @param {MetaAction} meta
 * @param {number} now
 * @returns {?SamplingStep[]}
 */
export function chooseSteps(state, meta, now) {
  const request = meta.request;
  const graph = state.graph;
  if (request.action !== null) {
    const action = graph.actions.get(request.action) ?? null;
    if (action === null || !graph.stances.has(action.stance)) {
      state.tell(meta, "unknown-action", `there is no action '${request.action}' in the ${graph.layer} layer`);
      return null;
    }
    if (action.kind === "stance") {
      return findRoute(state, meta, action.stance);
    }
    if (!arrives(state, action)) {
      state.tell(meta, "no-stance", `'${action.name}' ends in a stance that has no loop`);
      return null;
    }
    if (action.stance === state.stance) {
      return [new SamplingStep([action])];
    }
    const way = findRoute(state, meta, action.stance);
    return way === null ? null : [...way, new SamplingStep([action])];
  }
  if (request.stance !== null && ["transition", "stance"].includes(request.kind)) {
    if (!graph.stances.has(request.stance)) {
      state.tell(meta, "no-stance", `there is no stance '${request.stance}' in the ${graph.layer} layer`);
      return null;
    }
    return findRoute(state, meta, request.stance);
  }
  const leads = meta.written ? findLead(state, now) : "";
  if (leads !== "") {
    return findRoute(state, meta, leads);
  }
  const found = _findCandidates(state, meta, now);
  return found.length === 0 ? null : [new SamplingStep(found)];
}

/**
 * Return the actions of the current stance that fit, none if every one played too recently for what the model wrote.
 * @param {LayerState} state
 * @param {MetaAction} meta
 * @param {number} now
 * @returns {Action[]}
 */
function _findCandidates(state, meta, now) {
  const request = meta.request;
  const graph = state.graph;
  const here = node(state.stance, request.kind);
  if (!state.candidates.has(here)) {
    state.candidates.set(here, graph.of(state.stance, request.kind).filter((a) => mayPlay(state, a)));
  }
  let every = state.candidates.get(here);
  if (request.among.length > 0) {
    every = every.filter((a) => request.among.includes(a.id));
  }
  let found = every;
  if (request.tags.length > 0) {
    found = every.filter((a) => request.tags.every((tag) => a.tags.includes(tag)));
  }
  let exact = found;
  if (request.limb !== null) {
    exact = found.filter((a) => a.limb === request.limb);
  }
  const directed = meta.written && state.project.settings.variety > 0;
  if (directed) { // the model's limb and tags are wishes, not orders
    every = keepFresh(state, meta, every, now);
    const fresh = new Set(every.map((a) => a.id));
    found = found.filter((a) => fresh.has(a.id));
    exact = exact.filter((a) => fresh.has(a.id));
    if (every.length === 0) {
      return findMoves(state, meta, now);
    }
    if (exact.length === 0) {
      exact = found.length > 0 ? found : every;
    }
  } else if (meta.written) { // nor worth playing the same again
    const again = (state.recent.get(here) ?? []).slice(-1);
    if (!exact.some((a) => !again.includes(a.id))) {
      exact = found.some((a) => !again.includes(a.id)) ? found : every;
    }
  }
  exact = keepModest(state, meta, exact, now);
  if (exact.length === 0) {
    const name = graph.stances.get(state.stance).name;
    let asked = [...request.tags, request.kind].join(" ");
    if (request.limb !== null) {
      asked = `${request.limb} ${asked}`;
    }
    if (found.length > 0) { // whose limb is a wish, too
      state.tell(meta, "other-limb", `stance '${name}' has no ${asked}; another will do`, true);
      return found;
    }
    const hint = meta.written ? "" : nameElsewhere(state, request);
    state.tell(meta, "no-candidate", `stance '${name}' has no ${asked}${hint}`);
  }
  return exact;
}
