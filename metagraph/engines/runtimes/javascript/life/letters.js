/**
 * From letters to mouth shapes: what a mouth may do when neither sound nor phones of a line are there. English spelling is read by
 * a few rules; other alphabets by their vowels, what is unknown by turns of open and shut.
 */

const PACE = 14; // characters a second: about 150 words a minute
const SHORTEST = 0.4; // seconds

// Shapes in turn; the longest spelling that fits is taken.
const SPELLINGS = read(`
  tion CH nn, sch CH, tch CH, igh aa I, eau O, ough O, th TH, sh CH, ch CH, ph FF, ck kk, ng nn, qu kk U, wh U, oo U, ou aa U, ow O U,
  ee I, ea I, ai E I, ay E I, oi O I, oy O I, au O, aw O, ie I, ei E I, ue U, oa O,
  a aa, e E, i I, o O, u U, y I, ø U, œ U, æ E, ı I, b PP, p PP, m PP, f FF, v FF, d DD, t DD, l nn, n nn, k kk, g kk, c kk, q kk, x kk SS,
  h kk, j CH, s SS, z SS, r RR, w U, ß SS, ð TH, þ TH, ł nn, đ DD`);
// Greek and Cyrillic letters that stand for the Latin ones.
const ALIKE = new Map(
  ["αa εe ηe ιi οo υy ωo βb πp μm φf δd τt λl νn κk γg χh ξx σs ςs ζz ρr θþ",
    "аa бb вv гg дd еe ёe жj зz иi йj кk лl мm нn оo пp рr сs тt уu фf хh цs чj шj щj ыi эe юu яa іi єe їi"]
    .join(" ").split(" ").map((pair) => [pair[0], pair[1]]),
);
const VOWELS = new Set(["aa", "E", "I", "O", "U"]);
const [VOWEL_LENGTH, CONSONANT_LENGTH] = [1.25, 0.8]; // of one character's time
const STOPS = { ",": 1.5, ";": 2, ":": 2, ".": 3, "!": 3, "?": 3, "…": 3, "-": 0.3, "–": 1.5, "—": 1.5, "(": 1, ")": 1 };
const PAUSE = 0.35; // after anything else between words

function read(text) {
  return new Map(text.split(",").map((entry) => entry.trim().split(" ")).map(([letters, ...shapes]) => [letters, shapes]));
}

/** Return the mouth shapes of a word's letters, in turn. @param {string} word @returns {string[]} */
function shapes(word) {
  const out = [];
  const letters = plain(word).map((c) => ALIKE.get(c) ?? c);
  for (let at = 0, size; at < letters.length; at += size) {
    size = [4, 3, 2, 1].find((n) => at + n <= letters.length && SPELLINGS.has(letters.slice(at, at + n).join(""))) ?? 0;
    const found = size ? SPELLINGS.get(letters.slice(at, at + size).join("")) : unknown(letters[at], out);
    size ||= 1;
    const silentE = letters[at] === "e" && size === 1 && at === letters.length - 1 && out.length > 1 && out.some((s) => VOWELS.has(s));
    const doubled = at > 0 && letters[at] === letters[at - 1] && size === 1 && !VOWELS.has(found[0]);
    if (found.length && !silentE && !doubled) out.push(...found);
  }
  return out;
}

/** Small letters without accents, one by one. */
function plain(word) {
  // Capitals first: that spells out ß and ligatures, as folding case does, but must spare the dotless i.
  const small = [...word].map((c) => (c === "ı" ? c : c.toUpperCase().toLowerCase())).join("");
  return [...small.normalize("NFD")].filter((c) => !combines(c));
}

/** Whether a mark is ordered after its letter (Unicode's combining class is not 0): only those change places with other marks. */
function combines(c) {
  if (!/\p{M}/u.test(c)) return false;
  const [first, last] = ["\u0334", "\u0345"]; // of the lowest class and the highest
  return c === first || c === last || (c + first).normalize("NFD")[0] === first || (last + c).normalize("NFD")[0] !== last;
}

