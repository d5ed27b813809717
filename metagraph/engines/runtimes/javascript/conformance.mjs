/**
 * Does this runtime do what Metagraph does? Runs conformance vectors: `node conformance.mjs FOLDER...`, each with vectors.json and the
 * export it names. Ends with 1 and a line for each failure where something differs. A page runs them with `runVectors`.
 */

import { LAYERS, StreamedVoice, describe, emptyPlan, hear, key32, keyOf, load, morphsAt, poseAt, since } from "./index.js";
import { ALPHABET } from "./alphabet.js";
import { answers } from "./hear.js";
import { Mood, MoodFrom, Moods } from "./mood.js";
import { Parameters } from "./parameters.js";
import { positions } from "./rotation.js";
import { answerRule } from "./single_rules.js";
import { SpeechWatch } from "./speech_watch.js";
import { spokenUntil } from "./spoken_so_far.js";
import { Laugh, laughsAlong, moodsTakenUp } from "./sympathy.js";
import { lexiconOf } from "./talk.js";
import { findForgotten } from "./utterances.js";
import { ToldWord, gestureAsks, proposedFor, sentenceEnd, wordsOf } from "./word_gestures.js";

const BESIDE = ["described", "heard", "talked", "sympathies", "rules", "settings"]; // what vectors have beside cases

/**
 * @param {object} vectors the content of vectors.json @param {string} exportJson @param {Uint8Array | ArrayBuffer} glbBytes
 * @returns {{passed: number, failures: {case: string, what: string}[]}} `passed`: how many cases
 */
export function runVectors(vectors, exportJson, glbBytes) {
  const failures = [];
  let passed = 0;
  const graph = load(exportJson, glbBytes, vectors.export);
  const run = (name, check) => {
    const found = [];
    try {
      check((what) => found.push(what));
    } catch (error) {
      found.push(`failed: ${error.stack.split("\n").slice(0, 2).join("")}`);
    }
    failures.push(...found.map((what) => ({ case: name, what })));
    if (!found.length) passed += 1;
  };
  run("hashes", (fail) => {
    for (const [seed, words, hash] of vectors.hashes) {
      if (key32(seed, ...words) !== hash) fail(`${seed} ${JSON.stringify(words)} is ${key32(seed, ...words)}, should be ${hash}`);
    }
  });
  if (vectors.described) run("described", (fail) => compare("described", describe(graph), vectors.described, vectors.tolerance.seconds, fail));
  if (vectors.heard) {
    run("heard", (fail) => {
      for (const { rate, pieces, said, marks, seconds } of vectors.heard) {
        const voice = new StreamedVoice(rate);
        const found = pieces.map((piece, n) => {
          voice.follow(said[n]);
          return [voice.hear(piece.map((x) => x / 128)).map(({ at, viseme, weight }) => [at, viseme, weight]), voice.seconds];
        });
        compare("heard", found, marks.map((one, n) => [one, seconds[n]]), vectors.tolerance.seconds, fail);
      }
    });
  }
  if (vectors.talked) {
    run("talked", (fail) => {
      vectors.talked.forEach((row, n) => {
        const { sentences, words, asks } = row;
        compare(`talked[${n}]`, talkOf(row), { sentences, words, asks }, vectors.tolerance.seconds, fail);
      });
    });
  }
  if (vectors.sympathies) {
    run("sympathies", (fail) => {
      for (const row of vectors.sympathies) {
        compare("sympathies", sympathiesOf(row), [row.taken, row.along], vectors.tolerance.seconds, fail);
      }
    });
  }
  if (vectors.rules) {
    run("rules", (fail) => {
      vectors.rules.forEach(([rule, seed, numbers, texts, answer], n) => {
        compare(`rules[${n}], ${rule}`, answerRule(ALPHABET, seed, rule, numbers, texts), answer, vectors.tolerance.seconds, fail);
      });
    });
  }
  if (vectors.settings) {
    run("settings", (fail) => {
      const parameters = new Parameters(graph.parameters);
      const found = vectors.settings.map(({ name, value }) => setOf(parameters, name, value));
      compare("settings", found, vectors.settings.map(({ request, wrong, now }) => [request, wrong, now]), vectors.tolerance.seconds, fail);
    });
  }
  for (const each of vectors.cases) run(each.name, (fail) => runCase(graph, each, vectors.tolerance, fail));
  return { passed, failures };
}

