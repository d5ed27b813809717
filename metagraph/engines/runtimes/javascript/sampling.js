/**
 * From a meta plan to specific actions: candidates, the three temporal cases, the draw (Borer et al., section 6.2).
 *
 * Translated from metagraph/playback/planning/sampling.py; change that, and translate anew.
 */

import { cycleOf } from "./repeating.js";
import { modeAt } from "./wanted.js";
import { Cue, Report, Rest } from "./meta_plan.js";
import { begins, bounds } from "./bounds.js";
import { pick, uniform } from "./choice.js";
import { 
  CueShape,
  FITS,
  RETRACTION,
  STOPPED,
  fitsBefore,
  hurried,
  lateness,
  mayShare,
  meets,
  remaining,
  shapeOf,
  slackOf,
} from "./cue_shapes.js";
import { 
  APART,
  GOES_HOME,
  LEAST_BEATS,
  LEAST_LULL,
  LEAVES_HOME,
  LONG_REST,
  MOST_LULL,
  MUSED,
  MUSES,
  SHORTER,
  STANDS_OUT,
  beatInterval,
  findLull,
  freshness,
  musing,
  posture,
  repeatInterval,
} from "./director.js";
import { performs } from "./markov.js";
import { HELD, changed, drag, extent, favour, madeFor, moodAt, stirs, tempo } from "./mood.js";
import { measureProminence } from "./prominence.js";
import { node, remember, rested } from "./remembering.js";
import { measureVigour } from "./vigour.js";
import { LEAST_BLEND } from "./phase_times.js";
import { findPhases } from "./phases.js";
import { but, maxOf, minOf, thousandths } from "./basics.js";

export const ON_TIME = 0.1; // seconds by which a request may begin later and still be on time
export const LOOP_FADE = 0.6; // seconds of crossfade when a long rest changes from one loop of its stance to another

/**
 * One action of a chain: the candidates for it and, for a transition on the way, the stance it leads to.
 *
 * candidates: Action[]; hop: string.
 */
export class SamplingStep {
  constructor(candidates, hop = "") {
    this.candidates = candidates;
    this.hop = hop;
  }
}

/**
 * One layer being planned, cue after cue. It changes while planning, and never leaves the planner.
 *
 * uses: how often each action was used. recent: the last draws of each `node`. ended: when each action ended. begun: keys of
 * meta actions whose chain of transitions already plays. served: keys of those that the action of another one serves, too.
 * moods: the mood over time. candidates: the actions of each `node` that may be drawn, for the nodes needed so far.
 * prominences: of actions, as far as needed. acted: when the last action ended. track: what lasts. model: the one that wrote
 * what was not requested, None if there is none. beats: seconds after which a gesture that hardly shows may be done again.
 *
 * project: Project; graph: MetaGraph; seed: number; stance: string; moods: Moods; track: Track; free: number; acted: number;
 * uses: Map<string, number>; recent: Map<string, string[]>; ended: Map<string, number>; cues: Cue[]; rests: Rest[]; reports:
 * Report[]; begun: Set<string>; served: Set<string>; candidates: Map<string, Action[]>; prominences: Map<string, number>;
 * model: ?Markov; beats: number.
 */
export class Performer {
  constructor(
    project,
    graph,
    seed,
    stance,
    moods,
    track,
    free = 0,
    acted = 0,
    uses = new Map(),
    recent = new Map(),
    ended = new Map(),
    cues = [],
    rests = [],
    reports = [],
    begun = new Set([]),
    served = new Set([]),
    candidates = new Map(),
    prominences = new Map(),
    model = null,
    beats = LEAST_BEATS,
  ) {
    this.project = project;
    this.graph = graph;
    this.seed = seed;
    this.stance = stance;
    this.moods = moods;
    this.track = track;
    this.free = free;
    this.acted = acted;
    this.uses = uses;
    this.recent = recent;
    this.ended = ended;
    this.cues = cues;
    this.rests = rests;
    this.reports = reports;
    this.begun = begun;
    this.served = served;
    this.candidates = candidates;
    this.prominences = prominences;
    this.model = model;
    this.beats = beats;
  }

  /** Note that a cue is played. */
  note(cue, then) {
    this.cues.push(cue);
    this.free = cue.end;
    this.acted = cue.end;
    this.stance = then;
    remember(cue, this.uses, this.recent, this.ended);
  }

  /** The earliest time at which the next action may begin. */
  get ready() {
    return this.free + (this.ended.size > 0 ? this.project.settings.rest : 0);
  }

  /** Lay the first loop down; return whether the layer can perform at all. */
  begin(stance) {
    const loop = this.loop(stance, `rest/${this.graph.layer}`);
    if (loop === null) {
      return false;
    }
    this.rests.push(new Rest(stance, loop, 0, 0, 0));
    return true;
  }

