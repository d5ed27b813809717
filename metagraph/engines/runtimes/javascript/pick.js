/** From a meta plan to specific actions: candidates, the three temporal cases, the draw (Borer et al., section 6.2). */

import { pick } from "./choice.js";
import { Report } from "./meta_plan.js";
import { REMEMBERED, clipSeconds, nodeOf, remember, s } from "./plan.js";

export const FITS = 1e-6; // seconds by which sums of times may be off

/**
 * One layer being planned, cue after cue. Changes while planning; nothing of it leaves the planner.
 *
 * stance: what the layer is in. free: when its last cue ends. begun: keys of meta actions whose chain of transitions plays
 * already. uses, recent, ended: how actions were used so far, as in a plan's past.
 */
export class Performer {
  /** Begins where `cues` have been played after a `past`; `begin`: the stance to fall back on. */
  constructor(graph, layer, seed, begin, past, cues) {
    this.settings = graph.settings;
    this.graph = graph.layers[layer];
    this.seed = seed;
    this.stance = this.graph.stances.has(past.stance) ? past.stance : begin;
    this.free = past.free;
    this.uses = new Map(past.uses);
    this.recent = new Map(past.recent);
    this.ended = new Map(past.ended);
    this.cues = [];
    this.rests = [];
    this.reports = [];
    this.begun = new Set();
    for (const cue of cues) this.note(cue, this.graph.stances.has(cue.then) ? cue.then : begin);
  }

  note(cue, then) {
    this.cues.push(cue);
    this.free = cue.end;
    this.stance = then;
    remember(cue, this);
  }

  /** When the next action may begin at the earliest. */
  get ready() {
    return this.free + (this.ended.size ? this.settings.rest : 0);
  }

  /** Lay the first loop down; return whether the layer can perform at all. */
  begin(stance) {
    const action = this.loop(stance, `rest/${this.graph.layer}`);
    if (action) this.rests.push({ stance, action, start: 0, fadeStart: 0, fade: 0 });
    return Boolean(action);
  }

  /** Realise what starts before `end` of a conflict-free meta plan, in order. */
  perform(metas, end) {
    for (const { meta, limit, wish } of bounds(metas)) {
      if (meta.start >= end) return;
      if (meta.end <= this.ready + FITS && meta.start < this.ready && !this.begun.has(meta.key)) {
        const running = this.cues.length ? `'${this.cues[this.cues.length - 1].action.name}'` : "the running action";
        const waits = this.ready - meta.request.start;
        // What is wanted for a certain time is over; what is wanted once may come late.
        if (meta.written || meta.request.duration !== null || waits > this.settings.wait) {
          this.tell(meta, "covered", `wholly covered by ${running}, which plays until ${s(this.free)}`);
          continue;
        }
        this.tell(meta, "queued", `waits ${s(waits)} for ${running}`, true);
      }
      this.realise(meta, Math.max(this.ready, meta.start), limit, wish);
    }
  }

  realise(meta, now, limit, wish) {
    const cues = [];
    let stance = this.stance;
    for (const { candidates, hop } of this.steps(meta) ?? []) {
      const asked = hop ? null : meta.request;
      const shape = (action) => this.shape(action, asked, now);
      let fitting = candidates;
      if (limit < Infinity) fitting = candidates.filter((a) => shape(a).start + shape(a).shortest <= limit + FITS);
      if (!fitting.length) {
        const before = meta.written ? "" : " before something more important";
        return this.tell(meta, "no-room", `nothing fits into the ${s(Math.max(0, limit - now))}${before}`);
      }
      if (!hop && meta.request.action === null) {
        const warm = fitting.filter((a) => a.cooldown <= 0 || this.cooled(a) <= shape(a).start + FITS);
        if (!warm.length) {
          const soonest = Math.min(...fitting.map((a) => this.cooled(a)));
          return this.tell(meta, "cooling", `all that fit are cooling down; the first may play again at ${s(soonest)}`);
        }
        fitting = warm;
      }
      const key = hop ? `${meta.key}/${hop}` : meta.key;
      const action = this.draw(fitting, key, now);
      const cue = this.cue(action, shape(action), limit, hop ? Infinity : wish, stance, meta.key);
      cues.push(cue);
      now = cue.end;
      stance = cue.then;
    }
    for (const cue of cues) this.keep(cue);
  }

