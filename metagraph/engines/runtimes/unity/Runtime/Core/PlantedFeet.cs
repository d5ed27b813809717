// Translated from metagraph/playback/posing/planted_feet.py; change that, and translate anew.
using System;
using System.Collections.Generic;
using System.Linq;

namespace Metagraph
{
    /// <summary>
    /// Where a clip's feet are.
    ///
    /// `rows` has a row for each tenth of a second, with the left foot and then the right: whether it stands (0 to 1), its
    /// joint's position and rotation in the character's space; in units of `FOOT_UNIT`.
    /// </summary>
    public sealed class FootTrack
    {
        public readonly List<List<double>> Rows;

        public FootTrack(List<List<double>> rows)
        {
            Rows = rows;
        }
    }

    public static class PlantedFeetRules
    {
        public const double FootRate = 10.0; // rows of a track in a second of its clip
        public const double FootUnit = 1e-05; // the value of 1 in a row
        public const int FootNumbers = 8; // in a row, for each foot
        public const double Stepping = 0.5; // seconds that two steps take if a cue leaves them time
        public const double LeastPart = 0.15; // of that time for the foot with the shorter way
        public const double Nearby = 0.015; // metres: feet with a shorter way move together, slowly
        public const double Waits = 0.12; // of a step's time: the foot is lifted before it moves and lowered after it
        public const double Lift = 0.25; // how high a foot is lifted for a short step, as a share of its way
        public const double MostLift = 0.08; // metres: the limit that no foot reaches
        public const double Far = 0.25; // of the height: no foot steps that much farther
        public const double TooFar = 0.1;
        public const double Quick = 0.65; // of the height, a second: above, feet step less and glide more
        public const double TooQuick = 0.2; // as much quicker, they only glide

        /// <summary>
        /// Return where both feet should be at a time; an empty list if nothing blends or it is unknown.
        ///
        /// `tracks` are by action. `height` is the figure's. `plan` is the body's layer. `cue` is the one that plays, if it has
        /// motion, and `place` the index of the rest in force, -1 for none.
        /// </summary>
        public static List<FootGoal> FootGoals(
            Graph project,
            Dictionary<string, FootTrack> tracks,
            double height,
            LayerPlan plan,
            Cue cue,
            int place,
            double time
        )
        {
            if (place < 0)
            {
                return new List<FootGoal>();
            }
            if (cue == null)
            {
                if (!Changes(project, plan, place, time))
                {
                    return new List<FootGoal>();
                }
                return Stance(project, tracks, height, plan, place, time);
            }
            var track = PlainMaps.Get(tracks, cue.Action.Id);
            var masked = cue.Action.Joints.Count > 0 || cue.Action.JointWeights.Count > 0;
            if (track == null || track.Rows.Count == 0 || masked)
            {
                return new List<FootGoal>();
            }
            var came = cue.Start + Entering(track, cue);
            var goes = cue.End - Leaving(track, cue);
            if (time >= came && time < goes)
            {
                return new List<FootGoal>();
            }
            var here = FootRow(track, CueTimesRules.CueSeconds(cue, time));
            double at = default(double);
            List<FootGoal> first = default(List<FootGoal>);
            List<FootGoal> last = default(List<FootGoal>);
            if (time < came)
            {
                at = Math.Min(time, cue.Start + cue.BlendIn);
                var before = Stance(project, tracks, height, plan, place, at);
                first = Stance(project, tracks, height, plan, place, cue.Start);
                last = FootRow(track, CueTimesRules.CueSeconds(cue, came));
                return Stepped(height, before, here, first, last, time - cue.Start, came - cue.Start);
            }
            at = Math.Max(time, cue.End - cue.BlendOut);
            var after = Stance(project, tracks, height, plan, place, at);
            first = FootRow(track, CueTimesRules.CueSeconds(cue, goes));
            last = Stance(project, tracks, height, plan, place, cue.End);
            return Stepped(height, here, after, first, last, time - goes, cue.End - goes);
        }

        /// <summary>Return how long the feet take to enter a cue: its blend, and longer while it stands.</summary>
        private static double Entering(FootTrack track, Cue cue)
        {
            return Lasting(track, cue, cue.BlendIn, cue.Start, 1.0);
        }

