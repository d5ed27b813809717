/**
 * What the planner remembers of played actions: how often each played lately, and until when.
 *
 * Translated from metagraph/playback/planning/remembering.py; change that, and translate anew.
 */


export const REMEMBERED = 32; // draws of a stance and kind that spacing can look back on

/**
 * Return the key under which draws of a stance and kind are remembered.
 * @param {string} stance
 * @param {string} kind
 * @returns {string}
 */
export function node(stance, kind) {
  return `${kind} ${stance}`;
}

/**
 * Return whether at least this many other draws came after an action's last one.
 * @param {string[]} recent
 * @param {string} ident
 * @param {number} needed
 * @returns {boolean}
 */
export function rested(recent, ident, needed) {
  if (needed <= 0) {
    return true;
  }
  return needed <= REMEMBERED && !recent.slice(Math.max(0, recent.length - needed)).includes(ident);
}

/**
 * Note that a cue was played: count its action, and note when it ended.
 * @param {Cue} cue
 * @param {Map<string, number>} uses
 * @param {Map<string, string[]>} recent
 * @param {Map<string, number>} ended
 */
export function remember(cue, uses, recent, ended) {
  const ident = cue.action.id;
  const place = node(cue.stance, cue.action.kind);
  uses.set(ident, (uses.get(ident) ?? 0) + 1);
  recent.set(place, [...(recent.get(place) ?? []).slice(1 - REMEMBERED), ident]);
  ended.set(ident, cue.end);
}
