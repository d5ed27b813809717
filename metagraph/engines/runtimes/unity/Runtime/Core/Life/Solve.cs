using System;

namespace Metagraph
{
    /// <summary>One pose brought to life: how head, eyes and lids turn. Angles are radians.</summary>
    internal sealed class Solve
    {
        // The head's part of a turn: next to none of a small one, then more; all that is beyond what eyes do with ease.
        private static readonly double Small = Radians(15), EyeEase = Radians(20);
        private const double TiltShare = 0.8; // of up and down the head does less
        private static readonly double TurnedAway = Radians(28); // who faces farther away than this is turned back
        private static readonly double HeadSideways = Radians(65), HeadUp = Radians(30), HeadDown = Radians(35);
        // Eyes turn freely within 0.7 of these, and never beyond.
        private static readonly double EyeSideways = Radians(32), EyeUp = Radians(26), EyeDown = Radians(30);
        private const double Free = 0.7;
        private static readonly double LookSideways = Radians(110), LookUpright = Radians(65); // beyond these nobody looks
        // What is behind is looked at ever less, so that nothing turns from one side to the other in a moment.
        private static readonly double LookBehind = Radians(120), TurnBehind = Radians(85), EyesBehind = Radians(100);
        private static readonly double TurnedBack = Radians(95); // the farthest that a body counts as turned away
        private const double Nearest = 0.25; // metres; nearer things are looked at as if they were there
        private const double Widest = -0.8; // how far lids open beyond rest, of their shutting turn

        /// <summary>The turns of the body's lookers, rotation vectors in their own space.</summary>
        public readonly Vec[] Turns;
        /// <summary>The turns of the left and the right eye to the left and up.</summary>
        public readonly double[] EyesLeft = new double[2], EyesUp = new double[2];
        private readonly Body body;
        private readonly Quat[] turned; // the chain in the character's space
        private readonly Vec[] at;

        public Solve(Body body)
        {
            this.body = body;
            Turns = new Vec[body.Lookers.Length];
            turned = new Quat[body.Chain.Length];
            at = new Vec[body.Chain.Length];
        }

        public static double Radians(double degrees)
        {
            return degrees * (Math.PI / 180.0);
        }

        private static double Hypot(double x, double y)
        {
            return Math.Sqrt(x * x + y * y);
        }

        private static double Within(double x, double limit)
        {
            return Basics.Clamp(x, -limit, limit);
        }

        /// <summary>An angle kept within a limit, and ever less of it from `behind` to half a turn.</summary>
        private static double Turning(double angle, double most, double behind)
        {
            return Within(angle, most) * (1 - Basics.Ease((Math.Abs(angle) - behind) / (Math.PI - behind)));
        }

        private static double Excess(double x, double free)
        {
            double size = Math.Max(Math.Abs(x) - free, 0.0);
            return x < 0 ? -size : size;
        }

        /// <summary>
        /// Find the turns. chain, places: the joints' rotations and translations in their parents' space. amount: of all looking; calm:
        /// of what nobody asked for; share: the head's of a turn.
        /// </summary>
        public void Look(Quat[] chain, Vec[] places, Gaze gaze, double amount, double calm, double share)
        {
            turned[0] = chain[0];
            at[0] = places[0];
            for (int n = 1; n < chain.Length; n++)
            {
                at[n] = at[n - 1] + turned[n - 1].Rotate(places[n]);
                turned[n] = turned[n - 1] * chain[n];
            }
            int top = chain.Length - 1;
            Quat head = turned[top];
            Vec eye = at[top] + head.Rotate((body.Eyes[0].At + body.Eyes[1].At) * 0.5);
            // Where the targets are, seen from there; the eyes' and the head's share of each.
            double eyesX = 0, eyesY = 0, headX = 0, headY = 0, near = 0, whole = 0;
            for (int n = 0; n < gaze.Parts.Count; n++)
            {
                GazePart part = gaze.Parts[n];
                Vec away = part.Aim.At - eye;
                double x = Vec.Dot(body.Left, away), y = Vec.Dot(body.Up, away), z = Vec.Dot(body.Ahead, away), level = Hypot(x, z);
                double side = Turning(Math.Atan2(x, z), LookSideways, LookBehind), above = Within(Math.Atan2(y, level), LookUpright);
                double weight = part.Aim.Amount * amount * (part.Aim.Asked ? 1.0 : calm);
                eyesX += part.Eyes * side;
                eyesY += part.Eyes * above;
                near += part.Eyes / Math.Max(Hypot(level, y), Nearest);
                headX += part.Head * weight * side;
                headY += part.Head * weight * above;
                whole += part.Eyes * weight;
            }
            double size;
            Vec vector = Head(headX + gaze.HeadLeft, headY + gaze.HeadUp, whole, share, out size);
            // Where that brings the eyes: every joint that turns carries what is above it along.
            Vec unit = size > 1e-12 ? vector * (1 / size) : new Vec(0, 1, 0), moved = at[body.Lookers[0].Place];
            double soFar = 0.0;
            for (int n = 0; n < body.Lookers.Length; n++)
            {
                Looker looker = body.Lookers[n];
                Turns[n] = turned[looker.Place].Inverse.Rotate(vector) * looker.Share;
                soFar += looker.Share;
                Vec end = n + 1 < body.Lookers.Length ? at[body.Lookers[n + 1].Place] : at[top];
                moved += Quat.About(unit, size * soFar).Rotate(end - at[looker.Place]);
            }
            head = Quat.About(unit, size) * head;
            // The point looked at, in the head's space; each eye turns to it the shortest way, so that it does not roll.
            double sideways = eyesX + gaze.EyesLeft, upwards = eyesY + gaze.EyesUp, far = 1 / Math.Max(near, 1e-3);
            Vec ahead = body.Left * (Math.Sin(sideways) * Math.Cos(upwards) * far) + body.Up * (Math.Sin(upwards) * far)
                + body.Ahead * (Math.Cos(sideways) * Math.Cos(upwards) * far);
            Vec inside = head.Inverse.Rotate(eye + ahead - moved);
            for (int n = 0; n < 2; n++)
            {
                EyeAt one = body.Eyes[n];
                Vec away = inside - one.At;
                double x = Vec.Dot(one.Left, away), y = Vec.Dot(one.Up, away), across = Hypot(x, y);
                double way = Turning(Math.Atan2(across, Vec.Dot(one.Ahead, away)), Math.PI, EyesBehind);
                double angle = way / Math.Max(across, 1e-12) * whole;
                Reach(n, x * angle + gaze.EyesLeft * (1 - whole), y * angle + gaze.EyesUp * (1 - whole));
            }
        }

