// Translated from metagraph/playback/timing/phase_times.py; change that, and translate anew.
using System;
using System.Collections.Generic;
using System.Linq;

namespace Metagraph
{
    /// <summary>
    /// Clip seconds, ascending: start, ready (preparation ends), stroke (its peak), stroke_end (the hold begins), relax (the hold
    /// ends), end.
    /// </summary>
    public sealed class Phases
    {
        public readonly double Start;
        public readonly double Ready;
        public readonly double Stroke;
        public readonly double StrokeEnd;
        public readonly double Relax;
        public readonly double End;

        public Phases(double start, double ready, double stroke, double strokeEnd, double relax, double end)
        {
            Start = start;
            Ready = ready;
            Stroke = stroke;
            StrokeEnd = strokeEnd;
            Relax = relax;
            End = end;
        }

        /// <summary>
        /// Return where a gesture begins if it skips its preparation: as late as it can blend in and be ready.
        /// </summary>
        public double Skip(double blendIn)
        {
            return Math.Max(Start, Ready - Math.Max(blendIn, PhaseTimesRules.LeastBlend));
        }
    }

    public static class PhaseTimesRules
    {
        public const double LeastBlend = 0.25; // seconds in which a gesture that skips its preparation comes in
    }
}
