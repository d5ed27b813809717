import type { Avatar } from "./avatar.js";
import type { Answer, Ask, Character, CharacterOptions, Graph, Happening, ParameterValue } from "./index.js";

/** A character that moves the bones and morph targets of a scene that three.js loaded. */
export class MetagraphObject {
  /** `scene`: an Object3D, such as GLTFLoader makes of the export's GLB. */
  constructor(graph: Graph, scene: { traverse(callback: (object: any) => void): void }, options?: CharacterOptions & { avatar?: Avatar | null });
  readonly character: Character;
  /** The look that is moved instead of the scene, which is hidden then; null for the scene. Setting it does not change the motion. */
  avatar: Avatar | null;
  /** Joints and morph targets that the scene lacks, or that move nothing of the avatar. */
  readonly missing: readonly string[];
  ask(request: Ask): string;
  /** Set a parameter, as `Character.setParameter`. */
  setParameter(name: string, value?: ParameterValue): string;
  getParameter(name: string): ParameterValue | null | undefined;
  /** Say a line whose sound comes in, as `Character.saySound`. */
  saySound(id: string, samples: ArrayLike<number>, rate: number): string;
  answer(id: string): Answer;
  events(): readonly Happening[];
  /** Move on by `delta` seconds and pose the scene; once a frame. */
  update(delta: number): void;
}
