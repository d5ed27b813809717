// Translated from metagraph/playback/life/wanted.py; change that, and translate anew.
using System;
using System.Collections.Generic;
using System.Linq;

namespace Metagraph
{
    /// <summary>
    /// The target of the gaze from `start` on: a point, or a name whose place the project knows. since: when the look at it
    /// began; its place may have changed meanwhile. asked: whether a request set it.
    /// </summary>
    public sealed class GazeTarget
    {
        public readonly double Start;
        public readonly Spot To;
        public readonly double Since;
        public readonly double Amount;
        public readonly bool Strict;
        public readonly bool Asked;

        public GazeTarget(double start, Spot to, double since = 0.0, double amount = 1.0, bool strict = false, bool asked = false)
        {
            Start = start;
            To = to;
            Since = since;
            Amount = amount;
            Strict = strict;
            Asked = asked;
        }

        /// <summary>Return whether it is the same apart from its times.</summary>
        public bool Like(GazeTarget other)
        {
            if (Amount != other.Amount || Strict != other.Strict || Asked != other.Asked)
            {
                return false;
            }
            return SpotsRules.IsSameSpot(To, other.To);
        }
    }

    public static class WantedRules
    {
        public const string Partner = "user"; // whom the character talks with, and looks at when nothing else is asked for
        public const string Ahead = "ahead"; // nothing in particular: eyes and head as the layers have them
        // What changes what is looked at; of one time in this order.
        public const int Over = 0;
        public const int Look = 1;
        public const int Place = 2;
        public const int Begin = 3;

        /// <summary>Return the requested mode; without one, talking while something is said and idle otherwise.</summary>
        public static string ModeAt(Track track, double seconds)
        {
            var told = track.ToldMode(seconds);
            return told == null ? "idle" : told;
        }

        /// <summary>
        /// Return (start, place among MODES) of each mode from `start` to before `end`; the first begins at `start`.
        /// </summary>
        public static List<(double, int)> ModesBetween(Track track, double start, double end)
        {
            var edges = new List<double> { start };
            edges.AddRange(track.Modes.Select(m => m.Start).ToList());
            edges.AddRange(track.Speeches.Select(s => s.Start).ToList());
            edges.AddRange(track.Speeches.Select(s => s.End).ToList());
            var out_ = new List<(double, int)>();
            var last = -1;
            foreach (double edge in edges.Where(e => start <= e && e < end).ToList().OrderBy(x => x).ToList())
            {
                var mode = WordsRules.Modes.IndexOf(ModeAt(track, edge));
                if (mode != last)
                {
                    out_.Add((edge, mode));
                }
                last = mode;
            }
            return out_;
        }

        /// <summary>Return the moods of a character: the one set in its life layers, and those requested over time.</summary>
        public static Moods MoodsOf(LifeSettings life, Track track)
        {
            return new Moods(new Mood(life.Valence, life.Arousal, life.Intensity), track.Moods);
        }

        /// <summary>Return (start, mood) of each mood from `start` to before `end`; the first begins at `start`.</summary>
        public static List<(double, Mood)> MoodsBetween(Moods moods, double start, double end)
        {
            var out_ = new List<(double, Mood)>();
            foreach (double edge in MoodRules.MoodEdges(moods, start, end))
            {
                var mood = MoodRules.MoodAt(moods, edge);
                if (out_.Count == 0 || !mood.Like(out_[out_.Count - 1].Item2))
                {
                    out_.Add((edge, mood));
                }
            }
            return out_;
        }

        /// <summary>Return the factors of the amounts for a mode and a mood.</summary>
        public static Manner WaysIn(Manner ways, Mood mood)
        {
            if (mood.Neutral)
            {
                return ways;
            }
            var of = MoodRules.LifeOf(mood);
            return LifeRules.Scaled(ways, of.Breathing, of.BreathRate, of.AversionRate, of.SaccadeRate, of.Blinks);
        }

        /// <summary>
        /// Return the targets of the gaze from `start` to before `end`; the first begins at `start`.
        ///
        /// The latest look holds until it ends or another of at least the same importance begins; a less important one waits.
        /// </summary>
        public static List<GazeTarget> TargetsBetween(Track track, double start, double end)
        {
            var changes = track.Looks.Select((x, n) => (x.Start, Look, n)).ToList();
            changes.AddRange(track.Looks.Select((x, n) => (x.End, Over, n)).ToList());
            changes.AddRange(track.Places.Select((item, n) => (n, item)).Where(pair => pair.Item2.Start >= start).Select(pair => (
                pair.Item2.Start,
                Place,
                pair.Item1
            )).ToList());
            changes.Add((start, Begin, 0));
            changes = changes.OrderBy(c => c.Item1).ThenBy(c => c.Item2).ToList();
            var looks = new List<int>(); // indices of looks, the most important first; the others are older or less important
            var places = new Dictionary<string, List<double>>();
            foreach (PlaceFrom place in track.Places) // a point that is sent again and again has thousands
            {
                if (place.Start < start)
                {
                    places[place.Name] = place.Point;
                }
            }
            var chosen = -1;
            var since = 0.0;
            var out_ = new List<GazeTarget>();
            for (int n = 0; n < changes.Count; n++)
            {
                var found = changes[n];
                double at = found.Item1;
                int kind = found.Item2;
                int which = found.Item3;
                if (at >= end)
                {
                    break;
                }
                if (kind == Look)
                {
                    var look = track.Looks[which];
                    looks = looks.Where(x => track.Looks[x].Priority > look.Priority).ToList();
                    if (look.End > look.Start)
                    {
                        looks.Add(which);
                    }
                }
                else if (kind == Over)
                {
                    looks = looks.Where(x => x != which).ToList();
                }
                else if (kind == Place)
                {
                    places[track.Places[which].Name] = track.Places[which].Point;
                }
                var first = looks.Count > 0 ? looks[0] : -1;
                if (chosen != first)
                {
                    chosen = first;
                    since = at;
                }
                if (at < start || (n + 1 < changes.Count && changes[n + 1].Item1 == at))
                {
                    continue;
                }
                var target = Target(at, since, chosen < 0 ? null : track.Looks[chosen], places);
                if (out_.Count == 0 || !target.Like(out_[out_.Count - 1]))
                {
                    out_.Add(target);
                }
            }
            return out_;
        }

        private static GazeTarget Target(double at, double since, LookAt look, Dictionary<string, List<double>> places)
        {
            if (look == null)
            {
                return new GazeTarget(at, SpotsRules.Placed(places, SpotsRules.Named(Partner)), since);
            }
            return new GazeTarget(at, SpotsRules.Placed(places, look.To), since, look.Amount, look.Strict, true);
        }
    }
}
