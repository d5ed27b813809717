/**
 * When the life layers do what: drawn from the seed, event by event, then pure in time.
 *
 * Each event depends only on the one before it and on what is asked meanwhile, and its chance on its number. So a schedule grows
 * as a plan does: what has begun stays, tick by tick gives what one call gives, and what lies behind can be forgotten.
 */

import { begunBy, bisect } from "../basics.js";
import { uniform } from "../choice.js";
import { MODES } from "../words.js";
import { emptyLane, longer, nextOf, sinceLane, until } from "./lane.js";
import { alike } from "./track.js";
import { alikeTargets, modesBetween, targetsBetween } from "./wanted.js";

const BLOCK = 8; // seconds drawn at a time, so that a running plan need not draw at every tick
const RECALL = 4; // seconds of looks kept when the past is forgotten: longer than any turn of the head takes
const AFTER_BLINK = 1; // seconds a stressed syllable's blink comes after the last, at least
const BLINK_GAPS = [0.57, 0.845]; // of the mean gap: the shortest, and what chance adds to it
const FIXATION = 0.2; // seconds the eyes rest at least
const [SACCADE, LARGEST_SACCADE, UPRIGHT] = [1.2, 4, 0.6]; // degrees on average, at most; of that, up and down
const AVERSION_GAPS = [0.6, 0.8];
const BETWEEN_AVERSIONS = 0.6; // seconds at least
const SHORTEST_AVERSION = 0.25;
const BREATHS = [0.85, 0.3]; // of the mean length and depth: the least, and what chance adds
const RANDOM = { breaths: "breath_rate", aversions: "aversion_rate", saccades: "saccade_rate", blinks: "blinks" };

/**
 * Everything that happens of itself from 0 to `end` seconds, in lanes; a lane's values stand in the order given here.
 *
 * modes: place among MODES. targets: what is looked at. breaths: length s, depth. aversions: end s, right-to-left and upward part of
 * the offset (of life's angle). saccades: offset to the left and up, degrees. blinks: 0 of itself, 1 on a stressed syllable, 2
 * asked for. drawn: seconds up to which the lanes are filled; `life` and `track`: what they were drawn from.
 */
export const emptySchedule = () => ({
  end: 0, drawn: 0, modes: emptyLane(), targets: [], breaths: emptyLane(), aversions: emptyLane(), saccades: emptyLane(),
  blinks: emptyLane(), life: null, track: null,
});

/** Return the schedule without what ended before `seconds`; what is drawn on from it stays as it would have been. */
export function sinceSchedule(schedule, seconds) {
  const names = Object.keys(RANDOM);
  const lanes = Object.fromEntries(names.map((name) => [name, sinceLane(schedule[name], seconds)]));
  // Gaps run in modes' time from the event before, so the modes since then are needed.
  const idle = names.some((name) => !lanes[name].starts.length && (!schedule.life || schedule.life[RANDOM[name]] > 0));
  const firsts = names.filter((name) => lanes[name].starts.length).map((name) => lanes[name].starts[0]);
  const needed = idle ? 0 : Math.min(...(firsts.length ? firsts : [seconds]));
  const targets = schedule.targets.slice(Math.max(0, begunBy(schedule.targets, Math.min(needed, seconds - RECALL)) - 1));
  return { ...schedule, ...lanes, modes: sinceLane(schedule.modes, needed, 0), targets };
}

/**
 * Return the schedule to `end` seconds. What `before` holds that begins before `now` stays exactly as it was; what it holds for later
 * is kept, too, where nothing it was drawn from has changed.
 */
export function schedule(graph, track, seed, end, before, now) {
  const { life } = graph;
  if (!life.on) return { ...before, end, life, track };
  const drawn = Math.max(BLOCK, Math.ceil(end / BLOCK) * BLOCK);
  const same = before.life !== null && alike(before.track, track);
  if (same && drawn === before.drawn) return { ...before, end };
  const onlyPlaces = !same && before.life !== null && alike(before.track, track, ["looks", "speeches", "modes", "blinks"]);
  const cut = Math.max(0, Math.min(before.drawn, same ? drawn : now));
  const chance = onlyPlaces ? Math.min(before.drawn, drawn) : cut;
  const draw = new Draw(graph, track, seed, cut, drawn, before);
  const lanes = Object.fromEntries(Object.keys(RANDOM).map((name) => [name, until(before[name], chance)]));
  if (chance < drawn) {
    draw.begin(chance);
    for (const name of Object.keys(RANDOM)) lanes[name] = draw[name](lanes[name]);
  }
  return { end, drawn, modes: draw.modes, targets: draw.targets, ...lanes, life, track };
}