/** What comes of a text: its sentences, words and gestures. */
function talkOf({ language, text, seconds, told, seed, at, arms, head }) {
  const sentences = [];
  let letters = ALPHABET.letters(text);
  for (let end = sentenceEnd(ALPHABET, letters, true); end > 0; end = sentenceEnd(ALPHABET, letters, true)) {
    sentences.push(letters.slice(0, end).join(""));
    letters = letters.slice(end);
  }
  const words = wordsOf(ALPHABET, text, told.map(([start, end]) => new ToldWord(start, end)), seconds);
  const { lexicon, small } = lexiconOf(language);
  const asks = gestureAsks(proposedFor(words, new Set(arms), head, lexicon, small, seed), at);
  return {
    sentences,
    words: words.map((w) => [w.text, w.plain, w.start, w.end, w.mark]),
    asks: asks.map((ask) => [ask.do, ask.layer, ask.tags, ask.at, ask.stroke, ask.late]),
  };
}

/** What is taken up of another's moods, and whose laughs are joined in. */
function sympathiesOf({ base, own, others, laughs, end, share, seed, who }) {
  const told = (rows) => rows.map(([start, valence, arousal, until]) => new MoodFrom("told", start, valence, arousal, null, until));
  const mine = new Moods(new Mood(...base), told(own));
  const taken = moodsTakenUp(mine, new Moods(new Mood(), told(others)), end, share, seed, who);
  const along = laughsAlong(mine, laughs.map(([start, until]) => new Laugh(start, until)), share, seed, who);
  return [taken, along].map((moods) => moods.map((m) => [m.id, m.start, m.valence, m.arousal, m.end]));
}

/** The request that setting a parameter makes, what is wrong with it, and the values of all then. */
function setOf(parameters, name, value) {
  let [request, wrong] = [null, ""];
  const ask = (data) => {
    request = data;
    return name;
  };
  parameters.set(name, value, ask, (why) => {
    wrong = why;
  });
  return [request, wrong, Object.fromEntries(Object.keys(parameters.exported).map((each) => [each, parameters.get(each)]))];
}

/** Look at what is said: after each step of a case, and later. */
class Watch {
  speech = new SpeechWatch();
  seen = -1;
  said = [];
  rows = [];

  look(plan, now, asks) {
    const { speeches } = plan.track;
    for (const ask of asks) if (ask.do === "say" && !this.said.includes(ask.id)) this.said.push(ask.id);
    const maybe = (seconds) => (seconds === null || seconds > 1e8 ? null : seconds);
    this.rows.push({
      now,
      events: this.speech.watch(speeches, this.seen, now).map((e) => [e.kind, e.at, e.id, e.said, e.reason]),
      spoken: this.said.map((id) => [id, ...spokenUntil(ALPHABET, speeches, id, now)]).filter(([, text]) => text !== ""),
      silent: findForgotten(plan.track, now),
      answers: [...answers(plan, asks.map((ask) => ask.id)).values()].map((a) => [a.id, a.state, maybe(a.at), maybe(a.until), a.what]),
    });
    this.seen = now;
  }
}

function runCase(graph, { seed, idle, stances, steps, plan: expected, life, poses, watched = [] }, tolerance, fail) {
  let plan = emptyPlan(seed);
  const watch = new Watch();
  for (const { now, end, asks, forget } of steps) {
    plan = hear(graph, plan, now, asks, end, { stances, idle });
    if (watched.length) watch.look(plan, now, asks);
    if (forget !== null) plan = since(plan, forget);
  }
  for (const { now } of watched.slice(steps.length)) watch.look(plan, now, []);
  compare("watched", watch.rows, watched, tolerance.seconds, fail);
  const same = (where, found, wanted) => compare(where, found, wanted, tolerance.seconds, fail);
  for (const layer of LAYERS) {
    const found = plan.layers[layer];
    const wanted = expected.layers[layer];
    same(`${layer}.metas`, found.metas.map((m) => [keyOf(m), m.start, m.end, m.written]), wanted.metas);
    same(`${layer}.cues`, found.cues.map(cueData), wanted.cues);
    same(`${layer}.rests`, found.rests.map((r) => [r.stance, r.action.id, r.start, r.fadeStart, r.fade]), wanted.rests);
  }
  const reports = plan.reports.map((r) => [r.request, r.outcome, r.layer, r.at, r.played]);
  const sorted = (rows) => [...rows].sort((a, b) => (order(a) < order(b) ? -1 : 1));
  same("reports", sorted(reports), sorted(expected.reports));
  for (const lane of ["modes", "breaths", "aversions", "saccades", "blinks", "swells", "emphases"]) {
    same(`life.${lane}`, plan.life[lane].times.map((start, n) => [start, ...plan.life[lane].rows[n]]), life[lane]);
  }
  if (life.moods) same("life.moods", plan.life.moods.times.map((start, n) => [start, ...plan.life.moods.rows[n]]), life.moods);
  same("life.targets", plan.life.targets.map((t) => [t.start, t.to, t.since, t.amount, t.strict, t.asked]), life.targets);
  for (const pose of poses) comparePose(graph, plan, pose, tolerance, fail);
}

