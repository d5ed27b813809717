using System;
using System.Collections.Generic;

namespace Metagraph
{
    /// <summary>A gesture's phases, as the export tells them.</summary>
    public static class PhasesRules
    {
        public static Phases FindPhases(Graph graph, GraphAction action)
        {
            return action.Phases;
        }

        /// <summary>Seconds from an action's start to its stroke.</summary>
        public static double Lead(Graph graph, GraphAction action)
        {
            return action.Phases.Stroke - action.Start;
        }

        /// <summary>How long before its stroke any gesture of a layer with these tags begins.</summary>
        public static double FindLongestLead(Graph graph, LayerGraph layer, List<string> tags)
        {
            double longest = 0.0;
            foreach (GraphAction action in layer.Actions.Values)
            {
                if (action.Kind == "gesture" && action.HasTags(tags))
                {
                    longest = Math.Max(longest, Lead(graph, action));
                }
            }
            return longest;
        }
    }
}
