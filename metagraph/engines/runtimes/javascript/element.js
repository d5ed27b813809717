/**
 * `<metagraph-character src="sample.json">`: a character in a page. Needs three.js, as "three" and "three/addons/".
 *
 * Attributes: `src`, the export's JSON; `avatar`, a VRM or another GLB of a humanoid that is shown instead of its character; `camera`,
 * what is seen and from where ("body", "upper", "face"; "three-quarter", "front", "left", "right", "back"); `background`, a colour,
 * without it the page shows through; `floor`, a colour; `controls`, dragging turns the camera; `paused`; `seed`; `idle="off"`, only what
 * is asked for happens; `mood`, a name. Events: `load`, `error` (its `detail` is the Error), `avatar` when another look was put on or
 * taken off, and `begin` and `end` of what is performed and said, as `Character.events` tells them, in `detail`.
 */

import { load } from "./load.js";
import { Sounds } from "./sounds.js";
import { Stage, readGlb } from "./stage.js";
import { StreamedVoice } from "./streamed_voice.js";
import { Talk } from "./talk.js";
import { MetagraphObject } from "./three.js";

const STYLE = `:host { display: block; position: relative; min-width: 0; min-height: 120px; max-height: 100vh; aspect-ratio: 3 / 4; }
:host([hidden]) { display: none; }
canvas { position: absolute; inset: 0; width: 100%; height: 100%; display: block; outline-offset: -2px; }
p { position: absolute; inset: auto 12px 10px; margin: 0; font: 14px/1.4 system-ui, sans-serif; color: #888; pointer-events: none; white-space: pre-line; }
p.wrong { color: #c8372d; inset: 40% 12px auto; text-align: center; }`;
const LONGEST = 0.25; // seconds a frame moves on at most, after a page was hidden
const PREPARING = 2; // milliseconds of a frame for motions that may play later

const loaded = new Map(); // address -> what lies there: characters of one export share it

async function fetched(url, remedy = "Export again, and keep its files together.") {
  const answer = await fetch(url).catch(() => null);
  if (!answer) throw new Error(`${url} cannot be fetched.\nServe this folder: python3 -m http.server, then open the address it tells.`);
  if (!answer.ok) throw new Error(`${url} is not there (${answer.status}).\n${remedy}`);
  return answer;
}

/** Return an export's files, its data, and `graph()`, which reads it once and tells what is wrong with it. */
async function exported(url) {
  const text = await (await fetched(url)).text();
  let data = {};
  try {
    data = JSON.parse(text);
  } catch {
    load(text, new ArrayBuffer(0), url); // tells what is wrong
  }
  const bytes = await (await fetched(new URL(data.glb, url))).arrayBuffer();
  let graph = null;
  return { bytes, data, graph: () => (graph ??= load(text, bytes, url)) };
}

export class MetagraphCharacter extends HTMLElement {
  static observedAttributes = ["src", "avatar", "camera", "background", "floor", "controls", "paused"];

  constructor() {
    super();
    this.attachShadow({ mode: "open" }).innerHTML = `<style>${STYLE}</style><canvas part="canvas"></canvas><p part="message" role="status"></p>`;
    this.canvas = this.shadowRoot.querySelector("canvas");
    this.message = this.shadowRoot.querySelector("p");
    this.stage = null;
    /** The MetagraphObject, once it is loaded. @type {MetagraphObject | null} */
    this.object = null;
    this.sounds = null;
    this.coming = null; // the look that is loaded
    this.waiting = []; // asked for before it was loaded
    this.preset = new Map(); // parameters that were set before
    this.talk = null; // what it says, with gestures
    this.early = 0;
    this.said = 0;
    this.drawn = true;
    this.last = null;
    this.seen = null; // what watches whether it is in sight, while it is in a page
    this.restart();
  }

  restart() {
    this.pending = true;
    /** Fulfilled with this element once the character is there. @type {Promise<this>} */
    this.ready = new Promise((resolve, reject) => (this.settle = { resolve, reject }));
    this.ready.catch(() => {}); // who wants to know listens to "error"
  }

