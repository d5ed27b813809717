using System;
using System.Collections.Generic;
using System.Linq;
using System.Runtime.CompilerServices;

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
            return From(GraphemesRules.Spelled(Alphabet.Common, text, duration), duration);
        }

        /// <summary>The voice of a line whose words and shapes are told with their times.</summary>
        public static Voice FromTiming(LineTiming timing, double duration)
        {
            return From(LineTimingRules.TimedSounds(Alphabet.Common, timing), duration);
        }

        private static Voice From(Spelled said, double duration)
        {
            List<List<double>> rows = MouthRules.MouthTrack(said.Pieces, said.Pieces.Count > 0 ? duration : 0.0);
            float[][] weights = rows.Select(row => row.Select(weight => (float)weight).ToArray()).ToArray();
            return new Voice(duration, MouthRules.AccentsOf(said.Peaks, said.Strengths).ToArray(), weights);
        }
    }

    /// <summary>
    /// How lines sound: as their words and shapes were told, as an export has them by their ids, else guessed from text. What was
    /// made is remembered for as long as it is said.
    /// </summary>
    public sealed class Voices
    {
        public readonly Dictionary<string, Voice> Known = new Dictionary<string, Voice>();
        private readonly ConditionalWeakTable<Speech, Voice> made = new ConditionalWeakTable<Speech, Voice>();
        private static readonly ConditionalWeakTable<Speech, Voice>.CreateValueCallback Made = speech =>
        {
            double length = Math.Max(0.0, ItemsRules.MeasureLine(speech));
            return speech.Timing != null ? Voice.FromTiming(speech.Timing, length) : Voice.FromText(speech.Text, length);
        };

        /// <summary>The voice of something said.</summary>
        public Voice Of(Speech speech)
        {
            Voice known;
            if (speech.Timing == null && speech.Line != null && Known.TryGetValue(speech.Line, out known))
            {
                return known;
            }
            return made.GetValue(speech, Made);
        }
    }

    /// <summary>What planning asks of voices.</summary>
    public static class VoiceRules
    {
        /// <summary>Times of the stressed syllables of something said.</summary>
        public static List<double> Stressed(Voices voices, Speech speech)
        {
            return voices.Of(speech).Accents.ToList();
        }

        public static bool AreSameVoices(Voices one, Voices other)
        {
            return one == other;
        }
    }
}
