// node interactivity.mjs CHARACTER.glb STEPS.json: Babylon.js plays a GLB's behaviour graph; prints what plays and where joints are after each step.
// STEPS: [{"seconds": s, "events": [name]}...]; time runs as fast as it can be stepped.
import fs from "node:fs";
import { NullEngine } from "@babylonjs/core/Engines/nullEngine.js";
import { FreeCamera } from "@babylonjs/core/Cameras/freeCamera.js";
import { Vector3 } from "@babylonjs/core/Maths/math.js";
import { Scene } from "@babylonjs/core/scene.js";
import { AppendSceneAsync } from "@babylonjs/core/Loading/sceneLoader.js";
import "@babylonjs/loaders/glTF/2.0/index.js";
import { registerBuiltInGLTFExtensions } from "@babylonjs/loaders/glTF/2.0/Extensions/dynamic.js";

registerBuiltInGLTFExtensions();
const engine = new NullEngine({ renderWidth: 64, renderHeight: 64, textureSize: 64 });
const scene = new Scene(engine);
new FreeCamera("camera", new Vector3(0, 1, -5), scene);
const [file, script] = process.argv.slice(2);
await AppendSceneAsync(`data:;base64,${fs.readFileSync(file).toString("base64")}`, scene, { pluginExtension: ".glb" });
const { FlowGraphCoordinator } = await import("@babylonjs/core/FlowGraph/flowGraphCoordinator.js");
const coordinator = FlowGraphCoordinator.SceneCoordinators.get(scene)?.[0];
scene.useConstantAnimationDeltaTime = true; // 16 ms a frame, however fast frames come
for (const step of JSON.parse(fs.readFileSync(script))) {
  for (const name of step.events ?? []) coordinator.notifyCustomEvent(name, {});
  for (let n = 0; n < (1000 * step.seconds) / 16; n++) {
    scene.render();
    await new Promise((done) => setImmediate(done));
  }
  const playing = scene.animationGroups.filter((g) => g.isPlaying).map((g) => g.name);
  const joints = Object.fromEntries(scene.transformNodes.map((n) => [n.name, n.getAbsolutePosition().asArray()]));
  console.log(JSON.stringify({ playing, joints }));
}
process.exit(0);
