/** Metagraph's runtime. Times are seconds, lengths metres (Y up, right-handed), quaternions xyzw; joints are told by their place. */

export type Layer = "body" | "arms" | "head";
export type Kind = "stance" | "gesture" | "fidget" | "transition";
export type Limb = "left" | "right" | "both";
export type Mode = "idle" | "listening" | "talking" | "thinking" | "reacting";
export type Point = [number, number, number];
export const LAYERS: readonly Layer[];

/** What every request may say. `after`: seconds from now, wins over `at`; only a Character knows it. */
export interface Common {
  id?: string;
  at?: number | null;
  after?: number;
  priority?: number;
  told?: number | null;
}

/** In which mood: a name, or valence and arousal, -1 to 1; how strongly, 0 to 2. */
export interface Felt {
  mood?: string | [number, number] | null;
  intensity?: number | null;
}

/** What can be asked for; docs/agents/requests.md says what each means. */
export type Ask = Common &
  (
    | ({
        do: "gesture"; layer?: Layer; tags?: string[]; limb?: Limb | null; duration?: number | null; stroke?: number | null;
        hold?: number | null; prepare?: boolean; resume?: boolean; late?: number | null;
      } & Felt)
    | ({ do: "fidget"; layer?: Layer; tags?: string[]; limb?: Limb | null; duration?: number | null; resume?: boolean; late?: number | null } & Felt)
    | ({
        do: "action"; action: string; layer?: Layer | null; stroke?: number | null; hold?: number | null; prepare?: boolean;
        late?: number | null;
      } & Felt)
    | { do: "stance"; stance: string; layer?: Layer | null; stay?: boolean; late?: number | null }
    | { do: "change"; layer?: Layer; limb?: Limb | null; duration?: number | null; late?: number | null }
    | ({ do: "nod" | "shake"; tags?: string[]; late?: number | null } & Felt)
    | { do: "look"; to?: string | Point; duration?: number | null; amount?: number; strict?: boolean }
    | { do: "blink" }
    | ({
        do: "say"; line?: string | number | null; text?: string; duration?: number | null; gestures?: boolean;
        words?: (unknown[] | object)[]; visemes?: (unknown[] | object)[]; set?: "oculus" | "azure" | "sapi" | "polly" | "arkit" | null;
      } & Felt)
    | { do: "mode"; mode?: Mode | null }
    | ({ do: "mood"; duration?: number | null } & Felt)
    | { do: "place"; name: string; point: Point }
    | { do: "withdraw"; what?: string }
  );

export interface Action {
  readonly id: string;
  readonly name: string;
  readonly kind: Kind;
  readonly layer: Layer;
  readonly stance: string;
  readonly endStance: string | null;
  readonly limb: Limb;
  readonly tags: readonly string[];
  /** Clip seconds of the part that plays. */
  readonly start: number;
  readonly end: number;
}

export interface LayerGraph {
  readonly layer: Layer;
  readonly start: string | null;
  readonly stances: ReadonlyMap<string, { readonly id: string; readonly name: string }>;
  readonly actions: ReadonlyMap<string, Action>;
}

/** What may be asked of a character. */
export interface Description {
  readonly project: string;
  /** What `do` of a request may be. */
  readonly words: readonly string[];
  readonly modes: readonly Mode[];
  readonly joints: readonly { readonly name: string; readonly parent: string | null; readonly part: string }[];
  readonly layers: Readonly<
    Record<
      Layer,
      {
        readonly start: string | null;
        readonly stances: readonly { readonly id: string; readonly name: string }[];
        /** All but the loops of stances. `to`: where a transition ends. */
        readonly actions: readonly {
          readonly id: string; readonly name: string; readonly kind: Kind; readonly stance: string; readonly seconds: number;
          readonly to?: string | null; readonly limb?: Limb; readonly tags?: readonly string[];
        }[];
        /** Tag -> how many actions have it. */
        readonly tags: Readonly<Record<string, number>>;
      }
    >
  >;
  readonly lines: readonly { readonly id: string; readonly text: string }[];
  readonly points: Readonly<Record<string, Point>>;
  /** What games set, by name; not there where an export has none. */
  readonly parameters?: Readonly<Record<string, ParameterDescription>>;
}

/** A parameter: a named value of the character that a game sets. */
export interface ParameterDescription {
  readonly type: "number" | "boolean" | "enum" | "list" | "point" | "trigger";
  readonly about: string;
  /** Its value until it is set; a trigger has none. */
  readonly initial?: ParameterValue;
  readonly least?: number;
  readonly most?: number;
  readonly choices?: readonly string[];
}

