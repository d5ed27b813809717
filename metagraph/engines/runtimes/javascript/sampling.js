/**
 * From a meta plan to specific actions: candidates, the three temporal cases, the draw (Borer et al., section 6.2).
 *
 * Translated from metagraph/playback/sampling.py; change that, and translate anew.
 */

import { begins, bounds } from "./bounds.js";
import { pick } from "./choice.js";
import { LEAST_BLEND } from "./phase_times.js";
import { phases } from "./phases.js";
import { Cue, Report, Rest } from "./meta_plan.js";
import { REMEMBERED, node, remember } from "./remembering.js";
import { but, maxOf, minOf, thousandths } from "./basics.js";

export const FITS = 1e-06; // seconds by which sums of times may be off
export const HURRY = 2; // a hold is played at most this many times as fast as it was made
export const RETRACTION = 0.4; // seconds in which an action whose retraction is cut goes back to its stance, at the least
export const SHARED = 0.25; // seconds within which two strokes may be one
export const LOOP_FADE = 0.6; // seconds of crossfade when a long rest changes from one loop of its stance to another

/**
 * One action of a chain: who may play it, and for a transition on the way the stance it leads to.
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
 * How an action would play: from `start` on, `length` seconds, at least `shortest`; the rest as in a cue.
 *
 * start: number; entry: number; length: number; shortest: number; holdFrom: number; holdTo: number; hold: number.
 */
export class CueShape {
  constructor(start, entry, length, shortest, holdFrom = 0, holdTo = 0, hold = 0) {
    this.start = start;
    this.entry = entry;
    this.length = length;
    this.shortest = shortest;
    this.holdFrom = holdFrom;
    this.holdTo = holdTo;
    this.hold = hold;
  }
}

/**
 * One layer being planned, cue after cue. Mutable while planning; nothing of it leaves the planner.
 *
 * uses: how often each action was used. recent: the last draws of each `node`. ended: when each action ended. begun: keys of
 * meta actions whose chain of transitions plays already. served: keys of those that another's action serves, too.
 *
 * project: Project; graph: MetaGraph; seed: number; stance: string; free: number; uses: Map<string, number>; recent:
 * Map<string, string[]>; ended: Map<string, number>; cues: Cue[]; rests: Rest[]; reports: Report[]; begun: Set<string>;
 * served: Set<string>.
 */
export class Performer {
  constructor(
    project,
    graph,
    seed,
    stance,
    free = 0,
    uses = new Map(),
    recent = new Map(),
    ended = new Map(),
    cues = [],
    rests = [],
    reports = [],
    begun = new Set([]),
    served = new Set([]),
  ) {
    this.project = project;
    this.graph = graph;
    this.seed = seed;
    this.stance = stance;
    this.free = free;
    this.uses = uses;
    this.recent = recent;
    this.ended = ended;
    this.cues = cues;
    this.rests = rests;
    this.reports = reports;
    this.begun = begun;
    this.served = served;
  }

  /** Take a cue as played. */
  note(cue, then) {
    this.cues.push(cue);
    this.free = cue.end;
    this.stance = then;
    remember(cue, this.uses, this.recent, this.ended);
  }

  /** When the next action may begin at the earliest. */
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

  /** Realise what starts before `end` of a conflict-free meta plan, in order. */
  perform(metas, end) {
    for (const bound of bounds(metas)) {
      const meta = bound.meta;
      if (begins(meta) >= end) {
        continue;
      }
      if (this.served.has(meta.key)) {
        continue;
      }
      if (meta.request.late !== null) {
        this.realise(bound, Math.max(this.ready, begins(meta)));
        continue;
      }
      if (meta.end <= this.ready + FITS && meta.start < this.ready && !this.begun.has(meta.key)) {
        let running = "the running action";
        if (this.cues.length > 0) {
          running = `'${this.cues[this.cues.length - 1].action.name}'`;
        }
        const waits = this.ready - meta.request.start;
        // What is wanted for a certain time is over; what is wanted once may come late.
        if (meta.written || meta.request.duration !== null || waits > this.project.settings.wait) {
          this.tell(meta, "covered", `wholly covered by ${running}, which plays until ${this.free.toFixed(2)} s`);
          continue;
        }
        this.tell(meta, "queued", `waits ${waits.toFixed(2)} s for ${running}`, true);
      }
      this.realise(bound, Math.max(this.ready, meta.start));
    }
  }

