// node xstate.mjs MACHINE.json STEPS.json: runs a state chart on a simulated clock; prints states, and what it asked to be played, after each step.
import fs from "node:fs";
import { createActor, createMachine, SimulatedClock } from "xstate";

const [chart, script] = process.argv.slice(2);
let played = [];
const machine = createMachine(JSON.parse(fs.readFileSync(chart))).provide({ actions: { play: (_, params) => played.push(params), missed: ({ event }) => played.push({ missed: event.type }) } });
const clock = new SimulatedClock();
const actor = createActor(machine, { clock }).start();
for (const step of JSON.parse(fs.readFileSync(script))) {
  for (const type of step.events ?? []) actor.send({ type });
  clock.increment(Math.round(step.seconds * 1000));
  const states = Object.fromEntries(Object.entries(actor.getSnapshot().value).map(([k, v]) => [k, typeof v === "string" ? v : Object.keys(v)[0]]));
  console.log(JSON.stringify({ states, played }));
  played = [];
}
process.exit(0);
