/** Performing what is asked while it comes in: working asks into a running plan, forgetting what is over, and answering. */

import { but } from "./basics.js";
import { heard, owners } from "./hearing.js";
import { Past } from "./meta_plan.js";
import { FOREVER } from "./meaning.js";
import { extend } from "./planner.js";
import { remember } from "./remembering.js";
import { understand } from "./understand.js";
import { findSoon, isPaused } from "./utterances.js";
import { LAYERS } from "./words.js";

// What answers call what lasts; where a layer stays is told by the way to it.
const LANES = { look: "looks", speech: "speeches", mode: "modes", place: "places", blink: "blinks", mood: "moods" };

/**
 * Return the plan with asks worked in that became known at `now`, and the horizon moved to `end`.
 *
 * What begins before now + lookahead stays as it was, but at the very beginning, when nothing has been shown; voices begin and stop
 * sooner. Asks need ids; of two with one id the later counts. What cannot be understood is in the plan's reports; nothing is thrown.
 * @param {import("./graph.js").Graph} graph @param {import("./plan.js").Plan} plan @param {number} now @param {object[]} asks
 * @param {number} end @param {{stances?: Record<string, string>, idle?: boolean}} [options] @returns {import("./plan.js").Plan}
 */
export function hear(graph, plan, now, asks, end, options = {}) {
  const fixed = now > 0 ? now + graph.settings.lookahead : 0;
  const soon = findSoon(now, graph.settings.lookahead);
  const meant = understand(graph, asks, fixed, soon);
  const turning = LAYERS.filter((layer) => graph.layers[layer].markov.modes.length);
  const { track, fresh, withdrawn, stopped, touched } = heard(plan.requests, plan.track, meant, now, fixed, soon, turning);
  // Without any asks everything is planned on; with some, what they have to do with.
  const leave = asks.length && now > 0 && end === plan.end ? LAYERS.filter((layer) => !touched.has(layer)) : [];
  const after = extend(graph, { ...plan, track }, fixed, fresh, end, options, withdrawn, leave, stopped);
  return meant.refused.length ? { ...after, reports: [...after.reports, ...meant.refused] } : after;
}

/**
 * Say what a plan does about asks: when each will play, or why it will not.
 * @param {import("./plan.js").Plan} plan @param {Iterable<string>} ids
 * @returns {Map<string, {id: string, state: string, at: ?number, until: ?number, what: string[], why: string}>}
 */
export function answers(plan, ids) {
  const found = new Map([...ids].map((id) => [id, { plays: [], told: [], waiting: [] }]));
  const each = (made, note) => {
    for (const owner of owners(made)) if (found.has(owner)) note(found.get(owner));
  };
  const served = servedBy(plan.reports);
  for (const { cues, metas } of Object.values(plan.layers)) {
    const play = (id, cue) => each(id, (x) => x.plays.push({ start: cue.start, end: cue.end, what: cue.action.name }));
    for (const cue of cues) {
      play(cue.meta.split("+")[0], cue);
      for (const id of served.get(cue.meta) ?? []) play(id, cue);
    }
    for (const meta of metas) if (meta.start >= plan.end) each(meta.request.id, (x) => x.waiting.push(meta.start));
  }
  for (const [what, lane] of Object.entries(LANES)) {
    const items = lane === "speeches" ? new Map(plan.track[lane].map((x) => [x.id, x])).values() : plan.track[lane]; // of an id the last
    for (const { id, start, end = what === "blink" ? start : FOREVER } of items) {
      each(id, (x) => (isPaused(start) ? x.waiting.push(start) : x.plays.push({ start, end, what })));
    }
  }
  for (const told of plan.reports) each(told.request, (x) => x.told.push(told));
  return new Map([...found].map(([id, x]) => [id, { id, ...answer(x) }]));
}

/** Return the requests that the action of another serves, by that one's key. */
function servedBy(reports) {
  const served = new Map();
  for (const { by, request } of reports) if (by) served.set(by, [...(served.get(by) ?? []), request]);
  return served;
}

function answer({ plays, told, waiting }) {
  const why = [...new Set(told.map((r) => r.message))].join("; ");
  const is = (...outcomes) => told.some((r) => outcomes.includes(r.outcome));
  if (plays.length) {
    return {
      state: is("late", "queued", "resumed") ? "late" : "planned",
      at: Math.min(...plays.map((p) => p.start)), until: Math.max(...plays.map((p) => p.end)), what: plays.map((p) => p.what), why,
    };
  }
  const nothing = { at: null, until: null, what: [] };
  if (is("already-there")) return { state: "done", ...nothing, why };
  if (waiting.length && told.every((r) => r.played)) {
    if (isPaused(waiting[0])) return { state: "planned", ...nothing, why: "it is paused" };
    return { state: told.length ? "late" : "planned", ...nothing, at: waiting[0], why: why || "chosen when its time is nearer" };
  }
  return { state: "refused", ...nothing, why: why || "nothing came of it" };
}

/**
 * Return a running plan without what ended before `seconds`; what is planned on from it stays as it would have been. Poses before
 * `seconds` are lost.
 * @param {import("./plan.js").Plan} plan @param {number} seconds @returns {import("./plan.js").Plan}
 */
export function since(plan, seconds) {
  const layers = Object.fromEntries(LAYERS.map((layer) => [layer, sinceLayer(plan.layers[layer], seconds)]));
  const known = new Set(Object.values(layers).flatMap((of) => of.metas.map((m) => m.request.id)));
  return {
    ...plan,
    layers,
    reports: plan.reports.filter((r) => r.at >= seconds),
    requests: plan.requests.filter((r) => r.start >= seconds || known.has(r.id)),
    track: plan.track.since(seconds),
    life: plan.life?.since(seconds) ?? null,
  };
}

function sinceLayer(plan, seconds) {
  const first = plan.cues.findIndex((cue) => cue.end >= seconds);
  const gone = plan.cues.slice(0, first < 0 ? plan.cues.length : first);
  const cues = plan.cues.slice(gone.length);
  const played = new Set(cues.map((cue) => cue.meta));
  let under = 0; // the last rest that has taken over by then
  plan.rests.forEach((rest, n) => {
    if (rest.fadeStart + rest.fade <= seconds) under = n;
  });
  return but(plan, {
    cues,
    metas: plan.metas.filter((m) => m.end >= seconds || played.has(m.key)),
    rests: plan.rests.slice(under),
    past: pastOf(plan.past, gone),
  });
}

function pastOf(past, gone) {
  if (!gone.length) return past;
  const last = gone[gone.length - 1];
  const [uses, recent, ended] = [new Map(past.uses), new Map(past.recent), new Map(past.ended)];
  for (const cue of gone) remember(cue, uses, recent, ended);
  return new Past(last.end, last.then, uses, recent, ended);
}
