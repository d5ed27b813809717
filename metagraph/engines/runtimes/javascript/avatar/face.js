/**
 * The face of another look: its morph targets that are called as the graph's, and for the rest mouth shapes, blinks, moods and looks of the
 * life layers, by VRM's expressions or by targets named as ARKit or Oculus name them.
 */

import { SHOWN } from "../shown.js";

// Channel -> VRM's expressions with shares, of its five vowels above all; an expression of the whole face shows half.
const EXPRESSIONS = {
  viseme_FF: { ou: 0.15 }, viseme_TH: { ee: 0.25 }, viseme_DD: { ih: 0.25 }, viseme_kk: { ee: 0.3 }, viseme_CH: { ou: 0.45 }, viseme_SS: { ih: 0.35 },
  viseme_nn: { ih: 0.2 }, viseme_RR: { oh: 0.3 }, viseme_aa: { aa: 1 }, viseme_E: { ee: 1 }, viseme_I: { ih: 1 }, viseme_O: { oh: 1 }, viseme_U: { ou: 1 },
  smile: { happy: 0.5 }, frown: { sad: 0.5 }, brow_down: { angry: 0.5 },
};
const LOOKS = Object.fromEntries(["Left", "Right", "Up", "Down"].flatMap((way) => {
  return ["left", "right"].map((side) => [`look_${way.toLowerCase()}_${side}`, { [`look${way}`]: 0.5 }]);
}));
// Channel -> ARKit's targets with weights; # stands for both sides. The figures are those of metagraph/graph/face/names.py.
const ARKIT = {
  viseme_PP: { "mouthpress#": 0.45, mouthrolllower: 0.25, mouthrollupper: 0.2 }, viseme_FF: { mouthrolllower: 0.6, "mouthupperup#": 0.25, jawopen: 0.06 },
  viseme_TH: { jawopen: 0.16, "mouthlowerdown#": 0.25, tongueout: 0.35 }, viseme_DD: { jawopen: 0.12, "mouthlowerdown#": 0.3, "mouthupperup#": 0.1 },
  viseme_kk: { jawopen: 0.2, "mouthlowerdown#": 0.2 }, viseme_CH: { mouthfunnel: 0.55, jawopen: 0.1, mouthpucker: 0.15 },
  viseme_SS: { "mouthstretch#": 0.3, "mouthlowerdown#": 0.25, "mouthupperup#": 0.1, jawopen: 0.04 }, viseme_nn: { jawopen: 0.14, "mouthlowerdown#": 0.2 },
  viseme_RR: { mouthfunnel: 0.4, jawopen: 0.14 }, viseme_aa: { jawopen: 0.6, "mouthlowerdown#": 0.25, "mouthupperup#": 0.15 },
  viseme_E: { jawopen: 0.34, "mouthstretch#": 0.3, "mouthlowerdown#": 0.2 }, viseme_I: { jawopen: 0.18, "mouthstretch#": 0.4, "mouthsmile#": 0.15 },
  viseme_O: { jawopen: 0.4, mouthfunnel: 0.6 }, viseme_U: { jawopen: 0.16, mouthpucker: 0.75, mouthfunnel: 0.2 },
  smile: { "mouthsmile#": 0.9 }, frown: { "mouthfrown#": 1, mouthshruglower: 0.3 }, brow_up: { browinnerup: 1 }, brows: { browinnerup: 0.9, "browouterup#": 0.9 },
  brow_down: { "browdown#": 1, "eyesquint#": 0.35, "nosesneer#": 0.25, "mouthpress#": 0.4 }, cheeks: { "cheeksquint#": 0.7, "eyesquint#": 0.3 },
  wide_left: { eyewideleft: 1 }, wide_right: { eyewideright: 1 },
};
// What 0.x calls its expressions.
const OLDER = { a: "aa", i: "ih", u: "ou", e: "ee", o: "oh", joy: "happy", sorrow: "sad", blink_l: "blinkLeft", blink_r: "blinkRight",
  lookleft: "lookLeft", lookright: "lookRight", lookup: "lookUp", lookdown: "lookDown" };

/** Return a name without what differs from tool to tool: case, separators, what stands before a dot, "_L" for "Left". */
function simplify(name) {
  const sided = name.replace(/[_.]([LR])$/i, (_, side) => (side.toLowerCase() === "l" ? "Left" : "Right"));
  return sided.toLowerCase().split(".").at(-1).replace(/[^a-z0-9]/g, "");
}

/** Return a record's shares with both sides of what is told for both. */
const sided = (mix) => Object.entries(mix).flatMap(([name, share]) => {
  return (name.endsWith("#") ? ["left", "right"].map((side) => name.replace("#", side)) : [name]).map((one) => [one, share]);
});

