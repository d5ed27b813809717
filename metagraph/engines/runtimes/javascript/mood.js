/**
 * How a mood shows: which actions become likelier, how large and fast they are played, and what it makes of breath, blinks,
 * gaze, posture and face.
 *
 * A mood is a point in Russell's circumplex (1980): valence, how pleasant, and arousal, how excited, both -1..1; with it, an
 * intensity, 0..2; 1 is normal. Neutral (0, 0, 1) changes nothing, to the last digit: every factor is 1 and every offset is
 * 0.
 *
 * What is known and followed here: arousal goes with the speed, acceleration and jerk of movements (Pollick et al. 2001, of
 * arms that knock and drink); elated joy and hot anger are expansive and full of movement, sadness and boredom neither
 * (Wallbott 1998); the sad walk slowly, with small movements and bowed heads (Roether et al. 2009). Anger and fear lie close
 * together here, at 99 and 116 degrees; people tell them apart by power (Fontaine et al. 2007). So here, mild unpleasant
 * excitement is anger and strong unpleasant excitement is fear: the body draws back (Coulson 2004), with the shoulders up
 * and the arms close. Faces follow the prototypes of FACS (Ekman and Friesen 1978): fear 1+2+4+5+20, anger 4+5+7+23, joy
 * 6+12, sadness 1+4+15. The amounts (the numbers below) are ours, chosen so that every clip still looks natural.
 *
 * Translated from metagraph/playback/planning/mood.py; change that, and translate anew.
 */

import { uniform } from "./choice.js";
import { sorted } from "./basics.js";

export const FADE = 1.5; // seconds in which posture and face go from one mood to the next
export const LEAST_EXTENT = 0.6;
export const MOST_EXTENT = 1.25;
export const LEAST_TEMPO = 0.75;
export const MOST_TEMPO = 1.25;
export const CLOSE = 0.5; // an action that is tagged with a mood no farther away than this was made for it
export const PLEASANT = "positive"; // tags
export const UNPLEASANT = "negative";
export const ANGRY_FROM = 0.02; // unpleasantness from which an excited mood is angry
export const ANGRY_WIDE = 0.1; // and by how much more it is altogether
export const FEAR_FROM = 0.15; // the same of fear
export const FEAR_WIDE = 0.18;
export const HELD = "contact"; // tag of actions that touch something: smaller or larger they would miss it
// Named moods: valence, arousal. Directions are Russell's (1980, table of 28 words, by circular scaling): calm
// 316.2, content 323, happy 7.8, excited 48.6, tense 92.8, angry 99, afraid 116, sad 207.5, bored 242 and
// tired 267.7 degrees, at 0.8 from the middle, which is ours. "warm" is ours.
export const MOODS = new Map([
  ["neutral", [0, 0]],
  ["calm", [0.58, -0.55]],
  ["content", [0.64, -0.48]],
  ["warm", [0.6, 0.1]],
  ["happy", [0.79, 0.11]],
  ["excited", [0.53, 0.6]],
  ["tense", [-0.04, 0.8]],
  ["angry", [-0.13, 0.79]],
  ["afraid", [-0.35, 0.72]],
  ["sad", [-0.71, -0.37]],
  ["bored", [-0.38, -0.71]],
  ["tired", [-0.03, -0.8]],
]);

/**
 * valence, arousal: -1..1. intensity: 0..2, 1 is normal.
 *
 * valence: number; arousal: number; intensity: number.
 */
export class Mood {
  constructor(valence = 0, arousal = 0, intensity = 1) {
    this.valence = valence;
    this.arousal = arousal;
    this.intensity = intensity;
  }

  /** Whether it changes nothing. */
  get neutral() {
    return this.valence === 0 && this.arousal === 0 && this.intensity === 1;
  }

  /** Whether it is the same. */
  like(other) {
    return this.valence === other.valence && this.arousal === other.arousal && this.intensity === other.intensity;
  }
}

/**
 * A mood that holds from `start` until `end`; a field that it leaves out stays as it is without it. If two hold at once, the
 * one that began later counts. When it is over, the other counts again.
 *
 * id: string; start: number; valence: ?number; arousal: ?number; intensity: ?number; end: number.
 */
export class MoodFrom {
  constructor(id, start, valence = null, arousal = null, intensity = null, end = Infinity) {
    this.id = id;
    this.start = start;
    this.valence = valence;
    this.arousal = arousal;
    this.intensity = intensity;
    this.end = end;
  }
}

/**
 * The mood over time. base: the mood where no other holds; told: the others, by start.
 *
 * base: Mood; told: MoodFrom[].
 */
