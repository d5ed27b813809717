/** One character of a game: takes requests as they come, plans ahead, and is posed every frame. */

import { readAsk } from "./asks.js";
import { describe } from "./describe.js";
import { answers, hear, since } from "./hear.js";
import { findLineStart } from "./items.js";
import { Parameters } from "./parameters.js";
import { emptyPlan } from "./plan.js";
import { Player } from "./pose.js";
import { SpeechWatch } from "./speech_watch.js";
import { findForgotten, findSoon } from "./utterances.js";
import { LAYERS } from "./words.js";

const SLACK = 2; // seconds the horizon may fall behind before it is moved on
const FORGETTING = 15; // seconds between forgetting what is over
const LEAP = 3600; // seconds an update may move on: all that lies between is planned
const SOUNDS = 16; // lines whose sound is remembered
const TAKING = ["withdraw", "interrupt", "pause", "resume", "finish"]; // what is done as soon as it is taken up
const REMEMBERED = 1000; // answers kept after that, and happenings nobody asked for

export class Character {
  /**
   * @param {import("./graph.js").Graph} graph
   * @param {{seed?: number, idle?: boolean, stances?: Record<string, string>, ahead?: number, recent?: number}} [options]
   *   seed: 32 bits, the export's when not given; characters of one graph want different ones. idle: whether the models fill the
   *   time nobody asks for. stances: layer -> id of the stance it begins in. ahead: seconds planned in advance. recent: seconds
   *   that are remembered.
   */
  constructor(graph, { seed = graph.settings.seed, idle = true, stances = {}, ahead = 20, recent = 30 } = {}) {
    this.graph = graph;
    this.options = { stances, idle };
    this.ahead = ahead;
    this.recent = recent;
    this.now = 0;
    this.plan = hear(graph, emptyPlan(seed), 0, [], ahead, this.options);
    this.posed = { rotations: Float32Array.from(graph.baseRotations), translations: Float32Array.from(graph.baseTranslations) };
    this.weights = new Float32Array(graph.morphs.length);
    this.player = new Player(graph, this.plan);
    this.queue = [];
    this.asked = new Set(); // ids that the plan can tell of
    this.settled = new Map(); // answers of those it has forgotten or never heard of
    this.sounds = new Map(); // of lines that are heard, by their ids
    this.parameters = new Parameters(graph.parameters);
    this.count = 0;
    this.speech = new SpeechWatch();
    this.seen = -Infinity; // when the update before was
    this.forgot = 0;
    this.happened = [];
  }

  /** Return what may be asked for, as plain data: see `describe`. */
  describe() {
    return describe(this.graph);
  }

  /**
   * Ask for something; it is taken up at the next update. Returns the request's id, under which `answer` tells what became of it.
   * Never throws: what cannot be read is refused.
   * @param {object} request as JSON, with `do`; `after`: seconds from now, wins over `at`; an `id` is made where there is none
   */
  ask(request) {
    const fine = typeof request === "object" && request !== null;
    this.count += 1;
    const id = fine && typeof request.id === "string" && request.id ? request.id : `#${this.count}`;
    if (!fine) return this.refuse(id, "a request should be an object");
    const { after, ...data } = { ...request, id };
    if (after !== undefined) {
      if (!Number.isFinite(after) || after < 0) return this.refuse(id, "after: should be a number of seconds from now");
      data.at = this.now + after;
    }
    const { ask, why } = readAsk(data);
    if (!ask) return this.refuse(id, why);
    this.settled.delete(id);
    this.asked.add(id);
    this.queue.push(data);
    return id;
  }

  /**
   * Set a parameter of the project; returns the id of the request that this makes. A number outside of its range becomes the nearest
   * inside, a trigger has no value, and what is set to the value that it has makes no request again. Never throws: what cannot be set
   * is refused.
   * @param {string} name @param {number | boolean | string | string[] | number[]} [value] as `describe().parameters` says
   */
  setParameter(name, value) {
    const refuse = (why) => this.refuse(`#${(this.count += 1)}`, why);
    return this.parameters.set(name, value, (request) => this.ask(request), refuse);
  }

