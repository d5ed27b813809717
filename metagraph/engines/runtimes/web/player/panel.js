/** The panel: everything that can be asked of the character, as buttons, and what became of it. */

const LAYERS = ["arms", "head", "body"];
const ANSWERS = 6; // of what was asked last
const MODES = ["idle", "listening", "talking", "thinking", "reacting"];

/** Make an element. @param {string} tag @param {object} [properties] @param {...(Node | string)} children */
function make(tag, properties = {}, ...children) {
  const out = Object.assign(document.createElement(tag), properties);
  out.append(...children);
  return out;
}

const row = (...children) => make("div", { className: "row" }, ...children);

/**
 * Fill the panel. Returns what the page asks of it each frame: `update()`, and `follow()`, the gaze at the pointer where that was asked for.
 * @param {HTMLElement} panel @param {import("../../javascript/element.js").MetagraphCharacter} element
 */
export function fillPanel(panel, element) {
  const { object, stage } = element;
  const { character } = object;
  const { graph } = character;
  const told = [];
  const answers = make("ul", { id: "answers" });
  let following = false, placed = -1;
  const stances = new Map(); // button -> [layer, stance]

  function ask(request, words) {
    told.unshift({ id: object.ask(request), words });
    told.length = Math.min(told.length, ANSWERS);
  }

  function button(words, request, kind = "") {
    const text = typeof words === "string" ? words : words.title;
    return make("button", { type: "button", textContent: text, className: kind ? `mark ${kind}` : "", onclick: () => ask(request, text) });
  }

  const pause = make("button", { type: "button", title: "Pause (Space)" });
  pause.onclick = () => (element.paused = !element.paused);
  panel.append(row(make("h1", { textContent: graph.name, title: graph.name }), pause));

  let mode = "idle";
  const modes = MODES.map((name) => make("button", { type: "button", textContent: name, onclick: () => be(name) }));
  /** Let the character be in a mode from now on. @param {string} name */
  function be(name) {
    mode = name;
    ask({ do: "mode", mode: name }, name);
  }
  panel.append(make("h2", { textContent: "Mode" }), row(...modes));

  const declared = Object.entries(character.describe().parameters ?? {});
  if (declared.length) panel.append(make("h2", { textContent: "Parameters" }));
  for (const [name, parameter] of declared) {
    const control = makeControl(parameter, (value) => told.unshift({ id: character.setParameter(name, value), words: name }));
    if (control) panel.append(make("label", { className: "row", title: parameter.about }, name, control));
  }

  for (const layer of LAYERS) {
    const { actions, stances: known } = graph.layers[layer];
    const every = [...actions.values()];
    if (!every.length) continue;
    const gestures = every.filter((action) => action.kind === "gesture");
    const tags = [...new Set(gestures.flatMap((action) => action.tags))].sort();
    panel.append(make("h2", { textContent: layer[0].toUpperCase() + layer.slice(1) }));
    const now = row();
    if (gestures.length) now.append(button("any gesture", { do: "gesture", layer }, "gesture"));
    for (const tag of tags) now.append(button(tag, { do: "gesture", layer, tags: [tag] }, "gesture"));
    if (every.some((action) => action.kind === "fidget")) now.append(button("fidget", { do: "fidget", layer }, "fidget"));
    panel.append(now);
    const places = row();
    places.style.marginTop = "6px";
    for (const { id, name } of known.values()) {
      const go = button(name, { do: "stance", layer, stance: id, stay: true }, "stance"); // else the models leave it at once
      stances.set(go, [layer, id]);
      places.append(go);
    }
    panel.append(places);
  }

  panel.append(make("h2", { textContent: "One action" }));
  const chosen = make("select", { ariaLabel: "Action" });
  for (const layer of LAYERS) {
    const group = make("optgroup", { label: layer });
    for (const action of graph.layers[layer].actions.values()) group.append(new Option(action.name, action.id));
    if (group.children.length) chosen.append(group);
  }
  const play = make("button", { type: "button", textContent: "Play" });
  play.onclick = () => ask({ do: "action", action: chosen.value }, chosen.selectedOptions[0]?.text ?? "");
  panel.append(row(chosen, play));

  panel.append(make("h2", { textContent: "Speech" }));
  const words = make("input", { type: "text", placeholder: "What it says", ariaLabel: "What it says", maxLength: 400 });
  const speak = make("form", { className: "row", onsubmit: say }, words, make("button", { textContent: "Say" }));
  function say(event) {
    event.preventDefault();
    if (words.value.trim()) ask({ do: "say", text: words.value.trim() }, `“${words.value.trim()}”`);
  }
  panel.append(speak);
  if (graph.lines.size) {
    const lines = row();
    lines.style.marginTop = "6px";
    for (const [line, { text }] of graph.lines) lines.append(button(text || line, { do: "say", line }));
    panel.append(lines);
  }

  panel.append(make("h2", { textContent: "Gaze" }));
  const follow = make("button", { type: "button", textContent: "at the pointer" });
  const gaze = (words, to) => make("button", { type: "button", textContent: words, onclick: () => look(words, to) });
  function look(words, to) {
    following = to === "pointer";
    ask({ do: "look", to, strict: to === "pointer" }, `look ${words}`);
  }
  follow.onclick = () => look("at the pointer", "pointer");
  panel.append(row(follow, gaze("at you", "user"), gaze("ahead", "ahead"), button("blink", { do: "blink" })));
  element.after(answers);

  function followPointer() {
    const point = following && stage.pointed(), now = character.now;
    if (!point || Math.abs(now - placed) < 0.1) return; // ten times a second is enough for eyes
    placed = now;
    object.ask({ do: "place", id: "pointer", name: "pointer", point });
  }

  let shown = "";
  function update() {
    pause.textContent = element.paused ? "Play" : "Pause";
    follow.setAttribute("aria-pressed", String(following));
    for (const button of modes) button.setAttribute("aria-pressed", String(button.textContent === mode));
    for (const [go, [layer, stance]] of stances) go.setAttribute("aria-pressed", String(resting(character, layer) === stance));
    const rows = told.map(({ id, words }) => ({ words, answer: character.answer(id) }));
    const key = JSON.stringify(rows);
    if (key === shown) return;
    shown = key;
    answers.replaceChildren(...rows.map(({ words, answer }) => make("li", { className: answer.state, textContent: `${words}: ${worded(answer)}` })));
  }
  update();
  return { update, follow: followPointer, be };
}

