/**
 * The values a project is made of. All are frozen; mappings in them are never changed in place.
 *
 * Ids are made once from the project's counter and never change; names are free text for people.
 *
 * Translated from metagraph/graph/model.py; change that, and translate anew.
 */


/**
 * When an action plays within its clip; seconds of the clip.
 *
 * start, end: the part that plays; `end` None is the clip's end. blend_in, blend_out: seconds of blending from and to the
 * stance, within start..end (for a looping stance, blend_in is the overlap at the loop's seam). loop: repeats.
 * earliest_exit: from here on the action may be left, or None to play it through. stroke: its most telling moment. ready,
 * stroke_end, relax: where a gesture's preparation, stroke and hold end (its retraction ends with it); None as found from
 * the motion (`playback.timing.phases`).
 *
 * start: number; end: ?number; blendIn: number; blendOut: number; loop: boolean; earliestExit: ?number; stroke: ?number;
 * ready: ?number; strokeEnd: ?number; relax: ?number.
 */
export class Timing {
  constructor(
    start = 0,
    end = null,
    blendIn = 0.2,
    blendOut = 0.3,
    loop = false,
    earliestExit = null,
    stroke = null,
    ready = null,
    strokeEnd = null,
    relax = null,
  ) {
    this.start = start;
    this.end = end;
    this.blendIn = blendIn;
    this.blendOut = blendOut;
    this.loop = loop;
    this.earliestExit = earliestExit;
    this.stroke = stroke;
    this.ready = ready;
    this.strokeEnd = strokeEnd;
    this.relax = relax;
  }
}

/**
 *
 * id: string; layer: string; name: string.
 */
export class Stance {
  constructor(id, layer, name) {
    this.id = id;
    this.layer = layer;
    this.name = name;
  }
}

/**
 * A first-order model over (limb, kind) that writes meta actions when nobody asks for any (Borer et al., 7.3).
 *
 * matrix: rows of probabilities, each summing to 1. gap: mean seconds of rest between two actions. positive, negative: share
 * of gestures asked for with that tag, where tags are not part of the states. tags: one text a state, the tags (blanks
 * between them) it asks for; empty when tags are not part of the states. lengths: (mean, standard deviation) seconds of each
 * state's actions; empty where that is not known. modes: what is performed of what it writes while one is said to idle, to
 * listen and to talk, a row each: shares of gestures, fidgets and transitions, 0..1; empty where the mode makes no
 * difference.
 *
 * layer: string; states: [string, string][]; matrix: number[][]; gap: number; positive: number; negative: number; tags:
 * string[]; lengths: [number, number][]; modes: number[][].
 */
export class Markov {
  constructor(layer, states, matrix, gap = 2.5, positive = 0, negative = 0, tags = [], lengths = [], modes = []) {
    this.layer = layer;
    this.states = states;
    this.matrix = matrix;
    this.gap = gap;
    this.positive = positive;
    this.negative = negative;
    this.tags = tags;
    this.lengths = lengths;
    this.modes = modes;
  }

  /** Return the tags a state asks for, "" for none. */
  tag(state) {
    return this.tags.length > 0 ? this.tags[state] : "";
  }
}

/**
 * Planner constants. alpha: how quickly a used action becomes unlikely (4 in the paper). seed: 32-bit.
 *
 * never_twice: an action is not played twice in a row where there is another. shortest: seconds below which the remainder of
 * a cut meta action is not worth keeping. wait: how late, in seconds, a request may start. memory: seconds after which a use
 * no longer counts, 0 for never (as in the paper). rest: least seconds in the stance between two actions of a layer.
 * lookahead: seconds ahead of now in which a running plan is not changed any more.
 *
 * alpha: number; seed: number; neverTwice: boolean; shortest: number; wait: number; memory: number; rest: number; lookahead:
 * number.
 */
export class Settings {
  constructor(alpha = 4, seed = 1, neverTwice = true, shortest = 0.4, wait = 4, memory = 0, rest = 0, lookahead = 0.1) {
    this.alpha = alpha;
    this.seed = seed;
    this.neverTwice = neverTwice;
    this.shortest = shortest;
    this.wait = wait;
    this.memory = memory;
    this.rest = rest;
    this.lookahead = lookahead;
  }
}