  /** Return the value that a parameter was set to, else its first one; null for a trigger, undefined for an unknown name. */
  getParameter(name) {
    return this.parameters.get(name);
  }

  /**
   * Say a line whose sound comes in while it is said: with each call its next samples, -1..1. The lips do what is heard in them. An
   * id is one line's; returns it, as `ask` does. rate: samples a second, 8000 to 48000.
   * @param {string} id @param {ArrayLike<number>} samples @param {number} rate
   */
  saySound(id, samples, rate) {
    if (!(rate >= 8000 && rate <= 48000)) return this.refuse(id, "rate: should be a number from 8000 to 48000");
    const { living } = this.graph;
    if (!living) return this.refuse(id, "the part 'life' of the runtime is not loaded: load(json, glb, file, [\"life\"])");
    const begun = this.plan.track.lastSpeech(id);
    const waiting = this.queue.findIndex((ask) => ask.id === id && ask.do === "say"); // of the same update
    let voice = this.sounds.get(id);
    if (voice?.rate !== rate || (begun === null && waiting < 0)) voice = new living.StreamedVoice(rate);
    if (begun !== null) voice.follow(findSoon(this.now, this.graph.settings.lookahead) - findLineStart(begun));
    this.sounds.delete(id);
    this.sounds.set(id, voice);
    if (this.sounds.size > SOUNDS) this.sounds.delete(this.sounds.keys().next().value);
    const from = voice.seconds;
    const marks = voice.hear(Array.from(samples));
    const visemes = marks.map(({ at, viseme, weight }) => [at, viseme, weight]);
    if (!marks.length) visemes.push([from, voice.shape, voice.weight]); // what goes on
    const before = waiting < 0 ? [] : this.queue.splice(waiting, 1)[0].visemes ?? [];
    return this.ask({ do: "say", id, visemes: [...before, ...visemes], set: "oculus" });
  }

  refuse(id, why) {
    this.finish({ id, state: "refused", at: null, until: null, what: [], why });
    return id;
  }

  /** Keep an answer that will not change any more. */
  finish(answer) {
    this.asked.delete(answer.id);
    this.settled.delete(answer.id);
    this.settled.set(answer.id, answer);
    if (this.settled.size > REMEMBERED) this.settled.delete(this.settled.keys().next().value);
  }

  /**
   * Move on to `now` seconds of the character's own time, which begins at 0, never goes backwards, and leaps an hour at most. Plans
   * what is needed; when nothing was asked and the horizon is far enough, that is nothing.
   * @param {number} now
   */
  update(now) {
    if (Number.isFinite(now) && now > this.now) this.now = Math.min(now, this.now + LEAP);
    try {
      this.planOn();
    } catch (error) {
      // A fault of the runtime's own must not stop the game: the character goes on with the plan it has.
      for (const { id } of this.queue) this.refuse(id, `the runtime failed: ${error.message}`);
      this.queue = [];
    }
    this.player.setPlan(this.plan);
    this.listen();
  }

  planOn() {
    const { graph, now, queue } = this;
    for (const what of findForgotten(this.plan.track, now)) queue.push({ do: "finish", id: `${what}.0`, what });
    const far = this.plan.end >= now + this.ahead - Math.min(SLACK, this.ahead / 2);
    if (queue.length || !far) {
      this.plan = hear(graph, this.plan, now, queue, far ? this.plan.end : now + this.ahead, this.options);
      const done = { state: "done", at: null, until: null, what: [], why: "" };
      for (const { id, do: what } of queue) if (TAKING.includes(what)) this.finish({ id, ...done });
      this.queue = [];
    }
    if (this.seen - this.forgot < FORGETTING) return;
    this.forgot = this.seen; // what has begun and ended since then is still to be told
    this.forget(this.seen - this.recent);
  }

