/**
 * The times of a line's words and mouth shapes, as a synthesiser reports them: the mouth follows them and is shut in
 * between. Times are seconds from the line's start.
 *
 * Translated from metagraph/playback/life/line_timing.py; change that, and translate anew.
 */

import { PACE, Spelled, measureLetter, sounds, splitWords } from "./graphemes.js";
import { LATE, MouthPiece, STEP, VOWELS } from "./mouth.js";
import { but, maxOf, sum, thousandths, zip } from "./basics.js";

export const WORD = 0.15; // seconds that a word takes if only its start is known and nothing comes sooner
export const LETTER = 0.07; // and seconds for each of its letters
export const SHAPE = 0.2; // seconds for which the last shape of a line stays
export const FARTHEST = 3600; // seconds of a line
export const AGAIN = 0.1; // a later piece belongs to a line from this many seconds before its last shape on
export const SLACK = 0.05; // seconds by which times may exceed the given end
export const MISSED = 0.1; // seconds by which a word may come late and only be cut short
// What each viseme of a set shows of the mouth shapes, and how fully.
export const OCULUS = new Map([
  ["sil", "sil"],
  ["PP", "PP"],
  ["FF", "FF"],
  ["TH", "TH"],
  ["DD", "DD"],
  ["kk", "kk"],
  ["CH", "CH"],
  ["SS", "SS"],
  ["nn", "nn"],
  ["RR", "RR"],
  ["aa", "aa"],
  ["E", "E"],
  ["ih", "I"],
  ["oh", "O"],
  ["ou", "U"],
  ["I", "I"],
  ["O", "O"],
  ["U", "U"],
]);
// SAPI's numbers, which Azure has, too.
export const AZURE = new Map([
  ["0", "sil"],
  ["1", "E"],
  ["2", "aa"],
  ["3", "O"],
  ["4", "E"],
  ["5", "RR"],
  ["6", "I"],
  ["7", "U"],
  ["8", "O"],
  ["9", "aa"],
  ["10", "O"],
  ["11", "aa"],
  ["12", "kk"],
  ["13", "RR"],
  ["14", "nn"],
  ["15", "SS"],
  ["16", "CH"],
  ["17", "TH"],
  ["18", "FF"],
  ["19", "DD"],
  ["20", "kk"],
  ["21", "PP"],
]);
// Amazon Polly's speech marks.
export const POLLY = new Map([
  ["sil", "sil"],
  ["p", "PP"],
  ["t", "DD"],
  ["S", "CH"],
  ["T", "TH"],
  ["f", "FF"],
  ["k", "kk"],
  ["i", "I"],
  ["r", "RR"],
  ["s", "SS"],
  ["u", "U"],
  ["@", "E"],
  ["a", "aa"],
  ["e", "E"],
  ["E", "E"],
  ["o", "O"],
  ["O", "O"],
]);
// Of ARKit's blend shapes those that make the mouth.
export const ARKIT = new Map([
  ["jawOpen", "aa"],
  ["mouthClose", "PP"],
  ["mouthPressLeft", "PP"],
  ["mouthPressRight", "PP"],
  ["mouthFunnel", "O"],
  ["mouthPucker", "U"],
  ["mouthRollLower", "FF"],
  ["mouthRollUpper", "PP"],
  ["mouthStretchLeft", "E"],
  ["mouthStretchRight", "E"],
  ["mouthSmileLeft", "I"],
  ["mouthSmileRight", "I"],
  ["mouthShrugUpper", "CH"],
  ["tongueOut", "TH"],
]);
export const SETS = ["oculus", "azure", "sapi", "polly", "arkit"];
export const WEAK = new Map([["@", 0.6], ["12", 0.5], ["1", 0.8], ["mouthSmileLeft", 0.3], ["mouthSmileRight", 0.3]]);

/**
 * A word from `start` to `end`; `end` is None if only its start is known.
 *
 * text: string; start: number; end: ?number.
 */
export class SpokenWord {
  constructor(text, start, end = null) {
    this.text = text;
    this.start = start;
    this.end = end;
  }
}

/**
 * A mouth shape from `at` until the next mark of a later time. viseme: its name in its set; in a `LineTiming`, one of
 * `VISEMES`. weight: how fully it is made, 0..1.
 *
 * at: number; viseme: string; weight: number.
 */
export class VisemeMark {
  constructor(at, viseme, weight = 1) {
    this.at = at;
    this.viseme = viseme;
    this.weight = weight;
  }
}

