using System;
using System.Collections.Generic;

namespace Metagraph
{
    /// <summary>A target as the gaze meets it. At: metres. Amount: 0..1. Eyes, Head: seconds their moves to it take.</summary>
    internal sealed class Aim
    {
        public double Start, Amount, Eyes, Head;
        public Vec At;
        public bool Asked, Strict;
    }

    /// <summary>A target with the eyes' and the head's share of it, all together 1.</summary>
    internal struct GazePart
    {
        public Aim Aim;
        public double Eyes, Head;
    }

    /// <summary>
    /// Where the gaze goes at a time: eased moves from target to target, with aversions and saccades on top. What is looked at is the
    /// sum of all moves so far, each from the target before, so a target may change at any time and nothing jumps:
    /// angle(t) = sum over targets i of angle_i (S_i(t) - S_{i+1}(t)), S_i: how far the move to target i has come, 0..1.
    /// </summary>
    internal sealed class Gaze
    {
        private const double EyeTime = 0.021, EyeTimePerDegree = 0.0022; // seconds
        private const double HeadLag = 0.04; // seconds the head sets off after the eyes
        private const double HeadTime = 0.55, HeadTimePerDegree = 0.006; // seconds until it has settled
        private const double Ending = 0.12; // seconds in which a new look ends an aversion
        private const double Spring = 8.0; // how many of the spring's own times a move takes; then all but 0.3 % is done
        private static readonly double Settled = 1 - (1 + Spring) * Math.Exp(-Spring);
        private static readonly Func<GazeTarget, double> Start = target => target.Start;

        public readonly Schedule Schedule;
        public readonly List<GazePart> Parts = new List<GazePart>();
        public double EyesLeft, EyesUp, HeadLeft, HeadUp; // what aversions and saccades add, radians
        private readonly Body body;
        private readonly Dictionary<string, double[]> points;
        private readonly Aim[] aims;
        private readonly double averts, darts, angle;

        public Gaze(Schedule schedule, LifeSettings life, Body body, Dictionary<string, double[]> points)
        {
            Schedule = schedule;
            this.body = body;
            this.points = points;
            aims = new Aim[schedule.Targets.Count];
            angle = life.AversionAngle;
            averts = Solve.Radians(angle) * (1 - life.Stillness) * life.Gaze;
            darts = Solve.Radians(life.Saccades) * (1 - life.Stillness);
        }

        /// <summary>A critically damped spring's way from 0 to 1, for x from 0 to 1.</summary>
        private static double Settle(double x)
        {
            return x <= 0 ? 0.0 : x >= 1 ? 1.0 : (1 - (1 + Spring * x) * Math.Exp(-Spring * x)) / Settled;
        }

        private static double Eyes(double degrees)
        {
            return EyeTime + EyeTimePerDegree * degrees;
        }

        private static double Head(double degrees)
        {
            return HeadTime + HeadTimePerDegree * degrees;
        }

        private static double Hypot(double x, double y)
        {
            return Math.Sqrt(x * x + y * y);
        }

        /// <summary>Find what the gaze does at a time.</summary>
        public void At(double time)
        {
            List<GazeTarget> targets = Schedule.Targets;
            Parts.Clear();
            EyesLeft = EyesUp = HeadLeft = HeadUp = 0.0;
            int last = targets.Count > 0 ? Math.Max(0, Basics.BisectRight(targets, time, Start) - 1) : -1;
            double came = 0.0, turned = 0.0, strict = 0.0;
            for (int place = last; place >= 0 && (came < 1 || turned < 1); place--)
            {
                Aim aim = aims[place] ?? (aims[place] = Meet(place));
                double gone = time - aim.Start, now = Basics.Ease(gone / aim.Eyes), head = Settle((gone - HeadLag) / aim.Head);
                Parts.Add(new GazePart { Aim = aim, Eyes = now - came, Head = head - turned });
                strict += aim.Strict ? now - came : 0.0;
                came = now;
                turned = head;
            }
            Avert(time, last, strict);
            Dart(time);
        }

        private void Avert(double time, int last, double strict)
        {
            Lane lane = Schedule.Aversions;
            int n = PlainLists.Right(lane.Times, time) - 1;
            if (n < 0 || averts <= 0)
            {
                return;
            }
            double start = lane.Times[n], end = lane.Rows[n][0], x = lane.Rows[n][1], y = lane.Rows[n][2];
            double scale = averts * (1 - strict), size = Hypot(x, y) * angle;
            if (last >= 0 && Schedule.Targets[last].Since > start) // a new look ends it
            {
                scale *= 1 - Basics.Ease((time - Schedule.Targets[last].Since) / Ending);
            }
            double went = time - start, gone = time - end, slow = Head(size), fast = Eyes(size);
            if (gone < HeadLag + slow)
            {
                double now = scale * (Basics.Ease(went / fast) - Basics.Ease(gone / fast));
                double head = scale * (Settle((went - HeadLag) / slow) - Settle((gone - HeadLag) / slow));
                EyesLeft = x * now;
                EyesUp = y * now;
                HeadLeft = x * head;
                HeadUp = y * head;
            }
        }

        private void Dart(double time)
        {
            Lane lane = Schedule.Saccades;
            int n = PlainLists.Right(lane.Times, time) - 1;
            if (n < 0 || darts <= 0)
            {
                return;
            }
            double x = lane.Rows[n][0], y = lane.Rows[n][1];
            double fromX = n > 0 ? lane.Rows[n - 1][0] : 0.0, fromY = n > 0 ? lane.Rows[n - 1][1] : 0.0;
            double way = Basics.Ease((time - lane.Times[n]) / Eyes(Hypot(x - fromX, y - fromY)));
            EyesLeft += darts * (fromX + (x - fromX) * way);
            EyesUp += darts * (fromY + (y - fromY) * way);
        }

        /// <summary>A target as it is met; how long the move to it takes is told by how far it is from the one before.</summary>
        private Aim Meet(int place)
        {
            GazeTarget target = Schedule.Targets[place];
            Vec at, seen, before;
            bool somewhere = Seen(target, out at, out seen);
            double turn = 0.0;
            if (place > 0)
            {
                Vec unused;
                Seen(Schedule.Targets[place - 1], out unused, out before);
                turn = Between(seen, before);
            }
            return new Aim
            {
                Start = place > 0 ? target.Start : double.NegativeInfinity, // the first has always been looked at
                At = at, Amount = somewhere ? target.Amount : 0.0, Asked = target.Asked, Strict = target.Strict,
                Eyes = Eyes(turn), Head = Head(turn),
            };
        }

        /// <summary>Where a target is, and its direction from where the eyes are at rest; false, and ahead, for what is nowhere.</summary>
        private bool Seen(GazeTarget target, out Vec at, out Vec seen)
        {
            string name = target.To.Name;
            double[] point = target.To.Point;
            if (name != null)
            {
                points.TryGetValue(name, out point);
            }
            if (name == WantedRules.Ahead || (point == null && name != WantedRules.Partner))
            {
                at = body.Partner;
                seen = body.Ahead;
                return false;
            }
            at = point == null ? body.Partner : new Vec(point[0], point[1], point[2]);
            seen = at - body.EyesAtRest;
            return true;
        }

        /// <summary>The angle between two directions, degrees.</summary>
        private static double Between(Vec a, Vec b)
        {
            double cosine = Vec.Dot(a, b) / Math.Max(Math.Sqrt(Vec.Dot(a, a) * Vec.Dot(b, b)), 1e-12);
            return Math.Acos(Basics.Clamp(cosine, -1.0, 1.0)) * 180.0 / Math.PI;
        }
    }
}
