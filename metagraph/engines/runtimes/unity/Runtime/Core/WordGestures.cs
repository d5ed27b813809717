// Translated from metagraph/speech/word_gestures.py; change that, and translate anew.
using System;
using System.Collections.Generic;
using System.Linq;

namespace Metagraph
{
    /// <summary>
    /// A gesture that some words propose. words: small letters; several in a row for a phrase. tags: of a gesture of the arms,
    /// the best first; the first one that the character has counts. head: its movement at the same time: "nod", "shake" or
    /// nothing. strength: the stronger of two rules wins.
    /// </summary>
    public sealed class GestureRule
    {
        public readonly List<string> Words;
        public readonly List<string> Tags;
        public readonly string Head;
        public readonly double Strength;

        public GestureRule(List<string> words = null, List<string> tags = null, string head = "", double strength = 1.0)
        {
            Words = words ?? new List<string>();
            Tags = tags ?? new List<string>();
            Head = head;
            Strength = strength;
        }
    }

    /// <summary>
    /// A lexicon. question, exclamation: proposed at the end of a sentence, for its last content word. clause: proposed for a
    /// clause without other proposals.
    /// </summary>
    public sealed class GestureWords
    {
        public readonly List<GestureRule> Rules;
        public readonly string Language;
        public readonly GestureRule Question;
        public readonly GestureRule Exclamation;
        public readonly GestureRule Clause;

        public GestureWords(
            List<GestureRule> rules,
            string language = "en",
            GestureRule question = null,
            GestureRule exclamation = null,
            GestureRule clause = null
        )
        {
            Rules = rules;
            Language = language;
            Question = question ?? new GestureRule();
            Exclamation = exclamation ?? new GestureRule();
            Clause = clause ?? new GestureRule();
        }
    }

    /// <summary>A word of a text. plain: in small letters. mark: the punctuation after it.</summary>
    public sealed class TextWord
    {
        public readonly string Text;
        public readonly string Plain;
        public readonly double Start;
        public readonly double End;
        public readonly string Mark;

        public TextWord(string text, string plain, double start, double end, string mark = "")
        {
            Text = text;
            Plain = plain;
            Start = start;
            End = end;
            Mark = mark;
        }
    }

    /// <summary>A word with the times at which a synthesiser says it.</summary>
    public sealed class ToldWord
    {
        public readonly double Start;
        public readonly double End;

        public ToldWord(double start, double end)
        {
            Start = start;
            End = end;
        }
    }

    /// <summary>
    /// A gesture that goes with a word. do: "gesture", "nod" or "shake". at: time of its stroke. tags: empty for gestures of the
    /// head.
    /// </summary>
    public sealed class ProposedGesture
    {
        public readonly string Layer;
        public readonly double At;
        public readonly List<string> Tags;
        public readonly double Strength;
        public readonly string Word;
        public readonly string Do;

        public ProposedGesture(string layer, double at, List<string> tags, double strength, string word, string do_ = "gesture")
        {
            Layer = layer;
            At = at;
            Tags = tags;
            Strength = strength;
            Word = word;
            Do = do_;
        }
    }

    /// <summary>
    /// The request for a gesture. at: the earliest second of the session at which it may begin. stroke: the time of its stroke,
    /// None for the head. late: by how many seconds it may come late.
    /// </summary>
    public sealed class GestureAsk
    {
        public readonly string Do;
        public readonly string Layer;
        public readonly List<string> Tags;
        public readonly double At;
        public readonly double? Stroke;
        public readonly double Late;

        public GestureAsk(string do_, string layer, List<string> tags, double at, double? stroke, double late)
        {
            Do = do_;
            Layer = layer;
            Tags = tags;
            At = at;
            Stroke = stroke;
            Late = late;
        }
    }

    /// <summary>A word, the number of letters of the text up to its end, and the mark after it.</summary>
    public sealed class SplitWord
    {
        public readonly string Text;
        public readonly int End;
        public readonly string Mark;

        public SplitWord(string text, int end, string mark)
        {
            Text = text;
            End = end;
            Mark = mark;
        }
    }

    public static class WordGesturesRules
    {
        public static readonly Dictionary<string, double> Apart = new Dictionary<string, double> {
            { "arms", 2.4 },
            { "head", 1.8 }
         }; // seconds between two strokes of a layer, at least
        public const double Again = 1.6; // and so many times as far where both are of the same tag
        public const double Late = 0.35; // seconds that a stroke may come after its word; later than that none is made
        // seconds into a text up to which a stroke may come late: a hand needs as long to get there
        public const double First = 1.4;
        public const double Plain = 0.55; // of the clauses that propose nothing, how many get a beat
        public const double Lead = 0.1; // seconds that a stroke comes before the middle of its word's vowels
        public const double MeaningLead = 0.2; // the same of a gesture that means something
        // tags of gestures that go with any word
        public static readonly List<string> Beats = new List<string> { "beat", "emphasis", "explain", "open" };
        public const double Nod = 0.3; // seconds from where a nod begins to its first stroke
        public const int Clause = 3; // words of a clause that gets a beat, at least
        public const int Longest = 20000; // letters of a text
        public const string Ends = ".?!…。？！";
        public const string Pauses = ",;:–—、，";
        public const string Inside = "'’-"; // what a word may have in the middle
        public const string Closing = "\"')”»"; // what may stand between a word and the mark behind it

