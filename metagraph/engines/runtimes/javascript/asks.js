/**
 * What can be asked of a character, as JSON: `do` says which ask it is; docs/agents/requests.md describes all of them. Times are seconds,
 * points metres in the character's space (Y up, the character looks along +Z).
 */

import { SETS } from "./line_timing.js";
import { MOODS } from "./mood.js";
import { LAYERS, MODES } from "./words.js";

const number = (low, high) => (x) => (Number.isFinite(x) && x >= low && x <= high ? "" : `should be a number from ${low} to ${high}`);
const text = (low, high) => (x) =>
  typeof x === "string" && x.length >= low && x.length <= high ? "" : `should be a text of ${low} to ${high} letters`;
const one = (words) => (x) => (words.includes(x) ? "" : `should be one of ${words.join(", ")}`);
const flag = (x) => (typeof x === "boolean" ? "" : "should be true or false");
const tags = (x) => (Array.isArray(x) && x.every((tag) => !text(0, 200)(tag)) ? "" : "should be a list of texts");
const point = (x) => (Array.isArray(x) && x.length === 3 && x.every((v) => !number(-1e6, 1e6)(v)) ? "" : "should be three numbers, metres");
const list = (most) => (x) => (Array.isArray(x) && x.length <= most ? "" : `should be a list of at most ${most} entries`);
const whole = (low, high) => (x) => (Number.isInteger(x) ? number(low, high)(x) : "should be a whole number");
const either = (a, b) => (x) => a(x) && b(x);
const seconds = number(0, 1e6);
const name = text(1, 200);

// field: [default, check]; null is allowed where it is the default, and a field without default must be there
const COMMON = { id: ["", text(0, 200)], at: [null, seconds], told: [null, seconds], priority: [1, whole(-1000, 1000)] };
const LAYER = ["arms", one(LAYERS)];
const ANY_LAYER = [null, one(LAYERS)];
const TAGS = [[], tags];
const LIMB = [null, one(["left", "right", "both"])];
const HOLD = [null, number(0, 600)];
const LATE = [null, number(0, 600)];
const pair = (x) => (Array.isArray(x) && x.length === 2 && x.every((v) => !number(-1, 1)(v)) ? "" : "should be valence and arousal, -1 to 1");
const MOOD = { mood: [null, either(one([...MOODS.keys()]), pair)], intensity: [null, number(0, 2)] };
const FIELDS = {
  gesture: {
    layer: LAYER, tags: TAGS, limb: LIMB, duration: [null, seconds], stroke: [null, seconds], hold: HOLD, prepare: [true, flag],
    resume: [false, flag], late: LATE, ...MOOD,
  },
  fidget: { layer: LAYER, tags: TAGS, limb: LIMB, duration: [null, seconds], resume: [false, flag], late: LATE, ...MOOD },
  action: {
    action: [undefined, name], layer: ANY_LAYER, duration: [null, seconds], stroke: [null, seconds], hold: HOLD, prepare: [true, flag],
    late: LATE, ...MOOD,
  },
  stance: { stance: [undefined, name], layer: ANY_LAYER, stay: [false, flag], late: LATE },
  change: { layer: LAYER, limb: LIMB, duration: [null, seconds], late: LATE },
  nod: { tags: TAGS, late: LATE, ...MOOD },
  shake: { tags: TAGS, late: LATE, ...MOOD },
  look: { to: ["user", either(name, point)], duration: [null, seconds], amount: [1, number(0, 1)], strict: [false, flag] },
  blink: {},
  say: {
    line: [null, either(name, whole(-1e15, 1e15))], text: ["", text(0, 20000)], duration: [null, seconds], gestures: [true, flag],
    words: [[], list(4000)], visemes: [[], list(20000)], characters: [[], list(20000)], more: [false, flag], set: [null, one(SETS)],
    ...MOOD,
  },
  mode: { mode: [null, one(MODES)] },
  mood: { ...MOOD, duration: [null, seconds] },
  place: { name: [undefined, name], point: [undefined, point] },
  withdraw: { what: ["", text(0, 200)] },
  interrupt: { what: ["", text(0, 200)] },
  pause: { what: ["", text(0, 200)] },
  resume: { what: ["", text(0, 200)] },
  finish: { what: ["", text(0, 200)] },
  bml: { bml: [undefined, text(0, 200000)] },
};

/** What `do` may be; blocks of BML are read by the desktop alone. */
export const WORDS = Object.keys(FIELDS).filter((word) => word !== "bml");

/**
 * Return the ask that plain data says, with every field, or why it cannot be read.
 * @param {unknown} data @returns {{ask: ?object, why: string}}
 */
export function readAsk(data) {
  const refuse = (why) => ({ ask: null, why });
  if (typeof data !== "object" || data === null || Array.isArray(data)) return refuse("a request should be an object");
  if (typeof data.do !== "string" || !Object.hasOwn(FIELDS, data.do)) {
    return refuse(`do: nothing is known of '${String(data.do)}'; known are ${Object.keys(FIELDS).join(", ")}`);
  }
  const fields = { ...COMMON, ...FIELDS[data.do] };
  const strange = Object.keys(data).find((key) => key !== "do" && !Object.hasOwn(fields, key));
  if (strange !== undefined) return refuse(`${strange}: '${data.do}' has no such field`);
  const ask = { do: data.do };
  for (const [field, [usual, check]] of Object.entries(fields)) {
    const value = data[field] === undefined ? usual : data[field];
    if (value === undefined) return refuse(`${field}: is missing`);
    const wrong = value === null && usual === null ? "" : check(value);
    if (wrong) return refuse(`${field}: ${wrong}`);
    ask[field] = value;
  }
  return { ask, why: "" };
}