export class Moods {
  constructor(base = new Mood(), told = []) {
    this.base = base;
    this.told = told;
  }
}

/**
 * The factors by which a mood changes the amounts and rates of the life layers, as those of a manner.
 *
 * breathing: number; breathRate: number; aversionRate: number; saccadeRate: number; blinks: number.
 */
export class LifeMood {
  constructor(breathing, breathRate, aversionRate, saccadeRate, blinks) {
    this.breathing = breathing;
    this.breathRate = breathRate;
    this.aversionRate = aversionRate;
    this.saccadeRate = saccadeRate;
    this.blinks = blinks;
  }
}

/**
 * Posture and face of a mood. droop: -0.4 upright .. 1 bowed. lift: of the shoulders, in breaths. lids: how far they hang,
 * 0..1, or are open wide, below 0. smile, frown, brow_down, brow_up, brows: weights of the face, 0..1. thrust: how far the
 * body leans forward, 0..1, or draws back, below 0. tension: of shoulders, arms and hands, 0..1. closed: how close the arms
 * are kept, 0..1.
 *
 * droop: number; lift: number; lids: number; smile: number; frown: number; browDown: number; browUp: number; thrust: number;
 * tension: number; brows: number; closed: number.
 */
export class Bearing {
  constructor(
    droop = 0,
    lift = 0,
    lids = 0,
    smile = 0,
    frown = 0,
    browDown = 0,
    browUp = 0,
    thrust = 0,
    tension = 0,
    brows = 0,
    closed = 0,
  ) {
    this.droop = droop;
    this.lift = lift;
    this.lids = lids;
    this.smile = smile;
    this.frown = frown;
    this.browDown = browDown;
    this.browUp = browUp;
    this.thrust = thrust;
    this.tension = tension;
    this.brows = brows;
    this.closed = closed;
  }
}

/**
 * Return a mood with the given fields changed, each limited to its range.
 * @param {Mood} mood
 * @param {?number} valence
 * @param {?number} arousal
 * @param {?number} intensity
 * @returns {Mood}
 */
export function changed(mood, valence, arousal, intensity) {
  return new Mood(
    valence === null ? mood.valence : within(valence, -1, 1),
    arousal === null ? mood.arousal : within(arousal, -1, 1),
    intensity === null ? mood.intensity : within(intensity, 0, 2),
  );
}

/**
 * Return the mood that holds at a time; posture and face follow it slowly (`shown`).
 * @param {Moods} moods
 * @param {number} seconds
 * @returns {Mood}
 */
export function moodAt(moods, seconds) {
  let out = moods.base;
  for (const told of moods.told) {
    if (told.start > seconds) {
      break;
    }
    if (seconds < told.end) {
      out = changed(out, told.valence, told.arousal, told.intensity);
    }
  }
  return out;
}

/**
 * Return the moods that may still show at `seconds` or later: without those that are over and have faded, and without those
 * that a mood without an end has replaced.
 * @param {MoodFrom[]} told
 * @param {number} seconds
 * @returns {MoodFrom[]}
 */
export function lasting(told, seconds) {
  const out = [];
  for (const { 0: place, 1: one } of told.entries()) {
    if (one.end <= seconds - FADE) {
      continue;
    }
    if (!told.slice(place + 1).some((other) => _replaces(other, one, seconds))) {
      out.push(one);
    }
  }
  return out;
}

/**
 * @param {MoodFrom} later
 * @param {MoodFrom} one
 * @param {number} seconds
 * @returns {boolean}
 */
function _replaces(later, one, seconds) {
  return later.end === Infinity
    && later.start <= seconds - FADE
    && (one.valence === null || later.valence !== null)
    && (one.arousal === null || later.arousal !== null)
    && (one.intensity === null || later.intensity !== null);
}

/**
 * Return the times from `start` to before `end` at which the mood may change, ascending, `start` first.
 * @param {Moods} moods
 * @param {number} start
 * @param {number} end
 * @returns {number[]}
 */
export function moodEdges(moods, start, end) {
  const edges = [start];
  for (const told of moods.told) {
    for (const edge of [told.start, told.end]) {
      if (start < edge && edge < end && !edges.includes(edge)) {
        edges.push(edge);
      }
    }
  }
  return sorted(edges);
}

/**
 * Return how much of a change shows after `x` of its fade: 3x^2 - 2x^3 of x clamped to 0..1.
 * @param {number} x
 * @returns {number}
 */
export function faded(x) {
  const y = within(x, 0, 1);
  return y * y * (3 - 2 * y);
}

