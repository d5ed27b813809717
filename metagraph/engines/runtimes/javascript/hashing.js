/**
 * Thirty-two bits from texts: FNV-1a over their UTF-8 bytes, and MurmurHash3's finaliser.
 */

const OFFSET = 0x811c9dc5; // FNV-1a's, 32 bits
const PRIME = 0x01000193;
const UTF8 = new TextEncoder();

/** Scramble 32 bits: two rounds of shift-xor and odd multiplication (MurmurHash3's finaliser). @param {number} value */
export function mix(value) {
  value ^= value >>> 16;
  value = Math.imul(value, 0x85ebca6b);
  value ^= value >>> 13;
  value = Math.imul(value, 0xc2b2ae35);
  return (value ^ (value >>> 16)) >>> 0;
}

/** Take a word's UTF-8 bytes and the zero byte that closes it into a hash. @param {number} value @param {string} word */
export function absorb(value, word) {
  let plain = value;
  for (let n = 0; n < word.length; n++) {
    const code = word.charCodeAt(n);
    if (code > 127) return close(UTF8.encode(word).reduce((x, byte) => Math.imul(x ^ byte, PRIME), value));
    plain = Math.imul(plain ^ code, PRIME);
  }
  return close(plain);
}

/** A zero byte closes every word, so that "ab", "" and "a", "b" differ. */
function close(value) {
  return Math.imul(value, PRIME);
}

/** Return the hash before any word. @param {number} seed */
export function begun(seed) {
  return OFFSET ^ mix(seed);
}
