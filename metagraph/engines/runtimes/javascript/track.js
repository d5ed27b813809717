/**
 * All requests that last, in order; see `items`. Times are seconds.
 *
 * Translated from metagraph/playback/life/track.py; change that, and translate anew.
 */

import { 
  alikeBlinks,
  alikeFelt,
  alikeLooks,
  alikeModes,
  alikePlaces,
  alikeSpeeches,
  alikeStays,
  apart,
  cut,
} from "./items.js";
import { lasting } from "./mood.js";
import { bisectRight, but, insort } from "./basics.js";

/**
 * All lasting requests, each kind sorted by start. Speeches do not overlap.
 *
 * looks: LookAt[]; speeches: Speech[]; modes: ModeFrom[]; places: PlaceFrom[]; blinks: BlinkAt[]; stays: StayFrom[]; moods:
 * MoodFrom[].
 */
export class Track {
  constructor(looks = [], speeches = [], modes = [], places = [], blinks = [], stays = [], moods = []) {
    this.looks = looks;
    this.speeches = speeches;
    this.modes = modes;
    this.places = places;
    this.blinks = blinks;
    this.stays = stays;
    this.moods = moods;
  }

  /** Return the ids of all items. */
  idents() {
    const out = this.looks.map((x) => x.id);
    out.push(...this.speeches.map((x) => x.id));
    out.push(...this.modes.map((x) => x.id));
    out.push(...this.places.map((x) => x.id));
    out.push(...this.blinks.map((x) => x.id));
    out.push(...this.stays.map((x) => x.id));
    out.push(...this.moods.map((x) => x.id));
    return out;
  }

  /** Return whether the models may not change a layer's stance at a time. */
  staysAt(layer, seconds) {
    const last = [...this.stays].reverse().find((s) => s.layer === layer && s.start <= seconds) ?? null;
    return last !== null && last.on && seconds < last.end;
  }

  /** Return the mode requested at a time, or talking while something is said; None if neither applies. */
  toldMode(seconds) {
    const asked = bisectRight(this.modes.map((m) => m.start), seconds) - 1;
    if (asked >= 0 && this.modes[asked].mode !== null) {
      return this.modes[asked].mode;
    }
    const said = bisectRight(this.speeches.map((s) => s.start), seconds) - 1;
    return (said >= 0 && seconds < this.speeches[said].end) ? "talking" : null;
  }

  /** Return the track without items of these ids that begin at `now` or later; those that have begun end now, if they can. */
  without(idents, now = -Infinity) {
    if (idents.size === 0 || !this.idents().some((ident) => idents.has(ident))) {
      return this;
    }
    return new Track(
      this.looks.filter((x) => !idents.has(x.id) || x.start < now).map((x) =>
        idents.has(x.id) ? but(x, { end: Math.min(x.end, now) }) : x),
      this.speeches.filter((x) => !idents.has(x.id) || x.start < now).map((x) => idents.has(x.id) ? cut(x, now) : x),
      this.modes.filter((x) => !idents.has(x.id) || x.start < now),
      this.places.filter((x) => !idents.has(x.id) || x.start < now),
      this.blinks.filter((x) => !idents.has(x.id) || x.start < now),
      this.stays.filter((x) => !idents.has(x.id) || x.start < now).map((x) =>
        idents.has(x.id) ? but(x, { end: Math.min(x.end, now) }) : x),
      this.moods.filter((x) => !idents.has(x.id) || x.start < now).map((x) =>
        idents.has(x.id) ? but(x, { end: Math.min(x.end, now) }) : x),
    );
  }

  /** Return the track with the items of another one, whose speeches may overlap. */
  joined(more) {
    if (more.idents().length === 0) {
      return this;
    }
    const looks = [...this.looks];
    for (const look of more.looks) {
      insort(looks, look, 0, (x) => [x.start, x.id]);
    }
    const speeches = [...this.speeches];
    for (const speech of more.speeches) {
      insort(speeches, speech, 0, (x) => [x.start, x.id]);
    }
    const modes = [...this.modes];
    for (const mode of more.modes) {
      insort(modes, mode, 0, (x) => [x.start, x.id]);
    }
    const places = [...this.places];
    for (const place of more.places) {
      insort(places, place, 0, (x) => [x.start, x.id]);
    }
    const blinks = [...this.blinks];
    for (const blink of more.blinks) {
      insort(blinks, blink, 0, (x) => [x.start, x.id]);
    }
    const stays = [...this.stays];
    for (const stay of more.stays) {
      insort(stays, stay, 0, (x) => [x.start, x.id]);
    }
    const moods = [...this.moods];
    for (const mood of more.moods) {
      insort(moods, mood, 0, (x) => [x.start, x.id]);
    }
    const said = more.speeches.length > 0 ? apart(speeches) : speeches;
    return new Track([...looks], [...said], [...modes], [...places], [...blinks], [...stays], [...moods]);
  }

  /** Return the track without items that are not needed from `seconds` on. */
  since(seconds) {
    // Those that no later one has replaced; also what is over: it tells since when what shows has shown.
    let looks = [];
    for (const look of this.looks) {
      if (look.start <= seconds) {
        looks = looks.filter((x) => x.priority > look.priority);
      }
      looks.push(look);
    }
    const latest = new Map(this.speeches.map((x) => [x.id, x]));
    const lasts = new Set([...latest].filter(({ 0: ident, 1: x }) => x.more || x.end > seconds).map(({ 0: ident, 1: x }) =>
      ident));
    const mode = Math.max(0, bisectRight(this.modes.map((m) => m.start), seconds) - 1);
    const places = new Map([...this.places.entries()].filter(({ 0: n, 1: x }) => x.start <= seconds).map(({ 0: n, 1: x }) =>
      [x.name, n]));
    const stays = new Map([...this.stays.entries()].filter(({ 0: n, 1: x }) => x.start <= seconds).map(({ 0: n, 1: x }) =>
      [x.layer, n]));
    return new Track(
      [...looks],
      this.speeches.filter((x) =>
        x.start > seconds || x.end > seconds || (x.more && lasts.has(x.id)) || (x.over !== null && x.over > seconds)),
      this.modes.slice(mode),
      [...this.places.entries()].filter(({ 0: n, 1: x }) => x.start > seconds || places.get(x.name) === n).map(({ 0: n, 1: x }) =>
        x),
      this.blinks.filter((x) => x.start > seconds),
      [...this.stays.entries()].filter(({ 0: n, 1: x }) => x.start > seconds || stays.get(x.layer) === n).map(({ 0: n, 1: x }) =>
        x),
      [...lasting(this.moods, seconds)],
    );
  }

  /** Return the last speech with an id. */
  lastSpeech(ident) {
    return [...this.speeches].reverse().find((s) => s.id === ident) ?? null;
  }

  /** Return whether everything is the same that random draws depend on. Places and stays are not part of it. */
  drawsLike(other) {
    if (!alikeLooks(this.looks, other.looks) || !alikeSpeeches(this.speeches, other.speeches)) {
      return false;
    }
    if (!alikeFelt(this.moods, other.moods)) {
      return false;
    }
    return alikeModes(this.modes, other.modes) && alikeBlinks(this.blinks, other.blinks);
  }

  /** Return whether everything is the same. */
  like(other) {
    if (!alikePlaces(this.places, other.places) || !alikeStays(this.stays, other.stays)) {
      return false;
    }
    return this.drawsLike(other);
  }
}
