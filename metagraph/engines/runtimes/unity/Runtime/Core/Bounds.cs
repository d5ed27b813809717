// Translated from metagraph/playback/planning/bounds.py; change that, and translate anew.
using System;
using System.Collections.Generic;
using System.Linq;

namespace Metagraph
{
    /// <summary>
    /// A meta action and its bounds. limit: when the next more important one begins; wish: when the next equally important
    /// request begins; infinity if there is none. after: equally important requests that say how late they may be, the next one
    /// first.
    /// </summary>
    public sealed class Bound
    {
        public readonly MetaAction Meta;
        public readonly double Limit;
        public readonly double Wish;
        public readonly List<MetaAction> After;

        public Bound(MetaAction meta, double limit, double wish, List<MetaAction> after = null)
        {
            Meta = meta;
            Limit = limit;
            Wish = wish;
            After = after ?? new List<MetaAction>();
        }
    }

    /// <summary>The first of some meta actions of a rank, written or requested, and when it starts.</summary>
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
        public const int LookedAt = 6; // how many of those that follow a meta action are listed

        /// <summary>Return each meta action with its bounds.</summary>
        public static List<Bound> Bounds(List<MetaAction> metas)
        {
            var out_ = new List<Bound>();
            var first = new List<_First>();
            var pressing = new List<MetaAction>(); // what says how late it may be, the last first
            foreach (MetaAction meta in metas.AsEnumerable().Reverse().ToList())
            {
                var limit = double.PositiveInfinity;
                var wish = double.PositiveInfinity;
                _First own = null;
                var start = Begins(meta);
                var rank = meta.Rank;
                foreach (_First one in first)
                {
                    if (one.Rank > rank)
                    {
                        limit = Math.Min(limit, one.Start);
                    }
                    if (one.Rank >= rank && !one.Written)
                    {
                        wish = Math.Min(wish, one.Start);
                    }
                    if (one.Rank == rank && one.Written == meta.Written)
                    {
                        own = one;
                    }
                }
                var after = new List<MetaAction>();
                if (pressing.Count > 0)
                {
                    after = PlainLists.Part(pressing, -LookedAt).AsEnumerable().Reverse().ToList().Where(one => one.Rank
                        >= rank).ToList();
                }
                out_.Add(new Bound(meta, limit, wish, after));
                if (meta.Request.Late != null)
                {
                    pressing.Add(meta);
                }
                if (own == null)
                {
                    first.Add(new _First(rank, meta.Written, start));
                }
                else
                {
                    own.Start = start;
                }
            }
            return out_.AsEnumerable().Reverse().ToList().ToList();
        }

        /// <summary>
        /// Return the earliest time at which a meta action may begin. One whose stroke is judged is placed where its stroke
        /// comes.
        /// </summary>
        public static double Begins(MetaAction meta)
        {
            if (meta.Request.Late != null && meta.Request.Stroke != null)
            {
                return Math.Min(meta.Start, meta.Request.Start);
            }
            return meta.Start;
        }
    }
}
