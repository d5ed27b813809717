// Translated from metagraph/playback/life/mouth.py; change that, and translate anew.
using System;
using System.Collections.Generic;
using System.Linq;

namespace Metagraph
{
    /// <summary>A sound from `start` to `end` seconds: its mouth shape and how fully it is made, 0..1.</summary>
    public sealed class MouthPiece
    {
        public readonly double Start;
        public readonly double End;
        public readonly string Viseme;
        public readonly double Strength;

        public MouthPiece(double start, double end, string viseme, double strength = 1.0)
        {
            Start = start;
            End = end;
            Viseme = viseme;
            Strength = strength;
        }
    }

    public static class MouthRules
    {
        // How much each of VISEMES rules its neighbours: tongue and palate need not be seen. What closes the mouth
        // does not take part in the mean.
        public static readonly List<double> Rule = new List<double> {
            0.8,
            0.0,
            0.0,
            1.0,
            0.7,
            0.5,
            1.6,
            1.2,
            0.7,
            0.9,
            1.5,
            1.3,
            1.2,
            1.7,
            1.9
         };
        public static readonly List<string> Closures = new List<string> { "PP", "FF" };
        public static readonly List<string> Vowels = new List<string> { "aa", "E", "I", "O", "U" };
        public static readonly List<string> Rounded = new List<string> { "O", "U" };
        public const double Early = 0.075; // seconds over which a shape comes before its sound begins
        public const double Late = 0.065; // and goes after it ends
        public const double Step = 0.02; // seconds between the rows of a track
        public const double LookAhead = 0.25; // seconds by which a rounded vowel may come before its sound
        public const double Pause = 0.03; // seconds without a sound that end a run of consonants
        public const double Held = 0.02; // seconds before and after its middle that a closure lasts at least: a row on each side
        public const double Shutting = 0.09; // seconds it takes to close and to open again
        public const double Parting = 0.03; // seconds one closure takes to make way for the other
        public const double Least = 0.02; // how much rest rules everywhere
        public const double Accent = 2.0; // seconds round a stressed syllable without another: blinks come as often as people's

        /// <summary>
        /// Return rows `[K][15]` of the shapes' weights, which sum to 1; the mouth is shut at both ends. Their times are evenly
        /// spaced from 0 to the duration, at least 1 ms.
        /// </summary>
        public static List<List<double>> MouthTrack(List<MouthPiece> pieces, double duration)
        {
            // as many for 0.88 s as languages that divide otherwise
            var count = Math.Max(2, (int)Math.Ceiling(duration / Step - 1e-06) + 1);
            var step = Math.Max(duration, 0.001) / (count - 1);
            var rows = PlainNumbers.Range(count).Select(row => PlainNumbers.Range(
                WordsRules.Visemes.Count
            ).Select(shape => 0.0).ToList()).ToList();
            var made = PlainNumbers.Range(count).Select(row => 0.0).ToList();
            var begun = 0.0;
            var last = -1.0; // of a run of consonants; where the sound before ended
            foreach (MouthPiece piece in pieces)
            {
                var place = WordsRules.Visemes.IndexOf(piece.Viseme);
                if (piece.Start - last > Pause)
                {
                    begun = piece.Start;
                }
                var early = Early;
                if (Rounded.Contains(piece.Viseme))
                {
                    early = Math.Min(Math.Max(piece.Start - begun, Early), LookAhead);
                }
                last = piece.End;
                if (Vowels.Contains(piece.Viseme))
                {
                    begun = piece.End;
                }
                // Short sounds are not left out: their ramps overlap and still reach the top in the middle.
                var inside = Math.Min(0.5 * (piece.End - piece.Start), 0.04);
                var first = Math.Max(0, (int)Math.Ceiling((piece.Start - early) / step));
                for (int k = first; k < Math.Min(count, (int)Math.Ceiling((piece.End + Late) / step)); k++)
                {
                    var rise = Ease((k * step - piece.Start + early) / (early + inside));
                    var fall = Ease((piece.End + Late - k * step) / (Late + inside));
                    var here = Math.Min(rise, fall);
                    made[k] += here;
                    rows[k][place] += here * Rule[place] * piece.Strength;
                    rows[k][0] += here * Rule[place] * (1 - piece.Strength);
                }
            }
            var shut = Closures.Select(name => Gates(pieces, name, count, step)).ToList();
            var out_ = new List<List<double>> { Rest() };
            for (int k = 1; k < count - 1; k++)
            {
                rows[k][0] += Least + Rule[0] * Math.Max(1 - made[k], 0.0); // where no sound rules, rest does
                var whole = rows[k].Sum();
                out_.Add(Closed(rows[k].Select(weight => weight / whole).ToList(), shut[0][k], shut[1][k]));
            }
            out_.Add(Rest());
            return out_;
        }

