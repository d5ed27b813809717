// Translated from metagraph/motion/contact_solve.py; change that, and translate anew.
using System;
using System.Collections.Generic;
using System.Linq;

namespace Metagraph
{
    /// <summary>The places of an arm's joints, and of all joints from its upper arm on, parents first.</summary>
    public sealed class ContactArm
    {
        public readonly int Upper;
        public readonly int Lower;
        public readonly int Hand;
        public readonly List<int> Below;

        public ContactArm(int upper, int lower, int hand, List<int> below)
        {
            Upper = upper;
            Lower = lower;
            Hand = hand;
            Below = below;
        }
    }

    /// <summary>
    /// A part of the body. joint, to: the places of the joints that carry the ends of its line; a, b: where the ends are, in the
    /// spaces of those joints. arm: 0 left, 1 right, -1 neither. kind: whether it is pushed out of others: an OBSTACLE is not; a
    /// FOREARM, from the elbow to the wrist, and a HAND are.
    /// </summary>
    public sealed class BodyCapsule
    {
        public readonly int Joint;
        public readonly (double, double, double) A;
        public readonly int To;
        public readonly (double, double, double) B;
        public readonly double Radius;
        public readonly int Arm;
        public readonly int Kind;

        public BodyCapsule(
            int joint,
            (double, double, double) a,
            int to,
            (double, double, double) b,
            double radius,
            int arm = -1,
            int kind = 0
        )
        {
            Joint = joint;
            A = a;
            To = to;
            B = b;
            Radius = radius;
            Arm = arm;
            Kind = kind;
        }
    }

    /// <summary>
    /// The part of a skeleton that contacts need. joints: parents first. parents: for each joint, the place of its parent, -1 for
    /// a root. places: joint name -&gt; place. arms: left, right; hands: the names of their hands. contacts, guard: whether each
    /// is on.
    /// </summary>
    public sealed class ContactRig
    {
        public readonly List<int> Joints;
        public readonly List<int> Parents;
        public readonly Dictionary<string, int> Places;
        public readonly List<ContactArm> Arms;
        public readonly List<string> Hands;
        public readonly List<BodyCapsule> Capsules;
        public readonly bool Contacts;
        public readonly bool Guard;

        public ContactRig(
            List<int> joints,
            List<int> parents,
            Dictionary<string, int> places,
            List<ContactArm> arms,
            List<string> hands,
            List<BodyCapsule> capsules,
            bool contacts = true,
            bool guard = true
        )
        {
            Joints = joints;
            Parents = parents;
            Places = places;
            Arms = arms;
            Hands = hands;
            Capsules = capsules;
            Contacts = contacts;
            Guard = guard;
        }
    }

    /// <summary>
    /// Where a wrist should be. arm: 0 left, 1 right. to: a place; at, turn: in its space. weight: 0..1.
    /// </summary>
    public sealed class HandGoal
    {
        public readonly int Arm;
        public readonly int To;
        public readonly (double, double, double) At;
        public readonly (double, double, double, double) Turn;
        public readonly double Weight;

        public HandGoal(int arm, int to, (double, double, double) at, (double, double, double, double) turn, double weight)
        {
            Arm = arm;
            To = to;
            At = at;
            Turn = turn;
            Weight = weight;
        }
    }

    /// <summary>
    /// A pose of a rig's joints: `local` rotations and `moved` translations are in the parents' space; `turned` and `at` are in
    /// the character's space, and `spread` computes them.
    /// </summary>
    public sealed class ContactPose
    {
        public List<(double, double, double, double)> Local;
        public List<(double, double, double)> Moved;
        public List<(double, double, double, double)> Turned;
        public List<(double, double, double)> At;

        public ContactPose(
            List<(double, double, double, double)> local = null,
            List<(double, double, double)> moved = null,
            List<(double, double, double, double)> turned = null,
            List<(double, double, double)> at = null
        )
        {
            Local = local ?? new List<(double, double, double, double)>();
            Moved = moved ?? new List<(double, double, double)>();
            Turned = turned ?? new List<(double, double, double, double)>();
            At = at ?? new List<(double, double, double)>();
        }
    }

