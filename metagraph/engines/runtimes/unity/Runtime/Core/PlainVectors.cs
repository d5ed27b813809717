// Translated from metagraph/motion/plain_vectors.py; change that, and translate anew.
using System;
using System.Collections.Generic;
using System.Linq;

namespace Metagraph
{
    /// <summary>
    /// Vectors and rotations as plain tuples, for code that computes one pose at a time, the same in all languages. Vectors are
    /// x, y, z; quaternions xyzw, of length 1.
    /// </summary>
    public static class PlainVectorsRules
    {
        /// <summary>Return the product: rotate by `b`, then by `a`.</summary>
        public static (double, double, double, double) Times(
            (double, double, double, double) a,
            (double, double, double, double) b
        )
        {
            var found = a;
            double ax = found.Item1;
            double ay = found.Item2;
            double az = found.Item3;
            double aw = found.Item4;
            var found2 = b;
            double bx = found2.Item1;
            double by = found2.Item2;
            double bz = found2.Item3;
            double bw = found2.Item4;
            return (
                aw * bx + ax * bw + ay * bz - az * by,
                aw * by - ax * bz + ay * bw + az * bx,
                aw * bz + ax * by - ay * bx + az * bw,
                aw * bw - ax * bx - ay * by - az * bz
            );
        }

        /// <summary>Return a vector rotated.</summary>
        public static (double, double, double) Rotated((double, double, double, double) q, (double, double, double) v)
        {
            var found = q;
            double x = found.Item1;
            double y = found.Item2;
            double z = found.Item3;
            double w = found.Item4;
            var found2 = v;
            double vx = found2.Item1;
            double vy = found2.Item2;
            double vz = found2.Item3;
            var tx = 2.0 * (y * vz - z * vy);
            var ty = 2.0 * (z * vx - x * vz);
            var tz = 2.0 * (x * vy - y * vx);
            return (vx + w * tx + y * tz - z * ty, vy + w * ty + z * tx - x * tz, vz + w * tz + x * ty - y * tx);
        }

        /// <summary>Return the shortest rotation that takes one direction to another, both of length 1.</summary>
        public static (double, double, double, double) Between((double, double, double) a, (double, double, double) b)
        {
            var found = a;
            double ax = found.Item1;
            double ay = found.Item2;
            double az = found.Item3;
            var found2 = b;
            double bx = found2.Item1;
            double by = found2.Item2;
            double bz = found2.Item3;
            var along = ax * bx + ay * by + az * bz;
            if (along < -0.999999999) // half a turn about any axis across
            {
                return UnitTurn(Math.Abs(ax) < 0.9 ? (0.0, az, -ay, 0.0) : (-az, 0.0, ax, 0.0));
            }
            return UnitTurn((ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx, 1.0 + along));
        }

        /// <summary>Return the length of a vector.</summary>
        public static double Length((double, double, double) v)
        {
            var found = v;
            double x = found.Item1;
            double y = found.Item2;
            double z = found.Item3;
            return Math.Sqrt(x * x + y * y + z * z);
        }

        /// <summary>Return a vector of length 1 in the same direction; the zero vector stays as it is.</summary>
        public static (double, double, double) Unit((double, double, double) v)
        {
            return Scaled(v, 1.0 / Math.Max(Length(v), 1e-12));
        }

        /// <summary>Return a quaternion of length 1.</summary>
        public static (double, double, double, double) UnitTurn((double, double, double, double) q)
        {
            var found = q;
            double x = found.Item1;
            double y = found.Item2;
            double z = found.Item3;
            double w = found.Item4;
            var k = 1.0 / Math.Max(Math.Sqrt(x * x + y * y + z * z + w * w), 1e-12);
            return (x * k, y * k, z * k, w * k);
        }

        /// <summary>Return the inverse rotation.</summary>
        public static (double, double, double, double) Back((double, double, double, double) q)
        {
            var found = q;
            double x = found.Item1;
            double y = found.Item2;
            double z = found.Item3;
            double w = found.Item4;
            return (-x, -y, -z, w);
        }

        /// <summary>Return the sum.</summary>
        public static (double, double, double) Plus((double, double, double) a, (double, double, double) b)
        {
            var found = a;
            double ax = found.Item1;
            double ay = found.Item2;
            double az = found.Item3;
            var found2 = b;
            double bx = found2.Item1;
            double by = found2.Item2;
            double bz = found2.Item3;
            return (ax + bx, ay + by, az + bz);
        }

        /// <summary>Return the difference.</summary>
        public static (double, double, double) Minus((double, double, double) a, (double, double, double) b)
        {
            var found = a;
            double ax = found.Item1;
            double ay = found.Item2;
            double az = found.Item3;
            var found2 = b;
            double bx = found2.Item1;
            double by = found2.Item2;
            double bz = found2.Item3;
            return (ax - bx, ay - by, az - bz);
        }

        /// <summary>Return a vector times a number.</summary>
        public static (double, double, double) Scaled((double, double, double) a, double k)
        {
            var found = a;
            double x = found.Item1;
            double y = found.Item2;
            double z = found.Item3;
            return (x * k, y * k, z * k);
        }

        /// <summary>Return the scalar product.</summary>
        public static double Dot((double, double, double) a, (double, double, double) b)
        {
            var found = a;
            double ax = found.Item1;
            double ay = found.Item2;
            double az = found.Item3;
            var found2 = b;
            double bx = found2.Item1;
            double by = found2.Item2;
            double bz = found2.Item3;
            return ax * bx + ay * by + az * bz;
        }
    }
}
