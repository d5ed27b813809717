// Translated from metagraph/playback/life/items.py; change that, and translate anew.
using System;
using System.Collections.Generic;
using System.Linq;

namespace Metagraph
{
    /// <summary>
    /// Look at a point or a named point from `start` until `end`, or until the next look. strict: without looking away.
    /// </summary>
    public sealed class LookAt
    {
        public readonly string Id;
        public readonly double Start;
        public readonly double End;
        public readonly Spot To;
        public readonly double Amount;
        public readonly bool Strict;
        public readonly int Priority;

        public LookAt(string id, double start, double end, Spot to, double amount = 1.0, bool strict = false, int priority = 1)
        {
            Id = id;
            Start = start;
            End = end;
            To = to;
            Amount = amount;
            Strict = strict;
            Priority = priority;
        }
    }

    /// <summary>
    /// Something said. line: id of the project's line, None for `text` alone. priority: a higher one interrupts a lower one.
    /// length: seconds that all of it would have taken, if it was cut short. timing: the times of its words and mouth shapes, if
    /// known. skip: seconds of it that were said before a pause. more: whether more of it may come, so that it is not over when
    /// it falls silent. over: when it was finished, if it had fallen silent before. asked: when the first piece of its utterance
    /// was asked for, which all its pieces share and no other utterance of its id has.
    /// </summary>
    public sealed class Speech
    {
        public readonly string Id;
        public readonly double Start;
        public readonly double End;
        public readonly string Line;
        public readonly string Text;
        public readonly int Priority;
        public readonly double? Length;
        public readonly LineTiming Timing;
        public readonly double Skip;
        public readonly bool More;
        public readonly double? Over;
        public readonly double Asked;

        public Speech(
            string id,
            double start,
            double end,
            string line = null,
            string text = "",
            int priority = 1,
            double? length = null,
            LineTiming timing = null,
            double skip = 0.0,
            bool more = false,
            double? over = null,
            double asked = 0.0
        )
        {
            Id = id;
            Start = start;
            End = end;
            Line = line;
            Text = text;
            Priority = priority;
            Length = length;
            Timing = timing;
            Skip = skip;
            More = more;
            Over = over;
            Asked = asked;
        }
    }

    /// <summary>The mode from `start` on; None for talking while something is said and idling otherwise.</summary>
    public sealed class ModeFrom
    {
        public readonly string Id;
        public readonly double Start;
        public readonly string Mode;

        public ModeFrom(string id, double start, string mode)
        {
            Id = id;
            Start = start;
            Mode = mode;
        }
    }

    /// <summary>Where a named point is from `start` on.</summary>
    public sealed class PlaceFrom
    {
        public readonly string Id;
        public readonly double Start;
        public readonly string Name;
        public readonly List<double> Point;

        public PlaceFrom(string id, double start, string name, List<double> point)
        {
            Id = id;
            Start = start;
            Name = name;
            Point = point;
        }
    }

    /// <summary>A requested blink.</summary>
    public sealed class BlinkAt
    {
        public readonly string Id;
        public readonly double Start;

        public BlinkAt(string id, double start)
        {
            Id = id;
            Start = start;
        }
    }

    /// <summary>
    /// From `start` on, the models change no stance of a layer, or may do so again with `on` false, until `end` or the next item
    /// of this kind.
    /// </summary>
    public sealed class StayFrom
    {
        public readonly string Id;
        public readonly double Start;
        public readonly string Layer;
        public readonly bool On;
        public readonly double End;

        public StayFrom(string id, double start, string layer, bool on = true, double end = double.PositiveInfinity)
        {
            Id = id;
            Start = start;
            Layer = layer;
            On = on;
            End = end;
        }
    }

    public static class ItemsRules
    {
        /// <summary>
        /// Return the second from which the times of a speech count: before its start if it continues after a pause.
        /// </summary>
        public static double FindLineStart(Speech speech)
        {
            return speech.Start - speech.Skip;
        }

        /// <summary>
        /// Return how many seconds all of a speech takes, with the part before a pause and the part that was cut off.
        /// </summary>
        public static double MeasureLine(Speech speech)
        {
            return speech.Length == null ? speech.End - FindLineStart(speech) : speech.Length.Value;
        }

        /// <summary>Return the speech, ending no later than `at`; it remembers its full length.</summary>
        public static Speech Cut(Speech speech, double at)
        {
            return speech.End <= at
                ? speech
                : new Speech(
                    speech.Id,
                    speech.Start,
                    at,
                    speech.Line,
                    speech.Text,
                    speech.Priority,
                    MeasureLine(speech),
                    speech.Timing,
                    speech.Skip,
                    speech.More,
                    speech.Over,
                    speech.Asked
                );
        }