        /// <summary>Return how long the feet take to leave a cue.</summary>
        private static double Leaving(FootTrack track, Cue cue)
        {
            return Lasting(track, cue, cue.BlendOut, cue.End, -1.0);
        }

        private static double Lasting(FootTrack track, Cue cue, double blend, double edge, double way)
        {
            if (blend <= 0.0)
            {
                return 0.0;
            }
            var spare = Math.Max(0.0, cue.End - cue.Start - cue.BlendIn - cue.BlendOut);
            var most = Math.Min(Stepping, blend + 0.5 * spare);
            var out_ = blend;
            var step = 1.0 / FootRate;
            while (out_ < most && Stands(track, CueTimesRules.CueSeconds(cue, edge + way * Math.Min(out_ + step, most))))
            {
                out_ = Math.Min(out_ + step, most);
            }
            return out_;
        }

        private static bool Stands(FootTrack track, double seconds)
        {
            var goals = FootRow(track, seconds);
            return goals[0].Planted >= 1.0 && goals[1].Planted >= 1.0;
        }

        /// <summary>
        /// Return both feet during a step, after `passed` of its `seconds`. `first` and `last` are their places when it begins
        /// and ends, which decide the order and size of the steps.
        /// </summary>
        public static List<FootGoal> Stepped(
            double height,
            List<FootGoal> before,
            List<FootGoal> after,
            List<FootGoal> first,
            List<FootGoal> last,
            double passed,
            double seconds
        )
        {
            if (before.Count == 0 || after.Count == 0 || first.Count == 0 || last.Count == 0)
            {
                return new List<FootGoal>();
            }
            var ways = new List<double>();
            for (int side = 0; side < 2; side++) // a foot that does not stand before or after needs no time for a step
            {
                var stands = first[side].Planted * last[side].Planted;
                ways.Add(stands * FeetSolveRules.FootWay(first[side], last[side]));
            }
            var part = 0.5;
            if (ways[0] + ways[1] > 0.0)
            {
                part = Math.Min(Math.Max(ways[0] / (ways[0] + ways[1]), LeastPart), 1.0 - LeastPart);
            }
            // To the left, the left foot goes first: the right foot would have to pass it.
            var moved = PlainVectorsRules.Plus(
                PlainVectorsRules.Minus(last[0].At, first[0].At),
                PlainVectorsRules.Minus(last[1].At, first[1].At)
            );
            var leftFirst = PlainVectorsRules.Dot(moved, PlainVectorsRules.Minus(first[0].At, first[1].At)) >= -1e-09;
            var longer = Math.Max(ways[0], ways[1]);
            var far = 1.0 - CueTimesRules.Ease((longer / height - Far) / TooFar);
            var apart = CueTimesRules.Ease(longer / Nearby);
            var shares = new List<double> { 1.0 - apart * (1.0 - part), 1.0 - apart * part };
            var quickest = Math.Max(ways[0] / shares[0], ways[1] / shares[1]);
            far *= 1.0 - CueTimesRules.Ease((quickest / (height * Math.Max(seconds, 0.001)) - Quick) / TooQuick);
            var u = seconds > 0.0 ? passed / seconds : 1.0;
            var out_ = new List<FootGoal>();
            for (int side = 0; side < 2; side++)
            {
                var share = shares[side];
                var begin = leftFirst == (side == 0) ? 0.0 : 1.0 - share;
                var x = Math.Min(Math.Max((u - begin) / share, 0.0), 1.0);
                var go = CueTimesRules.Ease((x - Waits) / (1.0 - 2.0 * Waits));
                var rise = Lift * ways[side];
                var air = 16.0 * x * x * (1.0 - x) * (1.0 - x) * rise / (1.0 + rise / MostLift);
                out_.Add(Mixed(before[side], after[side], go, air, far));
            }
            return out_;
        }

        /// <summary>Return a foot between two places.</summary>
        private static FootGoal Mixed(FootGoal a, FootGoal b, double x, double air, double share)
        {
            var found = a.Turn;
            double ax = found.Item1;
            double ay = found.Item2;
            double az = found.Item3;
            double aw = found.Item4;
            var found2 = b.Turn;
            double bx = found2.Item1;
            double by = found2.Item2;
            double bz = found2.Item3;
            double bw = found2.Item4;
            var k = ax * bx + ay * by + az * bz + aw * bw < 0.0 ? -x : x;
            var rest = 1.0 - x;
            var turn = PlainVectorsRules.UnitTurn(
                (ax * rest + bx * k, ay * rest + by * k, az * rest + bz * k, aw * rest + bw * k)
            );
            var at = PlainVectorsRules.Plus(a.At, PlainVectorsRules.Scaled(PlainVectorsRules.Minus(b.At, a.At), x));
            return new FootGoal(at, turn, share * a.Planted * b.Planted, a.Lift * rest + b.Lift * x + air);
        }

