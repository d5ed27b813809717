namespace Metagraph
{
    /// <summary>How energetic an action is, as the export tells it.</summary>
    public static class VigourRules
    {
        /// <summary>Beside others of its layer and kind, -1..1.</summary>
        public static double MeasureVigour(Graph graph, GraphAction action)
        {
            return action.Vigour;
        }
    }
}
