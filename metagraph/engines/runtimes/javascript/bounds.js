/**
 * By when each meta action of a plan has to be over.
 *
 * Translated from metagraph/playback/bounds.py; change that, and translate anew.
 */


/**
 * A meta action with when the next more important one begins (limit), and the next as important that was asked for (wish);
 * infinity where there is none.
 *
 * meta: MetaAction; limit: number; wish: number.
 */
export class Bound {
  constructor(meta, limit, wish) {
    this.meta = meta;
    this.limit = limit;
    this.wish = wish;
  }
}

/**
 * The first of some meta actions of a rank, written or asked for, and when it starts.
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
 * Return each meta action with what bounds it.
 * @param {MetaAction[]} metas
 * @returns {Bound[]}
 */
export function bounds(metas) {
  const out = [];
  const first = [];
  for (const meta of [...metas].reverse()) {
    let limit = Infinity;
    let wish = Infinity;
    let own = null;
    for (const one of first) {
      if (one.rank > meta.rank) {
        limit = Math.min(limit, one.start);
      }
      if (one.rank >= meta.rank && !one.written) {
        wish = Math.min(wish, one.start);
      }
      if (one.rank === meta.rank && one.written === meta.written) {
        own = one;
      }
    }
    out.push(new Bound(meta, limit, wish));
    if (own === null) {
      first.push(new _First(meta.rank, meta.written, meta.start));
    } else {
      own.start = meta.start;
    }
  }
  return [...[...out].reverse()];
}
