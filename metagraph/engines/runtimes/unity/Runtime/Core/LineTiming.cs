// Translated from metagraph/playback/life/line_timing.py; change that, and translate anew.
using System;
using System.Collections.Generic;
using System.Linq;

namespace Metagraph
{
    /// <summary>A word from `start` to `end`; `end` is None if only its start is known.</summary>
    public sealed class SpokenWord
    {
        public readonly string Text;
        public readonly double Start;
        public readonly double? End;

        public SpokenWord(string text, double start, double? end = null)
        {
            Text = text;
            Start = start;
            End = end;
        }
    }

    /// <summary>
    /// A mouth shape from `at` until the next mark of a later time. viseme: its name in its set; in a `LineTiming`, one of
    /// `VISEMES`. weight: how fully it is made, 0..1.
    /// </summary>
    public sealed class VisemeMark
    {
        public readonly double At;
        public readonly string Viseme;
        public readonly double Weight;

        public VisemeMark(double at, string viseme, double weight = 1.0)
        {
            At = at;
            Viseme = viseme;
            Weight = weight;
        }
    }

    /// <summary>
    /// A line's words and mouth shapes, each by time. later: seconds by which later pieces are delayed, because one came after
    /// its time. paced: whether the times are estimated from the letters.
    /// </summary>
    public sealed class LineTiming
    {
        public readonly List<SpokenWord> Words;
        public readonly List<VisemeMark> Marks;
        public readonly double Later;
        public readonly bool Paced;

        public LineTiming(List<SpokenWord> words = null, List<VisemeMark> marks = null, double later = 0.0, bool paced = false)
        {
            Words = words ?? new List<SpokenWord>();
            Marks = marks ?? new List<VisemeMark>();
            Later = later;
            Paced = paced;
        }
    }

    public static class LineTimingRules
    {
        public const double Word = 0.15; // seconds that a word takes if only its start is known and nothing comes sooner
        public const double Letter = 0.07; // and seconds for each of its letters
        public const double Shape = 0.2; // seconds for which the last shape of a line stays
        public const double Farthest = 3600.0; // seconds of a line
        public const double Again = 0.1; // a later piece belongs to a line from this many seconds before its last shape on
        public const double Slack = 0.05; // seconds by which times may exceed the given end
        public const double Missed = 0.1; // seconds by which a word may come late and only be cut short
        // What each viseme of a set shows of the mouth shapes, and how fully.
        public static readonly Dictionary<string, string> Oculus = new Dictionary<string, string> {
            { "sil", "sil" },
            { "PP", "PP" },
            { "FF", "FF" },
            { "TH", "TH" },
            { "DD", "DD" },
            { "kk", "kk" },
            { "CH", "CH" },
            { "SS", "SS" },
            { "nn", "nn" },
            { "RR", "RR" },
            { "aa", "aa" },
            { "E", "E" },
            { "ih", "I" },
            { "oh", "O" },
            { "ou", "U" },
            { "I", "I" },
            { "O", "O" },
            { "U", "U" }
         };
        // SAPI's numbers, which Azure has, too.
        public static readonly Dictionary<string, string> Azure = new Dictionary<string, string> {
            { "0", "sil" },
            { "1", "E" },
            { "2", "aa" },
            { "3", "O" },
            { "4", "E" },
            { "5", "RR" },
            { "6", "I" },
            { "7", "U" },
            { "8", "O" },
            { "9", "aa" },
            { "10", "O" },
            { "11", "aa" },
            { "12", "kk" },
            { "13", "RR" },
            { "14", "nn" },
            { "15", "SS" },
            { "16", "CH" },
            { "17", "TH" },
            { "18", "FF" },
            { "19", "DD" },
            { "20", "kk" },
            { "21", "PP" }
         };
        // Amazon Polly's speech marks.
        public static readonly Dictionary<string, string> Polly = new Dictionary<string, string> {
            { "sil", "sil" },
            { "p", "PP" },
            { "t", "DD" },
            { "S", "CH" },
            { "T", "TH" },
            { "f", "FF" },
            { "k", "kk" },
            { "i", "I" },
            { "r", "RR" },
            { "s", "SS" },
            { "u", "U" },
            { "@", "E" },
            { "a", "aa" },
            { "e", "E" },
            { "E", "E" },
            { "o", "O" },
            { "O", "O" }
         };
        // Of ARKit's blend shapes those that make the mouth.
        public static readonly Dictionary<string, string> Arkit = new Dictionary<string, string> {
            { "jawOpen", "aa" },
            { "mouthClose", "PP" },
            { "mouthPressLeft", "PP" },
            { "mouthPressRight", "PP" },
            { "mouthFunnel", "O" },
            { "mouthPucker", "U" },
            { "mouthRollLower", "FF" },
            { "mouthRollUpper", "PP" },
            { "mouthStretchLeft", "E" },
            { "mouthStretchRight", "E" },
            { "mouthSmileLeft", "I" },
            { "mouthSmileRight", "I" },
            { "mouthShrugUpper", "CH" },
            { "tongueOut", "TH" }
         };
        public static readonly List<string> Sets = new List<string> { "oculus", "azure", "sapi", "polly", "arkit" };
        public static readonly Dictionary<string, double> Weak = new Dictionary<string, double> {
            { "@", 0.6 },
            { "12", 0.5 },
            { "1", 0.8 },
            { "mouthSmileLeft", 0.3 },
            { "mouthSmileRight", 0.3 }
         };

