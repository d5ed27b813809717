// Translated from metagraph/motion/feet_solve.py; change that, and translate anew.
using System;
using System.Collections.Generic;
using System.Linq;

namespace Metagraph
{
    /// <summary>
    /// Where a foot's joint should be, in the character's space. planted: how firmly it stands there, 0..1. lift: height of a
    /// step above that, metres.
    /// </summary>
    public sealed class FootGoal
    {
        public readonly (double, double, double) At;
        public readonly (double, double, double, double) Turn;
        public readonly double Planted;
        public readonly double Lift;

        public FootGoal((double, double, double) at, (double, double, double, double) turn, double planted, double lift)
        {
            At = at;
            Turn = turn;
            Planted = planted;
            Lift = lift;
        }
    }

    public static class FeetSolveRules
    {
        public const double Near = 0.0001; // metres that a foot may be away before it is brought
        public const double Nearly = 0.001; // radians that it may be turned away
        public const double Follows = 0.7; // of the feet's way the hips come along
        public const double Leans = 0.1; // of the way to the foot that stands, while the other is
        public const double High = 0.05; // metres in the air
        public const double Turning = 0.15; // metres that a turn of a radian counts as way

        /// <summary>
        /// Return the distance between two places of a foot, in metres; a rotation counts as a distance, too.
        /// </summary>
        public static double FootWay(FootGoal a, FootGoal b)
        {
            var found = a.Turn;
            double ax = found.Item1;
            double ay = found.Item2;
            double az = found.Item3;
            double aw = found.Item4;
            var found2 = b.Turn;
            double bx = found2.Item1;
            double by = found2.Item2;
            double bz = found2.Item3;
            double bw = found2.Item4;
            var along = Math.Abs(ax * bx + ay * by + az * bz + aw * bw);
            var turn = 2.0 * Math.Sqrt(Math.Max(0.0, 2.0 - 2.0 * along));
            return PlainVectorsRules.Length(PlainVectorsRules.Minus(b.At, a.At)) + Turning * turn;
        }

        /// <summary>
        /// Move feet to their goals, as far as these are planted; return whether anything moved. goals: left and right, or none.
        /// strength: the user's dial. You need not call `spread` first.
        /// </summary>
        public static bool PlantFeet(WeightRig rig, ContactPose pose, List<FootGoal> goals, double strength)
        {
            if (goals.Count != 2 || strength <= 0.0)
            {
                return false;
            }
            var body = rig.Body;
            ContactSolveRules.Spread(body, pose);
            strength = strength * WeightSolveRules.StandsBy(rig, pose);
            if (strength <= 0.0)
            {
                return false;
            }
            var feet = body.Arms.Select(leg => pose.At[leg.Hand]).ToList();
            var soles = body.Arms.Select(leg => pose.Turned[leg.Hand]).ToList();
            var reaches = body.Arms.Select(leg => PlainVectorsRules.Length(
                PlainVectorsRules.Minus(pose.At[leg.Hand], pose.At[leg.Upper])
            )).ToList();
            var hips = rig.Bends[0].Place;
            var middle = pose.At[hips];
            var shift = (0.0, 0.0, 0.0);
            var size = 0.0;
            var moved = false;
            for (int side = 0; side < 2; side++)
            {
                var goal = goals[side];
                var part = strength * goal.Planted;
                var way = PlainVectorsRules.Minus(
                    PlainVectorsRules.Plus(goal.At, PlainVectorsRules.Scaled(rig.Up, goal.Lift)),
                    feet[side]
                );
                var far = PlainVectorsRules.Length(way);
                if (far > Near && part > 0.0)
                {
                    way = PlainVectorsRules.Scaled(way, part * (far - Near) / far);
                    var lean = Leans * part * goal.Lift / High;
                    shift = PlainVectorsRules.Plus(
                        shift,
                        PlainVectorsRules.Plus(
                            PlainVectorsRules.Scaled(way, 0.5 * Follows),
                            PlainVectorsRules.Scaled(PlainVectorsRules.Minus(feet[1 - side], middle), lean)
                        )
                    );
                    feet[side] = PlainVectorsRules.Plus(feet[side], way);
                    size += PlainVectorsRules.Length(way);
                    moved = true;
                }
                var found = PlainVectorsRules.Times(goal.Turn, PlainVectorsRules.Back(soles[side]));
                double x = found.Item1;
                double y = found.Item2;
                double z = found.Item3;
                double w = found.Item4;
                var turn = 2.0 * Math.Sqrt(x * x + y * y + z * z);
                if (turn > Nearly && part > 0.0)
                {
                    var k = part * (turn - Nearly) / turn;
                    var along = w < 0.0 ? -k : k; // the shorter way
                    var turned = PlainVectorsRules.UnitTurn((x * along, y * along, z * along, 1.0 - k + Math.Abs(w) * k));
                    soles[side] = PlainVectorsRules.Times(turned, soles[side]);
                    moved = true;
                }
            }
            if (!moved)
            {
                return false;
            }
            shift = PlainVectorsRules.Minus(shift, PlainVectorsRules.Scaled(rig.Up, PlainVectorsRules.Dot(shift, rig.Up)));
            var above = body.Parents[hips];
            var space = above < 0 ? (0.0, 0.0, 0.0, 1.0) : PlainVectorsRules.Back(pose.Turned[above]);
            pose.Moved[hips] = PlainVectorsRules.Plus(pose.Moved[hips], PlainVectorsRules.Rotated(space, shift));
            ContactSolveRules.Spread(body, pose);
            var soft = WeightSolveRules.Give * (size + PlainVectorsRules.Length(shift));
            var low = 0.0;
            for (int side = 0; side < 2; side++)
            {
                low = Math.Max(low, WeightSolveRules.HipsSink(rig, pose, side, feet[side], reaches[side], soft));
            }
            if (low > 0.0)
            {
                pose.Moved[hips] = PlainVectorsRules.Plus(
                    pose.Moved[hips],
                    PlainVectorsRules.Rotated(space, PlainVectorsRules.Scaled(rig.Up, -low))
                );
                ContactSolveRules.Spread(body, pose);
            }
            for (int side = 0; side < 2; side++)
            {
                ContactSolveRules.Bring(body, pose, side, feet[side], soles[side], rig.Knees[side]);
            }
            return true;
        }
    }
}
