namespace Metagraph
{
    /// <summary>How much an action stands out, as the export tells it.</summary>
    public static class ProminenceRules
    {
        /// <summary>From 0 for hardly to 1 for much.</summary>
        public static double MeasureProminence(Graph graph, GraphAction action)
        {
            return action.Prominence;
        }
    }
}
