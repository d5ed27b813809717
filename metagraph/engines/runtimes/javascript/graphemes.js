/**
 * From letters to mouth shapes: what a mouth does if a line has neither sound nor phones.
 *
 * A few rules read English spelling. Other alphabets are read by their vowels. Unknown letters open and shut the mouth in
 * turn.
 *
 * Translated from metagraph/playback/life/graphemes.py; change that, and translate anew.
 */

import { MouthPiece, VOWELS } from "./mouth.js";
import { modulo, sum } from "./basics.js";

export const PACE = 14; // characters a second: about 150 words a minute
export const SHORTEST = 0.4; // seconds
// Values: shapes in turn. The longest spelling that fits is taken.
const _SPELLINGS = new Map([
  ["tion", ["CH", "nn"]],
  ["sch", ["CH"]],
  ["tch", ["CH"]],
  ["igh", ["aa", "I"]],
  ["eau", ["O"]],
  ["ough", ["O"]],
  ["th", ["TH"]],
  ["sh", ["CH"]],
  ["ch", ["CH"]],
  ["ph", ["FF"]],
  ["ck", ["kk"]],
  ["ng", ["nn"]],
  ["qu", ["kk", "U"]],
  ["wh", ["U"]],
  ["oo", ["U"]],
  ["ou", ["aa", "U"]],
  ["ow", ["O", "U"]],
  ["ee", ["I"]],
  ["ea", ["I"]],
  ["ai", ["E", "I"]],
  ["ay", ["E", "I"]],
  ["oi", ["O", "I"]],
  ["oy", ["O", "I"]],
  ["au", ["O"]],
  ["aw", ["O"]],
  ["ie", ["I"]],
  ["ei", ["E", "I"]],
  ["ue", ["U"]],
  ["oa", ["O"]],
  ["a", ["aa"]],
  ["e", ["E"]],
  ["i", ["I"]],
  ["o", ["O"]],
  ["u", ["U"]],
  ["y", ["I"]],
  ["ø", ["U"]],
  ["œ", ["U"]],
  ["æ", ["E"]],
  ["ı", ["I"]],
  ["b", ["PP"]],
  ["p", ["PP"]],
  ["m", ["PP"]],
  ["f", ["FF"]],
  ["v", ["FF"]],
  ["d", ["DD"]],
  ["t", ["DD"]],
  ["l", ["nn"]],
  ["n", ["nn"]],
  ["k", ["kk"]],
  ["g", ["kk"]],
  ["c", ["kk"]],
  ["q", ["kk"]],
  ["x", ["kk", "SS"]],
  ["h", ["kk"]],
  ["j", ["CH"]],
  ["s", ["SS"]],
  ["z", ["SS"]],
  ["r", ["RR"]],
  ["w", ["U"]],
  ["ß", ["SS"]],
  ["ð", ["TH"]],
  ["þ", ["TH"]],
  ["ł", ["nn"]],
  ["đ", ["DD"]],
]);
// Greek and Cyrillic letters, and the Latin ones they stand for.
const _ALIKE = new Map([
  ["α", "a"],
  ["ε", "e"],
  ["η", "e"],
  ["ι", "i"],
  ["ο", "o"],
  ["υ", "y"],
  ["ω", "o"],
  ["β", "b"],
  ["π", "p"],
  ["μ", "m"],
  ["φ", "f"],
  ["δ", "d"],
  ["τ", "t"],
  ["λ", "l"],
  ["ν", "n"],
  ["κ", "k"],
  ["γ", "g"],
  ["χ", "h"],
  ["ξ", "x"],
  ["σ", "s"],
  ["ς", "s"],
  ["ζ", "z"],
  ["ρ", "r"],
  ["θ", "þ"],
  ["а", "a"],
  ["б", "b"],
  ["в", "v"],
  ["г", "g"],
  ["д", "d"],
  ["е", "e"],
  ["ё", "e"],
  ["ж", "j"],
  ["з", "z"],
  ["и", "i"],
  ["й", "j"],
  ["к", "k"],
  ["л", "l"],
  ["м", "m"],
  ["н", "n"],
  ["о", "o"],
  ["п", "p"],
  ["р", "r"],
  ["с", "s"],
  ["т", "t"],
  ["у", "u"],
  ["ф", "f"],
  ["х", "h"],
  ["ц", "s"],
  ["ч", "j"],
  ["ш", "j"],
  ["щ", "j"],
  ["ы", "i"],
  ["э", "e"],
  ["ю", "u"],
  ["я", "a"],
  ["і", "i"],
  ["є", "e"],
  ["ї", "i"],
]);
const _CONSONANTS = ["DD", "nn", "SS", "kk", "PP"]; // of syllables nobody knows
const _VOWEL_LENGTH = 1.25; // of one character's time
const _CONSONANT_LENGTH = 0.8;
const _STOPS = new Map([
  [",", 1.5],
  [";", 2],
  [":", 2],
  [".", 3],
  ["!", 3],
  ["?", 3],
  ["…", 3],
  ["-", 0.3],
  ["–", 1.5],
  ["—", 1.5],
  ["(", 1],
  [")", 1],
  ["，", 1.5],
  ["、", 1.5],
  ["。", 3],
  ["！", 3],
  ["？", 3],
]);
const _BLANK = 0.35; // characters' time of anything else between words

