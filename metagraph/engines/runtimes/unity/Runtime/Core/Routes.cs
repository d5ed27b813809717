// Translated from metagraph/playback/planning/routes.py; change that, and translate anew.
using System;
using System.Collections.Generic;
using System.Linq;

namespace Metagraph
{
    /// <summary>
    /// One action of a chain: the candidates for it and, for a transition on the way, the stance it leads to.
    /// </summary>
    public sealed class SamplingStep
    {
        public readonly List<GraphAction> Candidates;
        public readonly string Hop;

        public SamplingStep(List<GraphAction> candidates, string hop = "")
        {
            Candidates = candidates;
            Hop = hop;
        }
    }

    public static class RoutesRules
    {
        public static bool MayPlay(LayerState state, GraphAction action)
        {
            return action.Likelihood > 0 && Arrives(state, action);
        }

        /// <summary>Return whether an action leaves the layer in a stance that has a loop.</summary>
        public static bool Arrives(LayerState state, GraphAction action)
        {
            var end = action.EndStance;
            if (action.Kind != "transition")
            {
                return true;
            }
            return end != null && state.Graph.Stances.ContainsKey(end) && state.Graph.Of(end, "stance").Count > 0;
        }

        /// <summary>
        /// Return the stances after the current one on the shortest way of transitions that can play, the goal last; empty if
        /// there is no way. Among equally short ways, the one whose transitions were placed first.
        /// </summary>
        public static List<string> FindHops(LayerState state, string goal)
        {
            var before = new Dictionary<string, string> { { state.Stance, "" } };
            var queue = new List<string> { state.Stance };
            var at = 0; // what is before it was looked at
            while (at < queue.Count && !before.ContainsKey(goal))
            {
                var stance = queue[at];
                at += 1;
                foreach (GraphAction action in state.Graph.Of(stance, "transition"))
                {
                    var end = action.EndStance;
                    if (end == null || before.ContainsKey(end) || !state.Graph.Stances.ContainsKey(end))
                    {
                        continue;
                    }
                    if (MayPlay(state, action))
                    {
                        before[end] = stance;
                        queue.Add(end);
                    }
                }
            }
            var way = new List<string>();
            if (!before.ContainsKey(goal))
            {
                return way;
            }
            var step = goal;
            while (step != state.Stance)
            {
                way.Add(step);
                step = before[step];
            }
            return way.AsEnumerable().Reverse().ToList().ToList();
        }

        public static string NameElsewhere(LayerState state, MetaRequest request)
        {
            foreach (GraphAction action in state.Graph.Actions.Values.ToList())
            {
                var fits = action.Kind == request.Kind
                    && request.Tags.All(tag => action.Tags.Contains(tag))
                    && (request.Limb == null || request.Limb == action.Limb);
                if (fits && state.Graph.Stances.ContainsKey(action.Stance))
                {
                    return "; there is one in '" + state.Graph.Stances[action.Stance].Name + "'";
                }
            }
            return "";
        }

        /// <summary>Return one of a stance's loops, drawn by likelihood; None if it has none.</summary>
        public static GraphAction DrawLoop(LayerState state, string stance, string key)
        {
            var loops = state.Graph.Of(stance, "stance");
            if (loops.Count == 1)
            {
                return loops[0];
            }
            var weights = loops.Where(a => a.Likelihood > 0).Select(a => (a.Id, a.Likelihood)).ToMap();
            if (weights.Count == 0)
            {
                return loops.Count > 0 ? loops[0] : null;
            }
            var chosen = ChoiceRules.Pick(state.Seed, key, "loop", weights);
            return loops.Where(a => a.Id == chosen).First();
        }

        /// <summary>Return the transitions hop by hop from the current stance to `goal`.</summary>
        public static List<SamplingStep> FindRoute(LayerState state, MetaAction meta, string goal)
        {
            if (goal == state.Stance)
            {
                var name = state.Graph.Stances[goal].Name;
                state.Tell(meta, "already-there", "the layer is in '" + name + "' already", true);
                return null;
            }
            var stances = FindHops(state, goal);
            if (stances.Count == 0)
            {
                var a = state.Graph.Stances[state.Stance].Name;
                var b = state.Graph.Stances[goal].Name;
                state.Tell(meta, "no-way", "no chain of transitions leads from '" + a + "' to '" + b + "'");
                return null;
            }
            var steps = new List<SamplingStep>();
            var at = state.Stance;
            foreach (string following in stances)
            {
                var hops = state.Graph.Of(at, "transition").Where(a => a.EndStance == following && MayPlay(state, a)).ToList();
                steps.Add(new SamplingStep(hops, following));
                at = following;
            }
            return steps;
        }
    }
}
