/**
 * Contacts of an action: where on the body a hand stays, or moves along it, for a part of its clip.
 *
 * A contact gives the position of the wrist and the rotation of the hand in the space of a joint. So it holds whatever else
 * moves that joint: a breathing spine, a layer below, a body of another shape.
 *
 * Translated from metagraph/motion/contact_spans.py; change that, and translate anew.
 */


export const HANDS = ["left", "right"];
export const PLACES = ["palm", "fingertips", "back", "wrist"];
export const EASE = 0.15; // seconds in which a hand comes to a contact, and leaves it, by default
export const SETTLES = 0.3; // seconds it takes at least where the contact lasts: what it touches may be far from its place

/**
 * Where a hand is on a joint at a moment. time: clip seconds. at: the wrist in the joint's own space, metres. turn: how the
 * hand is turned there, xyzw.
 *
 * time: number; at: [number, number, number]; turn: [number, number, number, number].
 */
export class ContactKey {
  constructor(time, at, turn) {
    this.time = time;
    this.at = at;
    this.turn = turn;
  }
}

/**
 * A hand that stays at a place on the body.
 *
 * hand: left or right. place: the part of the hand that touches: palm, fingertips, back, wrist. to: the name of the joint it
 * stays with. start, end: clip seconds. keys: one for a hand that stays, more, in order, for one that moves over the body.
 * ease_in, ease_out: seconds inside the span in which the contact sets in and fades out; they do not apply if the action
 * begins, or ends, within the span.
 *
 * hand: string; place: string; to: string; start: number; end: number; keys: ContactKey[]; easeIn: number; easeOut: number.
 */
export class ContactSpan {
  constructor(hand, place, to, start, end, keys, easeIn = EASE, easeOut = EASE) {
    this.hand = hand;
    this.place = place;
    this.to = to;
    this.start = start;
    this.end = end;
    this.keys = keys;
    this.easeIn = easeIn;
    this.easeOut = easeOut;
  }
}

/**
 * Return how much a hand is held at a second of the clip, 0..1. first, last: the seconds of the clip that play.
 * @param {ContactSpan} span
 * @param {number} seconds
 * @param {number} first
 * @param {number} last
 * @returns {number}
 */
export function contactWeight(span, seconds, first, last) {
  if (seconds < span.start || seconds > span.end) {
    return 0;
  }
  let shown = 1;
  const comes = span.start > first && span.easeIn > 0;
  const goes = span.end < last && span.easeOut > 0;
  const least = Math.min(SETTLES, (span.end - span.start) / ((comes && goes) ? 2 : 1));
  if (comes) {
    shown = Math.min(shown, (seconds - span.start) / Math.max(span.easeIn, least));
  }
  if (goes) {
    shown = Math.min(shown, (span.end - seconds) / Math.max(span.easeOut, least));
  }
  return shown * shown * (3 - 2 * shown);
}

/**
 * Return where a hand is at a second of the clip, interpolated linearly between two keys.
 * @param {ContactSpan} span
 * @param {number} seconds
 * @returns {ContactKey}
 */
export function contactKey(span, seconds) {
  let before = span.keys[0];
  for (const after of span.keys) {
    if (after.time >= seconds) {
      if (after.time <= before.time) {
        return after;
      }
      const part = (seconds - before.time) / (after.time - before.time);
      const { 0: ax, 1: ay, 2: az } = before.at;
      const { 0: bx, 1: by, 2: bz } = after.at;
      const at = [ax + (bx - ax) * part, ay + (by - ay) * part, az + (bz - az) * part];
      const { 0: px, 1: py, 2: pz, 3: pw } = before.turn;
      const { 0: qx, 1: qy, 2: qz, 3: qw } = after.turn;
      const other = px * qx + py * qy + pz * qz + pw * qw < 0 ? -part : part;
      const own = 1 - part;
      const x = px * own + qx * other;
      const y = py * own + qy * other;
      const z = pz * own + qz * other;
      const w = pw * own + qw * other;
      const size = 1 / Math.max(Math.sqrt(x * x + y * y + z * z + w * w), 1e-12);
      return new ContactKey(seconds, at, [x * size, y * size, z * size, w * size]);
    }
    before = after;
  }
  return before;
}