/**
 * Letters that are syllables, by their code points. size: characters' time of one.
 *
 * first: number; last: number; size: number.
 */
export class Syllabary {
  constructor(first, last, size) {
    this.first = first;
    this.last = last;
    this.size = size;
  }
}
const _SYLLABARIES = [
  new Syllabary(12353, 12543, 2),
  new Syllabary(65382, 65437, 2),
  new Syllabary(13312, 40959, 3),
  new Syllabary(63744, 64255, 3),
  new Syllabary(131072, 205743, 3),
  new Syllabary(44032, 55203, 3),
];

/**
 * Return the mouth shapes of a word's letters, in turn.
 * @param {Alphabet} alphabet
 * @param {string} word
 * @returns {string[]}
 */
export function shapes(alphabet, word) {
  const out = [];
  const letters = alphabet.plain(word).map((c) => _ALIKE.get(c) ?? c);
  let at = 0;
  while (at < letters.length) {
    let size = Math.min(4, letters.length - at);
    while (size > 1 && !_SPELLINGS.has(letters.slice(at, at + size).join(""))) {
      size -= 1;
    }
    const spelling = letters.slice(at, at + size).join("");
    const found = _SPELLINGS.has(spelling) ? _SPELLINGS.get(spelling) : _unknown(alphabet, spelling, out);
    const last = at === letters.length - 1;
    const finalE = spelling === "e" && last && out.length > 1 && out.some((s) => VOWELS.includes(s));
    const twice = at > 0 && size === 1 && letters[at] === letters[at - 1];
    if (found.length > 0 && !finalE && !(twice && !VOWELS.includes(found[0]))) {
      out.push(...found);
    }
    at += size;
  }
  return out;
}

/**
 * @param {Alphabet} alphabet
 * @param {string} letter
 * @param {string[]} before
 * @returns {string[]}
 */
function _unknown(alphabet, letter, before) {
  const kind = alphabet.kind(letter);
  if (kind === "syllable") {
    const code = alphabet.code(letter);
    return [_CONSONANTS[modulo(code, 5)], VOWELS[modulo(Math.floor(code / 5), 5)]];
  }
  if (kind === "letter") {
    return (before.length > 0 && !VOWELS.includes(before[before.length - 1])) ? ["aa"] : ["DD"];
  }
  return [];
}

/**
 * Return each word, and the pause after it, measured in characters.
 * @param {Alphabet} alphabet
 * @param {string} text
 * @returns {[string, number][]}
 */
export function splitWords(alphabet, text) {
  const out = [];
  let word = "";
  let pause = 0;
  for (const c of alphabet.letters(text)) {
    if (alphabet.kind(c) !== "" || c === "'" || c === "’") {
      if (pause > 0) {
        out.push([word, pause]);
        word = "";
        pause = 0;
      }
      word += c;
    } else {
      pause += _STOPS.get(c) ?? _BLANK;
    }
  }
  if (word !== "" || pause > 0) {
    out.push([word, pause]);
  }
  return out;
}