        /// <summary>Return rows (how far a closure has progressed, how far it suppresses the other one), 0..1.</summary>
        private static List<(double, double)> Gates(List<MouthPiece> pieces, string viseme, int count, double step)
        {
            var out_ = PlainNumbers.Range(count).Select(row => (0.0, 0.0)).ToList();
            foreach (MouthPiece piece in pieces)
            {
                if (piece.Viseme != viseme)
                {
                    continue;
                }
                var middle = 0.5 * (piece.Start + piece.End);
                var held = Math.Max(Held, 0.5 * (piece.End - piece.Start) - 0.01);
                var first = Math.Max(0, (int)Math.Ceiling((middle - held - Shutting) / step));
                for (int k = first; k < Math.Min(count, (int)Math.Ceiling((middle + held + Shutting) / step)); k++)
                {
                    var away = Math.Max(0.0, Math.Abs(k * step - middle) - held);
                    var wide = piece.Strength * Ease(1 - away / Shutting);
                    var narrow = piece.Strength * Ease(1 - away / Parting);
                    out_[k] = (Math.Max(out_[k].Item1, wide), Math.Max(out_[k].Item2, narrow));
                }
            }
            return out_;
        }

        /// <summary>Return a row with the closures on top: they suppress the rest as far as they are closed.</summary>
        private static List<double> Closed(List<double> row, (double, double) lips, (double, double) teeth)
        {
            var most = Math.Max(lips.Item1, teeth.Item1);
            if (most <= 0)
            {
                return row;
            }
            var one = lips.Item1 * (1 - teeth.Item2);
            var other = teeth.Item1 * (1 - lips.Item2);
            if (one + other <= 0)
            {
                one = lips.Item1;
                other = teeth.Item1;
            }
            var out_ = row.Select(weight => (1 - most) * weight).ToList();
            out_[1] += most * one / (one + other);
            out_[2] += most * other / (one + other);
            return out_;
        }

        /// <summary>
        /// Write the shapes without silence `[14]`, smoothed over three moments. Shapes that close the mouth keep their present
        /// weights, and the others share what is left: smoothing must not part lips that meet.
        /// </summary>
        public static void Soften(List<double> out_, List<double> before, List<double> now, List<double> after)
        {
            for (int n = 0; n < out_.Count; n++)
            {
                out_[n] = 0.25 * before[n] + 0.5 * now[n] + 0.25 * after[n];
            }
            var open = 1 - out_[0] - out_[1];
            out_[0] = now[0];
            out_[1] = now[1];
            var left = open > 1e-09 ? Math.Max(0.0, 1 - out_[0] - out_[1]) / open : 0.0;
            for (int n = 2; n < out_.Count; n++)
            {
                out_[n] *= Math.Min(1.0, left);
            }
        }

        /// <summary>Return the weights of a shut mouth.</summary>
        public static List<double> Rest()
        {
            return PlainNumbers.Range(WordsRules.Visemes.Count).Select(n => n == 0 ? 1.0 : 0.0).ToList();
        }

        /// <summary>
        /// Return the times of stressed syllables: the first peak, then those with no stronger one within `ACCENT` seconds.
        /// People blink and gesture on these, not on every syllable.
        /// </summary>
        public static List<double> AccentsOf(List<double> peaks, List<double> strengths)
        {
            var taken = new List<double>();
            foreach (int i in PlainNumbers.Range(peaks.Count).OrderBy(i => i == 0 ? 0 : 1).ThenBy(i => -strengths[i]).ThenBy(i => peaks[i]).ToList())
            {
                if (taken.All(t => Math.Abs(peaks[i] - t) >= Accent))
                {
                    taken.Add(peaks[i]);
                }
            }
            return taken.OrderBy(x => x).ToList();
        }

        private static double Ease(double x)
        {
            if (x <= 0)
            {
                return 0.0;
            }
            return x >= 1 ? 1.0 : x * x * (3 - 2 * x);
        }
    }
}
