/**
 * The events of the life layers: drawn from the seed one by one, and then a function of time.
 *
 * Each event depends only on the previous one and on the requests meanwhile; its random draw depends on its number. So a
 * schedule grows as a plan does: events that have begun stay, many short extensions give the same as one long one, and past
 * events can be forgotten.
 *
 * Translated from metagraph/playback/life/schedule.py; change that, and translate anew.
 */

import { getManner, isSameLife } from "./life.js";
import { MODES } from "./words.js";
import { emphasesOn, swellsOn } from "./expressions.js";
import { findLineStart } from "./items.js";
import { Lane } from "./lane.js";
import { areSameVoices, stressed } from "./voice.js";
import { modesBetween, moodsBetween, moodsOf, targetsBetween, waysIn } from "./wanted.js";
import { chanceOf, keyed, logNormal, uniform } from "./choice.js";
import { Mood } from "./mood.js";
import { bisectLeft, bisectRight, but, minOf, sorted, zip } from "./basics.js";

export const BLOCK = 8; // seconds drawn at a time, so that a running plan need not draw at every tick
export const RECALL = 4; // seconds of looks kept when the past is forgotten: longer than any turn of the head takes
// Blinks: on stressed syllables at least so many seconds after the last (Yang et al., section 7.3); of
// themselves after gaps that spread as people's do, log-normal, a few of them doubles.
export const AFTER_BLINK = 1;
export const BLINK_SPREAD = 0.7; // standard deviation of the gaps, times their mean
export const DOUBLES = 0.06; // share of blinks that follow the one before at once
export const DOUBLE = 0.4; // seconds after which they do
export const HALVES = 0.12; // share of blinks by themselves that are incomplete
export const HALF = 0.6; // how far these shut the eyes
// Saccades: fixations last 0.2 s and more; sizes fall off as in "Eyes Alive", small ones only: the eyes stay
// with what they look at.
export const FIXATION = 0.2;
export const SACCADE = 1.2; // degrees on average
export const LARGEST_SACCADE = 4; // degrees
export const UPRIGHT = 0.6; // how much of an offset goes up and down
// Aversions: at somewhat regular intervals, in a random direction, more often to the sides.
export const AVERSION_GAP = 0.6;
export const AVERSION_CHANCE = 0.8;
export const BETWEEN_AVERSIONS = 0.6; // seconds at least
export const SHORTEST_AVERSION = 0.25;
export const BREATH = 0.85; // of the mean length and depth: the least
export const BREATH_CHANCE = 0.3; // and what chance adds
// A character breathes in before it speaks: a breath begins so long before the first word, and the one before
// it is shortened or drawn out by so much of its length at most. Ours.
export const BREATHES_IN = 0.55; // seconds
export const STRETCH = 0.5;

/**
 * Everything that the life layers do by themselves from 0 to `end` seconds, in lanes. The columns of a lane's rows are
 * listed here.
 *
 * modes: index in MODES. moods: valence, arousal, intensity. targets: what the gaze looks at. breaths: length s, depth.
 * aversions: end s, right-to-left and upward part of the offset (of life's angle). saccades: offset to the left and up,
 * degrees. blinks: 0 spontaneous, 1 on a stressed syllable, 2 requested, 3 spontaneous and incomplete. swells, emphases: of
 * the face (`expressions`). drawn: seconds up to which the lanes are filled; the rest is what they were drawn from.
 *
 * end: number; drawn: number; modes: Lane; moods: Lane; targets: GazeTarget[]; breaths: Lane; aversions: Lane; saccades:
 * Lane; blinks: Lane; swells: Lane; emphases: Lane; life: ?Life; track: ?Track; voices: ?Voices; seed: number.
 */
export class Schedule {
  constructor(
    end = 0,
    drawn = 0,
    modes = new Lane([], [], 0, 1),
    moods = new Lane([], [], 0, 3),
    targets = [],
    breaths = new Lane([], [], 0, 2),
    aversions = new Lane([], [], 0, 3),
    saccades = new Lane([], [], 0, 2),
    blinks = new Lane([], [], 0, 1),
    swells = new Lane([], [], 0, 3),
    emphases = new Lane([], [], 0, 3),
    life = null,
    track = null,
    voices = null,
    seed = 0,
  ) {
    this.end = end;
    this.drawn = drawn;
    this.modes = modes;
    this.moods = moods;
    this.targets = targets;
    this.breaths = breaths;
    this.aversions = aversions;
    this.saccades = saccades;
    this.blinks = blinks;
    this.swells = swells;
    this.emphases = emphases;
    this.life = life;
    this.track = track;
    this.voices = voices;
    this.seed = seed;
  }

