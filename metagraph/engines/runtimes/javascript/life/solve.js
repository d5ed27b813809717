/** One pose brought to life: how head, eyes and lids turn. Rotations are quaternions xyzw, angles radians; nothing is allocated. */

import { ease, multiply, rotate } from "../rotation.js";

const RADIANS = Math.PI / 180;
const SMALL = 15 * RADIANS; // of a turn smaller than this the head takes next to nothing
const TILT_SHARE = 0.8; // of up and down the head does less
const EYE_EASE = 20 * RADIANS; // the head takes all that is beyond what eyes do with ease
const TURNED_AWAY = 28 * RADIANS; // a body and head that both face farther away than this are turned back
const [HEAD_SIDEWAYS, HEAD_UP, HEAD_DOWN] = [65 * RADIANS, 30 * RADIANS, 35 * RADIANS];
const [EYE_SIDEWAYS, EYE_UP, EYE_DOWN] = [32 * RADIANS, 26 * RADIANS, 30 * RADIANS]; // eyes never turn beyond these,
const FREE = 0.7; // and freely within this part of them
const [LOOK_SIDEWAYS, LOOK_UPRIGHT] = [110 * RADIANS, 65 * RADIANS]; // beyond these nobody looks, however far behind the target is
// What is behind is looked at ever less, so that nothing turns from one side to the other in a moment.
const [LOOK_BEHIND, TURN_BEHIND, EYES_BEHIND] = [120 * RADIANS, 85 * RADIANS, 100 * RADIANS];
const TURNED_BACK = 95 * RADIANS; // the farthest that a body counts as turned away
const NEAREST = 0.25; // metres; nearer things are looked at as if they were there
const WIDEST = -0.8; // how far lids open beyond rest, of their shutting turn

const within = (x, limit) => Math.min(Math.max(x, -limit), limit);
const excess = (x, free) => Math.sign(x) * Math.max(Math.abs(x) - free, 0);
/** An angle kept within a limit, and ever less of it from `behind` to half a turn. */
const turning = (angle, most, behind) => within(angle, most) * (1 - ease((Math.abs(angle) - behind) / (Math.PI - behind)));
const dot = (a, v) => a[0] * v[0] + a[1] * v[1] + a[2] * v[2];

// Room for working in; a pose is solved whole before the next.
const away = new Float64Array(3);
const eye = new Float64Array(3);
const movedTo = new Float64Array(3);
const vector = new Float64Array(3); // the head's turn: a rotation vector in the character's space
const inside = new Float64Array(3);
const about = new Float64Array(4);

/** Return the head's part of a turn: `share` of a wide one, next to none of a small one. */
function headPart(angle, share) {
  const size = Math.abs(angle);
  return (share * angle * size) / (size + SMALL);
}

/** Return how far a lid is shut: 0 open as at rest, 1 shut. down: the eye's pitch. already: how far a clip has shut it. */
export function lid(down, follow, already, blink) {
  const shut = Math.min(Math.max(already + follow * down, WIDEST), 1);
  return shut + blink * (1 - shut); // a blink shuts what is left, so that lids meet and go no farther
}

/** Return what the rotation q[i..], near rest, has in common with a row of an eye's `down` or of `shutBy`. */
export function partAlong(q, i, row) {
  const along = q[i] * row[0] + q[i + 1] * row[1] + q[i + 2] * row[2] + q[i + 3] * row[3];
  return q[i + 3] >= 0 ? along : -along;
}

/** Works out turns for one body; `look` leaves them in it. */
export class Solver {
  /** @param {object} body */
  constructor(body) {
    const count = body.chain.length;
    this.body = body;
    this.chain = new Float64Array(4 * count); // the chain's rotations in their parents' space, given
    this.places = new Float64Array(3 * count); // and translations
    this.turned = new Float64Array(4 * count); // rotations and positions in the character's space
    this.at = new Float64Array(3 * count);
    this.turns = new Float64Array(3 * body.lookers.length); // rotation vectors of the lookers, in their own space
    this.eyes = new Float64Array(4); // left eye's turn to the left and up, then the right's
  }

