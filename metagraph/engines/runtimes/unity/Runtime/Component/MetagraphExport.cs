using UnityEngine;

namespace Metagraph
{
    /// <summary>An export as the package imports it: graph, clips and, of a humanoid, its bones. Characters of one export share it.</summary>
    public sealed class MetagraphExport : ScriptableObject
    {
        /// <summary>The export's JSON.</summary>
        [HideInInspector]
        public string json = "";
        /// <summary>The bytes of the export's GLB.</summary>
        [HideInInspector]
        public byte[] motion = new byte[0];
        /// <summary>Which joint is which bone of a humanoid, and its T pose, as JSON; empty for other figures.</summary>
        [HideInInspector]
        public string humanoid = "";

        /// <summary>Read the graph. Throws MetagraphException.</summary>
        public Graph Read()
        {
            return Graph.Load(json, motion, name);
        }
    }
}