  /** Return the schedule without events that ended before `seconds`; later draws do not change. */
  since(seconds) {
    const breaths = this.breaths.since(seconds);
    const aversions = this.aversions.since(seconds);
    const saccades = this.saccades.since(seconds);
    const blinks = this.blinks.since(seconds);
    let rates = [1, 1, 1, 1];
    if (this.life !== null) {
      rates = [this.life.breathRate, this.life.aversionRate, this.life.saccadeRate, this.life.blinks];
    }
    // Gaps run in modes' time from the event before, so the modes since then are needed.
    const lanes = [breaths, aversions, saccades, blinks];
    const firsts = lanes.filter((kept) => kept.times.length > 0).map((kept) => kept.times[0]);
    let needed = firsts.length > 0 ? minOf(firsts) : seconds;
    if (zip(lanes, rates).some(({ 0: kept, 1: rate }) => kept.times.length === 0 && rate > 0)) {
      needed = 0;
    }
    const looked = bisectRight(this.targets.map((t) => t.start), Math.min(needed, seconds - RECALL)) - 1;
    return but(this, { modes: this.modes.since(needed, 0), moods: this.moods.since(
      Math.min(needed, seconds - RECALL),
      0,
    ), targets: this.targets.slice(Math.max(0, looked)), breaths: breaths, aversions: aversions, saccades: saccades, blinks: blinks, swells: this.swells.since(
      seconds,
    ), emphases: this.emphases.since(seconds, 3) });
  }
}

/**
 * Return the schedule to `end` seconds. Events of `before` that begin before `now` stay exactly as they were.
 *
 * Its later events stay, too, if nothing that they were drawn from has changed.
 * @param {Life} life
 * @param {Track} track
 * @param {Voices} voices
 * @param {number} seed
 * @param {number} end
 * @param {Schedule} before
 * @param {number} now
 * @returns {Schedule}
 */
export function schedule(life, track, voices, seed, end, before, now) {
  if (!life.on) {
    return but(before, { end: end, life: life, track: track, voices: voices, seed: seed });
  }
  const drawn = Math.max(BLOCK, Math.ceil(end / BLOCK) * BLOCK);
  const change = _change(before, life, track, voices, seed);
  if (change === "" && drawn === before.drawn) {
    return but(before, { end: end });
  }
  const cut = Math.max(0, Math.min(before.drawn, change === "" ? drawn : now));
  const chance = change === "places" ? Math.min(before.drawn, drawn) : cut;
  const draw = _draw(life, track, voices, seed, cut, drawn, before);
  let breaths = before.breaths.until(chance);
  let aversions = before.aversions.until(chance);
  let saccades = before.saccades.until(chance);
  let blinks = before.blinks.until(chance);
  let swells = before.swells.until(chance);
  let emphases = before.emphases.until(chance);
  if (chance < drawn) {
    draw.begin(chance);
    breaths = draw.breaths(breaths);
    aversions = draw.aversions(aversions);
    saccades = draw.saccades(saccades);
    blinks = draw.blinks(blinks);
    swells = swellsOn(track, seed, chance, drawn, swells);
    emphases = emphasesOn(life, track, voices, seed, chance, drawn, emphases);
  }
  return new Schedule(
    end,
    drawn,
    draw.modes,
    draw.moods,
    draw.targets,
    breaths,
    aversions,
    saccades,
    blinks,
    swells,
    emphases,
    life,
    track,
    voices,
    seed,
  );
}

/**
 * Return "" if nothing that a schedule was drawn from has changed, "places" if only places have, else "all".
 * @param {Schedule} before
 * @param {Life} life
 * @param {Track} track
 * @param {Voices} voices
 * @param {number} seed
 * @returns {string}
 */
function _change(before, life, track, voices, seed) {
  if (before.track === null || before.seed !== seed || !isSameLife(before.life, life)) {
    return "all";
  }
  if (!areSameVoices(before.voices, voices)) {
    return "all";
  }
  if (before.track === track || before.track.like(track)) {
    return "";
  }
  return before.track.drawsLike(track) ? "places" : "all";
}