        /// <summary>
        /// Return speeches, given in order, without overlaps: one of equal or higher importance cuts the running one, with its
        /// later pieces; a less important one is dropped.
        /// </summary>
        public static List<Speech> Apart(List<Speech> speeches)
        {
            var out_ = new List<Speech>();
            var ends = new Dictionary<string, double>(); // when what was cut would have ended
            foreach (Speech speech in speeches)
            {
                if (ends.ContainsKey(speech.Id) && speech.Start == ends[speech.Id])
                {
                    ends[speech.Id] = speech.End;
                    continue;
                }
                if (out_.Count > 0 && out_[out_.Count - 1].End > speech.Start)
                {
                    var last = out_[out_.Count - 1];
                    if (speech.Priority < last.Priority)
                    {
                        continue;
                    }
                    out_.RemoveAt(out_.Count - 1);
                    if (last.Id != speech.Id)
                    {
                        ends[last.Id] = last.End;
                    }
                    if (last.Start < speech.Start)
                    {
                        out_.Add(new Speech(
                            Cut(last, speech.Start).Id,
                            Cut(last, speech.Start).Start,
                            Cut(last, speech.Start).End,
                            Cut(last, speech.Start).Line,
                            Cut(last, speech.Start).Text,
                            Cut(last, speech.Start).Priority,
                            Cut(last, speech.Start).Length,
                            Cut(last, speech.Start).Timing,
                            Cut(last, speech.Start).Skip,
                            false,
                            Cut(last, speech.Start).Over,
                            Cut(last, speech.Start).Asked
                        ));
                    }
                }
                out_.Add(speech);
            }
            return out_;
        }

        /// <summary>
        /// Return a text moved to after another one of its id that is being said, also if more of it may come. said: in order.
        /// </summary>
        public static Speech Behind(List<Speech> said, Speech new_, double now)
        {
            if ((new_.Timing != null && !new_.Timing.Paced) || new_.Line != null || new_.Start > now)
            {
                return new_;
            }
            var end = new_.Start;
            foreach (Speech speech in said)
            {
                var paced = speech.Timing == null || speech.Timing.Paced;
                var plain = paced && speech.Line == null && speech.Length == null;
                if (speech.Id == new_.Id && plain && speech.Start <= end && end < speech.End)
                {
                    end = speech.End;
                }
            }
            return end == new_.Start
                ? new_
                : new Speech(
                    new_.Id,
                    end,
                    end + (new_.End - new_.Start),
                    new_.Line,
                    new_.Text,
                    new_.Priority,
                    new_.Length,
                    new_.Timing,
                    new_.Skip,
                    new_.More,
                    new_.Over,
                    new_.Asked
                );
        }

        /// <summary>
        /// Return a line as the continuation of the last one with the same id, if that has begun by `now` or begins with it: it
        /// keeps the start and what has been said. Only lines whose words or shapes have times continue.
        /// </summary>
        public static Speech GoingOn(Speech old, Speech new_, double now)
        {
            if (old == null || old.Timing == null || new_.Timing == null || old.Length != null)
            {
                return new_;
            }
            if (new_.Timing.Paced)
            {
                return old.End <= now ? new_ : BehindWords(old, old.Timing, new_, new_.Timing, now);
            }
            if (Math.Max(old.Start, new_.Start) > now && old.Start != new_.Start)
            {
                return new_;
            }
            var said = Math.Max(now - FindLineStart(old), old.Skip);
            if (old.End <= now && !LineTimingRules.TellsOn(old.Timing, LineTimingRules.Shifted(new_.Timing, old.Timing.Later)))
            {
                return new_;
            }
            var told = (old.Start > now && old.Skip == 0)
                ? new_.Timing
                : LineTimingRules.PlaceTold(old.Timing, new_.Timing, said);
            var timing = LineTimingRules.Extended(old.Timing, told, said);
            var length = Math.Max(LineTimingRules.TimedSeconds(timing, null), new_.End - new_.Start);
            var more = new_.Text == "" || new_.Text == LineTimingRules.ToldText(new_.Timing);
            return new Speech(
                new_.Id,
                old.Start,
                FindLineStart(old) + length,
                new_.Line,
                more ? LineTimingRules.ToldText(timing) : new_.Text,
                new_.Priority,
                new_.Length,
                timing,
                old.Skip,
                new_.More,
                new_.Over,
                new_.Asked
            );
        }

        /// <summary>Return a text with times estimated from its letters, so that later pieces can be added.</summary>
        public static Speech PaceSpeech(Alphabet alphabet, Speech new_)
        {
            var timing = LineTimingRules.PaceText(alphabet, new_.Text, null);
            var length = LineTimingRules.TimedSeconds(timing, LineTimingRules.MeasureText(alphabet, new_.Text));
            return new Speech(
                new_.Id,
                new_.Start,
                new_.Start + length,
                new_.Line,
                new_.Text,
                new_.Priority,
                new_.Length,
                timing,
                new_.Skip,
                new_.More,
                new_.Over,
                new_.Asked
            );
        }

