// Translated from metagraph/motion/weight_solve.py; change that, and translate anew.
using System;
using System.Collections.Generic;
using System.Linq;

namespace Metagraph
{
    /// <summary>
    /// A joint that turns. left, up, ahead: the character's directions in its own space. share: of the hips' rotation, below 0
    /// for the opposite direction.
    /// </summary>
    public sealed class WeightBend
    {
        public readonly int Place;
        public readonly (double, double, double) Left;
        public readonly (double, double, double) Up;
        public readonly (double, double, double) Ahead;
        public readonly double Share;

        public WeightBend(
            int place,
            (double, double, double) left,
            (double, double, double) up,
            (double, double, double) ahead,
            double share
        )
        {
            Place = place;
            Left = left;
            Up = up;
            Ahead = ahead;
            Share = share;
        }
    }

    /// <summary>
    /// A collar bone. upper: the place of its arm. axis: what lifts it, in its own space. side: 0 left, 1 right.
    /// </summary>
    public sealed class WeightCollar
    {
        public readonly int Place;
        public readonly int Upper;
        public readonly (double, double, double) Axis;
        public readonly int Side;

        public WeightCollar(int place, int upper, (double, double, double) axis, int side)
        {
            Place = place;
            Upper = upper;
            Axis = axis;
            Side = side;
        }
    }

    /// <summary>
    /// The part of a skeleton that reacts to its arms. body: its joints; its `arms` are the legs, left and right, its `hands` the
    /// names of the hands. bends: from the hips up. knees: the direction in which straight legs bend, in the upper legs' own
    /// spaces. levers: how far the arms are to the left and ahead of the hips. up: the character's up direction. height: of the
    /// figure, metres. strength: how much of the arms' layer counts, 0..1.
    /// </summary>
    public sealed class WeightRig
    {
        public readonly ContactRig Body;
        public readonly List<WeightBend> Bends;
        public readonly List<WeightCollar> Collars;
        public readonly List<(double, double, double)> Knees;
        public readonly List<(double, double)> Levers;
        public readonly (double, double, double) Up;
        public readonly double Height;
        public readonly double Strength;

        public WeightRig(
            ContactRig body,
            List<WeightBend> bends,
            List<WeightCollar> collars,
            List<(double, double, double)> knees,
            List<(double, double)> levers,
            (double, double, double) up,
            double height,
            double strength
        )
        {
            Body = body;
            Bends = bends;
            Collars = collars;
            Knees = knees;
            Levers = levers;
            Up = up;
            Height = height;
            Strength = strength;
        }
    }

    public static class WeightSolveRules
    {
        public const double Balance = 1.4; // factor of the arms' shift of the centre of mass by which the hips compensate
        public const double Haste = 0.12; // seconds of the arms' speed that are added to the shift
        public const double Dip = 0.05; // seconds: arms that rise this fast press the body down, half as far at most
        public const double Spin = 30.0; // seconds: how far the pelvis turns against what arms turn about the vertical
        public const double Roll = 3.0; // radians that the pelvis rolls for a shift to a side of its own height, and
        public const double Pitch = 2.0; // bends for one ahead or back
        public const double MostShift = 0.02; // of the height
        public const double MostTurn = 0.1; // radians
        // how high a hip is above its ankle, of the leg's length: below this it does not stand
        public const double Sitting = 0.75;
        public const double Standing = 0.15; // and this much above it stands altogether
        public const double Give = 0.5; // of a shift: over so much a leg's full length makes itself felt

        /// <summary>Return whether there is anything to react to.</summary>
        public static bool MovesBody(List<double> drive)
        {
            return drive.Any(x => x != 0.0);
        }