  /** Return when an action may be drawn again. */
  cooled(action) {
    return action.cooldown > 0 && this.ended.has(action.id) ? this.ended.get(action.id) + action.cooldown : -Infinity;
  }

  /** Return each action in turn: the transitions to get there, then the action itself; null if impossible or needless. */
  steps(meta) {
    const { request } = meta;
    const { graph } = this;
    if (request.action !== null) {
      const action = graph.actions.get(request.action);
      if (!action || !graph.stances.has(action.stance)) {
        return this.tell(meta, "unknown-action", `there is no action '${request.action}' in the ${graph.layer} layer`);
      }
      if (action.kind === "stance") return this.way(meta, action.stance);
      if (!graph.arrives(action)) return this.tell(meta, "no-stance", `'${action.name}' ends in a stance that has no loop`);
      const way = action.stance === this.stance ? [] : this.way(meta, action.stance);
      return way && [...way, { candidates: [action], hop: "" }];
    }
    if (request.stance !== null && (request.kind === "transition" || request.kind === "stance")) {
      if (graph.stances.has(request.stance)) return this.way(meta, request.stance);
      return this.tell(meta, "no-stance", `there is no stance '${request.stance}' in the ${graph.layer} layer`);
    }
    let every = graph.of(this.stance, request.kind).filter((a) => this.usable(a));
    if (request.among.length) every = every.filter((a) => request.among.includes(a.id));
    const found = every.filter((a) => request.tags.every((tag) => a.tags.includes(tag)));
    let exact = request.limb === null ? found : found.filter((a) => a.limb === request.limb);
    if (meta.written) {
      // The model's limb and tags are wishes, not orders, nor worth playing the same again.
      const again = (this.recent.get(nodeOf(this.stance, request.kind)) ?? []).slice(-1);
      exact = [exact, found, every].find((some) => some.some((a) => !again.includes(a.id))) ?? every;
    }
    if (exact.length) return [{ candidates: exact, hop: "" }];
    const asked = [request.limb ?? "", ...request.tags, request.kind].filter(Boolean).join(" ");
    const lacks = `stance '${graph.stances.get(this.stance).name}' has no ${asked}`;
    if (!found.length) return this.tell(meta, "no-candidate", lacks);
    this.tell(meta, "other-limb", `${lacks}; another will do`, true); // a limb is a wish, too
    return [{ candidates: found, hop: "" }];
  }

  /** Return the transitions hop by hop from the current stance to `goal`. */
  way(meta, goal) {
    const { graph } = this;
    const name = (stance) => graph.stances.get(stance).name;
    if (goal === this.stance) return this.tell(meta, "already-there", `the layer is in '${name(goal)}' already`, true);
    const stances = this.chain(goal);
    if (!stances) return this.tell(meta, "no-way", `no chain of transitions leads from '${name(this.stance)}' to '${name(goal)}'`);
    let at = this.stance;
    return stances.map((hop) => {
      const candidates = graph.of(at, "transition").filter((a) => a.endStance === hop && this.usable(a));
      at = hop;
      return { candidates, hop };
    });
  }

  /** Return the stances on the shortest way to `goal`; of equally short ones that whose transitions were placed first. */
  chain(goal) {
    const before = new Map([[this.stance, null]]);
    for (const stance of before.keys()) {
      for (const action of this.graph.of(stance, "transition")) {
        if (before.has(action.endStance) || !this.usable(action)) continue;
        before.set(action.endStance, stance);
        if (action.endStance !== goal) continue;
        const way = [];
        for (let at = goal; at !== this.stance; at = before.get(at)) way.unshift(at);
        return way;
      }
    }
    return null;
  }

