using System;
using System.Collections.Generic;
using System.Linq;

namespace Metagraph
{
    /// <summary>Reads an export: its JSON and its GLB.</summary>
    public sealed partial class Graph
    {
        /// <summary>Version of the format that this runtime reads.</summary>
        public const int Format = 1;
        private const double Largest = 1e8; // rotations of a clip

        /// <summary>
        /// The graph of an export. A clip that the GLB lacks is a problem, not an error: its actions show their stance. name: of the
        /// JSON, for messages. Raises MetagraphException, which says what is wrong, where, and what to do.
        /// </summary>
        public static Graph Load(string json, byte[] glb, string name = "export")
        {
            object parsed;
            try
            {
                parsed = Json.Parse(json ?? "");
            }
            catch (FormatException error)
            {
                throw new MetagraphException(name, error.Message, "Export it again.");
            }
            var root = new Node(parsed, name);
            int version = root["metagraph"].Count;
            if (version > Format)
            {
                string what = "has format " + version + ", this runtime reads " + Format;
                throw new MetagraphException(name, what, "Update the runtime.");
            }
            if (root["randomness"]["hash"].Text != "fnv1a32-mix")
            {
                throw new MetagraphException(name, "draws by another hash than this runtime's", "Update the runtime.");
            }
            return new Graph(root, glb);
        }

        private Graph(Node root, byte[] data)
        {
            Name = root["name"].Text;
            ReadJoints(root);
            ReadPlanner(root["planner"]);
            foreach (Node one in root["clips"].Items)
            {
                var entry = new ClipEntry
                {
                    Id = one["id"].Text, Name = one["name"].Text, Animation = one["animation"].Count, Fps = one["fps"].Within(1e-3, 1e6),
                    Frames = one["frames"].Count,
                };
                if (entry.Frames < 1 || (double)entry.Frames * Joints.Length > Largest)
                {
                    throw one["frames"].Wrong("is out of range");
                }
                Clips[entry.Id] = entry;
            }
            Node layers = root["layers"], found;
            foreach (string layer in Basics.Layers)
            {
                Layers[layer] = ReadLayer(layer, layers[layer]);
            }
            Life = root.Maybe("life", out found) ? LifeSettings.From(found) : Life;
            if (root.Maybe("points", out found))
            {
                foreach (string name in found.Names)
                {
                    Points[name] = found[name].Numbers(3);
                }
            }
            ReadLines(root);
            ReadParameters(root);
            string glb = root["glb"].Text;
            if (root.Maybe("glb_bytes", out found) && !found.IsNull && found.Count != data.Length)
            {
                Problems.Add(
                    "'" + glb + "' is not the GLB that this JSON was written with (" + data.Length + " bytes, not " + found.Count
                    + "): export again, and copy both files."
                );
            }
            var clips = new ClipReader(new Glb(data, glb), this, glb);
            foreach (ClipEntry entry in Clips.Values)
            {
                entry.Motion = clips.Read(entry);
                if (entry.Motion == null)
                {
                    Problems.Add("the GLB '" + glb + "' lacks clip '" + entry.Name + "'; its actions show their stance. Export it again.");
                }
            }
            Body = root.Maybe("rig", out found) && !found.IsNull ? ReadBody(found) : null;
            ContactRig = root.Maybe("contact_rig", out found) && !found.IsNull ? Contacts.ReadRig(found, Joints) : null;
            WeightRig = root.Maybe("weight_rig", out found) && !found.IsNull ? Weight.ReadRig(found, Joints.Length) : null;
            ArmTracks = Weight.ReadTracks(this, root["clips"]);
            bool told = WeightRig != null && root["weight_rig"].Maybe("feet_layer", out found) && Layers.ContainsKey(found.Text);
            FeetLayer = told ? found.Text : "body";
            FootTracks = Weight.ReadFeet(this, root["clips"]);
        }

        private void ReadJoints(Node root)
        {
            List<Node> joints = root["joints"].Items;
            var places = new Dictionary<string, int>();
            Joints = new JointInfo[joints.Count];
            for (int j = 0; j < Joints.Length; j++)
            {
                string parent = joints[j]["parent"].TextOrNull;
                var joint = new JointInfo
                {
                    Name = joints[j]["name"].Text, Part = joints[j]["part"].OneOf(Basics.Parts), Side = joints[j]["side"].Text, Parent = -1,
                };
                Node scales;
                if (joints[j].Maybe("scales", out scales))
                {
                    joint.Larger = scales.Text == "both";
                    joint.Smaller = scales.Text != "neither";
                }
                if (parent != null && !places.TryGetValue(parent, out joint.Parent))
                {
                    throw joints[j].Wrong("its parent '" + parent + "' should stand before it");
                }
                places[joint.Name] = j;
                Joints[j] = joint;
            }
            BaseRotations = Rows(root["base"]["rotations"], 4);
            BaseTranslations = Rows(root["base"]["translations"], 3);
        }