  /** Realise in order those meta actions of a conflict-free meta plan that start before `end`. */
  perform(metas, end) {
    const performed = metas.filter((m) => !m.written || this.performs(m, m.start));
    for (const bound of bounds(performed)) {
      const meta = bound.meta;
      if (begins(meta) >= end) {
        continue;
      }
      if (this.served.size > 0 && this.served.has(meta.key)) {
        continue;
      }
      if (meta.request.late !== null) {
        this.realise(bound, Math.max(this.ready, begins(meta)));
        continue;
      }
      const ready = this.ready;
      if (meta.start < ready && !this.begun.has(meta.key)) {
        let running = "the running action";
        if (this.cues.length > 0) {
          running = `'${this.cues[this.cues.length - 1].action.name}'`;
        }
        let waits = ready - meta.start;
        if (meta.end <= ready + FITS) {
          waits = ready - meta.request.start;
          // What is wanted for a certain time is over; what is wanted once may come late.
          const wanted = meta.written || meta.request.duration !== null;
          if (wanted || waits > this.project.settings.wait) {
            const why = `wholly covered by ${running}, which plays until ${this.free.toFixed(2)} s`;
            this.tell(meta, "covered", why);
            continue;
          }
        }
        // What a model wrote is wanted at no certain time.
        if (!meta.written && waits > ON_TIME) {
          this.tell(meta, "queued", `waits ${waits.toFixed(2)} s for ${running}`, true);
        }
      }
      this.realise(bound, Math.max(ready, meta.start));
    }
  }

  realise(bound, now) {
    const meta = bound.meta;
    const limit = bound.limit;
    if (meta.written && !this.begun.has(meta.key) && !this.mayBegin(meta, now)) {
      return;
    }
    const steps = this.steps(meta, now);
    if (steps === null) {
      return;
    }
    const cues = [];
    let stance = this.stance;
    for (const step of steps) {
      const hops = step.hop !== "";
      const asked = hops ? null : remaining(meta, now);
      const mood = this.mood(asked, now);
      let fitting = [...step.candidates];
      if (limit < Infinity) { // else all fit
        fitting = step.candidates.filter((a) => fitsBefore(this.shape(a, asked, now, mood), limit));
      }
      if (fitting.length === 0) {
        const before = meta.written ? "" : " before something more important";
        this.tell(meta, "no-room", `nothing fits into the ${Math.max(0, limit - now).toFixed(2)} s${before}`);
        return;
      }
      if (!hops && meta.request.action === null) {
        const warm = fitting.filter((a) =>
          a.cooldown <= 0 || this.cooled(a) <= this.shape(a, asked, now, mood).start + FITS);
        if (warm.length === 0) {
          const soonest = minOf(fitting.map((a) => this.cooled(a)));
          this.tell(meta, "cooling", `all that fit are cooling down; the first may play again at ${soonest.toFixed(2)} s`);
          return;
        }
        fitting = warm;
      }
      // On the way to a stance it counts when that begins.
      if (meta.request.late !== null && (!hops || (cues.length === 0 && steps[steps.length - 1].hop !== ""))) {
        fitting = this.timely(bound, fitting, now);
        if (fitting.length === 0) {
          return;
        }
      }
      const action = this.draw(fitting, hops ? `${meta.key}/${step.hop}` : meta.key, now, mood);
      const shape = this.shape(action, asked, now, mood);
      const cue = this.cue(action, shape, bound, hops, stance, mood);
      cues.push(cue);
      now = cue.end;
      stance = cue.then;
    }
    for (const one of cues) {
      this.keep(one);
    }
  }

  /**
   * Return whether what a model wrote is performed at a time: not out of a stance that a request holds, and as often as mode
   * and mood say. Anything may begin a long thought, or end it.
   */
  performs(meta, now) {
    if (!stirs(moodAt(this.moods, now), this.seed, meta.request.id)) {
      return false;
    }
    if (meta.request.kind === "transition" && this.track.staysAt(this.graph.layer, now)) {
      return false;
    }
    if (this.model === null || this.muses(now) || this.hasMused(now)) {
      return true;
    }
    return performs(this.model, this.seed, meta, modeAt(this.track, now));
  }

  /**
   * Return whether what a model wrote begins at a time, which may be later than it was written for: not soon after an
   * interruption, and nothing that would end a thought.
   */
  mayBegin(meta, now) {
    if (this.track.hushedAt(now) || !this.performs(meta, now)) {
      return false;
    }
    if (this.model === null || this.leads(now) !== "") {
      return true;
    }
    if (this.lulls(now)) {
      return false;
    }
    const there = this.stance === musing(this.graph.stances);
    if (there && meta.request.kind === "transition" && this.muses(now)) {
      return false;
    }
    return performs(this.model, this.seed, meta, modeAt(this.track, now));
  }

