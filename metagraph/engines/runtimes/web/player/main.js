/**
 * The page: the character, and behind a switch what may be asked of it and what is planned. Its address may say `?panel`, `?seed=7`,
 * `?idle=0`, `?mode=listening`, `?paused`, `?camera=face`, `?export=other.json`. `window.metagraph` is for scripts and tests.
 */

import "../metagraph-character.js";
import { Lanes } from "./lanes.js";
import { fillPanel } from "./panel.js";

const options = new URLSearchParams(location.search);
const element = document.getElementById("character");
const [ask, panel, plan] = ["ask", "panel", "plan"].map((id) => document.getElementById(id));

for (const [name, attribute] of [["seed", "seed"], ["camera", "camera"], ["export", "src"]])
  if (options.has(name)) element.setAttribute(attribute, options.get(name));
if (options.get("idle") === "0") element.setAttribute("idle", "off");
if (options.has("paused")) element.paused = true;

const light = matchMedia("(prefers-color-scheme: light)");
function paint() {
  const look = getComputedStyle(document.documentElement);
  for (const [attribute, name] of [["background", "--ground"], ["floor", "--floor"]])
    element.setAttribute(attribute, look.getPropertyValue(name).trim());
}
light.addEventListener("change", paint);
paint();

function show(on) {
  panel.hidden = plan.hidden = !on;
  document.body.classList.toggle("asking", on);
  ask.setAttribute("aria-pressed", String(on));
}
ask.onclick = () => show(panel.hidden);
show(options.has("panel"));

let parts = null;
function draw() {
  if (!parts || panel.hidden) return;
  parts.lanes.draw();
  parts.asked.update();
}

element.addEventListener("load", () => {
  document.title = `${element.character.graph.name} – Metagraph`;
  panel.replaceChildren();
  document.getElementById("answers")?.remove();
  const asked = fillPanel(panel, element);
  const mode = options.get("mode") ?? "talking"; // as the preview plays it
  if (mode && options.get("idle") !== "0") asked.be(mode);
  parts = { asked, lanes: new Lanes(document.getElementById("lanes"), element.object) };
  window.metagraph = {
    element, object: element.object, stage: element.stage,
    /** Move on to a time and stay there. @param {number} seconds */
    seek(seconds) {
      element.seek(seconds);
      draw();
    },
  };
});
element.addEventListener("frame", () => {
  parts?.asked.follow();
  draw();
});
addEventListener("keydown", (event) => {
  if (event.ctrlKey || event.metaKey || event.altKey || /INPUT|SELECT|TEXTAREA/.test(event.target.tagName)) return;
  if (event.code === "KeyR") ask.click();
  else if (event.code === "Space" && event.target.tagName !== "BUTTON") element.paused = !element.paused;
  else return;
  event.preventDefault();
});