        /// <summary>
        /// Change a pose of the rig's joints in reaction to its arms; return whether it changed.
        ///
        /// drive: as `posing.follow_through.driven` returns it. follow, lift: the user's dials. You need not call `spread` first.
        /// </summary>
        public static bool AnswerArms(WeightRig rig, ContactPose pose, List<double> drive, double follow, double lift)
        {
            follow = follow * rig.Strength;
            lift = lift * rig.Strength;
            if ((follow <= 0.0 && lift <= 0.0) || !MovesBody(drive))
            {
                return false;
            }
            foreach (WeightCollar collar in rig.Collars)
            {
                var turn = Turn(collar.Axis, lift * drive[6 + collar.Side]);
                pose.Local[collar.Place] = PlainVectorsRules.Times(pose.Local[collar.Place], turn);
                pose.Local[collar.Upper] = PlainVectorsRules.Times(PlainVectorsRules.Back(turn), pose.Local[collar.Upper]);
            }
            if (follow <= 0.0)
            {
                return true;
            }
            ContactSolveRules.Spread(rig.Body, pose);
            follow = follow * StandsBy(rig, pose);
            if (follow <= 0.0)
            {
                return true;
            }
            GiveWay(rig, pose, drive, follow);
            return true;
        }

        /// <summary>Return how much a figure stands: 0 if it sits or lies, 1 on straight legs.</summary>
        public static double StandsBy(WeightRig rig, ContactPose pose)
        {
            var least = 1.0;
            foreach (ContactArm leg in rig.Body.Arms)
            {
                var hip = pose.At[leg.Upper];
                var knee = pose.At[leg.Lower];
                var ankle = pose.At[leg.Hand];
                var whole = PlainVectorsRules.Length(PlainVectorsRules.Minus(knee, hip))
                    + PlainVectorsRules.Length(PlainVectorsRules.Minus(ankle, knee));
                if (whole > 1e-06)
                {
                    least = Math.Min(least, PlainVectorsRules.Dot(PlainVectorsRules.Minus(hip, ankle), rig.Up) / whole);
                }
            }
            var x = Math.Min(Math.Max((least - Sitting) / Standing, 0.0), 1.0);
            return x * x * (3.0 - 2.0 * x);
        }

        /// <summary>Shift and rotate the hips, undo that in the spine, and move the legs so that the feet stay.</summary>
        private static void GiveWay(WeightRig rig, ContactPose pose, List<double> drive, double follow)
        {
            var body = rig.Body;
            var vx = drive[8] + drive[11];
            var vy = drive[9] + drive[12];
            var vz = drive[10] + drive[13];
            var spin = 0.0;
            foreach (var one in rig.Levers.Select((item, n) => (n, item)))
            {
                var side = one.Item1;
                var lever = one.Item2;
                var found = lever;
                double lx = found.Item1;
                double lz = found.Item2;
                spin += lz * drive[8 + 3 * side] - lx * drive[10 + 3 * side];
            }
            var most = MostShift * rig.Height;
            var x = Soft(-follow * Balance * (drive[0] + drive[3] + Haste * vx), most);
            var y = Soft(-follow * Dip * vy, 0.5 * most);
            var z = Soft(-follow * Balance * (drive[2] + drive[5] + Haste * vz), most);
            var yaw = Soft(-follow * Spin * spin / (rig.Height * rig.Height), MostTurn);
            var roll = Roll * x / rig.Height;
            var pitch = -Pitch * z / rig.Height;
            var feet = body.Arms.Select(leg => pose.At[leg.Hand]).ToList();
            var soles = body.Arms.Select(leg => pose.Turned[leg.Hand]).ToList();
            var reaches = body.Arms.Select(leg => PlainVectorsRules.Length(
                PlainVectorsRules.Minus(pose.At[leg.Hand], pose.At[leg.Upper])
            )).ToList();
            var hips = rig.Bends[0];
            var shift = PlainVectorsRules.Plus(
                PlainVectorsRules.Plus(PlainVectorsRules.Scaled(hips.Left, x), PlainVectorsRules.Scaled(hips.Up, y)),
                PlainVectorsRules.Scaled(hips.Ahead, z)
            );
            shift = PlainVectorsRules.Rotated(pose.Turned[hips.Place], shift);
            foreach (WeightBend bend in rig.Bends)
            {
                var axis = PlainVectorsRules.Plus(
                    PlainVectorsRules.Plus(PlainVectorsRules.Scaled(bend.Left, pitch), PlainVectorsRules.Scaled(bend.Up, yaw)),
                    PlainVectorsRules.Scaled(bend.Ahead, roll)
                );
                pose.Local[bend.Place] = PlainVectorsRules.Times(pose.Local[bend.Place], Turn(axis, bend.Share));
            }
            var above = body.Parents[hips.Place];
            var space = above < 0 ? (0.0, 0.0, 0.0, 1.0) : PlainVectorsRules.Back(pose.Turned[above]);
            pose.Moved[hips.Place] = PlainVectorsRules.Plus(pose.Moved[hips.Place], PlainVectorsRules.Rotated(space, shift));
            ContactSolveRules.Spread(body, pose);
            var size = PlainVectorsRules.Length((x, y, z)) + 0.1 * rig.Height * PlainVectorsRules.Length((yaw, roll, pitch));
            var low = 0.0;
            for (int side = 0; side < feet.Count; side++)
            {
                low = Math.Max(low, HipsSink(rig, pose, side, feet[side], reaches[side], Give * size));
            }
            if (low > 0.0)
            {
                var down = PlainVectorsRules.Rotated(space, PlainVectorsRules.Scaled(rig.Up, -low));
                pose.Moved[hips.Place] = PlainVectorsRules.Plus(pose.Moved[hips.Place], down);
                ContactSolveRules.Spread(body, pose);
            }
            for (int side = 0; side < feet.Count; side++)
            {
                ContactSolveRules.Bring(body, pose, side, feet[side], soles[side], rig.Knees[side]);
            }
        }

