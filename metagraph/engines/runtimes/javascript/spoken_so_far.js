/**
 * The part of an utterance that was spoken until a moment, for the history from which a language model continues.
 *
 * Translated from metagraph/speech/spoken_so_far.py; change that, and translate anew.
 */

import { findLineStart, measureLine } from "./items.js";
import { SpokenWord } from "./line_timing.js";
import { isPaused } from "./utterances.js";
import { telling, wordsOf } from "./word_gestures.js";

/**
 * Return the part of an utterance that was spoken until `seconds`, up to the word that was begun, and that word; "" if
 * nothing was spoken. said: all speeches, by start.
 * @param {Alphabet} alphabet
 * @param {Speech[]} said
 * @param {string} ident
 * @param {number} seconds
 * @returns {[string, string]}
 */
export function spokenUntil(alphabet, said, ident, seconds) {
  let text = "";
  let last = "";
  let paced = false;
  const pieces = _pieces(said, ident, seconds);
  for (const { 0: n, 1: piece } of pieces.entries()) {
    const { 0: words, 1: word } = _spokenOf(alphabet, piece, Math.min(seconds, piece.end) - findLineStart(piece));
    const joins = paced && piece.timing !== null && piece.timing.paced;
    if (n > 0 && text !== "" && words !== "" && !joins) {
      text += " ";
    }
    text += words;
    last = word === "" ? last : word;
    paced = piece.timing !== null && piece.timing.paced;
  }
  return [alphabet.stripped(text), last];
}

/**
 * Return the pieces of the last utterance with an id; one that continues after a pause is one utterance.
 * @param {Speech[]} said
 * @param {string} ident
 * @param {number} seconds
 * @returns {Speech[]}
 */
function _pieces(said, ident, seconds) {
  let out = [];
  for (const piece of said) {
    if (piece.id !== ident || piece.start >= seconds || isPaused(piece.start)) {
      continue;
    }
    if (out.length > 0 && out[out.length - 1].asked !== piece.asked) {
      out = [];
    } else if (out.length > 0 && piece.skip > 0) {
      out.pop();
    }
    out.push(piece);
  }
  return out;
}

/**
 * Return the part of one piece that was spoken in its first `seconds`, and its last word.
 * @param {Alphabet} alphabet
 * @param {Speech} piece
 * @param {number} seconds
 * @returns {[string, string]}
 */
function _spokenOf(alphabet, piece, seconds) {
  const letters = alphabet.letters(piece.text);
  let words = [];
  if (piece.timing !== null && piece.timing.words.length > 0) {
    words = [...piece.timing.words];
  } else if (piece.timing === null || !piece.timing.paced) {
    words = wordsOf(alphabet, piece.text, [], measureLine(piece)).map((w) => new SpokenWord(w.text, w.start));
  }
  const begun = words.filter((word) => word.start < seconds).map((word) => word.text);
  if (begun.length === 0) {
    const silent = piece.timing !== null && piece.timing.paced && words.length === 0;
    return [silent ? piece.text : "", ""];
  }
  let end = 0;
  for (const word of begun) {
    end = _endOfLetters(letters, alphabet.letters(word), end);
    if (end < 0) { // the text says it otherwise
      return [begun.join(" "), begun[begun.length - 1]];
    }
  }
  let stop = end;
  while (stop < letters.length && !_parts(alphabet, letters[stop])) {
    stop += 1;
  }
  let first = end;
  while (first > 0 && alphabet.stripped(letters[first - 1]) !== "") {
    first -= 1;
  }
  if (begun.length === words.length && piece.timing !== null && piece.timing.paced) {
    stop = letters.length;
  }
  const whole = wordsOf(alphabet, letters.slice(first, end).join(""));
  return [letters.slice(0, stop).join(""), whole.length > 0 ? whole[whole.length - 1].text : begun[begun.length - 1]];
}

/**
 * Return whether a letter after a word is not a mark that belongs to it.
 * @param {Alphabet} alphabet
 * @param {string} letter
 * @returns {boolean}
 */
function _parts(alphabet, letter) {
  return alphabet.stripped(letter) === "" || telling(alphabet, [letter]);
}

/**
 * Return the index after a word in a text, searching from `first`; -1 if it is not there.
 * @param {string[]} letters
 * @param {string[]} word
 * @param {number} first
 * @returns {number}
 */
function _endOfLetters(letters, word, first) {
  for (let start = first; start < letters.length - word.length + 1; start++) {
    if ([...word.entries()].every(({ 0: n, 1: letter }) => letters[start + n] === letter)) {
      return start + word.length;
    }
  }
  return -1;
}
