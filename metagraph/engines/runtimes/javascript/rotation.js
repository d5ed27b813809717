/**
 * Rotations as unit quaternions xyzw, vectors as xyz, both inside arrays of numbers: `out` at place `o` is written, `q` at place `i`
 * is read. `multiply(a, b)` applies b first, then a. Nothing is allocated.
 */

/** 3x^2 - 2x^3 of x clamped to 0..1. @param {number} x */
export const ease = (x) => (x <= 0 ? 0 : x >= 1 ? 1 : x * x * (3 - 2 * x));

/** out[o..] = a[i..] * b[j..]; may write where it reads. */
export function multiply(out, o, a, i, b, j) {
  const ax = a[i], ay = a[i + 1], az = a[i + 2], aw = a[i + 3];
  const bx = b[j], by = b[j + 1], bz = b[j + 2], bw = b[j + 3];
  out[o] = aw * bx + ax * bw + ay * bz - az * by;
  out[o + 1] = aw * by - ax * bz + ay * bw + az * bx;
  out[o + 2] = aw * bz + ax * by - ay * bx + az * bw;
  out[o + 3] = aw * bw - ax * bx - ay * by - az * bz;
}

/** out[o..] = the vector x, y, z turned by q[i..]; with `back` by its inverse. */
export function rotate(out, o, q, i, x, y, z, back = false) {
  const sign = back ? -1 : 1;
  const qx = sign * q[i], qy = sign * q[i + 1], qz = sign * q[i + 2], qw = q[i + 3];
  const tx = 2 * (qy * z - qz * y);
  const ty = 2 * (qz * x - qx * z);
  const tz = 2 * (qx * y - qy * x);
  out[o] = x + qw * tx + qy * tz - qz * ty;
  out[o + 1] = y + qw * ty + qz * tx - qx * tz;
  out[o + 2] = z + qw * tz + qx * ty - qy * tx;
}

/** out[o..] = the turn by the rotation vector x, y, z: axis times angle, radians. */
export function fromVector(out, o, x, y, z) {
  const size = Math.sqrt(x * x + y * y + z * z + 1e-30);
  const s = Math.sin(0.5 * size) / size;
  out[o] = x * s;
  out[o + 1] = y * s;
  out[o + 2] = z * s;
  out[o + 3] = Math.cos(0.5 * size);
}

/** q[i..] turned the short way by `weight` times its angle, in place. */
export function power(q, i, weight) {
  const sign = q[i + 3] < 0 ? -1 : 1;
  const s = Math.sqrt(q[i] * q[i] + q[i + 1] * q[i + 1] + q[i + 2] * q[i + 2]);
  const factor = sign * weight * (s > 1e-8 ? (2 * Math.atan2(s, sign * q[i + 3])) / s : 2);
  fromVector(q, i, q[i] * factor, q[i + 1] * factor, q[i + 2] * factor);
}

/** q[i..] to unit length, in place. */
export function normalize(q, i) {
  const k = 1 / Math.sqrt(Math.max(q[i] * q[i] + q[i + 1] * q[i + 1] + q[i + 2] * q[i + 2] + q[i + 3] * q[i + 3], 1e-20));
  q[i] *= k;
  q[i + 1] *= k;
  q[i + 2] *= k;
  q[i + 3] *= k;
}

/** out[o..] = a[i..] blended to b[j..] by `weight` along the shorter arc: a normalised straight line. */
export function nlerp(out, o, a, i, b, j, weight) {
  const dot = a[i] * b[j] + a[i + 1] * b[j + 1] + a[i + 2] * b[j + 2] + a[i + 3] * b[j + 3];
  const w = dot < 0 ? -weight : weight;
  for (let k = 0; k < 4; k++) out[o + k] = a[i + k] * (1 - weight) + b[j + k] * w;
  normalize(out, o);
}

/** out[o..] = a[i..] blended to b[j..] by `weight` at constant speed along the shorter arc. */
export function slerp(out, o, a, i, b, j, weight) {
  let dot = a[i] * b[j] + a[i + 1] * b[j + 1] + a[i + 2] * b[j + 2] + a[i + 3] * b[j + 3];
  const sign = dot < 0 ? -1 : 1;
  dot *= sign;
  if (dot > 0.9999) return nlerp(out, o, a, i, b, j, weight); // as good, where they are close
  const angle = Math.acos(dot);
  const u = Math.sin((1 - weight) * angle) / Math.sin(angle);
  const v = (sign * Math.sin(weight * angle)) / Math.sin(angle);
  for (let k = 0; k < 4; k++) out[o + k] = a[i + k] * u + b[j + k] * v;
}

/** Return positions `[J, 3]` in the character's space of local rotations `[J, 4]` and translations `[J, 3]`. */
export function positions(parents, rotations, translations) {
  const turned = Float64Array.from(rotations);
  const out = Float64Array.from(translations);
  parents.forEach((parent, j) => {
    if (parent < 0) return;
    rotate(out, 3 * j, turned, 4 * parent, translations[3 * j], translations[3 * j + 1], translations[3 * j + 2]);
    for (let k = 0; k < 3; k++) out[3 * j + k] += out[3 * parent + k];
    multiply(turned, 4 * j, turned, 4 * parent, turned, 4 * j);
  });
  return out;
}