/**
 * A line's words and mouth shapes, each by time. later: seconds by which later pieces are delayed, because one came after
 * its time. paced: whether the times are estimated from the letters.
 *
 * words: SpokenWord[]; marks: VisemeMark[]; later: number; paced: boolean.
 */
export class LineTiming {
  constructor(words = [], marks = [], later = 0, paced = false) {
    this.words = words;
    this.marks = marks;
    this.later = later;
    this.paced = paced;
  }
}

/**
 * Return whether two lines have the same words and shapes at the same times.
 * @param {?LineTiming} one
 * @param {?LineTiming} other
 * @returns {boolean}
 */
export function alikeTimings(one, other) {
  if (one === null || other === null) {
    return one === null && other === null;
  }
  if (one.words.length !== other.words.length || one.marks.length !== other.marks.length) {
    return false;
  }
  const words = zip(one.words, other.words).every(({ 0: a, 1: b }) =>
    a.text === b.text && a.start === b.start && a.end === b.end);
  return words
    && zip(one.marks, other.marks).every(({ 0: a, 1: b }) =>
      a.at === b.at && a.viseme === b.viseme && a.weight === b.weight);
}

/**
 * @param {string} name
 * @returns {Map<string, string>}
 */
function _table(name) {
  if (name === "oculus") {
    return OCULUS;
  }
  if (name === "polly") {
    return POLLY;
  }
  return name === "arkit" ? ARKIT : AZURE;
}

/**
 * Return the first set that has all of the visemes, "" if none has.
 * @param {VisemeMark[]} marks
 * @returns {string}
 */
export function setOf(marks) {
  for (const name of SETS) {
    if (marks.every((mark) => _table(name).has(mark.viseme))) {
      return name;
    }
  }
  return "";
}

/**
 * Return what is wrong with a line's times, where, and what would be right; "" if nothing is wrong.
 *
 * name: of the visemes' set, "" to find it by their names. duration: seconds of its sound, None if unknown.
 * @param {SpokenWord[]} words
 * @param {VisemeMark[]} marks
 * @param {string} name
 * @param {?number} duration
 * @returns {string}
 */
export function wrongIn(words, marks, name, duration) {
  let last = 0;
  let why;
  for (const { 0: n, 1: word } of words.entries()) {
    const place = `words[${n}] '${word.text}'`;
    why = _outOfRange(word.start);
    if (why === "" && word.start < last) {
      why = `begins at ${thousandths(word.start)} s, before the one before it; put words in order`;
    }
    const end = word.end === null ? word.start : word.end;
    if (why === "" && !(end >= word.start)) {
      why = `ends at ${thousandths(end)} s, before it begins; give [word, start, end] in seconds`;
    }
    if (why === "" && duration !== null && end > duration + SLACK) {
      why = `ends at ${thousandths(end)} s, past the end at ${thousandths(duration)} s; give a longer duration`;
    }
    if (why !== "") {
      return `${place}: ${why}`;
    }
    last = word.start;
  }
  if (name !== "" && !SETS.includes(name)) {
    return `set: '${name}' is no set of visemes; there are ${SETS.join(", ")}`;
  }
  const found = name === "" ? setOf(marks) : name;
  last = 0;
  for (const { 0: n, 1: mark } of marks.entries()) {
    why = _outOfRange(mark.at);
    if (why === "" && mark.at < last) {
      why = `comes at ${thousandths(mark.at)} s, before the one before it; put visemes in order`;
    }
    if (why === "" && duration !== null && mark.at > duration + SLACK) {
      why = `comes at ${thousandths(mark.at)} s, past the end at ${thousandths(duration)} s; give a longer duration`;
    }
    if (why === "" && !(0 <= mark.weight && mark.weight <= 1)) {
      why = `has the weight ${thousandths(mark.weight)}; weights are from 0 to 1`;
    }
    if (why === "" && found === "" && setOf([mark]) === "") {
      why = `is in no set of visemes; there are ${SETS.join(", ")}`;
    }
    if (why === "" && found !== "" && !_table(found).has(mark.viseme)) {
      why = `is not in the set '${found}', which has ${[...[..._table(found).keys()]].join(", ")}`;
    }
    if (why !== "") {
      return `visemes[${n}] '${mark.viseme}': ${why}`;
    }
    last = mark.at;
  }
  if (found === "") {
    return `visemes: no set has all of them; there are ${SETS.join(", ")}`;
  }
  return "";
}

