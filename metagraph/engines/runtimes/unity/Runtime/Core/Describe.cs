using System.Collections.Generic;
using System.Linq;

namespace Metagraph
{
    /// <summary>Tells what may be asked of a character.</summary>
    public sealed partial class Graph
    {
        /// <summary>
        /// What may be asked for, as JSON: "project", "words" (what "do" may be), "modes", "joints", "layers" (each "start", "stances",
        /// "actions" but loops of stances, "tags" with the number of their actions), "lines", "points" by name, metres, and, where there are
        /// any, "parameters" by name.
        /// </summary>
        public string Describe()
        {
            var joints = new List<object>();
            foreach (JointInfo joint in Joints)
            {
                joints.Add(Record("name", joint.Name, "parent", joint.Parent < 0 ? null : Joints[joint.Parent].Name, "part", joint.Part));
            }
            var layers = new JsonObject();
            foreach (string layer in Basics.Layers)
            {
                layers[layer] = Told(Layers[layer]);
            }
            var lines = new List<object>();
            var ids = new List<string>(Lines.Keys);
            ids.Sort(Basics.Compare);
            foreach (string id in ids)
            {
                lines.Add(Record("id", id, "text", Lines[id].Text));
            }
            var points = new JsonObject();
            foreach (KeyValuePair<string, double[]> point in Points)
            {
                points[point.Key] = new List<object>(System.Array.ConvertAll(point.Value, x => (object)x));
            }
            var parameters = new JsonObject();
            foreach (KeyValuePair<string, Parameter> one in Parameters)
            {
                parameters[one.Key] = one.Value.Described();
            }
            JsonObject found = Record(
                "project", Name, "words", new List<object>(Ask.AllWords), "modes", new List<object>(Basics.Modes), "joints", joints,
                "layers", layers, "lines", lines, "points", points);
            if (Parameters.Count > 0)
            {
                found["parameters"] = parameters;
            }
            return Json.Write(found);
        }

        private static JsonObject Told(LayerGraph graph)
        {
            List<object> stances = graph.Stances.Values.Select(stance => (object)Record("id", stance.Id, "name", stance.Name)).ToList();
            var actions = new List<object>();
            var tags = new JsonObject();
            foreach (GraphAction action in graph.Actions.Values)
            {
                foreach (string tag in action.Tags)
                {
                    tags[tag] = (tags.Has(tag) ? (long)tags[tag] : 0L) + 1L;
                }
                if (action.Kind != "stance")
                {
                    actions.Add(Told(action));
                }
            }
            return Record("start", graph.Start, "stances", stances, "actions", actions, "tags", tags);
        }

        private static JsonObject Told(GraphAction action)
        {
            JsonObject found = Record(
                "id", action.Id, "name", action.Name, "kind", action.Kind, "stance", action.Stance,
                "seconds", RepeatingRules.SecondsPlayed(action.Kind, action.Timing, action.Start, action.End));
            if (action.Kind == "transition")
            {
                found["to"] = action.EndStance;
            }
            if (action.Limb != "both")
            {
                found["limb"] = action.Limb;
            }
            if (action.Tags.Count > 0)
            {
                found["tags"] = new List<object>(action.Tags);
            }
            return found;
        }

        /// <summary>An object of names and values in turn.</summary>
        private static JsonObject Record(params object[] pairs)
        {
            var found = new JsonObject();
            for (int n = 0; n < pairs.Length; n += 2)
            {
                found[(string)pairs[n]] = pairs[n + 1];
            }
            return found;
        }
    }
}
