/** Another look: a humanoid that three.js loaded, a VRM or any GLB with a known skeleton, moved by a graph. Nothing of three.js is imported. */

import { AvatarFace } from "./avatar/face.js";
import { AvatarError, Figure } from "./avatar/figure.js";
import { Retarget, figureOf } from "./avatar/retarget.js";
import { findRoles, readHumanoid } from "./avatar/roles.js";
import { back, minus, plus, rotated, scaled, times } from "./plain_vectors.js";

export { AvatarError };

const LOW = 0.15, HIGH = 3; // metres: the legs of what is not measured in centimetres

/** A humanoid as a graph's look. One moves one scene. */
export class Avatar {
  /**
   * @param {import("./graph.js").Graph} graph
   * @param {{scene: object, parser?: object}} gltf what GLTFLoader made of the file, posed as it came; `scene` is turned to face as the
   *   graph's character does, and scaled to metres
   * @throws {AvatarError} where there is no skeleton or no humanoid: why
   */
  constructor(graph, gltf) {
    const { scene } = gltf;
    this.scene = scene;
    const nodes = skeletonOf(scene);
    if (!nodes.some((one) => one.isBone)) throw new AvatarError("The avatar cannot be used: it has no skeleton");
    const parents = nodes.map((one) => nodes.indexOf(one.parent));
    const names = nodes.map((one) => one.userData.name ?? one.name);
    const roles = humanoid(gltf, nodes) ?? findRoles(names, parents);
    const rest = restOf(nodes, parents);
    const source = figureOf(graph);
    let figure;
    try {
      figure = new Figure(roles, rest.turns, rest.places, "it");
      const unit = unitOf(figure, source);
      figure = new Figure(roles, rest.turns, rest.places.map((place) => scaled(place, unit)), "it");
      this.unit = unit;
    } catch (error) {
      throw error instanceof AvatarError ? new AvatarError(`The avatar cannot be used: ${error.message}`) : error;
    }
    /** The head's object, to look at. */
    this.head = nodes[roles.get("head")];
    this.face = new AvatarFace(graph, gltf, { eyes: roles.has("left_eye"), lids: names.some((name) => graph.joints.includes(name) && /lid/i.test(name)) });
    if (this.face.speaks) roles.delete("jaw"); // else the mouth would open twice
    this.retarget = new Retarget(graph, source, figure, { parents, names });
    /** Joints and morph targets of the graph that move nothing here. @type {string[]} */
    this.missing = [...this.retarget.missing, ...this.face.missing];
    this.nodes = nodes;
    this.scales = rest.scales;
    const turn = times(back(source.turn), figure.turn);
    scene.quaternion.set(...turn);
    scene.scale.setScalar(this.unit);
    const { apart, shifted } = this.retarget;
    this.placed = [...new Set([roles.get("hips"), ...apart, ...shifted.map(([joint]) => joint)])];
    this.moved = nodes.map((_, j) => j).filter((j) => this.retarget.given.has(j) || apart.includes(j));
  }

  /** Pose the scene as a character is posed now. @param {import("./character.js").Character} character */
  pose(character) {
    const { nodes, retarget, unit, scales } = this;
    const { rotations, translations } = character.pose();
    retarget.bring(rotations, translations);
    const { own, turns, places } = retarget;
    const level = back(retarget.target.turn); // the file's own axes
    for (const j of this.moved) nodes[j].quaternion.set(...times(back(own[j] < 0 ? retarget.target.turn : turns[own[j]]), turns[j]));
    for (const j of this.placed) {
      const over = own[j];
      const away = over < 0 ? rotated(level, places[j]) : rotated(back(turns[over]), minus(places[j], places[over]));
      nodes[j].position.set(...scaled(away, 1 / (unit * (over < 0 ? 1 : scales[over]))));
    }
    this.face.show(character);
  }
}

/** Return the bones of a scene and what is above them, parents before children. */
function skeletonOf(scene) {
  const wanted = new Set();
  scene.traverse((object) => {
    if (object.isBone) for (let one = object; one !== scene && !wanted.has(one); one = one.parent) wanted.add(one);
  });
  const out = [];
  scene.traverse((object) => wanted.has(object) && out.push(object));
  return out;
}

/** Return role -> place among nodes as the file's VRM says; null where it is none, or its bones are not there. */
function humanoid({ parser }, nodes) {
  const told = readHumanoid(parser?.json);
  if (!told) return null;
  const places = new Map(nodes.map((one, place) => [parser.associations.get(one)?.nodes, place]));
  return new Map([...told].filter(([, node]) => places.has(node)).map(([role, node]) => [role, places.get(node)]));
}

/** Return turns, places and scales of nodes in the scene's space, in the file's own unit. */
function restOf(nodes, parents) {
  const turns = [], places = [], scales = [];
  nodes.forEach((one, j) => {
    const over = parents[j];
    const turn = one.quaternion.toArray(), place = one.position.toArray();
    const size = Math.cbrt(Math.abs(one.scale.x * one.scale.y * one.scale.z)) || 1;
    turns.push(over < 0 ? turn : times(turns[over], turn));
    places.push(over < 0 ? place : plus(places[over], rotated(turns[over], scaled(place, scales[over]))));
    scales.push(over < 0 ? size : size * scales[over]);
  });
  return { turns, places, scales };
}

/** Return metres a unit: 1, of centimetres 0.01, else what makes the avatar as tall as the character. */
function unitOf(figure, source) {
  for (const unit of [1, 0.01]) if (figure.legLength * unit > LOW && figure.legLength * unit < HIGH) return unit;
  return source.legLength / figure.legLength;
}