/**
 * @param {number} seconds
 * @returns {string}
 */
function _outOfRange(seconds) {
  if (0 <= seconds && seconds <= FARTHEST) {
    return "";
  }
  return `is at ${thousandths(seconds)} s; times are from 0 to ${FARTHEST.toFixed(1)} s from the line's start`;
}

/**
 * Return the timing of words and visemes that are valid. name: as for `wrong_in`.
 * @param {Alphabet} alphabet
 * @param {SpokenWord[]} words
 * @param {VisemeMark[]} marks
 * @param {string} name
 * @returns {LineTiming}
 */
export function timingOf(alphabet, words, marks, name) {
  const table = _table(name === "" ? setOf(marks) : name);
  const shown = marks.map((m) => new VisemeMark(m.at, table.get(m.viseme), m.weight * (WEAK.get(m.viseme) ?? 1)));
  const said = [];
  for (const { 0: n, 1: word } of words.entries()) {
    let end = word.end === null ? word.start + WORD + LETTER * alphabet.letters(word.text).length : word.end;
    if (n + 1 < words.length) {
      end = Math.min(end, words[n + 1].start);
    }
    if (word.end === null) { // a pause ends it
      end = Math.min(end, shown.filter((m) => m.viseme === "sil" && m.at > word.start).map((m) => m.at)[0] ?? end);
    }
    said.push(new SpokenWord(word.text, word.start, Math.max(end, word.start)));
  }
  return new LineTiming([...said], [...shown]);
}

/**
 * Return how many seconds a text takes as a part of a longer text.
 * @param {Alphabet} alphabet
 * @param {string} text
 * @returns {number}
 */
export function measureText(alphabet, text) {
  let out = 0;
  for (const { 0: word, 1: pause } of splitWords(alphabet, text)) {
    out += _measureWord(alphabet, word) + pause / PACE;
  }
  return out;
}

/**
 * Return the words of a text, one after the other. seconds: how long all of it takes, None to estimate it from the letters.
 * @param {Alphabet} alphabet
 * @param {string} text
 * @param {?number} seconds
 * @returns {LineTiming}
 */
export function paceText(alphabet, text, seconds) {
  const scale = seconds === null ? 1 : seconds / Math.max(measureText(alphabet, text), 0.001);
  let at = 0;
  const words = [];
  for (const { 0: word, 1: pause } of splitWords(alphabet, text)) {
    const end = at + scale * _measureWord(alphabet, word);
    if (word !== "") {
      words.push(new SpokenWord(word, at, end));
    }
    at = end + scale * pause / PACE;
  }
  return new LineTiming([...words], [], 0, true);
}

/**
 * Return how long a word takes, seconds.
 * @param {Alphabet} alphabet
 * @param {string} word
 * @returns {number}
 */
function _measureWord(alphabet, word) {
  return sum(alphabet.letters(word).map((letter) => measureLetter(alphabet.code(letter)))) / PACE;
}

/**
 * Return the words of letters that have a time each. Blanks separate words, and so does each letter that is a syllable.
 * @param {Alphabet} alphabet
 * @param {SpokenWord[]} letters
 * @returns {SpokenWord[]}
 */
export function joinLetters(alphabet, letters) {
  const out = [];
  let parted = true;
  for (const letter of letters) {
    if (alphabet.stripped(letter.text) === "") {
      parted = true;
      continue;
    }
    const alone = measureLetter(alphabet.code(alphabet.letters(letter.text)[0])) > 1;
    if (parted || alone) {
      out.push(letter);
    } else {
      const last = out[out.length - 1];
      out[out.length - 1] = new SpokenWord(last.text + letter.text, last.start, letter.end);
    }
    parted = alone;
  }
  return out;
}

/**
 * Return the words of a line as its text.
 * @param {LineTiming} timing
 * @returns {string}
 */
export function toldText(timing) {
  return timing.words.map((word) => word.text).join(" ");
}

/**
 * Return how long a line lasts, rounded to whole rows of the mouth's track, so that later additions move nothing. duration:
 * of its sound, None for as long as its words and shapes need.
 * @param {LineTiming} timing
 * @param {?number} duration
 * @returns {number}
 */
export function timedSeconds(timing, duration) {
  const last = _endOf(timing);
  return Math.ceil((duration === null ? last + LATE : Math.max(duration, last)) / STEP - 1e-06) * STEP;
}

