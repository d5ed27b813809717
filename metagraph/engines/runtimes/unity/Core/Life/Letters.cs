using System;
using System.Collections.Generic;
using System.Globalization;
using System.Linq;
using System.Text;

namespace Metagraph
{
    /// <summary>A sound from Start to End seconds: its mouth shape and how fully it is made, 0..1.</summary>
    internal struct Piece
    {
        public double Start, End, Strength;
        public string Viseme;
    }

    /// <summary>A text read aloud: its pieces, times and strengths (0..1) of its syllables, its length in seconds.</summary>
    internal sealed class Spelled
    {
        public readonly List<Piece> Pieces = new List<Piece>();
        public readonly List<double> Peaks = new List<double>(), Strengths = new List<double>();
        public double Length;
    }

    /// <summary>
    /// From letters to mouth shapes: what a mouth may do when neither sound nor phones of a line are there. English spelling is read
    /// by a few rules; other alphabets by their vowels, what is unknown by turns of open and shut.
    /// </summary>
    internal static class Letters
    {
        // Shapes in turn; the longest spelling that fits counts.
        private const string Spellings =
            "tion=CH,nn sch=CH tch=CH igh=aa,I eau=O ough=O th=TH sh=CH ch=CH ph=FF ck=kk ng=nn qu=kk,U wh=U oo=U ou=aa,U ow=O,U ee=I "
            + "ea=I ai=E,I ay=E,I oi=O,I oy=O,I au=O aw=O ie=I ei=E,I ue=U oa=O a=aa e=E i=I o=O u=U y=I ø=U œ=U æ=E ı=I b=PP p=PP m=PP "
            + "f=FF v=FF d=DD t=DD l=nn n=nn k=kk g=kk c=kk q=kk x=kk,SS h=kk j=CH s=SS z=SS r=RR w=U ß=SS ð=TH þ=TH ł=nn đ=DD";

        // Greek and Cyrillic letters, and the Latin ones they stand for.
        private const string Alike = "αεηιουωβπμφδτλνκγχξσςζρθабвгдеёжзийклмнопрстуфхцчшщыэюяієї";
        private const string Latin = "aeeioyobpmfdtlnkghxsszrþabvgdeejzijklmnoprstufhsjjjieuaiei";
        private const string Stops = ",;:.!?…-–—()"; // and how many characters' time of pause each brings
        private static readonly double[] Pauses = { 1.5, 2.0, 2.0, 3.0, 3.0, 3.0, 3.0, 0.3, 1.5, 1.5, 1.0, 1.0 };
        private static readonly string[] Vowels = { "aa", "E", "I", "O", "U" }, Consonants = { "DD", "nn", "SS", "kk", "PP" };

        private static readonly Dictionary<string, string[]> Known =
            Spellings.Split(' ').Select(word => word.Split('=')).ToDictionary(pair => pair[0], pair => pair[1].Split(','));

        private static bool IsVowel(string shape)
        {
            return Array.IndexOf(Vowels, shape) >= 0;
        }

        /// <summary>A text's pieces and syllables, for a length in seconds.</summary>
        public static Spelled Read(string text, double duration)
        {
            var found = new Spelled { Length = Math.Max(duration, 0.0) };
            var shapes = new List<string>(); // null for a pause
            List<double> sizes = new List<double>(), strengths = new List<double>(); // characters' time; of syllables
            foreach (KeyValuePair<string, double> one in Words(Strip(text)))
            {
                List<string> own = Shapes(one.Key);
                // Content words are longer than the words between them; the first vowel bears the stress more often than not.
                double weight = Math.Min(1.0, 0.35 + 0.09 * Basics.Length(one.Key)) - 0.1 * (Crc32(one.Key) % 100) / 100;
                bool first = true;
                for (int n = 0; n < own.Count; n++)
                {
                    bool syllable = IsVowel(own[n]) && (n == 0 || !IsVowel(own[n - 1]));
                    shapes.Add(own[n]);
                    sizes.Add(IsVowel(own[n]) ? 1.25 : 0.8);
                    strengths.Add(!syllable ? 0.0 : first ? weight : 0.6 * weight);
                    first = first && !syllable;
                }
                if (one.Value > 0)
                {
                    shapes.Add(null);
                    sizes.Add(one.Value);
                    strengths.Add(0.0);
                }
            }
            if (!shapes.Exists(shape => shape != null) || found.Length < 1e-3)
            {
                return found;
            }
            double edge = Math.Min(0.06, 0.1 * found.Length), scale = (found.Length - 2 * edge) / sizes.Sum(), at = edge;
            for (int n = 0; n < shapes.Count; n++)
            {
                double end = at + sizes[n] * scale;
                if (shapes[n] != null)
                {
                    double strength = IsVowel(shapes[n]) ? Math.Min(1.0, 0.7 + 0.4 * strengths[n]) : 1.0;
                    found.Pieces.Add(new Piece { Start = at, End = end, Viseme = shapes[n], Strength = strength });
                }
                if (strengths[n] > 0)
                {
                    found.Peaks.Add(0.5 * (at + end));
                    found.Strengths.Add(strengths[n]);
                }
                at = end;
            }
            return found;
        }

