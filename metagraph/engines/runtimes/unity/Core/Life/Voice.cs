using System;
using System.Collections.Generic;
using System.Linq;

namespace Metagraph
{
    /// <summary>
    /// One line, analysed. Duration: seconds. Accents: times of its stressed syllables. Weights [K][15]: how much of each of
    /// Visemes the mouth shows, 0..1, at K times evenly spaced over 0..Duration, linear between them.
    /// </summary>
    public sealed class Voice
    {
        /// <summary>The 15 mouth shapes most rigs and lip-sync tools share (Oculus), silence first.</summary>
        public static readonly string[] Visemes = { "sil", "PP", "FF", "TH", "DD", "kk", "CH", "SS", "nn", "RR", "aa", "E", "I", "O", "U" };

        // How much a shape rules its neighbours: closed lips and teeth on the lip must be seen, tongue and palate need not.
        private static readonly double[] Rule = { 0.8, 6.0, 4.0, 1.0, 0.7, 0.5, 1.6, 1.2, 0.7, 0.9, 1.5, 1.3, 1.2, 1.7, 1.9 };
        private const double Early = 0.075, Late = 0.065; // seconds a shape comes before its sound begins and goes after it ends
        private const double Step = 1.0 / 50, Least = 0.02; // seconds between keys; how much rest rules everywhere
        private const double Accent = 2.0; // seconds round a stressed syllable without another

        public readonly double Duration;
        public readonly double[] Accents, Times;
        public readonly float[][] Weights;

        public Voice(double duration, double[] accents, float[][] weights)
        {
            Duration = duration;
            Accents = accents;
            Weights = weights;
            double step = Math.Max(duration, 1e-3) / (weights.Length - 1);
            Times = weights.Select((row, n) => n == weights.Length - 1 ? Math.Max(duration, 1e-3) : n * step).ToArray();
        }

        /// <summary>A voice guessed from letters alone; duration: seconds.</summary>
        public static Voice FromText(string text, double duration)
        {
            Spelled spelled = Letters.Read(text, duration);
            int count = Math.Max(2, (int)Math.Ceiling(spelled.Length / Step) + 1);
            var silence = new float[Visemes.Length];
            silence[0] = 1;
            if (spelled.Pieces.Count == 0)
            {
                return new Voice(spelled.Length, new double[0], new[] { silence, silence });
            }
            var voice = new Voice(spelled.Length, Stressed(spelled.Peaks, spelled.Strengths), new float[count][]);
            voice.Fill(spelled.Pieces);
            voice.Weights[0] = voice.Weights[count - 1] = silence; // shut at both ends
            return voice;
        }

        /// <summary>The first peak, then the loudest ones that have no louder one near.</summary>
        private static double[] Stressed(List<double> peaks, List<double> strengths)
        {
            var taken = new List<double>();
            IEnumerable<int> order = Enumerable.Range(0, peaks.Count)
                .OrderBy(i => i > 0).ThenByDescending(i => strengths[i]).ThenBy(i => peaks[i]);
            foreach (int i in order)
            {
                if (taken.All(t => Math.Abs(peaks[i] - t) >= Accent))
                {
                    taken.Add(peaks[i]);
                }
            }
            taken.Sort();
            return taken.ToArray();
        }

        /// <summary>
        /// Coarticulation: every piece rules the mouth around its own time, begins before it is heard and lingers after it; what the
        /// mouth shows is the mean of all pieces weighted by how much each rules.
        /// </summary>
        private void Fill(List<Piece> pieces)
        {
            int count = Times.Length;
            var made = new double[count];
            var rule = new double[count][];
            for (int k = 0; k < count; k++)
            {
                rule[k] = new double[Visemes.Length];
            }
            foreach (Piece piece in pieces)
            {
                int place = Array.IndexOf(Visemes, piece.Viseme);
                double half = Math.Min(0.5 * (piece.End - piece.Start), 0.04);
                for (int k = Basics.BisectLeft(Times, piece.Start - Early); k < Basics.BisectLeft(Times, piece.End + Late); k++)
                {
                    // Short sounds are not left out: their ramps overlap and still reach the top in the middle.
                    double rise = Basics.Ease((Times[k] - piece.Start + Early) / (Early + half));
                    double here = Math.Min(rise, Basics.Ease((piece.End + Late - Times[k]) / (Late + half)));
                    made[k] += here;
                    rule[k][place] += here * Rule[place] * piece.Strength;
                    rule[k][0] += here * Rule[place] * (1 - piece.Strength);
                }
            }
            for (int k = 0; k < count; k++)
            {
                rule[k][0] += Least + Rule[0] * Math.Max(1 - made[k], 0); // where no sound rules, rest does
                double sum = rule[k].Sum();
                Weights[k] = Array.ConvertAll(rule[k], x => (float)(x / sum));
            }
        }
    }
}