  /**
   * Return whether the arms rest at a time: after a burst of one who talks, else after any act. In a thought acts are rare
   * anyway.
   */
  lulls(now) {
    const variety = this.project.settings.variety;
    if (this.graph.layer !== "arms" || variety <= 0 || this.cues.length === 0 || this.hasMused(now)) {
      return false;
    }
    const last = this.cues[this.cues.length - 1];
    const mode = modeAt(this.track, now);
    if (now >= last.end + MOST_LULL || mode === "thinking") {
      return false;
    }
    const talks = mode === "talking";
    if (talks && last.action.kind === "transition") { // it opens a burst
      return false;
    }
    return now < last.end + findLull(this.seed, last.meta, talks, variety);
  }

  /** Return whether the arms take or keep the stance in which the character thinks. */
  muses(now) {
    if (modeAt(this.track, now) !== "thinking" || modeAt(this.track, now + MUSES) !== "thinking") {
      return false;
    }
    if (this.graph.layer !== "arms" || this.project.settings.variety <= 0) {
      return false;
    }
    return !this.track.staysAt("arms", now) && musing(this.graph.stances) !== "";
  }

  /** Return whether a thought of the character has ended just now. */
  hasMused(now) {
    if (this.graph.layer !== "arms" || modeAt(this.track, now) === "thinking") {
      return false;
    }
    return this.project.settings.variety > 0 && modeAt(this.track, now - MUSED) === "thinking";
  }

  /**
   * Return the stance that the arms go to whatever a model wrote: the one in which the character thinks, and from there home
   * as soon as the thought is over; "" for none.
   */
  leads(now) {
    if (this.graph.layer !== "arms" || this.project.settings.variety <= 0) {
      return "";
    }
    const muses = musing(this.graph.stances);
    if (muses === "" || this.track.staysAt("arms", now)) {
      return "";
    }
    const home = this.graph.start;
    let goal = "";
    if (this.muses(now)) {
      goal = muses;
    } else if (this.stance === muses && home !== null && modeAt(this.track, now) !== "thinking") {
      const came = this.moved();
      if (came >= 0 && modeAt(this.track, came) === "thinking") {
        goal = home;
      }
    }
    if (goal === this.stance || goal === "" || this.chain(goal).length === 0) {
      return "";
    }
    return goal;
  }

  /**
   * Return the candidates that come least late, if that is not too late; among them those that leave the following requests
   * the most time and serve the most of them.
   */
  timely(bound, fitting, now) {
    const meta = bound.meta;
    const request = meta.request;
    const allowed = slackOf(request);
    const mood = this.mood(request, now);
    const late = new Map(fitting.map((a) => [a.id, lateness(this.project, a, request, this.shape(a, request, now, mood))]));
    const least = minOf(fitting.map((a) => late.get(a.id)));
    let waits;
    if (least > allowed + FITS) {
      waits = this.cause(request, now);
      this.tell(
        meta,
        "too-late",
        `would come ${least.toFixed(2)} s late, ${allowed.toFixed(2)} s are allowed; it waits for ${waits}`,
        false,
        least,
      );
      return [];
    }
    if (least > FITS) {
      waits = this.cause(request, now);
      this.tell(meta, "late", `comes ${least.toFixed(2)} s late; it waits for ${waits}`, true, least);
    }
    let timely = fitting.filter((a) => late.get(a.id) <= Math.max(least, 0) + FITS);
    for (const other of bound.after) {
      if (!mayShare(request, other.request)) {
        continue;
      }
      const both = timely.filter((a) => meets(a, other.request));
      let behind = 0;
      if (request.stroke !== null && other.request.stroke !== null) {
        behind = Math.max(0, request.stroke + Math.max(least, 0) - other.request.stroke);
      }
      if (both.length > 0 && other.request.late !== null && behind <= other.request.late + FITS) {
        timely = both;
        this.served.add(other.key);
        const message = `shares the stroke of '${request.id}'`;
        this.tell(other, "shared", message, true, behind, meta.key);
      }
    }
    const following = bound.after.filter((other) => !this.served.has(other.key));
    for (const other of following) {
      for (const slack of [0, slackOf(other.request)]) {
        const by = this.latest(other.request) + slack;
        const over = timely.filter((a) => this.over(a, request, now) <= by);
        if (over.length > 0) {
          return over;
        }
      }
    }
    return timely;
  }

  /** Return the reason why a request comes late. */
  cause(request, now) {
    if (now <= request.start + FITS) {
      return "its own preparation";
    }
    if (this.cues.length > 0 && this.ready >= now - FITS && this.cues[this.cues.length - 1].end >= this.free - FITS) {
      return `'${this.cues[this.cues.length - 1].action.name}', which plays until ${this.free.toFixed(2)} s`;
    }
    return this.cues.length > 0 ? "what comes before it" : "the time it became known at";
  }

