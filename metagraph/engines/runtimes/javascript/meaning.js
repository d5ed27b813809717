/**
 * The meaning of asks: requests of the layers, and lasting items (Borer et al., section 6 and figure 5).
 *
 * Translated from metagraph/playback/planning/meaning.py; change that, and translate anew.
 */

import { cycleOf } from "./repeating.js";
import { readAloud } from "./graphemes.js";
import { BlinkAt, LookAt, ModeFrom, PlaceFrom, Speech, StayFrom } from "./items.js";
import { paceText, timedSeconds, toldText } from "./line_timing.js";
import { named } from "./spots.js";
import { Track } from "./track.js";
import { ASKED, MetaRequest, Report } from "./meta_plan.js";
import { actionCalled, stanceCalled } from "./finding.js";
import { MoodFrom } from "./mood.js";
import { findLongestLead, lead } from "./phases.js";

export const FOREVER = 1000000000; // seconds; a look that lasts until the next

/**
 * An ask with the fields of all kinds of asks; `do` says which of them count. line: id; said: that line, None if there is
 * none. text: the words, or a block of BML. timing: the times of its words and shapes.
 *
 * do: string; id: string; at: ?number; priority: number; layer: ?string; tags: string[]; limb: ?string; duration: ?number;
 * stroke: ?number; hold: ?number; late: ?number; valence: ?number; arousal: ?number; intensity: ?number; prepare: boolean;
 * resume: boolean; stay: boolean; action: string; stance: string; to: ?Spot; amount: number; strict: boolean; line: ?string;
 * said: ?SaidLine; text: string; gestures: boolean; timing: ?LineTiming; mode: ?string; name: string; point: number[]; what:
 * string; more: boolean.
 */
export class PlainAsk {
  constructor(
    do_,
    id = "",
    at = null,
    priority = ASKED,
    layer = null,
    tags = [],
    limb = null,
    duration = null,
    stroke = null,
    hold = null,
    late = null,
    valence = null,
    arousal = null,
    intensity = null,
    prepare = true,
    resume = false,
    stay = false,
    action = "",
    stance = "",
    to = null,
    amount = 1,
    strict = false,
    line = null,
    said = null,
    text = "",
    gestures = true,
    timing = null,
    mode = null,
    name = "",
    point = [],
    what = "",
    more = false,
  ) {
    this.do = do_;
    this.id = id;
    this.at = at;
    this.priority = priority;
    this.layer = layer;
    this.tags = tags;
    this.limb = limb;
    this.duration = duration;
    this.stroke = stroke;
    this.hold = hold;
    this.late = late;
    this.valence = valence;
    this.arousal = arousal;
    this.intensity = intensity;
    this.prepare = prepare;
    this.resume = resume;
    this.stay = stay;
    this.action = action;
    this.stance = stance;
    this.to = to;
    this.amount = amount;
    this.strict = strict;
    this.line = line;
    this.said = said;
    this.text = text;
    this.gestures = gestures;
    this.timing = timing;
    this.mode = mode;
    this.name = name;
    this.point = point;
    this.what = what;
    this.more = more;
  }
}

/**
 * A line of dialogue. seconds: its length, None if unknown. asks: its own requests, in seconds from its start. valence,
 * arousal, intensity: of the mood it is said in.
 *
 * text: string; seconds: ?number; asks: PlainAsk[]; valence: ?number; arousal: ?number; intensity: ?number.
 */
export class SaidLine {
  constructor(text = "", seconds = null, asks = [], valence = null, arousal = null, intensity = null) {
    this.text = text;
    this.seconds = seconds;
    this.asks = asks;
    this.valence = valence;
    this.arousal = arousal;
    this.intensity = intensity;
  }
}

/**
 * A requested block of BML: its behaviours become asks `<id>.1`, `<id>.2`, ...
 *
 * id: string; at: number; priority: number; text: string.
 */
export class AskedBlock {
  constructor(id, at, priority, text) {
    this.id = id;
    this.at = at;
    this.priority = priority;
    this.text = text;
  }
}

