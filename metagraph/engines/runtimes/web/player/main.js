/** The web player: loads the export this page names, plays it, and takes requests. `window.metagraph` is for scripts and tests. */

import { load } from "../metagraph/index.js";
import { MetagraphObject } from "../metagraph/three.js";
import { Lanes } from "./lanes.js";
import { fillPanel } from "./panel.js";
import { Stage } from "./stage.js";
import { Voice } from "./voice.js";

const message = document.getElementById("message");

/** Tell what went wrong where the character would stand. @param {string} words */
function fail(words) {
  message.textContent = words;
  message.className = "wrong";
}

async function fetched(url) {
  const answer = await fetch(url).catch(() => null);
  if (!answer) throw new Error(`${url} cannot be fetched.\nServe this folder: python3 -m http.server, then open the address it tells.`);
  if (!answer.ok) throw new Error(`${url} is not there (${answer.status}).\nExport again, and keep its files together.`);
  return answer;
}

async function start() {
  const options = new URLSearchParams(location.search);
  const url = options.get("export") ?? document.body.dataset.export;
  const text = await (await fetched(url)).text();
  const bytes = await (await fetched(new URL(JSON.parse(text).glb, new URL(url, location.href)))).arrayBuffer();
  const graph = load(text, bytes, url);
  const stage = new Stage(document.getElementById("view"));
  const scene = await stage.add(bytes);
  const seed = options.has("seed") ? Number(options.get("seed")) >>> 0 : undefined;
  const object = new MetagraphObject(graph, scene, { seed, idle: options.get("idle") !== "0" });
  const voice = new Voice(JSON.parse(text).lines ?? {}, new URL(url, location.href));
  const lanes = new Lanes(document.getElementById("lanes"), object);
  const state = { paused: options.has("paused") };
  const panel = fillPanel(document.getElementById("panel"), object, stage, state);
  document.title = `${graph.name} – Metagraph`;
  message.textContent = graph.problems.join(" · ");
  // Until the first frame is drawn nobody has seen anything, so time begins there.
  let last = null;
  const frame = (now) => {
    const delta = last === null || state.paused ? 0 : Math.min(0.25, (now - last) / 1000);
    last = now;
    object.update(delta);
    stage.follow(object, panel);
    voice.update(object.character);
    stage.draw();
    if (delta === 0 && !performance.getEntriesByName("first pose").length) performance.mark("first pose");
    lanes.draw();
    panel.update();
    requestAnimationFrame(frame);
  };
  requestAnimationFrame(frame);
  window.metagraph = {
    object, stage, state,
    /** Move on to a time and stay there. @param {number} seconds */
    seek(seconds) {
      state.paused = true;
      object.update(seconds - object.time);
      stage.draw();
      lanes.draw();
      panel.update();
    },
  };
}

start().catch((error) => {
  console.error(error);
  fail(error.message);
});
