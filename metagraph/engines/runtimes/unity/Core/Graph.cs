using System.Collections.Generic;

namespace Metagraph
{
    /// <summary>A joint. Parent: its place among all, -1 for a root; parents come first.</summary>
    public sealed class JointInfo
    {
        public string Name, Part, Side;
        public int Parent;
    }

    /// <summary>A clip as the export lists it. Motion: null where the GLB lacks it.</summary>
    public sealed class ClipEntry
    {
        public string Id, Name;
        public int Animation, Frames;
        public double Fps;
        public Clip Motion;
    }

    /// <summary>Clip seconds of a gesture, ascending.</summary>
    public struct Phases
    {
        public double Ready, Stroke, StrokeEnd, Relax;
    }

    /// <summary>
    /// One use of a clip. Start, End: the part that plays, clip seconds. Blends lie inside it; of a stance, BlendIn is the overlap
    /// at its loop's seam. Mask: for each joint whether it moves it, null where it moves all.
    /// </summary>
    public sealed class GraphAction
    {
        public string Id, Name, Kind, Layer, Stance, EndStance, Limb;
        public ClipEntry Clip;
        public double Start, End, BlendIn, BlendOut, Likelihood, Cooldown;
        public double? EarliestExit;
        public int? Spacing;
        public string[] Joints = Basics.None, Tags = Basics.None;
        public Phases Phases;
        public bool[] Mask;

        public double Length
        {
            get { return End - Start; }
        }

        /// <summary>Whether it has all the tags.</summary>
        public bool HasTags(IEnumerable<string> tags)
        {
            foreach (string tag in tags)
            {
                if (System.Array.IndexOf(Tags, tag) < 0)
                {
                    return false;
                }
            }
            return true;
        }
    }

    /// <summary>One layer: its stances (id, name) and actions, in the order they were placed.</summary>
    public sealed class LayerGraph
    {
        public readonly string Layer;
        public string Start;
        public readonly List<KeyValuePair<string, string>> Stances = new List<KeyValuePair<string, string>>();
        public readonly List<GraphAction> Actions = new List<GraphAction>();
        public Markov Markov;
        /// <summary>Joints the layer moves, and how strongly, 0..2.</summary>
        public int[] Reach;
        public double[] Weights;

        private readonly Dictionary<string, string> names = new Dictionary<string, string>();
        private readonly Dictionary<string, GraphAction> byId = new Dictionary<string, GraphAction>();
        private readonly Dictionary<string, List<GraphAction>> index = new Dictionary<string, List<GraphAction>>();
        private readonly HashSet<string> kinds = new HashSet<string>();
        private static readonly List<GraphAction> Nothing = new List<GraphAction>();

        public LayerGraph(string layer)
        {
            Layer = layer;
        }

        internal bool Add(string stance, string name)
        {
            if (names.ContainsKey(stance))
            {
                return false;
            }
            names[stance] = name;
            Stances.Add(new KeyValuePair<string, string>(stance, name));
            return true;
        }

        internal bool Add(GraphAction action)
        {
            if (byId.ContainsKey(action.Id))
            {
                return false;
            }
            byId[action.Id] = action;
            Actions.Add(action);
            string node = Node(action.Stance, action.Kind);
            if (!index.ContainsKey(node))
            {
                index[node] = new List<GraphAction>();
            }
            index[node].Add(action);
            kinds.Add(action.Kind);
            return true;
        }

        /// <summary>What a stance and a kind are counted under.</summary>
        public static string Node(string stance, string kind)
        {
            return kind + " " + stance;
        }

        /// <summary>The actions of a kind placed on a stance, in the order they were placed.</summary>
        public List<GraphAction> Of(string stance, string kind)
        {
            List<GraphAction> found;
            return stance != null && index.TryGetValue(Node(stance, kind), out found) ? found : Nothing;
        }

