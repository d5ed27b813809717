/**
 * Define the values that a project is made of. All are frozen, and their mappings never change in place.
 *
 * Ids are made once from the content they are for and never change. Names are free text for people.
 *
 * Translated from metagraph/graph/model.py; change that, and translate anew.
 */


/**
 * When an action plays within its clip. All times are seconds of the clip.
 *
 * `start` and `end` bound the part that plays; an `end` of None is the clip's end. `blend_in` and `blend_out` are the
 * seconds of blending from and to the stance, inside that part. For a looping stance, `blend_in` is the overlap at the
 * loop's seam. `loop` repeats the part. From `earliest_exit` on, the next action may start; None plays the action to its
 * end. `stroke` is its most expressive moment. `ready`, `stroke_end` and `relax` are the ends of a gesture's preparation,
 * stroke and hold; its retraction ends with the action. None takes the times found from the motion
 * (`playback.timing.phases`). `repeat` is the number of seconds for which a gesture or fidget repeats its part if no request
 * says how long; it plays the nearest whole number of times. 0 plays it once.
 *
 * start: number; end: ?number; blendIn: number; blendOut: number; loop: boolean; earliestExit: ?number; stroke: ?number;
 * ready: ?number; strokeEnd: ?number; relax: ?number; repeat: number.
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
    repeat = 0,
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
    this.repeat = repeat;
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
 * A first-order model over (limb, kind). It writes meta actions when there are no requests (Borer et al., 7.3).
 *
 * `matrix` has rows of probabilities, each of which sums to 1. `gap` is the mean rest between two actions, in seconds.
 * `positive` and `negative` are the shares of gestures that request that tag, if tags are not part of the states. `tags` has
 * one text for each state: the tags it requests, with blanks between them; it is empty if tags are not part of the states.
 * `lengths` has the mean and standard deviation of each state's actions, in seconds; it is empty if they are unknown.
 * `modes` has one row for each mode, in the order of `words.MODES`: the shares, 0 to 1, of the written gestures, fidgets and
 * transitions that are performed in that mode. Without the last two rows, thinking and reacting are as listening. It is
 * empty if the mode makes no difference.
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

  /** Return the tags that a state requests, "" for none. */
  tag(state) {
    return this.tags.length > 0 ? this.tags[state] : "";
  }
}

/**
 * The planner's constants.
 *
 * `alpha` says how quickly a used action becomes unlikely (4 in the paper). `seed` has 32 bits. With `never_twice`, an
 * action is not played twice in a row if there is another. `shortest` is the minimum length, in seconds, of a remainder that
 * is kept when a meta action is cut. `wait` is how many seconds late a request may start. `memory` is the number of seconds
 * after which a use no longer counts, 0 for never (as in the paper). `rest` is the least number of seconds in the stance
 * between two actions of a layer. A running plan is not changed for the next `lookahead` seconds. `variety`, 0..4,
 * multiplies the times of `planning.director`, which decide how rarely actions repeat and stances change; 0 is as in the
 * paper.
 *
 * alpha: number; seed: number; neverTwice: boolean; shortest: number; wait: number; memory: number; rest: number; lookahead:
 * number; variety: number.
 */
export class Settings {
  constructor(
    alpha = 4,
    seed = 1,
    neverTwice = true,
    shortest = 0.4,
    wait = 4,
    memory = 0,
    rest = 0,
    lookahead = 0.1,
    variety = 1,
  ) {
    this.alpha = alpha;
    this.seed = seed;
    this.neverTwice = neverTwice;
    this.shortest = shortest;
    this.wait = wait;
    this.memory = memory;
    this.rest = rest;
    this.lookahead = lookahead;
    this.variety = variety;
  }
}