  connectedCallback() {
    this.canvas.setAttribute("aria-label", this.getAttribute("aria-label") ?? "A character");
    this.canvas.setAttribute("role", "img");
    this.seen = new IntersectionObserver((entries) => (this.drawn = entries.at(-1).isIntersecting));
    this.seen.observe(this);
    if (this.getAttribute("src")) this.open(this.getAttribute("src"));
    this.frame = requestAnimationFrame((now) => this.step(now));
  }

  disconnectedCallback() {
    cancelAnimationFrame(this.frame);
    this.seen.disconnect();
    this.seen = null;
    this.close();
  }

  attributeChangedCallback(name, before, value) {
    if (!this.seen || before === value) return; // what it has when it comes into the page is read then
    if (name === "src") this.open(value);
    else if (name === "avatar") this.change();
    else if (name === "camera") this.stage?.view(value ?? "");
    else if (name === "controls") this.stage?.turning(value !== null);
    else if (name !== "paused") this.paint();
  }

  paint() {
    this.stage?.paint(this.getAttribute("background"), this.getAttribute("floor"));
  }

  close() {
    this.opening = null;
    this.sounds?.silence();
    this.stage?.dispose();
    this.object = this.stage = this.sounds = this.talk = null;
    this.last = null;
  }

  async open(src) {
    this.close();
    if (!this.pending) this.restart();
    const url = new URL(src, document.baseURI);
    const opening = (this.opening = {}); // another replaces it
    this.tell("Loading…");
    try {
      if (!loaded.has(url.href)) loaded.set(url.href, exported(url));
      loaded.get(url.href).catch(() => {}); // told where it is waited for
      const fresh = this.canvas.cloneNode(); // a canvas whose context was given back draws no more
      this.canvas.replaceWith(fresh);
      this.canvas = fresh;
      const stage = (this.stage = new Stage(this.canvas, this.hasAttribute("controls"))); // while the files come
      this.change(); // its files come at the same time
      const { bytes, data, graph: read } = await loaded.get(url.href);
      if (this.opening !== opening) return; // and the stage was given back
      const chain = data.rig?.chain ?? [];
      const shown = await stage.add(bytes, data.joints?.[chain[chain.length - 1]]?.name).catch((error) => ({ error }));
      if (this.opening !== opening) return;
      stage.view(this.getAttribute("camera") ?? "");
      this.paint();
      if (!shown.error) stage.compile(); // the graphics card's part, while this one reads on
      const graph = read(); // which says best what is wrong
      if (shown.error) throw shown.error;
      const scene = shown;
      for (let coming = null; coming !== this.coming; ) await (coming = this.coming).catch(() => {}); // what is wrong with it is told below
      if (this.opening !== opening) return;
      const seed = this.hasAttribute("seed") ? Number(this.getAttribute("seed")) >>> 0 : undefined;
      this.object = new MetagraphObject(graph, scene, { seed, idle: this.getAttribute("idle") !== "off" });
      this.sounds = new Sounds(data.lines ?? {}, url);
      const language = this.closest("[lang]")?.lang || "en";
      this.talk = new Talk(this.object.character, { language, seed: seed ?? 1, name: "said#" });
      if (this.hasAttribute("mood")) this.object.ask({ do: "mood", mood: this.getAttribute("mood") });
      if (!this.hasAttribute("aria-label")) this.canvas.setAttribute("aria-label", graph.name);
      for (const request of this.waiting.splice(0)) this.object.ask(request);
      for (const [name, value] of this.preset) this.object.setParameter(name, value);
      this.preset.clear();
      await this.wear(this.coming);
      if (this.opening !== opening) return;
      stage.view(this.getAttribute("camera") ?? "");
      this.step(performance.now());
      this.pending = false;
      this.settle.resolve(this);
      this.dispatchEvent(new CustomEvent("load"));
    } catch (error) {
      loaded.delete(url.href); // it may be there the next time
      if (this.opening !== opening) return;
      console.error(error);
      this.tell(error.message, true);
      this.pending = false;
      this.settle.reject(error);
      this.dispatchEvent(new CustomEvent("error", { detail: error }));
    }
  }