        /// <summary>
        /// Return how far the hips have to sink so that the leg reaches the foot. It sets in gently, a little before the limit.
        /// reach: the distance of hip and foot before.
        /// </summary>
        public static double HipsSink(
            WeightRig rig,
            ContactPose pose,
            int side,
            (double, double, double) foot,
            double reach,
            double soft
        )
        {
            var leg = rig.Body.Arms[side];
            var hip = pose.At[leg.Upper];
            var knee = pose.At[leg.Lower];
            var ankle = pose.At[leg.Hand];
            var whole = PlainVectorsRules.Length(PlainVectorsRules.Minus(knee, hip))
                + PlainVectorsRules.Length(PlainVectorsRules.Minus(ankle, knee));
            var most = Math.Max(ContactSolveRules.Reached * whole, reach);
            var way = PlainVectorsRules.Minus(hip, foot);
            var high = PlainVectorsRules.Dot(way, rig.Up);
            var aside = PlainVectorsRules.Dot(way, way) - high * high;
            if (high <= 0.0 || aside >= most * most || soft <= 0.0)
            {
                return 0.0;
            }
            var over = high - Math.Sqrt(most * most - aside);
            if (over >= soft)
            {
                return over;
            }
            return over <= -soft ? 0.0 : (over + soft) * (over + soft) / (4.0 * soft);
        }

        /// <summary>Return a number limited smoothly to below `most`; small numbers stay almost as they are.</summary>
        private static double Soft(double x, double most)
        {
            return x / Math.Sqrt(1.0 + x / most * (x / most));
        }

        /// <summary>Return the rotation about an axis by its length times an angle, radians.</summary>
        private static (double, double, double, double) Turn((double, double, double) axis, double angle)
        {
            var found = axis;
            double x = found.Item1;
            double y = found.Item2;
            double z = found.Item3;
            var size = PlainVectorsRules.Length(axis);
            if (size <= 0.0)
            {
                return (0.0, 0.0, 0.0, 1.0);
            }
            var half = 0.5 * size * angle;
            var k = Math.Sin(half) / size;
            return (x * k, y * k, z * k, Math.Cos(half));
        }
    }
}
