/**
 * The effect of requests on a running plan: what they take back, what lasts from then on, and which layers have to be
 * planned again.
 *
 * Translated from metagraph/playback/planning/hearing.py; change that, and translate anew.
 */

import { LAYERS } from "./words.js";
import { LookAt, behind, goingOn, paceSpeech } from "./items.js";
import { isSameSpot, named } from "./spots.js";
import { Track } from "./track.js";
import { 
  PAUSED,
  TOGETHER,
  breakOff,
  findSlot,
  findStop,
  findUtterances,
  finishSpeech,
  goesOn,
  isPaused,
  pause,
  resume,
  takesMore,
} from "./utterances.js";
import { MoodFrom } from "./mood.js";
import { but, isDigits, partedLast } from "./basics.js";

export const LISTENS = 2; // seconds for which the gaze stays with the partner who interrupts

/**
 * track: lasting items. fresh: requests of layers, with those that continue after a pause. withdrawn: ids of earlier
 * requests that no longer hold; stopped: those of them that were taken back, not replaced. touched: layers that the requests
 * affect.
 *
 * track: Track; fresh: MetaRequest[]; withdrawn: Set<string>; stopped: Set<string>; touched: Set<string>.
 */
export class Heard {
  constructor(track, fresh, withdrawn, stopped, touched) {
    this.track = track;
    this.fresh = fresh;
    this.withdrawn = withdrawn;
    this.stopped = stopped;
    this.touched = touched;
  }
}

/**
 * Return the ids of the asks from which a request may come: its own id, and those of which it would be a part.
 * @param {string} ident
 * @returns {string[]}
 */
export function owners(ident) {
  const out = [ident];
  let left = ident;
  while (true) {
    let dot;
    let number;
    ({ 0: left, 1: dot, 2: number } = partedLast(left, "."));
    if (dot === "" || !isDigits(number)) {
      return out;
    }
    out.push(left);
  }
}

/**
 * Return the ids with which a request is taken back: its `owners`, and the speech that a gesture belongs to: "answer" for
 * "answer/2".
 * @param {string} ident
 * @returns {string[]}
 */
export function makers(ident) {
  const out = owners(ident);
  const { 0: said, 1: slash, 2: number } = partedLast(out[out.length - 1], "/");
  if (slash !== "" && isDigits(number)) {
    out.push(said);
  }
  return out;
}

/**
 * Return the effect of asks. requests, track: of the plan. meant: the meaning of the asks; speeches may overlap in it.
 * present: when they became known. now: everything that begins earlier stays; soon: the same for voices. turning: layers
 * whose models perform differently in different modes.
 * @param {MetaRequest[]} requests
 * @param {Track} track
 * @param {Meaning} meant
 * @param {number} present
 * @param {number} now
 * @param {number} soon
 * @param {string[]} turning
 * @returns {Heard}
 */
