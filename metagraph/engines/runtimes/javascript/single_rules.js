/**
 * Single rules, asked with numbers and texts alone: what vectors ask beside plans and poses, so that each rule of geometry,
 * of the mouth, of moods and of times meets both sides of its boundaries.
 *
 * Translated from metagraph/engines/single_rules.py; change that, and translate anew.
 */

import { VISEMES } from "./words.js";
import { 
  BodyCapsule,
  ContactArm,
  ContactPose,
  ContactRig,
  HandGoal,
  apart,
  bring,
  capsuleEnds,
  solveContacts,
  spread,
} from "./contact_solve.js";
import { ContactKey, ContactSpan, contactKey, contactWeight } from "./contact_spans.js";
import { FootGoal, footWay, plantFeet } from "./feet_solve.js";
import { between, unit, unitTurn } from "./plain_vectors.js";
import { WeightBend, WeightCollar, WeightRig, answerArms, hipsSink, standsBy } from "./weight_solve.js";
import { measureLetter, readAloud, spelled } from "./graphemes.js";
import { 
  LineTiming,
  SpokenWord,
  VisemeMark,
  alikeTimings,
  comesLate,
  extended,
  joinLetters,
  paceText,
  placeTold,
  restarts,
  setOf,
  shifted,
  tellsOn,
  timedSeconds,
  timedSounds,
  timingOf,
  wrongIn,
} from "./line_timing.js";
import { MouthPiece, accentsOf, mouthTrack, soften } from "./mouth.js";
import { logNormal } from "./choice.js";
import { beatInterval, findLull, freshness, posture, repeatInterval } from "./director.js";
import { 
  Mood,
  MoodFrom,
  Moods,
  anger,
  bearing,
  changed,
  distance,
  drag,
  extent,
  faded,
  favour,
  fear,
  lasting,
  leaning,
  lifeOf,
  liveliness,
  madeFor,
  moodAt,
  moodEdges,
  shown,
  shutIn,
  stirs,
  tempo,
  turnExtent,
} from "./mood.js";
import { ease } from "./cue_times.js";
import { driven } from "./follow_through.js";
import { FootTrack, footRow, stepped } from "./planted_feet.js";

export const OPEN = 1000000000; // in the place of an end that is not known

/**
 * What a rule is asked with: numbers and texts, which are taken one after the other.
 *
 * numbers: number[]; texts: string[]; at: number; told: number.
 */
export class RuleInput {
  constructor(numbers, texts, at = 0, told = 0) {
    this.numbers = numbers;
    this.texts = texts;
    this.at = at;
    this.told = told;
  }

  /** Take the next number. */
  number() {
    this.at += 1;
    return this.numbers[this.at - 1];
  }

  /** Take the next text. */
  text() {
    this.told += 1;
    return this.texts[this.told - 1];
  }
}

/**
 * Return what a rule makes of numbers and texts; nothing for a rule that is not known.
 * @param {Alphabet} alphabet
 * @param {number} seed
 * @param {string} rule
 * @param {number[]} numbers
 * @param {string[]} texts
 * @returns {number[]}
 */
export function answerRule(alphabet, seed, rule, numbers, texts) {
  const given = new RuleInput(numbers, texts);
  if (["between", "apart", "unit", "contacts", "bring", "weight", "feet"].includes(rule)) {
    return _geometry(rule, given);
  }
  if (["way", "steps", "track", "driven", "span", "key"].includes(rule)) {
    return _places(rule, given);
  }
  if (["mouth", "soften", "accents", "spelled", "letters"].includes(rule)) {
    return _mouth(alphabet, rule, given);
  }
  if (["timing", "piece"].includes(rule)) {
    return _timing(alphabet, rule, given);
  }
  if (["mood", "moods", "shown", "lasting"].includes(rule)) {
    return _mood(seed, rule, given);
  }
  return _times(seed, rule, given);
}

/**
 * @param {RuleInput} given
 * @returns {[number, number, number]}
 */
function _vector(given) {
  const x = given.number();
  const y = given.number();
  const z = given.number();
  return [x, y, z];
}

/**
 * @param {RuleInput} given
 * @returns {[number, number, number, number]}
 */
function _turn(given) {
  const x = given.number();
  const y = given.number();
  const z = given.number();
  const w = given.number();
  return unitTurn([x, y, z, w]);
}

