// Translated from metagraph/playback/life/streamed_voice.py; change that, and translate anew.
using System;
using System.Collections.Generic;
using System.Linq;

namespace Metagraph
{
    /// <summary>
    /// The state of a voice that is analysed. rate: samples a second, 8000 or more. seconds: how much of it was heard. missed:
    /// seconds of the line in which no sound came. The other fields are memory.
    /// </summary>
    public sealed class StreamedVoice
    {
        public double Rate;
        public double Seconds;
        public double Missed;
        public string Shape;
        public double Told;
        public double Weight;
        public string Coming;
        public double Since;
        public double Loudest;
        public int Judged;
        public int Inside;
        public List<double> Filters;
        public List<double> Memory;
        public List<double> Energy;

        public StreamedVoice(
            double rate,
            double seconds = 0.0,
            double missed = 0.0,
            string shape = "sil",
            double told = 0.0,
            double weight = 1.0,
            string coming = "sil",
            double since = 0.0,
            double loudest = -120.0,
            int judged = 0,
            int inside = 0,
            List<double> filters = null,
            List<double> memory = null,
            List<double> energy = null
        )
        {
            Rate = rate;
            Seconds = seconds;
            Missed = missed;
            Shape = shape;
            Told = told;
            Weight = weight;
            Coming = coming;
            Since = since;
            Loudest = loudest;
            Judged = judged;
            Inside = inside;
            Filters = filters ?? new List<double>();
            Memory = memory ?? new List<double>();
            Energy = energy ?? new List<double>();
        }

        /// <summary>
        /// Analyse the next samples, -1..1; return the shapes that begin in them: visemes of the set "oculus", at seconds from
        /// the line's start.
        /// </summary>
        public List<VisemeMark> Hear(List<double> samples)
        {
            var out_ = new List<VisemeMark>();
            if (Filters.Count == 0)
            {
                Begin();
            }
            var size = Math.Max(1, (int)(StreamedVoiceRules.Hop * Rate));
            var count = Energy.Count;
            foreach (double sample in samples)
            {
                for (int band = 0; band < count; band++)
                {
                    // A band-pass of two poles, in the transposed direct form II.
                    var f = 3 * band;
                    var m = 2 * band;
                    var y = Filters[f] * sample + Memory[m];
                    Memory[m] = Memory[m + 1] - Filters[f + 1] * y;
                    Memory[m + 1] = -Filters[f] * sample - Filters[f + 2] * y;
                    Energy[band] = Energy[band] + y * y;
                }
                Inside += 1;
                if (Inside == size && Judge(size))
                {
                    out_.Add(new VisemeMark(Told + Missed, Shape, Weight));
                }
            }
            Seconds = ((double)(Judged * size + Inside) / Rate) + Missed;
            return out_;
        }

        /// <summary>Skip to where the line is if its sound came too late. said: seconds of the line that are over.</summary>
        public void Follow(double said)
        {
            if (Seconds < said - StreamedVoiceRules.Behind)
            {
                Missed += said - Seconds;
                Seconds = said;
            }
        }

        public void Begin()
        {
            foreach (var one in PlainLists.Pairs(StreamedVoiceRules.Hertz, StreamedVoiceRules.Quality))
            {
                var hertz = one.Item1;
                var quality = one.Item2;
                if (hertz <= StreamedVoiceRules.Highest * Rate)
                {
                    var turn = 2.0 * Math.PI * hertz / Rate;
                    var wide = Math.Sin(turn) / (2.0 * quality);
                    Filters.Add(wide / (1.0 + wide));
                    Filters.Add(-2.0 * Math.Cos(turn) / (1.0 + wide));
                    Filters.Add((1.0 - wide) / (1.0 + wide));
                    Memory.Add(0.0);
                    Memory.Add(0.0);
                    Energy.Add(0.0);
                }
            }
        }

