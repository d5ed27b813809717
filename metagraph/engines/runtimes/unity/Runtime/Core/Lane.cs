// Translated from metagraph/playback/life/lane.py; change that, and translate anew.
using System;
using System.Collections.Generic;
using System.Linq;

namespace Metagraph
{
    /// <summary>
    /// times: when events begin, ascending, seconds. rows: the values of each event. first: number of the first event that is
    /// still kept. width: how many numbers a row has.
    /// </summary>
    public sealed class Lane
    {
        public readonly List<double> Times;
        public readonly List<List<double>> Rows;
        public readonly int First;
        public readonly int Width;

        public Lane(List<double> times = null, List<List<double>> rows = null, int first = 0, int width = 1)
        {
            Times = times ?? new List<double>();
            Rows = rows ?? new List<List<double>>();
            First = first;
            Width = width;
        }

        /// <summary>The number of the event to be drawn next.</summary>
        public int Next
        {
            get
            {
                return First + Times.Count;
            }
        }

        /// <summary>Return the lane with only the events that begin before a time.</summary>
        public Lane Until(double seconds)
        {
            var count = PlainLists.Left(Times, seconds);
            if (count == Times.Count)
            {
                return this;
            }
            return new Lane(PlainLists.Part(Times, 0, count), PlainLists.Part(Rows, 0, count), First, Width);
        }

        /// <summary>Return the lane with later events.</summary>
        public Lane Plus(List<double> times, List<List<double>> rows)
        {
            if (times.Count == 0)
            {
                return this;
            }
            return new Lane(Times.Concat(times).ToList(), Rows.Concat(rows).ToList(), First, Width);
        }

        /// <summary>Return the lane without events that are over at `seconds`; `before`: how many of those to keep.</summary>
        public Lane Since(double seconds, int before = 1)
        {
            var gone = Math.Max(0, PlainLists.Right(Times, seconds) - 1 - before);
            if (gone == 0)
            {
                return this;
            }
            return new Lane(PlainLists.Part(Times, gone), PlainLists.Part(Rows, gone), First + gone, Width);
        }
    }
}
