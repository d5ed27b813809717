using System.Collections.Generic;
using System.Linq;

namespace Metagraph
{
    /// <summary>
    /// Hips, spine and legs that answer the arms, and feet that stay planted: what comes of what an export says of them. Made of an
    /// export; one for each player.
    /// </summary>
    public sealed class Weight
    {
        private const int Kept = 4096; // times that are remembered of a plan

        private readonly Graph graph;
        private readonly WeightRig rig;
        private readonly ContactPose pose = new ContactPose();
        private readonly List<List<double>> sways = new List<List<double>>();
        private readonly Dictionary<int, List<double>> found = new Dictionary<int, List<double>>();
        private static readonly List<double> Nothing = new List<double>();
        private static readonly List<FootGoal> Nowhere = new List<FootGoal>();
        private Plan known;

        public Weight(Graph graph)
        {
            this.graph = graph;
            rig = graph.WeightRig;
        }

        /// <summary>Change a composed pose so that its feet stay planted and the body answers its arms.</summary>
        public void Answer(Plan plan, double time, BodyPose body)
        {
            LifeSettings life = graph.Life;
            double calm = 1 - life.Stillness;
            List<double> drive = Drive(plan, time);
            List<FootGoal> feet = Feet(plan, time);
            if (feet.Count == 0 && !WeightSolveRules.MovesBody(drive))
            {
                return;
            }
            float[] r = body.Rotations, t = body.Translations;
            pose.Local.Clear();
            pose.Moved.Clear();
            foreach (int j in rig.Body.Joints)
            {
                pose.Local.Add((r[4 * j], r[4 * j + 1], r[4 * j + 2], r[4 * j + 3]));
                pose.Moved.Add((t[3 * j], t[3 * j + 1], t[3 * j + 2]));
            }
            bool moved = FeetSolveRules.PlantFeet(rig, pose, feet, life.PlantedFeet);
            if (drive.Count > 0 && WeightSolveRules.AnswerArms(rig, pose, drive, life.FollowThrough * calm, life.ShoulderLift * calm))
            {
                moved = true;
            }
            if (!moved)
            {
                return;
            }
            for (int place = 0; place < pose.Local.Count; place++)
            {
                int j = 4 * rig.Body.Joints[place];
                var q = pose.Local[place];
                r[j] = (float)q.Item1;
                r[j + 1] = (float)q.Item2;
                r[j + 2] = (float)q.Item3;
                r[j + 3] = (float)q.Item4;
            }
            var hips = pose.Moved[rig.Bends[0].Place];
            int at = 3 * rig.Body.Joints[rig.Bends[0].Place];
            t[at] = (float)hips.Item1;
            t[at + 1] = (float)hips.Item2;
            t[at + 2] = (float)hips.Item3;
        }

        /// <summary>What of the arms moves the body at a time, nothing where it does not answer them.</summary>
        private List<double> Drive(Plan plan, double time)
        {
            LifeSettings life = graph.Life;
            if (life.Stillness >= 1 || (life.FollowThrough <= 0 && life.ShoulderLift <= 0) || rig.Strength <= 0)
            {
                return Nothing;
            }
            if (plan.Layers["arms"].Cues.Count == 0)
            {
                return Nothing;
            }
            if (known != plan || found.Count >= Kept)
            {
                found.Clear();
                known = plan;
            }
            int last = FollowThroughRules.KnotBefore(time);
            sways.Clear();
            for (int n = last - FollowThroughRules.Knots + 1; n <= last; n++)
            {
                sways.Add(At(plan, n));
            }
            return FollowThroughRules.Driven(sways, time);
        }

        /// <summary>Where both feet should be at a time, nothing where nothing blends.</summary>
        private List<FootGoal> Feet(Plan plan, double time)
        {
            if (graph.Life.PlantedFeet <= 0)
            {
                return Nowhere;
            }
            LayerPlan layer = plan.Layers[graph.FeetLayer];
            int place;
            Cue cue = Playing(layer, time, out place);
            return PlantedFeetRules.FootGoals(graph, graph.FootTracks, rig.Height, layer, cue, place, time);
        }

        private List<double> At(Plan plan, int number)
        {
            List<double> sway;
            if (found.TryGetValue(number, out sway))
            {
                return sway;
            }
            double time = FollowThroughRules.KnotTime(number);
            LayerPlan arms = plan.Layers["arms"], body = plan.Layers["body"];
            int place, bodyPlace;
            Cue cue = Playing(arms, time, out place), bodyCue = Playing(body, time, out bodyPlace);
            sway = FollowThroughRules.ArmSway(
                graph, graph.ArmTracks, rig.Body.Hands, arms, cue, place, body, bodyCue, bodyPlace, time);
            found[number] = sway;
            return sway;
        }