/**
 * One extension: lanes filled from `cut` to `drawn` seconds. edges: when modes, moods or strict looks change; manners: the
 * factors of the amounts from each edge on; strict: 1 if the look is strict from there on, else 0. phrases: when the
 * character begins to speak.
 *
 * life: Life; track: Track; voices: Voices; seed: number; cut: number; drawn: number; calm: number; modes: Lane; moods:
 * Lane; targets: GazeTarget[]; edges: number[]; manners: Manner[]; strict: number[]; phrases: number[].
 */
export class LifeDraw {
  constructor(
    life,
    track,
    voices,
    seed,
    cut,
    drawn,
    calm,
    modes,
    moods,
    targets,
    edges = [],
    manners = [],
    strict = [],
    phrases = [],
  ) {
    this.life = life;
    this.track = track;
    this.voices = voices;
    this.seed = seed;
    this.cut = cut;
    this.drawn = drawn;
    this.calm = calm;
    this.modes = modes;
    this.moods = moods;
    this.targets = targets;
    this.edges = edges;
    this.manners = manners;
    this.strict = strict;
    this.phrases = phrases;
  }

  /** Combine modes, moods and strict looks into one list of segments. */
  begin(cut) {
    this.cut = cut;
    const talks = this.track.modes.filter((change) => change.mode === "talking").map((change) => change.start);
    this.phrases = sorted([...this.track.speeches.map((speech) => speech.start), ...talks]);
    const edges = [...this.modes.times];
    edges.push(...this.moods.times);
    for (const { 0: n, 1: target } of this.targets.entries()) {
      if (n === 0 || target.strict !== this.targets[n - 1].strict) {
        edges.push(target.start);
      }
    }
    const begun = this.targets.map((t) => t.start);
    for (const edge of sorted(edges)) {
      if (this.edges.length > 0 && this.edges[this.edges.length - 1] === edge) {
        continue;
      }
      const mode = Math.max(0, bisectRight(this.modes.times, edge) - 1);
      const look = Math.max(0, bisectRight(begun, edge) - 1);
      this.edges.push(edge);
      const felt = this.moods.rows[Math.max(0, bisectRight(this.moods.times, edge) - 1)];
      const ways = getManner(this.life, MODES[Math.trunc(this.modes.rows[mode][0])]);
      this.manners.push(waysIn(ways, new Mood(felt[0], felt[1], felt[2])));
      this.strict.push(this.targets[look].strict ? 1 : 0);
    }
  }

  /** Return the key of an event's random numbers, for `chance_of`. */
  key(what, number) {
    return keyed(this.seed, what, String(number));
  }

  /** Return the index of the segment that contains a time. */
  placeAt(seconds) {
    return Math.max(0, bisectRight(this.edges, seconds) - 1);
  }

  /** Return whether the character is thinking at a time: then it looks up and aside, never down. */
  thinks(seconds) {
    const mode = Math.max(0, bisectRight(this.modes.times, seconds) - 1);
    return MODES[Math.trunc(this.modes.rows[mode][0])] === "thinking";
  }

  /**
   * Return when `need` seconds have passed since `seconds` on a clock that runs at these rates, one for each segment;
   * infinity if that is after the end.
   */
  after(seconds, need, rates) {
    let at = seconds;
    let left = need;
    let place = this.placeAt(at);
    while (at < this.drawn) {
      const end = place + 1 < this.edges.length ? this.edges[place + 1] : this.drawn;
      const rate = rates[place];
      if (rate > 0 && at + left / rate < end) {
        return at + left / rate;
      }
      left -= rate * Math.max(0, end - at);
      at = end;
      place += 1;
    }
    return Infinity;
  }

  /** Draw breaths, each after the previous one. The first began before time 0, so that characters do not breathe in step. */
  breaths(lane) {
    const times = [];
    const rows = [];
    let number = lane.next;
    let begun = lane.times.length > 0;
    let at = begun ? lane.times[lane.times.length - 1] + lane.rows[lane.rows.length - 1][0] : 0;
    while (true) {
      if (begun) {
        at = Math.max(at, this.cut);
      }
      const ways = this.manners[this.placeAt(at)];
      const rate = this.life.breathRate * ways.breathRate / 60;
      if (rate <= 0) { // no breath until another mode begins
        const later = bisectRight(this.edges, at);
        if (this.life.breathRate <= 0 || later === this.edges.length) {
          break;
        }
        at = this.edges[later];
        begun = true;
        continue;
      }
      const key = this.key("breath", number);
      let length = (BREATH + BREATH_CHANCE * chanceOf(key, "length")) / rate;
      length *= 1 + 2 * this.life.stillness; // slower, too, but never halting
      length = begun ? this.toPhrase(at, length) : length;
      const depth = ways.breathing * (BREATH + BREATH_CHANCE * chanceOf(key, "depth"));
      if (!begun) {
        at = -length * uniform(this.seed, "breath", "first");
        begun = true;
      }
      if (at >= this.drawn) {
        break;
      }
      times.push(at);
      rows.push([length, depth]);
      at += length;
      number += 1;
    }
    return lane.plus(times, rows);
  }

