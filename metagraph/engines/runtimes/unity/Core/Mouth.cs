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
        // How much each of VISEMES rules its neighbours: closed lips and teeth on the lip must be seen, tongue and
        // palate need not.
        public static readonly List<double> Rule = new List<double> {
            0.8,
            6.0,
            4.0,
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
        public const double Early = 0.075; // seconds over which a shape comes before its sound begins
        public const double Late = 0.065; // and goes after it ends
        public const double Step = 0.02; // seconds between the rows of a track
        public const double Least = 0.02; // how much rest rules everywhere
        public const double Accent = 2.0; // seconds round a stressed syllable without another: blinks come as often as people's

        /// <summary>
        /// Return rows `[K][15]` of the shapes' weights, summing to 1; shut at both ends. Their times are evenly spaced from 0 to
        /// the duration, at least 1 ms.
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
            foreach (MouthPiece piece in pieces)
            {
                var place = WordsRules.Visemes.IndexOf(piece.Viseme);
                // Short sounds are not left out: their ramps overlap and still reach the top in the middle.
                var inside = Math.Min(0.5 * (piece.End - piece.Start), 0.04);
                var first = Math.Max(0, (int)Math.Ceiling((piece.Start - Early) / step));
                for (int k = first; k < Math.Min(count, (int)Math.Ceiling((piece.End + Late) / step)); k++)
                {
                    var rise = Ease((k * step - piece.Start + Early) / (Early + inside));
                    var fall = Ease((piece.End + Late - k * step) / (Late + inside));
                    var here = Math.Min(rise, fall);
                    made[k] += here;
                    rows[k][place] += here * Rule[place] * piece.Strength;
                    rows[k][0] += here * Rule[place] * (1 - piece.Strength);
                }
            }
            var out_ = new List<List<double>> { Rest() };
            for (int k = 1; k < count - 1; k++)
            {
                rows[k][0] += Least + Rule[0] * Math.Max(1 - made[k], 0.0); // where no sound rules, rest does
                var whole = rows[k].Sum();
                out_.Add(rows[k].Select(weight => weight / whole).ToList());
            }
            out_.Add(Rest());
            return out_;
        }

        /// <summary>Return the weights of a shut mouth.</summary>
        public static List<double> Rest()
        {
            return PlainNumbers.Range(WordsRules.Visemes.Count).Select(n => n == 0 ? 1.0 : 0.0).ToList();
        }

        /// <summary>
        /// Return the times of stressed syllables: the first peak, then the strongest that have no stronger one within `ACCENT`
        /// seconds. People blink and gesture on these, not on every syllable.
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