/**
 * Return the mouth's pieces and the syllables of a line's words and shapes: the mouth follows the shapes if there are any;
 * gestures and blinks follow the words.
 * @param {Alphabet} alphabet
 * @param {LineTiming} timing
 * @returns {Spelled}
 */
export function timedSounds(alphabet, timing) {
  const out = new Spelled();
  for (const word of timing.words) {
    const plan = sounds(alphabet, word.text);
    const over = word.end === null ? word.start : word.end;
    if (plan.length > 0 && over > word.start) {
      out.add(plan, word.start, over);
    }
  }
  if (timing.marks.length === 0) {
    return out;
  }
  const shown = new Spelled();
  let before = "sil";
  for (const { 0: mark, 1: end } of zip(timing.marks, _ends(timing.marks))) {
    if (mark.viseme !== "sil" && end > mark.at) {
      shown.pieces.push(new MouthPiece(mark.at, end, mark.viseme, mark.weight));
      if (VOWELS.includes(mark.viseme) && !VOWELS.includes(before) && mark.weight > 0) {
        shown.peaks.push(0.5 * (mark.at + end));
        shown.strengths.push(mark.weight * Math.min(1, 0.3 + 4 * (end - mark.at)));
      }
    }
    before = mark.viseme;
  }
  if (out.peaks.length > 0) {
    return new Spelled(shown.pieces, out.peaks, out.strengths);
  }
  return shown;
}

/**
 * Return when each mark ends: marks at the same time show together.
 * @param {VisemeMark[]} marks
 * @returns {number[]}
 */
function _ends(marks) {
  const out = [];
  let end = 0;
  let at = -1;
  for (const mark of [...marks].reverse()) {
    if (mark.at !== at) {
      end = at < 0 ? mark.at + SHAPE : at;
      at = mark.at;
    }
    out.push(end);
  }
  return [...[...out].reverse()];
}

/**
 * Return whether a piece that comes after the end of a line belongs to the same line: it begins after the last known word or
 * shape, or repeats all with more behind it. Otherwise it is something else under the same id.
 * @param {LineTiming} old
 * @param {LineTiming} new_
 * @returns {boolean}
 */
export function tellsOn(old, new_) {
  if (new_.words.length > 0 && old.words.length > 0) {
    const first = new_.words[0];
    if (first.start > old.words[old.words.length - 1].start) {
      return true;
    }
    const same = first.text === old.words[0].text && first.start === old.words[0].start;
    return same && new_.words.length > old.words.length;
  }
  if (new_.marks.length > 0 && old.marks.length > 0) {
    const shape = new_.marks[0];
    if (shape.at >= old.marks[old.marks.length - 1].at - AGAIN) {
      return true;
    }
    return shape.at === old.marks[0].at && new_.marks.length > old.marks.length;
  }
  return false;
}

/**
 * Return a timing `by` seconds later.
 * @param {LineTiming} timing
 * @param {number} by
 * @returns {LineTiming}
 */
export function shifted(timing, by) {
  if (by === 0) {
    return timing;
  }
  const words = timing.words.map((word) =>
    new SpokenWord(word.text, word.start + by, word.end === null ? null : word.end + by));
  return new LineTiming([...words], timing.marks.map((mark) => but(mark, { at: mark.at + by })));
}

/**
 * Return a later piece of a line with the times at which it is said. A piece that counts from its own beginning follows the
 * earlier pieces. A piece that comes too late, because the voice had stopped, is said at once, and everything after it is
 * delayed. said: seconds of the line that are over.
 * @param {LineTiming} old
 * @param {LineTiming} new_
 * @param {number} said
 * @returns {LineTiming}
 */
export function placeTold(old, new_, said) {
  const end = _endOf(old);
  if (restarts(old, new_, said)) {
    return but(shifted(new_, Math.max(said, end)), { later: old.later });
  }
  const told = shifted(new_, old.later);
  let by = 0;
  if (old.words.length > 0 && told.words.length > 0) {
    const words = told.words.filter((word) => word.start > old.words[old.words.length - 1].start);
    if (words.length > 0 && comesLate(words[0].start, maxOf(words.map((word) => _end(word))), end, said)) {
      by = Math.max(said, end) - words[0].start;
    }
  } else if (old.marks.length > 0 && told.marks.length > 0) {
    const marks = told.marks.filter((mark) => mark.at > old.marks[old.marks.length - 1].at);
    if (marks.length > 0 && comesLate(marks[0].at, marks[marks.length - 1].at + SHAPE, end, said)) {
      by = Math.max(said, end) - marks[0].at;
    }
  }
  return but(shifted(told, by), { later: old.later + by });
}