        /// <summary>Return whether two lines have the same words and shapes at the same times.</summary>
        public static bool AlikeTimings(LineTiming one, LineTiming other)
        {
            if (one == null || other == null)
            {
                return one == null && other == null;
            }
            if (one.Words.Count != other.Words.Count || one.Marks.Count != other.Marks.Count)
            {
                return false;
            }
            var words = PlainLists.Pairs(one.Words, other.Words).All(pair => pair.Item1.Text == pair.Item2.Text
                && pair.Item1.Start == pair.Item2.Start
                && pair.Item1.End == pair.Item2.End);
            return words
                && PlainLists.Pairs(one.Marks, other.Marks).All(pair => pair.Item1.At == pair.Item2.At
                    && pair.Item1.Viseme == pair.Item2.Viseme
                    && pair.Item1.Weight == pair.Item2.Weight);
        }

        private static Dictionary<string, string> Table(string name)
        {
            if (name == "oculus")
            {
                return Oculus;
            }
            if (name == "polly")
            {
                return Polly;
            }
            return name == "arkit" ? Arkit : Azure;
        }

        /// <summary>Return the first set that has all of the visemes, "" if none has.</summary>
        public static string SetOf(List<VisemeMark> marks)
        {
            foreach (string name in Sets)
            {
                if (marks.All(mark => Table(name).ContainsKey(mark.Viseme)))
                {
                    return name;
                }
            }
            return "";
        }