    public static class ContactSolveRules
    {
        public const double Reached = 0.995; // of an arm's length: it does not snap straight
        public const double Folded = 0.906; // cosine of the least angle inside an elbow, 25 degrees
        public const double Wrist = 0.819; // cosine of half of how far a contact may turn a hand from where it was, 70 degrees
        public const double Soft = 0.006; // metres of depth over which the push out of the body sets in
        public const double Firm = 0.03; // metres of depth from which on a part resists what pushes towards it
        public const double Through = 0.25; // of both radii: who is nearer to the other's line passes through it
        public const double Full = 0.9; // from here on, it is pushed all the way
        public const double Even = 0.05; // how much the middle counts where lines are side by side
        // where a straight arm bends to: no side in particular, but always one
        public static readonly (double, double, double) Straight = (0.31, 0.52, 0.8);
        public const double Elbow = 0.3; // how little a forearm is pushed near its elbow, which a wrist cannot move
        public const int Passes = 3; // of the guard
        public const int Obstacle = 0; // what a capsule is to the guard: others are pushed out of it
        public const int Forearm = 1; // pushed out, from the elbow to the wrist
        public const int Hand = 2; // pushed out

        /// <summary>Compute where all joints are.</summary>
        public static void Spread(ContactRig rig, ContactPose pose)
        {
            pose.Turned = pose.Local.ToList();
            pose.At = pose.Moved.ToList();
            for (int place = 0; place < rig.Parents.Count; place++)
            {
                Join(rig, pose, place);
            }
        }

        private static void Join(ContactRig rig, ContactPose pose, int place)
        {
            var above = rig.Parents[place];
            if (above < 0)
            {
                pose.Turned[place] = pose.Local[place];
                pose.At[place] = pose.Moved[place];
            }
            else
            {
                var turn = pose.Turned[above];
                var found = PlainVectorsRules.Rotated(turn, pose.Moved[place]);
                double x = found.Item1;
                double y = found.Item2;
                double z = found.Item3;
                var found2 = pose.At[above];
                double ax = found2.Item1;
                double ay = found2.Item2;
                double az = found2.Item3;
                pose.Turned[place] = PlainVectorsRules.Times(turn, pose.Local[place]);
                pose.At[place] = (ax + x, ay + y, az + z);
            }
        }

        /// <summary>
        /// Move hands to their goals, then push hands and forearms out of the body; return whether anything moved. Call `spread`
        /// first.
        /// </summary>
        public static bool SolveContacts(ContactRig rig, ContactPose pose, List<HandGoal> goals)
        {
            var moved = false;
            var held = new List<double> { 0.0, 0.0 };
            var across = 0.0; // how much one arm is held on the other
            foreach (HandGoal goal in goals)
            {
                held[goal.Arm] = Math.Min(1.0, held[goal.Arm] + goal.Weight);
                if (OnArm(rig, goal.To, 1 - goal.Arm))
                {
                    across = Math.Max(across, goal.Weight);
                }
            }
            var rounds = goals.Count == 0 ? 0 : across > 0.0 ? 2 : 1;
            var wrists = rig.Arms.Select(arm => pose.At[arm.Hand]).ToList();
            var hands = rig.Arms.Select(arm => pose.Turned[arm.Hand]).ToList();
            while (rounds > 0)
            {
                rounds -= 1;
                for (int side = 0; side < rig.Arms.Count; side++)
                {
                    if (held[side] > 0.0)
                    {
                        Hold(rig, pose, goals, side, wrists[side], hands[side]);
                        moved = true;
                    }
                }
            }
            var kept = rig.Arms.Select(arm => pose.At[arm.Hand]).ToList();
            if (rig.Guard && Guarded(rig, pose, held, across))
            {
                moved = true;
                for (int side = 0; side < rig.Arms.Count; side++)
                {
                    if (across > 0.0 && held[side] > 0.0)
                    {
                        var pushed = PlainVectorsRules.Minus(pose.At[rig.Arms[side].Hand], kept[side]);
                        Hold(rig, pose, goals, side, PlainVectorsRules.Plus(wrists[side], pushed), hands[side]);
                    }
                }
            }
            return moved;
        }

