/** Metagraph in three.js: a character that moves the bones and morph targets of a loaded scene. Nothing of three.js is imported. */

import { Character } from "./character.js";

export class MetagraphObject {
  /**
   * @param {import("./graph.js").Graph} graph @param {import("three").Object3D} scene what GLTFLoader made of the export's GLB (or of any
   *   character with joints of the same names); for several characters a clone each, by SkeletonUtils.clone
   * @param {object} [options] as for a Character; `avatar`: an Avatar (avatar.js) that is moved instead, the scene is hidden
   */
  constructor(graph, scene, { avatar = null, ...options } = {}) {
    this.character = new Character(graph, options);
    this.scene = scene;
    const missing = []; // of the scene
    const { bones, faces } = find(scene);
    this.joints = [];
    graph.joints.forEach((name, joint) => {
      const bone = bones.get(name) ?? bones.get(sanitized(name));
      if (bone) this.joints.push({ bone, joint });
      else missing.push(name);
    });
    this.targets = graph.morphs.flatMap((name, place) => {
      const found = faces.filter((mesh) => name in mesh.morphTargetDictionary);
      if (!found.length) missing.push(name);
      return found.map((mesh) => ({ influences: mesh.morphTargetInfluences, target: mesh.morphTargetDictionary[name], place }));
    });
    this.lacking = missing;
    this.time = 0;
    this.worn = null;
    this.avatar = avatar;
  }

  /** The look that is moved instead of the scene, null for the scene. The motion goes on where it is. */
  get avatar() {
    return this.worn;
  }

  /** @param {import("./avatar.js").Avatar | null} avatar */
  set avatar(avatar) {
    if (this.worn) this.worn.scene.visible = false;
    if (avatar || this.worn) this.scene.visible = !avatar;
    this.worn = avatar;
    if (!avatar) return;
    avatar.scene.visible = true;
    avatar.pose(this.character);
  }

  /** Joints and morph targets that the scene lacks, or that move nothing of the avatar; the others move all the same. */
  get missing() {
    return this.worn?.missing ?? this.lacking;
  }

  /** As of a Character: the request's id. @param {object} request */
  ask(request) {
    return this.character.ask(request);
  }

  /** Set a parameter, and return one's value, as of a Character. @param {string} name */
  setParameter(name, value) {
    return this.character.setParameter(name, value);
  }

  getParameter(name) {
    return this.character.getParameter(name);
  }

  /** As of a Character. @param {string} id @param {ArrayLike<number>} samples @param {number} rate */
  saySound(id, samples, rate) {
    return this.character.saySound(id, samples, rate);
  }

  answer(id) {
    return this.character.answer(id);
  }

  events() {
    return this.character.events();
  }

  /** Move on by `delta` seconds and pose the scene. Call it once a frame, before rendering. @param {number} delta */
  update(delta) {
    const { character, joints, targets } = this;
    if (delta > 0) this.time += delta;
    character.update(this.time);
    if (this.worn) return this.worn.pose(character);
    const { rotations, translations } = character.pose();
    for (let n = 0; n < joints.length; n++) {
      const { bone, joint } = joints[n];
      const turn = bone.quaternion;
      const x = rotations[4 * joint], y = rotations[4 * joint + 1], z = rotations[4 * joint + 2], w = rotations[4 * joint + 3];
      // Setting one makes three.js work out Euler angles; many joints stand still.
      if (turn.x !== x || turn.y !== y || turn.z !== z || turn.w !== w) turn.set(x, y, z, w);
      bone.position.set(translations[3 * joint], translations[3 * joint + 1], translations[3 * joint + 2]);
    }
    if (!targets.length) return;
    const weights = character.morphs();
    for (let n = 0; n < targets.length; n++) targets[n].influences[targets[n].target] = weights[targets[n].place];
  }
}

/** Names as three.js's PropertyBinding wants them: no blanks, no characters that mean something in a track's name. */
const sanitized = (name) => name.replace(/\s/g, "_").replace(/[[\].:/]/g, "");

/** Return the scene's objects by the names they had in their file, which GLTFLoader changes, and by those they have; and its faces. */
function find(scene) {
  const bones = new Map();
  const faces = [];
  scene.traverse((object) => {
    if (!bones.has(object.name)) bones.set(object.name, object);
    if (object.morphTargetDictionary && object.morphTargetInfluences) faces.push(object);
  });
  scene.traverse((object) => {
    if (typeof object.userData.name === "string") bones.set(object.userData.name, object);
  });
  return { bones, faces };
}
