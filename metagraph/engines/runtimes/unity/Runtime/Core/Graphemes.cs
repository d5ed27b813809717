// Translated from metagraph/playback/life/graphemes.py; change that, and translate anew.
using System;
using System.Collections.Generic;
using System.Linq;

namespace Metagraph
{
    /// <summary>Letters that are syllables, by their code points. size: characters' time of one.</summary>
    public sealed class Syllabary
    {
        public readonly int First;
        public readonly int Last;
        public readonly double Size;

        public Syllabary(int first, int last, double size)
        {
            First = first;
            Last = last;
            Size = size;
        }
    }

    /// <summary>
    /// A sound of a text. shape: "" for a pause. size: characters' time. strength: of a syllable, 0 for anything else.
    /// </summary>
    public sealed class SpelledSound
    {
        public readonly string Shape;
        public readonly double Size;
        public readonly double Strength;

        public SpelledSound(string shape, double size, double strength = 0.0)
        {
            Shape = shape;
            Size = size;
            Strength = strength;
        }
    }

    /// <summary>
    /// Something said, timed by its letters: pieces in time, and times and strengths (0..1) of its syllables.
    /// </summary>
    public sealed class Spelled
    {
        public List<MouthPiece> Pieces;
        public List<double> Peaks;
        public List<double> Strengths;

        public Spelled(List<MouthPiece> pieces = null, List<double> peaks = null, List<double> strengths = null)
        {
            Pieces = pieces ?? new List<MouthPiece>();
            Peaks = peaks ?? new List<double>();
            Strengths = strengths ?? new List<double>();
        }

        /// <summary>Add sounds that last from `start` to `end` seconds together.</summary>
        public void Add(List<SpelledSound> plan, double start, double end)
        {
            var at = start;
            var scale = (end - start) / plan.Select(sound => sound.Size).ToList().Sum();
            foreach (SpelledSound sound in plan)
            {
                var then = at + sound.Size * scale;
                if (sound.Shape != "")
                {
                    var fully = MouthRules.Vowels.Contains(sound.Shape) ? Math.Min(1.0, 0.7 + 0.4 * sound.Strength) : 1.0;
                    Pieces.Add(new MouthPiece(at, then, sound.Shape, fully));
                }
                if (sound.Strength > 0)
                {
                    Peaks.Add(0.5 * (at + then));
                    Strengths.Add(sound.Strength);
                }
                at = then;
            }
        }
    }

