import type { Answer, Ask, Character, Description, Happening, ParameterValue } from "./index.js";
import type { Avatar } from "./avatar.js";
import type { MetagraphObject } from "./three.js";

export interface AvatarWorn {
  avatar: Avatar | null;
  /** Joints and morph targets of the export that move nothing of it. */
  missing: readonly string[];
}

export interface SayOptions {
  id?: string;
  /** Its sound: an address, a Blob, the bytes of a file, or an AudioBuffer; played in step with the lips. */
  audio?: string | Blob | ArrayBuffer | AudioBuffer;
  words?: (unknown[] | object)[];
  visemes?: (unknown[] | object)[];
  set?: "oculus" | "azure" | "sapi" | "polly" | "arkit";
  /** Whether gestures go with the text's words, true if nothing is said. */
  gestures?: boolean;
  mood?: string | [number, number];
  intensity?: number;
}

/** `<metagraph-character src="sample.json">`. Importing this module defines it; it imports three.js. */
export class MetagraphCharacter extends HTMLElement {
  /** Fulfilled once the character is there; rejected where it cannot be loaded, as the event `error` says, too. */
  readonly ready: Promise<this>;
  readonly object: MetagraphObject | null;
  readonly character: Character | null;
  /** Seconds of the character's own time. */
  readonly time: number;
  paused: boolean;
  /** The address of the humanoid that is shown instead of the export's own character; null for that. Also a `blob:` address. */
  avatar: string | null;
  describe(): Description | null;
  /** Ask for something, before it is loaded, too; returns the request's id. */
  ask(request: Ask): string;
  /** Set a parameter, as `Character.setParameter`; before it is loaded, too. */
  setParameter(name: string, value?: ParameterValue): string;
  getParameter(name: string): ParameterValue | null | undefined;
  answer(id: string): Answer;
  /** Say something, with its sound where there is one; returns a promise of the request's id. */
  say(text: string, options?: SayOptions): Promise<string>;
  /** Say what comes in piece by piece, each sentence when it is whole; returns a promise of the ids of what it says by it. */
  sayPiece(piece: string, over?: boolean): Promise<string[]>;
  /** Break off all that is said, because the other speaks; what is said next begins at once. Returns the request's id. */
  interrupt(): string;
  play(): void;
  pause(): void;
  /** Move on to a time, and stay there. */
  seek(seconds: number): void;
  addEventListener(type: "begin" | "end", listener: (event: CustomEvent<Happening>) => void, options?: boolean | AddEventListenerOptions): void;
  /** Another look was put on, or taken off (`avatar` is null). */
  addEventListener(type: "avatar", listener: (event: CustomEvent<AvatarWorn>) => void, options?: boolean | AddEventListenerOptions): void;
  addEventListener(type: "error", listener: (event: CustomEvent<Error>) => void, options?: boolean | AddEventListenerOptions): void;
  addEventListener(type: string, listener: EventListenerOrEventListenerObject, options?: boolean | AddEventListenerOptions): void;
}

/** What the element takes in HTML, and in JSX. */
export interface MetagraphCharacterAttributes {
  src?: string;
  /** Address of a VRM or another GLB of a humanoid, shown instead of the export's own character. */
  avatar?: string;
  /** Words such as "face", or "upper front". */
  camera?: string;
  background?: string;
  floor?: string;
  seed?: number | string;
  idle?: string;
  mood?: string;
  controls?: boolean | "";
  paused?: boolean | "";
}

type InJsx = MetagraphCharacterAttributes & {
  id?: string;
  className?: string;
  class?: string;
  style?: object;
  hidden?: boolean;
  title?: string;
  slot?: string;
  key?: string | number | null;
  ref?: ((element: MetagraphCharacter | null) => void) | { current: MetagraphCharacter | null } | null;
  children?: unknown;
  [other: `aria-${string}` | `data-${string}` | `on${string}`]: unknown;
};

declare global {
  interface HTMLElementTagNameMap {
    "metagraph-character": MetagraphCharacter;
  }
  namespace JSX {
    interface IntrinsicElements {
      "metagraph-character": InJsx;
    }
  }
}

// @ts-ignore: programs without React have no such module
declare module "react" {
  namespace JSX {
    interface IntrinsicElements {
      "metagraph-character": InJsx;
    }
  }
}
