/** The words everything is told apart by. */

/** In the order in which layers' offsets are multiplied onto the base pose. */
export const LAYERS = ["body", "arms", "head"];
export const MODES = ["idle", "listening", "talking", "thinking", "reacting"];
export const VISEMES = ["sil", "PP", "FF", "TH", "DD", "kk", "CH", "SS", "nn", "RR", "aa", "E", "I", "O", "U"];
export const LIDS = ["upper_lid_left", "upper_lid_right", "lower_lid_left", "lower_lid_right"];
export const MOUTH = ["jaw_open", ...VISEMES.slice(1).map((v) => `viseme_${v}`)];
/** What a face is worked by, in the order of the rig's arrays. */
export const CHANNELS = [...LIDS, "blink", ...MOUTH];

/** Return a number of an export. Throws where it is none or out of range: what is planned from it might never end. */
export function inRange(value, low, high, where) {
  if (typeof value === "number" && value >= low && value <= high) return value;
  throw new Error(`${where} should be a number from ${low} to ${high}`);
}