/** Times of equal reports may differ in the last digits. */
const order = ([request, outcome, layer, at, played]) => JSON.stringify([request, outcome, layer, at.toFixed(5).padStart(20), played]);

function cueData(cue) {
  return {
    action: cue.action.id, start: cue.start, end: cue.end, entry: cue.entry, blend_in: cue.blendIn, blend_out: cue.blendOut,
    stance: cue.stance, then: cue.then, meta: cue.meta, hold_from: cue.holdFrom, hold_to: cue.holdTo, hold: cue.hold,
    ...(cue.extent !== 1 && { extent: cue.extent }), ...(cue.tempo !== 1 && { tempo: cue.tempo }),
    ...(cue.repeats && { cycle_from: cue.cycleFrom, cycle_to: cue.cycleTo }),
  };
}

/** Compare plain data; the first difference is told. */
function compare(where, found, wanted, tolerance, fail) {
  const differ = (a, b, at) => {
    if (typeof b === "number" && typeof a === "number") return Math.abs(a - b) <= tolerance ? "" : `${at} is ${a}, should be ${b}`;
    const plain = (x) => typeof x !== "object" || x === null;
    if (plain(a) || plain(b)) return a === b ? "" : `${at} is ${brief(a)}, should be ${brief(b)}`;
    const keys = Object.keys(b);
    const count = Object.keys(a).length;
    if (count !== keys.length) return `${at} has ${count} entries, should have ${keys.length}: ${brief(a)}, should be ${brief(b)}`;
    for (const key of keys) {
      const words = differ(a[key], b[key], `${at}.${key}`);
      if (words) return words;
    }
    return "";
  };
  const words = differ(found, wanted, where);
  if (words) fail(words);
}

const brief = (data) => String(JSON.stringify(data)).slice(0, 300);

function comparePose(graph, plan, { time, alive, rotations, positions: places, morphs }, tolerance, fail) {
  const at = `pose at ${time} s${alive ? ", alive" : ""}`;
  const pose = poseAt(graph, plan, time, alive);
  const where = positions(graph.parents, pose.rotations, pose.translations);
  const worst = { metres: [0, ""], degrees: [0, ""] };
  graph.joints.forEach((joint, j) => {
    const q = [0, 1, 2, 3].map((k) => pose.rotations[4 * j + k]);
    const metres = Math.hypot(...places[j].map((x, k) => x - where[3 * j + k]));
    const degrees = angle(q, rotations[j]);
    if (!(metres <= worst.metres[0])) worst.metres = [metres, joint];
    if (!(degrees <= worst.degrees[0])) worst.degrees = [degrees, joint];
  });
  for (const unit of ["metres", "degrees"]) {
    const [value, joint] = worst[unit];
    if (!(value <= tolerance[unit])) fail(`${at}: ${joint} is ${value.toPrecision(3)} ${unit} off`);
  }
  const found = morphsAt(graph, plan, time, alive);
  for (const name of new Set([...Object.keys(found), ...Object.keys(morphs)])) {
    const [is, should] = [found[name] ?? 0, morphs[name] ?? 0];
    if (!(Math.abs(is - should) <= tolerance.weight)) fail(`${at}: morph target ${name} is ${is}, should be ${should}`);
  }
}

/** Return the angle between two rotations, degrees. */
function angle(a, b) {
  const [ax, ay, az, aw] = a;
  const [bx, by, bz, bw] = b;
  const x = aw * bx - ax * bw - ay * bz + az * by;
  const y = aw * by + ax * bz - ay * bw - az * bx;
  const z = aw * bz - ax * by + ay * bx - az * bw;
  return (360 / Math.PI) * Math.atan2(Math.hypot(x, y, z), Math.abs(ax * bx + ay * by + az * bz + aw * bw));
}

if (typeof process !== "undefined" && process.argv[1] && import.meta.url.endsWith(process.argv[1].split(/[\\/]/).pop())) {
  const { readFileSync } = await import("node:fs");
  const { join } = await import("node:path");
  let failed = 0;
  for (const folder of process.argv.slice(2)) {
    const vectors = JSON.parse(readFileSync(join(folder, "vectors.json"), "utf8"));
    const json = readFileSync(join(folder, vectors.export), "utf8");
    const { passed, failures } = runVectors(vectors, json, readFileSync(join(folder, JSON.parse(json).glb)));
    for (const { case: name, what } of failures) console.log(`${folder}: ${name}: ${what}`);
    console.log(`${folder}: ${passed} of ${vectors.cases.length + 1 + BESIDE.filter((name) => name in vectors).length} cases pass`);
    failed += failures.length;
  }
  process.exit(failed ? 1 : 0);
}