        /// <summary>
        /// Return what is wrong with a line's times, where, and what would be right; "" if nothing is wrong.
        ///
        /// name: of the visemes' set, "" to find it by their names. duration: seconds of its sound, None if unknown.
        /// </summary>
        public static string WrongIn(List<SpokenWord> words, List<VisemeMark> marks, string name, double? duration)
        {
            var last = 0.0;
            string why = default(string);
            foreach (var one in words.Select((item, n) => (n, item)))
            {
                var n = one.Item1;
                var word = one.Item2;
                var place = "words[" + PlainText.Of(n) + "] '" + word.Text + "'";
                why = OutOfRange(word.Start);
                if (why == "" && word.Start < last)
                {
                    why = "begins at " + PlainText.Fixed(word.Start, 3) + " s, before the one before it; put words in order";
                }
                var end = word.End == null ? word.Start : word.End.Value;
                if (why == "" && !(end >= word.Start))
                {
                    why = "ends at " + PlainText.Fixed(end, 3) + " s, before it begins; give [word, start, end] in seconds";
                }
                if (why == "" && duration != null && end > duration.Value + Slack)
                {
                    why = "ends at "
                        + PlainText.Fixed(end, 3)
                        + " s, past the end at "
                        + PlainText.Fixed(duration.Value, 3)
                        + " s; give a longer duration";
                }
                if (why != "")
                {
                    return place + ": " + why;
                }
                last = word.Start;
            }
            if (name != "" && !Sets.Contains(name))
            {
                return "set: '" + name + "' is no set of visemes; there are " + string.Join(", ", Sets);
            }
            var found = name == "" ? SetOf(marks) : name;
            last = 0.0;
            foreach (var one in marks.Select((item, n) => (n, item)))
            {
                var n = one.Item1;
                var mark = one.Item2;
                why = OutOfRange(mark.At);
                if (why == "" && mark.At < last)
                {
                    why = "comes at " + PlainText.Fixed(mark.At, 3) + " s, before the one before it; put visemes in order";
                }
                if (why == "" && duration != null && mark.At > duration.Value + Slack)
                {
                    why = "comes at "
                        + PlainText.Fixed(mark.At, 3)
                        + " s, past the end at "
                        + PlainText.Fixed(duration.Value, 3)
                        + " s; give a longer duration";
                }
                if (why == "" && !(0 <= mark.Weight && mark.Weight <= 1))
                {
                    why = "has the weight " + PlainText.Fixed(mark.Weight, 3) + "; weights are from 0 to 1";
                }
                if (why == "" && found == "" && SetOf(new List<VisemeMark> { mark }) == "")
                {
                    why = "is in no set of visemes; there are " + string.Join(", ", Sets);
                }
                if (why == "" && found != "" && !Table(found).ContainsKey(mark.Viseme))
                {
                    why = "is not in the set '"
                        + found
                        + "', which has "
                        + string.Join(", ", Table(found).Keys.ToList().ToList());
                }
                if (why != "")
                {
                    return "visemes[" + PlainText.Of(n) + "] '" + mark.Viseme + "': " + why;
                }
                last = mark.At;
            }
            if (found == "")
            {
                return "visemes: no set has all of them; there are " + string.Join(", ", Sets);
            }
            return "";
        }

        private static string OutOfRange(double seconds)
        {
            if (0 <= seconds && seconds <= Farthest)
            {
                return "";
            }
            return "is at "
                + PlainText.Fixed(seconds, 3)
                + " s; times are from 0 to "
                + PlainText.Fixed(Farthest, 1)
                + " s from the line's start";
        }

        /// <summary>Return the timing of words and visemes that are valid. name: as for `wrong_in`.</summary>
        public static LineTiming TimingOf(Alphabet alphabet, List<SpokenWord> words, List<VisemeMark> marks, string name)
        {
            var table = Table(name == "" ? SetOf(marks) : name);
            var shown = marks.Select(m => new VisemeMark(
                m.At,
                table[m.Viseme],
                m.Weight * PlainMaps.GetOr(Weak, m.Viseme, 1.0)
            )).ToList();
            var said = new List<SpokenWord>();
            foreach (var one in words.Select((item, n) => (n, item)))
            {
                var n = one.Item1;
                var word = one.Item2;
                var end = word.End == null ? word.Start + Word + Letter * alphabet.Letters(word.Text).Count : word.End.Value;
                if (n + 1 < words.Count)
                {
                    end = Math.Min(end, words[n + 1].Start);
                }
                if (word.End == null) // a pause ends it
                {
                    end = Math.Min(
                        end,
                        shown.Where(m => m.Viseme == "sil" && m.At > word.Start).Select(m => m.At).DefaultIfEmpty(end).First()
                    );
                }
                said.Add(new SpokenWord(word.Text, word.Start, Math.Max(end, word.Start)));
            }
            return new LineTiming(said.ToList(), shown.ToList());
        }

        /// <summary>Return how many seconds a text takes as a part of a longer text.</summary>
        public static double MeasureText(Alphabet alphabet, string text)
        {
            var out_ = 0.0;
            foreach (var one in GraphemesRules.SplitWords(alphabet, text))
            {
                var word = one.Item1;
                var pause = one.Item2;
                out_ += MeasureWord(alphabet, word) + pause / GraphemesRules.Pace;
            }
            return out_;
        }

