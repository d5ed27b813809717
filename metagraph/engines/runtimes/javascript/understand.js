/** From asks at any level of abstraction to what the planner and the life layers work with (Borer et al., section 6, figure 5). */

import { ALPHABET } from "./alphabet.js";
import { readAsk } from "./asks.js";
import { readAloud } from "./graphemes.js";
import { timedSeconds, toldText } from "./line_timing.js";
import { Report } from "./meta_plan.js";
import { makeRequest } from "./plan.js";
import { toldTiming } from "./told_timing.js";
import { LAYERS } from "./words.js";

const FOREVER = 1e9; // seconds; a look that lasts until the next

/** What an ask cannot mean; never leaves this file. */
class AskError extends Error {}

/**
 * Return what asks mean. An ask that makes several requests gives them ids of its own: `<id>`, `<id>.1`, `<id>.2`, ...
 *
 * requests: for the layers. items: for the track. withdrawn: ids taken back; every id where it holds "". refused: reports of what
 * could not be understood.
 * @param {import("./graph.js").Graph} graph @param {unknown[]} asks as JSON @param {number} now when those begin that do not say
 */
export function understand(graph, asks, now) {
  const out = { requests: [], items: [], withdrawn: new Set(), refused: [] };
  for (const data of asks) {
    const { ask, why } = readAsk(data);
    const refuse = (id, message) => {
      const at = ask?.at ?? now;
      const layer = ask?.layer ?? "arms";
      out.refused.push(new Report(id, "not-understood", message, layer, at));
    };
    if (!ask) {
      refuse(typeof data?.id === "string" ? data.id : "", why);
      continue;
    }
    try {
      for (const { as, ...meant } of meaning(graph, ask, ask.at ?? now, refuse)) {
        if (as === "request") out.requests.push(makeRequest(meant));
        else if (as === "withdraw") out.withdrawn.add(meant.what);
        else out.items.push(meant);
      }
    } catch (error) {
      if (!(error instanceof AskError)) throw error;
      refuse(ask.id, error.message);
    }
  }
  return out;
}

/** Return what one ask means, each `as` a request, an item of the track or a withdrawal. Throws AskError where it can mean nothing. */
function meaning(graph, ask, at, refuse) {
  const { id, priority } = ask;
  const request = (fields) => [{ as: "request", id, priority, start: at, late: ask.late, ...fields }];
  const item = (fields) => ({ as: "item", id, start: at, ...fields });
  switch (ask.do) {
    case "gesture": {
      const { layer, tags, limb, duration, stroke, hold, prepare, resume } = ask;
      const start = stroke === null ? at : Math.max(0, stroke - longestLead(graph, layer, tags));
      return request({ layer, kind: "gesture", start, duration, tags, limb, stroke, hold, prepare, resume });
    }
    case "fidget": {
      const { layer, tags, limb, duration, resume } = ask;
      return request({ layer, kind: "fidget", duration, tags, limb, resume });
    }
    case "action": {
      const action = findAction(graph, ask.action, ask.layer);
      const { layer, kind } = action;
      const { stroke, hold, prepare } = ask;
      const start = stroke === null ? at : Math.max(0, stroke - lead(action));
      return request({ layer, kind, start, action: action.id, stroke, hold, prepare });
    }
    case "stance": {
      const { layer, stance } = findStance(graph, ask.stance, ask.layer);
      const stay = item({ kind: "stay", layer, on: ask.stay, end: Infinity });
      return [...request({ layer, kind: "transition", stance }), stay];
    }
    case "change": // whichever arm was seen to move: stances are joined by few transitions, and mostly of both
      return request({ layer: ask.layer, kind: "transition" });
    case "nod":
    case "shake":
      return request({ layer: "head", kind: "gesture", ...headGesture(graph, ask.do, ask.tags) });
    case "look": {
      const { to, amount, strict } = ask;
      return [item({ kind: "look", end: ask.duration === null ? FOREVER : at + ask.duration, to, amount, strict, priority })];
    }
    case "blink":
      return [item({ kind: "blink" })];
    case "mode":
      return [item({ kind: "mode", mode: ask.mode })];
    case "place":
      return [item({ kind: "place", name: ask.name, point: ask.point })];
    case "withdraw":
      return [{ as: "withdraw", what: ask.what }];
    case "say":
      return said(graph, ask, at, item, refuse);
    default:
      throw new AskError("a runtime does not read BML: send it through Metagraph, or ask for what it says");
  }
}

