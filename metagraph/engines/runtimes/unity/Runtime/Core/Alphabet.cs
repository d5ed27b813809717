using System;
using System.Collections.Generic;
using System.Globalization;
using System.Text;

namespace Metagraph
{
    /// <summary>What is known of letters: their plain forms and what kind of character they are, as Unicode has it.</summary>
    public sealed class Alphabet
    {
        public static readonly Alphabet Common = new Alphabet();
        private static readonly Dictionary<string, List<string>> spelled = new Dictionary<string, List<string>>();
        private static readonly Dictionary<int, string> kinds = new Dictionary<int, string>();

        static Alphabet()
        {
            foreach (string word in LettersTable.Spelled.Split(new[] { ' ' }, StringSplitOptions.RemoveEmptyEntries))
            {
                spelled[word.Substring(0, 1)] = Common.Letters(word.Substring(1));
            }
            Mark("letter", LettersTable.Letters);
            Mark("syllable", LettersTable.Syllables);
            Mark("mark", LettersTable.Marks);
            Mark("", LettersTable.Others);
        }

        private static void Mark(string kind, string runs)
        {
            int at = 0;
            bool skips = true;
            foreach (string number in runs.Split(' '))
            {
                int until = at + int.Parse(number, CultureInfo.InvariantCulture);
                for (; at < until; at++)
                {
                    if (!skips)
                    {
                        kinds[at] = kind;
                    }
                }
                skips = !skips;
            }
        }

        /// <summary>A text's code points, a text each.</summary>
        public List<string> Letters(string text)
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

        /// <summary>A text without blanks at its ends; Unicode's, and the four separators of ASCII.</summary>
        public string Stripped(string text)
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

        /// <summary>A word in small letters without accents, a letter each.</summary>
        public List<string> Plain(string word)
        {
            var found = new List<string>();
            foreach (string letter in Letters(word))
            {
                if (spelled.TryGetValue(letter, out List<string> plain))
                {
                    found.AddRange(plain);
                }
                else
                {
                    found.AddRange(Letters(Unmarked(Unmarked(letter).ToLowerInvariant()).Replace("ß", "ss").Replace("ſ", "s")));
                }
            }
            return found;
        }

        /// <summary>
        /// "syllable" for a digit and for a letter of a script without small ones, "letter" for others, "mark" for what combines with
        /// the letter before it; "" for all else.
        /// </summary>
        public string Kind(string letter)
        {
            int code = Code(letter);
            if (kinds.TryGetValue(code, out string known))
            {
                return known;
            }
            if (code >= 0x20000 && code < 0x32000) // rare Han characters
            {
                return "syllable";
            }
            if (!IsAlphanumeric(letter))
            {
                return IsCombining(letter) ? "mark" : "";
            }
            bool digit = CharUnicodeInfo.GetDigitValue(letter, 0) >= 0;
            bool single = CharUnicodeInfo.GetUnicodeCategory(letter, 0) == UnicodeCategory.OtherLetter;
            return digit || single ? "syllable" : "letter";
        }

        /// <summary>A letter's code point.</summary>
        public int Code(string letter)
        {
            return char.ConvertToUtf32(letter, 0);
        }

        /// <summary>0..99, the same for the same word.</summary>
        public int Scatter(string word)
        {
            return (int)(Crc32(word) % 100);
        }

        private string Unmarked(string text)
        {
            return string.Concat(Letters(text.Normalize(NormalizationForm.FormD)).FindAll(c => !IsCombining(c)));
        }

        private static bool IsBlank(char c)
        {
            return char.IsWhiteSpace(c) || (c >= '\u001c' && c <= '\u001f');
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
            if (kinds.TryGetValue(char.ConvertToUtf32(c, 0), out string known))
            {
                return known == "mark";
            }
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
