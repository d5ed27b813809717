// Translated from metagraph/graph/repeating.py; change that, and translate anew.
using System;
using System.Collections.Generic;
using System.Linq;

namespace Metagraph
{
    /// <summary>Say how long actions play that repeat a part of their clip, such as one cycle of a wave.</summary>
    public static class RepeatingRules
    {
        public const double LeastCycle = 0.1; // seconds of a part that can repeat
        public const double MostTimes = 1000000.0; // that a cycle plays in a row
        public const double LongestRepeat = 60.0; // most seconds that an action repeats if no request says how long

        /// <summary>
        /// Return the length in seconds of the part from `start` to `end` that an action repeats, 0 if it plays once.
        /// </summary>
        public static double CycleOf(string kind, Timing timing, double start, double end)
        {
            var repeats = timing.Repeat > 0 && new List<string> { "gesture", "fidget" }.Contains(kind);
            return (repeats && end - start >= LeastCycle) ? end - start : 0.0;
        }

        /// <summary>
        /// Return how many whole times, at least one, a cycle must play to last as close to `seconds` as possible.
        /// </summary>
        public static double TimesPlayed(double cycle, double seconds)
        {
            return Math.Max(1.0, (int)Math.Floor(Math.Min(seconds / cycle, MostTimes) + 0.5));
        }

        /// <summary>Return how many seconds an action plays at its own speed if no request says how long.</summary>
        public static double SecondsPlayed(string kind, Timing timing, double start, double end)
        {
            var cycle = CycleOf(kind, timing, start, end);
            if (cycle <= 0)
            {
                return end - start;
            }
            return cycle * TimesPlayed(cycle, Math.Min(timing.Repeat, LongestRepeat));
        }
    }
}
