/** The life layers' settings, and what an export leaves out of them. */

import { MODES, inRange } from "./words.js";

/** The life layers' settings: the usual where the export says nothing, the least and the most; docs/reference/export-rigs.md says what each means. */
const LIFE = {
  stillness: [0, 0, 1], breathing: [1, 0, 2], breath_rate: [14, 0, 40], gaze: [1, 0, 1], head_share: [0.6, 0, 1], aversion_rate: [12, 0, 40],
  aversion_length: [0.93, 0, 5], aversion_angle: [14, 0, 40], saccades: [1, 0, 2], saccade_rate: [60, 0, 180], lids: [1, 0, 2],
  blinks: [17, 0, 60], accent_blinks: [0.7, 0, 1], blink_close: [0.07, 0.02, 1], blink_open: [0.1, 0.02, 1], lips: [1, 0, 2],
  lip_smoothing: [0.03, 0, 0.2], expressions: [1, 0, 2], accent_brows: [0.4, 0, 1], valence: [0, -1, 1], arousal: [0, -1, 1], intensity: [1, 0, 2],
  follow_through: [1, 0, 2], shoulder_lift: [1, 0, 2], planted_feet: [1, 0, 1],
};
const FACTORS = [
  "breathing", "breath_rate", "aversion_rate", "aversion_length", "aversion_angle", "saccades", "saccade_rate", "blinks",
];
const MANNERS = {
  idle: { aversion_rate: 1.1, aversion_length: 2.4, aversion_angle: 1.4, saccade_rate: 0.85 },
  listening: { aversion_rate: 1.0, aversion_length: 1.5, aversion_angle: 1.1, saccades: 0.9, blinks: 1.45 },
  talking: { breathing: 1.15, breath_rate: 1.1, aversion_rate: 1.35, aversion_length: 2.3, aversion_angle: 1.3, blinks: 0.65 },
  thinking: { breathing: 0.8, aversion_rate: 1.1, aversion_length: 3.8, aversion_angle: 1.3, saccades: 0.7, saccade_rate: 0.6 },
  reacting: { breathing: 1.2, aversion_rate: 0.2, aversion_angle: 0.6, saccades: 0.7, blinks: 1.6 },
};

/** Return the settings with what an export says of them; `manners`: what each mode makes of the amounts, factors from 0 to 4. */
export function readLife(data = {}) {
  const dials = Object.entries(LIFE).map(([name, [usual, low, high]]) => [name, inRange(data[name] ?? usual, low, high, `life.${name}`)]);
  const manner = (mode, own) => FACTORS.map((name) => [name, inRange(own[name] ?? 1, 0, 4, `life.modes.${mode}.${name}`)]);
  const manners = MODES.map((mode) => [mode, camel(manner(mode, data.modes?.[mode] ?? MANNERS[mode]))]);
  return { on: data.on ?? true, ...camel(dials), manners: Object.fromEntries(manners) };
}

/** Return [name, number] pairs as a record, its names as this language writes them. */
const camel = (pairs) => Object.fromEntries(pairs.map(([name, value]) => [name.replace(/_(.)/g, (_, c) => c.toUpperCase()), value]));

/** Return what a mode makes of the amounts. */
export const getManner = (life, mode) => life.manners[mode];

/** Return whether two are the same settings. */
/** Return what a mode makes of the amounts, each that a mood changes times a factor. */
export const scaled = (ways, breathing, breathRate, aversionRate, saccadeRate, blinks) => ({
  ...ways,
  breathing: ways.breathing * breathing,
  breathRate: ways.breathRate * breathRate,
  aversionRate: ways.aversionRate * aversionRate,
  saccadeRate: ways.saccadeRate * saccadeRate,
  blinks: ways.blinks * blinks,
});

export const isSameLife = (a, b) => a === b;