        private float[] Rows(Node rows, int width)
        {
            List<Node> items = rows.Items;
            if (items.Count != Joints.Length || Joints.Length == 0)
            {
                throw rows.Wrong("should have a row for each of " + Joints.Length + " joints");
            }
            var found = new List<float>();
            items.ForEach(row => found.AddRange(Array.ConvertAll(row.Numbers(width), x => (float)x)));
            return found.ToArray();
        }

        private void ReadPlanner(Node json)
        {
            double seed = json["seed"].Number;
            if (json["blend"].Text != "3x^2-2x^3")
            {
                throw json["blend"].Wrong("is a curve that this runtime does not know");
            }
            Settings = new PlannerSettings
            {
                Seed = (uint)Basics.Clamp(seed, 0, uint.MaxValue), Alpha = json["alpha"].Within(0, 1e15),
                NeverTwice = json["never_twice"].Flag, Shortest = json["shortest"].Within(0, 1e9), Wait = json["wait"].Within(0, 1e9),
            };
            Node found;
            Settings.Memory = json.Maybe("memory", out found) ? found.Within(0, 600) : Settings.Memory;
            Settings.Rest = json.Maybe("rest", out found) ? found.Within(0, 600) : Settings.Rest;
            Settings.Lookahead = json.Maybe("lookahead", out found) ? found.Within(0, 10) : Settings.Lookahead;
            Settings.Variety = json.Maybe("variety", out found) ? found.Within(0, 4) : Settings.Variety;
        }

        private LayerGraph ReadLayer(string layer, Node json)
        {
            var graph = new LayerGraph(layer) { Start = json["start"].TextOrNull, Markov = ReadMarkov(layer, json["markov"]) };
            foreach (Node stance in json["stances"].Items)
            {
                if (!graph.Add(stance["id"].Text, stance["name"].Text))
                {
                    throw stance["id"].Wrong("is used twice");
                }
            }
            foreach (Node action in json["actions"].Items)
            {
                if (!graph.Add(ReadAction(layer, action)))
                {
                    throw action["id"].Wrong("is used twice");
                }
            }
            var reach = new List<int>();
            var weights = new List<double>();
            for (int j = 0; j < Joints.Length; j++)
            {
                Node weight;
                double own = json["weights"].Maybe(Joints[j].Part, out weight) ? (float)weight.Number : 0.0;
                if (own > 0)
                {
                    reach.Add(j);
                    weights.Add(own);
                }
            }
            graph.Reach = reach.ToArray();
            graph.Weights = weights.ToArray();
            Node arms;
            graph.Strength = json["weights"].Maybe("arms", out arms) ? Math.Min(1.0, arms.Number) : 0.0;
            return graph;
        }

        private GraphAction ReadAction(string layer, Node json)
        {
            var action = new GraphAction
            {
                Id = json["id"].Text, Name = json["name"].Text, Kind = json["kind"].OneOf(Basics.Kinds), Layer = layer,
                Stance = json["stance"].Text, EndStance = json["end_stance"].TextOrNull, Limb = json["limb"].OneOf(Basics.Limbs),
                Start = json["start"].Within(0, 1e9), Likelihood = json["likelihood"].Within(0, 1e15),
                Joints = json["joints"].Texts.ToList(), Tags = json["tags"].Texts.ToList(),
            };
            action.End = json["end"].Within(action.Start, 1e9);
            Node found;
            action.Timing = new Timing(
                action.Start, action.End, json["blend_in"].Within(0, 1e9), json["blend_out"].Within(0, 1e9), action.Kind == "stance",
                json["earliest_exit"].NumberOrNull, repeat: json.Maybe("repeat", out found) ? found.Within(0, 1e9) : 0.0);
            if (!Clips.TryGetValue(json["clip"].Text, out action.Clip))
            {
                throw json["clip"].Wrong("is no clip of the export");
            }
            action.Cooldown = json.Maybe("cooldown", out found) ? found.Within(0, 1e9) : 0.0;
            action.Vigour = json.Maybe("vigour", out found) ? found.Within(-1, 1) : 0.0;
            action.Prominence = json.Maybe("prominence", out found) ? found.Within(0, 1) : 0.0;
            action.Spacing = json.Maybe("spacing", out found) && !found.IsNull ? (int)found.Within(0, 1000) : (int?)null;
            action.Contacts = json.Maybe("contacts", out found) && !found.IsNull ? Contacts.Read(found) : action.Contacts;
            double[] phases = json.Maybe("phases", out found) ? found.Numbers(-1) : new double[0];
            if (phases.Length != 4) // where none are told, all are at the stroke, and that is halfway unless it was set
            {
                double stroke = json["stroke"].NumberOrNull ?? (action.Start + action.End) / 2;
                stroke = Basics.Clamp(stroke, action.Start, action.End);
                phases = new[] { stroke, stroke, stroke, stroke };
            }
            action.Phases = new Phases(action.Start, phases[0], phases[1], phases[2], phases[3], action.End);
            if (json.Maybe("joint_weights", out found))
            {
                foreach (string joint in found.Names)
                {
                    action.JointWeights[joint] = found[joint].Within(0, 1);
                }
            }
            action.Mask = Mask(action);
            return action;
        }

