/**
 * Gestures that go with words, from the words alone: greetings, denial, doubt, contrast, lists, persons and places,
 * emphasis, and a beat where there is none of these.
 *
 * After the idea of BEAT (Cassell, Vilhjalmsson and Bickmore, 2001): a text's words propose gestures by rules and a lexicon
 * that anybody can edit, and the weaker ones of those that would collide are left out. A gesture with a meaning precedes its
 * word by more than a beat does (ter Bekke et al. 2024: its stroke by some 0.2 s). All other numbers are ours. Times are
 * seconds from where the text begins.
 *
 * Translated from metagraph/speech/word_gestures.py; change that, and translate anew.
 */

import { readAloud } from "./graphemes.js";
import { uniform } from "./choice.js";
import { sortedBy, splitWords } from "./basics.js";

export const APART = new Map([["arms", 2.4], ["head", 1.8]]); // seconds between two strokes of a layer, at least
export const AGAIN = 1.6; // and so many times as far where both are of the same tag
export const LATE = 0.35; // seconds that a stroke may come after its word; later than that none is made
export const FIRST = 1.4; // seconds into a text up to which a stroke may come late: a hand needs as long to get there
export const PLAIN = 0.55; // of the clauses that propose nothing, how many get a beat
export const LEAD = 0.1; // seconds that a stroke comes before the middle of its word's vowels
export const MEANING_LEAD = 0.2; // the same of a gesture that means something
export const BEATS = ["beat", "emphasis", "explain", "open"]; // tags of gestures that go with any word
export const NOD = 0.3; // seconds from where a nod begins to its first stroke
export const CLAUSE = 3; // words of a clause that gets a beat, at least
export const LONGEST = 20000; // letters of a text
export const ENDS = ".?!…。？！";
export const PAUSES = ",;:–—、，";
export const INSIDE = "'’-"; // what a word may have in the middle
export const CLOSING = "\"')”»"; // what may stand between a word and the mark behind it

/**
 * A gesture that some words propose. words: small letters; several in a row for a phrase. tags: of a gesture of the arms,
 * the best first; the first one that the character has counts. head: its movement at the same time: "nod", "shake" or
 * nothing. strength: the stronger of two rules wins.
 *
 * words: string[]; tags: string[]; head: string; strength: number.
 */
export class GestureRule {
  constructor(words = [], tags = [], head = "", strength = 1) {
    this.words = words;
    this.tags = tags;
    this.head = head;
    this.strength = strength;
  }
}

/**
 * A lexicon. question, exclamation: proposed at the end of a sentence, for its last content word. clause: proposed for a
 * clause without other proposals.
 *
 * rules: GestureRule[]; language: string; question: GestureRule; exclamation: GestureRule; clause: GestureRule.
 */
export class GestureWords {
  constructor(
    rules,
    language = "en",
    question = new GestureRule(),
    exclamation = new GestureRule(),
    clause = new GestureRule(),
  ) {
    this.rules = rules;
    this.language = language;
    this.question = question;
    this.exclamation = exclamation;
    this.clause = clause;
  }
}

/**
 * A word of a text. plain: in small letters. mark: the punctuation after it.
 *
 * text: string; plain: string; start: number; end: number; mark: string.
 */
export class TextWord {
  constructor(text, plain, start, end, mark = "") {
    this.text = text;
    this.plain = plain;
    this.start = start;
    this.end = end;
    this.mark = mark;
  }
}

/**
 * A word with the times at which a synthesiser says it.
 *
 * start: number; end: number.
 */
export class ToldWord {
  constructor(start, end) {
    this.start = start;
    this.end = end;
  }
}

/**
 * A gesture that goes with a word. do: "gesture", "nod" or "shake". at: time of its stroke. tags: empty for gestures of the
 * head.
 *
 * layer: string; at: number; tags: string[]; strength: number; word: string; do: string.
 */
export class ProposedGesture {
  constructor(layer, at, tags, strength, word, do_ = "gesture") {
    this.layer = layer;
    this.at = at;
    this.tags = tags;
    this.strength = strength;
    this.word = word;
    this.do = do_;
  }
}

/**
 * The request for a gesture. at: the earliest second of the session at which it may begin. stroke: the time of its stroke,
 * None for the head. late: by how many seconds it may come late.
 *
 * do: string; layer: string; tags: string[]; at: number; stroke: ?number; late: number.
 */
export class GestureAsk {
  constructor(do_, layer, tags, at, stroke, late) {
    this.do = do_;
    this.layer = layer;
    this.tags = tags;
    this.at = at;
    this.stroke = stroke;
    this.late = late;
  }
}

