/** Hips, spine and legs that answer the arms, and feet that stay planted: what an export says of them, and what comes of it at a time. */

import { ContactArm, ContactPose, ContactRig } from "./contact_solve.js";
import { plantFeet } from "./feet_solve.js";
import { ArmTrack, KNOTS, armSway, driven, knotBefore, knotTime } from "./follow_through.js";
import { FootTrack, footGoals } from "./planted_feet.js";
import { WeightBend, WeightCollar, WeightRig, answerArms, movesBody } from "./weight_solve.js";

const KEPT = 4096; // times that are remembered of a plan

/** Return an export's weight rig; null where it has none. @param {?object} data @param {number} joints how many there are */
export function readWeightRig(data, joints) {
  if (!data) return null;
  const { parents } = data;
  const inside = (place, count, what) => {
    if (!Number.isInteger(place) || place < 0 || place >= count) throw new Error(`weight_rig: there is no ${what} ${place}`);
    return place;
  };
  const count = data.joints.length;
  for (const joint of data.joints) inside(joint, joints, "joint");
  if (parents.length !== count || parents.some((p, n) => p >= n)) throw new Error("weight_rig: parents do not fit the joints");
  const legs = data.legs.map(([upper, lower, foot]) => {
    const below = [inside(upper, count, "place")];
    for (let n = upper + 1; n < count; n++) if (below.includes(parents[n])) below.push(n);
    return new ContactArm(upper, inside(lower, count, "place"), inside(foot, count, "place"), below);
  });
  const body = new ContactRig(data.joints, parents, new Map(), legs, data.hands, [], false, false);
  const bends = data.bends.map((b) => new WeightBend(inside(b.place, count, "place"), b.left, b.up, b.ahead, b.share));
  const collars = data.collars.map(
    (c) => new WeightCollar(inside(c.place, count, "place"), inside(c.upper, count, "place"), c.axis, c.side),
  );
  return new WeightRig(body, bends, collars, data.knees, data.levers, data.up, data.height, data.strength);
}

/** Return what the actions of arms and body weigh, by action. @param {object[]} clips the export's */
export function readArmTracks(layers, clips) {
  const rows = new Map(clips.map((clip) => [clip.id, clip.arms ?? []]));
  const actions = ["arms", "body"].flatMap((layer) => [...layers[layer].actions.values()]);
  return new Map(actions.map(({ id, clip }) => [id, new ArmTrack(clip, rows.get(clip) ?? [])]));
}

/** Return where the feet of a layer's actions are, by action. @param {object} layer it moves the legs @param {object[]} clips the export's */
export function readFootTracks(layer, clips) {
  const rows = new Map(clips.map((clip) => [clip.id, clip.feet ?? []]));
  return new Map([...layer.actions.values()].map(({ id, clip }) => [id, new FootTrack(rows.get(clip) ?? [])]));
}

/** What the arms of a plan do at the times that are looked at, worked out once each. */
export class Swaying {
  constructor(graph) {
    this.graph = graph;
    this.found = new Map();
  }

  /** Forget what was found of another plan. */
  clear() {
    this.found.clear();
  }

  /**
   * Change a pose in place as its feet stay planted, and the body answers its arms, at a time.
   * @param {(time: number, layer: string) => [cue, place]} playing the cue with motion that plays in a layer, or null, and the place
   * of the rest in force, -1 for none
   */
  answer(plan, playing, time, rotations, translations) {
    const { weightRig: rig, footTracks, feetLayer, life } = this.graph;
    const calm = 1 - life.stillness;
    const drive = this.drive(plan, playing, time);
    const standing = () => footGoals(this.graph, footTracks, rig.height, plan.layers[feetLayer], ...playing(time, feetLayer), time);
    const feet = life.plantedFeet > 0 ? standing() : [];
    if (!feet.length && !movesBody(drive)) return;
    const { joints } = rig.body;
    const pose = new ContactPose(
      joints.map((j) => [rotations[4 * j], rotations[4 * j + 1], rotations[4 * j + 2], rotations[4 * j + 3]]),
      joints.map((j) => [translations[3 * j], translations[3 * j + 1], translations[3 * j + 2]]),
    );
    let moved = plantFeet(rig, pose, feet, life.plantedFeet);
    if (drive.length && answerArms(rig, pose, drive, life.followThrough * calm, life.shoulderLift * calm)) moved = true;
    if (!moved) return;
    for (let place = 0; place < joints.length; place++) rotations.set(pose.local[place], 4 * joints[place]);
    const hips = rig.bends[0].place;
    translations.set(pose.moved[hips], 3 * joints[hips]);
  }

  /** Return what of the arms moves the body at a time, nothing where it does not answer them. */
  drive(plan, playing, time) {
    const { weightRig: rig, life } = this.graph;
    if (life.stillness >= 1 || (life.followThrough <= 0 && life.shoulderLift <= 0)) return [];
    if (rig.strength <= 0 || !plan.layers.arms.cues.length) return [];
    const last = knotBefore(time);
    const sways = [];
    for (let n = last - KNOTS + 1; n <= last; n++) sways.push(this.at(plan, playing, n));
    return driven(sways, time);
  }

  at(plan, playing, number) {
    let out = this.found.get(number);
    if (out) return out;
    const time = knotTime(number);
    const { graph } = this;
    const { arms, body } = plan.layers;
    const [[cue, place], [bodyCue, bodyPlace]] = [playing(time, "arms"), playing(time, "body")];
    const { hands } = graph.weightRig.body;
    out = armSway(graph, graph.armTracks, hands, arms, cue, place, body, bodyCue, bodyPlace, time);
    if (this.found.size >= KEPT) this.clear();
    this.found.set(number, out);
    return out;
  }
}