  /** Forget what is over, and settle the answers of what was asked for then. */
  forget(over) {
    const known = answers(this.plan, this.asked);
    this.plan = since(this.plan, over);
    const left = answers(this.plan, this.asked);
    for (const answer of known.values()) {
      // What the plan no longer knows was played; so was a look without an end that another has replaced.
      if (answer.until !== null && (answer.until < over || left.get(answer.id).until === null)) this.finish({ ...answer, state: "done" });
      else if (answer.state === "refused" || answer.state === "done") this.finish(answer);
    }
  }

  /** Note what has begun or ended since the update before. */
  listen() {
    const { now, seen } = this;
    const from = this.happened.length;
    for (const layer of LAYERS) {
      for (const { start, end, meta, action } of this.plan.layers[layer].cues) {
        if (start > now) break;
        if (end <= seen || (start <= seen && end > now)) continue;
        this.note(start, end, layer, action.name, meta.split("+")[0]); // what goes on after a cut is the same request
      }
    }
    for (const { kind, at, id, said, reason } of this.speech.watch(this.plan.track.speeches, seen, now)) {
      this.happened.push({ kind, at, layer: "speech", action: said, meta: id, reason });
    }
    this.seen = now;
    if (this.happened.length === from) return;
    this.happened.sort((a, b) => a.at - b.at);
    this.happened.splice(0, this.happened.length - REMEMBERED);
  }

  note(start, end, layer, action, meta) {
    if (start > this.seen && start <= this.now) this.happened.push({ kind: "begin", at: start, layer, action, meta, reason: "" });
    if (end > this.seen && end <= this.now) this.happened.push({ kind: "end", at: end, layer, action, meta, reason: "" });
  }

  /**
   * Return what began and ended since this was last asked for, in order of time, of more than 1000 the latest: for sounds and game logic.
   * kind, at, layer ("speech" for what is said), action (its name; of what is said the line's id, else the text), meta (the request's
   * id), reason (where all that is said under an id is over: finished, interrupted or replaced; else "").
   */
  events() {
    const { happened } = this;
    if (happened.length) this.happened = [];
    return happened;
  }

  /**
   * Return what becomes of a request: `state` planned, late, refused or done; `at` and `until` seconds, when it plays, null when that is
   * not known or never; `what` plays; `why` not as asked.
   * @param {string} id
   */
  answer(id) {
    const settled = this.settled.get(id);
    if (settled) return settled;
    const nothing = { id, at: null, until: null, what: [] };
    if (!this.asked.has(id)) return { ...nothing, state: "refused", why: `nothing was asked for as '${id}'` };
    if (this.queue.some((ask) => ask.id === id)) return { ...nothing, state: "planned", why: "taken up at the next update" };
    return answers(this.plan, [id]).get(id);
  }

  /**
   * Return what of something said was spoken until now, up to the word that was begun, and that word; "" where nothing was.
   * @param {string} id @returns {{text: string, lastWord: string}}
   */
  spoken(id) {
    const { living } = this.graph;
    if (!living) return { text: "", lastWord: "" };
    const [text, lastWord] = living.spokenUntil(living.ALPHABET, this.plan.track.speeches, id, this.now);
    return { text, lastWord };
  }

  /**
   * Return the pose at the updated time: local `rotations` [J, 4] xyzw and `translations` [J, 3], metres, of `graph.joints`. The arrays
   * are the character's own, and the next pose overwrites them; `player.pose` writes into others. alive: with the life layers.
   */
  pose(alive = true) {
    this.player.pose(this.now, this.posed.rotations, this.posed.translations, alive);
    return this.posed;
  }

  /** Return the weights of the graph's morph targets, 0..1, in the order of `graph.morphs`; likewise. */
  morphs(alive = true) {
    this.player.morphs(this.now, this.weights, alive);
    return this.weights;
  }
}