/** Of a number, a switch, a choice, a list of choices or a point, metres. */
export type ParameterValue = number | boolean | string | readonly string[] | readonly number[];

/** Return what may be asked of any character of a graph. */
export function describe(graph: Graph): Description;

/** A loaded export, shared by all characters that use it. */
export interface Graph {
  readonly name: string;
  readonly joints: readonly string[];
  /** Place of each joint's parent, -1 for none; parents come first. */
  readonly parents: readonly number[];
  /** The pose that offsets are taken against, local: [J, 4] and [J, 3]. */
  readonly baseRotations: Float32Array;
  readonly baseTranslations: Float32Array;
  /** Names of the morph targets that are moved. */
  readonly morphs: readonly string[];
  readonly layers: Readonly<Record<Layer, LayerGraph>>;
  readonly lines: ReadonlyMap<string, { readonly text?: string; readonly duration?: number }>;
  /** What is missing in the GLB, in words; the rest plays all the same. */
  readonly problems: readonly string[];
  /**
   * Make motions that were not played yet, which otherwise is done when they first play, for so many milliseconds and one at least; all
   * of them where nothing is said. Returns how many are left.
   */
  prepare(milliseconds?: number): number;
}

/** Unpacks what is packed by EXT_meshopt_compression; for three.js's `GLTFLoader.setMeshoptDecoder`, too. */
export const MeshoptDecoder: {
  readonly supported: boolean;
  readonly ready: Promise<void>;
  decodeGltfBuffer(target: Uint8Array, count: number, size: number, source: Uint8Array, mode: string, filter?: string): void;
};

/** Which file, where in it, what is wrong, and what to do about it. */
export class MetagraphError extends Error {}

/** The newest version of the export that is read. */
export const FORMAT: number;

/** Return an export's graph. `file`: what to call the JSON in errors. Throws MetagraphError. */
export function load(json: string, glb: Uint8Array | ArrayBuffer, file?: string): Graph;

export interface Options {
  /** Layer -> id of the stance it begins in. */
  stances?: Partial<Record<Layer, string>>;
  /** Whether the models fill the time nobody asks for; true when not given. */
  idle?: boolean;
}

export interface Cue {
  readonly action: Action;
  readonly start: number;
  readonly end: number;
  readonly entry: number;
  readonly blendIn: number;
  readonly blendOut: number;
  readonly stance: string;
  readonly then: string;
  readonly meta: string;
  readonly holdFrom: number;
  readonly holdTo: number;
  readonly hold: number;
  readonly extent: number;
  readonly tempo: number;
  readonly cycleFrom: number;
  readonly cycleTo: number;
  readonly repeats: boolean;
}

export interface Rest {
  readonly stance: string;
  readonly action: Action;
  readonly start: number;
  readonly fadeStart: number;
  readonly fade: number;
}

export interface MetaAction {
  readonly request: { readonly id: string; readonly layer: Layer; readonly kind: Kind };
  readonly start: number;
  readonly end: number;
  readonly part: number;
  readonly written: boolean;
}

export interface Report {
  readonly request: string;
  readonly outcome: string;
  readonly message: string;
  readonly layer: Layer;
  readonly at: number;
  readonly played: boolean;
  readonly written: boolean;
  /** Seconds by which it comes late, or would have, where it said how late it may. */
  readonly late: number;
  /** Key of the meta action whose action serves it, too; "" for none. */
  readonly by: string;
}

/** A value: planning makes new ones. */
export interface Plan {
  readonly seed: number;
  readonly end: number;
  readonly layers: Readonly<
    Record<Layer, { readonly metas: readonly MetaAction[]; readonly cues: readonly Cue[]; readonly rests: readonly Rest[] }>
  >;
  readonly reports: readonly Report[];
}

export interface Answer {
  readonly id: string;
  readonly state: "planned" | "late" | "refused" | "done";
  readonly at: number | null;
  readonly until: number | null;
  readonly what: readonly string[];
  readonly why: string;
}

export interface Pose {
  /** [J, 4] xyzw, local. */
  rotations: Float32Array;
  /** [J, 3] metres, local. */
  translations: Float32Array;
}