        private static Cue Playing(LayerPlan plan, double time, out int place)
        {
            Cue cue = plan.CueAt(time);
            place = plan.Rests.Count > 0 ? plan.RestAt(time) : -1;
            return cue != null && cue.Action.Clip.Motion != null ? cue : null;
        }

        /// <summary>A weight rig, as exported. joints: how many there are.</summary>
        internal static WeightRig ReadRig(Node json, int joints)
        {
            List<int> places = json["joints"].Items.ConvertAll(j => Within(j, joints));
            List<int> parents = json["parents"].Items.ConvertAll(p => (int)p.Number);
            if (places.Count == 0 || parents.Count != places.Count || parents.Where((p, n) => p >= n || p < -1).Any())
            {
                throw json["parents"].Wrong("do not fit the joints");
            }
            var legs = new List<ContactArm>();
            foreach (Node leg in json["legs"].Items)
            {
                List<int> three = leg.Items.ConvertAll(p => Within(p, places.Count));
                if (three.Count != 3)
                {
                    throw leg.Wrong("should be three places");
                }
                var below = new List<int> { three[0] };
                for (int n = three[0] + 1; n < parents.Count; n++)
                {
                    if (below.Contains(parents[n]))
                    {
                        below.Add(n);
                    }
                }
                legs.Add(new ContactArm(three[0], three[1], three[2], below));
            }
            List<string> hands = json["hands"].Items.ConvertAll(hand => hand.Text);
            List<WeightBend> bends = json["bends"].Items.ConvertAll(b => new WeightBend(
                Within(b["place"], places.Count), Three(b["left"]), Three(b["up"]), Three(b["ahead"]), b["share"].Number));
            List<WeightCollar> collars = json["collars"].Items.ConvertAll(c => new WeightCollar(
                Within(c["place"], places.Count), Within(c["upper"], places.Count), Three(c["axis"]), (int)c["side"].Within(0, 1)));
            List<(double, double, double)> knees = json["knees"].Items.ConvertAll(Three);
            List<(double, double)> levers = json["levers"].Items.ConvertAll(Two);
            if (legs.Count != 2 || hands.Count != 2 || knees.Count != 2 || levers.Count != 2 || bends.Count == 0)
            {
                throw json.Wrong("should have two legs, hands, knees and levers, and hips");
            }
            var body = new ContactRig(
                places, parents, new Dictionary<string, int>(), legs, hands, new List<BodyCapsule>(), false, false);
            return new WeightRig(
                body, bends, collars, knees, levers, Three(json["up"]), json["height"].Number, json["strength"].Within(0, 1));
        }

        /// <summary>What the actions of arms and body weigh, by action. clips: the export's.</summary>
        internal static Dictionary<string, ArmTrack> ReadTracks(Graph graph, Node clips)
        {
            var rows = new Dictionary<string, List<List<double>>>();
            foreach (Node clip in clips.Items)
            {
                Node arms;
                rows[clip["id"].Text] = clip.Maybe("arms", out arms)
                    ? arms.Items.ConvertAll(row => row.Numbers(FollowThroughRules.Numbers).ToList())
                    : new List<List<double>>();
            }
            var tracks = new Dictionary<string, ArmTrack>();
            foreach (string layer in new[] { "arms", "body" })
            {
                foreach (GraphAction action in graph.Layers[layer].Actions.Values)
                {
                    tracks[action.Id] = new ArmTrack(action.Clip.Id, rows[action.Clip.Id]);
                }
            }
            return tracks;
        }

        /// <summary>Where the feet of the actions are of the layer that moves the legs, by action. clips: the export's.</summary>
        internal static Dictionary<string, FootTrack> ReadFeet(Graph graph, Node clips)
        {
            var rows = new Dictionary<string, List<List<double>>>();
            foreach (Node clip in clips.Items)
            {
                Node feet;
                rows[clip["id"].Text] = clip.Maybe("feet", out feet)
                    ? feet.Items.ConvertAll(row => row.Numbers(2 * PlantedFeetRules.FootNumbers).ToList())
                    : new List<List<double>>();
            }
            var tracks = new Dictionary<string, FootTrack>();
            foreach (GraphAction action in graph.Layers[graph.FeetLayer].Actions.Values)
            {
                tracks[action.Id] = new FootTrack(rows[action.Clip.Id]);
            }
            return tracks;
        }

        private static int Within(Node json, int count)
        {
            return (int)json.Within(0, count - 1);
        }

        private static (double, double, double) Three(Node json)
        {
            double[] v = json.Numbers(3);
            return (v[0], v[1], v[2]);
        }

        private static (double, double) Two(Node json)
        {
            double[] v = json.Numbers(2);
            return (v[0], v[1]);
        }
    }
}