  usable(action) {
    return action.likelihood > 0 && this.graph.arrives(action);
  }

  /** Return how an action would play for a request from `now` on: its times, and `shortest`, the seconds it takes at least. */
  shape(action, request, now) {
    const { start, end } = action;
    const { hurry, leastBlend } = this.settings;
    let [begin, entry, holdFrom, holdTo, hold] = [now, start, 0, 0, 0];
    const special = request && (request.hold !== null || request.stroke !== null || !request.prepare);
    if (special && action.kind === "gesture") {
      const found = action.phases;
      const latest = Math.max(start, found.ready - Math.max(action.blendIn, leastBlend)); // as late as it can blend in and be ready
      entry = request.prepare ? start : latest;
      if (request.stroke !== null) {
        // Wait for the stroke, or catch up with it by cutting the preparation.
        begin = Math.max(now, request.stroke - (found.stroke - entry));
        entry = Math.min(Math.max(entry, found.stroke - Math.max(0, request.stroke - begin)), Math.max(entry, latest));
      }
      if (request.hold !== null) {
        [holdFrom, holdTo] = [found.strokeEnd, found.relax];
        hold = Math.max(request.hold, (holdTo - holdFrom) / hurry);
        if (hold <= 0) holdFrom = holdTo = 0;
      }
    }
    const length = end - entry + hold - (holdTo - holdFrom);
    let shortest = length;
    if (action.earliestExit !== null) {
      const left = action.earliestExit - entry + (action.earliestExit >= holdTo ? hold - (holdTo - holdFrom) : 0);
      shortest = Math.min(length, Math.max(0, left) + action.blendOut);
    }
    return { start: begin, entry, length, shortest, holdFrom, holdTo, hold };
  }

  /** Draw with p_k ~ likelihood_k / max(c_k, 1), leaving out those used too recently as long as any others are left. */
  draw(candidates, key, now) {
    const left = this.spaced(candidates);
    return this.picked(left, key, "action", (a) => a.likelihood / Math.max(this.count(a.id, now), 1));
  }

  /** Leave out what needs more other actions before it plays again; where that leaves nothing, all need one less, and so on. */
  spaced(candidates) {
    const before = this.recent.get(nodeOf(candidates[0].stance, candidates[0].kind)) ?? [];
    if (candidates.length < 2 || !before.length) return candidates;
    const needs = candidates.map((a) => a.spacing ?? (this.settings.neverTwice ? 1 : 0));
    const since = candidates.map((a) => (before.includes(a.id) ? before.length - 1 - before.lastIndexOf(a.id) : REMEMBERED));
    for (let less = 0; less <= Math.max(...needs); less++) {
      const left = candidates.filter((_, n) => since[n] >= needs[n] - less);
      if (left.length) return left;
    }
    return candidates;
  }

  /** Return c_k of section 6.2, alpha times the uses, over the settings' memory. */
  count(id, now) {
    const { memory, alpha } = this.settings;
    if (memory <= 0) return alpha * (this.uses.get(id) ?? 0);
    return alpha * this.cues.filter((cue) => cue.start >= now - memory && cue.action.id === id).length;
  }

  cue(action, shape, limit, wish, stance, meta) {
    let { length } = shape;
    if (action.earliestExit !== null) length = Math.min(length, Math.max(shape.shortest, Math.min(limit, wish) - shape.start));
    let into = action.blendIn;
    if (shape.entry > action.start) into = Math.max(into, this.settings.leastBlend);
    const blends = into + action.blendOut;
    const squeeze = blends > 0 ? Math.min(1, length / blends) : 1;
    const cue = {
      action, start: shape.start, end: shape.start + length, entry: shape.entry,
      blendIn: into * squeeze, blendOut: action.blendOut * squeeze, stance, then: (action.kind === "transition" && action.endStance) || stance, meta,
      holdFrom: shape.holdFrom, holdTo: shape.holdTo, hold: shape.hold, last: 0,
    };
    cue.last = clipSeconds(cue, cue.end); // clip seconds shown at its end
    return cue;
  }