  /** Return the latest time at which a requested action has to begin to be on time; never in the past. */
  latest(request) {
    if (request.stroke === null) {
      return request.start;
    }
    let least = Infinity;
    for (const action of this.graph.of(this.stance, request.kind)) {
      let fits = meets(action, request);
      if (request.action !== null) {
        fits = action.id === request.action;
      }
      if (fits && this.usable(action)) {
        const found = findPhases(this.project, action);
        const lead = found.stroke - found.skip(action.timing.blendIn);
        const speed = this.tempo(action, this.mood(request, request.stroke));
        least = Math.min(least, lead + drag(lead, speed));
      }
    }
    return request.stroke - least;
  }

  /** Return the earliest time at which the next action could begin after this one. */
  over(action, request, now) {
    const shape = this.shape(action, request, now, this.mood(request, now));
    return shape.start + hurried(this.project, action, shape) + this.project.settings.rest - FITS;
  }

  /**
   * Return when an action that should play to its end is left early all the same: early enough for the first following
   * request that can then be in time, late enough for its own stroke; infinity for never.
   */
  until(action, shape, bound) {
    if (bound.after.length === 0) {
      return Infinity;
    }
    const rest = this.project.settings.rest;
    const soonest = shape.start + hurried(this.project, action, shape);
    for (const other of bound.after) {
      const inTime = this.latest(other.request) + slackOf(other.request);
      if (!this.served.has(other.key) && soonest + rest <= inTime + FITS) {
        return Math.max(soonest, begins(other) - rest);
      }
    }
    return Infinity;
  }

  /**
   * Leave the running action early for the first request that can then be in time, or if it was `stopped`. An action that a
   * model wrote, or that is less important, is left at once; others are left where their retraction begins.
   */
  makeWay(running, asked, now, stopped) {
    if (stopped) {
      this.retract(now);
      return;
    }
    const cue = this.cues[this.cues.length - 1];
    if (running === null || cue.action.kind === "transition" || cue.end - cue.blendOut <= now) {
      return;
    }
    const atOnce = now + Math.max(cue.blendOut, RETRACTION);
    let retracts = atOnce;
    if (!running.written) {
      let once = cue.end - cue.start;
      if (cue.repeats) {
        once = Math.min(once, (cue.cycleTo - cue.entry) / cue.tempo + Math.max(cue.blendOut, RETRACTION));
      }
      const shape = new CueShape(
        cue.start,
        cue.entry,
        cue.end - cue.start,
        once,
        cue.holdFrom,
        cue.holdTo,
        cue.hold,
        cue.tempo,
      );
      retracts = Math.max(atOnce, cue.start + hurried(this.project, cue.action, shape));
    }
    const rest = this.project.settings.rest;
    for (const meta of asked) {
      const request = meta.request;
      const inTime = this.latest(request) + slackOf(request);
      const soonest = meta.rank > running.rank ? atOnce : retracts;
      if (request.late === null || meta.rank < running.rank || inTime < soonest + rest - FITS) {
        continue;
      }
      const end = Math.max(soonest, begins(meta) - rest);
      if (end < cue.end) {
        const out = Math.max(cue.blendOut, RETRACTION);
        const into = Math.min(cue.blendIn, Math.max(0, end - out - cue.start));
        this.cues[this.cues.length - 1] = but(cue, { end: end, blendIn: into, blendOut: out });
        this.free = end;
        this.ended.set(cue.action.id, end);
      }
      return;
    }
  }

  /** Leave the running action: it returns to its stance from where it is. A transition ends in the stance it leads to. */
  retract(now) {
    const cue = this.cues[this.cues.length - 1];
    const end = now + STOPPED;
    if (cue.action.kind === "transition" || cue.end - cue.blendOut <= now || cue.end <= end) {
      return;
    }
    this.cues[this.cues.length - 1] = but(cue, { end: end, blendOut: STOPPED });
    this.free = end;
    this.ended.set(cue.action.id, end);
  }

  /** Return the time from which an action may be drawn again. */
  cooled(action) {
    if (action.cooldown > 0 && this.ended.has(action.id)) {
      return this.ended.get(action.id) + action.cooldown;
    }
    return -Infinity;
  }

