/**
 * What asks do to a running plan: what they take back, what lasts from then on, and which layers have to be planned again.
 *
 * Translated from metagraph/playback/planning/hearing.py; change that, and translate anew.
 */

import { LAYERS } from "./words.js";
import { behind, goingOn } from "./items.js";
import { isSameSpot, named } from "./spots.js";
import { Track } from "./track.js";
import { MoodFrom } from "./mood.js";
import { isDigits, partedLast } from "./basics.js";

/**
 * track: what lasts. withdrawn: ids of what was asked for before and is not any more; stopped: those of them that were taken
 * back and not asked for anew. touched: layers that asks have to do with.
 *
 * track: Track; withdrawn: Set<string>; stopped: Set<string>; touched: Set<string>.
 */
export class Heard {
  constructor(track, withdrawn, stopped, touched) {
    this.track = track;
    this.withdrawn = withdrawn;
    this.stopped = stopped;
    this.touched = touched;
  }
}

/**
 * Return the asks a request may have been made by: that of its own id, and those of which it would be a part.
 * @param {string} ident
 * @returns {string[]}
 */
export function owners(ident) {
  const out = [ident];
  let left = ident;
  while (true) {
    let dot;
    let number;
    [left, dot, number] = partedLast(left, ".");
    if (dot === "" || !isDigits(number)) {
      return out;
    }
    out.push(left);
  }
}

/**
 * Return what a request goes with when it is taken back: its `owners`, and what is said that a gesture was made for:
 * "answer" for "answer/2".
 * @param {string} ident
 * @returns {string[]}
 */
export function makers(ident) {
  const out = owners(ident);
  const [said, slash, number] = partedLast(out[out.length - 1], "/");
  if (slash !== "" && isDigits(number)) {
    out.push(said);
  }
  return out;
}

/**
 * Return what asks do. requests, track: of the plan. fresh, more: what is asked for, where speeches may overlap. withdrawn:
 * ids taken back; every one where it holds "". refused: ids of what could not be understood. now: what begins before stays.
 * turning: layers whose models perform one thing in one mode and another in another.
 * @param {MetaRequest[]} requests
 * @param {Track} track
 * @param {MetaRequest[]} fresh
 * @param {Track} more
 * @param {Set<string>} withdrawn
 * @param {string[]} refused
 * @param {number} now
 * @param {string[]} turning
 * @returns {Heard}
 */
export function heard(requests, track, fresh, more, withdrawn, refused, now, turning) {
  const gone = new Set(withdrawn);
  for (const ident of refused) {
    gone.add(ident);
  }
  for (const request of fresh) {
    gone.add(request.id);
  }
  for (const ident of more.idents()) {
    gone.add(ident);
  }
  let said = [];
  const begun = new Set([]); // of which more is said
  const anew = new Set([]); // of which something else was said before
  const later = new Map(); // by how much those begin that are said behind others of their id
  for (const asked of more.speeches) {
    const beforeIt = withdrawn.has(asked.id) ? null : track.lastSpeech(asked.id);
    const last = [...said].reverse().find((s) => s.id === asked.id) ?? beforeIt;
    let one = goingOn(last, asked, now);
    if (one !== asked && last !== null && one.start === last.start) {
      begun.add(one.id);
      said = said.filter((s) => s.id !== one.id);
    } else if (one === asked && !withdrawn.has(asked.id)) {
      one = behind([...track.speeches, ...said], asked, now);
      if (one !== asked) {
        later.set(one.id, one.start - asked.start);
      }
    }
    if (one === asked && track.lastSpeech(one.id) !== null) {
      anew.add(one.id);
    }
    said.push(one);
  }
  const before = requests.map((r) => r.id);
  before.push(...track.idents());
  // Who takes everything back still looks at whom it talks with.
  const user = new Set(track.looks.filter((x) => x.start < now && isSameSpot(x.to, named("user"))).map((x) => x.id));
  const taken = new Set([]);
  const stopped = new Set([]);
  for (const ident of before) {
    const every = withdrawn.has("") && !user.has(ident);
    if (every || (withdrawn.size > 0 && makers(ident).some((o) => withdrawn.has(o)))) {
      stopped.add(ident);
    } else if (anew.size > 0 && !anew.has(ident) && makers(ident).some((o) => anew.has(o))) {
      stopped.add(ident); // what was made for the words before
    }
    if (stopped.has(ident) || gone.has(ident) || (ident.includes(".") && owners(ident).some((o) => gone.has(o)))) {
      taken.add(ident);
    }
  }
  // Where the models may change stances again means nothing where they always might.
  const staying = new Set(track.stays.filter((s) => s.on).map((s) => s.layer));
  for (const stay of more.stays) {
    if (stay.on) {
      staying.add(stay.layer);
    }
  }
  const stays = more.stays.filter((s) => staying.has(s.layer));
  const touched = new Set(fresh.map((r) => r.layer));
  for (const request of requests) {
    if (taken.has(request.id)) {
      touched.add(request.layer);
    }
  }
  for (const stay of [...track.stays, ...stays]) {
    if (gone.has(stay.id) || taken.has(stay.id)) {
      touched.add(stay.layer);
    }
  }
  const turns = more.modes.length > 0
    || more.speeches.length > 0
    || track.modes.some((m) => taken.has(m.id))
    || track.speeches.some((s) => taken.has(s.id));
  if (turns) { // who talks moves otherwise than who listens
    for (const layer of turning) {
      touched.add(layer);
    }
  }
  if (more.moods.length > 0 || track.moods.some((m) => taken.has(m.id))) {
    for (const layer of LAYERS) {
      touched.add(layer);
    }
  }
  const over = new Set([]);
  for (const ident of taken) {
    if (!begun.has(ident) && !later.has(ident)) {
      over.add(ident);
    }
  }
  const moods = more.moods.map((m) =>
    later.has(m.id)
      ? new MoodFrom(m.id, m.start + later.get(m.id), m.valence, m.arousal, m.intensity, m.end + later.get(m.id))
      : m);
  const left = track.without(over, now).without(begun);
  const lasting = new Track(more.looks, [...said], more.modes, more.places, more.blinks, [...stays], [...moods]);
  return new Heard(left.joined(lasting), taken, stopped, touched);
}
