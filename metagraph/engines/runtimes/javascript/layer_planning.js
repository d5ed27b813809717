/**
 * Extend the plan of one layer: the later part of the plan is turned back into its meta actions, merged with new requests,
 * placed and performed again (Borer et al., section 6).
 *
 * Translated from metagraph/playback/planning/layer_planning.py; change that, and translate anew.
 */

import { LayerPlan, MetaAction, Report, TEMPORAL } from "./meta_plan.js";
import { FITS } from "./cue_shapes.js";
import { makeWay } from "./leaving.js";
import { write } from "./markov.js";
import { changed, moodAt, tempo } from "./mood.js";
import { delay, replan } from "./replan.js";
import { beginLayer, performMetas, resumeLayer, varyRests } from "./sampling.js";
import { but } from "./basics.js";

export const WINDOW = 1; // seconds a request may use when it does not say how long

/**
 * A layer placed in time, not yet performed.
 *
 * able: whether the layer can perform at all. done: meta actions that were performed before. placed: those to perform, in
 * order; those that a model wrote are performed as the mode says. reports: the reports so far.
 *
 * layer: string; state: LayerState; able: boolean; done: MetaAction[]; placed: MetaAction[]; reports: Report[]; past: Past;
 * cursor: Cursor; written: MetaAction[].
 */
export class LayerDraft {
  constructor(layer, state, able, done, placed, reports, past, cursor, written) {
    this.layer = layer;
    this.state = state;
    this.able = able;
    this.done = done;
    this.placed = placed;
    this.reports = reports;
    this.past = past;
    this.cursor = cursor;
    this.written = written;
  }

  /** Return the layer's plan with the given meta actions performed; `reports` is then complete. */
  performed(metas, end) {
    let cues = [];
    let rests = [];
    if (this.able) {
      performMetas(this.state, metas, end);
      varyRests(this.state, end);
      cues = this.state.cues;
      rests = this.state.rests;
      this.reports.push(...this.state.reports);
    }
    const every = [...this.done, ...this.placed];
    return new LayerPlan(this.layer, every, [...cues], [...rests], this.past, this.cursor, [...this.written]);
  }
}

/**
 * Return a layer's plan cut at `now`, with the requests placed again.
 *
 * chain: the model that writes when there are no requests, or None. kinds: the kinds of actions that the layer has. told:
 * reports of the plan so far. fresh: new requests, of all layers. replaced: ids of requests that are replaced or withdrawn;
 * stopped: those withdrawn, whose running action is left. stance: the stance in which the layer would begin. moods: the mood
 * over time. track: what lasts, such as the mode.
 * @param {Project} project
 * @param {MetaGraph} graph
 * @param {?Markov} chain
 * @param {Set<string>} kinds
 * @param {LayerPlan} old
 * @param {Report[]} told
 * @param {number} seed
 * @param {number} now
 * @param {MetaRequest[]} fresh
 * @param {Set<string>} replaced
 * @param {Set<string>} stopped
 * @param {number} end
 * @param {?string} stance
 * @param {Moods} moods
 * @param {Track} track
 * @returns {LayerDraft}
 */