/**
 * @param {RuleInput} given
 * @returns {number}
 */
function _count(given) {
  return Math.floor(given.number() + 0.5);
}

/**
 * @param {number[]} out
 * @param {[number, number, number]} v
 */
function _put(out, v) {
  const { 0: x, 1: y, 2: z } = v;
  out.push(...[x, y, z]);
}

/**
 * @param {number[]} out
 * @param {[number, number, number, number]} q
 */
function _putTurn(out, q) {
  const { 0: x, 1: y, 2: z, 3: w } = q;
  out.push(...[x, y, z, w]);
}

// --- limbs
/**
 * Read a rig and a pose of it.
 * @param {RuleInput} given
 * @param {ContactPose} pose
 * @returns {ContactRig}
 */
function _rig(given, pose) {
  const parents = [];
  const joints = [];
  let size = _count(given);
  for (let n = 0; n < size; n++) {
    joints.push(n);
    parents.push(_count(given));
    pose.moved.push(_vector(given));
    pose.local.push(_turn(given));
  }
  const limbs = [];
  for (let side = 0; side < 2; side++) {
    const upper = _count(given);
    const lower = _count(given);
    const hand = _count(given);
    const below = [];
    size = _count(given);
    for (let n = 0; n < size; n++) {
      below.push(_count(given));
    }
    limbs.push(new ContactArm(upper, lower, hand, [...below]));
  }
  const capsules = [];
  size = _count(given);
  for (let n = 0; n < size; n++) {
    const joint = _count(given);
    const a = _vector(given);
    const to = _count(given);
    const b = _vector(given);
    const radius = given.number();
    const arm = _count(given);
    capsules.push(new BodyCapsule(joint, a, to, b, radius, arm, _count(given)));
  }
  const guard = given.number() > 0;
  const places = new Map();
  return new ContactRig([...joints], [...parents], places, [...limbs], ["left", "right"], [...capsules], true, guard);
}

/**
 * @param {RuleInput} given
 * @param {ContactRig} body
 * @returns {WeightRig}
 */
function _weightRig(given, body) {
  const bends = [];
  let size = _count(given);
  let place;
  for (let n = 0; n < size; n++) {
    place = _count(given);
    const left = _vector(given);
    const up = _vector(given);
    const ahead = _vector(given);
    bends.push(new WeightBend(place, left, up, ahead, given.number()));
  }
  const collars = [];
  size = _count(given);
  for (let n = 0; n < size; n++) {
    place = _count(given);
    const upper = _count(given);
    const axis = _vector(given);
    collars.push(new WeightCollar(place, upper, axis, _count(given)));
  }
  const knees = [];
  const levers = [];
  for (let side = 0; side < 2; side++) {
    knees.push(_vector(given));
    const aside = given.number();
    levers.push([aside, given.number()]);
  }
  const height = given.number();
  return new WeightRig(body, [...bends], [...collars], [...knees], [...levers], [0, 1, 0], height, given.number());
}

/**
 * @param {ContactPose} pose
 * @returns {number[]}
 */
function _posed(pose) {
  const out = [];
  for (let place = 0; place < pose.local.length; place++) {
    _putTurn(out, pose.local[place]);
    _put(out, pose.at[place]);
  }
  return out;
}

/**
 * @param {string} rule
 * @param {RuleInput} given
 * @returns {number[]}
 */