        private static bool OnArm(ContactRig rig, int place, int arm)
        {
            return rig.Arms[arm].Below.Any(below => place == below);
        }

        /// <summary>
        /// Move a hand to the weighted mean of its goals. wrist, hand: its position and rotation without goals.
        /// </summary>
        private static void Hold(
            ContactRig rig,
            ContactPose pose,
            List<HandGoal> goals,
            int side,
            (double, double, double) wrist,
            (double, double, double, double) hand
        )
        {
            var total = 0.0;
            var x = 0.0;
            var y = 0.0;
            var z = 0.0;
            var a = 0.0;
            var b = 0.0;
            var c = 0.0;
            var d = 0.0;
            var found = hand;
            double hx = found.Item1;
            double hy = found.Item2;
            double hz = found.Item3;
            double hw = found.Item4;
            double k = default(double);
            foreach (HandGoal goal in goals)
            {
                if (goal.Arm == side && goal.Weight > 0.0)
                {
                    k = goal.Weight;
                    var found2 = PlainVectorsRules.Plus(
                        pose.At[goal.To],
                        PlainVectorsRules.Rotated(pose.Turned[goal.To], goal.At)
                    );
                    double px = found2.Item1;
                    double py = found2.Item2;
                    double pz = found2.Item3;
                    var found3 = PlainVectorsRules.Times(pose.Turned[goal.To], goal.Turn);
                    double qx = found3.Item1;
                    double qy = found3.Item2;
                    double qz = found3.Item3;
                    double qw = found3.Item4;
                    x = x + k * px;
                    y = y + k * py;
                    z = z + k * pz;
                    total = total + k;
                    if (qx * hx + qy * hy + qz * hz + qw * hw < 0.0)
                    {
                        k = -k;
                    }
                    a = a + k * qx;
                    b = b + k * qy;
                    c = c + k * qz;
                    d = d + k * qw;
                }
            }
            var weight = Math.Min(1.0, total);
            var mean = (x / total, y / total, z / total);
            var turn = WithinWrist(hand, PlainVectorsRules.UnitTurn((a, b, c, d)));
            var found4 = turn;
            double tx = found4.Item1;
            double ty = found4.Item2;
            double tz = found4.Item3;
            double tw = found4.Item4;
            var rest = 1.0 - weight;
            k = tx * hx + ty * hy + tz * hz + tw * hw < 0.0 ? -weight : weight;
            turn = PlainVectorsRules.UnitTurn((hx * rest + tx * k, hy * rest + ty * k, hz * rest + tz * k, hw * rest + tw * k));
            Bring(
                rig,
                pose,
                side,
                PlainVectorsRules.Plus(wrist, PlainVectorsRules.Scaled(PlainVectorsRules.Minus(mean, wrist), weight)),
                turn,
                Straight
            );
        }

        /// <summary>Return a hand's rotation, limited to what the wrist allows from the hand's earlier rotation.</summary>
        private static (double, double, double, double) WithinWrist(
            (double, double, double, double) hand,
            (double, double, double, double) turn
        )
        {
            var found = PlainVectorsRules.Times(turn, PlainVectorsRules.Back(hand));
            double x = found.Item1;
            double y = found.Item2;
            double z = found.Item3;
            double w = found.Item4;
            if (w < 0.0)
            {
                x = -x;
                y = -y;
                z = -z;
                w = -w;
            }
            if (w >= Wrist)
            {
                return turn;
            }
            var k = Math.Sqrt(1.0 - Wrist * Wrist) / Math.Max(Math.Sqrt(x * x + y * y + z * z), 1e-12);
            return PlainVectorsRules.Times((x * k, y * k, z * k, Wrist), hand);
        }

