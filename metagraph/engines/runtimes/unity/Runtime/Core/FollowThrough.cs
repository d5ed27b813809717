// Translated from metagraph/playback/posing/follow_through.py; change that, and translate anew.
using System;
using System.Collections.Generic;
using System.Linq;

namespace Metagraph
{
    /// <summary>
    /// How the arms of a clip move their mass.
    ///
    /// `clip` is its id. `rows` has a row for each tenth of a second, relative to the base pose: how far the left arm shifts the
    /// centre of mass of the whole body to the left, up and ahead, the same for the right arm, and how far each collar bone lags
    /// behind its arm; in units of `UNIT`.
    /// </summary>
    public sealed class ArmTrack
    {
        public readonly string Clip;
        public readonly List<List<double>> Rows;

        public ArmTrack(string clip, List<List<double>> rows)
        {
            Clip = clip;
            Rows = rows;
        }
    }

    public static class FollowThroughRules
    {
        public const double Step = 0.08; // seconds between the sampled times; the answer comes two of them late
        public const double Offset = 0.0111; // seconds by which they are shifted from whole steps, where cues begin and end
        public const int Knots = 4;
        public const double Rate = 10.0; // rows of a track in a second of its clip
        public const double Unit = 1e-05; // metres, or radians, of 1 in a row
        public const int Numbers = 8; // in a row

        /// <summary>Return the number of the last sampled time for a pose at `time`.</summary>
        public static int KnotBefore(double time)
        {
            return (int)Math.Floor((time - Offset) / Step);
        }

        /// <summary>Return the time of a sample, in seconds.</summary>
        public static double KnotTime(int number)
        {
            return number * Step + Offset;
        }

        /// <summary>
        /// Return how far the arms are from their stance at a time, as a row of a track, in metres and radians.
        ///
        /// `tracks` are by action. `hands` names the joints of the hands. `cue` is that of the arms' layer, if it has motion, and
        /// `place` the index of the rest in force, -1 for none; `body_cue` and `body_place` are the same for the body's layer. A
        /// cue whose clip the body's layer also shows moves the hips itself and does not count.
        /// </summary>
        public static List<double> ArmSway(
            Graph project,
            Dictionary<string, ArmTrack> tracks,
            List<string> hands,
            LayerPlan arms,
            Cue cue,
            int place,
            LayerPlan body,
            Cue bodyCue,
            int bodyPlace,
            double time
        )
        {
            var out_ = PlainNumbers.Range(Numbers).Select(n => 0.0).ToList();
            if (cue == null)
            {
                return out_;
            }
            var track = PlainMaps.Get(tracks, cue.Action.Id);
            if (track == null || track.Rows.Count == 0)
            {
                return out_;
            }
            var weight = CueTimesRules.CueWeight(cue, time);
            var share = cue.Extent * (1.0 - Shown(tracks, body, bodyCue, bodyPlace, track.Clip, time));
            if (weight <= 0.0 || share <= 0.0)
            {
                return out_;
            }
            var row = Row(track, CueTimesRules.CueSeconds(cue, time));
            var rest = Stance(project, tracks, arms, place, time);
            var entering = time < cue.Start + cue.BlendIn;
            if (cue.Repeats)
            {
                var back = CueTimesRules.SeamLeft(cue, time);
                var ends = Row(track, cue.CycleTo);
                var begins = Row(track, cue.CycleFrom);
                row = PlainNumbers.Range(Numbers).Select(n => row[n] + back * (ends[n] - begins[n])).ToList();
                row = PlainNumbers.Range(Numbers).Select(n => rest[n] + weight * (row[n] - rest[n])).ToList();
            }
            else if (entering || time >= cue.End - cue.BlendOut)
            {
                var edge = Row(track, entering ? cue.Entry : CueTimesRules.CueSeconds(cue, cue.End));
                row = PlainNumbers.Range(Numbers).Select(n => row[n] + (1.0 - weight) * (rest[n] - edge[n])).ToList();
            }
            var left = Moves(cue.Action, "left", hands[0]) ? share * Unit : 0.0;
            var right = Moves(cue.Action, "right", hands[1]) ? share * Unit : 0.0;
            for (int n = 0; n < Numbers; n++)
            {
                out_[n] = (row[n] - rest[n]) * ((n < 3 || n == 6) ? left : right);
            }
            return out_;
        }

