// Translated from metagraph/playback/planning/drawing.py; change that, and translate anew.
using System;
using System.Collections.Generic;
using System.Linq;

namespace Metagraph
{
    /// <summary>
    /// The draw of one action among the candidates that did not play too recently (Borer et al., section 6.2).
    /// </summary>
    public static class DrawingRules
    {
        /// <summary>
        /// Draw with p_k ~ likelihood_k / max(c_k, 1), times the factors of mood and variety. Actions used too recently are left
        /// out as long as others are left.
        /// </summary>
        public static GraphAction DrawAction(LayerState state, List<GraphAction> candidates, string key, double now, Mood mood)
        {
            var left = KeepSpaced(state, candidates);
            if (left.Count == 1)
            {
                return left[0];
            }
            var neutral = mood.Neutral;
            var weights = new Dictionary<string, double>();
            foreach (GraphAction a in left)
            {
                var favoured = neutral ? 1.0 : MoodRules.Favour(mood, a.Tags, VigourRules.MeasureVigour(state.Project, a));
                var weight = a.Likelihood / Math.Max(CountUses(state, a.Id, now), 1.0) * favoured;
                weights[a.Id] = weight * DirectingRules.WeighVariety(state, a, now);
            }
            if (!weights.Values.ToList().Any(w => w > 0))
            {
                return left[0];
            }
            var chosen = ChoiceRules.Pick(state.Seed, key, "action", weights);
            return left.Where(a => a.Id == chosen).First();
        }

        /// <summary>
        /// Leave out actions that need more other actions before they play again. If nothing is left, all need one less, and so
        /// on.
        /// </summary>
        public static List<GraphAction> KeepSpaced(LayerState state, List<GraphAction> candidates)
        {
            var default_ = state.Project.Settings.NeverTwice ? 1 : 0;
            var first = candidates[0];
            var before = PlainMaps.GetOr(state.Recent, RememberingRules.Node(first.Stance, first.Kind), new List<string>());
            if (candidates.Count < 2 || before.Count == 0)
            {
                return candidates;
            }
            var needs = candidates.Select(a => (a.Id, a.Spacing == null ? default_ : a.Spacing.Value)).ToMap();
            for (int less = 0; less < PlainNumbers.MaxOf(candidates.Select(a => needs[a.Id]).ToList()) + 1; less++)
            {
                var left = candidates.Where(a => RememberingRules.Rested(before, a.Id, needs[a.Id] - less)).ToList();
                if (left.Count > 0)
                {
                    return left;
                }
            }
            return candidates;
        }

        /// <summary>Return c_k of section 6.2, alpha times the uses, over the settings' memory.</summary>
        public static double CountUses(LayerState state, string ident, double now)
        {
            var memory = state.Project.Settings.Memory;
            var alpha = state.Project.Settings.Alpha;
            if (memory <= 0)
            {
                return alpha * PlainMaps.GetOr(state.Uses, ident, 0);
            }
            var used = 0;
            foreach (Cue cue in state.Cues.AsEnumerable().Reverse().ToList())
            {
                if (cue.Start < now - memory)
                {
                    break;
                }
                if (cue.Action.Id == ident)
                {
                    used += 1;
                }
            }
            return alpha * used;
        }

        /// <summary>Return the time from which an action may be drawn again.</summary>
        public static double FindCooled(LayerState state, GraphAction action)
        {
            if (action.Cooldown > 0 && state.Ended.ContainsKey(action.Id))
            {
                return state.Ended[action.Id] + action.Cooldown;
            }
            return double.NegativeInfinity;
        }
    }
}