        /// <summary>
        /// Move a wrist to a goal, or as near as the arm reaches, with the elbow on the side to which it is bent; rotate the
        /// hand. side_of: the direction in which a straight arm bends, in the upper arm's own space.
        /// </summary>
        public static void Bring(
            ContactRig rig,
            ContactPose pose,
            int side,
            (double, double, double) goal,
            (double, double, double, double) hand,
            (double, double, double) sideOf
        )
        {
            var arm = rig.Arms[side];
            var root = pose.At[arm.Upper];
            var elbow = pose.At[arm.Lower];
            var wrist = pose.At[arm.Hand];
            var bone = PlainVectorsRules.Minus(elbow, root);
            var fore = PlainVectorsRules.Minus(wrist, elbow);
            var aboveElbow = PlainVectorsRules.Length(bone);
            var belowElbow = PlainVectorsRules.Length(fore);
            var now = PlainVectorsRules.Length(PlainVectorsRules.Minus(wrist, root));
            if (aboveElbow < 1e-06 || belowElbow < 1e-06 || now < 1e-06)
            {
                return;
            }
            var way = PlainVectorsRules.Minus(goal, root);
            var most = Math.Max(Reached * (aboveElbow + belowElbow), now);
            var least = Math.Min(
                Math.Sqrt(aboveElbow * aboveElbow + belowElbow * belowElbow - 2.0 * Folded * aboveElbow * belowElbow),
                now
            );
            var far = Math.Min(Math.Max(PlainVectorsRules.Length(way), least), most);
            var ahead = PlainVectorsRules.Unit(way);
            var before = PlainVectorsRules.Scaled(PlainVectorsRules.Minus(wrist, root), 1.0 / now);
            var aside = PlainVectorsRules.Minus(bone, PlainVectorsRules.Scaled(before, PlainVectorsRules.Dot(bone, before)));
            // A straight arm has no side: it bends to one that goes with its bone.
            var spare = PlainVectorsRules.Rotated(pose.Turned[arm.Upper], sideOf);
            spare = PlainVectorsRules.Minus(spare, PlainVectorsRules.Scaled(before, PlainVectorsRules.Dot(spare, before)));
            aside = PlainVectorsRules.Plus(
                aside,
                PlainVectorsRules.Scaled(spare, Math.Max(0.0, 0.01 * aboveElbow - PlainVectorsRules.Length(aside)))
            );
            aside = PlainVectorsRules.Unit(PlainVectorsRules.Rotated(PlainVectorsRules.Between(before, ahead), aside));
            var along = (aboveElbow * aboveElbow + far * far - belowElbow * belowElbow) / (2.0 * far);
            var high = Math.Sqrt(Math.Max(0.0, aboveElbow * aboveElbow - along * along));
            var knee = PlainVectorsRules.Plus(PlainVectorsRules.Scaled(ahead, along), PlainVectorsRules.Scaled(aside, high));
            var swing = PlainVectorsRules.Between(PlainVectorsRules.Unit(bone), PlainVectorsRules.Unit(knee));
            var fold = PlainVectorsRules.Between(
                PlainVectorsRules.Unit(PlainVectorsRules.Rotated(swing, fore)),
                PlainVectorsRules.Unit(PlainVectorsRules.Minus(PlainVectorsRules.Scaled(ahead, far), knee))
            );
            var both = PlainVectorsRules.Times(fold, swing);
            var above = Above(rig, pose, arm.Upper);
            pose.Local[arm.Upper] = PlainVectorsRules.Times(
                PlainVectorsRules.Back(above),
                PlainVectorsRules.Times(swing, pose.Turned[arm.Upper])
            );
            above = PlainVectorsRules.Times(swing, Above(rig, pose, arm.Lower));
            pose.Local[arm.Lower] = PlainVectorsRules.Times(
                PlainVectorsRules.Back(above),
                PlainVectorsRules.Times(both, pose.Turned[arm.Lower])
            );
            above = PlainVectorsRules.Times(both, Above(rig, pose, arm.Hand));
            pose.Local[arm.Hand] = PlainVectorsRules.Times(PlainVectorsRules.Back(above), hand);
            foreach (int place in arm.Below)
            {
                Join(rig, pose, place);
            }
        }

