using System.Collections.Generic;
using System.Linq;

namespace Metagraph
{
    /// <summary>What a meta action needs one after the other: the transitions on the way to a stance, then the action itself.</summary>
    internal sealed partial class Performer
    {
        /// <summary>One action of a chain: who may play it, and for a transition on the way the stance it leads to.</summary>
        private struct Step
        {
            public List<GraphAction> Candidates;
            public string Hop;
        }

        /// <summary>Each action in turn: the transitions to get there, then the action itself; null if impossible or needless.</summary>
        private List<Step> Steps(MetaAction meta)
        {
            MetaRequest request = meta.Request;
            if (request.Action != null)
            {
                GraphAction action = graph.Action(request.Action);
                if (action == null || !graph.HasStance(action.Stance))
                {
                    Tell(meta, "unknown-action", "there is no action '" + request.Action + "' in the " + graph.Layer + " layer");
                    return null;
                }
                if (action.Kind == "stance")
                {
                    return Way(meta, action.Stance);
                }
                if (!Arrives(action))
                {
                    Tell(meta, "no-stance", "'" + action.Name + "' ends in a stance that has no loop");
                    return null;
                }
                List<Step> way = action.Stance == past.Stance ? new List<Step>() : Way(meta, action.Stance);
                if (way != null)
                {
                    way.Add(new Step { Candidates = new List<GraphAction> { action } });
                }
                return way;
            }
            if (request.Stance != null && (request.Kind == "transition" || request.Kind == "stance"))
            {
                if (!graph.HasStance(request.Stance))
                {
                    Tell(meta, "no-stance", "there is no stance '" + request.Stance + "' in the " + graph.Layer + " layer");
                    return null;
                }
                return Way(meta, request.Stance);
            }
            List<GraphAction> every = graph.Of(past.Stance, request.Kind).FindAll(Usable);
            if (request.Among.Count > 0)
            {
                every = every.FindAll(a => request.Among.Contains(a.Id));
            }
            List<GraphAction> found = every.FindAll(a => a.HasTags(request.Tags));
            List<GraphAction> exact = request.Limb != null ? found.FindAll(a => a.Limb == request.Limb) : found;
            if (meta.Written) // the model's limb and tags are wishes, not orders, nor worth playing the same again
            {
                List<string> recent;
                past.Recent.TryGetValue(LayerGraph.Node(past.Stance, request.Kind), out recent);
                string again = recent == null ? null : recent[recent.Count - 1];
                exact = new[] { exact, found, every }.FirstOrDefault(some => some.Exists(a => a.Id != again)) ?? every;
            }
            if (exact.Count == 0)
            {
                string[] words = new[] { request.Limb ?? "" }.Concat(request.Tags).Concat(new[] { request.Kind }).ToArray();
                string wanted = string.Join(" ", words.Where(word => word.Length > 0).ToArray());
                string lacks = "stance '" + graph.NameOf(past.Stance) + "' has no " + wanted;
                if (found.Count > 0) // whose limb is a wish, too
                {
                    Tell(meta, "other-limb", lacks + "; another will do", true);
                    return new List<Step> { new Step { Candidates = found } };
                }
                Tell(meta, "no-candidate", lacks);
                return null;
            }
            return new List<Step> { new Step { Candidates = exact } };
        }

        /// <summary>The transitions hop by hop from the current stance to `goal`.</summary>
        private List<Step> Way(MetaAction meta, string goal)
        {
            if (goal == past.Stance)
            {
                Tell(meta, "already-there", "the layer is in '" + graph.NameOf(goal) + "' already", true);
                return null;
            }
            List<string> stances = graph.Chain(past.Stance, goal);
            if (stances == null)
            {
                string ends = "'" + graph.NameOf(past.Stance) + "' to '" + graph.NameOf(goal) + "'";
                Tell(meta, "no-way", "no chain of transitions leads from " + ends);
                return null;
            }
            var steps = new List<Step>();
            string at = past.Stance;
            foreach (string following in stances)
            {
                List<GraphAction> hops = graph.Of(at, "transition").FindAll(a => a.EndStance == following && Usable(a));
                steps.Add(new Step { Candidates = hops, Hop = following });
                at = following;
            }
            return steps;
        }

        /// <summary>Whether an action leaves the layer in a stance that can rest.</summary>
        private bool Arrives(GraphAction action)
        {
            return action.Kind != "transition" || (graph.HasStance(action.EndStance) && graph.Of(action.EndStance, "stance").Count > 0);
        }

        private bool Usable(GraphAction action)
        {
            return action.Likelihood > 0 && Arrives(action);
        }
    }
}
