/** Text, whole or piece by piece, as speech with the gestures that go with its words. */

import { ALPHABET } from "./alphabet.js";
import { GESTURE_WORDS } from "./gesture_words.js";
import { readAloud } from "./graphemes.js";
import { GestureRule, GestureWords, ToldWord, gestureAsks, proposedFor, sentenceEnd, telling, wordsOf } from "./word_gestures.js";

const START = 0.35; // seconds before a text begins, so that a hand can be where its first stroke needs it
const BETWEEN = 0.25; // seconds between two sentences

/** What a character says. Times are seconds of the character's own time. */
export class Talk {
  /**
   * @param {import("./character.js").Character} character
   * @param {{language?: string, lexicon?: object, seed?: number, name?: string}} [options] lexicon: one of your own, as the files have them; without it
   * that of the language ("en", "de-AT"), English where there is none. name: what ids begin with.
   */
  constructor(character, { language = "en", lexicon, seed = 1, name = "talk" } = {}) {
    this.character = character;
    this.seed = seed >>> 0;
    this.name = name;
    Object.assign(this, lexiconOf(language, lexicon));
    const gestures = (layer) => [...character.graph.layers[layer].actions.values()].filter((action) => action.kind === "gesture");
    this.arms = new Set(gestures("arms").flatMap((action) => action.tags));
    this.head = gestures("head").some((action) => action.tags.length > 0);
    this.free = 0; // from when on nothing is said yet
    this.count = 0;
    this.text = ""; // what came in and is no whole sentence
  }

  /**
   * Say a text, with gestures on its words. Options are those of the request `say`; `words` that are told with starts and ends tell when
   * gestures come, else `duration`, else how long lips take. Where it cannot be understood, its answer says why. Returns the id of what is said and those of its gestures.
   * @param {string} text @param {object} [options] @returns {{id: string, gestures: string[]}}
   */
  say(text, options = {}) {
    this.count += 1;
    const id = options.id ?? `${this.name}${this.count}`;
    const at = options.at ?? this.character.now + (options.after ?? START);
    const { after: _, ...rest } = options;
    this.character.ask({ ...rest, do: "say", id, text, at });
    if (this.character.answer(id).state === "refused") return { id, gestures: [] };
    const told = times(options.words ?? []);
    this.free = at + (options.duration ?? told.at(-1)?.end ?? readAloud(ALPHABET, text)) + BETWEEN;
    const proposed = this.proposed(wordsOf(ALPHABET, text, told, options.duration ?? null));
    const gestures = gestureAsks(proposed, at).map(({ do: what, layer, tags, at: from, stroke, late }, n) => {
      const request = { do: what, id: `${id}/${n}`, at: from, late };
      return this.character.ask(stroke === null ? request : { ...request, layer, tags, stroke });
    });
    return { id, gestures };
  }

  /**
   * Break off all that is said, because the other speaks, and forget what came in and is not said yet. What is said next begins at once.
   * Returns the request's id.
   */
  interrupt() {
    this.text = "";
    this.free = 0;
    return this.character.ask({ do: "interrupt" });
  }

  /** Return the gestures that go with words. @param {import("./word_gestures.js").TextWord[]} words */
  proposed(words) {
    return proposedFor(words, this.arms, this.head, this.lexicon, this.small, (this.seed + this.count) >>> 0);
  }

  /**
   * Take in what comes next of a text, as a language model writes it: each sentence is said when it is whole, after the one before.
   * over: whether the text ends here. Returns what was said by it, as `say` does.
   * @param {string} piece @param {boolean} [over]
   */
  take(piece, over = false) {
    this.text += piece;
    const out = [];
    for (;;) {
      const letters = ALPHABET.letters(this.text);
      const end = sentenceEnd(ALPHABET, letters, over);
      if (end === 0) return out;
      const said = letters.slice(0, end).join("").trim();
      this.text = letters.slice(end).join("");
      if (telling(ALPHABET, letters.slice(0, end))) out.push(this.say(said, { at: Math.max(this.free, this.character.now + START) }));
    }
  }
}

/**
 * Return a language's lexicon and its words that say little by themselves. own: a lexicon as the files have them, instead.
 * @param {string} language @param {object} [own]
 */
export function lexiconOf(language, own) {
  const code = language.toLowerCase().split("-")[0];
  const known = GESTURE_WORDS[code] ?? GESTURE_WORDS.en;
  const { rules = [], question, exclamation, clause, small = known.small } = own ?? known;
  const lexicon = new GestureWords(rules.map(rule), code, rule(question), rule(exclamation), rule(clause));
  return { lexicon, small: new Set(small) };
}

/** @param {object | undefined} plain */
function rule({ words = [], tags = [], head = "", strength = 1 } = {}) {
  return new GestureRule(words, tags, head ?? "", strength);
}

/** Return words' times, as requests have them: [text, start, end] or { text, start, end }; none where an end is not told. */
function times(words) {
  const rows = words.map((word) => (Array.isArray(word) ? word.slice(1) : [word.start, word.end]));
  return rows.every((row) => row.length > 1 && row.every(Number.isFinite)) ? rows.map(([start, end]) => new ToldWord(start, end)) : [];
}
