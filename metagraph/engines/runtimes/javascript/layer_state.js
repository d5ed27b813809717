/**
 * One layer while it is planned: what it may draw on, and what it has played so far.
 *
 * Translated from metagraph/playback/planning/layer_state.py; change that, and translate anew.
 */

import { Report } from "./meta_plan.js";
import { LEAST_BEATS } from "./director.js";
import { remember } from "./remembering.js";

/**
 * One layer being planned, cue after cue. It changes while planning, and never leaves the planner.
 *
 * moods: the mood over time. track: what lasts, such as the mode. free: when the next action may begin. acted: when the last
 * action ended. uses: how often each action was used. recent: the last draws of each `node`. ended: when each action ended.
 * begun: keys of meta actions whose chain of transitions already plays. served: keys of those that the action of another one
 * serves, too. candidates: the actions of each `node` that may be drawn, for the nodes needed so far. prominences: of
 * actions, as far as needed. model: the one that wrote what was not requested, None if there is none. beats: seconds after
 * which a gesture that hardly shows may be done again.
 *
 * project: Project; graph: MetaGraph; seed: number; stance: string; moods: Moods; track: Track; free: number; acted: number;
 * uses: Map<string, number>; recent: Map<string, string[]>; ended: Map<string, number>; cues: Cue[]; rests: Rest[]; reports:
 * Report[]; begun: Set<string>; served: Set<string>; candidates: Map<string, Action[]>; prominences: Map<string, number>;
 * model: ?Markov; beats: number.
 */
export class LayerState {
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

  tell(meta, outcome, message, played = false, late = 0, by = "") {
    const layer = this.graph.layer;
    this.reports.push(new Report(meta.request.id, outcome, message, layer, meta.start, played, meta.written, late, by));
  }
}