        /// <summary>The kinds of actions there are.</summary>
        public HashSet<string> Kinds
        {
            get { return kinds; }
        }

        public bool HasStance(string stance)
        {
            return stance != null && names.ContainsKey(stance);
        }

        public string NameOf(string stance)
        {
            return names[stance];
        }

        public GraphAction Action(string id)
        {
            GraphAction found;
            return byId.TryGetValue(id, out found) ? found : null;
        }

        /// <summary>
        /// The stances after `start` on the shortest way of transitions to `goal`, null where there is none. Of equally short ways
        /// the one whose transitions were placed first. Transitions that cannot play, or end in a stance without a loop, do not count.
        /// </summary>
        public List<string> Chain(string start, string goal)
        {
            var before = new Dictionary<string, string> { { start, start } };
            var queue = new List<string> { start };
            for (int n = 0; n < queue.Count; n++)
            {
                foreach (GraphAction action in Of(queue[n], "transition"))
                {
                    string end = action.EndStance;
                    if (action.Likelihood <= 0 || !HasStance(end) || Of(end, "stance").Count == 0 || before.ContainsKey(end))
                    {
                        continue;
                    }
                    before[end] = queue[n];
                    queue.Add(end);
                    if (end == goal)
                    {
                        var way = new List<string>();
                        for (string at = end; at != start; at = before[at])
                        {
                            way.Insert(0, at);
                        }
                        return way;
                    }
                }
            }
            return null;
        }
    }

    /// <summary>Constants of planning; seconds, but for Alpha and Hurry.</summary>
    public sealed class PlannerSettings
    {
        public uint Seed;
        public double Alpha, Shortest, Wait, Window, LoopFade, Memory, Rest, Lookahead = 0.1, Hurry = 2.0, LeastBlend = 0.25;
        public bool NeverTwice;
    }

    /// <summary>
    /// A line of dialogue. Audio: path of its sound relative to the export, null for none; playing it is the game's. Voice: null where
    /// the export has none. Asks: times from the line's start.
    /// </summary>
    public sealed class Line
    {
        public string Text = "", Audio;
        public double? Duration;
        public Voice Voice;
        public readonly List<Ask> Asks = new List<Ask>();
    }

    /// <summary>All that an export holds, ready to plan and pose from; never changed once it is loaded.</summary>
    public sealed partial class Graph
    {
        public string Name;
        public JointInfo[] Joints;
        /// <summary>The base pose, local: xyzw of each joint, xyz of each joint, metres.</summary>
        public float[] BaseRotations, BaseTranslations;
        public readonly Dictionary<string, LayerGraph> Layers = new Dictionary<string, LayerGraph>();
        public readonly Dictionary<string, ClipEntry> Clips = new Dictionary<string, ClipEntry>();
        public PlannerSettings Planner;
        public LifeSettings Life = new LifeSettings();
        /// <summary>What breathes and looks; null where the export does not say.</summary>
        public Body Body;
        public readonly Dictionary<string, double[]> Points = new Dictionary<string, double[]>();
        public readonly Dictionary<string, Line> Lines = new Dictionary<string, Line>();
        /// <summary>Names of all morph targets that clips or the face may move; poses have a weight for each.</summary>
        public readonly List<string> Morphs = new List<string>();
        /// <summary>What is not as it should be, in words; nothing of it stops a performance.</summary>
        public readonly List<string> Problems = new List<string>();

        /// <summary>The action of that id in whichever layer; null where there is none.</summary>
        public GraphAction Action(string id)
        {
            foreach (string layer in Basics.Layers)
            {
                GraphAction found = Layers[layer].Action(id);
                if (found != null)
                {
                    return found;
                }
            }
            return null;
        }

        internal int Morph(string name)
        {
            int place = Morphs.IndexOf(name);
            if (place < 0)
            {
                place = Morphs.Count;
                Morphs.Add(name);
            }
            return place;
        }
    }
}