  /** Load the look that the attribute names: its scene, and what moves it; null for the export's own. */
  async look() {
    const address = this.getAttribute("avatar");
    if (!address) return null;
    const url = new URL(address, document.baseURI);
    const [{ Avatar }, answer] = await Promise.all([import("./avatar.js"), fetched(url, "Check the address of the avatar.")]);
    const gltf = await readGlb(await answer.arrayBuffer(), /^http/.test(url.protocol) ? new URL(".", url).href : "").catch((error) => {
      throw new Error(`The avatar cannot be used: ${error.message}`);
    });
    return { Avatar, gltf };
  }

  /** Change the look to the one that the attribute names now. */
  change() {
    const coming = (this.coming = this.look());
    coming.catch(() => {}); // told where it is put on
    if (this.object) this.wear(coming);
  }

  /** Put a look on once it is there, unless another has been asked for since. The motion goes on. */
  async wear(coming) {
    const { object } = this;
    let avatar = null;
    try {
      const found = await coming;
      if (this.object !== object || this.coming !== coming) return;
      this.tell(object.character.graph.problems.join(" · "));
      if (!found && !object.avatar) return;
      if (found) avatar = new found.Avatar(object.character.graph, found.gltf);
    } catch (error) {
      if (this.object !== object || this.coming !== coming) return;
      console.error(error);
      this.tell(error.message);
      this.dispatchEvent(new CustomEvent("error", { detail: error }));
      return;
    }
    this.stage.wear(avatar);
    object.avatar = avatar;
    this.dispatchEvent(new CustomEvent("avatar", { detail: { avatar, missing: object.missing } }));
  }

  tell(words, wrong = false) {
    this.message.textContent = words;
    this.message.className = wrong ? "wrong" : "";
    this.toggleAttribute("broken", wrong);
  }

  step(now) {
    cancelAnimationFrame(this.frame);
    this.frame = requestAnimationFrame((next) => this.step(next));
    if (!this.object) return;
    // Until the first frame is drawn nobody has seen anything, so time begins there.
    const delta = this.last === null || this.paused ? 0 : Math.min(LONGEST, (now - this.last) / 1000);
    const first = this.last === null;
    this.last = now;
    this.object.update(delta);
    this.sounds.update(this.object.character, this.paused);
    for (const happening of this.object.events()) this.dispatchEvent(new CustomEvent(happening.kind, { detail: happening }));
    if (this.drawn || first) this.stage.draw();
    if (first) performance.mark("first pose");
    else this.character.graph.prepare(PREPARING);
    this.dispatchEvent(new CustomEvent("frame", { detail: delta }));
  }

  /** The address of the look that is shown instead of the export's own character, null for that. */
  get avatar() {
    return this.getAttribute("avatar");
  }

  set avatar(address) {
    if (address) this.setAttribute("avatar", address);
    else this.removeAttribute("avatar");
  }

  get paused() {
    return this.hasAttribute("paused");
  }

  set paused(on) {
    this.toggleAttribute("paused", Boolean(on));
  }

  /** The Character, once it is loaded. */
  get character() {
    return this.object?.character ?? null;
  }

  /** Seconds of the character's own time. */
  get time() {
    return this.object?.time ?? 0;
  }

  /** What may be asked for, once it is loaded. */
  describe() {
    return this.character?.describe() ?? null;
  }

  /** Ask for something, as of a Character; before it is loaded, too. Returns the request's id. @param {object} request */
  ask(request) {
    if (this.object) return this.object.ask(request);
    const id = request?.id || `early#${(this.early += 1)}`;
    this.waiting.push({ ...request, id });
    return id;
  }

  /** Set a parameter, as of a Character; before it is loaded, too, and then its latest value counts. Returns the request's id, "" before. */
  setParameter(name, value) {
    if (this.object) return this.object.setParameter(name, value);
    this.preset.set(name, value);
    return "";
  }

  /** The value of a parameter, as of a Character; undefined before it is loaded. @param {string} name */
  getParameter(name) {
    return this.character?.getParameter(name);
  }

  /** What became of a request. @param {string} id */
  answer(id) {
    const nothing = { id, at: null, until: null, what: [], state: "planned", why: "taken up once the character is loaded" };
    return this.object?.answer(id) ?? nothing;
  }

