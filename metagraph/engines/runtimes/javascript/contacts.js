/** Hands that stay where they touch, and out of the body: what contacts and the guard make of a composed pose. */

import { layerGoals } from "./contact_goals.js";
import { BodyCapsule, ContactArm, ContactPose, ContactRig, solveContacts, spread } from "./contact_solve.js";
import { ContactKey, ContactSpan } from "./contact_spans.js";

/** Return an action's contacts from the export. @param {?object[]} data @returns {ContactSpan[]} */
export function readContacts(data) {
  return (data ?? []).map((c) => {
    const keys = c.keys.map((k) => new ContactKey(k[0], k.slice(1, 4), k.slice(4, 8)));
    return new ContactSpan(c.hand, c.place, c.to, c.start, c.end, keys, c.ease_in, c.ease_out);
  });
}

/** Return an export's contact rig; null where it has none. @param {?object} data @param {string[]} joints names */
export function readContactRig(data, joints) {
  if (!data) return null;
  const { parents } = data;
  const inside = (place, count, what) => {
    if (!Number.isInteger(place) || place < 0 || place >= count) throw new Error(`contact_rig: there is no ${what} ${place}`);
    return place;
  };
  for (const joint of data.joints) inside(joint, joints.length, "joint");
  if (parents.length !== data.joints.length || parents.some((p, n) => p >= n)) throw new Error("contact_rig: parents do not fit the joints");
  const count = data.joints.length;
  const arms = data.arms.map(([upper, lower, hand]) => {
    const below = [inside(upper, count, "place")];
    for (let n = upper + 1; n < count; n++) if (below.includes(parents[n])) below.push(n);
    return new ContactArm(upper, inside(lower, count, "place"), inside(hand, count, "place"), below);
  });
  const capsules = data.capsules.map(
    (c) => new BodyCapsule(inside(c.joint, count, "place"), c.a, inside(c.to, count, "place"), c.b, c.radius, c.arm, c.kind),
  );
  const places = new Map(data.joints.map((joint, n) => [joints[joint], n]));
  const hands = arms.map((arm) => joints[data.joints[arm.hand]]);
  return new ContactRig(data.joints, parents, places, arms, hands, capsules, data.contacts, data.guard);
}

/**
 * Change a pose in place so that hands are where contacts want them, and out of the body.
 * @param {import("./graph.js").Graph} graph @param {[layer, cue, place][]} playing what of each layer plays: its plan, the cue (or
 * null), the place of the rest in force (-1 for none) @param {Float64Array} rotations [J, 4] @param {Float64Array} translations [J, 3]
 */
export function touch(graph, playing, time, rotations, translations) {
  const rig = graph.contactRig;
  const goals = [];
  if (rig.contacts) {
    for (const [name, layer, cue, place] of playing) {
      const { strength } = graph.layers[name];
      if (strength > 0) goals.push(...layerGoals(rig, graph, layer, cue, place, time, strength));
    }
  }
  if (!goals.length && !rig.guard) return;
  const pose = new ContactPose(
    rig.joints.map((j) => [rotations[4 * j], rotations[4 * j + 1], rotations[4 * j + 2], rotations[4 * j + 3]]),
    rig.joints.map((j) => [translations[3 * j], translations[3 * j + 1], translations[3 * j + 2]]),
  );
  spread(rig, pose);
  if (!solveContacts(rig, pose, goals)) return;
  for (const arm of rig.arms) {
    for (const place of [arm.upper, arm.lower, arm.hand]) rotations.set(pose.local[place], 4 * rig.joints[place]);
  }
}