        /// <summary>The mouth shapes of a word's letters, in turn.</summary>
        private static List<string> Shapes(string word)
        {
            var found = new List<string>();
            List<string> letters = Plain(word);
            for (int at = 0, size; at < letters.Count; at += size)
            {
                string[] own = null;
                for (size = Math.Min(4, letters.Count - at); size > 0; size--)
                {
                    if (Known.TryGetValue(string.Concat(letters.GetRange(at, size)), out own))
                    {
                        break;
                    }
                }
                if (own == null)
                {
                    size = 1;
                    own = Unknown(letters[at], found);
                }
                bool finalE = letters[at] == "e" && size == 1 && at == letters.Count - 1 && found.Count > 1 && found.Exists(IsVowel);
                bool doubled = at > 0 && letters[at] == letters[at - 1] && size == 1 && own.Length > 0 && !IsVowel(own[0]);
                if (!finalE && !doubled)
                {
                    found.AddRange(own);
                }
            }
            return found;
        }

        /// <summary>Small letters without accents, each a code point.</summary>
        private static List<string> Plain(string word)
        {
            string folded = Unmarked(Unmarked(word).ToLowerInvariant()).Replace("ß", "ss").Replace("ſ", "s");
            return Characters(folded).ConvertAll(Romanised);
        }

        private static string Romanised(string c)
        {
            int place = Alike.IndexOf(c, StringComparison.Ordinal);
            return place < 0 ? c : Latin[place].ToString();
        }

        private static string Unmarked(string text)
        {
            return string.Concat(Characters(text.Normalize(NormalizationForm.FormD)).FindAll(c => !IsCombining(c)));
        }

        private static string[] Unknown(string letter, List<string> before)
        {
            if (!IsAlphanumeric(letter))
            {
                return Basics.None;
            }
            bool digit = CharUnicodeInfo.GetDigitValue(letter, 0) >= 0;
            if (digit || CharUnicodeInfo.GetUnicodeCategory(letter, 0) == UnicodeCategory.OtherLetter) // a syllable each
            {
                int code = char.ConvertToUtf32(letter, 0);
                return new[] { Consonants[code % 5], Vowels[code / 5 % 5] };
            }
            return new[] { before.Count > 0 && !IsVowel(before[before.Count - 1]) ? "aa" : "DD" };
        }

        /// <summary>Each word and how many characters' time of pause follows it.</summary>
        private static IEnumerable<KeyValuePair<string, double>> Words(string text)
        {
            string word = "";
            double pause = 0.0;
            foreach (string c in Characters(text))
            {
                if (IsAlphanumeric(c) || c == "'" || c == "’" || IsCombining(c))
                {
                    if (pause > 0)
                    {
                        yield return new KeyValuePair<string, double>(word, pause);
                        word = "";
                        pause = 0.0;
                    }
                    word += c;
                }
                else
                {
                    int stop = Stops.IndexOf(c, StringComparison.Ordinal);
                    pause += stop < 0 ? 0.35 : Pauses[stop];
                }
            }
            if (word.Length > 0 || pause > 0)
            {
                yield return new KeyValuePair<string, double>(word, pause);
            }
        }

        /// <summary>A text without blanks at its ends; Unicode's, and the four separators of ASCII.</summary>
        public static string Strip(string text)
        {
            int start = 0, end = text.Length;
            while (start < end && IsBlank(text[start]))
            {
                start++;
            }
            while (end > start && IsBlank(text[end - 1]))
            {
                end--;
            }
            return text.Substring(start, end - start);
        }

        private static bool IsBlank(char c)
        {
            return char.IsWhiteSpace(c) || (c >= '\u001c' && c <= '\u001f');
        }

        /// <summary>A text's code points, a text each.</summary>
        private static List<string> Characters(string text)
        {
            var found = new List<string>();
            for (int i = 0; i < text.Length; i++)
            {
                bool pair = i + 1 < text.Length && char.IsSurrogatePair(text[i], text[i + 1]);
                found.Add(text.Substring(i, pair ? 2 : 1));
                i += pair ? 1 : 0;
            }
            return found;
        }

        private static bool IsAlphanumeric(string c)
        {
            UnicodeCategory category = CharUnicodeInfo.GetUnicodeCategory(c, 0);
            return category <= UnicodeCategory.OtherLetter
                || (category >= UnicodeCategory.DecimalDigitNumber && category <= UnicodeCategory.OtherNumber);
        }

        /// <summary>
        /// Whether a mark moves in canonical order, as accents do and vowel signs do not. Classes are not to be had, but marks below
        /// (1) and iota (240) tell: normalising sorts what is above the one or below the other.
        /// </summary>
        private static bool IsCombining(string c)
        {
            UnicodeCategory category = CharUnicodeInfo.GetUnicodeCategory(c, 0);
            if (category != UnicodeCategory.NonSpacingMark && category != UnicodeCategory.SpacingCombiningMark)
            {
                return false;
            }
            string low = c + "\u0334", high = "\u0345" + c;
            return c == "\u0345" || low.Normalize(NormalizationForm.FormD) != low || high.Normalize(NormalizationForm.FormD) != high;
        }

        private static uint Crc32(string text)
        {
            uint value = 0xFFFFFFFF;
            foreach (byte b in Encoding.UTF8.GetBytes(text))
            {
                value ^= b;
                for (int bit = 0; bit < 8; bit++)
                {
                    value = (value & 1) != 0 ? (value >> 1) ^ 0xEDB88320 : value >> 1;
                }
            }
            return ~value;
        }
    }
}