  /** Set `turns` and `eyes` for a gaze. amount: of all looking; calm: of what nobody asked for; share: the head's of a turn. */
  look(gaze, amount, calm, share) {
    const { body, turned, at, turns } = this;
    const { left, up, ahead, lookers } = body;
    this.globals();
    const top = body.chain.length - 1;
    const [a, b] = [body.eyes[0].at, body.eyes[1].at];
    rotate(eye, 0, turned, 4 * top, (a[0] + b[0]) / 2, (a[1] + b[1]) / 2, (a[2] + b[2]) / 2);
    for (let k = 0; k < 3; k++) eye[k] += at[3 * top + k];
    // Where the targets are, seen from there; the eyes' and the head's share of each.
    let eyesX = gaze.eyes[0], eyesY = gaze.eyes[1], headX = gaze.head[0], headY = gaze.head[1], near = 0, whole = 0;
    for (let n = 0; n < gaze.count; n++) {
      const aim = gaze.aims[n];
      for (let k = 0; k < 3; k++) away[k] = aim.at[k] - eye[k];
      const x = dot(left, away), y = dot(up, away), z = dot(ahead, away);
      const level = Math.sqrt(x * x + z * z);
      const sideways = turning(Math.atan2(x, z), LOOK_SIDEWAYS, LOOK_BEHIND);
      const upwards = within(Math.atan2(y, level), LOOK_UPRIGHT);
      const weight = aim.amount * amount * (aim.asked ? 1 : calm);
      eyesX += gaze.came[n] * sideways;
      eyesY += gaze.came[n] * upwards;
      near += gaze.came[n] / Math.max(Math.sqrt(level * level + y * y), NEAREST);
      headX += gaze.moved[n] * weight * sideways;
      headY += gaze.moved[n] * weight * upwards;
      whole += gaze.came[n] * weight;
    }
    const size = this.head(headX, headY, whole, share);
    for (let n = 0; n < lookers.length; n++) {
      rotate(turns, 3 * n, turned, 4 * lookers[n].place, vector[0], vector[1], vector[2], true);
      for (let k = 0; k < 3; k++) turns[3 * n + k] *= lookers[n].share;
    }
    // Where that brings the eyes: every joint that turns carries what is above it along.
    for (let k = 0; k < 3; k++) movedTo[k] = at[3 * lookers[0].place + k];
    let soFar = 0;
    for (let n = 0; n < lookers.length; n++) {
      soFar += lookers[n].share;
      const from = 3 * lookers[n].place;
      const to = 3 * (n + 1 < lookers.length ? lookers[n + 1].place : top);
      this.turnAbout(size, soFar);
      rotate(away, 0, about, 0, at[to] - at[from], at[to + 1] - at[from + 1], at[to + 2] - at[from + 2]);
      for (let k = 0; k < 3; k++) movedTo[k] += away[k];
    }
    this.turnAbout(size, 1);
    multiply(about, 0, about, 0, turned, 4 * top);
    // The point looked at, in the head's space; each eye turns to it the shortest way, so that it does not roll.
    const far = 1 / Math.max(near, 1e-3);
    const x = Math.sin(eyesX) * Math.cos(eyesY) * far, y = Math.sin(eyesY) * far, z = Math.cos(eyesX) * Math.cos(eyesY) * far;
    for (let k = 0; k < 3; k++) away[k] = eye[k] + left[k] * x + up[k] * y + ahead[k] * z - movedTo[k];
    rotate(inside, 0, about, 0, away[0], away[1], away[2], true);
    for (let n = 0; n < 2; n++) this.aim(n, gaze, whole);
  }

