using System;
using System.Collections.Generic;

namespace Metagraph
{
    /// <summary>Reads what of an export's character breathes and looks.</summary>
    public sealed partial class Graph
    {
        private Body ReadBody(Node json)
        {
            List<Node> breath = json["breath"].Items, shoulders = json["shoulders"].Items, lookers = json["lookers"].Items;
            var body = new Body
            {
                Left = Vector(json["left"]), Up = Vector(json["up"]), Ahead = Vector(json["ahead"]), Chain = Indices(json["chain"]),
                Breath = breath.ConvertAll(row => Vector(row.Numbers(4))).ToArray(),
                Angles = breath.ConvertAll(row => row.Numbers(4)[3]).ToArray(),
                Shoulders = shoulders.ConvertAll(one => Index(one["joint"], 0)).ToArray(),
                ShoulderTurns = shoulders.ConvertAll(one => Vector(one["turn"])).ToArray(),
                ShoulderTenses = shoulders.ConvertAll(one => Turned(one, "tense")).ToArray(),
                ShoulderCloses = shoulders.ConvertAll(one => Turned(one, "closed")).ToArray(),
                Lookers = lookers.ConvertAll(one => new Looker { Place = one["place"].Count, Share = one["share"].Number }).ToArray(),
                Trunk = json["trunk"].Count, TrunkAhead = Vector(json["trunk_ahead"]), HeadAhead = Vector(json["head_ahead"]),
                Partner = Vector(json["partner"]), EyesAtRest = Vector(json["eyes_at_rest"]),
                Eyes = json["eyes"].Items.ConvertAll(ReadEye).ToArray(), Face = ReadFace(json["face"]),
            };
            int count = body.Chain.Length;
            Node bowed, thrust;
            body.Bowed = json.Maybe("bowed", out bowed) && bowed.Items.Count > 0 ? bowed.Numbers(count) : new double[count];
            body.Thrust = json.Maybe("thrust", out thrust) && thrust.Items.Count > 0 ? thrust.Numbers(count) : new double[count];
            bool placed = Array.TrueForAll(body.Lookers, x => x.Place >= 0 && x.Place < count) && body.Trunk >= 0 && body.Trunk < count;
            if (!placed || body.Angles.Length != count || body.Eyes.Length != 2)
            {
                throw json.Wrong("should have a chain of joints, a breath for each, two eyes, and lookers within the chain");
            }
            return body;
        }

        private static Vec Turned(Node json, string name)
        {
            Node turn;
            return json.Maybe(name, out turn) ? Vector(turn) : new Vec(0, 0, 0);
        }

        private EyeAt ReadEye(Node json)
        {
            return new EyeAt
            {
                At = Vector(json["at"]), Left = Vector(json["left"]), Up = Vector(json["up"]), Ahead = Vector(json["ahead"]),
                TurnLeft = Vector(json["turn_left"]), TurnUp = Vector(json["turn_up"]), Joint = Index(json["joint"], -1),
                Down = Quaternion(json["down"]),
            };
        }

        private FaceRig ReadFace(Node json)
        {
            var face = new FaceRig
            {
                Joints = Indices(json["joints"]), LidJoints = json["lid_joints"].Items.ConvertAll(lid => Index(lid, -1)).ToArray(),
                Turns = Shapes(json["turns"]), Shifts = Shapes(json["shifts"]), Follows = json["follows"].Numbers(4),
                ShutBy = json["shut_by"].Items.ConvertAll(Quaternion).ToArray(),
            };
            bool whole = Array.TrueForAll(face.Turns, row => row.Length == face.Joints.Length)
                && Array.TrueForAll(face.Shifts, row => row.Length == face.Joints.Length);
            if (!whole || face.LidJoints.Length != 4 || face.ShutBy.Length != 4)
            {
                throw json.Wrong("should have a turn and a shift of each joint for each channel, and four lids");
            }
            face.Shifted = Array.Exists(face.Shifts, row => Array.Exists(row, v => v.X != 0 || v.Y != 0 || v.Z != 0));
            Node morphs = json["morphs"];
            foreach (string channel in morphs.Names)
            {
                int value = Enliven.ValueOf(channel);
                foreach (string target in morphs[channel].Names)
                {
                    int place = Morph(target);
                    if (value >= 0)
                    {
                        face.Morphs.Add(new MorphShare { Value = value, Target = place, Weight = morphs[channel][target].Number });
                    }
                }
            }
            return face;
        }

        private static Vec[][] Shapes(Node json)
        {
            List<Node> rows = json.Items;
            if (rows.Count != FaceRig.Channels)
            {
                throw json.Wrong("should have " + FaceRig.Channels + " channels");
            }
            return rows.ConvertAll(row => row.Items.ConvertAll(Vector).ToArray()).ToArray();
        }

        private int Index(Node json, int least)
        {
            int found = json.Count;
            if (found < least || found >= Joints.Length)
            {
                throw json.Wrong("is no joint");
            }
            return found;
        }

        private int[] Indices(Node json)
        {
            return json.Items.ConvertAll(one => Index(one, 0)).ToArray();
        }

        private static Vec Vector(Node json)
        {
            return Vector(json.Numbers(3));
        }

        private static Vec Vector(double[] numbers)
        {
            return new Vec(numbers[0], numbers[1], numbers[2]);
        }

        private static Quat Quaternion(Node json)
        {
            double[] q = json.Numbers(4);
            return new Quat(q[0], q[1], q[2], q[3]);
        }
    }
}