/**
 * Return the mood that shows at a time, while it fades from the previous ones. starts: when each begins, ascending; values:
 * valence, arousal, intensity of each. Before the first it is the first.
 * @param {number[]} starts
 * @param {number[][]} values
 * @param {number} seconds
 * @returns {Mood}
 */
export function shown(starts, values, seconds) {
  let place = starts.length - 1;
  while (place > 0 && starts[place] > seconds) {
    place -= 1;
  }
  if (place < 0) {
    return new Mood();
  }
  let valence = 0;
  let arousal = 0;
  let intensity = 0;
  let left = 1;
  while (left > 0) {
    let share = left;
    if (place > 0) {
      share = Math.min(left, faded((seconds - starts[place]) / FADE) - (1 - left));
    }
    valence += share * values[place][0];
    arousal += share * values[place][1];
    intensity += share * values[place][2];
    left -= share;
    place -= 1;
  }
  return new Mood(valence, arousal, intensity);
}

/**
 * Return a number clamped to a range.
 * @param {number} x
 * @param {number} low
 * @param {number} high
 * @returns {number}
 */
export function within(x, low, high) {
  return Math.min(Math.max(x, low), high);
}

/**
 * Return 1 at 0, `most` at 1 and 1 / `most` at -1, and beyond as there; smooth and rising.
 * @param {number} x
 * @param {number} most
 * @returns {number}
 */
export function leaning(x, most) {
  const y = within(x, -1, 1) * (most - 1) / (most + 1);
  return (1 + y) / (1 - y);
}

/**
 * Return how lively a mood is, -1..1: its arousal, plus some if it is pleasant, less if it is unpleasant and not exciting.
 * @param {Mood} mood
 * @returns {number}
 */
export function liveliness(mood) {
  const well = Math.max(0, mood.valence);
  const ill = Math.max(0, -mood.valence);
  const calm = 1 - Math.max(0, mood.arousal);
  return within(mood.arousal + 0.5 * well - 0.6 * ill * calm, -1, 1);
}

/**
 * Return how afraid a mood is, 0..1.
 * @param {Mood} mood
 * @returns {number}
 */
export function fear(mood) {
  const much = Math.min(1, 1.25 * Math.max(0, mood.arousal));
  return much * faded((-mood.valence - FEAR_FROM) / FEAR_WIDE);
}

/**
 * Return how angry a mood is, 0..1.
 * @param {Mood} mood
 * @returns {number}
 */
export function anger(mood) {
  const much = Math.min(1, 1.25 * Math.max(0, mood.arousal));
  return much * faded((-mood.valence - ANGRY_FROM) / ANGRY_WIDE) - fear(mood);
}

/**
 * Return how large gestures and fidgets of arms and head are played: a factor of their turns away from the stance.
 * @param {Mood} mood
 * @returns {number}
 */
export function extent(mood) {
  const size = within(liveliness(mood) - 1.5 * fear(mood), -1, 1);
  const byMood = size > 0 ? 1 + 0.25 * size : 1 + 0.4 * size;
  const dial = mood.intensity - 1;
  const byDial = dial > 0 ? 1 + 0.25 * dial : 1 + 0.4 * dial;
  return within(byMood * byDial, LEAST_EXTENT, MOST_EXTENT);
}

/**
 * Return how fast actions are played: a factor of their own speed.
 * @param {Mood} mood
 * @returns {number}
 */
export function tempo(mood) {
  return within(1 + 0.25 * liveliness(mood), LEAST_TEMPO, MOST_TEMPO);
}

/**
 * Return how much longer clip seconds take at a speed than at their own speed, exactly 0 at that speed.
 * @param {number} seconds
 * @param {number} speed
 * @returns {number}
 */
export function drag(seconds, speed) {
  return seconds * (1 / speed - 1);
}

/**
 * Return how far a joint turns away from its stance, a factor, for that of a cue. real: the real part of the original
 * rotation, a unit quaternion. Rotations of nearly half a circle, whose short way changes sides, stay as they are.
 * @param {number} factor
 * @param {number} real
 * @returns {number}
 */
export function turnExtent(factor, real) {
  return 1 + (factor - 1) * faded((Math.abs(real) - 0.1) / 0.4);
}

/**
 * Return whether an action was made for a mood: whether it has the tag of a mood that is near.
 * @param {Mood} mood
 * @param {string[]} tags
 * @returns {boolean}
 */
export function madeFor(mood, tags) {
  return tags.some((tag) => MOODS.has(tag) && distance(mood, tag) <= CLOSE);
}

/**
 * Return how far a mood is from a named one, 0..2.8.
 * @param {Mood} mood
 * @param {string} name
 * @returns {number}
 */
