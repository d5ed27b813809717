// node playcanvas.mjs GRAPH.json CLIPS.glb STEPS.json: plays a state graph and prints, after each step, active states and joints' transforms.
// STEPS: [{"seconds": s, "integers": {name: value}, "triggers": [name]}...]
import fs from "node:fs";
import * as pc from "playcanvas";
import { readGlb } from "./glb.mjs";

const canvas = { id: "x", addEventListener() {}, removeEventListener() {}, width: 4, height: 4, style: {}, getBoundingClientRect: () => ({ width: 4, height: 4, left: 0, top: 0 }) };
globalThis.window ??= { addEventListener() {}, removeEventListener() {} };
globalThis.document ??= { addEventListener() {}, removeEventListener() {}, createElement: () => canvas, hidden: false };
const app = new pc.AppBase(canvas);
const options = new pc.AppOptions();
options.graphicsDevice = new pc.NullGraphicsDevice(canvas);
options.componentSystems = [pc.AnimComponentSystem];
options.resourceHandlers = [];
app.init(options);

const [graph, glb, script] = process.argv.slice(2);
const { nodes, parents, animations } = readGlb(glb);
const entities = nodes.map((node) => {
  const entity = new pc.Entity(node.name, app);
  if (node.translation) entity.setLocalPosition(...node.translation);
  if (node.rotation) entity.setLocalRotation(...node.rotation);
  return entity;
});
parents.forEach((parent, child) => entities[parent].addChild(entities[child]));
const root = entities[nodes.findIndex((_, n) => !parents.has(n))];
app.root.addChild(root);

const path = (n) => (parents.has(n) ? [...path(parents.get(n)), nodes[n].name] : [nodes[n].name]);
const PROPERTY = { rotation: "localRotation", translation: "localPosition" };
const tracks = new Map(animations.map(({ name, channels }) => {
  const used = channels.filter((c) => PROPERTY[c.path]);
  const inputs = used.map((c) => new pc.AnimData(1, c.times));
  const outputs = used.map((c) => new pc.AnimData(c.path === "rotation" ? 4 : 3, c.values));
  const curves = used.map((c, n) => new pc.AnimCurve([{ entityPath: path(c.node), component: "graph", propertyPath: [PROPERTY[c.path]] }], n, n, pc.INTERPOLATION_LINEAR));
  const length = Math.max(...used.map((c) => c.times[c.times.length - 1]));
  return [name, new pc.AnimTrack(name, length, inputs, outputs, curves)];
}));

root.addComponent("anim", { activate: true });
root.anim.loadStateGraph(new pc.AnimStateGraph(JSON.parse(fs.readFileSync(graph))));
for (const layer of root.anim.layers) for (const state of layer.states) if (tracks.has(state)) layer.assignAnimation(state, tracks.get(state));
for (const step of JSON.parse(fs.readFileSync(script))) {
  for (const [name, value] of Object.entries(step.integers ?? {})) root.anim.setInteger(name, value);
  for (const name of step.triggers ?? []) root.anim.setTrigger(name);
  for (let n = 0; n < Math.round(step.seconds * 60); n++) app.systems.fire("animationUpdate", 1 / 60);
  const states = Object.fromEntries(root.anim.layers.map((layer) => [layer.name, layer.activeState]));
  const joints = Object.fromEntries(entities.map((e) => {
    const r = e.getLocalRotation(), p = e.getPosition();
    return [e.name, { rotation: [r.x, r.y, r.z, r.w], position: [p.x, p.y, p.z] }];
  }));
  console.log(JSON.stringify({ states, joints }));
}
process.exit(0);