        /// <summary>
        /// Return the words of a text, one after the other. seconds: how long all of it takes, None to estimate it from the
        /// letters.
        /// </summary>
        public static LineTiming PaceText(Alphabet alphabet, string text, double? seconds)
        {
            var scale = seconds == null ? 1.0 : seconds.Value / Math.Max(MeasureText(alphabet, text), 0.001);
            var at = 0.0;
            var words = new List<SpokenWord>();
            foreach (var one in GraphemesRules.SplitWords(alphabet, text))
            {
                var word = one.Item1;
                var pause = one.Item2;
                var end = at + scale * MeasureWord(alphabet, word);
                if (word != "")
                {
                    words.Add(new SpokenWord(word, at, end));
                }
                at = end + scale * pause / GraphemesRules.Pace;
            }
            return new LineTiming(words.ToList(), new List<VisemeMark>(), 0.0, true);
        }

        /// <summary>Return how long a word takes, seconds.</summary>
        private static double MeasureWord(Alphabet alphabet, string word)
        {
            return alphabet.Letters(word).Select(letter => GraphemesRules.MeasureLetter(alphabet.Code(letter))).ToList().Sum()
                / GraphemesRules.Pace;
        }

        /// <summary>
        /// Return the words of letters that have a time each. Blanks separate words, and so does each letter that is a syllable.
        /// </summary>
        public static List<SpokenWord> JoinLetters(Alphabet alphabet, List<SpokenWord> letters)
        {
            var out_ = new List<SpokenWord>();
            var parted = true;
            foreach (SpokenWord letter in letters)
            {
                if (alphabet.Stripped(letter.Text) == "")
                {
                    parted = true;
                    continue;
                }
                var alone = GraphemesRules.MeasureLetter(alphabet.Code(alphabet.Letters(letter.Text)[0])) > 1;
                if (parted || alone)
                {
                    out_.Add(letter);
                }
                else
                {
                    var last = out_[out_.Count - 1];
                    out_[out_.Count - 1] = new SpokenWord(last.Text + letter.Text, last.Start, letter.End);
                }
                parted = alone;
            }
            return out_;
        }

        /// <summary>Return the words of a line as its text.</summary>
        public static string ToldText(LineTiming timing)
        {
            return string.Join(" ", timing.Words.Select(word => word.Text).ToList());
        }

        /// <summary>
        /// Return how long a line lasts, rounded to whole rows of the mouth's track, so that later additions move nothing.
        /// duration: of its sound, None for as long as its words and shapes need.
        /// </summary>
        public static double TimedSeconds(LineTiming timing, double? duration)
        {
            var last = EndOf(timing);
            return (int)Math.Ceiling((duration == null ? last + MouthRules.Late : Math.Max(duration.Value, last))
                        / MouthRules.Step
                    - 1e-06)
                * MouthRules.Step;
        }

        /// <summary>
        /// Return the mouth's pieces and the syllables of a line's words and shapes: the mouth follows the shapes if there are
        /// any; gestures and blinks follow the words.
        /// </summary>
        public static Spelled TimedSounds(Alphabet alphabet, LineTiming timing)
        {
            var out_ = new Spelled();
            foreach (SpokenWord word in timing.Words)
            {
                var plan = GraphemesRules.Sounds(alphabet, word.Text);
                var over = word.End == null ? word.Start : word.End.Value;
                if (plan.Count > 0 && over > word.Start)
                {
                    out_.Add(plan, word.Start, over);
                }
            }
            if (timing.Marks.Count == 0)
            {
                return out_;
            }
            var shown = new Spelled();
            var before = "sil";
            foreach (var one in PlainLists.Pairs(timing.Marks, Ends(timing.Marks)))
            {
                var mark = one.Item1;
                var end = one.Item2;
                if (mark.Viseme != "sil" && end > mark.At)
                {
                    shown.Pieces.Add(new MouthPiece(mark.At, end, mark.Viseme, mark.Weight));
                    if (MouthRules.Vowels.Contains(mark.Viseme) && !MouthRules.Vowels.Contains(before) && mark.Weight > 0)
                    {
                        shown.Peaks.Add(0.5 * (mark.At + end));
                        shown.Strengths.Add(mark.Weight * Math.Min(1.0, 0.3 + 4 * (end - mark.At)));
                    }
                }
                before = mark.Viseme;
            }
            if (out_.Peaks.Count > 0)
            {
                return new Spelled(shown.Pieces, out_.Peaks, out_.Strengths);
            }
            return shown;
        }