        /// <summary>
        /// Return the eight numbers that move the body at a time, and their change per second. `sways` has the rows of the last
        /// `KNOTS` times before it.
        /// </summary>
        public static List<double> Driven(List<List<double>> sways, double time)
        {
            var u = (time - Offset) / Step;
            u = u - (int)Math.Floor(u);
            var back = 1.0 - u;
            var weights = new List<double> {
                back * back * back / 6.0,
                (3.0 * u * u * u - 6.0 * u * u + 4.0) / 6.0,
                (3.0 * u + 3.0 * u * u - 3.0 * u * u * u + 1.0) / 6.0,
                u * u * u / 6.0
             };
            var slopes = new List<double> {
                -back * back / 2.0,
                (3.0 * u * u - 4.0 * u) / 2.0,
                (1.0 + 2.0 * u - 3.0 * u * u) / 2.0,
                u * u / 2.0
             };
            var out_ = PlainNumbers.Range(2 * Numbers).Select(n => 0.0).ToList();
            for (int n = 0; n < Numbers; n++)
            {
                for (int k = 0; k < Knots; k++)
                {
                    out_[n] += weights[k] * sways[k][n];
                    out_[Numbers + n] += slopes[k] * sways[k][n] / Step;
                }
            }
            return out_;
        }

        /// <summary>Return whether an action moves an arm, instead of leaving it in the stance.</summary>
        private static bool Moves(GraphAction action, string side, string hand)
        {
            if (!new List<string> { "both", side }.Contains(action.Limb))
            {
                return false;
            }
            return action.Joints.Count == 0 || action.Joints.Contains(hand);
        }

        /// <summary>Return how much a layer shows of a clip, 0..1.</summary>
        private static double Shown(
            Dictionary<string, ArmTrack> tracks,
            LayerPlan plan,
            Cue cue,
            int place,
            string clip,
            double time
        )
        {
            var left = 1.0;
            var out_ = 0.0;
            if (cue != null)
            {
                var weight = CueTimesRules.CueWeight(cue, time);
                left = 1.0 - weight;
                if (IsOf(tracks, cue.Action, clip))
                {
                    out_ += weight;
                }
            }
            if (place >= 0)
            {
                var rest = plan.Rests[place];
                var over = 1.0;
                if (place > 0 && rest.FadeStart + rest.Fade > time)
                {
                    over = CueTimesRules.Ease((time - rest.FadeStart) / rest.Fade);
                    if (IsOf(tracks, plan.Rests[place - 1].Action, clip))
                    {
                        out_ += left * (1.0 - over);
                    }
                }
                if (IsOf(tracks, rest.Action, clip))
                {
                    out_ += left * over;
                }
            }
            return Math.Min(1.0, out_);
        }

        private static bool IsOf(Dictionary<string, ArmTrack> tracks, GraphAction action, string clip)
        {
            var track = PlainMaps.Get(tracks, action.Id);
            return track != null && track.Clip == clip;
        }

        /// <summary>Return the row of the stance under the cues.</summary>
        private static List<double> Stance(
            Graph project,
            Dictionary<string, ArmTrack> tracks,
            LayerPlan plan,
            int place,
            double time
        )
        {
            if (place < 0)
            {
                return PlainNumbers.Range(Numbers).Select(n => 0.0).ToList();
            }
            var rest = plan.Rests[place];
            var row = Loop(project, tracks, rest, time);
            if (place > 0 && rest.FadeStart + rest.Fade > time)
            {
                var over = CueTimesRules.Ease((time - rest.FadeStart) / rest.Fade);
                var before = Loop(project, tracks, plan.Rests[place - 1], time);
                row = PlainNumbers.Range(Numbers).Select(n => before[n] + (row[n] - before[n]) * over).ToList();
            }
            return row;
        }

        /// <summary>Return the row of a loop, with its end blended into its beginning.</summary>
        private static List<double> Loop(Graph project, Dictionary<string, ArmTrack> tracks, Rest rest, double time)
        {
            var track = PlainMaps.Get(tracks, rest.Action.Id);
            if (track == null || track.Rows.Count == 0)
            {
                return PlainNumbers.Range(Numbers).Select(n => 0.0).ToList();
            }
            var spot = CueTimesRules.LoopSpot(project, rest, time);
            var row = Row(track, spot.Seconds);
            if (spot.Over < 1.0)
            {
                var old = 1.0 - CueTimesRules.Ease(spot.Over);
                var before = Row(track, spot.Other);
                row = PlainNumbers.Range(Numbers).Select(n => row[n] + (before[n] - row[n]) * old).ToList();
            }
            return row;
        }

        /// <summary>Return a track's row at a second of the clip, interpolated linearly.</summary>
        private static List<double> Row(ArmTrack track, double seconds)
        {
            var last = track.Rows.Count - 1;
            var at = Math.Min(Math.Max(seconds * Rate, 0.0), last);
            var low = Math.Min((int)Math.Floor(at), Math.Max(0, last - 1));
            var part = at - low;
            var a = track.Rows[low];
            var b = track.Rows[Math.Min(low + 1, last)];
            return PlainNumbers.Range(Numbers).Select(n => a[n] + (b[n] - a[n]) * part).ToList();
        }
    }
}
