using System;
using System.Collections;
using System.Collections.Generic;
using System.Globalization;
using System.Linq;
using System.Text;

namespace Metagraph
{
    // What translated modules need of the language, in the order of their operations.

    /// <summary>Thirty-two bits from texts: FNV-1a over their UTF-8 bytes, and MurmurHash3's finaliser.</summary>
    internal static class HashingRules
    {
        private const uint Offset = 0x811C9DC5, Prime = 0x01000193; // FNV-1a's, 32 bits

        /// <summary>Scramble 32 bits: two rounds of shift-xor and odd multiplication.</summary>
        public static uint Mix(uint value)
        {
            value ^= value >> 16;
            value = unchecked(value * 0x85EBCA6B);
            value ^= value >> 13;
            value = unchecked(value * 0xC2B2AE35);
            return value ^ (value >> 16);
        }

        /// <summary>Take a word and the zero byte that closes it into a hash.</summary>
        public static uint Absorb(uint value, string word)
        {
            foreach (byte b in Encoding.UTF8.GetBytes(word))
            {
                value = unchecked((value ^ b) * Prime);
            }
            return unchecked(value * Prime); // the closing zero byte
        }

        /// <summary>The hash before any word.</summary>
        public static uint Begun(uint seed)
        {
            return Offset ^ Mix(seed);
        }
    }

    /// <summary>Texts, whatever the culture.</summary>
    internal static class PlainText
    {
        public static readonly IComparer<string> Order = Comparer<string>.Create(Basics.Compare);

        public static int Compare(string a, string b)
        {
            return Basics.Compare(a, b);
        }

        public static string Of(int number)
        {
            return number.ToString(CultureInfo.InvariantCulture);
        }

        public static int Whole(string text)
        {
            return int.Parse(text, CultureInfo.InvariantCulture);
        }

        public static string Fixed(double number, int places)
        {
            if (places == 3) // what keys a draw
            {
                return Basics.ThreeDecimals(number);
            }
            return number.ToString("F" + places, CultureInfo.InvariantCulture);
        }

        /// <summary>A text before the last of another, that, and what is behind it; nothing of the first two where it has none.</summary>
        public static (string, string, string) PartedLast(string text, string by)
        {
            int place = text.LastIndexOf(by, StringComparison.Ordinal);
            return place < 0 ? ("", "", text) : (text.Substring(0, place), by, text.Substring(place + by.Length));
        }

        public static bool Digits(string text)
        {
            return text.Length > 0 && text.All(c => c >= '0' && c <= '9');
        }

        public static List<string> Words(string text)
        {
            return text.Split((char[])null, StringSplitOptions.RemoveEmptyEntries).ToList();
        }
    }

    /// <summary>What the standard library has only later, or says otherwise.</summary>
    internal static class PlainNumbers
    {
        /// <summary>What is left of a division, as far above a multiple of b.</summary>
        public static int Modulo(int a, int b)
        {
            return (a % b + b) % b;
        }

        public static double Modulo(double a, double b)
        {
            return a - b * Math.Floor(a / b);
        }

        /// <summary>The largest of some numbers.</summary>
        public static T MaxOf<T>(List<T> values)
        {
            return values.Max();
        }

        /// <summary>The largest of some numbers, or another of none.</summary>
        public static double MaxOf(List<double> values, double other)
        {
            return values.Count > 0 ? values.Max() : other;
        }

        public static T MinOf<T>(List<T> values)
        {
            return values.Min();
        }

        public static double MinOf(List<double> values, double other)
        {
            return values.Count > 0 ? values.Min() : other;
        }

        /// <summary>The whole numbers from 0 to before `last`.</summary>
        public static List<int> Range(int last)
        {
            return Enumerable.Range(0, Math.Max(0, last)).ToList();
        }

        public static bool IsFinite(double x)
        {
            return !double.IsNaN(x) && !double.IsInfinity(x);
        }

        /// <summary>ln(1 + x), near 0 too.</summary>
        public static double Log1P(double x)
        {
            double u = 1.0 + x;
            return u == 1.0 ? x : Math.Log(u) * x / (u - 1.0);
        }
    }

    /// <summary>Maps, whose values may be missing.</summary>
    internal static class PlainMaps
    {
        /// <summary>A map of pairs; of two with one key the later counts, in the place of the first.</summary>
        public static Dictionary<K, V> ToMap<K, V>(this IEnumerable<(K, V)> pairs)
        {
            var found = new Dictionary<K, V>();
            foreach (var pair in pairs)
            {
                found[pair.Item1] = pair.Item2;
            }
            return found;
        }

        /// <summary>The value of a key, null where there is none.</summary>
        public static T Get<T>(Dictionary<string, T> map, string key) where T : class
        {
            T found;
            return map.TryGetValue(key, out found) ? found : null;
        }

        public static int? Get(Dictionary<string, int> map, string key)
        {
            int found;
            return map.TryGetValue(key, out found) ? found : (int?)null;
        }

        public static double? Get(Dictionary<string, double> map, string key)
        {
            double found;
            return map.TryGetValue(key, out found) ? found : (double?)null;
        }

        /// <summary>The value of a key, another where there is none.</summary>
        public static T GetOr<T>(Dictionary<string, T> map, string key, T other)
        {
            T found;
            return map.TryGetValue(key, out found) ? found : other;
        }
    }

    /// <summary>Lists that are in order, and parts of lists.</summary>
    internal static class PlainLists
    {
        private sealed class Items : IComparer
        {
            public int Compare(object a, object b)
            {
                var text = a as string;
                return text != null ? Basics.Compare(text, (string)b) : Comparer.DefaultInvariant.Compare(a, b);
            }
        }

        private static readonly IComparer Each = new Items();

        /// <summary>Items by what a key gives; those alike stay as they were.</summary>
        public static List<T> By<T, TKey>(IEnumerable<T> items, Func<T, TKey> key) where TKey : IStructuralComparable
        {
            return items.OrderBy(key, Comparer<TKey>.Create((a, b) => a.CompareTo(b, Each))).ToList();
        }

        /// <summary>Put an item into an ordered list, from place `low` on, behind those alike.</summary>
        public static void Insert<T, TKey>(List<T> items, T item, int low, Func<T, TKey> key) where TKey : IStructuralComparable
        {
            TKey own = key(item);
            int high = items.Count;
            while (low < high)
            {
                int middle = (low + high) / 2;
                if (own.CompareTo(key(items[middle]), Each) < 0)
                {
                    high = middle;
                }
                else
                {
                    low = middle + 1;
                }
            }
            items.Insert(low, item);
        }

        /// <summary>Pairs of the items at the same places of two lists.</summary>
        public static IEnumerable<(A, B)> Pairs<A, B>(IEnumerable<A> one, IEnumerable<B> other)
        {
            return one.Zip(other, (a, b) => (a, b));
        }

        /// <summary>How many of ascending values are at most x.</summary>
        public static int Right(List<double> values, double x)
        {
            return Basics.BisectRight(values, x, value => value);
        }

        public static int Left(List<double> values, double x)
        {
            return Basics.BisectLeft(values, x, value => value);
        }

        /// <summary>The items from a place to before another; negative places count from the end, those beyond are the ends.</summary>
        public static List<T> Part<T>(List<T> items, int first, int? last = null)
        {
            int begin = Place(first, items.Count), end = Place(last ?? items.Count, items.Count);
            return begin < end ? items.GetRange(begin, end - begin) : new List<T>();
        }

        private static int Place(int place, int count)
        {
            return Math.Min(Math.Max(place < 0 ? place + count : place, 0), count);
        }
    }
}