/** Return a plan of nothing, up to 0 seconds. `seed`: 32 bits. */
export function emptyPlan(seed: number): Plan;
/** Return the plan with asks (which need ids) worked in that became known at `now`, and the horizon moved to `end`. Throws nothing. */
export function hear(graph: Graph, plan: Plan, now: number, asks: readonly object[], end: number, options?: Options): Plan;
/** Return the plan without what ended before `seconds`. */
export function since(plan: Plan, seconds: number): Plan;
/** Say what a plan does about asks. */
export function answers(plan: Plan, ids: Iterable<string>): Map<string, Answer>;
/** What keys a meta action's draws, and names it in cues. */
export function keyOf(meta: MetaAction): string;
/** Return the 32-bit hash of a seed and words that every draw comes from. */
export function key32(seed: number, ...words: string[]): number;
/** Return a plan's pose at a time. */
export function poseAt(graph: Graph, plan: Plan, time: number, alive?: boolean): Pose;
/** Return the weights of morph targets at a time, by name, 0..1. */
export function morphsAt(graph: Graph, plan: Plan, time: number, alive?: boolean): Record<string, number>;

/** Poses one plan after the other, into arrays of yours; nothing is allocated. */
export class Player {
  constructor(graph: Graph, plan: Plan);
  readonly plan: Plan;
  setPlan(plan: Plan): void;
  pose(time: number, rotations: Float32Array, translations: Float32Array, alive?: boolean): void;
  /** `out`: a weight for each of `graph.morphs`. */
  morphs(time: number, out: Float32Array, alive?: boolean): void;
}

export interface CharacterOptions extends Options {
  /** 32 bits, the export's when not given; characters of one graph want different ones. */
  seed?: number;
  /** Seconds planned in advance, 20. */
  ahead?: number;
  /** Seconds that are remembered, 30. */
  recent?: number;
}

export interface Happening {
  readonly kind: "begin" | "end";
  readonly at: number;
  /** "speech": something was said. */
  readonly layer: Layer | "speech";
  /** Name of the action; of what is said the line's id, else the text. */
  readonly action: string;
  /** Id of the request it is for, or "auto/..." of what the models wrote. */
  readonly meta: string;
}

/** One character of a game. Nothing here throws. */
/** A mouth shape from `at` seconds on. viseme: of the set "oculus"; weight: 0..1. */
export interface VisemeMark {
  readonly at: number;
  readonly viseme: string;
  readonly weight: number;
}
/** A voice that is heard as it comes in. */
export class StreamedVoice {
  constructor(rate: number);
  readonly rate: number;
  /** Up to which it was heard. */
  readonly seconds: number;
  /** Take in the next samples, -1..1; return the shapes that begin in them. */
  hear(samples: ArrayLike<number> & Iterable<number>): VisemeMark[];
}
export class Character {
  constructor(graph: Graph, options?: CharacterOptions);
  readonly graph: Graph;
  readonly now: number;
  readonly plan: Plan;
  readonly player: Player;
  /** What may be asked for. */
  describe(): Description;
  /** Ask for something; returns its id. It is taken up at the next update. */
  ask(request: Ask): string;
  /** Set a parameter, a trigger without a value; returns the id of the request that this makes. What cannot be set is refused. */
  setParameter(name: string, value?: ParameterValue): string;
  /** The value that a parameter was set to, else its first one; null for a trigger, undefined for a name that is not known. */
  getParameter(name: string): ParameterValue | null | undefined;
  /** Say a line whose sound comes in while it is said, a piece with each call: samples -1..1, `rate` a second, 8000 to 48000. Returns its id. */
  saySound(id: string, samples: ArrayLike<number>, rate: number): string;
  /** Move on to `now`, seconds of the character's own time, which begins at 0. */
  update(now: number): void;
  answer(id: string): Answer;
  /** What began and ended since this was last asked for, by time; of more than 1000 the latest. */
  events(): readonly Happening[];
  /** The pose at the updated time; the arrays are overwritten by the next. `alive`: with the life layers; true when not given. */
  pose(alive?: boolean): Pose;
  /** Weights of `graph.morphs` at the updated time; likewise. */
  morphs(alive?: boolean): Float32Array;
}

export interface TalkOptions {
  /** Whose lexicon is taken, "en" if nothing is said; English where there is none. */
  language?: string;
  /** One of your own, as the files have them. */
  lexicon?: object;
  seed?: number;
  /** What ids begin with. */
  name?: string;
}

export interface Said {
  readonly id: string;
  /** Ids of its gestures. */
  readonly gestures: readonly string[];
}

/** Text, whole or piece by piece, as speech with the gestures that go with its words. */
export class Talk {
  constructor(character: Character, options?: TalkOptions);
  readonly character: Character;
  /** Say a text; options are those of the request `say`. */
  say(text: string, options?: Partial<Ask>): Said;
  /** Take in what comes next of a text: each sentence is said when it is whole. `over`: whether the text ends here. */
  take(piece: string, over?: boolean): Said[];
  /** Break off all that is said, and forget what came in; what is said next begins at once. Returns the request's id. */
  interrupt(): string;
}