  keep(cue) {
    this.note(cue, cue.then);
    const action = this.loop(cue.then, cue.meta);
    if (!action) return;
    // The loop begins anew under the action, so that the action's last pose meets the loop's first. Where the action leaves
    // joints alone the change shows, and takes its time: a transition all of its own.
    const until = cue.end - cue.blendOut;
    let begin = cue.start + cue.blendIn;
    let fade = Math.max(0, until - begin);
    if (cue.action.limb !== "both" || cue.action.joints.length) {
      const whole = cue.end - cue.start;
      fade = cue.then !== cue.stance ? whole : Math.min(this.settings.loopFade, whole);
      begin = Math.max(cue.start, until - fade);
    }
    this.rests.push({ stance: cue.then, action, start: until, fadeStart: begin, fade });
  }

  loop(stance, key) {
    const loops = this.graph.of(stance, "stance");
    return this.picked(loops, key, "loop", (a) => a.likelihood);
  }

  /** Draw one of some actions; the first where none has a weight. */
  picked(actions, key, purpose, weight) {
    const weights = new Map(actions.map((a) => [a.id, weight(a)]));
    if (![...weights.values()].some((w) => w > 0)) return actions[0];
    const chosen = pick(this.seed, key, purpose, weights);
    return actions.find((a) => a.id === chosen);
  }

  /** Where a stance has several loops, change between them in long rests, at a loop's end. */
  varyRests(end) {
    const { loopFade } = this.settings;
    this.rests = this.rests.flatMap((rest, place) => {
      const out = [rest];
      if (this.graph.of(rest.stance, "stance").length < 2) return out;
      const until = place + 1 < this.rests.length ? this.rests[place + 1].fadeStart : end;
      let current = rest.action;
      for (let change = rest.start; ; ) {
        change += Math.max(1, current.end - current.start - current.blendIn);
        if (!(change <= until)) return out;
        const action = this.loop(rest.stance, `${this.graph.layer}/${thousandths(change)}`);
        if (action.id === current.id) continue;
        current = action;
        out.push({ stance: rest.stance, action, start: change, fadeStart: change - loopFade, fade: loopFade });
      }
    });
  }

  /** @returns {null} so that what tells can end with it */
  tell(meta, outcome, message, played = false) {
    const { request, start, written } = meta;
    this.reports.push(new Report(request.id, outcome, message, request.layer, start, played, written));
    return null;
  }
}

/** Return each meta action with when the next more important one begins, and the next as important that was asked for. */
function bounds(metas) {
  const out = [];
  const first = new Map(); // rank of what was asked for -> start of the next such; what is written limits nothing
  for (const meta of [...metas].reverse()) {
    let [limit, wish] = [Infinity, Infinity];
    for (const [rank, start] of first) {
      if (rank > meta.rank) limit = Math.min(limit, start);
      if (rank >= meta.rank) wish = Math.min(wish, start);
    }
    out.push({ meta, limit, wish });
    if (!meta.written) first.set(meta.rank, meta.start);
  }
  return out.reverse();
}

/** Return seconds with three decimals, halves to even: `toFixed` rounds them up, and this text keys a draw. */
export function thousandths(seconds) {
  const halves = (seconds * 16) % 2 === 1 || (seconds * 16) % 2 === -1; // only odd sixteenths lie midway
  const low = Math.floor(seconds * 1000);
  return halves && low % 2 === 0 ? (low / 1000).toFixed(3) : seconds.toFixed(3);
}
