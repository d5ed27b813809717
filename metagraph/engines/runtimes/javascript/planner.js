/**
 * The planner: requests at any level in, a plan of specific actions out.
 *
 * Meta actions -> temporal replanning -> sampling, layer by layer (Borer et al., section 6). Planning from nothing and extending
 * a running plan are the same function.
 */

import { schedule } from "./life/schedule.js";
import { staysAt, toldMode } from "./life/track.js";
import { performs, write } from "./markov.js";
import { MetaAction, Report } from "./meta_plan.js";
import { FITS, Performer } from "./pick.js";
import { TEMPORAL } from "./plan.js";
import { delay, replan } from "./replan.js";
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
 * @returns {import("./plan.js").Plan}
 */
export function extend(graph, plan, now, requests, end, { stances = {}, idle = true } = {}, withdrawn = new Set(), leave = []) {
  const fresh = [...new Map(requests.map((r) => [r.id, r])).values()]; // of two with one id the later counts
  const again = new Set([...fresh.map((r) => r.id), ...withdrawn]);
  const layers = {};
  const reports = [];
  for (const layer of LAYERS) {
    const old = plan.layers[layer];
    if (leave.includes(layer)) {
      layers[layer] = old;
      reports.push(...plan.reports.filter((r) => r.layer === layer && !again.has(r.request)));
      continue;
    }
    const asked = fresh.filter((r) => r.layer === layer).map((r) => metaOf(r, graph.settings.window));
    const begin = beginStance(graph.layers[layer], old, stances?.[layer]);
    const found = extendLayer(graph, plan, layer, now, asked, again, end, begin, idle);
    layers[layer] = found.plan;
    reports.push(...found.reports);
  }
  return {
    seed: plan.seed, end, layers, track: plan.track,
    reports: reports.sort((a, b) => a.at - b.at),
    requests: [...plan.requests.filter((r) => !again.has(r.id)), ...fresh],
    life: schedule(graph, plan.track, plan.seed, end, plan.life, now),
  };
}

/** `window`: seconds a request may use when it does not say how long. */
function metaOf(request, window) {
  let length = request.duration === null ? window : Math.max(0, request.duration);
  if (request.stroke !== null) length = Math.max(length, request.stroke - request.start + FITS);
  return new MetaAction(request, request.start, request.start + length);
}

/** again: requests that replace what was asked before. */
function extendLayer(graph, plan, layer, now, asked, again, end, begin, idle) {
  const old = plan.layers[layer];
  const kept = old.cues.filter((cue) => cue.start < now);
  const played = new Set(kept.map((cue) => cue.meta));
  const waiting = new Set(old.cues.slice(kept.length).map((cue) => cue.meta)); // also those whose chain of transitions has begun
  let [written, cursor] = [[], old.cursor];
  if (idle) {
    const { markov, kinds } = graph.layers[layer];
    let more;
    [more, cursor] = write(markov, plan.seed, end, kinds, old.cursor);
    written = [...old.written, ...more].filter((m) => m.start >= now);
  }
  again = new Set([...again, ...written.map((m) => m.request.id)]);
  const stays = old.metas.filter((m) => !again.has(m.request.id));
  const future = stays.filter((m) => waiting.has(m.key) || (m.start >= now && !played.has(m.key)));
  // What was told about time still holds; the rest will be told again by those that are planned again.
  const at = (id, start) => `${start} ${id}`;
  const plannedAgain = new Set(future.map((m) => at(m.request.id, m.start)));
  const done = stays.filter((m) => !plannedAgain.has(at(m.request.id, m.start)) && (played.has(m.key) || m.start < now));
  const reports = plan.reports.filter(
    (r) => r.layer === layer && !again.has(r.request) && (TEMPORAL.has(r.outcome) || !plannedAgain.has(at(r.request, r.at))),
  );
  const performer = new Performer(graph, layer, plan.seed, begin, old.past, kept);
  if (!begin || !performer.begin(begin)) {
    const message = `the ${layer} layer has no stance with a loop to begin in`;
    for (const m of [...future, ...asked]) {
      if (!m.written) reports.push(new Report(m.request.id, "no-stance", message, layer, m.start));
    }
    const metas = [...done, ...future, ...asked];
    return { plan: { layer, metas, cues: [], rests: [], past: old.past, cursor, written }, reports };
  }
  if (old.rests.length && now > 0) {
    const begun = new Set(kept.map((cue) => cue.end - cue.blendOut));
    performer.rests = old.rests.filter((r) => r.fadeStart < now || begun.has(r.start));
  }
  performer.begun = new Set([...played].filter((key) => waiting.has(key)));
  performer.free = Math.max(now - (performer.ready - performer.free), performer.free);
  const [late, delayed] = delay(asked, performer.ready, graph.settings);
  // What runs keeps the time it was wanted for, from the models.
  const busy = done.reduce((latest, m) => (m.written ? latest : Math.max(latest, m.end)), -Infinity);
  const [placed, told] = replan([...future, ...written, ...late], graph.settings, busy);
  const leaves = (m) => m.request.kind === "transition" && staysAt(plan.track, layer, m.start);
  const performed = (m) => !leaves(m) && performs(graph.layers[layer].markov, plan.seed, m, toldMode(plan.track, m.start));
  performer.perform(placed.filter((m) => !m.written || performed(m)), end);
  performer.varyRests(end);
  const { cues, rests } = performer;
  return {
    plan: { layer, metas: [...done, ...placed], cues, rests, past: old.past, cursor, written },
    reports: [...reports, ...delayed, ...told, ...performer.reports],
  };
}

/** Return the stance a layer begins in: as it did before, as asked, the graph's start, or the first that has a loop. */
function beginStance(graph, old, stance) {
  const wishes = [old.past.stance, old.rests[0]?.stance, stance, graph.start, ...graph.stances.keys()];
  return wishes.find((s) => graph.stances.has(s) && graph.of(s, "stance").length) ?? "";
}