/**
 * An ask that steers speech. do: "interrupt", "pause", "resume" or "finish". what: the id of the speech, "" for all speech.
 *
 * do: string; id: string; what: string; priority: number.
 */
export class SteeringAsk {
  constructor(do_, id, what, priority) {
    this.do = do_;
    this.id = id;
    this.what = what;
    this.priority = priority;
  }
}

/**
 * The meaning of asks, so far. graphs: of the layers, in their order. withdrawn: ids taken back; "" stands for all. steered:
 * the asks that steer speech, in order. unknown: the kind of thing that an ask names and that does not exist: "action",
 * "stance" or "line". Speeches may overlap. fixed: the earliest second at which a gesture of a line can begin; the line
 * itself may begin earlier.
 *
 * project: Project; graphs: MetaGraph[]; alphabet: Alphabet; requests: MetaRequest[]; looks: LookAt[]; speeches: Speech[];
 * modes: ModeFrom[]; places: PlaceFrom[]; blinks: BlinkAt[]; stays: StayFrom[]; moods: MoodFrom[]; blocks: AskedBlock[];
 * withdrawn: Set<string>; steered: SteeringAsk[]; refused: Report[]; unknown: string; fixed: number.
 */
export class Meaning {
  constructor(
    project,
    graphs,
    alphabet,
    requests = [],
    looks = [],
    speeches = [],
    modes = [],
    places = [],
    blinks = [],
    stays = [],
    moods = [],
    blocks = [],
    withdrawn = new Set([]),
    steered = [],
    refused = [],
    unknown = "",
    fixed = 0,
  ) {
    this.project = project;
    this.graphs = graphs;
    this.alphabet = alphabet;
    this.requests = requests;
    this.looks = looks;
    this.speeches = speeches;
    this.modes = modes;
    this.places = places;
    this.blinks = blinks;
    this.stays = stays;
    this.moods = moods;
    this.blocks = blocks;
    this.withdrawn = withdrawn;
    this.steered = steered;
    this.refused = refused;
    this.unknown = unknown;
    this.fixed = fixed;
  }

  /** Return the track of lasting items. */
  track() {
    return new Track(
      [...this.looks],
      [...this.speeches],
      [...this.modes],
      [...this.places],
      [...this.blinks],
      [...this.stays],
      [...this.moods],
    );
  }

  /** Add the meaning of other asks. */
  take(other) {
    this.requests.push(...other.requests);
    this.looks.push(...other.looks);
    this.speeches.push(...other.speeches);
    this.modes.push(...other.modes);
    this.places.push(...other.places);
    this.blinks.push(...other.blinks);
    this.stays.push(...other.stays);
    this.moods.push(...other.moods);
    this.blocks.push(...other.blocks);
    this.steered.push(...other.steered);
    for (const ident of other.withdrawn) {
      this.withdrawn.add(ident);
    }
  }

  /** Report that an ask was not understood. */
  refuse(ident, why, layer, at) {
    this.refused.push(new Report(ident, "not-understood", why, layer === null ? "arms" : layer, at));
  }

  /** Return a layer's graph. */
  graphOf(layer) {
    return this.graphs.find((graph) => graph.layer === layer);
  }