/**
 * A word, the number of letters of the text up to its end, and the mark after it.
 *
 * text: string; end: number; mark: string.
 */
export class SplitWord {
  constructor(text, end, mark) {
    this.text = text;
    this.end = end;
    this.mark = mark;
  }
}

/**
 * Return a text's words with their times: those of a synthesiser, else as long as lips would take.
 *
 * told: the times of the words in order; words without times are left out. seconds: how long all of it takes, if only that
 * is known.
 * @param {Alphabet} alphabet
 * @param {string} text
 * @param {ToldWord[]} told
 * @param {?number} seconds
 * @returns {TextWord[]}
 */
export function wordsOf(alphabet, text, told = [], seconds = null) {
  const letters = alphabet.letters(text);
  let pace = 1;
  if (seconds !== null && told.length === 0) {
    pace = seconds / Math.max(0.001, readAloud(alphabet, text));
  }
  const out = [];
  for (const split of _split(alphabet, letters.slice(0, LONGEST))) {
    const small = alphabet.letters(split.text.toLowerCase());
    const plain = small.map((letter) => letter === "’" ? "'" : letter).join("");
    if (told.length > 0) {
      if (out.length === told.length) {
        break;
      }
      const times = told[out.length];
      out.push(new TextWord(split.text, plain, times.start, times.end, split.mark));
    } else {
      const stop = pace * readAloud(alphabet, letters.slice(0, split.end).join(""));
      const before = out.length > 0 ? out[out.length - 1].end : 0;
      const start = Math.max(before, stop - pace * readAloud(alphabet, split.text));
      out.push(new TextWord(split.text, plain, start, stop, split.mark));
    }
  }
  return out;
}

/**
 * @param {Alphabet} alphabet
 * @param {string} letter
 * @returns {boolean}
 */
function _isLetter(alphabet, letter) {
  const kind = alphabet.kind(letter);
  return kind === "syllable" || kind === "letter";
}

/**
 * Return whether letters contain words, so that there is something to say.
 * @param {Alphabet} alphabet
 * @param {string[]} letters
 * @returns {boolean}
 */
export function telling(alphabet, letters) {
  return letters.some((letter) => _isLetter(alphabet, letter));
}

/**
 * @param {Alphabet} alphabet
 * @param {string[]} letters
 * @returns {SplitWord[]}
 */
function _split(alphabet, letters) {
  const out = [];
  let at = 0;
  const count = letters.length;
  while (at < count) {
    if (!_isLetter(alphabet, letters[at])) {
      at += 1;
      continue;
    }
    const first = at;
    while (at < count) {
      let goesOn = _isLetter(alphabet, letters[at]);
      if (!goesOn && INSIDE.includes(letters[at]) && at + 1 < count) {
        goesOn = _isLetter(alphabet, letters[at + 1]);
      }
      if (!goesOn) {
        break;
      }
      at += 1;
    }
    let behind = at;
    while (behind < count && CLOSING.includes(letters[behind])) {
      behind += 1;
    }
    let mark = "";
    if (behind < count && (ENDS.includes(letters[behind]) || PAUSES.includes(letters[behind]))) {
      mark = letters[behind];
    }
    out.push(new SplitWord(letters.slice(first, at).join(""), at, mark));
  }
  return out;
}

/**
 * Return the gestures that go with words, in order and without collisions.
 *
 * arms: tags of the character's gestures of the arms; others are not proposed. head: whether the head moves. small: words
 * that say little by themselves.
 * @param {TextWord[]} words
 * @param {Set<string>} arms
 * @param {boolean} head
 * @param {GestureWords} lexicon
 * @param {Set<string>} small
 * @param {number} seed
 * @returns {ProposedGesture[]}
 */
export function proposedFor(words, arms, head, lexicon, small, seed) {
  const every = [];
  let clause = [];
  let proposes = false;
  for (const { 0: n, 1: word } of words.entries()) {
    clause.push(word);
    const { 0: rule, 1: length } = _fitting(lexicon, words, n);
    if (length > 0) {
      every.push(..._of(rule, words[n + length - 1], arms, head));
      proposes = true;
    }
    if (word.mark === "" && n + 1 < words.length) {
      continue;
    }
    const large = clause.filter((w) => !small.has(w.plain));
    const last = large.length > 0 ? large[large.length - 1] : clause[clause.length - 1];
    if (word.mark === "?" || word.mark === "？") {
      every.push(..._of(lexicon.question, last, arms, head));
    } else if (word.mark === "!" || word.mark === "！") {
      every.push(..._of(lexicon.exclamation, last, arms, head));
    } else if (!proposes && clause.length >= CLAUSE && uniform(seed, `${n}/${last.plain}`, "beat") < PLAIN) {
      every.push(..._of(lexicon.clause, last, arms, head));
    }
    clause = [];
    proposes = false;
  }
  const kept = _spaced(every);
  return sortedBy(kept, (one) => one.at);
}

