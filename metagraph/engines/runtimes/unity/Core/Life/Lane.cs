using System;
using System.Collections.Generic;

namespace Metagraph
{
    /// <summary>
    /// Events in time, drawn one after another: never changed, extended at the end, forgotten at the front. Starts ascend, seconds;
    /// Values: what each event is. First: number of the first event that is still kept.
    /// </summary>
    public sealed class Lane
    {
        public static readonly Lane Empty = new Lane(new double[0], new double[0][], 0);
        public readonly double[] Starts;
        public readonly double[][] Values;
        public readonly int First;

        private Lane(double[] starts, double[][] values, int first)
        {
            Starts = starts;
            Values = values;
            First = first;
        }

        public int Count
        {
            get { return Starts.Length; }
        }

        /// <summary>The number of the event to be drawn next.</summary>
        public int Next
        {
            get { return First + Starts.Length; }
        }

        /// <summary>The lane with only what begins before a time.</summary>
        public Lane Until(double seconds)
        {
            return Part(0, Basics.BisectLeft(Starts, seconds));
        }

        /// <summary>The lane with later events.</summary>
        public Lane Plus(List<double> starts, List<double[]> values)
        {
            var allStarts = new List<double>(Starts);
            var allValues = new List<double[]>(Values);
            allStarts.AddRange(starts);
            allValues.AddRange(values);
            return starts.Count == 0 ? this : new Lane(allStarts.ToArray(), allValues.ToArray(), First);
        }

        /// <summary>The lane without what neither goes on at `seconds` nor comes later; before: how many more are kept.</summary>
        public Lane Since(double seconds, int before)
        {
            return Part(Math.Max(0, Basics.BisectRight(Starts, seconds) - 1 - before), Count);
        }

        private Lane Part(int from, int to)
        {
            if (from == 0 && to == Count)
            {
                return this;
            }
            var starts = new double[to - from];
            var values = new double[to - from][];
            Array.Copy(Starts, from, starts, 0, to - from);
            Array.Copy(Values, from, values, 0, to - from);
            return new Lane(starts, values, First + from);
        }
    }
}
