/**
 * What was asked of the life layers, as segments in time: which mode the character is in, and what it looks at.
 * @typedef {{start: number, to: string | number[], since: number, amount: number, strict: boolean, asked: boolean}} Target what is
 *   looked at from `start` on. `since`: when the look at it began; its place may have changed meanwhile. `asked`: not of its own accord.
 */

import { begunBy } from "../basics.js";
import { MODES } from "../words.js";
import { samePlace, toldMode } from "./track.js";

export const PARTNER = "user"; // whom the character talks with, and looks at when nothing else is asked for
export const AHEAD = "ahead"; // nothing in particular: eyes and head as the layers have them

/** Whether two targets are the same but for their times. @param {Target} a @param {Target} b */
export const alikeTargets = (a, b) => samePlace(a.to, b.to) && a.amount === b.amount && a.strict === b.strict && a.asked === b.asked;

/** Return the place among MODES of the mode asked for; where none is, talking while something is said and idle otherwise. */
function modeAt(track, seconds) {
  return MODES.indexOf(toldMode(track, seconds) ?? "idle");
}

/** Return [start, place among MODES] of each mode from `start` to before `end`; the first begins at `start`. */
export function modesBetween(track, start, end) {
  const edges = new Set([start, ...track.modes.map((m) => m.start), ...track.speeches.flatMap((x) => [x.start, x.end])]);
  const out = [];
  for (const edge of [...edges].filter((e) => start <= e && e < end).sort((a, b) => a - b)) {
    const mode = modeAt(track, edge);
    if (!out.length || out[out.length - 1][1] !== mode) out.push([edge, mode]);
  }
  return out;
}

/**
 * Return what is looked at from `start` to before `end`; the first begins at `start`. The latest look holds until it ends or another
 * of its importance or more begins; a lesser one waits beneath.
 * @returns {Target[]}
 */
export function targetsBetween(track, start, end) {
  const [OVER, LOOK, PLACE, BEGIN] = [0, 1, 2, 3];
  const changes = [
    ...track.looks.map((look) => ({ at: look.start, kind: LOOK, what: look })),
    ...track.looks.map((look) => ({ at: look.end, kind: OVER, what: look })),
    ...track.places.map((place) => ({ at: place.start, kind: PLACE, what: place })),
    { at: start, kind: BEGIN, what: null },
  ].sort((a, b) => a.at - b.at || a.kind - b.kind);
  let looks = []; // the most important first; those beneath are older or lesser
  const places = new Map();
  let chosen = null;
  let since = 0;
  const out = [];
  changes.forEach(({ at, kind, what }, n) => {
    if (at >= end) return;
    if (kind === LOOK) {
      looks = looks.filter((look) => look.priority > what.priority);
      if (what.end > what.start) looks.push(what);
    } else if (kind === OVER) {
      looks = looks.filter((look) => look !== what);
    } else if (kind === PLACE) {
      places.set(what.name, what.point);
    }
    if (chosen !== (looks[0] ?? null)) [chosen, since] = [looks[0] ?? null, at];
    if (at < start || changes[n + 1]?.at === at) return;
    const target = targetOf(at, since, chosen, places);
    if (!out.length || !alikeTargets(target, out[out.length - 1])) out.push(target);
  });
  return out;
}

function targetOf(start, since, look, places) {
  const placed = (to) => places.get(to) ?? to;
  if (!look) return { start, to: placed(PARTNER), since, amount: 1, strict: false, asked: false };
  return { start, to: placed(look.to), since, amount: look.amount, strict: look.strict, asked: true };
}
