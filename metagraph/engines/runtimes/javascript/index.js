/** Metagraph's runtime: loads an export, plans what is asked, and poses characters. No dependencies; Node and browsers. */

export { key32 } from "./choice.js";
export { Character } from "./character.js";
export { describe } from "./describe.js";
export { FORMAT, Graph, MetagraphError } from "./graph.js";
export { load } from "./load.js";
export { answers, hear, since } from "./hear.js";
export { emptyPlan, keyOf } from "./plan.js";
export { Player, morphsAt, poseAt } from "./pose.js";
export { MeshoptDecoder } from "./meshopt.js";
export { StreamedVoice } from "./streamed_voice.js";
export { Talk } from "./talk.js";
export { LAYERS } from "./words.js";
