// Translated from metagraph/playback/planning/steps.py; change that, and translate anew.
using System;
using System.Collections.Generic;
using System.Linq;

namespace Metagraph
{
    /// <summary>Which actions a meta action may become: the transitions on the way, then the candidates.</summary>
    public static class StepsRules
    {
        /// <summary>
        /// Return each action in turn: the transitions to get there, then the action itself; None if it is impossible or not
        /// needed, or if the model wrote it and every candidate played too recently.
        /// </summary>
        public static List<SamplingStep> ChooseSteps(LayerState state, MetaAction meta, double now)
        {
            var request = meta.Request;
            var graph = state.Graph;
            if (request.Action != null)
            {
                var action = PlainMaps.Get(graph.Actions, request.Action);
                if (action == null || !graph.Stances.ContainsKey(action.Stance))
                {
                    state.Tell(
                        meta,
                        "unknown-action",
                        "there is no action '" + request.Action + "' in the " + graph.Layer + " layer"
                    );
                    return null;
                }
                if (action.Kind == "stance")
                {
                    return RoutesRules.FindRoute(state, meta, action.Stance);
                }
                if (!RoutesRules.Arrives(state, action))
                {
                    state.Tell(meta, "no-stance", "'" + action.Name + "' ends in a stance that has no loop");
                    return null;
                }
                if (action.Stance == state.Stance)
                {
                    return new List<SamplingStep> { new SamplingStep(new List<GraphAction> { action }) };
                }
                var way = RoutesRules.FindRoute(state, meta, action.Stance);
                return way == null
                    ? null
                    : way.Concat(new List<SamplingStep> { new SamplingStep(new List<GraphAction> { action }) }).ToList();
            }
            if (request.Stance != null && new List<string> { "transition", "stance" }.Contains(request.Kind))
            {
                if (!graph.Stances.ContainsKey(request.Stance))
                {
                    state.Tell(meta, "no-stance", "there is no stance '" + request.Stance + "' in the " + graph.Layer + " layer");
                    return null;
                }
                return RoutesRules.FindRoute(state, meta, request.Stance);
            }
            var leads = meta.Written ? DirectingRules.FindLead(state, now) : "";
            if (leads != "")
            {
                return RoutesRules.FindRoute(state, meta, leads);
            }
            var found = FindCandidates(state, meta, now);
            return found.Count == 0 ? null : new List<SamplingStep> { new SamplingStep(found) };
        }

        /// <summary>
        /// Return the actions of the current stance that fit, none if every one played too recently for what the model wrote.
        /// </summary>
        private static List<GraphAction> FindCandidates(LayerState state, MetaAction meta, double now)
        {
            var request = meta.Request;
            var graph = state.Graph;
            var here = RememberingRules.Node(state.Stance, request.Kind);
            if (!state.Candidates.ContainsKey(here))
            {
                state.Candidates[here] = graph.Of(state.Stance, request.Kind).Where(a => RoutesRules.MayPlay(state, a)).ToList();
            }
            var every = state.Candidates[here];
            if (request.Among.Count > 0)
            {
                every = every.Where(a => request.Among.Contains(a.Id)).ToList();
            }
            var found = every;
            if (request.Tags.Count > 0)
            {
                found = every.Where(a => request.Tags.All(tag => a.Tags.Contains(tag))).ToList();
            }
            var exact = found;
            if (request.Limb != null)
            {
                exact = found.Where(a => a.Limb == request.Limb).ToList();
            }
            var directed = meta.Written && state.Project.Settings.Variety > 0;
            if (directed) // the model's limb and tags are wishes, not orders
            {
                every = DirectingRules.KeepFresh(state, meta, every, now);
                var fresh = new HashSet<string>(every.Select(a => a.Id));
                found = found.Where(a => fresh.Contains(a.Id)).ToList();
                exact = exact.Where(a => fresh.Contains(a.Id)).ToList();
                if (every.Count == 0)
                {
                    return DirectingRules.FindMoves(state, meta, now);
                }
                if (exact.Count == 0)
                {
                    exact = found.Count > 0 ? found : every;
                }
            }
            else if (meta.Written) // nor worth playing the same again
            {
                var again = PlainLists.Part(PlainMaps.GetOr(state.Recent, here, new List<string>()), -1);
                if (!exact.Any(a => !again.Contains(a.Id)))
                {
                    exact = found.Any(a => !again.Contains(a.Id)) ? found : every;
                }
            }
            exact = DirectingRules.KeepModest(state, meta, exact, now);
            if (exact.Count == 0)
            {
                var name = graph.Stances[state.Stance].Name;
                var asked = string.Join(" ", request.Tags.Concat(new List<string> { request.Kind }).ToList());
                if (request.Limb != null)
                {
                    asked = request.Limb + " " + asked;
                }
                if (found.Count > 0) // whose limb is a wish, too
                {
                    state.Tell(meta, "other-limb", "stance '" + name + "' has no " + asked + "; another will do", true);
                    return found;
                }
                var hint = meta.Written ? "" : RoutesRules.NameElsewhere(state, request);
                state.Tell(meta, "no-candidate", "stance '" + name + "' has no " + asked + hint);
            }
            return exact;
        }
    }
}