        private static (double, double, double, double) Above(ContactRig rig, ContactPose pose, int place)
        {
            var above = rig.Parents[place];
            return above < 0 ? (0.0, 0.0, 0.0, 1.0) : pose.Turned[above];
        }

        /// <summary>
        /// Push forearms and hands out of the capsules they are inside, by the smallest shift of the wrists; return whether any
        /// was inside. held: how much a contact holds each hand, which is then not pushed.
        ///
        /// An arm that passes through a capsule is pushed to one side before the middle and to the other side after it. The push
        /// gets weaker towards the middle, so that the arm does not jump.
        /// </summary>
        private static bool Guarded(ContactRig rig, ContactPose pose, List<double> held, double across)
        {
            var local = pose.Local.ToList();
            var turned = pose.Turned.ToList();
            var at = pose.At.ToList();
            var whole = new List<double> { 1.0, 1.0 };
            var moved = false;
            for (int number = 0; number < Passes; number++)
            {
                var ends = CapsuleEnds(rig, pose);
                var balls = Balls(rig, ends);
                var found = false;
                var first = number == 0;
                var shifts = PlainNumbers.Range(rig.Arms.Count).Select(side => Shift(
                    rig,
                    ends,
                    balls,
                    side,
                    held,
                    across,
                    whole,
                    first
                )).ToList();
                foreach (var one in shifts.Select((item, n) => (n, item)))
                {
                    var side = one.Item1;
                    var shift = one.Item2;
                    if (PlainVectorsRules.Length(shift) > 0.0)
                    {
                        var hand = rig.Arms[side].Hand;
                        Bring(rig, pose, side, PlainVectorsRules.Plus(pose.At[hand], shift), pose.Turned[hand], Straight);
                        found = true;
                    }
                }
                if (!found)
                {
                    break;
                }
                moved = true;
            }
            if (moved && Math.Min(whole[0], whole[1]) < 1.0)
            {
                var goals = rig.Arms.Select(arm => pose.At[arm.Hand]).ToList();
                pose.Local = local;
                pose.Turned = turned;
                pose.At = at;
                foreach (var one in rig.Arms.Select((item, n) => (n, item)))
                {
                    var side = one.Item1;
                    var arm = one.Item2;
                    var way = PlainVectorsRules.Minus(goals[side], pose.At[arm.Hand]);
                    if (PlainVectorsRules.Length(way) > 0.0)
                    {
                        var goal = PlainVectorsRules.Plus(pose.At[arm.Hand], PlainVectorsRules.Scaled(way, whole[side]));
                        Bring(rig, pose, side, goal, pose.Turned[arm.Hand], Straight);
                    }
                }
            }
            return moved;
        }

        /// <summary>Return both ends of every capsule's line, one after the other.</summary>
        public static List<(double, double, double)> CapsuleEnds(ContactRig rig, ContactPose pose)
        {
            var out_ = new List<(double, double, double)>();
            foreach (BodyCapsule capsule in rig.Capsules)
            {
                out_.Add(PlainVectorsRules.Plus(
                    pose.At[capsule.Joint],
                    PlainVectorsRules.Rotated(pose.Turned[capsule.Joint], capsule.A)
                ));
                out_.Add(PlainVectorsRules.Plus(
                    pose.At[capsule.To],
                    PlainVectorsRules.Rotated(pose.Turned[capsule.To], capsule.B)
                ));
            }
            return out_;
        }

        /// <summary>Return a ball round each capsule: its middle and radius.</summary>
        private static List<(double, double, double, double)> Balls(ContactRig rig, List<(double, double, double)> ends)
        {
            var out_ = new List<(double, double, double, double)>();
            foreach (var one in rig.Capsules.Select((item, n) => (n, item)))
            {
                var n = one.Item1;
                var capsule = one.Item2;
                var found = ends[2 * n];
                double ax = found.Item1;
                double ay = found.Item2;
                double az = found.Item3;
                var found2 = ends[2 * n + 1];
                double bx = found2.Item1;
                double by = found2.Item2;
                double bz = found2.Item3;
                var x = bx - ax;
                var y = by - ay;
                var z = bz - az;
                var size = 0.5 * Math.Sqrt(x * x + y * y + z * z) + capsule.Radius;
                out_.Add((ax + 0.5 * x, ay + 0.5 * y, az + 0.5 * z, size));
            }
            return out_;
        }

