/** The words and visemes of a line as synthesisers tell them: pairs and triples, Amazon Polly's speech marks, Azure's events. */

import { ALPHABET } from "./alphabet.js";
import { SpokenWord, VisemeMark, joinLetters, timingOf, wrongIn } from "./line_timing.js";

const [THOUSAND, TICKS] = [1e3, 1e7]; // of a second, in which Polly and Azure count

/**
 * Return when a line's words and shapes come, null where that is not told, or why that cannot be read.
 * @param {{words: unknown[], visemes: unknown[], characters: unknown[], set: ?string, duration: ?number}} ask
 * @returns {{timing: ?import("./line_timing.js").LineTiming, why: string}}
 */
export function toldTiming(ask) {
  const words = [];
  const marks = [];
  const refuse = (why) => ({ timing: null, why });
  for (const [n, entry] of ask.words.entries()) {
    if (!addWord(entry, words, false)) return refuse(`words[${n}]: should be [word, start, end], seconds from the line's start`);
  }
  const letters = [];
  for (const [n, entry] of ask.characters.entries()) {
    if (!addWord(entry, letters, false)) return refuse(`characters[${n}]: should be [letter, start, end], seconds from the line's start`);
  }
  if (!words.length) words.push(...joinLetters(ALPHABET, letters));
  for (const [n, entry] of ask.visemes.entries()) {
    const told = addMark(entry, marks) || addWord(entry, words, true);
    if (!told) return refuse(`visemes[${n}]: should be [seconds, viseme], or with its weight from 0 to 1`);
  }
  if (!words.length && !marks.length) return refuse("");
  const why = wrongIn(words, marks, ask.set ?? "", ask.duration);
  return why ? refuse(why) : { timing: timingOf(ALPHABET, words, marks, ask.set ?? ""), why: "" };
}

const isNumber = (x) => typeof x === "number";
const isRecord = (x) => typeof x === "object" && x !== null && !Array.isArray(x);
const seconds = (x, of) => (isNumber(x) ? x / of : x);

/** Add the word an entry tells; return whether it is one. named: only where it says so itself. */
function addWord(entry, out, named) {
  let told = entry;
  if (isRecord(entry)) {
    const kind = entry.type ?? "";
    if (kind === "sentence" || kind === "ssml") return true; // marks of Polly's that no mouth needs
    if (named && kind !== "word") return false;
    if (kind === "word") {
      told = [entry.value, seconds(entry.time, THOUSAND)];
    } else if ("audioOffset" in entry) {
      const { audioOffset: start, duration: length } = entry;
      told = [entry.text, seconds(start, TICKS), isNumber(start) && isNumber(length) ? (start + length) / TICKS : null];
    } else {
      told = [entry.word ?? entry.text ?? entry.character, entry.start, entry.end];
    }
  } else if (named) {
    return false;
  }
  if (!Array.isArray(told) || told.length < 2 || told.length > 3 || typeof told[0] !== "string") return false;
  const [text, start, end = null] = told;
  if (!isNumber(start) || !(end === null || isNumber(end))) return false;
  out.push(new SpokenWord(text, start, end));
  return true;
}

/** Add the visemes an entry tells; return whether it tells any. */
function addMark(entry, out) {
  let told = entry;
  if (isRecord(entry)) {
    if ((entry.type ?? "viseme") !== "viseme") return false;
    if ("type" in entry) told = [seconds(entry.time, THOUSAND), entry.value];
    else if ("audioOffset" in entry) told = [seconds(entry.audioOffset, TICKS), entry.visemeId];
    else if (isRecord(entry.weights)) return Object.entries(entry.weights).every((pair) => addMark([entry.time, ...pair], out));
    else told = [entry.time, entry.viseme ?? entry.id, entry.weight ?? 1];
  }
  if (!Array.isArray(told) || told.length < 2 || told.length > 3 || !isNumber(told[0])) return false;
  const [at, id, weight = 1] = told;
  const name = Number.isInteger(id) ? String(id) : id;
  if (typeof name !== "string" || !isNumber(weight)) return false;
  out.push(new VisemeMark(at, name, weight));
  return true;
}
