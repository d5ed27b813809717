using System.Collections.Generic;

namespace Metagraph
{
    /// <summary>A vector of three doubles, and the few operations on it that the life layers need.</summary>
    public struct Vec
    {
        public double X, Y, Z;

        public Vec(double x, double y, double z)
        {
            X = x;
            Y = y;
            Z = z;
        }

        public static Vec operator +(Vec a, Vec b)
        {
            return new Vec(a.X + b.X, a.Y + b.Y, a.Z + b.Z);
        }

        public static Vec operator -(Vec a, Vec b)
        {
            return new Vec(a.X - b.X, a.Y - b.Y, a.Z - b.Z);
        }

        public static Vec operator *(Vec a, double k)
        {
            return new Vec(a.X * k, a.Y * k, a.Z * k);
        }

        public static double Dot(Vec a, Vec b)
        {
            return a.X * b.X + a.Y * b.Y + a.Z * b.Z;
        }
    }

    /// <summary>A joint that takes part in turning the head: its place in the chain, its share; all shares sum to 1.</summary>
    public struct Looker
    {
        public int Place;
        public double Share;
    }

    /// <summary>
    /// An eye, or where one would be, in the head's own space. Joint: its place, -1 for none. TurnLeft, TurnUp: rotation vectors in
    /// the joint's space that turn it a radian. Down: what the joint's rotation says about how far down it looks already.
    /// </summary>
    public sealed class EyeAt
    {
        public Vec At, Left, Up, Ahead, TurnLeft, TurnUp;
        public int Joint;
        public Quat Down;
    }

    /// <summary>
    /// What moves a face: joints [F] with turns [C][F] (rotation vectors in the joint's space) and shifts [C][F] (metres in the parent's)
    /// at 1 of each channel, and morph targets by channel. Lids: upper left, upper right, lower left, lower right.
    /// </summary>
    public sealed class FaceRig
    {
        public const int Channels = 20, Blink = 4, JawOpen = 5; // lids, blink, jaw_open, then the visemes but silence
        public int[] Joints, LidJoints;
        public Vec[][] Turns, Shifts;
        public double[] Follows;
        public Quat[] ShutBy;
        public bool Shifted;
        /// <summary>Value of the face, place of the morph target among the graph's, weight at 1.</summary>
        public readonly List<MorphShare> Morphs = new List<MorphShare>();
    }

    public struct MorphShare
    {
        public int Value, Target;
        public double Weight;
    }

    /// <summary>
    /// What of the character breathes and looks. Directions Left, Up, Ahead are the character's; metres. Chain: joints from the root
    /// to the head. Breath: for each the axis it turns about in its own space, Angles: radians at the top of a breath, Bowed: of a bowed
    /// posture, Thrust: of one that leans into it. ShoulderTenses: how the same joints as of ShoulderTurns turn at full tension,
    /// ShoulderCloses: where the arms are kept close.
    /// </summary>
    public sealed class Body
    {
        public Vec Left, Up, Ahead, TrunkAhead, HeadAhead, Partner, EyesAtRest;
        public int[] Chain, Shoulders;
        public Vec[] Breath, ShoulderTurns, ShoulderTenses, ShoulderCloses;
        public double[] Angles, Bowed, Thrust;
        public Looker[] Lookers;
        public int Trunk;
        public EyeAt[] Eyes;
        public FaceRig Face;
    }
}
