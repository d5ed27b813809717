/**
 * A lane of events in time, drawn one after another. It never changes: it is extended at the end and forgotten at the front.
 *
 * Translated from metagraph/playback/life/lane.py; change that, and translate anew.
 */

import { bisectLeft, bisectRight } from "./basics.js";

/**
 * times: when events begin, ascending, seconds. rows: the values of each event. first: number of the first event that is
 * still kept. width: how many numbers a row has.
 *
 * times: number[]; rows: number[][]; first: number; width: number.
 */
export class Lane {
  constructor(times = [], rows = [], first = 0, width = 1) {
    this.times = times;
    this.rows = rows;
    this.first = first;
    this.width = width;
  }

  /** The number of the event to be drawn next. */
  get next() {
    return this.first + this.times.length;
  }

  /** Return the lane with only the events that begin before a time. */
  until(seconds) {
    const count = bisectLeft(this.times, seconds);
    if (count === this.times.length) {
      return this;
    }
    return new Lane(this.times.slice(0, count), this.rows.slice(0, count), this.first, this.width);
  }

  /** Return the lane with later events. */
  plus(times, rows) {
    if (times.length === 0) {
      return this;
    }
    return new Lane([...this.times, ...times], [...this.rows, ...rows], this.first, this.width);
  }

  /** Return the lane without events that are over at `seconds`; `before`: how many of those to keep. */
  since(seconds, before = 1) {
    const gone = Math.max(0, bisectRight(this.times, seconds) - 1 - before);
    if (gone === 0) {
      return this;
    }
    return new Lane(this.times.slice(gone), this.rows.slice(gone), this.first + gone, this.width);
  }
}