export function heard(requests, track, meant, present, now, soon, turning) {
  const more = meant.track();
  const gone = new Set(meant.withdrawn);
  for (const report of meant.refused) {
    gone.add(report.request);
  }
  for (const request of meant.requests) {
    gone.add(request.id);
  }
  for (const ident of more.idents()) {
    gone.add(ident);
  }
  const words = addSpeeches(meant, track, present, soon);
  const before = requests.map((r) => r.id);
  before.push(...track.idents());
  // A client that takes everything back keeps the look at the user.
  const user = new Set(track.looks.filter((x) => x.start < now && isSameSpot(x.to, named("user"))).map((x) => x.id));
  const taken = new Set([]);
  const stopped = new Set([]);
  const withdrawn = meant.withdrawn;
  for (const ident of before) {
    const every = withdrawn.has("") && !user.has(ident);
    if (every || (withdrawn.size > 0 && makers(ident).some((o) => withdrawn.has(o)))) {
      stopped.add(ident);
    } else if (words.anew.size > 0 && !words.anew.has(ident) && makers(ident).some((o) => words.anew.has(o))) {
      stopped.add(ident); // what was made for the words before
    }
    if (stopped.has(ident) || gone.has(ident) || (ident.includes(".") && owners(ident).some((o) => gone.has(o)))) {
      taken.add(ident);
    }
  }
  // Leave to change stances again means nothing if the models always may.
  const staying = new Set(track.stays.filter((s) => s.on).map((s) => s.layer));
  for (const stay of more.stays) {
    if (stay.on) {
      staying.add(stay.layer);
    }
  }
  const stays = more.stays.filter((s) => staying.has(s.layer));
  const touched = new Set(meant.requests.map((r) => r.layer));
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
    || meant.steered.length > 0
    || track.modes.some((m) => taken.has(m.id))
    || track.speeches.some((s) => taken.has(s.id));
  if (turns) { // talking and listening characters move differently
    for (const layer of turning) {
      touched.add(layer);
    }
  }
  if (more.moods.length > 0 || track.moods.some((m) => taken.has(m.id))) {
    for (const layer of LAYERS) {
      touched.add(layer);
    }
  }
  let left = track;
  for (const ident of findUtterances(track, "", soon)) {
    if (stopped.has(ident)) {
      left = breakOff(left, ident, now);
    }
  }
  const over = new Set([]);
  for (const ident of taken) {
    if (!words.on.has(ident)) {
      over.add(ident);
    }
  }
  left = words.leave(left.without(over, now));
  for (const ident of over) {
    const open = left.lastSpeech(ident);
    if (open !== null && open.more) { // something else takes its place
      left = finishSpeech(left, ident, soon);
    }
  }
  const lasting = new Track(more.looks, [...words.said], more.modes, more.places, more.blinks, [...stays], [...words.moods]);
  const said = new Heard(left.joined(lasting), meant.requests, taken, stopped, touched);
  return _steer(requests, said, meant, now, soon);
}

/**
 * New speeches, combined with those that are being said. said: all that are new or changed. begun: ids of changed earlier
 * ones among them; on: ids of those that continue. `anew`: ids under which something else was said before. moods: the moods
 * requested with them.
 *
 * said: Speech[]; begun: Set<string>; on: Set<string>; anew: Set<string>; moods: MoodFrom[].
 */
export class AddedSpeeches {
  constructor(said, begun, on, anew, moods) {
    this.said = said;
    this.begun = begun;
    this.on = on;
    this.anew = anew;
    this.moods = moods;
  }

  /**
   * Return the part of a track that stays: moods of speeches that continue last as long as these, unless another mood is
   * requested.
   */
  leave(track) {
    if (this.on.size === 0 && this.begun.size === 0) {
      return track;
    }
    const other = new Set(this.moods.map((m) => m.id));
    const ends = new Map();
    for (const speech of this.said) {
      if (this.on.has(speech.id)) {
        ends.set(speech.id, speech.more ? PAUSED : speech.end);
      }
    }
    const speeches = track.speeches.filter((s) => !this.begun.has(s.id));
    const moods = [];
    for (const m of track.moods) {
      if (!ends.has(m.id) || other.has(m.id)) {
        moods.push(m);
      } else {
        moods.push(but(m, { end: ends.get(m.id) }));
      }
    }
    return new Track(track.looks, [...speeches], track.modes, track.places, track.blinks, track.stays, [...moods]);
  }
}

/**
 * Return the effect of asks to say something on a track: a new line, a line after another, or more of one. present: what
 * ended by then is over, and its end was reported; more of it begins a new utterance.
 * @param {Meaning} meant
 * @param {Track} track
 * @param {number} present
 * @param {number} soon
 * @returns {AddedSpeeches}
 */
