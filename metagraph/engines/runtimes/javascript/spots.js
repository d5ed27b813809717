/** Where something is: a name or a point, three numbers. */

/** Return what has a name. @param {string} name */
export const named = (name) => name;

/** Return the point that a name stands for among places, else what was given. @param {Map<string, number[]>} places */
export const placed = (places, to) => (typeof to === "string" ? places.get(to) ?? to : to);

/** Return whether two names or two points are the same. */
export function isSameSpot(a, b) {
  return a === b || (Array.isArray(a) && Array.isArray(b) && a.every((x, n) => x === b[n]));
}
