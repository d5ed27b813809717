/**
 * A lane of events in time, drawn one after another; never changed, extended at the end, forgotten at the front.
 * @typedef {{starts: number[], values: number[][], first: number}} Lane `starts` ascend, seconds; `values`: what each event is;
 *   `first`: number of the first event that is still kept.
 */

import { bisect } from "../basics.js";

/** @returns {Lane} */
export const emptyLane = () => ({ starts: [], values: [], first: 0 });

/** The number of the event to be drawn next. @param {Lane} lane */
export const nextOf = (lane) => lane.first + lane.starts.length;

/** Return the lane with only what begins before a time. @param {Lane} lane */
export function until(lane, seconds) {
  const count = bisect(lane.starts, seconds, false);
  return count === lane.starts.length ? lane : { ...lane, starts: lane.starts.slice(0, count), values: lane.values.slice(0, count) };
}

/** Return the lane with later events. @param {Lane} lane */
export function longer(lane, starts, values) {
  return starts.length ? { ...lane, starts: [...lane.starts, ...starts], values: [...lane.values, ...values] } : lane;
}

/** Return the lane without what neither goes on at `seconds` nor comes later; `before`: how many more are kept. @param {Lane} lane */
export function sinceLane(lane, seconds, before = 1) {
  const gone = Math.max(0, bisect(lane.starts, seconds, true) - 1 - before);
  return gone ? { starts: lane.starts.slice(gone), values: lane.values.slice(gone), first: lane.first + gone } : lane;
}
