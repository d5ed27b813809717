/** The words everything is told apart by, and the defaults an export leaves out. */

/** In the order in which layers' offsets are multiplied onto the base pose. */
export const LAYERS = ["body", "arms", "head"];
export const MODES = ["idle", "listening", "talking"];
export const VISEMES = ["sil", "PP", "FF", "TH", "DD", "kk", "CH", "SS", "nn", "RR", "aa", "E", "I", "O", "U"];
export const LIDS = ["upper_lid_left", "upper_lid_right", "lower_lid_left", "lower_lid_right"];
export const MOUTH = ["jaw_open", ...VISEMES.slice(1).map((v) => `viseme_${v}`)];
/** What a face is worked by, in the order of the rig's arrays. */
export const CHANNELS = [...LIDS, "blink", ...MOUTH];

/** The life layers' settings: the usual where the export says nothing, the least and the most; docs/format.md says what each means. */
const LIFE = {
  stillness: [0, 0, 1], breathing: [1, 0, 2], breath_rate: [14, 0, 40], gaze: [1, 0, 1], head_share: [0.6, 0, 1], aversion_rate: [12, 0, 40],
  aversion_length: [0.93, 0, 5], aversion_angle: [14, 0, 40], saccades: [1, 0, 2], saccade_rate: [60, 0, 180], lids: [1, 0, 2],
  blinks: [17, 0, 60], accent_blinks: [1, 0, 1], blink_close: [0.07, 0.02, 1], blink_open: [0.1, 0.02, 1], lips: [1, 0, 2],
  lip_smoothing: [0.03, 0, 0.2],
};
const FACTORS = [
  "breathing", "breath_rate", "aversion_rate", "aversion_length", "aversion_angle", "saccades", "saccade_rate", "blinks",
];
const MANNERS = {
  idle: { aversion_rate: 1.1, aversion_length: 2.4, aversion_angle: 1.4, saccade_rate: 0.85 },
  listening: { aversion_rate: 0.6, aversion_length: 0.46, aversion_angle: 0.8, saccades: 0.9 },
  talking: { breathing: 1.15, breath_rate: 1.1, aversion_rate: 1.25 },
};

/** Return the settings with what an export says of them; `manners`: what each mode makes of the amounts, factors from 0 to 4. */
export function readLife(data = {}) {
  const dials = Object.entries(LIFE).map(([name, [usual, low, high]]) => [name, inRange(data[name] ?? usual, low, high, `life.${name}`)]);
  const manner = (mode, own) => FACTORS.map((name) => [name, inRange(own[name] ?? 1, 0, 4, `life.modes.${mode}.${name}`)]);
  const manners = MODES.map((mode) => [mode, Object.fromEntries(manner(mode, data.modes?.[mode] ?? MANNERS[mode]))]);
  return { on: data.on ?? true, ...Object.fromEntries(dials), manners: Object.fromEntries(manners) };
}

/** Return a number of an export. Throws where it is none or out of range: what is planned from it might never end. */
export function inRange(value, low, high, where) {
  if (typeof value === "number" && value >= low && value <= high) return value;
  throw new Error(`${where} should be a number from ${low} to ${high}`);
}