function _geometry(rule, given) {
  const out = [];
  if (rule === "between") {
    const a = unit(_vector(given));
    _putTurn(out, between(a, unit(_vector(given))));
  } else if (rule === "unit") {
    _put(out, unit(_vector(given)));
    _putTurn(out, _turn(given));
  } else if (rule === "apart") {
    const ends = [];
    for (let n = 0; n < 4; n++) {
      ends.push(_vector(given));
    }
    _putTurn(out, apart(ends, 0, 2));
  } else {
    const pose = new ContactPose();
    const rig = _rig(given, pose);
    spread(rig, pose);
    let moved = false;
    if (rule === "bring") {
      const side = _count(given);
      const goal = _vector(given);
      let turn = _turn(given);
      bring(rig, pose, side, goal, turn, _vector(given));
    } else if (rule === "contacts") {
      const goals = [];
      let size = _count(given);
      for (let n = 0; n < size; n++) {
        const arm = _count(given);
        const to = _count(given);
        const at = _vector(given);
        let turn = _turn(given);
        goals.push(new HandGoal(arm, to, at, turn, given.number()));
      }
      moved = solveContacts(rig, pose, goals);
      for (const end of capsuleEnds(rig, pose)) {
        _put(out, end);
      }
    } else {
      const body = _weightRig(given, rig);
      out.push(standsBy(body, pose));
      if (rule === "weight") {
        const drive = [];
        for (let n = 0; n < 16; n++) {
          drive.push(given.number());
        }
        const follow = given.number();
        moved = answerArms(body, pose, drive, follow, given.number());
      } else {
        for (let side = 0; side < 2; side++) {
          const foot = _vector(given);
          const reach = given.number();
          out.push(hipsSink(body, pose, side, foot, reach, given.number()));
        }
        const feet = [];
        let size = _count(given);
        for (let n = 0; n < size; n++) {
          feet.push(_foot(given));
        }
        moved = plantFeet(body, pose, feet, given.number());
      }
    }
    out.push(moved ? 1 : 0);
    spread(rig, pose);
    out.push(..._posed(pose));
  }
  return out;
}

// --- where hands and feet are
/**
 * @param {RuleInput} given
 * @returns {FootGoal}
 */
function _foot(given) {
  const at = _vector(given);
  const turn = _turn(given);
  const planted = given.number();
  return new FootGoal(at, turn, planted, given.number());
}

/**
 * @param {RuleInput} given
 * @returns {FootGoal[]}
 */
function _feet(given) {
  const out = [];
  const size = _count(given);
  for (let n = 0; n < size; n++) {
    out.push(_foot(given));
  }
  return out;
}

/**
 * @param {number[]} out
 * @param {FootGoal[]} feet
 */
function _putFeet(out, feet) {
  for (const foot of feet) {
    _put(out, foot.at);
    _putTurn(out, foot.turn);
    out.push(...[foot.planted, foot.lift]);
  }
}

/**
 * @param {RuleInput} given
 * @param {number} count
 * @param {number} width
 * @returns {number[][]}
 */
function _rows(given, count, width) {
  const out = [];
  for (let n = 0; n < count; n++) {
    const row = [];
    for (let k = 0; k < width; k++) {
      row.push(given.number());
    }
    out.push(row);
  }
  return out;
}

/**
 * @param {RuleInput} given
 * @returns {ContactSpan}
 */
function _span(given) {
  const start = given.number();
  const end = given.number();
  const easeIn = given.number();
  const easeOut = given.number();
  const keys = [];
  const size = _count(given);
  for (let n = 0; n < size; n++) {
    const time = given.number();
    const at = _vector(given);
    keys.push(new ContactKey(time, at, _turn(given)));
  }
  return new ContactSpan("left", "palm", "Chest", start, end, [...keys], easeIn, easeOut);
}

/**
 * @param {string} rule
 * @param {RuleInput} given
 * @returns {number[]}
 */
function _places(rule, given) {
  const out = [];
  if (rule === "way") {
    const one = _foot(given);
    out.push(footWay(one, _foot(given)));
  } else if (rule === "steps") {
    const height = given.number();
    const before = _feet(given);
    const after = _feet(given);
    const first = _feet(given);
    const last = _feet(given);
    const passed = given.number();
    _putFeet(out, stepped(height, before, after, first, last, passed, given.number()));
  } else if (rule === "track") {
    const rows = _rows(given, _count(given), 16);
    _putFeet(out, footRow(new FootTrack(rows), given.number()));
  } else if (rule === "driven") {
    const sways = _rows(given, 4, 8);
    out.push(...driven(sways, given.number()));
  } else if (rule === "span") {
    let span = _span(given);
    const first = given.number();
    const last = given.number();
    let size = _count(given);
    for (let n = 0; n < size; n++) {
      out.push(contactWeight(span, given.number(), first, last));
    }
  } else {
    let span = _span(given);
    let size = _count(given);
    for (let n = 0; n < size; n++) {
      const key = contactKey(span, given.number());
      out.push(key.time);
      _put(out, key.at);
      _putTurn(out, key.turn);
    }
  }
  return out;
}

