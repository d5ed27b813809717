/**
 * From a meta plan to specific actions: candidates, the three temporal cases, cues and rests (Borer et al., section 6.2).
 *
 * Translated from metagraph/playback/planning/sampling.py; change that, and translate anew.
 */

import { cycleOf } from "./repeating.js";
import { Cue, Rest } from "./meta_plan.js";
import { begins, bounds } from "./bounds.js";
import { FITS, RETRACTION, fitsBefore, remaining } from "./cue_shapes.js";
import { mayBegin, performsWritten } from "./directing.js";
import { beatInterval } from "./director.js";
import { drawAction, findCooled } from "./drawing.js";
import { LayerState } from "./layer_state.js";
import { findExtent, findMood, shapeInMood } from "./manner.js";
import { findUntil, keepTimely } from "./punctuality.js";
import { drawLoop } from "./routes.js";
import { chooseSteps } from "./steps.js";
import { LEAST_BLEND } from "./phase_times.js";
import { minOf, thousandths } from "./basics.js";

export const ON_TIME = 0.1; // seconds by which a request may begin later and still be on time
export const LOOP_FADE = 0.6; // seconds of crossfade when a long rest changes from one loop of its stance to another

/**
 * Return the layer as it is after a past and the cues that played since.
 * @param {Project} project
 * @param {MetaGraph} graph
 * @param {number} seed
 * @param {string} begin
 * @param {Past} past
 * @param {Cue[]} cues
 * @param {Moods} moods
 * @param {Track} track
 * @returns {LayerState}
 */