  /** Return the length of a breath that begins at `at`, so that the next one begins right before the character speaks. */
  toPhrase(at, length) {
    const place = bisectLeft(this.phrases, at + (1 - STRETCH) * length + BREATHES_IN);
    if (place === this.phrases.length) {
      return length;
    }
    const wanted = this.phrases[place] - BREATHES_IN - at;
    return wanted <= (1 + STRETCH) * length ? wanted : length;
  }

  /** Draw the small jumps of the eyes. */
  saccades(lane) {
    if (this.life.saccadeRate <= 0 || this.calm <= 0) {
      return lane;
    }
    const mean = Math.max(60 / this.life.saccadeRate, FIXATION + 0.01);
    const rates = this.manners.map((ways) => ways.saccadeRate * this.calm);
    const times = [];
    const rows = [];
    let number = lane.next;
    let last = lane.times.length > 0 ? lane.times[lane.times.length - 1] : 0;
    while (true) {
      const key = this.key("saccade", number);
      const need = FIXATION + (mean - FIXATION) * Math.min(4, -Math.log(chanceOf(key, "gap")));
      last = Math.max(this.cut, this.after(last, need, rates));
      if (!(last < this.drawn)) {
        return lane.plus(times, rows);
      }
      let size = Math.min(LARGEST_SACCADE, -SACCADE * Math.log(chanceOf(key, "size")));
      size *= this.manners[this.placeAt(last)].saccades;
      const turn = 2 * Math.PI * chanceOf(key, "way");
      times.push(last);
      rows.push([size * Math.sin(turn + Math.PI / 2), UPRIGHT * size * Math.sin(turn)]);
      number += 1;
    }
  }

  /** Draw short looks away. */
  aversions(lane) {
    const life = this.life;
    if (life.aversionRate <= 0 || life.aversionLength <= 0 || life.aversionAngle <= 0 || this.calm <= 0) {
      return lane;
    }
    const rates = [];
    for (const { 0: ways, 1: strict } of zip(this.manners, this.strict)) {
      const rate = life.aversionRate * ways.aversionRate;
      if (strict === 1 || rate <= 0) {
        rates.push(0);
      } else {
        const mean = Math.max(BETWEEN_AVERSIONS, 60 / rate - life.aversionLength * ways.aversionLength);
        rates.push(this.calm / mean);
      }
    }
    const times = [];
    const rows = [];
    let number = lane.next;
    let last = lane.rows.length > 0 ? lane.rows[lane.rows.length - 1][0] : 0;
    while (true) {
      const key = this.key("aversion", number);
      const need = AVERSION_GAP + AVERSION_CHANCE * chanceOf(key, "gap");
      const at = Math.max(this.cut, last + BETWEEN_AVERSIONS, this.after(last, need, rates));
      if (!(at < this.drawn)) {
        return lane.plus(times, rows);
      }
      const own = this.manners[this.placeAt(at)];
      let length = life.aversionLength * own.aversionLength;
      length *= 0.6 + 0.8 * chanceOf(key, "length");
      last = at + Math.max(SHORTEST_AVERSION, length);
      const size = own.aversionAngle * (0.7 + 0.6 * chanceOf(key, "size"));
      const turn = 2 * Math.PI * chanceOf(key, "way");
      const up = UPRIGHT * size * Math.sin(turn);
      times.push(at);
      rows.push([last, size * Math.sin(turn + Math.PI / 2), this.thinks(at) ? Math.abs(up) : up]);
      number += 1;
    }
  }

