/**
 * Vectors and rotations as plain tuples, for code that computes one pose at a time, the same in all languages. Vectors are
 * x, y, z; quaternions xyzw, of length 1.
 *
 * Translated from metagraph/motion/plain_vectors.py; change that, and translate anew.
 */


/**
 * Return the product: rotate by `b`, then by `a`.
 * @param {[number, number, number, number]} a
 * @param {[number, number, number, number]} b
 * @returns {[number, number, number, number]}
 */
export function times(a, b) {
  const { 0: ax, 1: ay, 2: az, 3: aw } = a;
  const { 0: bx, 1: by, 2: bz, 3: bw } = b;
  return [
    aw * bx + ax * bw + ay * bz - az * by,
    aw * by - ax * bz + ay * bw + az * bx,
    aw * bz + ax * by - ay * bx + az * bw,
    aw * bw - ax * bx - ay * by - az * bz,
  ];
}

/**
 * Return a vector rotated.
 * @param {[number, number, number, number]} q
 * @param {[number, number, number]} v
 * @returns {[number, number, number]}
 */
export function rotated(q, v) {
  const { 0: x, 1: y, 2: z, 3: w } = q;
  const { 0: vx, 1: vy, 2: vz } = v;
  const tx = 2 * (y * vz - z * vy);
  const ty = 2 * (z * vx - x * vz);
  const tz = 2 * (x * vy - y * vx);
  return [vx + w * tx + y * tz - z * ty, vy + w * ty + z * tx - x * tz, vz + w * tz + x * ty - y * tx];
}

/**
 * Return the shortest rotation that takes one direction to another, both of length 1.
 * @param {[number, number, number]} a
 * @param {[number, number, number]} b
 * @returns {[number, number, number, number]}
 */
export function between(a, b) {
  const { 0: ax, 1: ay, 2: az } = a;
  const { 0: bx, 1: by, 2: bz } = b;
  const along = ax * bx + ay * by + az * bz;
  if (along < -0.999999999) { // half a turn about any axis across
    return unitTurn(Math.abs(ax) < 0.9 ? [0, az, -ay, 0] : [-az, 0, ax, 0]);
  }
  return unitTurn([ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx, 1 + along]);
}

/**
 * Return the length of a vector.
 * @param {[number, number, number]} v
 * @returns {number}
 */
export function length(v) {
  const { 0: x, 1: y, 2: z } = v;
  return Math.sqrt(x * x + y * y + z * z);
}

/**
 * Return a vector of length 1 in the same direction; the zero vector stays as it is.
 * @param {[number, number, number]} v
 * @returns {[number, number, number]}
 */
export function unit(v) {
  return scaled(v, 1 / Math.max(length(v), 1e-12));
}

/**
 * Return a quaternion of length 1.
 * @param {[number, number, number, number]} q
 * @returns {[number, number, number, number]}
 */
export function unitTurn(q) {
  const { 0: x, 1: y, 2: z, 3: w } = q;
  const k = 1 / Math.max(Math.sqrt(x * x + y * y + z * z + w * w), 1e-12);
  return [x * k, y * k, z * k, w * k];
}

/**
 * Return the inverse rotation.
 * @param {[number, number, number, number]} q
 * @returns {[number, number, number, number]}
 */
export function back(q) {
  const { 0: x, 1: y, 2: z, 3: w } = q;
  return [-x, -y, -z, w];
}

/**
 * Return the sum.
 * @param {[number, number, number]} a
 * @param {[number, number, number]} b
 * @returns {[number, number, number]}
 */
export function plus(a, b) {
  const { 0: ax, 1: ay, 2: az } = a;
  const { 0: bx, 1: by, 2: bz } = b;
  return [ax + bx, ay + by, az + bz];
}

/**
 * Return the difference.
 * @param {[number, number, number]} a
 * @param {[number, number, number]} b
 * @returns {[number, number, number]}
 */
export function minus(a, b) {
  const { 0: ax, 1: ay, 2: az } = a;
  const { 0: bx, 1: by, 2: bz } = b;
  return [ax - bx, ay - by, az - bz];
}

/**
 * Return a vector times a number.
 * @param {[number, number, number]} a
 * @param {number} k
 * @returns {[number, number, number]}
 */
export function scaled(a, k) {
  const { 0: x, 1: y, 2: z } = a;
  return [x * k, y * k, z * k];
}

/**
 * Return the scalar product.
 * @param {[number, number, number]} a
 * @param {[number, number, number]} b
 * @returns {number}
 */
export function dot(a, b) {
  const { 0: ax, 1: ay, 2: az } = a;
  const { 0: bx, 1: by, 2: bz } = b;
  return ax * bx + ay * by + az * bz;
}
