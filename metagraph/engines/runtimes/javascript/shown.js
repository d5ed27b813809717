/** What a face shows, by the names that exports give to channels of morph targets. */

import { MOUTH } from "./words.js";

const FEELS = ["smile", "frown", "brow_down", "brow_up", "brows", "cheeks"];
const SIDED = ["blink", "wide", "look_left", "look_right", "look_up", "look_down"];

/** What morph targets stand for, in the order in which life/evaluate.js works it out. */
export const SHOWN = ["blink", ...["left", "right"].flatMap((side) => SIDED.map((what) => `${what}_${side}`)), ...MOUTH, ...FEELS];