/**
 * A sound of a text. shape: "" for a pause. size: characters' time. strength: of a syllable, 0 for anything else.
 *
 * shape: string; size: number; strength: number.
 */
export class SpelledSound {
  constructor(shape, size, strength = 0) {
    this.shape = shape;
    this.size = size;
    this.strength = strength;
  }
}

/**
 * Return a word's sounds, in turn.
 *
 * Content words are longer than the words between them. The first vowel usually has the stress.
 * @param {Alphabet} alphabet
 * @param {string} word
 * @returns {SpelledSound[]}
 */
export function sounds(alphabet, word) {
  const out = [];
  const found = shapes(alphabet, word);
  const weight = Math.min(1, 0.35 + 0.09 * alphabet.letters(word).length) - 0.1 * alphabet.scatter(word) / 100;
  let first = true;
  let before = "";
  for (const shape of found) {
    const vowel = VOWELS.includes(shape);
    const syllable = vowel && !VOWELS.includes(before);
    const strength = syllable ? (first ? weight : 0.6 * weight) : 0;
    first = first && !syllable;
    out.push(new SpelledSound(shape, vowel ? _VOWEL_LENGTH : _CONSONANT_LENGTH, strength));
    before = shape;
  }
  return out;
}

/**
 * Something said, timed by its letters: pieces in time, and times and strengths (0..1) of its syllables.
 *
 * pieces: MouthPiece[]; peaks: number[]; strengths: number[].
 */
export class Spelled {
  constructor(pieces = [], peaks = [], strengths = []) {
    this.pieces = pieces;
    this.peaks = peaks;
    this.strengths = strengths;
  }

  /** Add sounds that last from `start` to `end` seconds together. */
  add(plan, start, end) {
    let at = start;
    const scale = (end - start) / sum(plan.map((sound) => sound.size));
    for (const sound of plan) {
      const then = at + sound.size * scale;
      if (sound.shape !== "") {
        const fully = VOWELS.includes(sound.shape) ? Math.min(1, 0.7 + 0.4 * sound.strength) : 1;
        this.pieces.push(new MouthPiece(at, then, sound.shape, fully));
      }
      if (sound.strength > 0) {
        this.peaks.push(0.5 * (at + then));
        this.strengths.push(sound.strength);
      }
      at = then;
    }
  }
}

/**
 * Return how long a text takes to say, seconds.
 * @param {Alphabet} alphabet
 * @param {string} text
 * @returns {number}
 */
export function readAloud(alphabet, text) {
  const letters = alphabet.letters(alphabet.stripped(text));
  return Math.max(SHORTEST, sum(letters.map((letter) => measureLetter(alphabet.code(letter)))) / PACE);
}

/**
 * Return how long a letter takes, measured in characters, by its code point: a Chinese, Japanese or Korean one is a
 * syllable.
 * @param {number} code
 * @returns {number}
 */
export function measureLetter(code) {
  for (const script of _SYLLABARIES) {
    if (script.first <= code && code <= script.last) {
      return script.size;
    }
  }
  return 1;
}

/**
 * Return the sounds of a text that lasts `duration` seconds; none if it has no known letter.
 * @param {Alphabet} alphabet
 * @param {string} text
 * @param {number} duration
 * @returns {Spelled}
 */
export function spelled(alphabet, text, duration) {
  const out = new Spelled();
  const plan = [];
  for (const { 0: word, 1: pause } of splitWords(alphabet, alphabet.stripped(text))) {
    plan.push(...sounds(alphabet, word));
    if (pause > 0) {
      plan.push(new SpelledSound("", pause));
    }
  }
  if (duration >= 0.001 && plan.some((sound) => sound.shape !== "")) {
    const edge = Math.min(0.06, 0.1 * duration);
    out.add(plan, edge, duration - edge);
  }
  return out;
}
