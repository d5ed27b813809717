/** What of a body breathes and looks, as the export's `rig` has it, laid out for reading every frame. */

import { CHANNELS } from "../words.js";

/**
 * Directions `left`, `up`, `ahead` are the character's; metres, radians.
 *
 * chain: joints from the root to the head. breath [c, 4]: axis and angle of each at the top of a breath. joints: all that life may turn:
 * the chain, then shoulders, eyes that are joints, the face's; `turned` of them before the face's. lookers: `place` in the chain, and
 * `share` of a turn of the head. eyes: left, right. bowed, thrust [c]: radians of a bowed posture, and of one that
 * leans into it, about the breath's axes. face: see `readFace`.
 * @param {object} rig
 */
export function readBody(rig) {
  const eyes = rig.eyes.map((eye) => ({
    ...eye, turnLeft: eye.turn_left, turnUp: eye.turn_up, isJoint: eye.joint >= 0,
  }));
  const eyeJoints = eyes.filter((eye) => eye.isJoint).map((eye) => eye.joint);
  const face = readFace(rig.face);
  const turned = [...rig.chain, ...rig.shoulders.map((s) => s.joint), ...eyeJoints];
  return {
    left: rig.left, up: rig.up, ahead: rig.ahead,
    chain: rig.chain, breath: Float64Array.from(rig.breath.flat()),
    bowed: Float64Array.from(rig.chain, (_, n) => rig.bowed?.[n] ?? 0), thrust: Float64Array.from(rig.chain, (_, n) => rig.thrust?.[n] ?? 0),
    shoulders: rig.shoulders.map((s) => ({ ...s, tense: s.tense ?? [0, 0, 0], closed: s.closed ?? [0, 0, 0] })), lookers: rig.lookers,
    trunk: rig.trunk, trunkAhead: rig.trunk_ahead, headAhead: rig.head_ahead, eyes,
    partner: rig.partner, eyesAtRest: rig.eyes_at_rest, face, turned: turned.length, joints: Int32Array.from([...turned, ...face.joints]),
  };
}

/**
 * joints [F]: those that shapes move. turns, shifts [C, F, 3]: rotation vectors in the joints' own space and metres in the parents',
 * both at 1, in the order of CHANNELS. follows [4]: how much each lid shuts for an eye that looks down by a radian. lids: its joint, -1 for
 * none. shutBy [4][4]: what a lid's own rotation says about how far it is shut already. morphs: channel, name of the target, its
 * weight at 1.
 */
function readFace(face) {
  return {
    joints: face.joints,
    turns: Float64Array.from(face.turns.flat(2)),
    shifts: Float64Array.from(face.shifts.flat(2)),
    moves: CHANNELS.map((_, n) => [face.turns[n], face.shifts[n]].some((rows) => (rows ?? []).flat().some((x) => x !== 0))),
    follows: face.follows,
    lids: face.lid_joints,
    shutBy: face.shut_by,
    morphs: Object.entries(face.morphs).flatMap(([channel, targets]) =>
      Object.entries(targets).map(([name, weight]) => ({ channel, name, weight })),
    ),
  };
}
