/**
 * The times by which the meta actions of a plan have to be over.
 *
 * Translated from metagraph/playback/planning/bounds.py; change that, and translate anew.
 */


export const LOOKED_AT = 6; // how many of those that follow a meta action are listed

/**
 * A meta action and its bounds. limit: when the next more important one begins; wish: when the next equally important
 * request begins; infinity if there is none. after: equally important requests that say how late they may be, the next one
 * first.
 *
 * meta: MetaAction; limit: number; wish: number; after: MetaAction[].
 */
export class Bound {
  constructor(meta, limit, wish, after = []) {
    this.meta = meta;
    this.limit = limit;
    this.wish = wish;
    this.after = after;
  }
}

/**
 * The first of some meta actions of a rank, written or requested, and when it starts.
 *
 * rank: number; written: boolean; start: number.
 */
export class _First {
  constructor(rank, written, start) {
    this.rank = rank;
    this.written = written;
    this.start = start;
  }
}

/**
 * Return each meta action with its bounds.
 * @param {MetaAction[]} metas
 * @returns {Bound[]}
 */
export function bounds(metas) {
  const out = [];
  const first = [];
  const pressing = []; // what says how late it may be, the last first
  for (const meta of [...metas].reverse()) {
    let limit = Infinity;
    let wish = Infinity;
    let own = null;
    const start = begins(meta);
    const rank = meta.rank;
    for (const one of first) {
      if (one.rank > rank) {
        limit = Math.min(limit, one.start);
      }
      if (one.rank >= rank && !one.written) {
        wish = Math.min(wish, one.start);
      }
      if (one.rank === rank && one.written === meta.written) {
        own = one;
      }
    }
    let after = [];
    if (pressing.length > 0) {
      after = [...pressing.slice(-LOOKED_AT)].reverse().filter((one) => one.rank >= rank);
    }
    out.push(new Bound(meta, limit, wish, after));
    if (meta.request.late !== null) {
      pressing.push(meta);
    }
    if (own === null) {
      first.push(new _First(rank, meta.written, start));
    } else {
      own.start = start;
    }
  }
  return [...[...out].reverse()];
}

/**
 * Return the earliest time at which a meta action may begin. One whose stroke is judged is placed where its stroke comes.
 * @param {MetaAction} meta
 * @returns {number}
 */
export function begins(meta) {
  if (meta.request.late !== null && meta.request.stroke !== null) {
    return Math.min(meta.start, meta.request.start);
  }
  return meta.start;
}