  /** Set the turn of one eye to the point `inside` the head's space. */
  aim(n, gaze, whole) {
    const side = this.body.eyes[n];
    for (let k = 0; k < 3; k++) away[k] = inside[k] - side.at[k];
    const x = dot(side.left, away), y = dot(side.up, away);
    const across = Math.sqrt(x * x + y * y);
    const way = turning(Math.atan2(across, dot(side.ahead, away)), Math.PI, EYES_BEHIND);
    const angle = (way / Math.max(across, 1e-12)) * whole;
    const left = x * angle + gaze.eyes[0] * (1 - whole);
    const up = y * angle + gaze.eyes[1] * (1 - whole);
    // Within what eyes can do, softly near the limit.
    const a = left / EYE_SIDEWAYS, b = up / (up > 0 ? EYE_UP : EYE_DOWN);
    const far = Math.sqrt(a * a + b * b);
    const k = far <= FREE ? 1 : (FREE + (1 - FREE) * Math.tanh((far - FREE) / (1 - FREE))) / far;
    this.eyes[2 * n] = left * k;
    this.eyes[2 * n + 1] = up * k;
  }

  /** Leave in `vector` the head's turn towards a target `left` and `up` of ahead; return its size. */
  head(left, up, amount, share) {
    const { body, turned } = this;
    const beyond = Math.min(1, 2 * share);
    let x = headPart(left, share);
    let y = TILT_SHARE * headPart(up, share);
    x += beyond * excess(left - x, EYE_EASE);
    y += beyond * excess(up - y, EYE_EASE);
    // A character that has turned away as a whole turns its head back; one whose head alone or body alone has, means it.
    const trunk = this.gap(turned, body.trunk, body.trunkAhead, left);
    const face = this.gap(turned, body.chain.length - 1, body.headAhead, left);
    const both = Math.max(Math.min(trunk, face), 0) + Math.min(Math.max(trunk, face), 0);
    x += beyond * amount * excess(both, Math.max(TURNED_AWAY, Math.abs(left)));
    x = within(x, HEAD_SIDEWAYS);
    y = Math.min(Math.max(y, -HEAD_DOWN), HEAD_UP);
    // First up, then round: the head does not tilt to a shoulder.
    const cx = Math.cos(0.5 * x), sx = Math.sin(0.5 * x), cy = Math.cos(0.5 * y), sy = -Math.sin(0.5 * y);
    const a = cx * sy, b = sx * cy, c = -sx * sy;
    const length = Math.sqrt(a * a + b * b + c * c);
    const size = 2 * Math.atan2(length, cx * cy);
    const k = length > 1e-12 ? size / length : 0;
    for (let n = 0; n < 3; n++) vector[n] = k * (a * body.left[n] + b * body.up[n] + c * body.ahead[n]);
    return size;
  }

  /** Return the angle from where a joint of the chain faces to `left`; less of it where that is behind, or where it faces up or down. */
  gap(turned, place, facing, left) {
    rotate(away, 0, turned, 4 * place, facing[0], facing[1], facing[2]);
    const x = dot(this.body.left, away), z = dot(this.body.ahead, away);
    const gap = left - Math.atan2(x, z);
    const short = gap > Math.PI ? gap - 2 * Math.PI : gap < -Math.PI ? gap + 2 * Math.PI : gap;
    return turning(short, TURNED_BACK, TURN_BEHIND) * ease(2 * Math.sqrt(x * x + z * z));
  }

  /** Leave in `about` the turn by `part` of `vector`, which is `size` long. */
  turnAbout(size, part) {
    const s = size > 1e-12 ? Math.sin(0.5 * size * part) / size : 0;
    for (let k = 0; k < 3; k++) about[k] = vector[k] * s;
    about[3] = Math.cos(0.5 * size * part);
  }

  /** Rotations and positions of the chain in the character's space, from those in the parents'. */
  globals() {
    const { chain, places, turned, at } = this;
    for (let k = 0; k < 4; k++) turned[k] = chain[k];
    for (let k = 0; k < 3; k++) at[k] = places[k];
    for (let n = 1, above = 0; n < this.body.chain.length; above = n++) {
      rotate(at, 3 * n, turned, 4 * above, places[3 * n], places[3 * n + 1], places[3 * n + 2]);
      for (let k = 0; k < 3; k++) at[3 * n + k] += at[3 * above + k];
      multiply(turned, 4 * n, turned, 4 * above, chain, 4 * n);
    }
  }
}