  realise(bound, now) {
    const meta = bound.meta;
    const limit = bound.limit;
    const steps = this.steps(meta);
    if (steps === null) {
      return;
    }
    const cues = [];
    let stance = this.stance;
    for (const step of steps) {
      const hops = step.hop !== "";
      const asked = hops ? null : meta.request;
      let fitting = [...step.candidates];
      if (limit < Infinity) { // else all fit
        fitting = step.candidates.filter((a) => this.fits(this.shape(a, asked, now), limit));
      }
      if (fitting.length === 0) {
        const before = meta.written ? "" : " before something more important";
        this.tell(meta, "no-room", `nothing fits into the ${Math.max(0, limit - now).toFixed(2)} s${before}`);
        return;
      }
      if (!hops && meta.request.action === null) {
        const warm = fitting.filter((a) => a.cooldown <= 0 || this.cooled(a) <= this.shape(a, asked, now).start + FITS);
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
      const action = this.draw(fitting, hops ? `${meta.key}/${step.hop}` : meta.key, now);
      const shape = this.shape(action, asked, now);
      const cue = this.cue(action, shape, bound, hops, stance);
      cues.push(cue);
      now = cue.end;
      stance = cue.then;
    }
    for (const one of cues) {
      this.keep(one);
    }
  }

  /**
   * Return those that come least late, if that is not too late; of them those that leave most of what follows its time, and
   * serve most of it.
   */
  timely(bound, fitting, now) {
    const meta = bound.meta;
    const request = meta.request;
    const allowed = this.slack(request);
    const late = new Map(fitting.map((a) => [a.id, this.lateness(a, request, this.shape(a, request, now))]));
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
      if (!this.shares(request, other.request)) {
        continue;
      }
      const both = timely.filter((a) => this.meets(a, other.request));
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
      for (const slack of [0, this.slack(other.request)]) {
        const by = this.latest(other.request) + slack;
        const over = timely.filter((a) => this.over(a, request, now) <= by);
        if (over.length > 0) {
          return over;
        }
      }
    }
    return timely;
  }

  /**
   * Return by how many seconds an action that plays so comes late, at its stroke where one is asked for; less than 0 before
   * its time.
   */
  lateness(action, request, shape) {
    if (request.stroke !== null && action.kind === "gesture") {
      const found = phases(this.project, action);
      return shape.start + found.stroke - shape.entry - request.stroke;
    }
    return shape.start - request.start;
  }

  /** Return what a request that comes late waits for. */
  cause(request, now) {
    if (now <= request.start + FITS) {
      return "its own preparation";
    }
    if (this.cues.length > 0 && this.ready >= now - FITS && this.cues[this.cues.length - 1].end >= this.free - FITS) {
      return `'${this.cues[this.cues.length - 1].action.name}', which plays until ${this.free.toFixed(2)} s`;
    }
    return this.cues.length > 0 ? "what comes before it" : "the time it became known at";
  }

  /** Whether two requests may be met by one stroke. */
  shares(request, other) {
    if (request.stroke === null || other.stroke === null) {
      return false;
    }
    return request.action === null
      && other.action === null
      && request.kind === other.kind
      && (other.hold === null || other.hold === request.hold)
      && Math.abs(request.stroke - other.stroke) <= SHARED;
  }

  /** Whether an action is what a request for any asks for. */
  meets(action, request) {
    return request.tags.every((tag) => action.tags.includes(tag))
      && (request.limb === null || action.limb === request.limb)
      && (request.among.length === 0 || request.among.includes(action.id));
  }

  /**
   * Return when something that is asked for has to begin at the latest, to be on time; never in the past, where nothing
   * meets it.
   */
  latest(request) {
    if (request.stroke === null) {
      return request.start;
    }
    let least = Infinity;
    for (const action of this.graph.of(this.stance, request.kind)) {
      let fits = this.meets(action, request);
      if (request.action !== null) {
        fits = action.id === request.action;
      }
      if (fits && this.usable(action)) {
        const found = phases(this.project, action);
        least = Math.min(least, found.stroke - found.skip(action.timing.blendIn));
      }
    }
    return request.stroke - least;
  }

  /** Return by how many seconds a request may come late, 0 where it does not say. */
  slack(request) {
    return request.late === null ? 0 : request.late;
  }

  /** Return when what follows an action could begin at the earliest. */
  over(action, request, now) {
    const shape = this.shape(action, request, now);
    return shape.start + this.hurried(action, shape) + this.project.settings.rest - FITS;
  }