// --- the mouth
/**
 * @param {number[]} out
 * @param {Spelled} found
 */
function _putSpelled(out, found) {
  for (const piece of found.pieces) {
    out.push(...[piece.start, piece.end, VISEMES.indexOf(piece.viseme), piece.strength]);
  }
  out.push(...found.peaks);
  out.push(...found.strengths);
}

/**
 * @param {Alphabet} alphabet
 * @param {string} rule
 * @param {RuleInput} given
 * @returns {number[]}
 */
function _mouth(alphabet, rule, given) {
  const out = [];
  if (rule === "mouth") {
    const pieces = [];
    let size = _count(given);
    for (let n = 0; n < size; n++) {
      const start = given.number();
      const end = given.number();
      const strength = given.number();
      pieces.push(new MouthPiece(start, end, given.text(), strength));
    }
    for (const row of mouthTrack(pieces, given.number())) {
      out.push(...row);
    }
  } else if (rule === "soften") {
    let rows = _rows(given, 3, 14);
    out.push(...rows[1]);
    soften(out, rows[0], rows[1], rows[2]);
  } else if (rule === "accents") {
    const count = _count(given);
    let rows = _rows(given, 2, count);
    out.push(...accentsOf(rows[0], rows[1]));
  } else if (rule === "letters") {
    let size = _count(given);
    for (let n = 0; n < size; n++) {
      out.push(measureLetter(_count(given)));
    }
  } else {
    const text = given.text();
    out.push(readAloud(alphabet, text));
    _putSpelled(out, spelled(alphabet, text, given.number()));
  }
  return out;
}

// --- the times of lines
/**
 * @param {RuleInput} given
 * @returns {LineTiming}
 */
function _line(given) {
  const words = [];
  let size = _count(given);
  for (let n = 0; n < size; n++) {
    const start = given.number();
    const end = given.number();
    words.push(new SpokenWord(given.text(), start, end >= OPEN ? null : end));
  }
  const marks = [];
  size = _count(given);
  for (let n = 0; n < size; n++) {
    const at = given.number();
    const weight = given.number();
    marks.push(new VisemeMark(at, given.text(), weight));
  }
  return new LineTiming([...words], [...marks], given.number());
}

/**
 * @param {Alphabet} alphabet
 * @param {number[]} out
 * @param {LineTiming} line
 */
function _putLine(alphabet, out, line) {
  for (const word of line.words) {
    out.push(...[word.start, word.end === null ? OPEN : word.end, alphabet.letters(word.text).length]);
  }
  for (const mark of line.marks) {
    out.push(...[mark.at, mark.viseme.length, mark.weight]);
  }
  out.push(line.later);
}

/**
 * @param {boolean} which
 * @returns {number}
 */
function _yes(which) {
  return which ? 1 : 0;
}

/**
 * @param {Alphabet} alphabet
 * @param {string} rule
 * @param {RuleInput} given
 * @returns {number[]}
 */
function _timing(alphabet, rule, given) {
  const out = [];
  if (rule === "timing") {
    const name = given.text();
    const duration = given.number();
    const raw = _line(given);
    const wrong = wrongIn(raw.words, raw.marks, name, duration >= OPEN ? null : duration);
    out.push(...[wrong.length, setOf(raw.marks).length]);
    _putLine(alphabet, out, new LineTiming([...joinLetters(alphabet, raw.words)]));
    const paced = paceText(alphabet, given.text(), duration >= OPEN ? null : duration);
    _putLine(alphabet, out, paced);
    if (wrong !== "") {
      return out;
    }
    const line = timingOf(alphabet, raw.words, raw.marks, name);
    _putLine(alphabet, out, line);
    _putLine(alphabet, out, shifted(line, 0.5));
    out.push(timedSeconds(line, duration >= OPEN ? null : duration));
    _putSpelled(out, timedSounds(alphabet, line));
  } else {
    const old = _line(given);
    const new_ = _line(given);
    const said = given.number();
    out.push(_yes(alikeTimings(old, new_)));
    out.push(_yes(alikeTimings(old, null)));
    out.push(_yes(alikeTimings(null, null)));
    out.push(_yes(tellsOn(old, new_)));
    out.push(_yes(restarts(old, new_, said)));
    const first = given.number();
    const last = given.number();
    out.push(_yes(comesLate(first, last, given.number(), said)));
    _putLine(alphabet, out, placeTold(old, new_, said));
    _putLine(alphabet, out, extended(old, new_, said));
  }
  return out;
}