        /// <summary>A one-armed action leaves the other arm alone; `Joints`, if any, names the only joints it moves, and `JointWeights` how far.</summary>
        private double[] Mask(GraphAction action)
        {
            if (action.Limb == "both" && action.Joints.Count == 0 && action.JointWeights.Count == 0)
            {
                return null;
            }
            string other = action.Limb == "left" ? "right" : "left";
            return Array.ConvertAll(Joints, joint =>
            {
                bool moves = !(action.Limb != "both" && joint.Part == "arms" && joint.Side == other)
                    && (action.Joints.Count == 0 || action.Joints.Contains(joint.Name));
                double weight;
                return !moves ? 0.0 : action.JointWeights.TryGetValue(joint.Name, out weight) ? weight : 1.0;
            });
        }

        private static Markov ReadMarkov(string layer, Node json)
        {
            List<(string, string)> states = json["states"].Items.ConvertAll(
                state => (Half(state, 0).OneOf(Basics.Limbs), Half(state, 1).OneOf(Basics.Kinds)));
            Node found;
            List<string> tags = json.Maybe("tags", out found) ? found.Texts.ToList() : new List<string>();
            List<List<double>> matrix = json["matrix"].Items.ConvertAll(row => row.Numbers(states.Count).ToList());
            List<(double, double)> lengths = json.Maybe("lengths", out found)
                ? found.Items.ConvertAll(pair => (pair.Numbers(2)[0], pair.Numbers(2)[1]))
                : new List<(double, double)>();
            List<List<double>> modes = json.Maybe("modes", out found)
                ? found.Items.ConvertAll(row => row.Numbers(3).ToList())
                : new List<List<double>>();
            if (modes.Count != 0 && (modes.Count < 3 || modes.Count > Basics.Modes.Length))
            {
                throw json.Wrong("should have shares for each mode");
            }
            bool tagged = tags.Count == 0 || tags.Count == states.Count;
            if (matrix.Count != states.Count || !tagged || (lengths.Count != 0 && lengths.Count != states.Count))
            {
                throw json.Wrong("should have a row of everything for each state");
            }
            if (matrix.Exists(row => row.Exists(x => !(x >= 0))) || lengths.Exists(pair => !(pair.Item1 > 0)))
            {
                throw json.Wrong("should have no chance below 0, and lengths above 0");
            }
            return new Markov(
                layer, states, matrix, json["gap"].Within(1e-3, 1e9), json["positive"].Number, json["negative"].Number, tags, lengths,
                modes);
        }

        /// <summary>Limb or kind of a state.</summary>
        private static Node Half(Node state, int place)
        {
            List<Node> both = state.Items;
            if (both.Count != 2)
            {
                throw state.Wrong("should be a limb and a kind");
            }
            return both[place];
        }

        private void ReadParameters(Node root)
        {
            Node found;
            if (root.Maybe("parameters", out found))
            {
                foreach (string name in found.Names)
                {
                    Parameters[name] = Parameter.Read(found[name]);
                }
            }
        }

        private void ReadLines(Node root)
        {
            Node found, part;
            if (!root.Maybe("lines", out found))
            {
                return;
            }
            foreach (string id in found.Names)
            {
                var line = new Line();
                line.Text = found[id].Maybe("text", out part) ? part.Text : "";
                line.Audio = found[id].Maybe("audio", out part) ? part.TextOrNull : null;
                line.Duration = found[id].Maybe("duration", out part) ? part.NumberOrNull : null;
                line.Mood = new Ask();
                line.Mood.Feel("mood", found[id].Maybe("mood", out part) ? part.Value : null);
                line.Mood.Intensity = found[id].Maybe("intensity", out part) ? part.NumberOrNull : null;
                foreach (Node ask in Glb.List(found[id], "asks"))
                {
                    try
                    {
                        line.Asks.Add(Ask.From(ask.Value));
                    }
                    catch (AskException error)
                    {
                        throw ask.Wrong(error.Message);
                    }
                }
                Lines[id] = line;
            }
            if (!root.Maybe("voices", out found))
            {
                return;
            }
            foreach (string id in found.Names)
            {
                Node voice = found[id];
                float[][] weights = voice["weights"].Items.ConvertAll(
                    row => Array.ConvertAll(row.Numbers(Voice.Visemes.Length), x => (float)x)).ToArray();
                if (weights.Length < 2)
                {
                    throw voice["weights"].Wrong("should have two rows or more");
                }
                if (Lines.ContainsKey(id))
                {
                    Voices.Known[id] = Lines[id].Voice = new Voice(voice["duration"].Number, voice["accents"].Numbers(-1), weights);
                }
            }
        }
    }
}
