using System;
using System.Collections.Generic;
using System.Text;

namespace Metagraph
{
    /// <summary>
    /// Keyed randomness: every draw is a hash of (seed, key, purpose). Nothing is remembered between draws, so changing one
    /// request leaves the draws of all others as they were.
    /// </summary>
    public static class Choice
    {
        private const uint Offset = 0x811C9DC5, Prime = 0x01000193; // FNV-1a's, 32 bits

        /// <summary>Scramble 32 bits: MurmurHash3's finaliser.</summary>
        public static uint Mix(uint value)
        {
            value ^= value >> 16;
            value = unchecked(value * 0x85EBCA6B);
            value ^= value >> 13;
            value = unchecked(value * 0xC2B2AE35);
            return value ^ (value >> 16);
        }

        private static uint Absorb(uint value, string word)
        {
            foreach (byte b in Encoding.UTF8.GetBytes(word))
            {
                value = unchecked((value ^ b) * Prime);
            }
            return unchecked(value * Prime); // the closing zero byte
        }

        /// <summary>The 32-bit hash of a seed and words.</summary>
        public static uint Key32(uint seed, params string[] words)
        {
            return Mix(Begin(seed, words));
        }

        private static uint Begin(uint seed, params string[] words)
        {
            uint value = Offset ^ Mix(seed);
            foreach (string word in words)
            {
                value = Absorb(value, word);
            }
            return value;
        }

        /// <summary>A number in the open interval (0, 1).</summary>
        public static double Uniform(uint seed, params string[] words)
        {
            return (Key32(seed, words) + 0.5) / 4294967296.0;
        }

        /// <summary>
        /// One of the ids, id k with probability weight_k / sum; null where no weight is positive. Each runs its own race, the
        /// shortest of -log(u_k) / weight_k wins, so another candidate changes the choice only where it wins.
        /// </summary>
        public static string Pick(uint seed, string key, string purpose, IEnumerable<KeyValuePair<string, double>> weights)
        {
            string best = null;
            double shortest = double.PositiveInfinity;
            uint begun = Begin(seed, key, purpose);
            foreach (KeyValuePair<string, double> one in weights)
            {
                if (one.Value > 0)
                {
                    double time = -Math.Log((Mix(Absorb(begun, one.Key)) + 0.5) / 4294967296.0) / one.Value;
                    if (best == null || time < shortest || (time == shortest && Basics.Compare(one.Key, best) < 0))
                    {
                        best = one.Key;
                        shortest = time;
                    }
                }
            }
            return best;
        }
    }
}