        /// <summary>
        /// Return a text's words with their times: those of a synthesiser, else as long as lips would take.
        ///
        /// told: the times of the words in order; words without times are left out. seconds: how long all of it takes, if only
        /// that is known.
        /// </summary>
        public static List<TextWord> WordsOf(Alphabet alphabet, string text, List<ToldWord> told = null, double? seconds = null)
        {
            told = told ?? new List<ToldWord>();
            var letters = alphabet.Letters(text);
            var pace = 1.0;
            if (seconds != null && told.Count == 0)
            {
                pace = seconds.Value / Math.Max(0.001, GraphemesRules.ReadAloud(alphabet, text));
            }
            var out_ = new List<TextWord>();
            foreach (SplitWord split in Split(alphabet, PlainLists.Part(letters, 0, Longest)))
            {
                var small = alphabet.Letters(split.Text.ToLowerInvariant());
                var plain = string.Join("", small.Select(letter => letter == "’" ? "'" : letter).ToList());
                if (told.Count > 0)
                {
                    if (out_.Count == told.Count)
                    {
                        break;
                    }
                    var times = told[out_.Count];
                    out_.Add(new TextWord(split.Text, plain, times.Start, times.End, split.Mark));
                }
                else
                {
                    var stop = pace * GraphemesRules.ReadAloud(alphabet, string.Join("", PlainLists.Part(letters, 0, split.End)));
                    var before = out_.Count > 0 ? out_[out_.Count - 1].End : 0.0;
                    var start = Math.Max(before, stop - pace * GraphemesRules.ReadAloud(alphabet, split.Text));
                    out_.Add(new TextWord(split.Text, plain, start, stop, split.Mark));
                }
            }
            return out_;
        }

        private static bool IsLetter(Alphabet alphabet, string letter)
        {
            var kind = alphabet.Kind(letter);
            return kind == "syllable" || kind == "letter";
        }

        /// <summary>Return whether letters contain words, so that there is something to say.</summary>
        public static bool Telling(Alphabet alphabet, List<string> letters)
        {
            return letters.Any(letter => IsLetter(alphabet, letter));
        }

        private static List<SplitWord> Split(Alphabet alphabet, List<string> letters)
        {
            var out_ = new List<SplitWord>();
            var at = 0;
            var count = letters.Count;
            while (at < count)
            {
                if (!IsLetter(alphabet, letters[at]))
                {
                    at += 1;
                    continue;
                }
                var first = at;
                while (at < count)
                {
                    var goesOn = IsLetter(alphabet, letters[at]);
                    if (!goesOn && Inside.Contains(letters[at]) && at + 1 < count)
                    {
                        goesOn = IsLetter(alphabet, letters[at + 1]);
                    }
                    if (!goesOn)
                    {
                        break;
                    }
                    at += 1;
                }
                var behind = at;
                while (behind < count && Closing.Contains(letters[behind]))
                {
                    behind += 1;
                }
                var mark = "";
                if (behind < count && (Ends.Contains(letters[behind]) || Pauses.Contains(letters[behind])))
                {
                    mark = letters[behind];
                }
                out_.Add(new SplitWord(string.Join("", PlainLists.Part(letters, first, at)), at, mark));
            }
            return out_;
        }

        /// <summary>
        /// Return the gestures that go with words, in order and without collisions.
        ///
        /// arms: tags of the character's gestures of the arms; others are not proposed. head: whether the head moves. small:
        /// words that say little by themselves.
        /// </summary>
        public static List<ProposedGesture> ProposedFor(
            List<TextWord> words,
            HashSet<string> arms,
            bool head,
            GestureWords lexicon,
            HashSet<string> small,
            uint seed
        )
        {
            var every = new List<ProposedGesture>();
            var clause = new List<TextWord>();
            var proposes = false;
            foreach (var pair in words.Select((item, n) => (n, item)))
            {
                var n = pair.Item1;
                var word = pair.Item2;
                clause.Add(word);
                var found = Fitting(lexicon, words, n);
                GestureRule rule = found.Item1;
                int length = found.Item2;
                if (length > 0)
                {
                    every.AddRange(Of(rule, words[n + length - 1], arms, head));
                    proposes = true;
                }
                if (word.Mark == "" && n + 1 < words.Count)
                {
                    continue;
                }
                var large = clause.Where(w => !small.Contains(w.Plain)).ToList();
                var last = large.Count > 0 ? large[large.Count - 1] : clause[clause.Count - 1];
                if (word.Mark == "?" || word.Mark == "？")
                {
                    every.AddRange(Of(lexicon.Question, last, arms, head));
                }
                else if (word.Mark == "!" || word.Mark == "！")
                {
                    every.AddRange(Of(lexicon.Exclamation, last, arms, head));
                }
                else if (!proposes
                    && clause.Count >= Clause
                    && ChoiceRules.Uniform(seed, PlainText.Of(n) + "/" + last.Plain, "beat") < Plain)
                {
                    every.AddRange(Of(lexicon.Clause, last, arms, head));
                }
                clause = new List<TextWord>();
                proposes = false;
            }
            var kept = Spaced(every);
            return kept.OrderBy(one => one.At).ToList();
        }

