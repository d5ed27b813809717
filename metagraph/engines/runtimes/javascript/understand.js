/** From asks at any level of abstraction to what the planner and the life layers work with (Borer et al., section 6, figure 5). */

import { ALPHABET } from "./alphabet.js";
import { readAsk } from "./asks.js";
import { Meaning, PlainAsk, SaidLine, understood } from "./meaning.js";
import { MOODS } from "./mood.js";
import { toldTiming } from "./told_timing.js";
import { LAYERS } from "./words.js";

/**
 * Return what asks mean. An ask that makes several requests gives them ids of its own: `<id>`, `<id>.1`, `<id>.2`, ...
 * @param {import("./graph.js").Graph} graph @param {unknown[]} asks as JSON @param {number} now when those begin that do not say
 * @param {number} soon when it is said, for what is said
 * @returns {Meaning}
 */
export function understand(graph, asks, now, soon) {
  const out = new Meaning(graph, LAYERS.map((layer) => graph.layers[layer]), ALPHABET);
  for (const data of asks) {
    const { ask, why } = readAsk(data);
    const { plain, wrong } = ask ? plainAsk(graph, ask) : { plain: null, wrong: why };
    if (plain) understood(out, plain, now, soon);
    else out.refuse(ask?.id ?? (typeof data?.id === "string" ? data.id : ""), wrong, ask?.layer ?? null, ask?.at ?? now);
  }
  for (const block of out.blocks) {
    out.refuse(block.id, "a runtime does not read BML: send it through Metagraph, or ask for what it says", null, block.at);
  }
  return out;
}

/** Return an ask with every field that any has, or what is wrong with it. */
function plainAsk(graph, ask) {
  const { mood = null, intensity = null, ...rest } = ask;
  const plain = Object.assign(new PlainAsk(ask.do), rest, felt(mood, intensity));
  if (ask.do !== "say") return { plain, wrong: "" };
  const { timing, why } = toldTiming(ask);
  plain.timing = timing;
  plain.line = ask.line === null ? null : String(ask.line);
  const said = plain.line === null ? { line: null, wrong: "" } : saidLine(graph, plain.line, ask.gestures);
  plain.said = said.line;
  const wrong = why || said.wrong;
  return { plain: wrong ? null : plain, wrong };
}

/** Return a line as it is said, null where there is none, or what is wrong with what it asks for. */
function saidLine(graph, name, gestures) {
  const line = graph.lines.get(name);
  if (!line) return { line: null, wrong: "" };
  const asks = [];
  for (const data of gestures ? (line.asks ?? []) : []) {
    const { ask, why } = readAsk(data);
    if (!ask) return { line: null, wrong: `line '${name}' asks for what cannot be read: ${why}` };
    asks.push(ask.do === "say" ? new PlainAsk("say") : plainAsk(graph, ask).plain);
  }
  const seconds = graph.voices.known.get(name)?.duration ?? line.duration ?? null;
  const { valence, arousal, intensity } = felt(line.mood ?? null, line.intensity ?? null);
  return { line: new SaidLine(line.text ?? "", seconds, asks, valence, arousal, intensity), wrong: "" };
}

/** Return what a mood that is asked for tells: valence, arousal and intensity, null where it does not. */
function felt(mood, intensity) {
  const [valence, arousal] = typeof mood === "string" ? MOODS.get(mood) : (mood ?? [null, null]);
  return { valence, arousal, intensity };
}
