// Translated from metagraph/graph/model.py; change that, and translate anew.
using System;
using System.Collections.Generic;
using System.Linq;

namespace Metagraph
{
    /// <summary>
    /// When an action plays within its clip; seconds of the clip.
    ///
    /// start, end: the part that plays; `end` None is the clip's end. blend_in, blend_out: seconds of blending from and to the
    /// stance, within start..end (for a looping stance, blend_in is the overlap at the loop's seam). loop: repeats.
    /// earliest_exit: from here on the action may be left, or None to play it through. stroke: its most telling moment. ready,
    /// stroke_end, relax: where a gesture's preparation, stroke and hold end (its retraction ends with it); None as found from
    /// the motion (`playback.timing.phases`).
    /// </summary>
    public sealed class Timing
    {
        public readonly double Start;
        public readonly double? End;
        public readonly double BlendIn;
        public readonly double BlendOut;
        public readonly bool Loop;
        public readonly double? EarliestExit;
        public readonly double? Stroke;
        public readonly double? Ready;
        public readonly double? StrokeEnd;
        public readonly double? Relax;

        public Timing(
            double start = 0.0,
            double? end = null,
            double blendIn = 0.2,
            double blendOut = 0.3,
            bool loop = false,
            double? earliestExit = null,
            double? stroke = null,
            double? ready = null,
            double? strokeEnd = null,
            double? relax = null
        )
        {
            Start = start;
            End = end;
            BlendIn = blendIn;
            BlendOut = blendOut;
            Loop = loop;
            EarliestExit = earliestExit;
            Stroke = stroke;
            Ready = ready;
            StrokeEnd = strokeEnd;
            Relax = relax;
        }
    }

    public sealed class Stance
    {
        public readonly string Id;
        public readonly string Layer;
        public readonly string Name;

        public Stance(string id, string layer, string name)
        {
            Id = id;
            Layer = layer;
            Name = name;
        }
    }

    /// <summary>
    /// A first-order model over (limb, kind) that writes meta actions when nobody asks for any (Borer et al., 7.3).
    ///
    /// matrix: rows of probabilities, each summing to 1. gap: mean seconds of rest between two actions. positive, negative: share
    /// of gestures asked for with that tag, where tags are not part of the states. tags: one text a state, the tags (blanks
    /// between them) it asks for; empty when tags are not part of the states. lengths: (mean, standard deviation) seconds of each
    /// state's actions; empty where that is not known. modes: what is performed of what it writes while one is said to idle, to
    /// listen and to talk, a row each: shares of gestures, fidgets and transitions, 0..1; empty where the mode makes no
    /// difference.
    /// </summary>
    public sealed class Markov
    {
        public readonly string Layer;
        public readonly List<(string, string)> States;
        public readonly List<List<double>> Matrix;
        public readonly double Gap;
        public readonly double Positive;
        public readonly double Negative;
        public readonly List<string> Tags;
        public readonly List<(double, double)> Lengths;
        public readonly List<List<double>> Modes;

        public Markov(
            string layer,
            List<(string, string)> states,
            List<List<double>> matrix,
            double gap = 2.5,
            double positive = 0.0,
            double negative = 0.0,
            List<string> tags = null,
            List<(double, double)> lengths = null,
            List<List<double>> modes = null
        )
        {
            Layer = layer;
            States = states;
            Matrix = matrix;
            Gap = gap;
            Positive = positive;
            Negative = negative;
            Tags = tags ?? new List<string>();
            Lengths = lengths ?? new List<(double, double)>();
            Modes = modes ?? new List<List<double>>();
        }

        /// <summary>Return the tags a state asks for, "" for none.</summary>
        public string Tag(int state)
        {
            return Tags.Count > 0 ? Tags[state] : "";
        }
    }

    /// <summary>
    /// Planner constants. alpha: how quickly a used action becomes unlikely (4 in the paper). seed: 32-bit.
    ///
    /// never_twice: an action is not played twice in a row where there is another. shortest: seconds below which the remainder of
    /// a cut meta action is not worth keeping. wait: how late, in seconds, a request may start. memory: seconds after which a use
    /// no longer counts, 0 for never (as in the paper). rest: least seconds in the stance between two actions of a layer.
    /// lookahead: seconds ahead of now in which a running plan is not changed any more.
    /// </summary>
    public sealed class Settings
    {
        public readonly double Alpha;
        public readonly int Seed;
        public readonly bool NeverTwice;
        public readonly double Shortest;
        public readonly double Wait;
        public readonly double Memory;
        public readonly double Rest;
        public readonly double Lookahead;

        public Settings(
            double alpha = 4.0,
            int seed = 1,
            bool neverTwice = true,
            double shortest = 0.4,
            double wait = 4.0,
            double memory = 0.0,
            double rest = 0.0,
            double lookahead = 0.1
        )
        {
            Alpha = alpha;
            Seed = seed;
            NeverTwice = neverTwice;
            Shortest = shortest;
            Wait = wait;
            Memory = memory;
            Rest = rest;
            Lookahead = lookahead;
        }
    }
}
