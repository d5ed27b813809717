/** The part of the runtime that breathes, looks, blinks, moves the lips and hears what comes in as it is said; see parts.js. */

export { ALPHABET } from "../alphabet.js";
export { Schedule, schedule } from "../schedule.js";
export { spokenUntil } from "../spoken_so_far.js";
export { StreamedVoice } from "../streamed_voice.js";
export { readBody } from "./body.js";
export { Enlivener } from "./evaluate.js";