  /** Return the seconds that a gesture takes whose retraction is cut, and whose hold is left out, unless it was asked for. */
  hurried(action, shape) {
    if (action.kind !== "gesture" || action.timing.earliestExit !== null) {
      return shape.shortest;
    }
    const found = phases(this.project, action);
    let left = found.relax - shape.entry + shape.hold - (shape.holdTo - shape.holdFrom);
    if (shape.hold <= 0) {
      left = found.strokeEnd - shape.entry;
    }
    return Math.min(shape.length, left + Math.max(action.timing.blendOut, RETRACTION));
  }

  /**
   * Return when an action that is to be played through is left nevertheless: early enough for the first of what follows that
   * can be in time then, late enough for its own stroke; infinity for never.
   */
  until(action, shape, bound) {
    const rest = this.project.settings.rest;
    const soonest = shape.start + this.hurried(action, shape);
    for (const other of bound.after) {
      const inTime = this.latest(other.request) + this.slack(other.request);
      if (!this.served.has(other.key) && soonest + rest <= inTime + FITS) {
        return Math.max(soonest, begins(other) - rest);
      }
    }
    return Infinity;
  }

  /**
   * Leave the running action early for the first of what is asked for that can be in time then. What a model wrote is left
   * at once, what was asked for where its retraction begins.
   */
  makeWay(running, asked, now) {
    const cue = this.cues[this.cues.length - 1];
    if (running === null || cue.action.kind === "transition" || cue.end - cue.blendOut <= now) {
      return;
    }
    let soonest = now + Math.max(cue.blendOut, RETRACTION);
    if (!running.written) {
      const shape = new CueShape(
        cue.start,
        cue.entry,
        cue.end - cue.start,
        cue.end - cue.start,
        cue.holdFrom,
        cue.holdTo,
        cue.hold,
      );
      soonest = Math.max(soonest, cue.start + this.hurried(cue.action, shape));
    }
    const rest = this.project.settings.rest;
    for (const meta of asked) {
      const request = meta.request;
      const inTime = this.latest(request) + this.slack(request);
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

  /** Whether something that plays so is over by a limit. */
  fits(shape, limit) {
    return shape.start + shape.shortest <= limit + FITS;
  }

  /** Return when an action may be drawn again. */
  cooled(action) {
    if (action.cooldown > 0 && this.ended.has(action.id)) {
      return this.ended.get(action.id) + action.cooldown;
    }
    return -Infinity;
  }

  /** Return each action in turn: the transitions to get there, then the action itself; None if impossible or needless. */
  steps(meta) {
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
    let every = graph.of(this.stance, request.kind).filter((a) => this.usable(a));
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
    if (meta.written) { // the model's limb and tags are wishes, not orders, nor worth playing the same again
      const again = (this.recent.get(node(this.stance, request.kind)) ?? []).slice(-1);
      if (!exact.some((a) => !again.includes(a.id))) {
        exact = found.some((a) => !again.includes(a.id)) ? found : every;
      }
    }
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
   * Return the stances after the current one on the shortest way of transitions that can play, the goal last; none where
   * there is no way. Among equally short ones that whose transitions were placed first.
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

  /** Whether an action leaves the layer in a stance that can rest. */
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
  shape(action, request, now) {
    const [start, end] = this.project.span(action);
    let begin = now;
    let entry = start;
    let holdFrom = 0;
    let holdTo = 0;
    let hold = 0;
    if (request !== null
      && action.kind === "gesture"
      && (request.hold !== null || request.stroke !== null || !request.prepare)) {
      const found = phases(this.project, action);
      const latest = found.skip(action.timing.blendIn);
      entry = request.prepare ? start : latest;
      // Wait for the stroke, or catch up with it by cutting the preparation.
      if (request.stroke !== null) {
        begin = Math.max(now, request.stroke - (found.stroke - entry));
        entry = Math.min(Math.max(entry, found.stroke - Math.max(0, request.stroke - begin)), Math.max(entry, latest));
      }
      if (request.hold !== null) {
        holdFrom = found.strokeEnd;
        holdTo = found.relax;
        hold = Math.max(request.hold, (holdTo - holdFrom) / HURRY);
        if (hold <= 0) {
          holdFrom = 0;
          holdTo = 0;
        }
      }
    }
    const length = end - entry + hold - (holdTo - holdFrom);
    let shortest = length;
    const exitAt = action.timing.earliestExit;
    if (exitAt !== null) {
      const left = exitAt - entry + (exitAt >= holdTo ? hold - (holdTo - holdFrom) : 0);
      shortest = Math.min(length, Math.max(0, left) + action.timing.blendOut);
    }
    return new CueShape(begin, entry, length, shortest, holdFrom, holdTo, hold);
  }

  /** Draw with p_k ~ likelihood_k / max(c_k, 1), leaving out those used too recently as long as any others are left. */
  draw(candidates, key, now) {
    const left = this.spaced(candidates);
    const weights = new Map(left.map((a) => [a.id, a.likelihood / Math.max(this.count(a.id, now), 1)]));
    if (![...weights.values()].some((w) => w > 0)) {
      return left[0];
    }
    const chosen = pick(this.seed, key, "action", weights);
    return left.find((a) => a.id === chosen);
  }

  /** Leave out what needs more other actions before it plays again; where that leaves nothing, all need one less, and so on. */
  spaced(candidates) {
    const default_ = this.project.settings.neverTwice ? 1 : 0;
    const first = candidates[0];
    const before = this.recent.get(node(first.stance, first.kind)) ?? [];
    if (candidates.length < 2 || before.length === 0) {
      return candidates;
    }
    // How many came after each.
    const since = new Map(before.map((ident, place) => [ident, before.length - 1 - place]));
    const needs = new Map(candidates.map((a) => [a.id, a.spacing === null ? default_ : a.spacing]));
    for (let less = 0; less < maxOf(candidates.map((a) => needs.get(a.id))) + 1; less++) {
      const left = candidates.filter((a) => (since.get(a.id) ?? REMEMBERED) >= needs.get(a.id) - less);
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

  /** hops: whether it is a transition on the way to what is asked for. */
  cue(action, shape, bound, hops, stance) {
    let length = shape.length;
    let into = Math.max(0, action.timing.blendIn);
    let out = Math.max(0, action.timing.blendOut);
    if (action.timing.earliestExit !== null) {
      const wish = hops ? Infinity : bound.wish;
      length = Math.min(length, Math.max(shape.shortest, Math.min(bound.limit, wish) - shape.start));
    } else if (!hops) {
      length = Math.min(length, this.until(action, shape, bound) - shape.start);
      if (length < shape.length) {
        out = Math.max(out, RETRACTION);
      }
    }
    if (shape.entry > this.project.span(action)[0]) {
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
    );
  }

  keep(cue) {
    this.note(cue, cue.then);
    const loop = this.loop(cue.then, cue.meta);
    if (loop !== null) {
      // The loop begins anew under the action, so that the action's last pose meets the loop's first.
      // Where the action leaves joints alone the change shows, and takes its time: a transition all of
      // its own.
      const partial = cue.action.limb !== "both" || cue.action.joints.length > 0;
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

  /** Return one of a stance's loops, drawn by likelihood; None where it has none. */
  loop(stance, key) {
    const loops = this.graph.of(stance, "stance");
    const weights = new Map(loops.filter((a) => a.likelihood > 0).map((a) => [a.id, a.likelihood]));
    if (weights.size === 0) {
      return loops.length > 0 ? loops[0] : null;
    }
    const chosen = pick(this.seed, key, "loop", weights);
    return loops.find((a) => a.id === chosen);
  }

  /** Where a stance has several loops, change between them in long rests, at a loop's end. */
  varyRests(end) {
    const out = [];
    for (const [place, rest] of this.rests.entries()) {
      out.push(rest);
      const loops = this.graph.of(rest.stance, "stance");
      if (loops.length < 2) {
        continue;
      }
      const until = place + 1 < this.rests.length ? this.rests[place + 1].fadeStart : end;
      let current = rest;
      let change = rest.start;
      while (true) {
        const [start, stop] = this.project.span(current.action);
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
 * Return the performer that stands where cues have been played after a past.
 * @param {Project} project
 * @param {MetaGraph} graph
 * @param {number} seed
 * @param {string} begin
 * @param {Past} past
 * @param {Cue[]} cues
 * @returns {Performer}
 */
export function performerAfter(project, graph, seed, begin, past, cues) {
  const stance = graph.stances.has(past.stance) ? past.stance : begin;
  const out = new Performer(
    project,
    graph,
    seed,
    stance,
    past.free,
    new Map(past.uses),
    new Map(past.recent),
    new Map(past.ended),
  );
  for (const cue of cues) {
    out.note(cue, graph.stances.has(cue.then) ? cue.then : begin);
  }
  return out;
}
