import type { Avatar } from "./avatar.js";
import type { CharacterOptions, Graph } from "./index.js";
import type { MetagraphObject } from "./three.js";

/**
 * A character that moves a scene in each frame, inside of a Canvas. `graph`: what `load` made, once. `scene`: what useGLTF read; a clone
 * (`SkeletonUtils.clone`) for each further character. The options count when graph or scene change.
 */
export function useCharacter(
  graph: Graph,
  scene: { traverse(callback: (object: any) => void): void },
  options?: CharacterOptions & { avatar?: Avatar | null },
): MetagraphObject;