/** One extension: lanes filled from `cut` to `drawn`. */
class Draw {
  constructor(graph, track, seed, cut, drawn, before) {
    Object.assign(this, { graph, life: graph.life, track, seed, cut, drawn, calm: 1 - graph.life.stillness });
    const modes = until(before.modes, cut);
    const last = modes.values.length ? modes.values[modes.values.length - 1][0] : -1;
    const fresh = modesBetween(track, cut, drawn).filter(([, mode], n) => n > 0 || mode !== last);
    this.modes = longer(modes, fresh.map(([at]) => at), fresh.map(([, mode]) => [mode]));
    this.targets = before.targets.slice(0, begunBy(before.targets, cut, false));
    for (const target of targetsBetween(track, cut, drawn)) {
      const { length } = this.targets;
      if (!length || !alikeTargets(target, this.targets[length - 1])) this.targets.push(target);
    }
  }

  /** Lay modes and strict looks out in one row of segments. */
  begin(cut) {
    this.cut = cut;
    const { starts, values } = this.modes;
    const turns = this.targets.filter((t, n) => n === 0 || t.strict !== this.targets[n - 1].strict);
    this.edges = [...new Set([...starts, ...turns.map((t) => t.start)])].sort((a, b) => a - b);
    this.manners = this.edges.map((edge) => this.life.manners[MODES[values[Math.max(0, bisect(starts, edge, true) - 1)][0]]]);
    this.strict = this.edges.map((edge) => this.targets[Math.max(0, begunBy(this.targets, edge) - 1)].strict);
  }

  chance(...words) {
    return uniform(this.seed, ...words);
  }

  placeAt(seconds) {
    return Math.max(0, bisect(this.edges, seconds, true) - 1);
  }

  manner(seconds) {
    return this.manners[this.placeAt(seconds)];
  }

  /** Return when `need` has passed since `seconds`, for a clock that runs at `speed(manner, strict)`; Infinity where not before the end. */
  after(seconds, need, speed) {
    for (let place = this.placeAt(seconds); seconds < this.drawn; place++) {
      const end = place + 1 < this.edges.length ? this.edges[place + 1] : this.drawn;
      const rate = speed(this.manners[place], this.strict[place]);
      if (rate > 0 && seconds + need / rate < end) return seconds + need / rate;
      need -= rate * Math.max(0, end - seconds);
      seconds = end;
    }
    return Infinity;
  }

  /** Each breath follows the one before; the first began before time 0, so that not everybody breathes alike. */
  breaths(lane) {
    const { life } = this;
    const [starts, values] = [[], []];
    const last = lane.starts.length - 1;
    let at = last < 0 ? null : lane.starts[last] + lane.values[last][0];
    for (let n = nextOf(lane); ; ) {
      if (at !== null) at = Math.max(at, this.cut);
      const ways = this.manner(at ?? 0);
      const rate = (life.breath_rate * ways.breath_rate) / 60;
      if (rate <= 0) {
        // no breath until another mode begins
        const later = bisect(this.edges, at ?? 0, true);
        if (life.breath_rate <= 0 || later === this.edges.length) break;
        at = this.edges[later];
        continue;
      }
      let length = (BREATHS[0] + BREATHS[1] * this.chance("breath", String(n), "length")) / rate;
      length *= 1 + 2 * life.stillness; // slower, too, but never halting
      const depth = ways.breathing * (BREATHS[0] + BREATHS[1] * this.chance("breath", String(n), "depth"));
      at ??= -length * this.chance("breath", "first");
      if (at >= this.drawn) break;
      starts.push(at);
      values.push([length, depth]);
      at += length;
      n += 1;
    }
    return longer(lane, starts, values);
  }

  saccades(lane) {
    const { life, calm } = this;
    if (life.saccade_rate <= 0 || calm <= 0) return lane;
    const mean = Math.max(60 / life.saccade_rate, FIXATION + 0.01);
    return this.oneByOne(lane, lane.starts[lane.starts.length - 1] ?? 0, (n, last) => {
      const need = FIXATION + (mean - FIXATION) * Math.min(4, -Math.log(this.chance("saccade", n, "gap")));
      const at = Math.max(this.cut, this.after(last, need, (ways) => ways.saccade_rate * calm));
      let size = Math.min(LARGEST_SACCADE, -SACCADE * Math.log(this.chance("saccade", n, "size")));
      size *= at < Infinity ? this.manner(at).saccades : 0;
      return { at, value: this.way("saccade", n, size), next: at };
    });
  }

