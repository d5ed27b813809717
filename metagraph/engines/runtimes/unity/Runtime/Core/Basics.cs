using System;
using System.Collections.Generic;
using System.Globalization;

namespace Metagraph
{
    /// <summary>Something that cannot be loaded: what is wrong, where, and what to do about it.</summary>
    public sealed class MetagraphException : Exception
    {
        public MetagraphException(string where, string what, string remedy) : base(where + ": " + what + ". " + remedy) { }
    }

    /// <summary>Where C# has its own ways: the order of texts, numbers as words, searching in what is sorted.</summary>
    public static class Basics
    {
        public static readonly string[] Layers = { "body", "arms", "head" };
        public static readonly string[] Kinds = { "stance", "gesture", "fidget", "transition" };
        public static readonly string[] Limbs = { "left", "right", "both" };
        public static readonly string[] Parts = { "legs", "spine", "arms", "head", "face" };
        public static readonly string[] Modes = { "idle", "listening", "talking", "thinking", "reacting" };
        public static readonly string[] None = new string[0];

        /// <summary>3x^2 - 2x^3 of x clamped to 0..1.</summary>
        public static double Ease(double x)
        {
            return x <= 0 ? 0.0 : x >= 1 ? 1.0 : x * x * (3 - 2 * x);
        }

        public static double Clamp(double x, double low, double high)
        {
            return Math.Min(Math.Max(x, low), high);
        }

        /// <summary>Order of texts by their Unicode code points, whatever the culture; UTF-16 puts surrogates before U+E000.</summary>
        public static int Compare(string a, string b)
        {
            int shared = Math.Min(a.Length, b.Length);
            for (int i = 0; i < shared; i++)
            {
                if (a[i] != b[i])
                {
                    return Rank(a[i]) - Rank(b[i]);
                }
            }
            return a.Length - b.Length;
        }

        private static int Rank(char c)
        {
            return char.IsSurrogate(c) ? c + 0x10000 : c;
        }

        /// <summary>The number of Unicode code points of a text.</summary>
        public static int Length(string text)
        {
            int count = text.Length;
            foreach (char c in text)
            {
                count -= char.IsLowSurrogate(c) ? 1 : 0;
            }
            return count;
        }

        /// <summary>Seconds for people: two decimals.</summary>
        public static string Words(double seconds)
        {
            return seconds.ToString("0.00", CultureInfo.InvariantCulture);
        }

        /// <summary>
        /// A number of at least 1 with three decimals: its exact binary value, rounded half to even. It keys draws, and ToString("F3")
        /// rounds otherwise, or from fewer digits, depending on the platform.
        /// </summary>
        public static string ThreeDecimals(double value)
        {
            double whole = Math.Floor(value);
            ulong scaled = (ulong)((value - whole) * 4503599627370496.0) * 1000UL; // 2^52: nothing is lost of a number above 1
            ulong digits = scaled >> 52, rest = scaled & 0xFFFFFFFFFFFFFUL, half = 1UL << 51;
            digits += rest > half || (rest == half && digits % 2 == 1) ? 1UL : 0UL;
            whole += digits == 1000 ? 1 : 0;
            return whole.ToString("0", CultureInfo.InvariantCulture) + "." + (digits % 1000).ToString("000", CultureInfo.InvariantCulture);
        }

        /// <summary>The number of values, ascending, that are at most x.</summary>
        public static int BisectRight(double[] values, double x)
        {
            int low = 0, high = values.Length;
            while (low < high)
            {
                int middle = (low + high) / 2;
                if (x < values[middle])
                {
                    high = middle;
                }
                else
                {
                    low = middle + 1;
                }
            }
            return low;
        }

        /// <summary>The number of items, ascending by key, whose key is at most x.</summary>
        public static int BisectRight<T>(List<T> items, double x, Func<T, double> key)
        {
            int low = 0, high = items.Count;
            while (low < high)
            {
                int middle = (low + high) / 2;
                if (x < key(items[middle]))
                {
                    high = middle;
                }
                else
                {
                    low = middle + 1;
                }
            }
            return low;
        }

        /// <summary>The number of items, ascending by key, whose key is below x.</summary>
        public static int BisectLeft<T>(List<T> items, double x, Func<T, double> key)
        {
            int low = 0, high = items.Count;
            while (low < high)
            {
                int middle = (low + high) / 2;
                if (key(items[middle]) < x)
                {
                    low = middle + 1;
                }
                else
                {
                    high = middle;
                }
            }
            return low;
        }
    }
}
