import type { Character, Graph } from "./index.js";

/** What an avatar cannot be used for, in words. */
export class AvatarError extends Error {}

/** A humanoid that three.js loaded, as a graph's look: a VRM (0.x, 1.0), or a skeleton named as Mixamo, Unreal, Blender, 3ds Max or VRoid do. */
export class Avatar {
  /** `gltf`: what GLTFLoader made of the file. Its scene is turned and scaled. Throws AvatarError for what is no humanoid. */
  constructor(graph: Graph, gltf: { scene: object; parser?: object });
  readonly scene: any;
  /** The head's object. */
  readonly head: any;
  /** Joints and morph targets of the graph that move nothing of it. */
  readonly missing: readonly string[];
  /** Pose the scene as a character is posed now. */
  pose(character: Character): void;
}
