// Translated from metagraph/playback/bounds.py; change that, and translate anew.
using System;
using System.Collections.Generic;
using System.Linq;

namespace Metagraph
{
    /// <summary>
    /// A meta action with when the next more important one begins (limit), and the next as important that was asked for (wish);
    /// infinity where there is none.
    /// </summary>
    public sealed class Bound
    {
        public readonly MetaAction Meta;
        public readonly double Limit;
        public readonly double Wish;

        public Bound(MetaAction meta, double limit, double wish)
        {
            Meta = meta;
            Limit = limit;
            Wish = wish;
        }
    }

    /// <summary>The first of some meta actions of a rank, written or asked for, and when it starts.</summary>
    public sealed class _First
    {
        public double Rank;
        public bool Written;
        public double Start;

        public _First(double rank, bool written, double start)
        {
            Rank = rank;
            Written = written;
            Start = start;
        }
    }

    public static class BoundsRules
    {
        /// <summary>Return each meta action with what bounds it.</summary>
        public static List<Bound> Bounds(List<MetaAction> metas)
        {
            var out_ = new List<Bound>();
            var first = new List<_First>();
            foreach (MetaAction meta in metas.AsEnumerable().Reverse().ToList())
            {
                var limit = double.PositiveInfinity;
                var wish = double.PositiveInfinity;
                _First own = null;
                foreach (_First one in first)
                {
                    if (one.Rank > meta.Rank)
                    {
                        limit = Math.Min(limit, one.Start);
                    }
                    if (one.Rank >= meta.Rank && !one.Written)
                    {
                        wish = Math.Min(wish, one.Start);
                    }
                    if (one.Rank == meta.Rank && one.Written == meta.Written)
                    {
                        own = one;
                    }
                }
                out_.Add(new Bound(meta, limit, wish));
                if (own == null)
                {
                    first.Add(new _First(meta.Rank, meta.Written, meta.Start));
                }
                else
                {
                    own.Start = meta.Start;
                }
            }
            return out_.AsEnumerable().Reverse().ToList().ToList();
        }
    }
}