  aversions(lane) {
    const { life, calm } = this;
    if (life.aversion_rate <= 0 || life.aversion_length <= 0 || life.aversion_angle <= 0 || calm <= 0) return lane;
    const speed = (ways, strict) => {
      const rate = life.aversion_rate * ways.aversion_rate;
      if (strict || rate <= 0) return 0;
      return calm / Math.max(BETWEEN_AVERSIONS, 60 / rate - life.aversion_length * ways.aversion_length);
    };
    return this.oneByOne(lane, lane.values[lane.values.length - 1]?.[0] ?? 0, (n, last) => {
      const need = AVERSION_GAPS[0] + AVERSION_GAPS[1] * this.chance("aversion", n, "gap");
      const at = Math.max(this.cut, last + BETWEEN_AVERSIONS, this.after(last, need, speed));
      const ways = at < Infinity ? this.manner(at) : life.manners.idle;
      const length = life.aversion_length * ways.aversion_length * (0.6 + 0.8 * this.chance("aversion", n, "length"));
      const end = at + Math.max(SHORTEST_AVERSION, length);
      const size = ways.aversion_angle * (0.7 + 0.6 * this.chance("aversion", n, "size"));
      return { at, value: [end, ...this.way("aversion", n, size)], next: end };
    });
  }

  /** Return an offset of a size in a random direction, more often to the sides: to the left and up. */
  way(what, n, size) {
    const turn = 2 * Math.PI * this.chance(what, n, "way");
    return [size * Math.sin(turn + Math.PI / 2), UPRIGHT * size * Math.sin(turn)];
  }

  blinks(lane) {
    const { life, calm, cut, drawn } = this;
    const shut = life.blink_close + life.blink_open;
    const mean = life.blinks > 0 && calm > 0 ? 60 / life.blinks : Infinity;
    let last = lane.starts[lane.starts.length - 1] ?? -0.5 * Math.min(mean, 10) * this.chance("blink", "first");
    const accents = calm > 0 && life.accent_blinks > 0 ? this.accents(Math.max(0, Math.min(cut, last))) : [];
    // A stressed syllable may bring a blink: the first of a speech always, the others some time after the last blink.
    const suits = ({ at, first }) => at >= cut && at >= last + (first ? shut + 0.1 : AFTER_BLINK / calm);
    const asked = this.track.blinks.map((blink) => blink.start);
    const [starts, values] = [[], []];
    let place = 0;
    for (let n = nextOf(lane); ; n++) {
      const need = mean * (BLINK_GAPS[0] + BLINK_GAPS[1] * this.chance("blink", String(n), "gap"));
      const own = need < Infinity ? Math.max(cut, this.after(last, need, (ways) => ways.blinks * calm)) : Infinity;
      while (place < accents.length && !suits(accents[place])) place += 1;
      const stressed = accents[place]?.at ?? Infinity;
      const wanted = asked[bisect(asked, Math.max(cut, last + shut), false)] ?? Infinity;
      const at = Math.min(own, stressed, wanted);
      if (at >= drawn) return longer(lane, starts, values);
      starts.push(at);
      values.push([at === wanted ? 2 : at === stressed ? 1 : 0]);
      last = at;
    }
  }

  /** Return the stressed syllables from `start` to the end that may bring blinks, and whether each is a speech's first. */
  accents(start) {
    const out = [];
    for (const speech of this.track.speeches) {
      if (speech.end <= start || speech.start >= this.drawn) continue;
      this.graph.voiceOf(speech).accents.forEach((peak, n) => {
        const at = speech.start + peak;
        const inside = start <= at && at < Math.min(speech.end, this.drawn);
        if (inside && this.chance(speech.id, "accent", String(n)) < this.life.accent_blinks) out.push({ at, first: n === 0 });
      });
    }
    return out;
  }

  /** Draw events until the end: `draw(number, last)` gives start, value and where the next gap begins. */
  oneByOne(lane, last, draw) {
    const [starts, values] = [[], []];
    for (let n = nextOf(lane); ; n++) {
      const { at, value, next } = draw(String(n), last);
      if (!(at < this.drawn)) return longer(lane, starts, values);
      starts.push(at);
      values.push(value);
      last = next;
    }
  }
}
