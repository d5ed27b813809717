using System.Collections.Generic;

namespace Metagraph
{
    /// <summary>A joint. Parent: its place among all, -1 for a root; parents come first.</summary>
    public sealed class JointInfo
    {
        public string Name, Part, Side;
        public int Parent;
        /// <summary>Whether it turns farther, and whether less far, where a cue is played larger or smaller than made.</summary>
        public bool Larger = true, Smaller = true;
    }

    /// <summary>A clip as the export lists it. Motion: null where the GLB lacks it.</summary>
    public sealed class ClipEntry
    {
        public string Id, Name;
        public int Animation, Frames;
        public double Fps;
        public Clip Motion;
    }

    /// <summary>
    /// One use of a clip. Start, End: the part that plays, clip seconds. Blends lie inside it; of a stance, the blend in is the overlap
    /// at its loop's seam. Mask: for each joint how far it moves it, 0..1, null where it moves all of all.
    /// </summary>
    public sealed class GraphAction
    {
        public string Id, Name, Kind, Layer, Stance, EndStance, Limb;
        public ClipEntry Clip;
        public double Start, End, Likelihood, Cooldown, Vigour, Prominence;
        public Timing Timing;
        public int? Spacing;
        public List<string> Joints = new List<string>(), Tags = new List<string>();
        public Dictionary<string, double> JointWeights = new Dictionary<string, double>();
        public List<ContactSpan> Contacts = new List<ContactSpan>();
        public Phases Phases;
        public double[] Mask;

        public double Length
        {
            get { return End - Start; }
        }

        /// <summary>Whether it has all the tags.</summary>
        public bool HasTags(IEnumerable<string> tags)
        {
            foreach (string tag in tags)
            {
                if (!Tags.Contains(tag))
                {
                    return false;
                }
            }
            return true;
        }
    }

    /// <summary>One layer: its stances and actions by id, in the order they were placed.</summary>
    public sealed class LayerGraph
    {
        public readonly string Layer;
        public string Start;
        public readonly Dictionary<string, Stance> Stances = new Dictionary<string, Stance>();
        public readonly Dictionary<string, GraphAction> Actions = new Dictionary<string, GraphAction>();
        public Markov Markov;
        /// <summary>Joints the layer moves, and how strongly, 0..2.</summary>
        public int[] Reach;
        public double[] Weights;
        /// <summary>How much of the arms it moves, 0..1.</summary>
        public double Strength;

        private readonly Dictionary<string, List<GraphAction>> index = new Dictionary<string, List<GraphAction>>();
        private readonly HashSet<string> kinds = new HashSet<string>();
        private static readonly List<GraphAction> Nothing = new List<GraphAction>();

        public LayerGraph(string layer)
        {
            Layer = layer;
        }

        internal bool Add(string stance, string name)
        {
            if (Stances.ContainsKey(stance))
            {
                return false;
            }
            Stances[stance] = new Stance(stance, Layer, name);
            return true;
        }

        internal bool Add(GraphAction action)
        {
            if (Actions.ContainsKey(action.Id))
            {
                return false;
            }
            Actions[action.Id] = action;
            string node = RememberingRules.Node(action.Stance, action.Kind);
            if (!index.ContainsKey(node))
            {
                index[node] = new List<GraphAction>();
            }
            index[node].Add(action);
            kinds.Add(action.Kind);
            return true;
        }

        /// <summary>The actions of a kind placed on a stance, in the order they were placed.</summary>
        public List<GraphAction> Of(string stance, string kind)
        {
            List<GraphAction> found;
            return stance != null && index.TryGetValue(RememberingRules.Node(stance, kind), out found) ? found : Nothing;
        }

        /// <summary>The kinds of actions there are.</summary>
        public HashSet<string> Kinds
        {
            get { return kinds; }
        }
    }

    /// <summary>Constants of planning; seconds, but for Alpha.</summary>
    public sealed class PlannerSettings
    {
        public uint Seed;
        public double Alpha, Shortest, Wait, Memory, Rest, Lookahead = 0.1, Variety;
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
        /// <summary>The mood it is said in: what an ask tells of it, null where it tells nothing.</summary>
        public Ask Mood;
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
        public PlannerSettings Settings;
        public LifeSettings Life = new LifeSettings();
        /// <summary>What breathes and looks; null where the export does not say.</summary>
        public Body Body;
        /// <summary>What keeps hands on the body, and out of it; null where the export does not say.</summary>
        public ContactRig ContactRig;
        /// <summary>What answers the arms; null where the export does not say.</summary>
        public WeightRig WeightRig;
        /// <summary>What the actions of arms and body weigh, by action.</summary>
        public Dictionary<string, ArmTrack> ArmTracks;
        /// <summary>Where the feet of the body's actions are, by action.</summary>
        public Dictionary<string, FootTrack> FootTracks;
        public string FeetLayer = "body"; // it moves the legs
        public readonly Dictionary<string, double[]> Points = new Dictionary<string, double[]>();
        public readonly Dictionary<string, Line> Lines = new Dictionary<string, Line>();
        /// <summary>What games set, by name.</summary>
        public readonly Dictionary<string, Parameter> Parameters = new Dictionary<string, Parameter>();
        public readonly Voices Voices = new Voices();
        /// <summary>Names of all morph targets that clips or the face may move; poses have a weight for each.</summary>
        public readonly List<string> Morphs = new List<string>();
        /// <summary>What is not as it should be, in words; nothing of it stops a performance.</summary>
        public readonly List<string> Problems = new List<string>();

        /// <summary>The action of that id in whichever layer; null where there is none.</summary>
        public GraphAction Action(string id)
        {
            foreach (string layer in Basics.Layers)
            {
                GraphAction found;
                if (Layers[layer].Actions.TryGetValue(id, out found))
                {
                    return found;
                }
            }
            return null;
        }

        /// <summary>The seconds of its clip between which an action plays.</summary>
        public (double, double) Span(GraphAction action)
        {
            return (action.Start, action.End);
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