export function addSpeeches(meant, track, present, soon) {
  let said = [];
  let begun = new Set([]);
  let on = new Set([]);
  const anew = new Set([]);
  const later = new Map(); // by how much those begin that are said behind others of their id
  for (const told of meant.speeches) {
    const taken = meant.withdrawn.has(told.id) || meant.withdrawn.has("");
    const before = taken ? null : track.lastSpeech(told.id);
    const last = [...said].reverse().find((s) => s.id === told.id) ?? before;
    let asked = told;
    let now = soon;
    if (last !== null && isPaused(last.start) && told.start <= soon && told.line === null) {
      now = last.start; // it is said when that is
      asked = but(told, { start: now, end: told.end + now - told.start });
    }
    const paces = told.more || (last !== null && last.more);
    if (paces && asked.timing === null && asked.line === null) {
      asked = paceSpeech(meant.alphabet, asked);
    }
    let one = goingOn(last, asked, now);
    let continues = false;
    if (one !== asked && last !== null && one.start === last.start) {
      continues = true;
      said = said.filter((s) => s.id !== one.id || s.start < one.start);
      if (last === before) {
        begun.add(one.id);
        said.push(...track.speeches.filter((s) => s.id === one.id && s !== last));
      }
    } else if (one === asked && last !== null) {
      const same = [...track.speeches, ...said].filter((s) => s.id === last.id && s.asked === last.asked);
      one = behind(same, asked, now);
      continues = one !== asked || (takesMore(last) && told.line === null && one.start <= now);
    }
    const over = last !== null && last.end <= present && !takesMore(last);
    const since = findAsked(track, last, continues && !over, one.id, soon);
    if (!continues) { // it replaces what was asked for at the same time
      said = said.filter((s) => s.id !== one.id);
      begun = _without(begun, one.id);
      on = _without(on, one.id);
    }
    if (before !== null && since === before.asked) {
      on.add(one.id);
    }
    if (one.start !== told.start) {
      later.set(one.id, one.start - told.start);
    }
    if (!continues && !on.has(one.id) && track.lastSpeech(one.id) !== null) {
      anew.add(one.id);
    }
    said.push(but(one, { asked: since }));
  }
  const opened = new Set(said.filter((s) => s.more).map((s) => s.id));
  const moods = [];
  for (const m of meant.moods) {
    const by = (later.has(m.id) && !begun.has(m.id)) ? later.get(m.id) : 0;
    const end = opened.has(m.id) ? PAUSED : m.end + by;
    moods.push(new MoodFrom(m.id, m.start + by, m.valence, m.arousal, m.intensity, end));
  }
  return new AddedSpeeches(said, begun, on, anew, moods);
}

/**
 * @param {Set<string>} idents
 * @param {string} ident
 * @returns {Set<string>}
 */
function _without(idents, ident) {
  const left = new Set([]);
  for (const other of idents) {
    if (other !== ident) {
      left.add(other);
    }
  }
  return left;
}

/**
 * Return when the utterance of a new piece was asked for. last: the piece before it, None if that is taken back; continues:
 * whether the new one goes on from it.
 * @param {Track} track
 * @param {?Speech} last
 * @param {boolean} continues
 * @param {string} ident
 * @param {number} soon
 * @returns {number}
 */
export function findAsked(track, last, continues, ident, soon) {
  if (last !== null && continues) {
    return last.asked;
  }
  const known = last === null ? track.lastSpeech(ident) : last;
  return known === null ? soon : Math.max(soon, known.asked + TOGETHER);
}

/**
 * Return the effect of asks that interrupt, pause, resume or finish speech, in order. requests: of the plan before.
 * @param {MetaRequest[]} requests
 * @param {Heard} told
 * @param {Meaning} meant
 * @param {number} now
 * @param {number} soon
 * @returns {Heard}
 */
function _steer(requests, told, meant, now, soon) {
  if (meant.steered.length === 0) {
    return told;
  }
  const steered = new SteeredSpeech(told.track, new Set(told.withdrawn), new Set(told.stopped), new Set(told.touched));
  steered.requests = requests.filter((r) => !told.withdrawn.has(r.id));
  for (const request of told.fresh) {
    steered.requests.push(request);
    steered.anew.add(request.id);
  }
  for (const ask of meant.steered) {
    const ids = findUtterances(steered.track, ask.what, soon);
    if (ask.do === "interrupt") {
      if (ids.length > 0) {
        const look = new LookAt(ask.id, now, now + LISTENS, named("user"), 1, true, ask.priority);
        steered.track = steered.track.joined(new Track([look]));
      }
      if (ask.what !== "" && !ids.includes(ask.what)) { // it may have been said, and its gestures go on
        ids.push(ask.what);
      }
    }
    for (const ident of ids) {
      const made = new Set(steered.idents().filter((x) => x.startsWith(ident) && makers(x).includes(ident)));
      if (ask.do === "interrupt") {
        const stop = findStop(meant.alphabet, steered.track, ident, soon, now);
        steered.interrupt(ident, made, Math.min(stop, now), now, soon);
      } else if (ask.do === "pause") {
        steered.pause(ident, made, findStop(meant.alphabet, steered.track, ident, soon, now), now);
      } else if (ask.do === "resume") {
        steered.resume(ident, made, now, soon);
      } else {
        steered.track = finishSpeech(steered.track, ident, soon);
      }
    }
  }
  const fresh = steered.requests.filter((r) => steered.anew.has(r.id));
  return new Heard(steered.track, fresh, steered.withdrawn, steered.stopped, steered.touched);
}

