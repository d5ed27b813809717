using System;
using System.Collections.Generic;

namespace Metagraph
{
    /// <summary>
    /// Motion at a constant frame rate. Rotations [F][J] local xyzw, neighbours on the same side. Translations [F][T] of the joints
    /// listed in Translated, metres; Still [J] of all others. Weights [F][K] of the morph targets whose places Morphs lists.
    /// </summary>
    public sealed class Clip
    {
        public readonly int Frames, Joints;
        public readonly double Fps;
        public readonly float[] Rotations, Still;
        public float[] Translations = new float[0], Weights = new float[0];
        public int[] Translated = new int[0], Morphs = new int[0];

        internal Clip(int frames, double fps, int joints, float[] still)
        {
            Frames = frames;
            Fps = fps;
            Joints = joints;
            Rotations = new float[frames * joints * 4];
            Still = still;
        }

        /// <summary>The frames before and after a time of the clip, and the part of the way between them, 0..1.</summary>
        public void Locate(double seconds, out int low, out int high, out double part)
        {
            double at = Basics.Clamp(seconds * Fps, 0, Frames - 1);
            low = Math.Min((int)at, Math.Max(0, Frames - 2));
            high = Math.Min(low + 1, Frames - 1);
            part = at - low;
        }

        public Quat Rotation(int frame, int joint)
        {
            return Quat.Of(Rotations, frame * Joints + joint);
        }
    }

    /// <summary>The animations of a GLB as clips: channels whose keys were thinned out, brought back to every frame.</summary>
    internal sealed class ClipReader
    {
        private readonly Glb glb;
        private readonly Graph graph;
        private readonly string name;
        private readonly List<Node> animations;
        private readonly Dictionary<int, int> joints = new Dictionary<int, int>(); // node -> joint
        private readonly Dictionary<int, int[]> morphs = new Dictionary<int, int[]>(); // node -> places among the graph's morph targets
        private readonly float[] stillTurns, stillPlaces;

        public ClipReader(Glb glb, Graph graph, string name)
        {
            this.glb = glb;
            this.graph = graph;
            this.name = name;
            animations = Glb.List(glb.Json, "animations");
            stillTurns = new float[4 * graph.Joints.Length];
            stillPlaces = new float[3 * graph.Joints.Length];
            List<Node> nodes = Glb.List(glb.Json, "nodes"), meshes = Glb.List(glb.Json, "meshes");
            var places = new Dictionary<string, int>();
            for (int n = nodes.Count - 1; n >= 0; n--) // of one name the first counts
            {
                Node called;
                places[nodes[n].Maybe("name", out called) ? called.Text : ""] = n;
            }
            for (int j = 0; j < graph.Joints.Length; j++)
            {
                int node;
                if (!places.TryGetValue(graph.Joints[j].Name, out node))
                {
                    string what = "has no joint '" + graph.Joints[j].Name + "'";
                    throw new MetagraphException(name, what, "Give the GLB that was exported with the JSON.");
                }
                joints[node] = j;
                Keep(nodes[node], "rotation", stillTurns, j, 4);
                Keep(nodes[node], "translation", stillPlaces, j, 3);
            }
            for (int n = 0; n < nodes.Count; n++)
            {
                int mesh = Glb.Integer(nodes[n], "mesh", -1);
                Node extras, targets;
                if (mesh < 0 || mesh >= meshes.Count || !meshes[mesh].Maybe("extras", out extras)
                    || !extras.Maybe("targetNames", out targets))
                {
                    continue;
                }
                morphs[n] = Array.ConvertAll(targets.Texts, graph.Morph);
            }
        }

        private static void Keep(Node node, string field, float[] values, int joint, int width)
        {
            Node found;
            double[] numbers = node.Maybe(field, out found) ? found.Numbers(width) : new double[] { 0, 0, 0, 1 };
            for (int i = 0; i < width; i++)
            {
                values[width * joint + i] = (float)numbers[i];
            }
        }