export function draft(
  project,
  graph,
  chain,
  kinds,
  old,
  told,
  seed,
  now,
  fresh,
  replaced,
  stopped,
  end,
  stance,
  moods,
  track,
) {
  const layer = graph.layer;
  let asked = fresh.filter((request) => request.layer === layer).map((request) => metaOf(inTime(request, moods)));
  const kept = old.cues.filter((cue) => cue.start < now);
  const played = new Set(kept.map((cue) => cue.meta));
  // also those whose chain of transitions has begun
  const waiting = new Set(old.cues.slice(kept.length).map((cue) => cue.meta));
  // Who lies ahead may be called as what was played long ago: a request that is asked for again and again.
  const playing = new Set(kept.filter((cue) => cue.end > now).map((cue) => cue.meta));
  const written = [];
  let cursor = old.cursor;
  // What another's action has served since it began is played as that is.
  const served = new Set(told.filter((report) => report.outcome === "shared" && played.has(report.by)).map((report) =>
    report.request));
  const again = new Set(replaced);
  if (chain !== null) {
    let more;
    ({ 0: more, 1: cursor } = write(chain, seed, end, kinds, old.cursor));
    for (const meta of [...old.written, ...more]) {
      if (meta.start >= now) {
        written.push(meta);
        again.add(meta.request.id);
      }
    }
  }
  const future = [];
  const planned = new Map(); // again: when those of a request start
  const judged = new Set([]); // those whose lateness is known once they are performed
  for (const meta of old.metas) {
    if (again.has(meta.request.id) || served.has(meta.request.id)) {
      continue;
    }
    if (waiting.has(meta.key) || (meta.start >= now && !playing.has(meta.key))) {
      future.push(meta);
      if (meta.request.late !== null) {
        judged.add(meta.request.id);
      }
      planned.set(meta.request.id, [...planned.get(meta.request.id) ?? [], meta.start]);
    }
  }
  // Reports about time still hold; those that are planned again report the rest.
  const done = old.metas.filter((meta) =>
    !again.has(meta.request.id)
      && !(planned.get(meta.request.id) ?? []).includes(meta.start)
      && (playing.has(meta.key) || meta.start < now || served.has(meta.request.id)));
  const reports = told.filter((report) =>
    report.layer === layer
      && !again.has(report.request)
      && ((TEMPORAL.has(report.outcome) && !judged.has(report.request))
        || !(planned.get(report.request) ?? []).includes(report.at)));
  const begin = _begin(graph, old, stance);
  const state = resumeLayer(project, graph, seed, begin, old.past, kept, moods, track);
  state.model = chain;
  if (begin === "" || !beginLayer(state, begin)) {
    const why = `the ${layer} layer has no stance with a loop to begin in`;
    const waits = [...future, ...asked];
    for (const meta of waits) {
      if (!meta.written) {
        reports.push(new Report(meta.request.id, "no-stance", why, layer, meta.start));
      }
    }
    return new LayerDraft(layer, state, false, done, waits, reports, old.past, cursor, written);
  }
  state.begun = _begun(old, kept.length);
  if (kept.length > 0 && kept[kept.length - 1].end > now) {
    const running = old.metas.find((meta) => meta.key === kept[kept.length - 1].meta) ?? null;
    const leaves = _leaves(running, stopped, track, now);
    makeWay(state, running, asked, now, leaves);
  }
  if (old.rests.length > 0 && now > 0) {
    const begun = new Set(state.cues.map((cue) => cue.end - cue.blendOut));
    state.rests = old.rests.filter((rest) => rest.fadeStart < now || begun.has(rest.start));
  }
  state.free = Math.max(now - (state.ready - state.free), state.free);
  let delayed;
  ({ 0: asked, 1: delayed } = delay(asked, state.ready, project.settings));
  let busy = -Infinity; // what runs keeps the time it was wanted for, from the models
  for (const meta of done) {
    if (!meta.written) {
      busy = Math.max(busy, meta.end);
    }
  }
  const { 0: placed, 1: moved } = replan([...future, ...written, ...asked], project.settings, busy);
  const every = [...reports, ...delayed, ...moved];
  return new LayerDraft(layer, state, true, done, placed, every, old.past, cursor, written);
}

/**
 * Return whether the running action is left: it was stopped, or it is a gesture of the character's own and what it said was
 * broken off.
 * @param {?MetaAction} running
 * @param {Set<string>} stopped
 * @param {Track} track
 * @param {number} now
 * @returns {boolean}
 */
function _leaves(running, stopped, track, now) {
  if (running === null) {
    return false;
  }
  const own = running.written && running.request.kind === "gesture";
  return stopped.has(running.request.id) || (own && track.hushedAt(now));
}

/**
 * Return the key of the meta action whose chain of transitions plays where the first cues are kept; none if none does. An
 * earlier action may have had the same key, so that only the last cue can be of a chain.
 * @param {LayerPlan} old
 * @param {number} kept
 * @returns {Set<string>}
 */
function _begun(old, kept) {
  const out = new Set([]);
  if (0 < kept && kept < old.cues.length) {
    const last = old.cues[kept - 1];
    const following = old.cues[kept];
    if (last.meta === following.meta && following.start <= last.end) {
      out.add(last.meta);
    }
  }
  return out;
}

/**
 * Return a request that may begin earlier, by the extra time that its preparation takes in its mood.
 * @param {MetaRequest} request
 * @param {Moods} moods
 * @returns {MetaRequest}
 */
export function inTime(request, moods) {
  if (request.stroke === null) {
    return request;
  }
  const mood = moodAt(moods, request.stroke);
  const speed = tempo(changed(mood, request.valence, request.arousal, request.intensity));
  if (speed >= 1) {
    return request;
  }
  return but(request, { start: Math.max(0, request.stroke - (request.stroke - request.start) / speed) });
}

/**
 * Return a request as a meta action with the window it may use; if its stroke is judged, with the moment of the stroke.
 * @param {MetaRequest} request
 * @returns {MetaAction}
 */
export function metaOf(request) {
  if (request.late !== null && request.stroke !== null) {
    return new MetaAction(request, request.stroke, request.stroke + FITS);
  }
  let length = request.duration === null ? WINDOW : Math.max(0, request.duration);
  if (request.stroke !== null) {
    length = Math.max(length, request.stroke - request.start + FITS);
  }
  return new MetaAction(request, request.start, request.start + length);
}

/**
 * Return the stance in which a layer begins: that of the plan before, the given one, the graph's start, or the first that
 * has a loop; "" for none.
 * @param {MetaGraph} graph
 * @param {LayerPlan} old
 * @param {?string} stance
 * @returns {string}
 */
function _begin(graph, old, stance) {
  const wishes = [old.past.stance];
  if (old.rests.length > 0) {
    wishes.push(old.rests[0].stance);
  }
  if (stance !== null) {
    wishes.push(stance);
  }
  if (graph.start !== null) {
    wishes.push(graph.start);
  }
  wishes.push(...[...graph.stances.keys()]);
  for (const wish of wishes) {
    if (graph.stances.has(wish) && graph.of(wish, "stance").length > 0) {
      return wish;
    }
  }
  return "";
}