function unknown(letter, before) {
  if (!isWord(letter)) return [];
  if (SYLLABIC.test(letter)) {
    const code = letter.codePointAt(0); // a syllable each
    return [["DD", "nn", "SS", "kk", "PP"][code % 5], ["aa", "E", "I", "O", "U"][Math.floor(code / 5) % 5]];
  }
  return before.length && !VOWELS.has(before[before.length - 1]) ? ["aa"] : ["DD"];
}

// Digits, also raised, lowered and circled ones, and letters of scripts that have no small ones.
const SYLLABIC = /[\p{Nd}\p{Lo}²³¹⁰⁴-⁹₀-₉①-⑨⑴-⑼⒈-⒐⓪⓵-⓽⓿❶-❾➀-➈➊-➒፩-፱]/u;
const isWord = (c) => /[\p{L}\p{N}]/u.test(c);

/** Return [word, how many characters' time of pause follows it] for each word. */
function words(text) {
  const out = [];
  let [word, pause] = ["", 0];
  for (const c of text) {
    if (isWord(c) || c === "'" || c === "’" || combines(c)) {
      if (pause) {
        out.push([word, pause]);
        [word, pause] = ["", 0];
      }
      word += c;
    } else {
      pause += STOPS[c] ?? PAUSE;
    }
  }
  if (word || pause) out.push([word, pause]);
  return out;
}

/**
 * Return a text's pieces (`start`, `end` seconds, `viseme`, `strength` 0..1), the times and strengths (0..1) of its syllables, and its
 * length in seconds. duration: how long it takes, null for `PACE` characters a second.
 * @param {string} text @param {?number} duration
 */
export function spelled(text, duration) {
  const stripped = strip(text);
  const length = duration === null ? Math.max(SHORTEST, [...stripped].length / PACE) : Math.max(duration, 0);
  const plan = []; // shape, or null for a pause; characters' time; strength of a syllable
  for (const [word, pause] of words(stripped)) {
    const found = shapes(word);
    // Content words are longer than the words between them; the first vowel bears the stress more often than not.
    const weight = Math.min(1, 0.35 + 0.09 * [...word].length) - (0.1 * (crc32(word) % 100)) / 100;
    let first = true;
    found.forEach((shape, n) => {
      const vowel = VOWELS.has(shape);
      const syllable = vowel && (n === 0 || !VOWELS.has(found[n - 1]));
      plan.push({ shape, size: vowel ? VOWEL_LENGTH : CONSONANT_LENGTH, strength: syllable ? (first ? weight : 0.6 * weight) : 0 });
      first &&= !syllable;
    });
    if (pause) plan.push({ shape: null, size: pause, strength: 0 });
  }
  const out = { pieces: [], peaks: [], strengths: [], length };
  if (!plan.some(({ shape }) => shape) || length < 1e-3) return out;
  const edge = Math.min(0.06, 0.1 * length);
  const scale = (length - 2 * edge) / plan.reduce((sum, { size }) => sum + size, 0);
  let at = edge;
  for (const { shape, size, strength } of plan) {
    const end = at + size * scale;
    if (shape) out.pieces.push({ start: at, end, viseme: shape, strength: VOWELS.has(shape) ? Math.min(1, 0.7 + 0.4 * strength) : 1 });
    if (strength > 0) {
      out.peaks.push(0.5 * (at + end));
      out.strengths.push(strength);
    }
    at = end;
  }
  return out;
}

/** Return a text without blanks at its ends. */
export const strip = (text) => text.replace(/^[\s\x1c-\x1f\x85]+|[\s\x1c-\x1f\x85]+$/g, "");

/** The checksum that zip files use, of a text's UTF-8 bytes. */
function crc32(text) {
  let out = 0xffffffff;
  for (const byte of new TextEncoder().encode(text)) {
    out ^= byte;
    for (let bit = 0; bit < 8; bit++) out = (out >>> 1) ^ (out & 1 ? 0xedb88320 : 0);
  }
  return (out ^ 0xffffffff) >>> 0;
}
