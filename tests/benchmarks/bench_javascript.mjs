/**
 * What a pose costs: Metagraph's JavaScript runtime beside three.js's AnimationMixer, in one process, by turns.
 *
 *     npm install --prefix tests --no-package-lock
 *     metagraph export sample_clips/sample.metagraph.yaml -o out/sample
 *     node tests/benchmarks/bench_javascript.mjs [FOLDER of an export, out/sample] [characters, 1000] [rounds, 60]
 *
 * Both sides: as many characters, each with its own motion at its own time, three layers over the same joints and clips, a frame of
 * 1/60 s a round. Ours: each with a plan of its own that its models wrote, blends and changes of stance included. three.js: a mixer
 * each, one action for the body and an additive one (AnimationUtils.makeClipAdditive) for each further layer, no blends. Neither
 * side works out matrices. Printed are medians of processor time over the rounds and their ratios.
 */

import { readFileSync, readdirSync } from "node:fs";
import { join } from "node:path";
import { LAYERS, Player, emptyPlan, hear, load } from "../../metagraph/engines/runtimes/javascript/index.js";
import { MetagraphObject } from "../../metagraph/engines/runtimes/javascript/three.js";

globalThis.self ??= globalThis;
const THREE = await import("three");
const { GLTFLoader } = await import("three/examples/jsm/loaders/GLTFLoader.js");
const { clone } = await import("three/examples/jsm/utils/SkeletonUtils.js");

const [folder = "out/sample", count = 1000, rounds = 60] = process.argv.slice(2);
const FRAME = 1 / 60;
const LENGTH = 60; // seconds planned
const name = readdirSync(folder).find((file) => file.endsWith(".json") && !file.startsWith(".") && file !== "vectors.json");
const text = readFileSync(join(folder, name), "utf8");
const data = JSON.parse(text);
const glb = readFileSync(join(folder, data.glb));
const graph = load(text, glb);
const gltf = await new GLTFLoader().parseAsync(glb.buffer.slice(glb.byteOffset, glb.byteOffset + glb.byteLength), "");
const seconds = (n) => ((n * 7919) % 4000) / 100; // each at its own time

// --- ours

const began = performance.now();
const plans = Array.from({ length: Number(count) }, (_, n) => hear(graph, emptyPlan(n + 1), 0, [], LENGTH));
const planning = (performance.now() - began) / plans.length;
const rotations = new Float32Array(4 * graph.joints.length);
const translations = new Float32Array(3 * graph.joints.length);

function ours(alive) {
  const players = plans.map((plan) => new Player(graph, plan));
  let frame = 0;
  return () => {
    frame += 1;
    for (let n = 0; n < players.length; n++) players[n].pose(seconds(n) + frame * FRAME, rotations, translations, alive);
  };
}

/** Every character amid a blend of its arms, the dearest moment there is. */
function blending() {
  const players = plans.map((plan) => new Player(graph, plan));
  const times = plans.map((plan) => {
    const cue = plan.layers.arms.cues.find((c) => c.blendIn > 0.1) ?? plan.layers.arms.cues[0];
    return cue ? cue.start + 0.5 * cue.blendIn : 0;
  });
  return () => players.forEach((player, n) => player.pose(times[n], rotations, translations, true));
}

// --- three.js

/** Return a clip's tracks on the joints that a layer reaches. */
function reached(clip, layer) {
  const joints = new Set([...graph.layers[layer].reach].map((joint) => THREE.PropertyBinding.sanitizeNodeName(graph.joints[joint])));
  const tracks = clip.tracks.filter((track) => joints.has(THREE.PropertyBinding.parseTrackName(track.name).nodeName));
  return new THREE.AnimationClip(`${layer} ${clip.name}`, clip.duration, tracks.map((track) => track.clone()));
}

const clips = Object.fromEntries(
  LAYERS.map((layer) => {
    const ids = new Set([...graph.layers[layer].actions.values()].map((action) => action.clip));
    const used = new Set(data.clips.filter((clip) => ids.has(clip.id)).map((clip) => clip.name));
    const found = gltf.animations.filter((clip) => used.has(clip.name)).map((clip) => reached(clip, layer));
    return [layer, layer === LAYERS[0] ? found : found.map((clip) => THREE.AnimationUtils.makeClipAdditive(clip))];
  }),
);
const scenes = plans.map(() => clone(gltf.scene));
const mixers = scenes.map((scene, n) => {
  const mixer = new THREE.AnimationMixer(scene);
  LAYERS.forEach((layer, place) => {
    if (clips[layer].length) mixer.clipAction(clips[layer][(n * 31 + place) % clips[layer].length]).play();
  });
  mixer.update(seconds(n));
  return mixer;
});
const objects = plans.map((plan, n) => {
  const object = new MetagraphObject(graph, scenes[n], { seed: n + 1, ahead: LENGTH });
  object.update(seconds(n) % 40);
  return object;
});

// --- by turns

const sides = {
  "three.js, one mixer each": () => mixers.forEach((mixer) => mixer.update(FRAME)),
  "ours, layers": ours(false),
  "ours, layers and life": ours(true),
  "ours, all amid a blend, alive": blending(),
  "ours, bound to three.js, alive, planning on": () => objects.forEach((object) => object.update(FRAME)),
};
const taken = Object.fromEntries(Object.keys(sides).map((side) => [side, []]));
for (let round = -20; round < Number(rounds); round++) {
  for (const [side, run] of Object.entries(sides)) {
    const start = process.cpuUsage(); // of all threads, the collector's too, whatever else the machine does
    run();
    const { user, system } = process.cpuUsage(start);
    if (round >= 0) taken[side].push((user + system) / 1000);
  }
}
const median = (list) => [...list].sort((a, b) => a - b)[list.length >> 1];
const mixed = median(taken["three.js, one mixer each"]);
console.log(`${data.name}: ${count} characters, ${graph.joints.length} joints, ${graph.clips.size} clips`);
console.log(`three.js r${THREE.REVISION}, node ${process.version}`);
console.log(`planning ${LENGTH} s: ${planning.toFixed(2)} ms a character`);
for (const [side, list] of Object.entries(taken)) {
  const time = median(list);
  const each = ((1000 * time) / count).toFixed(2).padStart(6);
  console.log(`${side.padEnd(46)} ${time.toFixed(2).padStart(7)} ms a frame  ${each} us each  ${(time / mixed).toFixed(2)} x three.js`);
}
