namespace Metagraph
{
    /// <summary>A gesture's phases, as the export tells them.</summary>
    public static class PhasesRules
    {
        public static Phases Phases(Graph graph, GraphAction action)
        {
            return action.Phases;
        }
    }
}
