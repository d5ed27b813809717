/**
 * What asks do to a running plan: what they take back, what lasts from then on, and which layers have to be planned again.
 *
 * Translated from metagraph/playback/planning/hearing.py; change that, and translate anew.
 */

import { LAYERS } from "./words.js";
import { goingOn } from "./items.js";
import { Track } from "./track.js";
import { isDigits, partedLast, zip } from "./basics.js";

/**
 * track: what lasts. withdrawn: ids of what was asked for before and is not any more. touched: layers that asks have to do
 * with.
 *
 * track: Track; withdrawn: Set<string>; touched: Set<string>.
 */
export class Heard {
  constructor(track, withdrawn, touched) {
    this.track = track;
    this.withdrawn = withdrawn;
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
  const before = requests.map((r) => r.id);
  before.push(...track.idents());
  const taken = new Set([]);
  for (const ident of before) {
    if (withdrawn.has("") || gone.has(ident) || (ident.includes(".") && owners(ident).some((o) => gone.has(o)))) {
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
  const said = more.speeches.map((s) => goingOn(track.lastSpeech(s.id), s, now));
  const begun = new Set([]); // of which more is said
  for (const [new_, asked] of zip(said, more.speeches)) {
    if (new_ !== asked) {
      begun.add(new_.id);
    }
  }
  const over = new Set([]);
  for (const ident of taken) {
    if (!begun.has(ident)) {
      over.add(ident);
    }
  }
  const left = track.without(over, now).without(begun);
  const lasting = new Track(more.looks, [...said], more.modes, more.places, more.blinks, [...stays], more.moods);
  return new Heard(left.joined(lasting), taken, touched);
}