  /**
   * Return each action in turn: the transitions to get there, then the action itself; None if it is impossible or not
   * needed, or if the model wrote it and every candidate played too recently.
   */
  steps(meta, now) {
    const request = meta.request;
    const graph = this.graph;
    if (request.action !== null) {
      const action = graph.actions.get(request.action) ?? null;
      if (action === null || !graph.stances.has(action.stance)) {
        this.tell(meta, "unknown-action", `there is no action '${request.action}' in the ${graph.layer} layer`);
        return null;
      }
      if (action.kind === "stance") {
        return this.way(meta, action.stance);
      }
      if (!this.arrives(action)) {
        this.tell(meta, "no-stance", `'${action.name}' ends in a stance that has no loop`);
        return null;
      }
      if (action.stance === this.stance) {
        return [new SamplingStep([action])];
      }
      const way = this.way(meta, action.stance);
      return way === null ? null : [...way, new SamplingStep([action])];
    }
    if (request.stance !== null && ["transition", "stance"].includes(request.kind)) {
      if (!graph.stances.has(request.stance)) {
        this.tell(meta, "no-stance", `there is no stance '${request.stance}' in the ${graph.layer} layer`);
        return null;
      }
      return this.way(meta, request.stance);
    }
    const leads = meta.written ? this.leads(now) : "";
    if (leads !== "") {
      return this.way(meta, leads);
    }
    const here = node(this.stance, request.kind);
    if (!this.candidates.has(here)) {
      this.candidates.set(here, graph.of(this.stance, request.kind).filter((a) => this.usable(a)));
    }
    let every = this.candidates.get(here);
    if (request.among.length > 0) {
      every = every.filter((a) => request.among.includes(a.id));
    }
    let found = every;
    if (request.tags.length > 0) {
      found = every.filter((a) => request.tags.every((tag) => a.tags.includes(tag)));
    }
    let exact = found;
    if (request.limb !== null) {
      exact = found.filter((a) => a.limb === request.limb);
    }
    const directed = meta.written && this.project.settings.variety > 0;
    if (directed) { // the model's limb and tags are wishes, not orders
      every = this.fresh(meta, every, now);
      const fresh = new Set(every.map((a) => a.id));
      found = found.filter((a) => fresh.has(a.id));
      exact = exact.filter((a) => fresh.has(a.id));
      if (every.length === 0) {
        const moves = this.movesOn(meta, now);
        return moves.length > 0 ? [new SamplingStep(moves)] : null;
      }
      if (exact.length === 0) {
        exact = found.length > 0 ? found : every;
      }
    } else if (meta.written) { // nor worth playing the same again
      const again = (this.recent.get(here) ?? []).slice(-1);
      if (!exact.some((a) => !again.includes(a.id))) {
        exact = found.some((a) => !again.includes(a.id)) ? found : every;
      }
    }
    exact = this.modest(meta, exact, now);
    if (exact.length === 0) {
      const name = graph.stances.get(this.stance).name;
      let asked = [...request.tags, request.kind].join(" ");
      if (request.limb !== null) {
        asked = `${request.limb} ${asked}`;
      }
      if (found.length > 0) { // whose limb is a wish, too
        this.tell(meta, "other-limb", `stance '${name}' has no ${asked}; another will do`, true);
        return [new SamplingStep(found)];
      }
      const hint = meta.written ? "" : this.elsewhere(request);
      this.tell(meta, "no-candidate", `stance '${name}' has no ${asked}${hint}`);
      return null;
    }
    return [new SamplingStep(exact)];
  }

  elsewhere(request) {
    for (const action of [...this.graph.actions.values()]) {
      const fits = action.kind === request.kind
        && request.tags.every((tag) => action.tags.includes(tag))
        && (request.limb === null || request.limb === action.limb);
      if (fits && this.graph.stances.has(action.stance)) {
        return `; there is one in '${this.graph.stances.get(action.stance).name}'`;
      }
    }
    return "";
  }

  /** Return the transitions hop by hop from the current stance to `goal`. */
  way(meta, goal) {
    if (goal === this.stance) {
      const name = this.graph.stances.get(goal).name;
      this.tell(meta, "already-there", `the layer is in '${name}' already`, true);
      return null;
    }
    const stances = this.chain(goal);
    if (stances.length === 0) {
      const a = this.graph.stances.get(this.stance).name;
      const b = this.graph.stances.get(goal).name;
      this.tell(meta, "no-way", `no chain of transitions leads from '${a}' to '${b}'`);
      return null;
    }
    const steps = [];
    let at = this.stance;
    for (const following of stances) {
      const hops = this.graph.of(at, "transition").filter((a) => a.endStance === following && this.usable(a));
      steps.push(new SamplingStep(hops, following));
      at = following;
    }
    return steps;
  }

