/**
 * Where the gaze goes at a time: eased moves from target to target, with aversions and saccades on top.
 *
 * The eyes jump (a saccade of A degrees takes 21 + 2.2 A milliseconds), the head follows a moment later and settles like a critically
 * damped spring. What is looked at is the sum of all moves so far, each from the target before, so a target may change at any time:
 *
 *     angle(t) = sum over targets i of angle_i (S_i(t) - S_{i+1}(t)),  S_i: how far the move to target i has come, 0..1
 */

import { begunBy, bisect } from "../basics.js";
import { ease } from "../rotation.js";
import { AHEAD, PARTNER } from "../wanted.js";

const [EYE_TIME, EYE_TIME_PER_DEGREE] = [0.021, 0.0022]; // seconds
const HEAD_LAG = 0.04; // seconds the head sets off after the eyes
const [HEAD_TIME, HEAD_TIME_PER_DEGREE] = [0.55, 0.006]; // seconds until it has settled
const ENDING = 0.12; // seconds in which a new look ends an aversion
const SPRING = 8; // how many of the spring's own times a move takes; then all but 0.3 % is done
const SETTLED = 1 - (1 + SPRING) * Math.exp(-SPRING);
const RADIANS = Math.PI / 180;

/** A critically damped spring's way from 0 to 1, for x from 0 to 1. @param {number} x */
const settle = (x) => (x <= 0 ? 0 : x >= 1 ? 1 : (1 - (1 + SPRING * x) * Math.exp(-SPRING * x)) / SETTLED);

/** Seconds the eyes, and the head from when it sets off, take for a turn of `angle` degrees. */
const eyeTime = (angle) => EYE_TIME + EYE_TIME_PER_DEGREE * angle;
const headTime = (angle) => HEAD_TIME + HEAD_TIME_PER_DEGREE * angle;

/** A schedule's gaze on a body; `at` leaves in it what the gaze does at a time. */
export class Gaze {
  /** @param {object} schedule @param {object} life @param {object} body @param {Map<string, number[]>} points */
  constructor(schedule, life, body, points) {
    this.schedule = schedule;
    this.body = body;
    this.points = points;
    const calm = 1 - life.stillness;
    this.averting = life.aversionAngle * RADIANS * calm * life.gaze; // radians of an aversion's offset of 1
    this.darting = life.saccades * RADIANS * calm;
    this.angle = life.aversionAngle;
    this.known = []; // targets as the gaze meets them
    this.count = 0; // how many targets take part, and each with the eyes' and the head's share of it, together 1
    this.aims = [];
    this.came = [];
    this.moved = [];
    this.eyes = new Float64Array(2); // what aversions and saccades add, radians to the left and up
    this.head = new Float64Array(2);
  }

  /** @param {number} time */
  at(time) {
    const { targets, aversions, saccades } = this.schedule;
    const last = Math.max(0, begunBy(targets, time) - 1);
    let came = 0, turned = 0, strict = 0;
    this.count = 0;
    for (let place = last; place >= 0 && (came < 1 || turned < 1); place--) {
      const aim = (this.known[place] ??= this.aim(place));
      const gone = time - aim.start;
      const now = ease(gone / aim.eyes);
      const head = settle((gone - HEAD_LAG) / aim.head);
      this.aims[this.count] = aim;
      this.came[this.count] = now - came;
      this.moved[this.count] = head - turned;
      this.count += 1;
      if (aim.strict) strict += now - came;
      came = now;
      turned = head;
    }
    this.eyes.fill(0);
    this.head.fill(0);
    this.avert(aversions, time, strict, targets[last].since);
    this.dart(saccades, time);
  }

  avert({ times, rows }, time, strict, since) {
    const n = bisect(times, time, true) - 1;
    if (n < 0 || !(this.averting > 0)) return;
    const end = rows[n][0], x = rows[n][1], y = rows[n][2];
    const size = Math.hypot(x, y) * this.angle;
    let scale = this.averting * (1 - strict);
    if (since > times[n]) scale *= 1 - ease((time - since) / ENDING); // a new look ends it
    const went = time - times[n];
    const gone = time - end;
    const slow = headTime(size);
    if (gone >= HEAD_LAG + slow) return;
    const fast = eyeTime(size);
    const now = scale * (ease(went / fast) - ease(gone / fast));
    const head = scale * (settle((went - HEAD_LAG) / slow) - settle((gone - HEAD_LAG) / slow));
    this.eyes[0] = x * now;
    this.eyes[1] = y * now;
    this.head[0] = x * head;
    this.head[1] = y * head;
  }

  dart({ times, rows }, time) {
    const n = bisect(times, time, true) - 1;
    if (n < 0 || !(this.darting > 0)) return;
    const x = rows[n][0], y = rows[n][1];
    const fromX = n > 0 ? rows[n - 1][0] : 0;
    const fromY = n > 0 ? rows[n - 1][1] : 0;
    const way = ease((time - times[n]) / eyeTime(Math.hypot(x - fromX, y - fromY)));
    this.eyes[0] += this.darting * (fromX + (x - fromX) * way);
    this.eyes[1] += this.darting * (fromY + (y - fromY) * way);
  }

  /** Return a target as it is met; how long the move to it takes is told by how far it is from the one before. */
  aim(place) {
    const { targets } = this.schedule;
    const target = targets[place];
    const point = this.pointOf(target);
    const angle = place ? between(this.towards(point), this.towards(this.pointOf(targets[place - 1]))) : 0;
    const start = place ? target.start : -Infinity; // the first has always been looked at
    const { asked, strict } = target;
    const at = point ?? this.body.partner;
    return { start, at, amount: point ? target.amount : 0, asked, strict, eyes: eyeTime(angle), head: headTime(angle) };
  }

  /** Return where a target is, metres; null for what is nowhere: ahead. */
  pointOf({ to }) {
    if (to === AHEAD) return null;
    return (typeof to === "string" ? this.points.get(to) : to) ?? (to === PARTNER ? this.body.partner : null);
  }

  /** Return the direction of a point from where the eyes are at rest. */
  towards(point) {
    return point ? point.map((x, n) => x - this.body.eyesAtRest[n]) : this.body.ahead;
  }
}

/** Return the angle between two directions, degrees. */
function between(a, b) {
  const dot = (x, y) => x[0] * y[0] + x[1] * y[1] + x[2] * y[2];
  const cosine = dot(a, b) / Math.max(Math.sqrt(dot(a, a) * dot(b, b)), 1e-12);
  return Math.acos(Math.min(1, Math.max(-1, cosine))) / RADIANS;
}
