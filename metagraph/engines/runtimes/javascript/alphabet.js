/** What is known of letters: their plain forms and what kind of character they are, as Unicode has it. */

// Digits, also raised, lowered and circled ones, and letters of scripts that have no small ones.
const SYLLABIC = /[\p{Nd}\p{Lo}²³¹⁰⁴-⁹₀-₉①-⑨⑴-⑼⒈-⒐⓪⓵-⓽⓿❶-❾➀-➈➊-➒፩-፱]/u;

export class Alphabet {
  /** Return a text's code points, a text each. @param {string} text @returns {string[]} */
  letters(text) {
    return [...text];
  }

  /** Return a text without blanks at its ends. @param {string} text */
  stripped(text) {
    return text.replace(/^[\s\x1c-\x1f\x85]+|[\s\x1c-\x1f\x85]+$/g, "");
  }

  /** Return a word in small letters without accents, a letter each. @param {string} word @returns {string[]} */
  plain(word) {
    // Capitals first: that spells out ß and ligatures, as folding case does, but must spare the dotless i.
    const small = [...word].map((c) => (c === "ı" ? c : c.toUpperCase().toLowerCase())).join("");
    return [...small.normalize("NFD")].filter((c) => !combines(c));
  }

  /**
   * Return "syllable" for a digit and for a letter of a script without small ones, "letter" for others, "mark" for what combines with
   * the letter before it; "" for all else. @param {string} letter
   */
  kind(letter) {
    if (/[\p{L}\p{N}]/u.test(letter)) return SYLLABIC.test(letter) ? "syllable" : "letter";
    return combines(letter) ? "mark" : "";
  }

  /** Return a letter's code point. @param {string} letter */
  code(letter) {
    return letter.codePointAt(0);
  }

  /** Return 0..99, the same for the same word. @param {string} word */
  scatter(word) {
    return crc32(word) % 100;
  }
}

export const ALPHABET = new Alphabet();

/** Whether a mark is ordered after its letter (Unicode's combining class is not 0): only those change places with other marks. */
function combines(c) {
  if (!/\p{M}/u.test(c)) return false;
  const [first, last] = ["\u0334", "\u0345"]; // of the lowest class and the highest
  return c === first || c === last || (c + first).normalize("NFD")[0] === first || (last + c).normalize("NFD")[0] !== last;
}

/** The checksum that zip files use, of a text's UTF-8 bytes. */
function crc32(text) {
  let out = 0xffffffff;
  for (const byte of new TextEncoder().encode(text)) {
    out ^= byte;
    for (let bit = 0; bit < 8; bit++) out = (out >>> 1) ^ (out & 1 ? 0xedb88320 : 0);
  }
  return (out ^ 0xffffffff) >>> 0;
}
