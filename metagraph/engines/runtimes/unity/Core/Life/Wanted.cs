using System;
using System.Collections.Generic;
using System.Linq;

namespace Metagraph
{
    /// <summary>What is looked at from Start on. Since: when the look at it began; its place may have changed meanwhile.</summary>
    public sealed class Target
    {
        public double Start, Since, Amount = 1.0;
        public Spot To;
        public bool Strict, Asked;

        /// <summary>Whether it is the same but for its times.</summary>
        public bool Like(Target other)
        {
            return To.Same(other.To) && Amount == other.Amount && Strict == other.Strict && Asked == other.Asked;
        }
    }

    /// <summary>What was asked of the life layers, as segments in time: which mode the character is in, and what it looks at.</summary>
    internal static class Wanted
    {
        public const string Partner = "user"; // whom the character talks with, and looks at when nothing else is asked for
        public const string Ahead = "ahead"; // nothing in particular: eyes and head as the layers have them

        /// <summary>The mode asked for; where none is, talking while something is said and idle otherwise.</summary>
        private static string ModeAt(Track track, double seconds)
        {
            return track.ToldMode(seconds) ?? "idle";
        }

        /// <summary>Start and place among the modes of each mode from `start` to before `end`; the first begins at `start`.</summary>
        public static void Modes(Track track, double start, double end, List<double> starts, List<double[]> places)
        {
            var edges = new HashSet<double> { start };
            edges.UnionWith(track.Modes.Select(m => m.Start));
            edges.UnionWith(track.Speeches.Select(s => s.Start));
            edges.UnionWith(track.Speeches.Select(s => s.End));
            int last = -1;
            foreach (double edge in edges.Where(e => start <= e && e < end).OrderBy(e => e))
            {
                int mode = Array.IndexOf(Basics.Modes, ModeAt(track, edge));
                if (mode != last)
                {
                    starts.Add(edge);
                    places.Add(new double[] { mode });
                }
                last = mode;
            }
        }

        private struct Change
        {
            public double At;
            public int Kind; // what ends comes before what begins at the same time: 0 end, 1 look, 2 place, 3 here we start
            public Item What;
        }

        /// <summary>
        /// What is looked at from `start` to before `end`; the first begins at `start`. The latest look holds until it ends or another
        /// of its importance or more begins; a lesser one waits beneath.
        /// </summary>
        public static IEnumerable<Target> Targets(Track track, double start, double end)
        {
            IEnumerable<Change> every = track.Looks.Select(x => new Change { At = x.Start, Kind = 1, What = x })
                .Concat(track.Looks.Select(x => new Change { At = x.End, Kind = 0, What = x }))
                .Concat(track.Places.Select(p => new Change { At = p.Start, Kind = 2, What = p }))
                .Concat(new[] { new Change { At = start, Kind = 3 } });
            List<Change> changes = every.OrderBy(c => c.At).ThenBy(c => c.Kind).ToList();
            var looks = new List<LookAt>(); // the most important first; those beneath are older or lesser
            var places = new Dictionary<string, Spot>();
            Target last = null;
            LookAt chosen = null;
            double since = 0.0;
            for (int n = 0; n < changes.Count && changes[n].At < end; n++)
            {
                Change change = changes[n];
                if (change.Kind == 1)
                {
                    looks.RemoveAll(x => x.Priority <= ((LookAt)change.What).Priority);
                    if (change.What.End > change.What.Start)
                    {
                        looks.Add((LookAt)change.What);
                    }
                }
                else if (change.Kind == 0)
                {
                    looks.RemoveAll(x => ReferenceEquals(x, change.What));
                }
                else if (change.Kind == 2)
                {
                    places[((PlaceFrom)change.What).Name] = ((PlaceFrom)change.What).Point;
                }
                LookAt first = looks.Count > 0 ? looks[0] : null;
                since = ReferenceEquals(chosen, first) ? since : change.At;
                chosen = first;
                if (change.At < start || (n + 1 < changes.Count && changes[n + 1].At == change.At))
                {
                    continue;
                }
                Target target = TargetOf(change.At, since, chosen, places);
                if (last == null || !target.Like(last))
                {
                    yield return target;
                    last = target;
                }
            }
        }

        private static Target TargetOf(double at, double since, LookAt look, Dictionary<string, Spot> places)
        {
            Spot to = look == null ? new Spot(Partner) : look.To, place;
            to = to.Name != null && places.TryGetValue(to.Name, out place) ? place : to;
            return look == null
                ? new Target { Start = at, To = to, Since = since }
                : new Target { Start = at, To = to, Since = since, Amount = look.Amount, Strict = look.Strict, Asked = true };
        }
    }
}