// --- moods
/**
 * @param {RuleInput} given
 * @returns {Mood}
 */
function _moodOf(given) {
  const valence = given.number();
  const arousal = given.number();
  return new Mood(valence, arousal, given.number());
}

/**
 * Read moods; numbers above 8 stand for what is not told.
 * @param {RuleInput} given
 * @returns {MoodFrom[]}
 */
function _told(given) {
  const out = [];
  const size = _count(given);
  for (let n = 0; n < size; n++) {
    const start = given.number();
    const valence = given.number();
    const arousal = given.number();
    const intensity = given.number();
    const end = given.number();
    out.push(new MoodFrom(
      "told",
      start,
      valence > 8 ? null : valence,
      arousal > 8 ? null : arousal,
      intensity > 8 ? null : intensity,
      end >= OPEN ? Infinity : end,
    ));
  }
  return out;
}

/**
 * @param {number[]} out
 * @param {Mood} mood
 */
function _putMood(out, mood) {
  out.push(...[mood.valence, mood.arousal, mood.intensity]);
}

/**
 * @param {number} seed
 * @param {string} rule
 * @param {RuleInput} given
 * @returns {number[]}
 */
function _mood(seed, rule, given) {
  const out = [];
  if (rule === "mood") {
    const mood = _moodOf(given);
    const tags = [given.text(), given.text()];
    const life = lifeOf(mood);
    const how = bearing(mood);
    out.push(...[liveliness(mood), fear(mood), anger(mood), extent(mood), tempo(mood)]);
    out.push(...[life.breathing, life.breathRate, life.aversionRate, life.saccadeRate, life.blinks]);
    out.push(...[how.droop, how.lift, how.lids, how.smile, how.frown, how.browDown]);
    out.push(...[how.browUp, how.thrust, how.tension, how.brows, how.closed]);
    out.push(favour(mood, tags, given.number()));
    out.push(_yes(madeFor(mood, tags)));
    out.push(distance(mood, "happy"));
    for (let n = 0; n < 4; n++) {
      out.push(_yes(stirs(mood, seed, `${tags[0]}${n}`)));
    }
    const valence = given.number();
    const arousal = given.number();
    _putMood(out, changed(mood, valence, arousal, given.number()));
  } else if (rule === "moods") {
    const base = _moodOf(given);
    const moods = new Moods(base, _told(given));
    const start = given.number();
    const edges = moodEdges(moods, start, given.number());
    out.push(...edges);
    for (const edge of edges) {
      _putMood(out, moodAt(moods, edge));
    }
  } else if (rule === "shown") {
    const count = _count(given);
    const starts = _rows(given, 1, count);
    const values = _rows(given, count, 3);
    _putMood(out, shown(starts[0], values, given.number()));
  } else {
    const told = _told(given);
    for (const one of lasting(told, given.number())) {
      out.push(...[one.start, one.end > OPEN ? OPEN : one.end]);
    }
  }
  return out;
}

// --- times
/**
 * @param {number} seed
 * @param {string} rule
 * @param {RuleInput} given
 * @returns {number[]}
 */
function _times(seed, rule, given) {
  const out = [];
  if (rule === "lull") {
    const key = given.text();
    const talks = given.number() > 0;
    out.push(findLull(seed, key, talks, given.number()));
  } else if (rule === "intervals") {
    const count = _count(given);
    const share = given.number();
    const beats = beatInterval("arms", count);
    out.push(...[beats, beatInterval("head", count), posture("body"), posture("arms"), posture("head")]);
    out.push(...[repeatInterval("gesture", share, beats), repeatInterval("fidget", share, beats)]);
    out.push(freshness(given.number(), beats));
  } else if (rule === "curves") {
    const x = given.number();
    out.push(...[faded(x), ease(x), leaning(x, 4), turnExtent(1.25, x)]);
    out.push(...[shutIn(0.25, x), shutIn(0.75, x), drag(2, 1 + 0.5 * x * x)]);
    out.push(logNormal(8, 14, 0.25 + 0.125 * x * x, 0.5));
  }
  return out;
}