export function resumeLayer(project, graph, seed, begin, past, cues, moods, track) {
  const stance = graph.stances.has(past.stance) ? past.stance : begin;
  const out = new LayerState(
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

/**
 * Lay the first loop down; return whether the layer can perform at all.
 * @param {LayerState} state
 * @param {string} stance
 * @returns {boolean}
 */
export function beginLayer(state, stance) {
  const loop = drawLoop(state, stance, `rest/${state.graph.layer}`);
  if (loop === null) {
    return false;
  }
  state.rests.push(new Rest(stance, loop, 0, 0, 0));
  return true;
}

/**
 * Realise in order those meta actions of a conflict-free meta plan that start before `end`.
 * @param {LayerState} state
 * @param {MetaAction[]} metas
 * @param {number} end
 */
export function performMetas(state, metas, end) {
  const performed = metas.filter((m) => !m.written || performsWritten(state, m, m.start));
  for (const bound of bounds(performed)) {
    const meta = bound.meta;
    if (begins(meta) >= end) {
      continue;
    }
    if (state.served.size > 0 && state.served.has(meta.key)) {
      continue;
    }
    if (meta.request.late !== null) {
      _realise(state, bound, Math.max(state.ready, begins(meta)));
      continue;
    }
    const ready = state.ready;
    if (meta.start < ready && !state.begun.has(meta.key)) {
      let running = "the running action";
      if (state.cues.length > 0) {
        running = `'${state.cues[state.cues.length - 1].action.name}'`;
      }
      let waits = ready - meta.start;
      if (meta.end <= ready + FITS) {
        waits = ready - meta.request.start;
        // What is wanted for a certain time is over; what is wanted once may come late.
        const wanted = meta.written || meta.request.duration !== null;
        if (wanted || waits > state.project.settings.wait) {
          const why = `wholly covered by ${running}, which plays until ${state.free.toFixed(2)} s`;
          state.tell(meta, "covered", why);
          continue;
        }
      }
      // What a model wrote is wanted at no certain time.
      if (!meta.written && waits > ON_TIME) {
        state.tell(meta, "queued", `waits ${waits.toFixed(2)} s for ${running}`, true);
      }
    }
    _realise(state, bound, Math.max(ready, meta.start));
  }
}

/**
 * @param {LayerState} state
 * @param {Bound} bound
 * @param {number} now
 */
function _realise(state, bound, now) {
  const meta = bound.meta;
  if (meta.written && !state.begun.has(meta.key) && !mayBegin(state, meta, now)) {
    return;
  }
  const steps = chooseSteps(state, meta, now);
  if (steps === null) {
    return;
  }
  const cues = [];
  let stance = state.stance;
  for (const step of steps) {
    const hops = step.hop !== "";
    const asked = hops ? null : remaining(meta, now);
    const mood = findMood(state, asked, now);
    let fitting = _fit(state, bound, step, asked, now, mood);
    if (fitting.length === 0) {
      return;
    }
    // On the way to a stance it counts when that begins.
    if (meta.request.late !== null && (!hops || (cues.length === 0 && steps[steps.length - 1].hop !== ""))) {
      fitting = keepTimely(state, bound, fitting, now);
      if (fitting.length === 0) {
        return;
      }
    }
    const action = drawAction(state, fitting, hops ? `${meta.key}/${step.hop}` : meta.key, now, mood);
    const shape = shapeInMood(state, action, asked, now, mood);
    const cue = _cue(state, action, shape, bound, hops, stance, mood);
    cues.push(cue);
    now = cue.end;
    stance = cue.then;
  }
  for (const one of cues) {
    _keep(state, one);
  }
}

/**
 * Return the candidates of a step that are over in time and have cooled down. If none, tell why.
 * @param {LayerState} state
 * @param {Bound} bound
 * @param {SamplingStep} step
 * @param {?MetaRequest} asked
 * @param {number} now
 * @param {Mood} mood
 * @returns {Action[]}
 */
function _fit(state, bound, step, asked, now, mood) {
  const meta = bound.meta;
  let fitting = [...step.candidates];
  if (bound.limit < Infinity) { // else all fit
    fitting = step.candidates.filter((a) => fitsBefore(shapeInMood(state, a, asked, now, mood), bound.limit));
  }
  if (fitting.length === 0) {
    const before = meta.written ? "" : " before something more important";
    const left = Math.max(0, bound.limit - now);
    state.tell(meta, "no-room", `nothing fits into the ${left.toFixed(2)} s${before}`);
    return fitting;
  }
  if (step.hop !== "" || meta.request.action !== null) {
    return fitting;
  }
  const warm = fitting.filter((a) =>
    a.cooldown <= 0 || findCooled(state, a) <= shapeInMood(state, a, asked, now, mood).start + FITS);
  if (warm.length === 0) {
    const soonest = minOf(fitting.map((a) => findCooled(state, a)));
    const why = `all that fit are cooling down; the first may play again at ${soonest.toFixed(2)} s`;
    state.tell(meta, "cooling", why);
  }
  return warm;
}

/**
 * hops: whether it is a transition on the way to the requested action.
 * @param {LayerState} state
 * @param {Action} action
 * @param {CueShape} shape
 * @param {Bound} bound
 * @param {boolean} hops
 * @param {string} stance
 * @param {Mood} mood
 * @returns {Cue}
 */
function _cue(state, action, shape, bound, hops, stance, mood) {
  let length = shape.length;
  let into = Math.max(0, action.timing.blendIn);
  let out = Math.max(0, action.timing.blendOut);
  const { 0: begin, 1: until } = state.project.span(action);
  const cycle = cycleOf(action.kind, action.timing, begin, until);
  if (action.timing.earliestExit !== null || cycle > 0) {
    const wish = hops ? Infinity : bound.wish;
    length = Math.min(length, Math.max(shape.shortest, Math.min(bound.limit, wish) - shape.start));
  } else if (!hops) {
    length = Math.min(length, findUntil(state, action, shape, bound) - shape.start);
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
    findExtent(state, action, mood),
    shape.tempo,
    cycle > 0 ? begin : 0,
    cycle > 0 ? begin + cycle : 0,
  );
}

/**
 * @param {LayerState} state
 * @param {Cue} cue
 */
function _keep(state, cue) {
  state.note(cue, cue.then);
  const loop = drawLoop(state, cue.then, cue.meta);
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
    state.rests.push(new Rest(cue.then, loop, until, begin, fade));
  }
}

/**
 * Change between the loops of a stance in long rests, at the end of a loop.
 * @param {LayerState} state
 * @param {number} end
 */
export function varyRests(state, end) {
  const out = [];
  for (const { 0: place, 1: rest } of state.rests.entries()) {
    out.push(rest);
    const loops = state.graph.of(rest.stance, "stance");
    if (loops.length < 2) {
      continue;
    }
    const until = place + 1 < state.rests.length ? state.rests[place + 1].fadeStart : end;
    let current = rest;
    let change = rest.start;
    while (true) {
      const { 0: start, 1: stop } = state.project.span(current.action);
      change += Math.max(1, stop - start - current.action.timing.blendIn);
      if (!(change <= until)) { // nor when it is no number
        break;
      }
      const loop = drawLoop(state, rest.stance, `${state.graph.layer}/${thousandths(change)}`);
      if (loop !== null && loop.id !== current.action.id) {
        current = new Rest(rest.stance, loop, change, change - LOOP_FADE, LOOP_FADE);
        out.push(current);
      }
    }
  }
  state.rests = out;
}
