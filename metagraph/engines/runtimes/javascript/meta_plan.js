/**
 * Requests, meta actions and plans: what the planner takes and gives. All values; times are seconds.
 *
 * Translated from metagraph/playback/plan.py; change that, and translate anew.
 */


export const ASKED = 1; // default priority of a request
export const WRITTEN = 0; // priority of what the Markov model writes

/**
 * What an agent or animator asks for, at any level of abstraction.
 *
 * id: unique; it keys the random draws. start: seconds. duration: how long the activity is wanted, None for one action.
 * action: id of a specific action. tags: all of them must be on the action. limb: which arm. stance: id of the stance to go
 * to (kind "transition"). priority: higher wins. resume: whether, when something more important cuts it, its remainder goes
 * on afterwards. stroke: when a gesture's stroke should come; `start` is then the earliest it may begin. hold: seconds its
 * hold should last, None for as long as it was made. prepare: whether its preparation plays. among: ids of the only actions
 * it may be, any where empty.
 *
 * id: string; layer: string; kind: string; start: number; duration: ?number; action: ?string; tags: string[]; limb: ?string;
 * stance: ?string; priority: number; resume: boolean; stroke: ?number; hold: ?number; prepare: boolean; among: string[].
 */
export class MetaRequest {
  constructor(
    id,
    layer,
    kind,
    start,
    duration = null,
    action = null,
    tags = [],
    limb = null,
    stance = null,
    priority = ASKED,
    resume = false,
    stroke = null,
    hold = null,
    prepare = true,
    among = [],
  ) {
    this.id = id;
    this.layer = layer;
    this.kind = kind;
    this.start = start;
    this.duration = duration;
    this.action = action;
    this.tags = tags;
    this.limb = limb;
    this.stance = stance;
    this.priority = priority;
    this.resume = resume;
    this.stroke = stroke;
    this.hold = hold;
    this.prepare = prepare;
    this.among = among;
  }
}

/**
 * Where writing stands: before meta action `number`, in state number `state` (-1: none yet), which ended at `time` seconds.
 *
 * number: number; state: number; time: number.
 */
export class Cursor {
  constructor(number = 0, state = -1, time = 0) {
    this.number = number;
    this.state = state;
    this.time = time;
  }
}

/**
 * A request placed in time: `start`..`end` is the window it may use. written: by the Markov model, not asked for. part: 0
 * for the request itself, n for its n-th remainder after a cut.
 *
 * request: MetaRequest; start: number; end: number; part: number; written: boolean.
 */
export class MetaAction {
  constructor(request, start, end, part = 0, written = false) {
    this.request = request;
    this.start = start;
    this.end = end;
    this.part = part;
    this.written = written;
  }

  /** How important it is: its request's priority; what a model wrote gives way to all that is asked for. */
  get rank() {
    return this.written ? -Infinity : this.request.priority;
  }

  /** What keys this meta action's random draws. */
  get key() {
    return this.part === 0 ? this.request.id : `${this.request.id}+${this.part}`;
  }
}

/**
 * What became of a meta action that was not simply played as asked. played: whether something of it still plays.
 *
 * request: string; outcome: string; message: string; layer: string; at: number; played: boolean; written: boolean.
 */
export class Report {
  constructor(request, outcome, message, layer, at, played = false, written = false) {
    this.request = request;
    this.outcome = outcome;
    this.message = message;
    this.layer = layer;
    this.at = at;
    this.played = played;
    this.written = written;
  }
}
