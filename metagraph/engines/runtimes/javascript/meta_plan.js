/**
 * Requests, meta actions and plans: what the planner takes and returns. All are values; times are seconds.
 *
 * Translated from metagraph/playback/plan.py; change that, and translate anew.
 */


export const ASKED = 1; // default priority of a request
export const WRITTEN = 0; // priority of what the Markov model writes

/**
 * A request of an agent or animator, at any level of abstraction.
 *
 * id: unique; it keys the random draws. start: seconds. duration: how long the activity should last, None for one action.
 * action: id of a specific action. tags: all of them must be on the action. limb: which arm. stance: id of the stance to go
 * to (kind "transition"). priority: higher wins. resume: whether the remainder plays afterwards if a more important request
 * cuts it. stroke: when a gesture's stroke should come; `start` is then the earliest it may begin. hold: seconds that its
 * hold should last, None for its length in the clip. prepare: whether its preparation plays. among: ids of the only actions
 * it may be; empty for any. late: by how many seconds its stroke may come late, or its start if it has no stroke; 0 for on
 * time or not at all, None for as late as the settings allow. valence, arousal, intensity: the mood it is played in, as in
 * `mood.Mood`; None for the mood at that time.
 *
 * id: string; layer: string; kind: string; start: number; duration: ?number; action: ?string; tags: string[]; limb: ?string;
 * stance: ?string; priority: number; resume: boolean; stroke: ?number; hold: ?number; prepare: boolean; among: string[];
 * late: ?number; valence: ?number; arousal: ?number; intensity: ?number.
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
    late = null,
    valence = null,
    arousal = null,
    intensity = null,
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
    this.late = late;
    this.valence = valence;
    this.arousal = arousal;
    this.intensity = intensity;
  }
}

/**
 * Where writing continues: before meta action `number`, after state number `state` (-1: none yet), which ended at `time`
 * seconds.
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
 * A request placed in time: `start`..`end` is the window it may use. written: whether the Markov model wrote it, instead of
 * a request. part: 0 for the request itself, n for its n-th remainder after a cut.
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

  /** Its importance: its request's priority. What a model wrote gives way to all requests. */
  get rank() {
    return this.written ? -Infinity : this.request.priority;
  }

  /** The key of this meta action's random draws. */
  get key() {
    return this.part === 0 ? this.request.id : `${this.request.id}+${this.part}`;
  }
}

/**
 * One action in the plan. It plays its clip from `entry` on during `start`..`end`, at `tempo` times its own speed but for
 * its hold.
 *
 * hold_from, hold_to: clip seconds of the hold, which takes `hold` seconds; 0, 0, 0 if it is not stretched. blend_in,
 * blend_out: seconds, fitting inside the cue. stance: before it; then: the stance it leaves the layer in. meta: key of the
 * meta action it realises. extent: how large it is played, a factor of its turns away from the stance. cycle_from, cycle_to:
 * clip seconds between which it repeats; 0, 0 if it plays once.
 *
 * action: Action; start: number; end: number; entry: number; blendIn: number; blendOut: number; stance: string; then:
 * string; meta: string; holdFrom: number; holdTo: number; hold: number; extent: number; tempo: number; cycleFrom: number;
 * cycleTo: number.
 */
export class Cue {
  constructor(
    action,
    start,
    end,
    entry,
    blendIn,
    blendOut,
    stance,
    then,
    meta,
    holdFrom = 0,
    holdTo = 0,
    hold = 0,
    extent = 1,
    tempo = 1,
    cycleFrom = 0,
    cycleTo = 0,
  ) {
    this.action = action;
    this.start = start;
    this.end = end;
    this.entry = entry;
    this.blendIn = blendIn;
    this.blendOut = blendOut;
    this.stance = stance;
    this.then = then;
    this.meta = meta;
    this.holdFrom = holdFrom;
    this.holdTo = holdTo;
    this.hold = hold;
    this.extent = extent;
    this.tempo = tempo;
    this.cycleFrom = cycleFrom;
    this.cycleTo = cycleTo;
  }

  /** Whether it repeats a cycle. */
  get repeats() {
    return this.cycleTo > this.cycleFrom;
  }
}

/**
 * The stance loop that lies under the cues from `start` on: loop seconds are `time - start`, wrapped.
 *
 * fade_start, fade: when and for how many seconds it takes over from the loop before.
 *
 * stance: string; action: Action; start: number; fadeStart: number; fade: number.
 */
export class Rest {
  constructor(stance, action, start, fadeStart, fade) {
    this.stance = stance;
    this.action = action;
    this.start = start;
    this.fadeStart = fadeStart;
    this.fade = fade;
  }
}
export const TEMPORAL = new Set(["late", "cut", "resumed", "past"]); // told by temporal replanning, once

/**
 * The result of a meta action that does not play exactly as requested. played: whether a part of it still plays. late: by
 * how many seconds it comes late, or would have come, if it said how late it may. by: key of the meta action whose action
 * serves it, too.
 *
 * request: string; outcome: string; message: string; layer: string; at: number; played: boolean; written: boolean; late:
 * number; by: string.
 */
export class Report {
  constructor(request, outcome, message, layer, at, played = false, written = false, late = 0, by = "") {
    this.request = request;
    this.outcome = outcome;
    this.message = message;
    this.layer = layer;
    this.at = at;
    this.played = played;
    this.written = written;
    this.late = late;
    this.by = by;
  }
}

/**
 * What further planning needs from forgotten cues. free: when the last one ended; stance: in which stance. uses: how often
 * each action was used. recent: the actions used last, by `remembering.node`, the latest at the end. ended: when each ended
 * last.
 *
 * free: number; stance: string; uses: Map<string, number>; recent: Map<string, string[]>; ended: Map<string, number>.
 */
export class Past {
  constructor(free = 0, stance = "", uses = new Map(), recent = new Map(), ended = new Map()) {
    this.free = free;
    this.stance = stance;
    this.uses = uses;
    this.recent = recent;
    this.ended = ended;
  }
}

/**
 * cues never overlap and ascend; rests ascend by fade_start, the first covering everything before.
 *
 * past: what came before the first cue, if that was forgotten. cursor: where the Markov model continues to write. written:
 * what it wrote for later, unchanged: each extension fits it in again, so that it does not matter when it was written.
 *
 * layer: string; metas: MetaAction[]; cues: Cue[]; rests: Rest[]; past: Past; cursor: Cursor; written: MetaAction[].
 */
export class LayerPlan {
  constructor(layer, metas = [], cues = [], rests = [], past = new Past(), cursor = new Cursor(), written = []) {
    this.layer = layer;
    this.metas = metas;
    this.cues = cues;
    this.rests = rests;
    this.past = past;
    this.cursor = cursor;
    this.written = written;
  }
}
