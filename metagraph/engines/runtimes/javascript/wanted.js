/**
 * Requests of the life layers as segments in time: the mode of the character, and what it looks at.
 *
 * Translated from metagraph/playback/life/wanted.py; change that, and translate anew.
 */

import { scaled } from "./life.js";
import { MODES } from "./words.js";
import { isSameSpot, named, placed } from "./spots.js";
import { Mood, Moods, lifeOf, moodAt, moodEdges } from "./mood.js";
import { sorted, sortedBy } from "./basics.js";

export const PARTNER = "user"; // whom the character talks with, and looks at when nothing else is asked for
export const AHEAD = "ahead"; // nothing in particular: eyes and head as the layers have them
// What changes what is looked at; of one time in this order.
export const OVER = 0;
export const LOOK = 1;
export const PLACE = 2;
export const BEGIN = 3;

/**
 * The target of the gaze from `start` on: a point, or a name whose place the project knows. since: when the look at it
 * began; its place may have changed meanwhile. asked: whether a request set it.
 *
 * start: number; to: Spot; since: number; amount: number; strict: boolean; asked: boolean.
 */
export class GazeTarget {
  constructor(start, to, since = 0, amount = 1, strict = false, asked = false) {
    this.start = start;
    this.to = to;
    this.since = since;
    this.amount = amount;
    this.strict = strict;
    this.asked = asked;
  }

  /** Return whether it is the same apart from its times. */
  like(other) {
    if (this.amount !== other.amount || this.strict !== other.strict || this.asked !== other.asked) {
      return false;
    }
    return isSameSpot(this.to, other.to);
  }
}

/**
 * Return the requested mode; without one, talking while something is said and idle otherwise.
 * @param {Track} track
 * @param {number} seconds
 * @returns {string}
 */
export function modeAt(track, seconds) {
  const told = track.toldMode(seconds);
  return told === null ? "idle" : told;
}

/**
 * Return (start, place among MODES) of each mode from `start` to before `end`; the first begins at `start`.
 * @param {Track} track
 * @param {number} start
 * @param {number} end
 * @returns {[number, number][]}
 */
export function modesBetween(track, start, end) {
  const edges = [start];
  edges.push(...track.modes.map((m) => m.start));
  edges.push(...track.speeches.map((s) => s.start));
  edges.push(...track.speeches.map((s) => s.end));
  const out = [];
  let last = -1;
  for (const edge of sorted(edges.filter((e) => start <= e && e < end))) {
    const mode = MODES.indexOf(modeAt(track, edge));
    if (mode !== last) {
      out.push([edge, mode]);
    }
    last = mode;
  }
  return out;
}

/**
 * Return the moods of a character: the one set in its life layers, and those requested over time.
 * @param {Life} life
 * @param {Track} track
 * @returns {Moods}
 */
export function moodsOf(life, track) {
  return new Moods(new Mood(life.valence, life.arousal, life.intensity), track.moods);
}

/**
 * Return (start, mood) of each mood from `start` to before `end`; the first begins at `start`.
 * @param {Moods} moods
 * @param {number} start
 * @param {number} end
 * @returns {[number, Mood][]}
 */
export function moodsBetween(moods, start, end) {
  const out = [];
  for (const edge of moodEdges(moods, start, end)) {
    const mood = moodAt(moods, edge);
    if (out.length === 0 || !mood.like(out[out.length - 1][1])) {
      out.push([edge, mood]);
    }
  }
  return out;
}

/**
 * Return the factors of the amounts for a mode and a mood.
 * @param {Manner} ways
 * @param {Mood} mood
 * @returns {Manner}
 */
export function waysIn(ways, mood) {
  if (mood.neutral) {
    return ways;
  }
  const of = lifeOf(mood);
  return scaled(ways, of.breathing, of.breathRate, of.aversionRate, of.saccadeRate, of.blinks);
}

/**
 * Return the targets of the gaze from `start` to before `end`; the first begins at `start`.
 *
 * The latest look holds until it ends or another of at least the same importance begins; a less important one waits.
 * @param {Track} track
 * @param {number} start
 * @param {number} end
 * @returns {GazeTarget[]}
 */
export function targetsBetween(track, start, end) {
  let changes = track.looks.map((x, n) => [x.start, LOOK, n]);
  changes.push(...track.looks.map((x, n) => [x.end, OVER, n]));
  changes.push(...[...track.places.entries()].filter(({ 0: n, 1: p }) => p.start >= start).map(({ 0: n, 1: p }) =>
    [p.start, PLACE, n]));
  changes.push([start, BEGIN, 0]);
  changes = sortedBy(changes, (c) => [c[0], c[1]]);
  let looks = []; // indices of looks, the most important first; the others are older or less important
  const places = new Map();
  for (const place of track.places) { // a point that is sent again and again has thousands
    if (place.start < start) {
      places.set(place.name, place.point);
    }
  }
  let chosen = -1;
  let since = 0;
  const out = [];
  for (let n = 0; n < changes.length; n++) {
    const { 0: at, 1: kind, 2: which } = changes[n];
    if (at >= end) {
      break;
    }
    if (kind === LOOK) {
      const look = track.looks[which];
      looks = looks.filter((x) => track.looks[x].priority > look.priority);
      if (look.end > look.start) {
        looks.push(which);
      }
    } else if (kind === OVER) {
      looks = looks.filter((x) => x !== which);
    } else if (kind === PLACE) {
      places.set(track.places[which].name, track.places[which].point);
    }
    const first = looks.length > 0 ? looks[0] : -1;
    if (chosen !== first) {
      chosen = first;
      since = at;
    }
    if (at < start || (n + 1 < changes.length && changes[n + 1][0] === at)) {
      continue;
    }
    const target = _target(at, since, chosen < 0 ? null : track.looks[chosen], places);
    if (out.length === 0 || !target.like(out[out.length - 1])) {
      out.push(target);
    }
  }
  return out;
}

/**
 * @param {number} at
 * @param {number} since
 * @param {?LookAt} look
 * @param {Map<string, number[]>} places
 * @returns {GazeTarget}
 */
function _target(at, since, look, places) {
  if (look === null) {
    return new GazeTarget(at, placed(places, named(PARTNER)), since);
  }
  return new GazeTarget(at, placed(places, look.to), since, look.amount, look.strict, true);
}
