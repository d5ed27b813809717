// Translated from metagraph/playback/planning/finding.py; change that, and translate anew.
using System;
using System.Collections.Generic;
using System.Linq;

namespace Metagraph
{
    /// <summary>Find actions and stances by id or name.</summary>
    public static class FindingRules
    {
        /// <summary>
        /// Return the action with an id or, failing that, with a name; of several with the same name, the likeliest. layer: None
        /// for any.
        /// </summary>
        public static GraphAction ActionCalled(List<LayerGraph> graphs, string word, string layer)
        {
            foreach (LayerGraph graph in graphs)
            {
                var found = PlainMaps.Get(graph.Actions, word);
                if (found != null && (layer == null || layer == graph.Layer))
                {
                    return found;
                }
            }
            GraphAction best = null;
            foreach (LayerGraph graph in graphs)
            {
                if (layer == null || layer == graph.Layer)
                {
                    foreach (GraphAction action in graph.Actions.Values.ToList())
                    {
                        if (action.Name == word && (best == null || action.Likelihood > best.Likelihood))
                        {
                            best = action;
                        }
                    }
                }
            }
            return best;
        }

        /// <summary>Return the stance with an id or, failing that, with a name, in the first layer that has one.</summary>
        public static Stance StanceCalled(List<LayerGraph> graphs, string word, string layer)
        {
            foreach (LayerGraph graph in graphs)
            {
                if (layer == null || layer == graph.Layer)
                {
                    var found = PlainMaps.Get(graph.Stances, word);
                    if (found != null)
                    {
                        return found;
                    }
                    foreach (Stance stance in graph.Stances.Values.ToList())
                    {
                        if (stance.Name == word)
                        {
                            return stance;
                        }
                    }
                }
            }
            return null;
        }
    }
}