/**
 * Return whether what is new of a line comes too late: all of it, or its beginning after the voice had stopped. first, last:
 * when it would begin and end; silent: when what was known before ends; said: as for `place_told`.
 * @param {number} first
 * @param {number} last
 * @param {number} silent
 * @param {number} said
 * @returns {boolean}
 */
export function comesLate(first, last, silent, said) {
  return last <= said || (first < said - MISSED && silent <= said);
}

/**
 * Return whether a piece of a line counts its times from 0 again: it lies at the beginning of the line, but does not repeat
 * it.
 * @param {LineTiming} old
 * @param {LineTiming} new_
 * @param {number} said
 * @returns {boolean}
 */
export function restarts(old, new_, said) {
  let again;
  if (old.words.length > 0 && new_.words.length > 0) {
    let same = 0;
    while (same < Math.min(old.words.length, new_.words.length) && _alike(old.words[same], new_.words[same])) {
      same += 1;
    }
    again = same > 0 && new_.words.length >= old.words.length;
    return same < new_.words.length && !again && new_.words[0].start < _end(old.words[0]);
  }
  if (old.marks.length > 0 && new_.marks.length > 0) {
    again = zip(old.marks, new_.marks).every(({ 0: a, 1: b }) => a.viseme === b.viseme && Math.abs(a.at - b.at) < SLACK);
    const first = new_.marks[0].at;
    return !again && first < old.marks[0].at + SLACK && first < said;
  }
  return false;
}

/**
 * @param {SpokenWord} one
 * @param {SpokenWord} other
 * @returns {boolean}
 */
function _alike(one, other) {
  return one.text === other.text && Math.abs(one.start - other.start) < SLACK;
}

/**
 * @param {SpokenWord} word
 * @returns {number}
 */
function _end(word) {
  return word.end === null ? word.start : word.end;
}

/**
 * Return when the last word or shape ends.
 * @param {LineTiming} timing
 * @returns {number}
 */
function _endOf(timing) {
  let end = maxOf([0, ...timing.words.map((word) => _end(word))]);
  if (timing.marks.length > 0) {
    const mark = timing.marks[timing.marks.length - 1];
    end = Math.max(end, mark.at + (mark.viseme === "sil" ? 0 : SHAPE));
  }
  return end;
}

/**
 * Return a line's timing with a later piece: the old timing stays up to `said` seconds, and up to the beginning of the new
 * piece. Of a word or shape that has begun meanwhile, the rest is said.
 * @param {LineTiming} old
 * @param {LineTiming} new_
 * @param {number} said
 * @returns {LineTiming}
 */
export function extended(old, new_, said) {
  let words = [...old.words];
  const begun = maxOf([-1, ...old.words.filter((word) => word.start < said).map((word) => word.start)]);
  const coming = new_.words.filter((word) =>
    word.start >= said || (word.start > begun && (word.end === null ? word.start : word.end) > said));
  let until;
  if (coming.length > 0) {
    until = Math.max(said, new_.words[0].start);
    const first = Math.max(coming[0].start, said);
    words = old.words.filter((word) => word.start < until).map((word) =>
      but(word, { end: Math.min(word.end === null ? first : word.end, first) }));
    words.push(...coming.map((word) => but(word, { start: Math.max(word.start, said) })));
  }
  let marks = [...old.marks];
  const now = maxOf([-1, ...new_.marks.filter((mark) => mark.at < said).map((mark) => mark.at)]);
  const over = maxOf([-1, ...old.marks.filter((mark) => mark.at < said).map((mark) => mark.at)]);
  const shown = new_.marks.filter((mark) =>
    mark.at >= said || (mark.at === now && now >= over && !_told(old.marks, mark))).map((mark) =>
    but(mark, { at: Math.max(mark.at, said) }));
  if (shown.length > 0) {
    until = Math.max(said, new_.marks[0].at);
    marks = old.marks.filter((mark) => mark.at < until);
    marks.push(...shown);
  }
  return new LineTiming([...words], [...marks], new_.later);
}

/**
 * @param {VisemeMark[]} marks
 * @param {VisemeMark} mark
 * @returns {boolean}
 */
function _told(marks, mark) {
  return marks.some((m) => m.at === mark.at && m.viseme === mark.viseme);
}