        /// <summary>
        /// Return the shift of a wrist that brings its arm out of all other capsules, or closer to that. whole: for each side,
        /// the share of the shift to apply, which the first pass finds.
        /// </summary>
        private static (double, double, double) Shift(
            ContactRig rig,
            List<(double, double, double)> ends,
            List<(double, double, double, double)> balls,
            int side,
            List<double> held,
            double across,
            List<double> whole,
            bool first
        )
        {
            var shift = (0.0, 0.0, 0.0);
            var own = 1.0 - held[side];
            if (own <= 0.0)
            {
                return shift;
            }
            foreach (var one in rig.Capsules.Select((item, n) => (n, item)))
            {
                var i = one.Item1;
                var mine = one.Item2;
                if (mine.Arm != side || mine.Kind == Obstacle)
                {
                    continue;
                }
                var found = balls[i];
                double mx = found.Item1;
                double my = found.Item2;
                double mz = found.Item3;
                double size = found.Item4;
                for (int k = 0; k < balls.Count; k++)
                {
                    var found2 = balls[k];
                    double ox = found2.Item1;
                    double oy = found2.Item2;
                    double oz = found2.Item3;
                    double most = found2.Item4;
                    var dx = ox - mx;
                    var dy = oy - my;
                    var dz = oz - mz;
                    var reach = most + size;
                    if (dx * dx + dy * dy + dz * dz >= reach * reach)
                    {
                        continue; // most are nowhere near
                    }
                    var other = rig.Capsules[k];
                    if (other.Arm == side)
                    {
                        continue;
                    }
                    var share = own;
                    if (other.Arm >= 0)
                    {
                        share = Math.Min(own, 1.0 - across);
                        if (other.Kind != Obstacle) // both give way
                        {
                            share = share * (1.0 - 0.5 * (1.0 - held[other.Arm]));
                        }
                    }
                    if (share <= 0.0)
                    {
                        continue;
                    }
                    var found3 = Apart(ends, 2 * i, 2 * k);
                    double x = found3.Item1;
                    double y = found3.Item2;
                    double z = found3.Item3;
                    double gap = found3.Item4;
                    var radii = mine.Radius + other.Radius;
                    if (gap >= radii || gap < 1e-09)
                    {
                        continue;
                    }
                    var depth = radii - gap;
                    var amount = depth > Soft ? depth - 0.5 * Soft : depth * depth / (2.0 * Soft);
                    // Near to the line it is not pushed all the way, and about it not at all.
                    var inner = Math.Min(1.0, Math.Max(0.0, (gap / radii - Through) / (Full - Through)));
                    inner = inner * inner * (3.0 - 2.0 * inner);
                    if (first)
                    {
                        whole[side] = Math.Min(whole[side], 1.0 - share * (1.0 - inner));
                        inner = 1.0;
                    }
                    amount = amount * share * inner;
                    var part = mine.Kind == Forearm ? Along(ends, 2 * i, 2 * k) : 1.0;
                    var way = (x / gap, y / gap, z / gap);
                    var pushed = part * PlainVectorsRules.Dot(way, shift);
                    if (pushed < 0.0) // others push towards it: what hardly touches or hardly counts hardly resists
                    {
                        pushed = pushed * share * Math.Min(1.0, depth / Firm);
                    }
                    var left = amount - pushed;
                    if (left > 0.0)
                    {
                        shift = PlainVectorsRules.Plus(
                            shift,
                            PlainVectorsRules.Scaled(way, left * part / (part * part + Elbow * (1.0 - part)))
                        );
                    }
                }
            }
            return shift;
        }