  /**
   * Return the stances after the current one on the shortest way of transitions that can play, the goal last; empty if there
   * is no way. Among equally short ways, the one whose transitions were placed first.
   */
  chain(goal) {
    const before = new Map([[this.stance, ""]]);
    const queue = [this.stance];
    let at = 0; // what is before it was looked at
    while (at < queue.length && !before.has(goal)) {
      const stance = queue[at];
      at += 1;
      for (const action of this.graph.of(stance, "transition")) {
        const end = action.endStance;
        if (end === null || before.has(end) || !this.graph.stances.has(end)) {
          continue;
        }
        if (this.usable(action)) {
          before.set(end, stance);
          queue.push(end);
        }
      }
    }
    const way = [];
    if (!before.has(goal)) {
      return way;
    }
    let step = goal;
    while (step !== this.stance) {
      way.push(step);
      step = before.get(step);
    }
    return [...[...way].reverse()];
  }

  /** Return whether an action leaves the layer in a stance that has a loop. */
  arrives(action) {
    const end = action.endStance;
    if (action.kind !== "transition") {
      return true;
    }
    return end !== null && this.graph.stances.has(end) && this.graph.of(end, "stance").length > 0;
  }

  usable(action) {
    return action.likelihood > 0 && this.arrives(action);
  }

  /** Return how an action would play for a request from `now` on, or as a step on the way to it. */
  shape(action, request, now, mood) {
    return shapeOf(this.project, action, request, now, this.tempo(action, mood));
  }

  /** Return the mood in which a request is played from `at` on, or at its stroke. */
  mood(request, at) {
    if (request === null) {
      return moodAt(this.moods, at);
    }
    const mood = moodAt(this.moods, request.stroke === null ? at : request.stroke);
    if (request.valence === null && request.arousal === null && request.intensity === null) {
      return mood;
    }
    return changed(mood, request.valence, request.arousal, request.intensity);
  }

  /** Return the speed of an action in a mood, 1 if it was made for the mood. */
  tempo(action, mood) {
    return (mood.neutral || madeFor(mood, action.tags)) ? 1 : tempo(mood);
  }

  /**
   * Return the extent of an action in a mood. Actions that move the feet, lead to another stance, touch something or were
   * made for the mood keep their extent.
   */
  extent(action, mood) {
    if (this.graph.layer === "body" || action.kind === "transition" || mood.neutral) {
      return 1;
    }
    return (action.contacts.length > 0 || action.tags.includes(HELD) || madeFor(mood, action.tags)) ? 1 : extent(mood);
  }

  /**
   * Draw with p_k ~ likelihood_k / max(c_k, 1), times the factors of mood and variety. Actions used too recently are left
   * out as long as others are left.
   */
  draw(candidates, key, now, mood) {
    const left = this.spaced(candidates);
    if (left.length === 1) {
      return left[0];
    }
    const neutral = mood.neutral;
    const weights = new Map();
    for (const a of left) {
      const favoured = neutral ? 1 : favour(mood, a.tags, measureVigour(this.project, a));
      const weight = a.likelihood / Math.max(this.count(a.id, now), 1) * favoured;
      weights.set(a.id, weight * this.variety(a, now));
    }
    if (![...weights.values()].some((w) => w > 0)) {
      return left[0];
    }
    const chosen = pick(this.seed, key, "action", weights);
    return left.find((a) => a.id === chosen);
  }

  /** Return the factor by which variety changes an action's likelihood. */
  variety(action, now) {
    const variety = this.project.settings.variety;
    if (variety <= 0) {
      return 1;
    }
    if (action.kind === "transition") {
      const talks = this.graph.layer === "arms" && modeAt(this.track, now) === "talking";
      return talks ? 1 + this.countFresh(action.endStance, now) : 1;
    }
    if (!this.ended.has(action.id)) {
      return 1;
    }
    const shows = this.shows(action);
    const needed = repeatInterval(action.kind, shows, this.beats) * variety;
    return freshness(now - this.ended.get(action.id), needed);
  }

  /** Return how much an action stands out. */
  shows(action) {
    if (!this.prominences.has(action.id)) {
      this.prominences.set(action.id, measureProminence(this.project, action));
    }
    return this.prominences.get(action.id);
  }

  /** Return the actions that the character may do by itself; see `director`. */
  fresh(meta, candidates, now) {
    const variety = this.project.settings.variety;
    const layer = this.graph.layer;
    if (meta.request.kind === "transition") {
      if (now < this.moved() + posture(layer) * variety) {
        return [];
      }
      if (layer === "arms" && now < this.acted + LEAST_LULL * variety) {
        return [];
      }
      if (layer !== "head") {
        return [...candidates];
      }
      if (this.stance === this.graph.start) {
        const leaves = uniform(this.seed, meta.key, "leaves") < LEAVES_HOME;
        return leaves ? [...candidates] : [];
      }
      const home = candidates.filter((a) => a.endStance === this.graph.start);
      const returns = home.length > 0 && uniform(this.seed, meta.key, "home") < GOES_HOME;
      return returns ? home : [...candidates];
    }
    const share = now < this.acted + LONG_REST * variety ? variety : variety * SHORTER;
    const reminded = this.shown(now - APART * variety);
    const converses = meta.request.kind === "fidget" && modeAt(this.track, now) !== "idle";
    const out = [];
    for (const action of candidates) {
      const shows = this.shows(action);
      if ((reminded || converses) && shows >= STANDS_OUT) {
        continue;
      }
      const needed = repeatInterval(action.kind, shows, this.beats) * share;
      if (!this.ended.has(action.id) || now >= this.ended.get(action.id) + needed) {
        out.push(action);
      }
    }
    return out;
  }