/** Return the control of a parameter, null for lists and points. @param {object} parameter as `describe()` has it */
function makeControl({ type, initial, least, most, choices }, set) {
  if (type === "trigger") return make("button", { type: "button", textContent: "Play", onclick: () => set() });
  if (type === "boolean") return make("input", { type: "checkbox", checked: initial === true, onchange: (e) => set(e.target.checked) });
  if (type === "number") {
    const slider = make("input", { type: "range", min: least, max: most, step: (most - least) / 100, oninput: (e) => set(Number(e.target.value)) });
    slider.value = initial ?? least;
    return slider;
  }
  if (type !== "enum") return null;
  const select = make("select", { onchange: (e) => set(e.target.value) }, ...choices.map((name) => new Option(name)));
  select.value = initial ?? choices[0];
  return select;
}

/** Return the stance a layer is in, or leaves. */
function resting(character, layer) {
  const { cues, rests } = character.plan.layers[layer];
  let stance = rests.length ? rests[0].stance : null;
  for (const cue of cues) {
    if (cue.start > character.now) break;
    stance = cue.end > character.now ? cue.stance : cue.then;
  }
  return stance;
}

function worded({ state, at, until, what, why }) {
  const time = at === null ? "" : ` at ${at.toFixed(1)}${until !== null && until < 1e6 ? `–${until.toFixed(1)}` : ""} s`;
  const names = what.length ? ` (${what.join(", ")})` : "";
  return `${state}${time}${names}${why ? `: ${why}` : ""}`;
}