        /// <summary>Return the index of the rest in force at a time, searching from another.</summary>
        private static int Resting(LayerPlan plan, int place, double time)
        {
            while (place > 0 && plan.Rests[place].FadeStart > time)
            {
                place -= 1;
            }
            while (place + 1 < plan.Rests.Count && plan.Rests[place + 1].FadeStart <= time)
            {
                place += 1;
            }
            return place;
        }

        private static bool Fades(LayerPlan plan, int place, double time)
        {
            var rest = plan.Rests[place];
            return place > 0 && rest.FadeStart + rest.Fade > time;
        }

        /// <summary>Return whether a stance blends: between two rests, or at a loop's seam.</summary>
        private static bool Changes(Graph project, LayerPlan plan, int place, double time)
        {
            var rest = plan.Rests[place];
            if (Fades(plan, place, time))
            {
                return true;
            }
            return CueTimesRules.LoopSpot(project, rest, time).Over < 1.0;
        }

        /// <summary>Return where the feet of the stance under the cues are at a time.</summary>
        private static List<FootGoal> Stance(
            Graph project,
            Dictionary<string, FootTrack> tracks,
            double height,
            LayerPlan plan,
            int place,
            double time
        )
        {
            place = Resting(plan, place, time);
            var rest = plan.Rests[place];
            var goals = Loop(project, tracks, height, rest, time);
            if (!Fades(plan, place, time))
            {
                return goals;
            }
            var old = plan.Rests[place - 1];
            var ends = rest.FadeStart + rest.Fade;
            return Stepped(
                height,
                Loop(project, tracks, height, old, time),
                goals,
                Loop(project, tracks, height, old, rest.FadeStart),
                Loop(project, tracks, height, rest, ends),
                time - rest.FadeStart,
                rest.Fade
            );
        }

        /// <summary>Return where the feet of a loop are. They also go from its end to its beginning in steps.</summary>
        private static List<FootGoal> Loop(
            Graph project,
            Dictionary<string, FootTrack> tracks,
            double height,
            Rest rest,
            double time
        )
        {
            var track = PlainMaps.Get(tracks, rest.Action.Id);
            if (track == null || track.Rows.Count == 0)
            {
                return new List<FootGoal>();
            }
            var spot = CueTimesRules.LoopSpot(project, rest, time);
            var here = FootRow(track, spot.Seconds);
            if (spot.Over >= 1.0)
            {
                return here;
            }
            var seam = spot.Meets - project.Span(rest.Action).Item1;
            var before = FootRow(track, spot.Other);
            var leaves = FootRow(track, spot.Leaves);
            var meets = FootRow(track, spot.Meets);
            return Stepped(height, before, here, leaves, meets, spot.Over * seam, seam);
        }

        /// <summary>Return where a clip's feet are at a second of the clip, interpolated linearly.</summary>
        public static List<FootGoal> FootRow(FootTrack track, double seconds)
        {
            var last = track.Rows.Count - 1;
            var at = Math.Min(Math.Max(seconds * FootRate, 0.0), last);
            var low = Math.Min((int)Math.Floor(at), Math.Max(0, last - 1));
            var part = at - low;
            var a = track.Rows[low];
            var b = track.Rows[Math.Min(low + 1, last)];
            var v = PlainNumbers.Range(2 * FootNumbers).Select(n => FootUnit * (a[n] + (b[n] - a[n]) * part)).ToList();
            var out_ = new List<FootGoal>();
            for (int side = 0; side < 2; side++)
            {
                var n = FootNumbers * side;
                var turn = PlainVectorsRules.UnitTurn((v[n + 4], v[n + 5], v[n + 6], v[n + 7]));
                out_.Add(new FootGoal((v[n + 1], v[n + 2], v[n + 3]), turn, v[n], 0.0));
            }
            return out_;
        }
    }
}