  /**
   * Return the candidates for a requested fidget in a conversation without those that stand out, if others are left and no
   * tags are requested; else all.
   */
  modest(meta, candidates, now) {
    const request = meta.request;
    const every = [...candidates];
    if (request.kind !== "fidget" || request.tags.length > 0 || this.project.settings.variety <= 0) {
      return every;
    }
    if (meta.written || modeAt(this.track, now) === "idle") {
      return every;
    }
    const left = every.filter((a) => this.shows(a) < STANDS_OUT);
    return left.length > 0 ? left : every;
  }

  /**
   * Return the transitions of the arms that may play for a gesture where all gestures of the stance have played too
   * recently, and others of another stance have not.
   */
  movesOn(meta, now) {
    const out = [];
    if (this.graph.layer !== "arms" || meta.request.kind !== "gesture" || this.track.staysAt("arms", now)) {
      return out;
    }
    const variety = this.project.settings.variety;
    if (now < this.moved() + posture("arms") * variety || now < this.acted + LEAST_LULL * variety) {
      return out;
    }
    for (const action of this.graph.of(this.stance, "transition")) {
      if (this.usable(action) && this.countFresh(action.endStance, now) > 0) {
        out.push(action);
      }
    }
    return out;
  }

  /** Return how many gestures of a stance have not played for long enough. */
  countFresh(stance, now) {
    if (stance === null) {
      return 0;
    }
    const variety = this.project.settings.variety;
    let count = this.graph.of(stance, "gesture").length;
    for (const { 0: ident, 1: end } of this.ended) {
      const action = this.graph.actions.get(ident) ?? null;
      if (action === null || action.kind !== "gesture" || action.stance !== stance) {
        continue;
      }
      const shows = this.shows(action);
      if (now < end + repeatInterval("gesture", shows, this.beats) * variety) {
        count -= 1;
      }
    }
    return count;
  }

  /** Return when the stance was last changed; minus infinity for never. */
  moved() {
    let latest = -Infinity;
    for (const { 0: ident, 1: end } of this.ended) {
      const action = this.graph.actions.get(ident) ?? null;
      if (action !== null && action.kind === "transition") {
        latest = Math.max(latest, end);
      }
    }
    return latest;
  }

  /** Return whether an act that stands out was done since a time. */
  shown(since) {
    for (const { 0: ident, 1: end } of this.ended) {
      const action = this.graph.actions.get(ident) ?? null;
      if (action === null || action.kind === "transition" || end < since) {
        continue;
      }
      if (this.shows(action) >= STANDS_OUT) {
        return true;
      }
    }
    return false;
  }

  /** Leave out actions that need more other actions before they play again. If nothing is left, all need one less, and so on. */
  spaced(candidates) {
    const default_ = this.project.settings.neverTwice ? 1 : 0;
    const first = candidates[0];
    const before = this.recent.get(node(first.stance, first.kind)) ?? [];
    if (candidates.length < 2 || before.length === 0) {
      return candidates;
    }
    const needs = new Map(candidates.map((a) => [a.id, a.spacing === null ? default_ : a.spacing]));
    for (let less = 0; less < maxOf(candidates.map((a) => needs.get(a.id))) + 1; less++) {
      const left = candidates.filter((a) => rested(before, a.id, needs.get(a.id) - less));
      if (left.length > 0) {
        return left;
      }
    }
    return candidates;
  }

  /** Return c_k of section 6.2, alpha times the uses, over the settings' memory. */
  count(ident, now) {
    const memory = this.project.settings.memory;
    const alpha = this.project.settings.alpha;
    if (memory <= 0) {
      return alpha * (this.uses.get(ident) ?? 0);
    }
    let used = 0;
    for (const cue of [...this.cues].reverse()) {
      if (cue.start < now - memory) {
        break;
      }
      if (cue.action.id === ident) {
        used += 1;
      }
    }
    return alpha * used;
  }

