using System;

namespace Metagraph
{
    /// <summary>A rotation xyzw of unit length. a * b applies b first, then a.</summary>
    public struct Quat
    {
        public static readonly Quat Identity = new Quat(0, 0, 0, 1);
        public double X, Y, Z, W;

        public Quat(double x, double y, double z, double w)
        {
            X = x;
            Y = y;
            Z = z;
            W = w;
        }

        /// <summary>The n-th quaternion of an array of xyzw.</summary>
        public static Quat Of(float[] values, int n)
        {
            return new Quat(values[4 * n], values[4 * n + 1], values[4 * n + 2], values[4 * n + 3]);
        }

        public void Write(float[] values, int n)
        {
            values[4 * n] = (float)X;
            values[4 * n + 1] = (float)Y;
            values[4 * n + 2] = (float)Z;
            values[4 * n + 3] = (float)W;
        }

        public static Quat operator *(Quat a, Quat b)
        {
            return new Quat(
                a.W * b.X + a.X * b.W + a.Y * b.Z - a.Z * b.Y, a.W * b.Y - a.X * b.Z + a.Y * b.W + a.Z * b.X,
                a.W * b.Z + a.X * b.Y - a.Y * b.X + a.Z * b.W, a.W * b.W - a.X * b.X - a.Y * b.Y - a.Z * b.Z);
        }

        public static double Dot(Quat a, Quat b)
        {
            return a.X * b.X + a.Y * b.Y + a.Z * b.Z + a.W * b.W;
        }

        public Quat Inverse
        {
            get { return new Quat(-X, -Y, -Z, W); }
        }

        public Quat Negative
        {
            get { return new Quat(-X, -Y, -Z, -W); }
        }

        /// <summary>Scaled to unit length; zero becomes the identity.</summary>
        public Quat Unit
        {
            get
            {
                double length = Math.Sqrt(Dot(this, this));
                return length > 1e-12 ? new Quat(X / length, Y / length, Z / length, W / length) : Identity;
            }
        }

        public Vec Rotate(Vec v)
        {
            double tx = 2 * (Y * v.Z - Z * v.Y), ty = 2 * (Z * v.X - X * v.Z), tz = 2 * (X * v.Y - Y * v.X);
            return new Vec(v.X + W * tx + Y * tz - Z * ty, v.Y + W * ty + Z * tx - X * tz, v.Z + W * tz + X * ty - Y * tx);
        }

        /// <summary>A turn about a unit axis, radians.</summary>
        public static Quat About(Vec axis, double angle)
        {
            double s = Math.Sin(0.5 * angle);
            return new Quat(axis.X * s, axis.Y * s, axis.Z * s, Math.Cos(0.5 * angle));
        }

        /// <summary>The rotation of a rotation vector: axis times angle.</summary>
        public static Quat Turn(Vec v)
        {
            double size = Math.Sqrt(Vec.Dot(v, v) + 1e-30), s = Math.Sin(0.5 * size) / size;
            return new Quat(v.X * s, v.Y * s, v.Z * s, Math.Cos(0.5 * size));
        }

        /// <summary>Turned by `weight` times its angle, the short way.</summary>
        public Quat Power(double weight)
        {
            Quat q = W < 0 ? Negative : this;
            double s = Math.Sqrt(q.X * q.X + q.Y * q.Y + q.Z * q.Z), k = s > 1e-8 ? 2 * Math.Atan2(s, q.W) / s : 2.0;
            return Turn(new Vec(q.X, q.Y, q.Z) * (k * weight));
        }

        /// <summary>A normalised straight line from a to b, on the shorter side.</summary>
        public static Quat Nlerp(Quat a, Quat b, double weight)
        {
            double v = 1 - weight, w = Dot(a, b) < 0 ? -weight : weight;
            return new Quat(a.X * v + b.X * w, a.Y * v + b.Y * w, a.Z * v + b.Z * w, a.W * v + b.W * w).Unit;
        }

        /// <summary>From a to b at constant speed, on the shorter side.</summary>
        public static Quat Slerp(Quat a, Quat b, double weight)
        {
            return a * (a.Inverse * b).Power(weight);
        }

        /// <summary>What a rotation near rest has in common with a row of `EyeAt.Down` or `FaceRig.ShutBy`.</summary>
        public double Along(Quat row)
        {
            double along = Dot(this, row);
            return W >= 0 ? along : -along;
        }
    }
}
