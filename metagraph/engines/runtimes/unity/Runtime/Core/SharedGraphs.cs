using System;
using System.Collections.Generic;

namespace Metagraph
{
    /// <summary>
    /// Graphs by what they were loaded from, so that characters of the same export read it once. A graph stays as long as somebody
    /// holds it. For one thread.
    /// </summary>
    public static class SharedGraphs
    {
        private static readonly Dictionary<(object, object), WeakReference> Known = new Dictionary<(object, object), WeakReference>();

        /// <summary>
        /// The graph of an export and a GLB, whatever tells these apart: assets, paths. load: makes it where nobody holds one; what it
        /// throws is thrown on, and nothing is kept.
        /// </summary>
        public static Graph Of(object export, object glb, Func<Graph> load)
        {
            WeakReference known;
            var graph = Known.TryGetValue((export, glb), out known) ? (Graph)known.Target : null;
            if (graph != null)
            {
                return graph;
            }
            graph = load();
            foreach ((object, object) key in new List<(object, object)>(Known.Keys))
            {
                if (!Known[key].IsAlive)
                {
                    Known.Remove(key);
                }
            }
            Known[(export, glb)] = new WeakReference(graph);
            return graph;
        }

        /// <summary>Forget all, as when assets may have changed.</summary>
        public static void Clear()
        {
            Known.Clear();
        }
    }
}
