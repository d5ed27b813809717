using System.Collections.Generic;
using System.Linq;

namespace Metagraph
{
    /// <summary>Where something is: a name ("user", "ahead", a named point), or a point, metres in the character's space.</summary>
    public sealed class Spot
    {
        public readonly string Name;
        public readonly double[] Point;

        public Spot(string name)
        {
            Name = name;
        }

        public Spot(double[] point)
        {
            Point = point;
        }
    }

    /// <summary>What is done with names and points.</summary>
    public static class SpotsRules
    {
        public static Spot Named(string name)
        {
            return new Spot(name);
        }

        /// <summary>The point that a name stands for among places, else what was given.</summary>
        public static Spot Placed(Dictionary<string, List<double>> places, Spot to)
        {
            List<double> point;
            return to.Name != null && places.TryGetValue(to.Name, out point) ? new Spot(point.ToArray()) : to;
        }

        /// <summary>Whether two names or two points are the same.</summary>
        public static bool IsSameSpot(Spot one, Spot other)
        {
            return one.Name == other.Name && (one.Name != null || one.Point.SequenceEqual(other.Point));
        }
    }
}