/**
 * Return the rule with the longest phrase that begins at a word, and the number of its words; 0 if there is none.
 * @param {GestureWords} lexicon
 * @param {TextWord[]} words
 * @param {number} n
 * @returns {[GestureRule, number]}
 */
function _fitting(lexicon, words, n) {
  let best = lexicon.clause;
  let longest = 0;
  for (const rule of lexicon.rules) {
    for (const phrase of rule.words) {
      const parts = splitWords(phrase);
      if (parts.length > longest && _says(words, n, parts)) {
        best = rule;
        longest = parts.length;
      }
    }
  }
  return [best, longest];
}

/**
 * Return whether a phrase begins at a word, without a pause inside it.
 * @param {TextWord[]} words
 * @param {number} first
 * @param {string[]} parts
 * @returns {boolean}
 */
function _says(words, first, parts) {
  if (first + parts.length > words.length) {
    return false;
  }
  for (const { 0: k, 1: part } of parts.entries()) {
    if (words[first + k].plain !== part || (k + 1 < parts.length && words[first + k].mark !== "")) {
      return false;
    }
  }
  return true;
}

/**
 * @param {GestureRule} rule
 * @param {TextWord} word
 * @param {Set<string>} arms
 * @param {boolean} head
 * @returns {ProposedGesture[]}
 */
function _of(rule, word, arms, head) {
  const at = Math.max(0, (word.start + word.end) / 2 - LEAD);
  const out = [];
  for (const tag of rule.tags) {
    if (arms.has(tag)) {
      const early = BEATS.includes(tag) ? 0 : MEANING_LEAD - LEAD;
      out.push(new ProposedGesture("arms", Math.max(0, at - early), [tag], rule.strength, word.text));
      break;
    }
  }
  if (rule.head !== "" && head) {
    out.push(new ProposedGesture("head", at, [], rule.strength, word.text, rule.head));
  }
  return out;
}

/**
 * Leave out gestures that are too near to a stronger one of their layer; of two equal ones the earlier stays. The same tag
 * twice in a row needs more room.
 * @param {ProposedGesture[]} every
 * @returns {ProposedGesture[]}
 */
function _spaced(every) {
  const kept = [];
  for (const one of sortedBy(every, (one) => [-one.strength, one.at])) {
    if (!kept.some((other) => _inTheWay(one, other))) {
      kept.push(one);
    }
  }
  return kept;
}

/**
 * @param {ProposedGesture} one
 * @param {ProposedGesture} other
 * @returns {boolean}
 */
function _inTheWay(one, other) {
  if (one.layer !== other.layer) {
    return false;
  }
  let room = APART.get(one.layer);
  if (one.tags.length === 0 || (other.tags.length > 0 && one.tags[0] === other.tags[0])) {
    room *= AGAIN;
  }
  return Math.abs(one.at - other.at) < room;
}

/**
 * Return the requests for the gestures of a text that begins at `at` seconds of the session. Gestures that cannot be in time
 * are refused, not made late.
 * @param {ProposedGesture[]} every
 * @param {number} at
 * @returns {GestureAsk[]}
 */
export function gestureAsks(every, at) {
  const out = [];
  for (const one of every) {
    const late = Math.max(LATE, FIRST - one.at);
    if (one.do === "gesture") {
      out.push(new GestureAsk(one.do, one.layer, one.tags, at, at + one.at, late));
    } else {
      out.push(new GestureAsk(one.do, one.layer, [], at + Math.max(0, one.at - NOD), null, late));
    }
  }
  return out;
}

/**
 * Return the number of letters after which the first sentence of a text ends, 0 if it goes on. over: whether the text is
 * complete.
 * @param {Alphabet} alphabet
 * @param {string[]} letters
 * @param {boolean} over
 * @returns {number}
 */
export function sentenceEnd(alphabet, letters, over) {
  let some = false;
  for (const { 0: n, 1: letter } of letters.entries()) {
    const blank = alphabet.stripped(letter) === "";
    if (letter === "\n" && some) {
      return n + 1;
    }
    // An end is one once something else follows: "3." may become "3.5".
    if (ENDS.includes(letter)
      && n + 1 < letters.length
      && ("。？！".includes(letter) || alphabet.stripped(letters[n + 1]) === "")) {
      return n + 1;
    }
    some = some || !blank;
  }
  return (over && some) ? letters.length : 0;
}