        /// <summary>The head's turn towards a target `left` and `up` of ahead: a rotation vector of the character's, its size.</summary>
        private Vec Head(double left, double up, double amount, double share, out double size)
        {
            double beyond = Math.Min(1.0, 2 * share);
            double x = HeadPart(left, share), y = TiltShare * HeadPart(up, share);
            x += beyond * Excess(left - x, EyeEase);
            y += beyond * Excess(up - y, EyeEase);
            // A character that has turned away as a whole turns its head back; one whose head alone or body alone has, means it.
            double trunk = Gap(left, turned[body.Trunk].Rotate(body.TrunkAhead));
            double head = Gap(left, turned[turned.Length - 1].Rotate(body.HeadAhead));
            double both = Math.Max(Math.Min(trunk, head), 0.0) + Math.Min(Math.Max(trunk, head), 0.0);
            x += beyond * amount * Excess(both, Math.Max(TurnedAway, Math.Abs(left)));
            x = Within(x, HeadSideways);
            y = Basics.Clamp(y, -HeadDown, HeadUp);
            // First up, then round: the head does not tilt to a shoulder.
            double cx = Math.Cos(0.5 * x), sx = Math.Sin(0.5 * x), cy = Math.Cos(0.5 * y), sy = -Math.Sin(0.5 * y);
            double a = cx * sy, b = sx * cy, c = -sx * sy, w = cx * cy, length = Math.Sqrt(a * a + b * b + c * c);
            size = 2 * Math.Atan2(length, w);
            double k = length > 1e-12 ? size / length : 0.0;
            return body.Left * (a * k) + body.Up * (b * k) + body.Ahead * (c * k);
        }

        private double Gap(double left, Vec facing)
        {
            double x = Vec.Dot(body.Left, facing), z = Vec.Dot(body.Ahead, facing), gap = left - Math.Atan2(x, z);
            gap = gap > Math.PI ? gap - 2 * Math.PI : gap < -Math.PI ? gap + 2 * Math.PI : gap;
            return Turning(gap, TurnedBack, TurnBehind) * Basics.Ease(2 * Hypot(x, z));
        }

        /// <summary>The head's part of a turn: `share` of a wide one, next to none of a small one.</summary>
        private static double HeadPart(double angle, double share)
        {
            double size = Math.Abs(angle);
            return share * angle * size / (size + Small);
        }

        /// <summary>Keep an eye's turn within what eyes can do, softly near the limit.</summary>
        private void Reach(int eye, double left, double up)
        {
            double far = Hypot(left / EyeSideways, up / (up > 0 ? EyeUp : EyeDown));
            double k = far <= Free ? 1.0 : (Free + (1 - Free) * Math.Tanh((far - Free) / (1 - Free))) / far;
            EyesLeft[eye] = left * k;
            EyesUp[eye] = up * k;
        }

        /// <summary>How far a lid is shut: 0 open as at rest, 1 shut. down: the eye's pitch; already: how far a clip has shut it.</summary>
        public static double Lid(double down, double follow, double already, double blink)
        {
            double shut = Basics.Clamp(already + follow * down, Widest, 1.0);
            return shut + blink * (1 - shut);
        }
    }
}
