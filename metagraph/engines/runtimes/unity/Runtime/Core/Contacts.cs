using System;
using System.Collections.Generic;
using System.Linq;

namespace Metagraph
{
    /// <summary>
    /// Hands that stay where they touch, and out of the body: what contacts and the guard make of a composed pose. Made of an export; one
    /// for each player.
    /// </summary>
    public sealed class Contacts
    {
        private readonly Graph graph;
        private readonly ContactRig rig;
        private readonly ContactPose pose = new ContactPose();

        public Contacts(Graph graph)
        {
            this.graph = graph;
            rig = graph.ContactRig;
        }

        /// <summary>Change a pose so that hands are where contacts want them, and out of the body.</summary>
        public void Touch(Plan plan, double time, BodyPose body)
        {
            var goals = new List<HandGoal>();
            foreach (string layer in rig.Contacts ? Basics.Layers : new string[0])
            {
                double strength = graph.Layers[layer].Strength;
                if (strength <= 0)
                {
                    continue;
                }
                LayerPlan of = plan.Layers[layer];
                Cue cue = of.CueAt(time);
                cue = cue != null && cue.Action.Clip.Motion != null ? cue : null;
                int place = of.Rests.Count > 0 ? of.RestAt(time) : -1;
                goals.AddRange(ContactGoalsRules.LayerGoals(rig, graph, of, cue, place, time, strength));
            }
            if (goals.Count == 0 && !rig.Guard)
            {
                return;
            }
            float[] r = body.Rotations, t = body.Translations;
            pose.Local.Clear();
            pose.Moved.Clear();
            foreach (int j in rig.Joints)
            {
                pose.Local.Add((r[4 * j], r[4 * j + 1], r[4 * j + 2], r[4 * j + 3]));
                pose.Moved.Add((t[3 * j], t[3 * j + 1], t[3 * j + 2]));
            }
            ContactSolveRules.Spread(rig, pose);
            if (!ContactSolveRules.SolveContacts(rig, pose, goals))
            {
                return;
            }
            foreach (ContactArm arm in rig.Arms)
            {
                foreach (int place in new[] { arm.Upper, arm.Lower, arm.Hand })
                {
                    int j = 4 * rig.Joints[place];
                    var q = pose.Local[place];
                    r[j] = (float)q.Item1;
                    r[j + 1] = (float)q.Item2;
                    r[j + 2] = (float)q.Item3;
                    r[j + 3] = (float)q.Item4;
                }
            }
        }

        /// <summary>An action's contacts, as exported.</summary>
        internal static List<ContactSpan> Read(Node json)
        {
            return json.Items.ConvertAll(one => new ContactSpan(
                one["hand"].Text, one["place"].Text, one["to"].Text, one["start"].Number, one["end"].Number,
                one["keys"].Items.ConvertAll(Key), one["ease_in"].Number, one["ease_out"].Number));
        }

        private static ContactKey Key(Node row)
        {
            double[] k = row.Numbers(8);
            return new ContactKey(k[0], (k[1], k[2], k[3]), (k[4], k[5], k[6], k[7]));
        }

        /// <summary>A contact rig, as exported. joints: the export's.</summary>
        internal static ContactRig ReadRig(Node json, JointInfo[] joints)
        {
            List<int> places = json["joints"].Items.ConvertAll(j => Within(j, joints.Length));
            List<int> parents = json["parents"].Items.ConvertAll(p => (int)p.Number);
            if (parents.Count != places.Count || parents.Where((p, n) => p >= n || p < -1).Any())
            {
                throw json["parents"].Wrong("do not fit the joints");
            }
            var arms = new List<ContactArm>();
            foreach (Node arm in json["arms"].Items)
            {
                List<int> three = arm.Items.ConvertAll(p => Within(p, places.Count));
                if (three.Count != 3)
                {
                    throw arm.Wrong("should be three places");
                }
                var below = new List<int> { three[0] };
                for (int n = three[0] + 1; n < parents.Count; n++)
                {
                    if (below.Contains(parents[n]))
                    {
                        below.Add(n);
                    }
                }
                arms.Add(new ContactArm(three[0], three[1], three[2], below));
            }
            if (arms.Count != 2)
            {
                throw json["arms"].Wrong("should be two");
            }
            List<BodyCapsule> capsules = json["capsules"].Items.ConvertAll(c => new BodyCapsule(
                Within(c["joint"], places.Count), Three(c["a"]), Within(c["to"], places.Count), Three(c["b"]), c["radius"].Number,
                (int)c["arm"].Within(-1, 1), (int)c["kind"].Within(0, 2)));
            var names = new Dictionary<string, int>();
            for (int n = 0; n < places.Count; n++)
            {
                names[joints[places[n]].Name] = n;
            }
            List<string> hands = arms.ConvertAll(arm => joints[places[arm.Hand]].Name);
            return new ContactRig(places, parents, names, arms, hands, capsules, json["contacts"].Flag, json["guard"].Flag);
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
    }
}