        /// <summary>Return when each mark ends: marks at the same time show together.</summary>
        private static List<double> Ends(List<VisemeMark> marks)
        {
            var out_ = new List<double>();
            var end = 0.0;
            var at = -1.0;
            foreach (VisemeMark mark in marks.AsEnumerable().Reverse().ToList())
            {
                if (mark.At != at)
                {
                    end = at < 0 ? mark.At + Shape : at;
                    at = mark.At;
                }
                out_.Add(end);
            }
            return out_.AsEnumerable().Reverse().ToList().ToList();
        }

        /// <summary>
        /// Return whether a piece that comes after the end of a line belongs to the same line: it begins after the last known
        /// word or shape, or repeats all with more behind it. Otherwise it is something else under the same id.
        /// </summary>
        public static bool TellsOn(LineTiming old, LineTiming new_)
        {
            if (new_.Words.Count > 0 && old.Words.Count > 0)
            {
                var first = new_.Words[0];
                if (first.Start > old.Words[old.Words.Count - 1].Start)
                {
                    return true;
                }
                var same = first.Text == old.Words[0].Text && first.Start == old.Words[0].Start;
                return same && new_.Words.Count > old.Words.Count;
            }
            if (new_.Marks.Count > 0 && old.Marks.Count > 0)
            {
                var shape = new_.Marks[0];
                if (shape.At >= old.Marks[old.Marks.Count - 1].At - Again)
                {
                    return true;
                }
                return shape.At == old.Marks[0].At && new_.Marks.Count > old.Marks.Count;
            }
            return false;
        }

        /// <summary>Return a timing `by` seconds later.</summary>
        public static LineTiming Shifted(LineTiming timing, double by)
        {
            if (by == 0)
            {
                return timing;
            }
            var words = timing.Words.Select(word => new SpokenWord(
                word.Text,
                word.Start + by,
                word.End == null ? (double?)null : word.End.Value + by
            )).ToList();
            return new LineTiming(
                words.ToList(),
                timing.Marks.Select(mark => new VisemeMark(mark.At + by, mark.Viseme, mark.Weight)).ToList()
            );
        }

        /// <summary>
        /// Return a later piece of a line with the times at which it is said. A piece that counts from its own beginning follows
        /// the earlier pieces. A piece that comes too late, because the voice had stopped, is said at once, and everything after
        /// it is delayed. said: seconds of the line that are over.
        /// </summary>
        public static LineTiming PlaceTold(LineTiming old, LineTiming new_, double said)
        {
            var end = EndOf(old);
            if (Restarts(old, new_, said))
            {
                return new LineTiming(
                    Shifted(new_, Math.Max(said, end)).Words,
                    Shifted(new_, Math.Max(said, end)).Marks,
                    old.Later,
                    Shifted(new_, Math.Max(said, end)).Paced
                );
            }
            var told = Shifted(new_, old.Later);
            var by = 0.0;
            if (old.Words.Count > 0 && told.Words.Count > 0)
            {
                var words = told.Words.Where(word => word.Start > old.Words[old.Words.Count - 1].Start).ToList();
                if (words.Count > 0
                    && ComesLate(words[0].Start, PlainNumbers.MaxOf(words.Select(word => End(word)).ToList()), end, said))
                {
                    by = Math.Max(said, end) - words[0].Start;
                }
            }
            else if (old.Marks.Count > 0 && told.Marks.Count > 0)
            {
                var marks = told.Marks.Where(mark => mark.At > old.Marks[old.Marks.Count - 1].At).ToList();
                if (marks.Count > 0 && ComesLate(marks[0].At, marks[marks.Count - 1].At + Shape, end, said))
                {
                    by = Math.Max(said, end) - marks[0].At;
                }
            }
            return new LineTiming(Shifted(told, by).Words, Shifted(told, by).Marks, old.Later + by, Shifted(told, by).Paced);
        }

        /// <summary>
        /// Return whether what is new of a line comes too late: all of it, or its beginning after the voice had stopped. first,
        /// last: when it would begin and end; silent: when what was known before ends; said: as for `place_told`.
        /// </summary>
        public static bool ComesLate(double first, double last, double silent, double said)
        {
            return last <= said || (first < said - Missed && silent <= said);
        }