        /// <summary>Classify the last moment; return whether a shape begins or changes, at `told`.</summary>
        public bool Judge(int size)
        {
            var now = ((double)(Judged * size) / Rate);
            var levels = Energy.Select(energy => 10.0 / Math.Log(10.0) * Math.Log(energy / size + 1e-12)).ToList();
            for (int band = 0; band < Energy.Count; band++)
            {
                Energy[band] = 0.0;
            }
            Inside = 0;
            Judged += 1;
            var voiced = Math.Max(levels[0], Math.Max(levels[1], levels[2]));
            Loudest = Math.Max(voiced, Math.Max(StreamedVoiceRules.Loudest, Loudest - StreamedVoiceRules.Forget * size / Rate));
            var shape = ShapeOf(levels);
            if (shape != Coming)
            {
                Coming = shape;
                Since = now;
            }
            var weight = 1.0;
            if (shape != "sil" && shape != "SS" && shape != "nn")
            {
                weight = 0.35 + 0.65 * Math.Min(1.0, Math.Max(0.0, 1.0 + (voiced - Loudest) / -StreamedVoiceRules.Sonorous));
            }
            var begins = shape != Shape && now + ((double)size / Rate) - Since >= StreamedVoiceRules.Least;
            if (begins
                || (shape == Shape
                    && Math.Abs(weight - Weight) >= StreamedVoiceRules.Grows
                    && now - Told >= StreamedVoiceRules.Step))
            {
                Shape = shape;
                Told = begins ? Since : now;
                Weight = weight;
                return true;
            }
            return false;
        }

        /// <summary>Return the shape of a moment. levels: dB of the bands, without the highest band at low rates.</summary>
        public string ShapeOf(List<double> levels)
        {
            var low = levels[0];
            var middle = levels[1];
            var high = levels[2];
            if (levels.Count > 3
                && levels[3] > Loudest + StreamedVoiceRules.Hissing
                && levels[3] > Math.Max(low, middle) + StreamedVoiceRules.Hiss)
            {
                return "SS";
            }
            var loud = Math.Max(low, Math.Max(middle, high)) - Loudest;
            if (loud < StreamedVoiceRules.Shut)
            {
                return "sil";
            }
            if (loud < StreamedVoiceRules.Sonorous)
            {
                return "nn";
            }
            if (middle - low > StreamedVoiceRules.Open)
            {
                return "aa";
            }
            if (middle - low > StreamedVoiceRules.Half)
            {
                return high - middle > StreamedVoiceRules.FrontHalf ? "E" : "O";
            }
            return high - middle > StreamedVoiceRules.Front ? "I" : "U";
        }
    }

    public static class StreamedVoiceRules
    {
        public const double Hop = 0.01; // seconds that are judged together
        public static readonly List<double> Hertz = new List<double> { 300.0, 800.0, 2200.0, 5000.0 }; // middles of the bands
        public static readonly List<double> Quality = new List<double> { 0.7, 1.0, 1.0, 0.7 }; // and how narrow they are
        public const double Highest = 0.42; // of the rate: bands higher than this are left out
        public static readonly double Loudest = -32.0; // dB of full scale: a voice is taken to be at least as loud as this
        public const double Forget = 3.0; // dB a second by which the loudest is forgotten
        public static readonly double Shut = -25.0; // dB beside the loudest: softer than this the mouth is shut
        public static readonly double Sonorous = -16.0; // louder than this it is open
        public static readonly double Hissing = -33.0; // softer than this nothing hisses
        public const double Hiss = 3.0; // dB by which the highest band is above the lower ones where it does
        public static readonly double Open = -1.7; // dB of the second band beside the first: an open mouth, and
        public static readonly double Half = -5.0; // half open
        // dB of the third band beside the second: the tongue is in front, of half open mouths
        public static readonly double FrontHalf = -6.0;
        public static readonly double Front = -8.5; // and of others
        public const double Least = 0.03; // seconds: anything shorter is not a shape
        public const double Step = 0.06; // seconds after which a shape that gets stronger or weaker
        public const double Grows = 0.15; // by this much is reported again
        public const double Behind = 0.25; // seconds by which a piece may come late; a later one is heard when it comes
    }
}