  /**
   * Add the meaning of an ask; return why it has none, "" if it has one. ident, at, priority: its own, or as the line
   * changed them that it belongs to. shift: the second at which that line begins, else 0.
   */
  add(ask, ident, at, priority, shift) {
    const where = ask.layer === null ? "" : ` in the ${ask.layer} layer`;
    const stroke = ask.stroke === null ? null : ask.stroke + shift;
    let start = at;
    if (ask.do === "gesture" || ask.do === "fidget") {
      const kind = ask.do === "gesture" ? "gesture" : "fidget";
      let layer = ask.layer === null ? "arms" : ask.layer;
      if (stroke !== null) {
        start = Math.max(0, stroke - findLongestLead(this.project, this.graphOf(layer), ask.tags));
      }
      let request = new MetaRequest(
        ident,
        layer,
        kind,
        start,
        ask.duration,
        null,
        ask.tags,
        ask.limb,
        null,
        priority,
        ask.resume,
        stroke,
        ask.hold,
        ask.prepare,
        [],
        ask.late,
        ask.valence,
        ask.arousal,
        ask.intensity,
      );
      this.requests.push(request);
    } else if (ask.do === "action") {
      const action = actionCalled(this.graphs, ask.action, ask.layer);
      if (action === null) {
        this.unknown = "action";
        return `there is no action '${ask.action}'${where}`;
      }
      if (stroke !== null) {
        start = Math.max(0, stroke - lead(this.project, action));
      }
      const { 0: begins, 1: ends } = this.project.span(action);
      const repeats = cycleOf(action.kind, action.timing, begins, ends) > 0;
      const duration = repeats ? ask.duration : null;
      let request = new MetaRequest(
        ident,
        action.layer,
        action.kind,
        start,
        duration,
        action.id,
        [],
        null,
        null,
        priority,
        false,
        stroke,
        ask.hold,
        ask.prepare,
        [],
        ask.late,
        ask.valence,
        ask.arousal,
        ask.intensity,
      );
      this.requests.push(request);
    } else if (ask.do === "stance") {
      const stance = stanceCalled(this.graphs, ask.stance, ask.layer);
      if (stance === null) {
        this.unknown = "stance";
        return `there is no stance '${ask.stance}'${where}`;
      }
      this.requests.push(new MetaRequest(
        ident,
        stance.layer,
        "transition",
        at,
        null,
        null,
        [],
        null,
        stance.id,
        priority,
        false,
        null,
        null,
        true,
        [],
        ask.late,
      ));
      this.stays.push(new StayFrom(ident, at, stance.layer, ask.stay));
    } else if (ask.do === "change") {
      // Whichever arm was seen to move: stances are joined by few transitions, and mostly of both.
      let layer = ask.layer === null ? "arms" : ask.layer;
      this.requests.push(new MetaRequest(
        ident,
        layer,
        "transition",
        at,
        null,
        null,
        [],
        null,
        null,
        priority,
        false,
        null,
        null,
        true,
        [],
        ask.late,
      ));
    } else if (ask.do === "nod" || ask.do === "shake") {
      return this.head(ask, ident, at, priority);
    } else if (ask.do === "look") {
      const end = ask.duration === null ? FOREVER : at + ask.duration;
      const to = ask.to === null ? named("user") : ask.to;
      this.looks.push(new LookAt(ident, at, end, to, ask.amount, ask.strict, priority));
    } else if (ask.do === "blink") {
      this.blinks.push(new BlinkAt(ident, at));
    } else if (ask.do === "mood") {
      const until = ask.duration === null ? Infinity : at + ask.duration;
      this.moods.push(new MoodFrom(ident, at, ask.valence, ask.arousal, ask.intensity, until));
    } else if (ask.do === "mode") {
      this.modes.push(new ModeFrom(ident, at, ask.mode));
    } else if (ask.do === "place") {
      this.places.push(new PlaceFrom(ident, at, ask.name, ask.point));
    } else if (ask.do === "withdraw") {
      this.withdrawn.add(ask.what);
    } else if (ask.do === "interrupt" || ask.do === "pause" || ask.do === "resume" || ask.do === "finish") {
      this.steered.push(new SteeringAsk(ask.do, ident, ask.what, priority));
    } else if (ask.do === "say") {
      return this.say(ask, ident, at, priority);
    } else if (ask.do === "bml") {
      this.blocks.push(new AskedBlock(ident, at, priority, ask.text));
    } else {
      return `nothing is known of '${ask.do}'`;
    }
    return "";
  }