        /// <summary>
        /// Return whether a piece of a line counts its times from 0 again: it lies at the beginning of the line, but does not
        /// repeat it.
        /// </summary>
        public static bool Restarts(LineTiming old, LineTiming new_, double said)
        {
            bool again = default(bool);
            if (old.Words.Count > 0 && new_.Words.Count > 0)
            {
                var same = 0;
                while (same < Math.Min(old.Words.Count, new_.Words.Count) && Alike(old.Words[same], new_.Words[same]))
                {
                    same += 1;
                }
                again = same > 0 && new_.Words.Count >= old.Words.Count;
                return same < new_.Words.Count && !again && new_.Words[0].Start < End(old.Words[0]);
            }
            if (old.Marks.Count > 0 && new_.Marks.Count > 0)
            {
                again = PlainLists.Pairs(old.Marks, new_.Marks).All(pair => pair.Item1.Viseme == pair.Item2.Viseme
                    && Math.Abs(pair.Item1.At - pair.Item2.At) < Slack);
                var first = new_.Marks[0].At;
                return !again && first < old.Marks[0].At + Slack && first < said;
            }
            return false;
        }

        private static bool Alike(SpokenWord one, SpokenWord other)
        {
            return one.Text == other.Text && Math.Abs(one.Start - other.Start) < Slack;
        }

        private static double End(SpokenWord word)
        {
            return word.End == null ? word.Start : word.End.Value;
        }

        /// <summary>Return when the last word or shape ends.</summary>
        private static double EndOf(LineTiming timing)
        {
            var end = PlainNumbers.MaxOf(
                new List<double> { 0.0 }.Concat(timing.Words.Select(word => End(word)).ToList()).ToList()
            );
            if (timing.Marks.Count > 0)
            {
                var mark = timing.Marks[timing.Marks.Count - 1];
                end = Math.Max(end, mark.At + (mark.Viseme == "sil" ? 0.0 : Shape));
            }
            return end;
        }

        /// <summary>
        /// Return a line's timing with a later piece: the old timing stays up to `said` seconds, and up to the beginning of the
        /// new piece. Of a word or shape that has begun meanwhile, the rest is said.
        /// </summary>
        public static LineTiming Extended(LineTiming old, LineTiming new_, double said)
        {
            var words = old.Words.ToList();
            var begun = PlainNumbers.MaxOf(
                new List<double> { -1.0 }.Concat(old.Words.Where(word => word.Start < said).Select(word => word.Start).ToList()).ToList()
            );
            var coming = new_.Words.Where(word => word.Start >= said
                || (word.Start > begun && (word.End == null ? word.Start : word.End.Value) > said)).ToList();
            double until = default(double);
            if (coming.Count > 0)
            {
                until = Math.Max(said, new_.Words[0].Start);
                var first = Math.Max(coming[0].Start, said);
                words = old.Words.Where(word => word.Start < until).Select(word => new SpokenWord(
                    word.Text,
                    word.Start,
                    Math.Min(word.End == null ? first : word.End.Value, first)
                )).ToList();
                words.AddRange(coming.Select(word => new SpokenWord(word.Text, Math.Max(word.Start, said), word.End)).ToList());
            }
            var marks = old.Marks.ToList();
            var now = PlainNumbers.MaxOf(
                new List<double> { -1.0 }.Concat(new_.Marks.Where(mark => mark.At < said).Select(mark => mark.At).ToList()).ToList()
            );
            var over = PlainNumbers.MaxOf(
                new List<double> { -1.0 }.Concat(old.Marks.Where(mark => mark.At < said).Select(mark => mark.At).ToList()).ToList()
            );
            var shown = new_.Marks.Where(mark => mark.At >= said
                || (mark.At == now && now >= over && !Told(old.Marks, mark))).Select(mark => new VisemeMark(
                Math.Max(mark.At, said),
                mark.Viseme,
                mark.Weight
            )).ToList();
            if (shown.Count > 0)
            {
                until = Math.Max(said, new_.Marks[0].At);
                marks = old.Marks.Where(mark => mark.At < until).ToList();
                marks.AddRange(shown);
            }
            return new LineTiming(words.ToList(), marks.ToList(), new_.Later);
        }

        private static bool Told(List<VisemeMark> marks, VisemeMark mark)
        {
            return marks.Any(m => m.At == mark.At && m.Viseme == mark.Viseme);
        }
    }
}
