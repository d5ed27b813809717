// Translated from metagraph/playback/life/sympathy.py; change that, and translate anew.
using System;
using System.Collections.Generic;
using System.Linq;

namespace Metagraph
{
    /// <summary>A laugh of the other character, in seconds.</summary>
    public sealed class Laugh
    {
        public readonly double Start;
        public readonly double End;

        public Laugh(double start, double end)
        {
            Start = start;
            End = end;
        }
    }

    public static class SympathyRules
    {
        public const double Delay = 0.7; // seconds until a mood is taken up, at least; as much again by chance
        public const double Shortest = 0.5; // seconds: what passes sooner is not taken up
        public const double Hostile = 0.4; // of how much, for moods that are unpleasant and excited
        // Laughing along.
        public const double LaughDelay = 0.25; // seconds, at least; as much again by chance
        public const double LaughLasts = 2.6; // seconds, at least
        public const double LaughRings = 1.0; // seconds a smile stays after the other's laugh, at least; as much again by chance
        public const double LaughValence = 0.9;
        public const double LaughArousal = 0.45;

        /// <summary>
        /// Return the mood of a character that sees another's: `share`, 0..1, of the way to it; its own mood if the other's is
        /// neutral.
        /// </summary>
        public static Mood TakenUp(Mood own, Mood other, double share)
        {
            if (other.Valence == 0 && other.Arousal == 0)
            {
                return own;
            }
            var part = (other.Valence < 0 && other.Arousal > 0.3) ? share * Hostile : share;
            return new Mood(
                own.Valence + part * (other.Valence - own.Valence),
                own.Arousal + part * (other.Arousal - own.Arousal),
                own.Intensity
            );
        }

        /// <summary>
        /// Return the moods of a character that sees the other's, from 0 to `end` seconds, by start. own: its mood without the
        /// other; who: the key of the other, from which each delay is drawn.
        /// </summary>
        public static List<MoodFrom> MoodsTakenUp(Moods own, Moods other, double end, double share, uint seed, string who)
        {
            var edges = MoodRules.MoodEdges(other, 0.0, end);
            foreach (double edge in MoodRules.MoodEdges(own, 0.0, end))
            {
                if (!edges.Contains(edge))
                {
                    edges.Add(edge);
                }
            }
            edges = edges.OrderBy(x => x).ToList();
            var out_ = new List<MoodFrom>();
            foreach (var one in edges.Select((item, n) => (n, item)))
            {
                var n = one.Item1;
                var edge = one.Item2;
                var until = n + 1 < edges.Count ? edges[n + 1] : end;
                var mine = MoodRules.MoodAt(own, edge);
                var mood = TakenUp(mine, MoodRules.MoodAt(other, edge), share);
                if (until - edge < Shortest || mood.Like(mine))
                {
                    continue;
                }
                var late = edge <= 0 ? 0.0 : Delay + Delay * ChoiceRules.Uniform(seed, who, PlainText.Of(n), "mood");
                var start = Math.Min(edge + late, until);
                out_.Add(new MoodFrom(who + " mood " + PlainText.Of(n), start, mood.Valence, mood.Arousal, null, until));
            }
            return out_;
        }

        /// <summary>
        /// Return the moods of a character that laughs along with `share`, 0..1, of the other's laughs, by start.
        /// </summary>
        public static List<MoodFrom> LaughsAlong(Moods own, List<Laugh> laughs, double share, uint seed, string who)
        {
            var out_ = new List<MoodFrom>();
            foreach (var one in laughs.Select((item, n) => (n, item)))
            {
                var n = one.Item1;
                var laugh = one.Item2;
                if (ChoiceRules.Uniform(seed, who, PlainText.Of(n), "laugh") >= share)
                {
                    continue;
                }
                var start = laugh.Start + LaughDelay + LaughDelay * ChoiceRules.Uniform(seed, who, PlainText.Of(n), "late");
                var rings = LaughRings + LaughRings * ChoiceRules.Uniform(seed, who, PlainText.Of(n), "rings");
                var mine = MoodRules.MoodAt(own, start);
                out_.Add(new MoodFrom(
                    who + " laugh " + PlainText.Of(n),
                    start,
                    Math.Max(mine.Valence, LaughValence),
                    Math.Max(mine.Arousal, LaughArousal),
                    null,
                    Math.Max(start + LaughLasts, laugh.End + rings)
                ));
            }
            return out_;
        }
    }
}