export function distance(mood, name) {
  const { 0: valence, 1: arousal } = MOODS.get(name);
  const x = mood.valence - valence;
  const y = mood.arousal - arousal;
  return Math.sqrt(x * x + y * y);
}

/**
 * Return the factor of an action's likelihood. vigour: how energetic it is compared with others of its layer and kind,
 * -1..1. The factor is up to 4 for vigour, 4 for a tag of valence and 9 for a tag that names a mood, and the inverse if they
 * contradict the mood.
 * @param {Mood} mood
 * @param {string[]} tags
 * @param {number} vigour
 * @returns {number}
 */
export function favour(mood, tags, vigour) {
  let out = leaning(vigour * within(liveliness(mood) + (mood.intensity - 1), -1, 1), 4);
  if (tags.includes(PLEASANT)) {
    out *= leaning(mood.valence, 4);
  }
  if (tags.includes(UNPLEASANT)) {
    out *= leaning(-mood.valence, 4);
  }
  const strength = Math.min(1, Math.sqrt(mood.valence * mood.valence + mood.arousal * mood.arousal) / CLOSE);
  for (const tag of tags) {
    if (MOODS.has(tag)) {
      out *= leaning(strength * (1 - distance(mood, tag) / CLOSE), 9);
    }
  }
  return out;
}

/**
 * Return whether something that a model wrote is performed in a mood: less of it in a less lively mood, down to 0.6.
 * @param {Mood} mood
 * @param {number} seed
 * @param {string} key
 * @returns {boolean}
 */
export function stirs(mood, seed, key) {
  const lively = liveliness(mood);
  return lively >= 0 || uniform(seed, key, "mood") < 1 + 0.4 * lively;
}

/**
 * Return how a mood changes the life layers. With arousal, breath is quicker and deeper, and eyes dart and blink more. In an
 * unpleasant mood the character looks away more, in a pleasant one less. The amounts are ours.
 * @param {Mood} mood
 * @returns {LifeMood}
 */
export function lifeOf(mood) {
  const a = mood.arousal;
  const v = mood.valence;
  return new LifeMood(
    1 + 0.25 * a,
    a > 0 ? 1 + 0.4 * a : 1 + 0.25 * a,
    v < 0 ? 1 - 0.4 * v : 1 - 0.25 * v,
    1 + 0.4 * a,
    a > 0 ? 1 + 0.4 * a : 1 + 0.25 * a,
  );
}

/**
 * Return posture and face of a mood, stronger with its intensity. The head bows with sadness (Roether et al. 2009);
 * shoulders rise, fists close and the body leans forward with arousal that is not joy; fear draws back (Coulson 2004); the
 * amounts are ours.
 * @param {Mood} mood
 * @returns {Bearing}
 */
export function bearing(mood) {
  const v = mood.valence;
  const a = mood.arousal;
  const i = mood.intensity;
  const up = Math.max(0, a);
  const down = Math.max(0, -a);
  const well = Math.max(0, v);
  const ill = Math.max(0, -v);
  const scared = fear(mood);
  const cross = anger(mood);
  return new Bearing(
    within(i * (-0.7 * v - 0.5 * a), -0.4, 1),
    within(i * (2 * up * (1 - well) + 4.5 * scared - 1.5 * down - ill * (1 - up)), -2, 6),
    within(i * (0.5 * down - 0.5 * scared - 0.15 * cross - 1.1 * up * well), -0.6, 0.5),
    within(i * well * (1.2 + 0.3 * up - 0.6 * down), 0, 1),
    within(i * (1.4 * ill * (1 - up) * (1 - 0.6 * down) + 0.35 * cross + 0.4 * scared), 0, 1),
    within(i * (0.5 * up * Math.max(0, 0.4 - v) + 0.8 * cross) * (1 - scared), 0, 1),
    within(i * (2 * ill * (1 - up) * (1 - down) + 0.9 * scared), 0, 1),
    within(i * (0.3 * up * Math.max(0, 0.3 - v) + 0.9 * cross - 0.7 * scared), -1, 1),
    within(i * 1.2 * up * Math.max(0, 1 - 2 * well) * (1 - 0.8 * scared), 0, 1),
    within(i * (0.6 * scared + 1.6 * up * well), 0, 1),
    within(i * (0.5 * scared + 0.4 * ill * (1 - up)), 0, 1),
  );
}

/**
 * Return how far lids are shut: as far as a blink shuts them or, if they hang farther, as far as they do; below 0 where they
 * are open wide.
 * @param {number} blink
 * @param {number} lids
 * @returns {number}
 */
export function shutIn(blink, lids) {
  return lids > 0 ? Math.max(blink, lids) : blink + lids * (1 - blink);
}