        /// <summary>
        /// Return where on the line that begins at `ends[i]` the shortest way from the line at `ends[k]` ends, 0..1. For nearly
        /// parallel lines, where it could end anywhere, the result moves towards the middle.
        /// </summary>
        private static double Along(List<(double, double, double)> ends, int i, int k)
        {
            var a = ends[i];
            var c = ends[k];
            var u = PlainVectorsRules.Minus(ends[i + 1], a);
            var v = PlainVectorsRules.Minus(ends[k + 1], c);
            var w = PlainVectorsRules.Minus(a, c);
            var uu = PlainVectorsRules.Dot(u, u);
            var uv = PlainVectorsRules.Dot(u, v);
            var vv = PlainVectorsRules.Dot(v, v);
            var uw = PlainVectorsRules.Dot(u, w);
            var vw = PlainVectorsRules.Dot(v, w);
            if (uu <= 1e-12)
            {
                return 0.0;
            }
            var stiff = (1.0 + Even) * uu;
            var middle = 0.5 * Even * uu - uw;
            if (vv <= 1e-12)
            {
                return Math.Min(Math.Max(middle / stiff, 0.0), 1.0);
            }
            var s = Math.Min(Math.Max((vv * middle + uv * vw) / (stiff * vv - uv * uv), 0.0), 1.0);
            var t = (uv * s + vw) / vv;
            if (t < 0.0 || t > 1.0)
            {
                s = Math.Min(Math.Max((uv * Math.Min(Math.Max(t, 0.0), 1.0) + middle) / stiff, 0.0), 1.0);
            }
            return s;
        }

        /// <summary>
        /// Return the shortest way from the line that begins at `ends[k]` to the one at `ends[i]`, and its length. Its vectors
        /// are written out, since a guarded pose asks some thirty times.
        /// </summary>
        public static (double, double, double, double) Apart(List<(double, double, double)> ends, int i, int k)
        {
            var found = ends[i];
            double ax = found.Item1;
            double ay = found.Item2;
            double az = found.Item3;
            var found2 = ends[i + 1];
            double bx = found2.Item1;
            double by = found2.Item2;
            double bz = found2.Item3;
            var found3 = ends[k];
            double cx = found3.Item1;
            double cy = found3.Item2;
            double cz = found3.Item3;
            var found4 = ends[k + 1];
            double dx = found4.Item1;
            double dy = found4.Item2;
            double dz = found4.Item3;
            var ux = bx - ax;
            var uy = by - ay;
            var uz = bz - az;
            var vx = dx - cx;
            var vy = dy - cy;
            var vz = dz - cz;
            var wx = ax - cx;
            var wy = ay - cy;
            var wz = az - cz;
            var uu = ux * ux + uy * uy + uz * uz;
            var uv = ux * vx + uy * vy + uz * vz;
            var vv = vx * vx + vy * vy + vz * vz;
            var uw = ux * wx + uy * wy + uz * wz;
            var vw = vx * wx + vy * wy + vz * wz;
            var s = 0.0;
            var t = 0.0;
            if (uu > 1e-12)
            {
                var below = uu * vv - uv * uv;
                if (below > 1e-09 * uu * vv)
                {
                    s = Math.Min(Math.Max((uv * vw - vv * uw) / below, 0.0), 1.0);
                }
                if (vv > 1e-12)
                {
                    t = (uv * s + vw) / vv;
                    if (t < 0.0 || t > 1.0)
                    {
                        t = Math.Min(Math.Max(t, 0.0), 1.0);
                        s = Math.Min(Math.Max((uv * t - uw) / uu, 0.0), 1.0);
                    }
                }
                else
                {
                    s = Math.Min(Math.Max(-uw / uu, 0.0), 1.0);
                }
            }
            else if (vv > 1e-12)
            {
                t = Math.Min(Math.Max(vw / vv, 0.0), 1.0);
            }
            var x = wx + ux * s - vx * t;
            var y = wy + uy * s - vy * t;
            var z = wz + uz * s - vz * t;
            return (x, y, z, Math.Sqrt(x * x + y * y + z * z));
        }
    }
}