        /// <summary>Return a line with a text after its known words. told, more: the words of both.</summary>
        private static Speech BehindWords(Speech old, LineTiming told, Speech new_, LineTiming more, double now)
        {
            var begin = FindLineStart(old);
            var at = Math.Max(now - begin, Math.Max(old.Skip, old.End - begin));
            var timing = new LineTiming(
                told.Words.Concat(LineTimingRules.Shifted(more, at).Words).ToList(),
                told.Marks,
                told.Later,
                true
            );
            var length = LineTimingRules.TimedSeconds(timing, at + new_.End - new_.Start);
            return new Speech(
                new_.Id,
                old.Start,
                begin + length,
                new_.Line,
                old.Text + new_.Text,
                new_.Priority,
                new_.Length,
                timing,
                old.Skip,
                new_.More,
                new_.Over,
                new_.Asked
            );
        }

        /// <summary>Return whether the looks of two tracks are the same. The functions below compare other items.</summary>
        public static bool AlikeLooks(List<LookAt> one, List<LookAt> other)
        {
            return one.Count == other.Count
                && PlainLists.Pairs(one, other).All(pair => pair.Item1 == pair.Item2 || SameLook(pair.Item1, pair.Item2));
        }

        private static bool SameLook(LookAt a, LookAt b)
        {
            if (!SpotsRules.IsSameSpot(a.To, b.To) || a.Amount != b.Amount || a.Strict != b.Strict)
            {
                return false;
            }
            return a.Id == b.Id && a.Start == b.Start && a.End == b.End && a.Priority == b.Priority;
        }

        public static bool AlikeSpeeches(List<Speech> one, List<Speech> other)
        {
            return one.Count == other.Count
                && PlainLists.Pairs(one, other).All(pair => pair.Item1 == pair.Item2 || SameSpeech(pair.Item1, pair.Item2));
        }

        private static bool SameSpeech(Speech a, Speech b)
        {
            if (a.Line != b.Line || a.Text != b.Text || a.Length != b.Length || a.Priority != b.Priority)
            {
                return false;
            }
            if (a.Skip != b.Skip || a.More != b.More || a.Over != b.Over || a.Asked != b.Asked)
            {
                return false;
            }
            return a.Id == b.Id && a.Start == b.Start && a.End == b.End && LineTimingRules.AlikeTimings(a.Timing, b.Timing);
        }

        public static bool AlikeModes(List<ModeFrom> one, List<ModeFrom> other)
        {
            return one.Count == other.Count
                && PlainLists.Pairs(one, other).All(pair => pair.Item1 == pair.Item2
                    || (pair.Item1.Id == pair.Item2.Id
                        && pair.Item1.Start == pair.Item2.Start
                        && pair.Item1.Mode == pair.Item2.Mode));
        }

        public static bool AlikePlaces(List<PlaceFrom> one, List<PlaceFrom> other)
        {
            return one.Count == other.Count
                && PlainLists.Pairs(one, other).All(pair => pair.Item1 == pair.Item2 || SamePlace(pair.Item1, pair.Item2));
        }

        private static bool SamePlace(PlaceFrom a, PlaceFrom b)
        {
            if (a.Id != b.Id || a.Start != b.Start || a.Name != b.Name)
            {
                return false;
            }
            return PlainLists.Pairs(a.Point, b.Point).All(pair => pair.Item1 == pair.Item2);
        }

        public static bool AlikeBlinks(List<BlinkAt> one, List<BlinkAt> other)
        {
            return one.Count == other.Count
                && PlainLists.Pairs(one, other).All(pair => pair.Item1 == pair.Item2
                    || (pair.Item1.Id == pair.Item2.Id && pair.Item1.Start == pair.Item2.Start));
        }

        public static bool AlikeStays(List<StayFrom> one, List<StayFrom> other)
        {
            return one.Count == other.Count
                && PlainLists.Pairs(one, other).All(pair => pair.Item1 == pair.Item2 || SameStay(pair.Item1, pair.Item2));
        }

        private static bool SameStay(StayFrom a, StayFrom b)
        {
            if (a.Layer != b.Layer || a.On != b.On || a.End != b.End)
            {
                return false;
            }
            return a.Id == b.Id && a.Start == b.Start;
        }

        public static bool AlikeFelt(List<MoodFrom> one, List<MoodFrom> other)
        {
            return one.Count == other.Count
                && PlainLists.Pairs(one, other).All(pair => pair.Item1 == pair.Item2 || SameFelt(pair.Item1, pair.Item2));
        }

        private static bool SameFelt(MoodFrom a, MoodFrom b)
        {
            if (a.Valence != b.Valence || a.Arousal != b.Arousal || a.Intensity != b.Intensity)
            {
                return false;
            }
            return a.Id == b.Id && a.Start == b.Start && a.End == b.End;
        }
    }
}