/** Return the speech of a `say` and what its line asks for while it is said. */
function said(graph, ask, at, item, refuse) {
  const name = ask.line === null ? null : String(ask.line);
  const line = name === null ? null : graph.lines.get(name);
  if (line === undefined) throw new AskError(`there is no line '${name}'`);
  const { timing, why } = toldTiming(ask);
  if (why) throw new AskError(why);
  const text = ask.text || (line?.text ?? (timing ? toldText(timing) : ""));
  if (!line && !text && !timing) throw new AskError("say what: a line's id, text, or words with their times");
  const { priority } = ask;
  const end = at + (timing ? timedSeconds(timing, ask.duration) : spokenSeconds(graph, name, text, ask.duration));
  const out = [item({ kind: "speech", end, line: name, text, priority, length: null, timing })];
  (ask.gestures ? (line?.asks ?? []) : []).forEach((data, n) => {
    const id = `${ask.id}.${n + 1}`;
    const { ask: inner, why } = readAsk(data);
    if (!inner) throw new AskError(`line '${name}' asks for what cannot be read: ${why}`);
    if (inner.do === "say") throw new AskError(`line '${name}' would say another line; its asks may not`);
    if (inner.do === "bml") return refuse(id, "a runtime does not read BML"); // the rest of the line is said all the same
    const begins = at + (inner.at ?? 0);
    const shifted = { ...inner, id, at: begins, priority: Math.max(inner.priority, priority) };
    if (inner.stroke != null) shifted.stroke = at + inner.stroke;
    out.push(...meaning(graph, shifted, begins, refuse));
  });
  return out;
}

/** Return how long something takes to say: as asked, as its sound, as the line says, or as its text is long. */
function spokenSeconds(graph, line, text, duration) {
  const known = graph.voices.known.get(line)?.duration ?? graph.lines.get(line)?.duration;
  return duration ?? known ?? readAloud(ALPHABET, text);
}

/** Nods are gestures tagged so; where none is, one of those called so. */
function headGesture(graph, word, tags) {
  const every = [...graph.layers.head.actions.values()];
  const gestures = every.filter((a) => a.kind === "gesture" && tags.every((tag) => a.tags.includes(tag)));
  if (gestures.some((a) => a.tags.includes(word))) return { tags: [word, ...tags] };
  const among = gestures.filter((a) => a.name.toLowerCase().includes(word)).map((a) => a.id);
  if (!among.length) throw new AskError(`the head layer has no gesture tagged or called '${[word, ...tags].join("', '")}'`);
  return { among };
}

/** Return how long before its stroke any gesture with these tags begins. */
function longestLead(graph, layer, tags) {
  let longest = 0;
  for (const action of graph.layers[layer].actions.values()) {
    if (action.kind === "gesture" && tags.every((tag) => action.tags.includes(tag))) longest = Math.max(longest, lead(action));
  }
  return longest;
}

/** Return the seconds from an action's start to its stroke. */
const lead = (action) => action.phases.stroke - action.start;

/** Return the action of an id or, failing that, a name; of several of one name the likeliest. */
function findAction(graph, word, layer) {
  const layers = LAYERS.map((each) => graph.layers[each]);
  const found = layers.find((each) => each.actions.has(word))?.actions.get(word);
  if (found && (layer === null || layer === found.layer)) return found;
  const every = layers.filter((each) => layer === null || layer === each.layer).flatMap((each) => [...each.actions.values()]);
  const called = every.filter((a) => a.name === word);
  if (!called.length) throw new AskError(`there is no action '${word}'${layer === null ? "" : ` in the ${layer} layer`}`);
  return called.reduce((best, a) => (a.likelihood > best.likelihood ? a : best));
}

/** Return layer and id of a stance from its id or name. */
function findStance(graph, word, only) {
  for (const layer of LAYERS.filter((each) => only === null || only === each)) {
    const { stances } = graph.layers[layer];
    if (stances.has(word)) return { layer, stance: word };
    for (const stance of stances.values()) if (stance.name === word) return { layer, stance: stance.id };
  }
  throw new AskError(`there is no stance '${word}'${only === null ? "" : ` in the ${only} layer`}`);
}