        /// <summary>The clip of an entry; null where the GLB has none of its place and name.</summary>
        public Clip Read(ClipEntry entry)
        {
            Node called;
            int place = entry.Animation;
            bool there = place >= 0 && place < animations.Count && animations[place].Maybe("name", out called) && called.Text == entry.Name;
            if (!there)
            {
                return null;
            }
            Node found = animations[place];
            int count = graph.Joints.Length;
            var clip = new Clip(entry.Frames, entry.Fps, count, stillPlaces);
            for (int f = 0; f < entry.Frames; f++)
            {
                Array.Copy(stillTurns, 0, clip.Rotations, f * 4 * count, 4 * count);
            }
            var moved = new SortedDictionary<int, float[]>();
            var shaped = new SortedDictionary<int, float[]>();
            List<Node> samplers = found["samplers"].Items;
            foreach (Node channel in found["channels"].Items)
            {
                int node = Glb.Integer(channel["target"], "node", -1), joint, sampler = channel["sampler"].Count;
                string path = channel["target"]["path"].Text;
                if (sampler < 0 || sampler >= samplers.Count)
                {
                    throw channel.Wrong("has a sampler that is not there");
                }
                if (path == "weights" && morphs.ContainsKey(node))
                {
                    float[] values = Resample(samplers[sampler], entry, morphs[node].Length, false);
                    Spread(values, morphs[node], entry.Frames, shaped);
                }
                else if (path == "rotation" && joints.TryGetValue(node, out joint))
                {
                    float[] values = Resample(samplers[sampler], entry, 4, true);
                    for (int f = 0; f < entry.Frames; f++)
                    {
                        Array.Copy(values, 4 * f, clip.Rotations, 4 * (f * count + joint), 4);
                    }
                }
                else if (path == "translation" && joints.TryGetValue(node, out joint))
                {
                    moved[joint] = Resample(samplers[sampler], entry, 3, false);
                }
            }
            clip.Translated = new List<int>(moved.Keys).ToArray();
            clip.Translations = Interleaved(moved, entry.Frames, 3);
            clip.Morphs = new List<int>(shaped.Keys).ToArray();
            clip.Weights = Interleaved(shaped, entry.Frames, 1);
            return clip;
        }

        private static void Spread(float[] values, int[] targets, int frames, SortedDictionary<int, float[]> shaped)
        {
            for (int k = 0; k < targets.Length; k++)
            {
                var own = new float[frames];
                for (int f = 0; f < frames; f++)
                {
                    own[f] = values[f * targets.Length + k];
                }
                shaped[targets[k]] = own;
            }
        }

        /// <summary>Columns [F][width] of several things as one array [F][count][width].</summary>
        private static float[] Interleaved(SortedDictionary<int, float[]> columns, int frames, int width)
        {
            var found = new float[columns.Count * frames * width];
            int place = 0;
            foreach (float[] column in columns.Values)
            {
                for (int f = 0; f < frames; f++)
                {
                    Array.Copy(column, f * width, found, (f * columns.Count + place) * width, width);
                }
                place++;
            }
            return found;
        }

        /// <summary>A sampler's values [F][width] at every frame of a clip.</summary>
        private float[] Resample(Node sampler, ClipEntry entry, int width, bool turning)
        {
            Node mode;
            string how = sampler.Maybe("interpolation", out mode) ? mode.Text : "LINEAR";
            float[] keys = glb.Numbers(sampler["input"].Count), values = glb.Numbers(sampler["output"].Count);
            if (how != "LINEAR" || keys.Length == 0 || values.Length != keys.Length * width)
            {
                throw new MetagraphException(name, "clip '" + entry.Name + "' has keys that exports never have", "Export it again.");
            }
            var found = new float[entry.Frames * width];
            int low = 0;
            for (int f = 0; f < entry.Frames; f++)
            {
                double time = f / entry.Fps;
                while (low < keys.Length - 2 && keys[low + 1] <= time)
                {
                    low++;
                }
                int high = Math.Min(low + 1, keys.Length - 1);
                double gap = keys[high] - keys[low], part = gap > 0 ? Basics.Clamp((time - keys[low]) / gap, 0, 1) : 0;
                if (turning)
                {
                    Quat q = Quat.Slerp(Quat.Of(values, low).Unit, Quat.Of(values, high).Unit, part);
                    bool other = f > 0 && Quat.Dot(q, Quat.Of(found, f - 1)) < 0;
                    (other ? q.Negative : q).Unit.Write(found, f);
                    continue;
                }
                for (int i = 0; i < width; i++)
                {
                    double a = values[low * width + i], b = values[high * width + i];
                    found[f * width + i] = (float)(a + (b - a) * part);
                }
            }
            return found;
        }
    }
}