        /// <summary>
        /// Return the rule with the longest phrase that begins at a word, and the number of its words; 0 if there is none.
        /// </summary>
        private static (GestureRule, int) Fitting(GestureWords lexicon, List<TextWord> words, int n)
        {
            var best = lexicon.Clause;
            var longest = 0;
            foreach (GestureRule rule in lexicon.Rules)
            {
                foreach (string phrase in rule.Words)
                {
                    var parts = PlainText.Words(phrase);
                    if (parts.Count > longest && Says(words, n, parts))
                    {
                        best = rule;
                        longest = parts.Count;
                    }
                }
            }
            return (best, longest);
        }

        /// <summary>Return whether a phrase begins at a word, without a pause inside it.</summary>
        private static bool Says(List<TextWord> words, int first, List<string> parts)
        {
            if (first + parts.Count > words.Count)
            {
                return false;
            }
            foreach (var one in parts.Select((item, n) => (n, item)))
            {
                var k = one.Item1;
                var part = one.Item2;
                if (words[first + k].Plain != part || (k + 1 < parts.Count && words[first + k].Mark != ""))
                {
                    return false;
                }
            }
            return true;
        }

        private static List<ProposedGesture> Of(GestureRule rule, TextWord word, HashSet<string> arms, bool head)
        {
            var at = Math.Max(0.0, (word.Start + word.End) / 2 - Lead);
            var out_ = new List<ProposedGesture>();
            foreach (string tag in rule.Tags)
            {
                if (arms.Contains(tag))
                {
                    var early = Beats.Contains(tag) ? 0.0 : MeaningLead - Lead;
                    out_.Add(new ProposedGesture(
                        "arms",
                        Math.Max(0.0, at - early),
                        new List<string> { tag },
                        rule.Strength,
                        word.Text
                    ));
                    break;
                }
            }
            if (rule.Head != "" && head)
            {
                out_.Add(new ProposedGesture("head", at, new List<string>(), rule.Strength, word.Text, rule.Head));
            }
            return out_;
        }

        /// <summary>
        /// Leave out gestures that are too near to a stronger one of their layer; of two equal ones the earlier stays. The same
        /// tag twice in a row needs more room.
        /// </summary>
        private static List<ProposedGesture> Spaced(List<ProposedGesture> every)
        {
            var kept = new List<ProposedGesture>();
            foreach (ProposedGesture one in every.OrderBy(one => -one.Strength).ThenBy(one => one.At).ToList())
            {
                if (!kept.Any(other => InTheWay(one, other)))
                {
                    kept.Add(one);
                }
            }
            return kept;
        }

        private static bool InTheWay(ProposedGesture one, ProposedGesture other)
        {
            if (one.Layer != other.Layer)
            {
                return false;
            }
            var room = Apart[one.Layer];
            if (one.Tags.Count == 0 || (other.Tags.Count > 0 && one.Tags[0] == other.Tags[0]))
            {
                room *= Again;
            }
            return Math.Abs(one.At - other.At) < room;
        }

        /// <summary>
        /// Return the requests for the gestures of a text that begins at `at` seconds of the session. Gestures that cannot be in
        /// time are refused, not made late.
        /// </summary>
        public static List<GestureAsk> GestureAsks(List<ProposedGesture> every, double at)
        {
            var out_ = new List<GestureAsk>();
            foreach (ProposedGesture one in every)
            {
                var late = Math.Max(Late, First - one.At);
                if (one.Do == "gesture")
                {
                    out_.Add(new GestureAsk(one.Do, one.Layer, one.Tags, at, at + one.At, late));
                }
                else
                {
                    out_.Add(new GestureAsk(one.Do, one.Layer, new List<string>(), at + Math.Max(0.0, one.At - Nod), null, late));
                }
            }
            return out_;
        }

        /// <summary>
        /// Return the number of letters after which the first sentence of a text ends, 0 if it goes on. over: whether the text is
        /// complete.
        /// </summary>
        public static int SentenceEnd(Alphabet alphabet, List<string> letters, bool over)
        {
            var some = false;
            foreach (var one in letters.Select((item, n) => (n, item)))
            {
                var n = one.Item1;
                var letter = one.Item2;
                var blank = alphabet.Stripped(letter) == "";
                if (letter == "\n" && some)
                {
                    return n + 1;
                }
                // An end is one once something else follows: "3." may become "3.5".
                if (Ends.Contains(letter)
                    && n + 1 < letters.Count
                    && ("。？！".Contains(letter) || alphabet.Stripped(letters[n + 1]) == ""))
                {
                    return n + 1;
                }
                some = some || !blank;
            }
            return (over && some) ? letters.Count : 0;
        }
    }
}
