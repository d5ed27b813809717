// Translated from metagraph/playback/posing/contact_goals.py; change that, and translate anew.
using System;
using System.Collections.Generic;
using System.Linq;

namespace Metagraph
{
    /// <summary>
    /// Find the goals that contacts set for the hands at a time: contacts of the cue that plays and of the loops under it, each
    /// weighted by how much of it shows.
    /// </summary>
    public static class ContactGoalsRules
    {
        public const double Least = 1e-06; // of a hand: goals with less weight are not solved

        /// <summary>
        /// Return a layer's goals for the hands at a time.
        ///
        /// `cue` is the one that plays, if it has motion. `place` is the index of the rest in force, -1 for none. `strength` is
        /// how much of the arms the layer moves, 0..1.
        /// </summary>
        public static List<HandGoal> LayerGoals(
            ContactRig rig,
            Graph project,
            LayerPlan plan,
            Cue cue,
            int place,
            double time,
            double strength
        )
        {
            var out_ = new List<HandGoal>();
            var shown = new List<double> { 0.0, 0.0 };
            if (cue != null)
            {
                var weight = CueTimesRules.CueWeight(cue, time);
                foreach (var one in ContactSpansRules.Hands.Select((item, n) => (n, item)))
                {
                    var arm = one.Item1;
                    var hand = one.Item2;
                    if (Moves(rig, cue.Action, arm, hand))
                    {
                        shown[arm] = weight;
                    }
                }
                if (cue.Action.Contacts.Count > 0)
                {
                    var left = CueTimesRules.SeamLeft(cue, time);
                    if (left > 0.0) // the goals at the end of the previous cycle, as far as its pose still shows
                    {
                        out_.AddRange(Goals(
                            rig,
                            project,
                            cue.Action,
                            cue.CycleTo,
                            shown.Select(w => strength * left * w).ToList()
                        ));
                    }
                    var share = strength * (1.0 - left);
                    out_.AddRange(Goals(
                        rig,
                        project,
                        cue.Action,
                        CueTimesRules.CueSeconds(cue, time),
                        shown.Select(w => share * w).ToList()
                    ));
                }
            }
            if (place >= 0)
            {
                var rest = plan.Rests[place];
                var over = 1.0;
                if (place > 0 && rest.FadeStart + rest.Fade > time)
                {
                    over = CueTimesRules.Ease((time - rest.FadeStart) / rest.Fade);
                    out_.AddRange(LoopGoals(rig, project, plan.Rests[place - 1], time, strength * (1.0 - over), shown));
                }
                out_.AddRange(LoopGoals(rig, project, rest, time, strength * over, shown));
            }
            return out_;
        }

        /// <summary>Return a loop's goals for the hands, reduced by the cue above it.</summary>
        private static List<HandGoal> LoopGoals(
            ContactRig rig,
            Graph project,
            Rest rest,
            double time,
            double strength,
            List<double> shown
        )
        {
            var out_ = new List<HandGoal>();
            var action = rest.Action;
            if (action.Contacts.Count == 0)
            {
                return out_;
            }
            var left = shown.Select(w => strength * (1.0 - w)).ToList();
            var found = project.Span(action);
            double start = found.Item1;
            double end = found.Item2;
            var seam = Math.Min(Math.Max(0.0, action.Timing.BlendIn), (end - start) / 2.0);
            var period = end - start - seam;
            if (period <= 0.0)
            {
                return Goals(rig, project, action, start, left);
            }
            var elapsed = time - rest.Start;
            var phase = seam > 0.0 ? Math.Max(elapsed, 0.0) : elapsed;
            phase = phase - period * (int)Math.Floor(phase / period);
            var old = 0.0;
            if (seam > 0.0 && elapsed >= period)
            {
                old = 1.0 - CueTimesRules.Ease(phase / seam);
            }
            if (old > 0.0)
            {
                var before = start + Math.Min(period + phase, end - start);
                out_.AddRange(Goals(rig, project, action, before, left.Select(w => old * w).ToList()));
            }
            out_.AddRange(Goals(rig, project, action, start + phase, left.Select(w => (1.0 - old) * w).ToList()));
            return out_;
        }

        /// <summary>
        /// Return the goals of an action at a second of its clip. `shares` says how much of it shows at the left and the right
        /// hand.
        /// </summary>
        private static List<HandGoal> Goals(
            ContactRig rig,
            Graph project,
            GraphAction action,
            double seconds,
            List<double> shares
        )
        {
            var out_ = new List<HandGoal>();
            var found = project.Span(action);
            double start = found.Item1;
            double end = found.Item2;
            foreach (ContactSpan span in action.Contacts)
            {
                var arm = Arm(span);
                var to = PlainMaps.Get(rig.Places, span.To);
                if (to == null || span.Keys.Count == 0 || shares[arm] <= Least)
                {
                    continue;
                }
                var weight = shares[arm] * ContactSpansRules.ContactWeight(span, seconds, start, end);
                if (weight > Least)
                {
                    var key = ContactSpansRules.ContactKey(span, seconds);
                    out_.Add(new HandGoal(arm, to.Value, key.At, key.Turn, weight));
                }
            }
            return out_;
        }

        private static int Arm(ContactSpan span)
        {
            return span.Hand == "left" ? 0 : 1;
        }

        /// <summary>Return whether an action moves a hand, instead of leaving it in the stance.</summary>
        private static bool Moves(ContactRig rig, GraphAction action, int arm, string hand)
        {
            if (!new List<string> { "both", hand }.Contains(action.Limb))
            {
                return false;
            }
            return action.Joints.Count == 0 || action.Joints.Contains(rig.Hands[arm]);
        }
    }
}
