// Translated from metagraph/playback/posing/cue_times.py; change that, and translate anew.
using System;
using System.Collections.Generic;
using System.Linq;

namespace Metagraph
{
    /// <summary>
    /// Where a loop is.
    ///
    /// `seconds` is the time in its clip, `other` the time on the other side of its seam. `over` is how far it has blended from
    /// there to here, 1 if no seam shows. `leaves` and `meets` are the clip seconds at which the two sides of the seam begin and
    /// end.
    /// </summary>
    public sealed class LoopSpot
    {
        public readonly double Seconds;
        public readonly double Other;
        public readonly double Over;
        public readonly double Leaves;
        public readonly double Meets;

        public LoopSpot(double seconds, double other, double over, double leaves, double meets)
        {
            Seconds = seconds;
            Other = other;
            Over = over;
            Leaves = leaves;
            Meets = meets;
        }
    }

    public static class CueTimesRules
    {
        // clip seconds in which a cue that repeats makes its cycle's ends meet, at most half of the cycle
        public const double Seam = 0.4;

        /// <summary>Return where a stance's loop is at a time, as `layers.compute_loop_seconds` does.</summary>
        public static LoopSpot LoopSpot(Graph project, Rest rest, double time)
        {
            var action = rest.Action;
            var found = project.Span(action);
            double start = found.Item1;
            double end = found.Item2;
            var seam = Math.Min(Math.Max(0.0, action.Timing.BlendIn), (end - start) / 2.0);
            var period = end - start - seam;
            if (period <= 0.0)
            {
                return new LoopSpot(start, start, 1.0, start, start);
            }
            var elapsed = time - rest.Start;
            var phase = seam > 0.0 ? Math.Max(elapsed, 0.0) : elapsed;
            phase = phase - period * (int)Math.Floor(phase / period);
            var over = (seam > 0.0 && elapsed >= period && phase < seam) ? phase / seam : 1.0;
            var other = start + Math.Min(period + phase, end - start);
            return new LoopSpot(start + phase, other, over, start + period, start + seam);
        }

        /// <summary>Return how much of a cue shows at a time, 0..1.</summary>
        public static double CueWeight(Cue cue, double time)
        {
            if (time < cue.Start || time >= cue.End)
            {
                return 0.0;
            }
            var rise = cue.BlendIn > 0.0 ? Ease((time - cue.Start) / cue.BlendIn) : 1.0;
            var fall = cue.BlendOut > 0.0 ? Ease((cue.End - time) / cue.BlendOut) : 1.0;
            return rise * fall;
        }

        /// <summary>Return the second of its clip that a cue plays at a time.</summary>
        public static double CueSeconds(Cue cue, double time)
        {
            var elapsed = time - cue.Start;
            if (cue.Repeats)
            {
                var cycle = cue.CycleTo - cue.CycleFrom;
                var into = cue.Entry - cue.CycleFrom + elapsed * cue.Tempo;
                return cue.CycleFrom + into - cycle * (int)Math.Floor(into / cycle);
            }
            if (cue.Hold <= 0.0)
            {
                return cue.Entry + elapsed * cue.Tempo;
            }
            var held = Math.Min(Math.Max(elapsed - (cue.HoldFrom - cue.Entry) / cue.Tempo, 0.0), cue.Hold);
            var more = (elapsed - held) * (cue.Tempo - 1.0);
            return cue.Entry + elapsed - held + more + held * ((cue.HoldTo - cue.HoldFrom) / cue.Hold);
        }

        /// <summary>
        /// Return the share, 0..1, of the offset between the end of one cycle and the beginning of the next that is still added
        /// at a time, so that a cue that repeats does not jump.
        /// </summary>
        public static double SeamLeft(Cue cue, double time)
        {
            var cycle = cue.CycleTo - cue.CycleFrom;
            var into = cue.Entry - cue.CycleFrom + (time - cue.Start) * cue.Tempo;
            if (!cue.Repeats || (int)Math.Floor(into / cycle) < 1)
            {
                return 0.0;
            }
            return 1.0 - Ease((into - cycle * (int)Math.Floor(into / cycle)) / Math.Min(Seam, 0.5 * cycle));
        }

        /// <summary>Return 3 x^2 - 2 x^3 of x clamped to 0..1.</summary>
        public static double Ease(double x)
        {
            x = Math.Min(Math.Max(x, 0.0), 1.0);
            return x * x * (3.0 - 2.0 * x);
        }
    }
}
