// Translated from metagraph/playback/planning/choice.py; change that, and translate anew.
using System;
using System.Collections.Generic;
using System.Linq;

namespace Metagraph
{
    /// <summary>
    /// Keyed randomness: every draw is a hash of (seed, key, purpose), in 32-bit integers that any language mixes in the same
    /// way.
    ///
    /// Draws remember nothing, so a change of one request does not change the draws of the others.
    /// </summary>
    public static class ChoiceRules
    {
        public const double All = 4294967296.0; // numbers of 32 bits

        /// <summary>
        /// Return the 32-bit hash of a seed and words: FNV-1a over their UTF-8 bytes, each word closed by a zero byte, then
        /// mixed.
        ///
        /// The mixed seed is xored into FNV's offset basis.
        /// </summary>
        public static uint Key32(uint seed, params string[] words)
        {
            return HashingRules.Mix(Keyed(seed, words));
        }

        /// <summary>Return the hash of a seed and words before it is mixed, which all draws of one key share.</summary>
        public static uint Keyed(uint seed, params string[] words)
        {
            var value = HashingRules.Begun(seed);
            foreach (string word in words)
            {
                value = HashingRules.Absorb(value, word);
            }
            return value;
        }

        /// <summary>Return a number in the open interval (0, 1).</summary>
        public static double Uniform(uint seed, params string[] words)
        {
            return (HashingRules.Mix(Keyed(seed, words)) + 0.5) / All;
        }

        /// <summary>Return the number that `uniform` returns for a key and one more word.</summary>
        public static double ChanceOf(uint key, string purpose)
        {
            return (HashingRules.Mix(HashingRules.Absorb(key, purpose)) + 0.5) / All;
        }

        /// <summary>
        /// Return a log-normal number from two uniform ones in (0, 1) by Box and Muller, in a way that any language can compute:
        /// `a = ln(1 + (s / m)^2)`, `z = sqrt(-2 ln u) cos(2 pi v)`, `m exp(sqrt(a) z - a / 2)`.
        /// </summary>
        public static double LogNormal(double mean, double deviation, double u, double v)
        {
            var share = deviation / mean;
            var spread = PlainNumbers.Log1P(share * share);
            var z = Math.Sqrt(-2.0 * Math.Log(u)) * Math.Cos(2.0 * Math.PI * v);
            return mean * Math.Exp(Math.Sqrt(spread) * z - spread / 2.0);
        }

        /// <summary>Return one of the ids, chosen as by `picked`.</summary>
        public static string Pick(uint seed, string key, string purpose, Dictionary<string, double> weights)
        {
            return Picked(Keyed(seed, key), purpose, weights);
        }

        /// <summary>
        /// Return one of the ids, id k with probability weight_k / sum.
        ///
        /// Each id draws its own exponential time, -log(u_k) / weight_k, and the shortest wins. So adding or removing a candidate
        /// changes the choice only if that candidate wins. Raises ValueError when no weight is positive.
        /// </summary>
        public static string Picked(uint key, string purpose, Dictionary<string, double> weights)
        {
            var best = "";
            var shortest = double.PositiveInfinity;
            var start = HashingRules.Absorb(key, purpose);
            foreach (var one in weights)
            {
                var ident = one.Key;
                var weight = one.Value;
                if (weight > 0)
                {
                    var time = -Math.Log((HashingRules.Mix(HashingRules.Absorb(start, ident)) + 0.5) / All) / weight;
                    if (time < shortest || (time == shortest && PlainText.Compare(ident, best) < 0))
                    {
                        best = ident;
                        shortest = time;
                    }
                }
            }
            if (best == "")
            {
                throw new InvalidOperationException("nothing to choose from");
            }
            return best;
        }
    }
}
