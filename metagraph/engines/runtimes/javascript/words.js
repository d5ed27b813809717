/** The words everything is told apart by, and the defaults an export leaves out. */

/** In the order in which layers' offsets are multiplied onto the base pose. */
export const LAYERS = ["body", "arms", "head"];
export const MODES = ["idle", "listening", "talking"];
export const VISEMES = ["sil", "PP", "FF", "TH", "DD", "kk", "CH", "SS", "nn", "RR", "aa", "E", "I", "O", "U"];
export const LIDS = ["upper_lid_left", "upper_lid_right", "lower_lid_left", "lower_lid_right"];
export const MOUTH = ["jaw_open", ...VISEMES.slice(1).map((v) => `viseme_${v}`)];
/** What a face is worked by, in the order of the rig's arrays. */
export const CHANNELS = [...LIDS, "blink", ...MOUTH];

/** The life layers' settings where the export says nothing; what each means is in docs/format.md. */
export const LIFE = {
  on: true, stillness: 0, breathing: 1, breath_rate: 14, gaze: 1, head_share: 0.6, aversion_rate: 12, aversion_length: 0.93,
  aversion_angle: 14, saccades: 1, saccade_rate: 60, lids: 1, blinks: 17, accent_blinks: 1, blink_close: 0.07, blink_open: 0.1,
  lips: 1, lip_smoothing: 0.03,
};
const SAME = {
  breathing: 1, breath_rate: 1, aversion_rate: 1, aversion_length: 1, aversion_angle: 1, saccades: 1, saccade_rate: 1, blinks: 1,
};
const MANNERS = {
  idle: { aversion_rate: 1.1, aversion_length: 2.4, aversion_angle: 1.4, saccade_rate: 0.85 },
  listening: { aversion_rate: 0.6, aversion_length: 0.46, aversion_angle: 0.8, saccades: 0.9 },
  talking: { breathing: 1.15, breath_rate: 1.1, aversion_rate: 1.25 },
};

/** Return the settings with what an export says of them; `manners`: what each mode makes of the amounts, factors. */
export function readLife(data = {}) {
  const manners = Object.fromEntries(MODES.map((mode) => [mode, { ...SAME, ...(data.modes?.[mode] ?? MANNERS[mode]) }]));
  return { ...LIFE, ...data, manners };
}