  /**
   * Say something. `audio`, its sound: an address, a Blob, the bytes of a file, or an AudioBuffer; it is played in step with the lips,
   * which do what `visemes` or `words` tell, else what is heard in it. Gestures go with the text's words, by the lexicon of the page's
   * `lang`, unless `gestures` is false. Other options are those of the request `say`. Returns a promise of the request's id.
   * @param {string} text @param {{words?: any[], visemes?: any[], set?: string, audio?: string | Blob | ArrayBuffer | AudioBuffer}} [options]
   */
  async say(text, { audio, ...options } = {}) {
    const request = { ...options, do: "say", id: options.id ?? `say#${(this.said += 1)}` };
    if (text) request.text = text;
    if (audio !== undefined) {
      const { url, buffer } = await sound(audio);
      request.duration ??= buffer.duration;
      if (!request.visemes && !request.words) Object.assign(request, heard(buffer));
      await this.ready;
      this.sounds.give(request.id, url);
    }
    if (!text || request.line !== undefined || request.gestures === false) return this.ask(request);
    await this.ready.catch(() => {}); // then it waits for the next one
    if (!this.talk) return this.ask(request);
    const { do: _, text: __, ...rest } = request;
    return this.talk.say(text, rest).id;
  }

  /**
   * Say what comes in piece by piece, as a language model writes it: each sentence when it is whole, after the one before. Returns a
   * promise of the ids of what it says by it. @param {string} piece @param {boolean} [over] whether the text ends here
   */
  async sayPiece(piece, over = false) {
    await this.ready;
    return this.talk.take(piece, over).map(({ id }) => id);
  }

  /**
   * Break off all that is said, because the other speaks: sounds stop, gestures go back, and the gaze goes to the other. What is said
   * next begins at once. Returns the request's id.
   */
  interrupt() {
    return this.talk ? this.talk.interrupt() : this.ask({ do: "interrupt" });
  }

  play() {
    this.paused = false;
  }

  pause() {
    this.paused = true;
  }

  /** Move on to a time and stay there. @param {number} seconds */
  seek(seconds) {
    this.paused = true;
    if (!this.object) return;
    this.object.update(seconds - this.object.time);
    this.stage.draw();
  }
}

/** Return a sound's address and its samples. */
async function sound(audio) {
  if (audio instanceof AudioBuffer) return { url: URL.createObjectURL(new Blob([wave(audio)], { type: "audio/wav" })), buffer: audio };
  const blob = typeof audio === "string" ? await (await fetched(new URL(audio, document.baseURI))).blob() : new Blob([audio]);
  const context = new OfflineAudioContext(1, 1, 44100);
  const buffer = await context.decodeAudioData(await blob.arrayBuffer());
  return { url: typeof audio === "string" ? new URL(audio, document.baseURI).href : URL.createObjectURL(blob), buffer };
}

/** Return what lips do in a sound. @param {AudioBuffer} buffer */
function heard(buffer) {
  const voice = new StreamedVoice(buffer.sampleRate);
  const marks = voice.hear(Array.from(buffer.getChannelData(0)));
  return { visemes: marks.map(({ at, viseme, weight }) => [at, viseme, weight]), set: "oculus" };
}

/** Return a file of a sound's first channel, 16 bits a sample. @param {AudioBuffer} buffer */
function wave(buffer) {
  const samples = buffer.getChannelData(0), size = 2 * samples.length;
  const view = new DataView(new ArrayBuffer(44 + size));
  const text = (at, words) => [...words].forEach((letter, n) => view.setUint8(at + n, letter.charCodeAt(0)));
  text(0, "RIFF");
  view.setUint32(4, 36 + size, true);
  text(8, "WAVEfmt ");
  view.setUint32(16, 16, true);
  view.setUint16(20, 1, true); // numbers as they are
  view.setUint16(22, 1, true);
  view.setUint32(24, buffer.sampleRate, true);
  view.setUint32(28, 2 * buffer.sampleRate, true);
  view.setUint16(32, 2, true);
  view.setUint16(34, 16, true);
  text(36, "data");
  view.setUint32(40, size, true);
  samples.forEach((x, n) => view.setInt16(44 + 2 * n, 32767 * Math.max(-1, Math.min(1, x)), true));
  return view.buffer;
}

if (!customElements.get("metagraph-character")) customElements.define("metagraph-character", MetagraphCharacter);