/**
 * A track and requests while asks steer speech. `anew`: ids of the requests that are made again; the other fields are as in
 * `Heard`.
 *
 * track: Track; withdrawn: Set<string>; stopped: Set<string>; touched: Set<string>; requests: MetaRequest[]; anew:
 * Set<string>.
 */
export class SteeredSpeech {
  constructor(track, withdrawn, stopped, touched, requests = [], anew = new Set([])) {
    this.track = track;
    this.withdrawn = withdrawn;
    this.stopped = stopped;
    this.touched = touched;
    this.requests = requests;
    this.anew = anew;
  }

  /** Return the ids of everything in it. */
  idents() {
    return [...this.requests.map((r) => r.id), ...this.track.idents()];
  }

  /** Break off an utterance at `stop`, and the requests that belong to it at `now`. */
  interrupt(ident, made, stop, now, soon) {
    if (goesOn(this.track.speeches, ident, soon)) {
      this.track = breakOff(this.track, ident, stop);
    }
    if (this.track.moods.some((m) => made.has(m.id))) {
      for (const layer of LAYERS) {
        this.touched.add(layer);
      }
    }
    this.track = this.track.without(made, now);
    for (const request of this.requests) {
      if (made.has(request.id)) {
        this.withdrawn.add(request.id);
        this.stopped.add(request.id);
        this.touched.add(request.layer);
      }
    }
    this.requests = this.requests.filter((r) => !made.has(r.id));
  }

  /** Pause an utterance, and the requests that belong to it and whose moment has not come; those that have begun go back. */
  pause(ident, made, stop, now) {
    if (isPaused(stop)) {
      return;
    }
    const slot = findSlot(this.track);
    this.track = pause(this.track, ident, made, stop, slot);
    const kept = [];
    for (const request of this.requests) {
      if (!made.has(request.id) || isPaused(request.start)) {
        kept.push(request);
        continue;
      }
      this.withdrawn.add(request.id);
      this.touched.add(request.layer);
      if (request.start < now) {
        this.stopped.add(request.id);
      }
      const wanted = request.stroke === null ? request.start : request.stroke;
      if (wanted >= stop) {
        kept.push(this.moveRequest(request, slot - stop, 0));
        this.anew.add(request.id);
      }
    }
    this.requests = kept;
  }

  /** Resume a paused utterance, and the requests that wait for it. */
  resume(ident, made, now, soon) {
    const held = this.track.speeches.find((s) => s.id === ident && isPaused(s.start)) ?? null;
    if (held === null) {
      return;
    }
    this.track = resume(this.track, ident, made, soon);
    const kept = [];
    for (const request of this.requests) {
      if (made.has(request.id) && isPaused(request.start)) {
        this.withdrawn.add(request.id);
        this.touched.add(request.layer);
        this.anew.add(request.id);
        kept.push(this.moveRequest(request, soon - held.start, now));
      } else {
        kept.push(request);
      }
    }
    this.requests = kept;
  }

  /** Return a request moved by a number of seconds, but not to before `least`. */
  moveRequest(request, by, least) {
    const stroke = request.stroke === null ? null : request.stroke + by;
    return but(request, { start: Math.max(least, request.start + by), stroke: stroke });
  }
}
