/**
 * When a gesture prepares, strikes, holds and retracts (Kendon; BML's ready, stroke-end and relax).
 *
 * Translated from metagraph/playback/timing/phase_times.py; change that, and translate anew.
 */


export const LEAST_BLEND = 0.25; // seconds in which a gesture that skips its preparation comes in

/**
 * Clip seconds, ascending: start, ready (preparation ends), stroke (its peak), stroke_end (the hold begins), relax (the hold
 * ends), end.
 *
 * start: number; ready: number; stroke: number; strokeEnd: number; relax: number; end: number.
 */
export class Phases {
  constructor(start, ready, stroke, strokeEnd, relax, end) {
    this.start = start;
    this.ready = ready;
    this.stroke = stroke;
    this.strokeEnd = strokeEnd;
    this.relax = relax;
    this.end = end;
  }

  /** Return where a gesture begins if it skips its preparation: as late as it can blend in and be ready. */
  skip(blendIn) {
    return Math.max(this.start, this.ready - Math.max(blendIn, LEAST_BLEND));
  }
}