  /** Nods are gestures with that tag; if there is none, the likeliest one with that name, whatever stance it needs. */
  head(ask, ident, at, priority) {
    const gestures = [...this.graphOf("head").actions.values()].filter((x) =>
      x.kind === "gesture" && ask.tags.every((tag) => x.tags.includes(tag)));
    let tags = [];
    let called = [];
    if (gestures.some((x) => x.tags.includes(ask.do))) {
      tags = [ask.do, ...ask.tags];
    } else {
      called = gestures.filter((x) => x.name.toLowerCase().includes(ask.do)).map((x) => x.id);
      if (called.length === 0) {
        const told = ask.tags.length > 0 ? ` with the tags ${ask.tags.join(", ")}` : "";
        return `the head layer has no gesture tagged or called '${ask.do}'${told}`;
      }
    }
    this.requests.push(new MetaRequest(
      ident,
      "head",
      "gesture",
      at,
      null,
      null,
      tags,
      null,
      null,
      priority,
      false,
      null,
      null,
      true,
      [...called],
      ask.late,
      ask.valence,
      ask.arousal,
      ask.intensity,
    ));
    return "";
  }

  /** Say a line, with its own requests, or other words. */
  say(ask, ident, at, priority) {
    const line = ask.said;
    if (ask.line !== null && line === null) {
      this.unknown = "line";
      return `there is no line '${ask.line}'`;
    }
    let text = ask.text;
    if (text === "" && line !== null) {
      text = line.text;
    }
    if (text === "" && line === null && ask.timing !== null) {
      text = toldText(ask.timing);
    }
    if (line === null && text === "" && ask.timing === null) {
      return "say what: a line's id, text, or words with their times";
    }
    let timing = ask.timing;
    if (timing === null && line === null && ask.more && ask.duration !== null) {
      timing = paceText(this.alphabet, text, ask.duration);
    }
    let length;
    if (timing !== null) {
      length = timedSeconds(timing, ask.duration);
    } else if (ask.duration !== null) {
      length = Math.max(ask.duration, 0);
    } else if (line !== null && line.seconds !== null) {
      length = line.seconds;
    } else {
      length = readAloud(this.alphabet, text);
    }
    this.speeches.push(new Speech(ident, at, at + length, ask.line, text, priority, null, timing, 0, ask.more));
    const told = ask.valence !== null || line === null;
    const valence = (told || line === null) ? ask.valence : line.valence;
    const arousal = (told || line === null) ? ask.arousal : line.arousal;
    const intensity = (ask.intensity === null && line !== null) ? line.intensity : ask.intensity;
    if (valence !== null || intensity !== null) {
      this.moods.push(new MoodFrom(ident, at, valence, arousal, intensity, at + length));
    }
    if (line === null || !ask.gestures) {
      return "";
    }
    for (const { 0: n, 1: inner } of line.asks.entries()) {
      if (inner.do === "say") {
        return "a line would say another line; its asks may not";
      }
      let begins = inner.at === null ? at : at + inner.at;
      if (ask.at === null) {
        begins = Math.max(begins, this.fixed);
      }
      const why = this.add(inner, `${ident}.${n + 1}`, begins, Math.max(inner.priority, priority), at);
      if (why !== "") {
        return why;
      }
    }
    return "";
  }
}

/**
 * Add the meaning of an ask, or refuse all of it. now: when it begins if it does not say; soon: the same for speech.
 * @param {Meaning} whole
 * @param {PlainAsk} ask
 * @param {number} now
 * @param {number} soon
 */
export function understood(whole, ask, now, soon) {
  const one = new Meaning(
    whole.project,
    whole.graphs,
    whole.alphabet,
    [],
    [],
    [],
    [],
    [],
    [],
    [],
    [],
    [],
    new Set([]),
    [],
    [],
    "",
    now,
  );
  const at = ask.at === null ? (ask.do === "say" ? soon : now) : ask.at;
  const why = one.add(ask, ask.id, at, ask.priority, 0);
  if (why === "") {
    whole.take(one);
  } else {
    whole.refuse(ask.id, why, ask.layer, at);
  }
}