export class AvatarFace {
  /** eyes, lids: whether joints move them. @param {import("../graph.js").Graph} graph */
  constructor(graph, { scene, parser }, { eyes, lids }) {
    const targets = new Map(); // simplified name -> [influences, place]
    scene.traverse((mesh) => {
      for (const [name, place] of Object.entries(mesh.morphTargetInfluences ? mesh.morphTargetDictionary ?? {} : {})) {
        const key = simplify(name);
        targets.set(key, [...(targets.get(key) ?? []), { mesh, place }]);
      }
    });
    const key = ({ mesh, place }) => `${mesh.id} ${place}`;
    const taken = new Set();
    this.named = graph.morphs.flatMap((name, from) => (targets.get(simplify(name)) ?? []).map((at) => {
      taken.add(key(at));
      return { ...at, from };
    }));
    this.missing = graph.morphs.filter((name) => !targets.has(simplify(name)));
    const expressions = parser ? expressionsOf(parser, scene) : new Map();
    const channels = SHOWN.filter((channel) => channel !== "blink" && !(eyes && channel.startsWith("look_")) && !(lids && channel.startsWith("blink")));
    /** Channels that move something: their place in SHOWN, and the targets with their shares. */
    this.worked = channels.map((channel) => {
      const by = (table, mix) => sided(mix ?? {}).flatMap(([name, share]) => (table.get(name) ?? []).map((at) => ({ ...at, share: share * (at.share ?? 1) })));
      const ways = [
        by(expressions, blinkOf(channel, expressions) ?? EXPRESSIONS[channel] ?? LOOKS[channel]),
        by(targets, { [simplify(channel)]: 1 }),
        by(targets, blinkOf(channel, targets) ?? ARKIT[channel] ?? lookOf(channel)),
      ];
      const found = ways.find((way) => way.length) ?? [];
      return { from: SHOWN.indexOf(channel), moved: found.filter((at) => !taken.has(key(at))) };
    }).filter(({ moved }) => moved.length);
    this.cleared = [...new Map(this.worked.flatMap(({ moved }) => moved.map((at) => [key(at), at]))).values()];
    /** Whether the life layers' mouth shapes are shown by other targets than the graph's. */
    this.speaks = this.worked.some(({ from }) => SHOWN[from].startsWith("viseme_"));
  }

  /** Show the face of a character as it is now. @param {import("../character.js").Character} character */
  show(character) {
    const { named, worked } = this;
    const weights = named.length ? character.morphs() : null;
    for (const { mesh, place, from } of named) mesh.morphTargetInfluences[place] = weights[from];
    if (!worked.length) return;
    const values = character.player.channels(character.now);
    for (const { mesh, place } of this.cleared) mesh.morphTargetInfluences[place] = 0;
    for (const { from, moved } of worked) {
      const value = values[from];
      if (value < 1e-4) continue;
      for (const { mesh, place, share } of moved) {
        mesh.morphTargetInfluences[place] = Math.min(1, mesh.morphTargetInfluences[place] + share * value);
      }
    }
  }
}

/** Return what shows a blink of one eye, or of both where a face cannot tell them apart. */
function blinkOf(channel, table) {
  const side = { blink_left: "left", blink_right: "right" }[channel];
  if (!side) return undefined;
  const big = side === "left" ? "Left" : "Right";
  const own = [`blink${big}`, `blink${side}`, `eyeblink${side}`].find((name) => table.has(name));
  return own ? { [own]: 1 } : { blink: 0.5 };
}

/** Return ARKit's target for an eye that looks somewhere. */
function lookOf(channel) {
  const found = /^look_(left|right|up|down)_(left|right)$/.exec(channel);
  if (!found) return undefined;
  const [, way, side] = found;
  const to = way === "up" || way === "down" ? way : way === side ? "out" : "in";
  return { [`eyelook${to}${side}`]: 1 };
}

/** Return VRM's expressions of either version -> the targets they work, with shares. */
function expressionsOf({ json, associations }, scene) {
  const out = new Map();
  const { VRM: old, VRMC_vrm: one } = json?.extensions ?? {};
  const meshes = (fits) => {
    const found = [];
    scene.traverse((object) => fits(associations.get(object) ?? {}) && object.traverse((mesh) => mesh.morphTargetInfluences && found.push(mesh)));
    return new Set(found);
  };
  const add = (name, fits, place, share) => {
    for (const mesh of meshes(fits)) if (place < mesh.morphTargetInfluences.length) out.set(name, [...(out.get(name) ?? []), { mesh, place, share }]);
  };
  for (const [name, { morphTargetBinds = [] }] of Object.entries(one?.expressions?.preset ?? {})) {
    for (const { node, index, weight = 1 } of morphTargetBinds) add(name, ({ nodes }) => nodes === node, index, weight);
  }
  for (const { presetName = "", binds = [] } of one ? [] : old?.blendShapeMaster?.blendShapeGroups ?? []) {
    const name = OLDER[presetName.toLowerCase()] ?? presetName.toLowerCase();
    for (const { mesh, index, weight = 100 } of binds) add(name, ({ meshes: at }) => at === mesh, index, weight / 100);
  }
  return out;
}
