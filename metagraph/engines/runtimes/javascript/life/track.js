/**
 * What was asked for and lasts: where to look, what to say, which mode to be in, which stance to stay in. Values; times are seconds.
 *
 * Every item has `kind`, `id` and `start`; a look also `end`, `to` (a name or a point), `amount`, `strict`, `priority`; a speech `end`,
 * `line` (id or null), `text`, `priority`, `length` (seconds it would have taken, where something cut it short), `timing` (when its words and
 * mouth shapes come, null where that was not told); a mode `mode`; a place `name` and `point`; a stay `layer`, `on`, `end`.
 */

import { compareText } from "../basics.js";
import { extended, timedSeconds, toldText } from "../line_timing.js";

const LANES = { look: "looks", speech: "speeches", mode: "modes", place: "places", blink: "blinks", stay: "stays" };

/** All of it, each by start. Speeches do not overlap. */
export const emptyTrack = () => ({ looks: [], speeches: [], modes: [], places: [], blinks: [], stays: [] });

export const trackItems = (track) => Object.values(LANES).flatMap((lane) => track[lane]);

/** Return whether the models may not change a layer's stance at a time. */
export function staysAt(track, layer, seconds) {
  const last = track.stays.findLast((stay) => stay.layer === layer && stay.start <= seconds);
  return last !== undefined && last.on && seconds < last.end;
}

/** Return the mode asked for at a time, or talking while something is said; null where neither tells. */
export function toldMode(track, seconds) {
  const asked = track.modes.findLast((mode) => mode.start <= seconds);
  if (asked && asked.mode !== null) return asked.mode;
  const said = track.speeches.findLast((speech) => speech.start <= seconds);
  return said && seconds < said.end ? "talking" : null;
}

/** Return the track without items of these ids that begin at `now` or later; what has begun ends now, if it can. */
export function without(track, ids, now) {
  if (!trackItems(track).some((item) => ids.has(item.id))) return track;
  const kept = (item) => {
    if (!ids.has(item.id)) return [item];
    if (item.start >= now) return [];
    if (item.kind === "speech") return [cut(item, now)];
    return item.kind === "look" || item.kind === "stay" ? [{ ...item, end: Math.min(item.end, now) }] : [item];
  };
  return Object.fromEntries(Object.values(LANES).map((lane) => [lane, track[lane].flatMap(kept)]));
}

/** Return the track with more items; of speeches that overlap the later or more important cuts the other short. */
export function plus(track, items) {
  if (!items.length) return track;
  const out = { ...track };
  for (const item of [...items].sort(order)) {
    const lane = LANES[item.kind];
    const before = out[lane].findLastIndex((other) => order(other, item) <= 0) + 1;
    out[lane] = [...out[lane].slice(0, before), item, ...out[lane].slice(before)];
  }
  if (out.speeches !== track.speeches) out.speeches = apart(out.speeches);
  return out;
}

/**
 * Return an item as it goes on where a line of the same id has begun by `now`, or begins with it: it keeps its start and what has been said of it. Only
 * lines whose words or shapes were told with their times do.
 */
export function goesOn(track, item, now) {
  if (item.kind !== "speech" || !item.timing) return item;
  const old = track.speeches.findLast((speech) => speech.id === item.id);
  if (!old?.timing || old.length !== null) return item;
  if (Math.max(old.start, item.start) > now && old.start !== item.start) return item;
  const timing = extended(old.timing, item.timing, Math.max(now - old.start, 0));
  const length = Math.max(timedSeconds(timing, null), item.end - item.start);
  const text = item.text === "" || item.text === toldText(item.timing) ? toldText(timing) : item.text;
  return { ...item, start: old.start, end: old.start + length, text, timing };
}

/** Return the track without what no time from `seconds` on needs. */
export function sinceTrack(track, seconds) {
  const begun = (lane) => track[lane].filter((item) => item.start <= seconds);
  const last = (lane, of) => [...new Map(begun(lane).map((item) => [of(item), item])).values()];
  let looks = []; // those that no later one has replaced; also what is over: it tells since when what shows has shown
  for (const look of begun("looks")) looks = [...looks.filter((x) => x.priority > look.priority), look];
  const old = new Set([...looks, ...last("modes", () => ""), ...last("places", (p) => p.name), ...last("stays", (s) => s.layer)]);
  const kept = (item) => item.start > seconds || old.has(item) || (item.kind === "speech" && item.end > seconds);
  return Object.fromEntries(Object.values(LANES).map((lane) => [lane, track[lane].filter(kept)]));
}

/** Return whether two tracks hold the same in these lanes. */
export function alike(a, b, lanes = Object.values(LANES)) {
  return a === b || lanes.every((lane) => a[lane].length === b[lane].length && a[lane].every((item, n) => same(item, b[lane][n])));
}

function same(a, b) {
  const alike = { to: samePlace, point: samePlace, timing: sameTiming };
  return a === b || Object.keys(a).every((key) => a[key] === b[key] || alike[key]?.(a[key], b[key]));
}

const sameTiming = (a, b) => JSON.stringify(a) === JSON.stringify(b);

/** Return whether two names or points are the same. */
export function samePlace(a, b) {
  return a === b || (Array.isArray(a) && Array.isArray(b) && a.every((x, n) => x === b[n]));
}

const order = (a, b) => a.start - b.start || compareText(a.id, b.id);

/** Return the speech, ending no later than `at`; how long it would have been is remembered. */
function cut(speech, at) {
  return speech.end <= at ? speech : { ...speech, end: at, length: speech.length ?? speech.end - speech.start };
}

/** Return speeches without overlaps: one that is at least as important cuts the running one, a lesser one is not said. */
function apart(speeches) {
  const out = [];
  for (const speech of speeches) {
    const last = out[out.length - 1];
    if (last && last.end > speech.start) {
      if (speech.priority < last.priority) continue;
      if (last.start >= speech.start) out.pop();
      else out[out.length - 1] = cut(last, speech.start);
    }
    out.push(speech);
  }
  return out;
}