    public static class GraphemesRules
    {
        public const double Pace = 14.0; // characters a second: about 150 words a minute
        public const double Shortest = 0.4; // seconds
        // Values: shapes in turn. The longest spelling that fits is taken.
        private static readonly Dictionary<string, List<string>> Spellings = new Dictionary<string, List<string>> {
            { "tion", new List<string> { "CH", "nn" } },
            { "sch", new List<string> { "CH" } },
            { "tch", new List<string> { "CH" } },
            { "igh", new List<string> { "aa", "I" } },
            { "eau", new List<string> { "O" } },
            { "ough", new List<string> { "O" } },
            { "th", new List<string> { "TH" } },
            { "sh", new List<string> { "CH" } },
            { "ch", new List<string> { "CH" } },
            { "ph", new List<string> { "FF" } },
            { "ck", new List<string> { "kk" } },
            { "ng", new List<string> { "nn" } },
            { "qu", new List<string> { "kk", "U" } },
            { "wh", new List<string> { "U" } },
            { "oo", new List<string> { "U" } },
            { "ou", new List<string> { "aa", "U" } },
            { "ow", new List<string> { "O", "U" } },
            { "ee", new List<string> { "I" } },
            { "ea", new List<string> { "I" } },
            { "ai", new List<string> { "E", "I" } },
            { "ay", new List<string> { "E", "I" } },
            { "oi", new List<string> { "O", "I" } },
            { "oy", new List<string> { "O", "I" } },
            { "au", new List<string> { "O" } },
            { "aw", new List<string> { "O" } },
            { "ie", new List<string> { "I" } },
            { "ei", new List<string> { "E", "I" } },
            { "ue", new List<string> { "U" } },
            { "oa", new List<string> { "O" } },
            { "a", new List<string> { "aa" } },
            { "e", new List<string> { "E" } },
            { "i", new List<string> { "I" } },
            { "o", new List<string> { "O" } },
            { "u", new List<string> { "U" } },
            { "y", new List<string> { "I" } },
            { "ø", new List<string> { "U" } },
            { "œ", new List<string> { "U" } },
            { "æ", new List<string> { "E" } },
            { "ı", new List<string> { "I" } },
            { "b", new List<string> { "PP" } },
            { "p", new List<string> { "PP" } },
            { "m", new List<string> { "PP" } },
            { "f", new List<string> { "FF" } },
            { "v", new List<string> { "FF" } },
            { "d", new List<string> { "DD" } },
            { "t", new List<string> { "DD" } },
            { "l", new List<string> { "nn" } },
            { "n", new List<string> { "nn" } },
            { "k", new List<string> { "kk" } },
            { "g", new List<string> { "kk" } },
            { "c", new List<string> { "kk" } },
            { "q", new List<string> { "kk" } },
            { "x", new List<string> { "kk", "SS" } },
            { "h", new List<string> { "kk" } },
            { "j", new List<string> { "CH" } },
            { "s", new List<string> { "SS" } },
            { "z", new List<string> { "SS" } },
            { "r", new List<string> { "RR" } },
            { "w", new List<string> { "U" } },
            { "ß", new List<string> { "SS" } },
            { "ð", new List<string> { "TH" } },
            { "þ", new List<string> { "TH" } },
            { "ł", new List<string> { "nn" } },
            { "đ", new List<string> { "DD" } }
         };
        // Greek and Cyrillic letters, and the Latin ones they stand for.
        private static readonly Dictionary<string, string> Alike = new Dictionary<string, string> {
            { "α", "a" },
            { "ε", "e" },
            { "η", "e" },
            { "ι", "i" },
            { "ο", "o" },
            { "υ", "y" },
            { "ω", "o" },
            { "β", "b" },
            { "π", "p" },
            { "μ", "m" },
            { "φ", "f" },
            { "δ", "d" },
            { "τ", "t" },
            { "λ", "l" },
            { "ν", "n" },
            { "κ", "k" },
            { "γ", "g" },
            { "χ", "h" },
            { "ξ", "x" },
            { "σ", "s" },
            { "ς", "s" },
            { "ζ", "z" },
            { "ρ", "r" },
            { "θ", "þ" },
            { "а", "a" },
            { "б", "b" },
            { "в", "v" },
            { "г", "g" },
            { "д", "d" },
            { "е", "e" },
            { "ё", "e" },
            { "ж", "j" },
            { "з", "z" },
            { "и", "i" },
            { "й", "j" },
            { "к", "k" },
            { "л", "l" },
            { "м", "m" },
            { "н", "n" },
            { "о", "o" },
            { "п", "p" },
            { "р", "r" },
            { "с", "s" },
            { "т", "t" },
            { "у", "u" },
            { "ф", "f" },
            { "х", "h" },
            { "ц", "s" },
            { "ч", "j" },
            { "ш", "j" },
            { "щ", "j" },
            { "ы", "i" },
            { "э", "e" },
            { "ю", "u" },
            { "я", "a" },
            { "і", "i" },
            { "є", "e" },
            { "ї", "i" }
         };
        // of syllables nobody knows
        private static readonly List<string> Consonants = new List<string> { "DD", "nn", "SS", "kk", "PP" };
        private const double VowelLength = 1.25; // of one character's time
        private const double ConsonantLength = 0.8;
        private static readonly Dictionary<string, double> Stops = new Dictionary<string, double> {
            { ",", 1.5 },
            { ";", 2.0 },
            { ":", 2.0 },
            { ".", 3.0 },
            { "!", 3.0 },
            { "?", 3.0 },
            { "…", 3.0 },
            { "-", 0.3 },
            { "–", 1.5 },
            { "—", 1.5 },
            { "(", 1.0 },
            { ")", 1.0 },
            { "，", 1.5 },
            { "、", 1.5 },
            { "。", 3.0 },
            { "！", 3.0 },
            { "？", 3.0 }
         };
        private const double Blank = 0.35; // characters' time of anything else between words
        private static readonly List<Syllabary> Syllabaries = new List<Syllabary> {
            new Syllabary(12353, 12543, 2.0),
            new Syllabary(65382, 65437, 2.0),
            new Syllabary(13312, 40959, 3.0),
            new Syllabary(63744, 64255, 3.0),
            new Syllabary(131072, 205743, 3.0),
            new Syllabary(44032, 55203, 3.0)
         };