  /** Draw blinks: spontaneous ones, those on stressed syllables and requested ones, in the order in which they come. */
  blinks(lane) {
    const life = this.life;
    const shut = life.blinkClose + life.blinkOpen;
    const mean = (life.blinks > 0 && this.calm > 0) ? 60 / life.blinks : Infinity;
    const rates = this.manners.map((ways) => ways.blinks * this.calm);
    let last = -0.5 * Math.min(mean, 10) * uniform(this.seed, "blink", "first");
    if (lane.times.length > 0) {
      last = lane.times[lane.times.length - 1];
    }
    let accents = [];
    if (this.calm > 0 && life.accentBlinks > 0) {
      accents = this.accents(Math.max(0, Math.min(this.cut, last)));
    }
    const asked = this.track.blinks.map((b) => b.start);
    const times = [];
    const rows = [];
    let number = lane.next;
    let place = 0;
    while (true) {
      let own = Infinity;
      if (mean < Infinity) {
        const key = this.key("blink", number);
        const drawn = logNormal(mean, BLINK_SPREAD * mean, chanceOf(key, "gap"), chanceOf(key, "gap2"));
        const need = chanceOf(key, "double") < DOUBLES ? DOUBLE : Math.max(DOUBLE, drawn);
        own = Math.max(this.cut, this.after(last, need, rates));
      }
      // A stressed syllable may bring a blink: the first of a speech always, the others some time after
      // the last blink.
      while (place < accents.length) {
        const { 0: accent, 1: first } = accents[place];
        if (accent >= this.cut && accent >= last + (first ? shut + 0.1 : AFTER_BLINK / this.calm)) {
          break;
        }
        place += 1;
      }
      const heard = place < accents.length ? accents[place][0] : Infinity;
      const wish = bisectLeft(asked, Math.max(this.cut, last + shut));
      const wanted = wish < asked.length ? asked[wish] : Infinity;
      const at = Math.min(own, heard, wanted);
      if (at >= this.drawn) {
        return lane.plus(times, rows);
      }
      times.push(at);
      let kind = at === heard ? 1 : 0;
      if (at === own && at !== heard && chanceOf(this.key("blink", number), "half") < HALVES) {
        kind = 3;
      }
      rows.push([at === wanted ? 2 : kind]);
      last = at;
      number += 1;
    }
  }

  /** Return the stressed syllables from `start` to the end that may bring blinks, and whether each is a speech's first. */
  accents(start) {
    const out = [];
    for (const speech of this.track.speeches) {
      if (speech.end <= start || speech.start >= this.drawn) {
        continue;
      }
      const end = Math.min(speech.end, this.drawn);
      for (const { 0: n, 1: peak } of stressed(this.voices, speech).entries()) {
        const at = findLineStart(speech) + peak;
        if (at < Math.max(start, speech.start) || at >= end) {
          continue;
        }
        if (n === 0 || uniform(this.seed, speech.id, "accent", String(n)) < this.life.accentBlinks) {
          out.push([at, n === 0]);
        }
      }
    }
    return out;
  }
}

/**
 * Return the draw that extends a schedule from `cut` to `drawn` seconds, with modes and looks filled in.
 * @param {Life} life
 * @param {Track} track
 * @param {Voices} voices
 * @param {number} seed
 * @param {number} cut
 * @param {number} drawn
 * @param {Schedule} before
 * @returns {LifeDraw}
 */
function _draw(life, track, voices, seed, cut, drawn, before) {
  const modes = before.modes.until(cut);
  const last = modes.rows.length > 0 ? Math.trunc(modes.rows[modes.rows.length - 1][0]) : -1;
  const times = [];
  const rows = [];
  for (const { 0: at, 1: mode } of modesBetween(track, cut, drawn)) {
    if (times.length > 0 || mode !== last) {
      times.push(at);
      rows.push([mode]);
    }
  }
  const moods = before.moods.until(cut);
  let felt = [];
  if (moods.rows.length > 0) {
    felt = [...moods.rows[moods.rows.length - 1]];
  }
  const changes = [];
  const wanted = [];
  for (const { 0: at, 1: mood } of moodsBetween(moodsOf(life, track), cut, drawn)) {
    const same = felt.length > 0 && felt[0] === mood.valence && felt[1] === mood.arousal && felt[2] === mood.intensity;
    if (changes.length > 0 || !same) {
      changes.push(at);
      wanted.push([mood.valence, mood.arousal, mood.intensity]);
    }
  }
  const begun = bisectLeft(before.targets.map((t) => t.start), cut);
  const targets = before.targets.slice(0, begun);
  for (const target of targetsBetween(track, cut, drawn)) {
    if (targets.length === 0 || !target.like(targets[targets.length - 1])) {
      targets.push(target);
    }
  }
  return new LifeDraw(
    life,
    track,
    voices,
    seed,
    cut,
    drawn,
    1 - life.stillness,
    modes.plus(times, rows),
    moods.plus(changes, wanted),
    [...targets],
  );
}
