// Runs vectors with changed copies of the JavaScript runtime, one after another in one process: `node mutants.mjs`.
// Each line read is {"runtime": folder, "folders": [folder, ...]}; each line written {"fault": "", "difference": ""}:
// why the runtime could not be loaded, and how it first differs from the vectors; folders after that one are not looked into.

import { readFileSync } from "node:fs";
import { join } from "node:path";
import { createInterface } from "node:readline";
import { pathToFileURL } from "node:url";

const kept = new Map(); // folder -> texts and bytes: each mutant gets vectors of its own, none reads the files again

function content(folder) {
  if (!kept.has(folder)) {
    const vectors = readFileSync(join(folder, "vectors.json"), "utf8");
    const json = readFileSync(join(folder, JSON.parse(vectors).export), "utf8");
    kept.set(folder, { vectors, json, glb: readFileSync(join(folder, JSON.parse(json).glb)) });
  }
  return kept.get(folder);
}

const AT_ONCE = 30; // cases of a folder: a mutant that some of them notice need not run the others

function* parts(vectors) {
  const { cases, ...beside } = JSON.parse(vectors);
  const { export: name, tolerance } = beside;
  yield { ...beside, cases: cases.slice(0, 3) };
  for (let n = 3; n < cases.length; n += AT_ONCE) yield { export: name, tolerance, hashes: [], cases: cases.slice(n, n + AT_ONCE) };
}

function firstDifference(runVectors, folders) {
  for (const folder of folders) {
    const { vectors, json, glb } = content(folder);
    for (const part of parts(vectors)) {
      let failures;
      try {
        ({ failures } = runVectors(part, json, new Uint8Array(glb)));
      } catch (error) {
        return `${folder}: ${error.message}`;
      }
      if (failures.length) return `${folder}: ${failures[0].case}: ${failures[0].what}`;
    }
  }
  return "";
}

for await (const line of createInterface({ input: process.stdin })) {
  const { runtime, folders } = JSON.parse(line);
  let [fault, difference] = ["", ""];
  try {
    const { runVectors } = await import(pathToFileURL(join(runtime, "conformance.mjs")));
    difference = firstDifference(runVectors, folders);
  } catch (error) {
    fault = String(error.stack);
  }
  console.log(JSON.stringify({ fault, difference }));
}