        /// <summary>Return the mouth shapes of a word's letters, in turn.</summary>
        public static List<string> Shapes(Alphabet alphabet, string word)
        {
            var out_ = new List<string>();
            var letters = alphabet.Plain(word).Select(c => PlainMaps.GetOr(Alike, c, c)).ToList();
            var at = 0;
            while (at < letters.Count)
            {
                var size = Math.Min(4, letters.Count - at);
                while (size > 1 && !Spellings.ContainsKey(string.Join("", PlainLists.Part(letters, at, at + size))))
                {
                    size -= 1;
                }
                var spelling = string.Join("", PlainLists.Part(letters, at, at + size));
                var found = Spellings.ContainsKey(spelling) ? Spellings[spelling] : Unknown(alphabet, spelling, out_);
                var last = at == letters.Count - 1;
                var finalE = spelling == "e" && last && out_.Count > 1 && out_.Any(s => MouthRules.Vowels.Contains(s));
                var twice = at > 0 && size == 1 && letters[at] == letters[at - 1];
                if (found.Count > 0 && !finalE && !(twice && !MouthRules.Vowels.Contains(found[0])))
                {
                    out_.AddRange(found);
                }
                at += size;
            }
            return out_;
        }

        private static List<string> Unknown(Alphabet alphabet, string letter, List<string> before)
        {
            var kind = alphabet.Kind(letter);
            if (kind == "syllable")
            {
                var code = alphabet.Code(letter);
                return new List<string> {
                    Consonants[PlainNumbers.Modulo(code, 5)],
                    MouthRules.Vowels[PlainNumbers.Modulo((int)Math.Floor((double)code / 5), 5)]
                 };
            }
            if (kind == "letter")
            {
                return (before.Count > 0 && !MouthRules.Vowels.Contains(before[before.Count - 1]))
                    ? new List<string> { "aa" }
                    : new List<string> { "DD" };
            }
            return new List<string>();
        }

        /// <summary>Return each word, and the pause after it, measured in characters.</summary>
        public static List<(string, double)> SplitWords(Alphabet alphabet, string text)
        {
            var out_ = new List<(string, double)>();
            var word = "";
            var pause = 0.0;
            foreach (string c in alphabet.Letters(text))
            {
                if (alphabet.Kind(c) != "" || c == "'" || c == "’")
                {
                    if (pause > 0)
                    {
                        out_.Add((word, pause));
                        word = "";
                        pause = 0.0;
                    }
                    word += c;
                }
                else
                {
                    pause += PlainMaps.GetOr(Stops, c, Blank);
                }
            }
            if (word != "" || pause > 0)
            {
                out_.Add((word, pause));
            }
            return out_;
        }

        /// <summary>
        /// Return a word's sounds, in turn.
        ///
        /// Content words are longer than the words between them. The first vowel usually has the stress.
        /// </summary>
        public static List<SpelledSound> Sounds(Alphabet alphabet, string word)
        {
            var out_ = new List<SpelledSound>();
            var found = Shapes(alphabet, word);
            var weight = Math.Min(1.0, 0.35 + 0.09 * alphabet.Letters(word).Count) - 0.1 * alphabet.Scatter(word) / 100;
            var first = true;
            var before = "";
            foreach (string shape in found)
            {
                var vowel = MouthRules.Vowels.Contains(shape);
                var syllable = vowel && !MouthRules.Vowels.Contains(before);
                var strength = syllable ? first ? weight : 0.6 * weight : 0.0;
                first = first && !syllable;
                out_.Add(new SpelledSound(shape, vowel ? VowelLength : ConsonantLength, strength));
                before = shape;
            }
            return out_;
        }

        /// <summary>Return how long a text takes to say, seconds.</summary>
        public static double ReadAloud(Alphabet alphabet, string text)
        {
            var letters = alphabet.Letters(alphabet.Stripped(text));
            return Math.Max(Shortest, letters.Select(letter => MeasureLetter(alphabet.Code(letter))).ToList().Sum() / Pace);
        }

        /// <summary>
        /// Return how long a letter takes, measured in characters, by its code point: a Chinese, Japanese or Korean one is a
        /// syllable.
        /// </summary>
        public static double MeasureLetter(int code)
        {
            foreach (Syllabary script in Syllabaries)
            {
                if (script.First <= code && code <= script.Last)
                {
                    return script.Size;
                }
            }
            return 1.0;
        }

        /// <summary>Return the sounds of a text that lasts `duration` seconds; none if it has no known letter.</summary>
        public static Spelled Spelled(Alphabet alphabet, string text, double duration)
        {
            var out_ = new Spelled();
            var plan = new List<SpelledSound>();
            foreach (var one in SplitWords(alphabet, alphabet.Stripped(text)))
            {
                var word = one.Item1;
                var pause = one.Item2;
                plan.AddRange(Sounds(alphabet, word));
                if (pause > 0)
                {
                    plan.Add(new SpelledSound("", pause));
                }
            }
            if (duration >= 0.001 && plan.Any(sound => sound.Shape != ""))
            {
                var edge = Math.Min(0.06, 0.1 * duration);
                out_.Add(plan, edge, duration - edge);
            }
            return out_;
        }
    }
}
