// Translated from metagraph/graph/model.py; change that, and translate anew.
using System;
using System.Collections.Generic;
using System.Linq;

namespace Metagraph
{
    /// <summary>
    /// When an action plays within its clip. All times are seconds of the clip.
    ///
    /// `start` and `end` bound the part that plays; an `end` of None is the clip's end. `blend_in` and `blend_out` are the
    /// seconds of blending from and to the stance, inside that part. For a looping stance, `blend_in` is the overlap at the
    /// loop's seam. `loop` repeats the part. From `earliest_exit` on, the next action may start; None plays the action to its
    /// end. `stroke` is its most expressive moment. `ready`, `stroke_end` and `relax` are the ends of a gesture's preparation,
    /// stroke and hold; its retraction ends with the action. None takes the times found from the motion
    /// (`playback.timing.phases`). `repeat` is the number of seconds for which a gesture or fidget repeats its part if no request
    /// says how long; it plays the nearest whole number of times. 0 plays it once.
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
        public readonly double Repeat;

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
            double? relax = null,
            double repeat = 0.0
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
            Repeat = repeat;
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
    /// A first-order model over (limb, kind). It writes meta actions when there are no requests (Borer et al., 7.3).
    ///
    /// `matrix` has rows of probabilities, each of which sums to 1. `gap` is the mean rest between two actions, in seconds.
    /// `positive` and `negative` are the shares of gestures that request that tag, if tags are not part of the states. `tags` has
    /// one text for each state: the tags it requests, with blanks between them; it is empty if tags are not part of the states.
    /// `lengths` has the mean and standard deviation of each state's actions, in seconds; it is empty if they are unknown.
    /// `modes` has one row for each mode, in the order of `words.MODES`: the shares, 0 to 1, of the written gestures, fidgets and
    /// transitions that are performed in that mode. Without the last two rows, thinking and reacting are as listening. It is
    /// empty if the mode makes no difference.
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

        /// <summary>Return the tags that a state requests, "" for none.</summary>
        public string Tag(int state)
        {
            return Tags.Count > 0 ? Tags[state] : "";
        }
    }

    /// <summary>
    /// The planner's constants.
    ///
    /// `alpha` says how quickly a used action becomes unlikely (4 in the paper). `seed` has 32 bits. With `never_twice`, an
    /// action is not played twice in a row if there is another. `shortest` is the minimum length, in seconds, of a remainder that
    /// is kept when a meta action is cut. `wait` is how many seconds late a request may start. `memory` is the number of seconds
    /// after which a use no longer counts, 0 for never (as in the paper). `rest` is the least number of seconds in the stance
    /// between two actions of a layer. A running plan is not changed for the next `lookahead` seconds. `variety`, 0..4,
    /// multiplies the times of `planning.director`, which decide how rarely actions repeat and stances change; 0 is as in the
    /// paper.
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
        public readonly double Variety;

        public Settings(
            double alpha = 4.0,
            int seed = 1,
            bool neverTwice = true,
            double shortest = 0.4,
            double wait = 4.0,
            double memory = 0.0,
            double rest = 0.0,
            double lookahead = 0.1,
            double variety = 1.0
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
            Variety = variety;
        }
    }
}