  /** hops: whether it is a transition on the way to the requested action. */
  cue(action, shape, bound, hops, stance, mood) {
    let length = shape.length;
    let into = Math.max(0, action.timing.blendIn);
    let out = Math.max(0, action.timing.blendOut);
    const { 0: begin, 1: until } = this.project.span(action);
    const cycle = cycleOf(action.kind, action.timing, begin, until);
    if (action.timing.earliestExit !== null || cycle > 0) {
      const wish = hops ? Infinity : bound.wish;
      length = Math.min(length, Math.max(shape.shortest, Math.min(bound.limit, wish) - shape.start));
    } else if (!hops) {
      length = Math.min(length, this.until(action, shape, bound) - shape.start);
      if (length < shape.length) {
        out = Math.max(out, RETRACTION);
      }
    }
    if (shape.entry > begin) {
      into = Math.max(into, LEAST_BLEND);
    }
    const squeeze = into + out > 0 ? Math.min(1, length / (into + out)) : 1;
    let then = stance;
    if (action.kind === "transition" && action.endStance !== null) {
      then = action.endStance;
    }
    const end = shape.start + length;
    return new Cue(
      action,
      shape.start,
      end,
      shape.entry,
      into * squeeze,
      out * squeeze,
      stance,
      then,
      bound.meta.key,
      shape.holdFrom,
      shape.holdTo,
      shape.hold,
      this.extent(action, mood),
      shape.tempo,
      cycle > 0 ? begin : 0,
      cycle > 0 ? begin + cycle : 0,
    );
  }

  keep(cue) {
    this.note(cue, cue.then);
    const loop = this.loop(cue.then, cue.meta);
    if (loop !== null) {
      // The loop begins again under the action, so that the action's last pose meets the loop's first.
      // On joints that the action does not move, the change shows. It takes its time there, like a
      // transition.
      const partial = cue.action.limb !== "both" || cue.action.joints.length > 0 || cue.action.jointWeights.length > 0;
      let begin = cue.start + cue.blendIn;
      const until = cue.end - cue.blendOut;
      let fade = Math.max(0, until - begin);
      if (partial) {
        fade = cue.then !== cue.stance ? cue.end - cue.start : Math.min(LOOP_FADE, cue.end - cue.start);
        begin = Math.max(cue.start, until - fade);
      }
      this.rests.push(new Rest(cue.then, loop, until, begin, fade));
    }
  }

  /** Return one of a stance's loops, drawn by likelihood; None if it has none. */
  loop(stance, key) {
    const loops = this.graph.of(stance, "stance");
    if (loops.length === 1) {
      return loops[0];
    }
    const weights = new Map(loops.filter((a) => a.likelihood > 0).map((a) => [a.id, a.likelihood]));
    if (weights.size === 0) {
      return loops.length > 0 ? loops[0] : null;
    }
    const chosen = pick(this.seed, key, "loop", weights);
    return loops.find((a) => a.id === chosen);
  }

  /** Change between the loops of a stance in long rests, at the end of a loop. */
  varyRests(end) {
    const out = [];
    for (const { 0: place, 1: rest } of this.rests.entries()) {
      out.push(rest);
      const loops = this.graph.of(rest.stance, "stance");
      if (loops.length < 2) {
        continue;
      }
      const until = place + 1 < this.rests.length ? this.rests[place + 1].fadeStart : end;
      let current = rest;
      let change = rest.start;
      while (true) {
        const { 0: start, 1: stop } = this.project.span(current.action);
        change += Math.max(1, stop - start - current.action.timing.blendIn);
        if (!(change <= until)) { // nor when it is no number
          break;
        }
        const loop = this.loop(rest.stance, `${this.graph.layer}/${thousandths(change)}`);
        if (loop !== null && loop.id !== current.action.id) {
          current = new Rest(rest.stance, loop, change, change - LOOP_FADE, LOOP_FADE);
          out.push(current);
        }
      }
    }
    this.rests = out;
  }

  tell(meta, outcome, message, played = false, late = 0, by = "") {
    const layer = this.graph.layer;
    this.reports.push(new Report(meta.request.id, outcome, message, layer, meta.start, played, meta.written, late, by));
  }
}

/**
 * Return the performer as it is after a past and the cues that played since.
 * @param {Project} project
 * @param {MetaGraph} graph
 * @param {number} seed
 * @param {string} begin
 * @param {Past} past
 * @param {Cue[]} cues
 * @param {Moods} moods
 * @param {Track} track
 * @returns {Performer}
 */
export function performerAfter(project, graph, seed, begin, past, cues, moods, track) {
  const stance = graph.stances.has(past.stance) ? past.stance : begin;
  const out = new Performer(
    project,
    graph,
    seed,
    stance,
    moods,
    track,
    past.free,
    past.free,
    new Map(past.uses),
    new Map(past.recent),
    new Map(past.ended),
  );
  out.beats = beatInterval(graph.layer, [...graph.actions.values()].filter((a) => a.kind === "gesture").length);
  for (const cue of cues) {
    out.note(cue, graph.stances.has(cue.then) ? cue.then : begin);
  }
  return out;
}
