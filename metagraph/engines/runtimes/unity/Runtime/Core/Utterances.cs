// Translated from metagraph/playback/life/utterances.py; change that, and translate anew.
using System;
using System.Collections.Generic;
using System.Linq;

namespace Metagraph
{
    /// <summary>
    /// Break off, pause, resume and finish utterances. An utterance is everything that is said under one id, piece by piece,
    /// until it is over. Times are seconds.
    ///
    /// A paused utterance is moved to a time that never comes (`PAUSED`), each to a slot of its own.
    /// </summary>
    public static class UtterancesRules
    {
        public const double Paused = 1000000000.0; // seconds from which on lies what is paused
        public const double Voice = 0.04; // seconds in which a voice can begin; more than lips look ahead
        public const double Earlier = 0.03; // seconds by which it can stop sooner, since a mouth takes its time to close
        // seconds of silence after which nothing more is awaited of what was promised to go on
        public const double Forgotten = 60.0;
        public const double Together = 0.001; // seconds between two pieces of one utterance, at most

        /// <summary>
        /// Return when a voice can begin: sooner than gestures, which blend. At the very beginning it can begin at once, because
        /// nothing has been shown.
        /// </summary>
        public static double FindSoon(double now, double lookahead)
        {
            return now > 0 ? now + Math.Min(lookahead, Voice) : 0.0;
        }

        /// <summary>Return whether an item with this start is paused.</summary>
        public static bool IsPaused(double start)
        {
            return start >= Paused;
        }

        /// <summary>
        /// Return whether more can be added to a piece that is not being said: more was announced, or it is paused.
        /// </summary>
        public static bool TakesMore(Speech speech)
        {
            return speech.More || speech.Start >= Paused;
        }

        /// <summary>
        /// Return whether an utterance is not over at `now`: it is being said, will be said, is paused, or expects more.
        /// </summary>
        public static bool GoesOn(List<Speech> speeches, string ident, double now)
        {
            var last = speeches.AsEnumerable().Reverse().ToList().Where(s => s.Id == ident).FirstOrDefault();
            return last != null && (last.End > now || last.More);
        }

        /// <summary>Return the ids of the utterances that are not over at `now`; what: of one, "" for all.</summary>
        public static List<string> FindUtterances(Track track, string what, double now)
        {
            if (what != "")
            {
                return GoesOn(track.Speeches, what, now) ? new List<string> { what } : new List<string>();
            }
            var last = track.Speeches.Select(s => (s.Id, s)).ToMap();
            var lasting = new HashSet<string>(track.Speeches.Where(s => (s.End > now || s.More)
                && last[s.Id] == s).Select(s => s.Id));
            var out_ = new List<string>();
            foreach (Speech speech in track.Speeches)
            {
                if (lasting.Contains(speech.Id) && !out_.Contains(speech.Id))
                {
                    out_.Add(speech.Id);
                }
            }
            return out_;
        }

        /// <summary>
        /// Return the ids of the utterances of which more was promised, and nothing has come for `FORGOTTEN`.
        /// </summary>
        public static List<string> FindForgotten(Track track, double now)
        {
            var silent = track.Speeches.Where(s => s.More && s.End < now - Forgotten).ToList();
            return silent.Where(s => track.LastSpeech(s.Id) == s).Select(s => s.Id).ToList();
        }

        /// <summary>
        /// Return when the voice of an utterance stops: at the end of the current sound, at `soon` at the latest; at once if its
        /// sounds are unknown or it is in a pause; at its start if it has not begun. now: when gestures can stop.
        /// </summary>
        public static double FindStop(Alphabet alphabet, Track track, string ident, double soon, double now)
        {
            var first = now > soon ? soon - Earlier : soon;
            var running = track.Speeches.Where(s => s.Id == ident && s.Start < first && first < s.End).FirstOrDefault();
            if (running == null)
            {
                var coming = track.Speeches.Where(s => s.Id == ident && s.Start >= first).Select(s => s.Start).ToList();
                return coming.Count > 0 ? PlainNumbers.MinOf(coming.Concat(new List<double> { Paused }).ToList()) : soon;
            }
            if (running.Line != null && running.Timing == null)
            {
                return first;
            }
            var begin = ItemsRules.FindLineStart(running);
            var said = running.Timing == null
                ? GraphemesRules.Spelled(alphabet, running.Text, ItemsRules.MeasureLine(running))
                : LineTimingRules.TimedSounds(alphabet, running.Timing);
            var ends = said.Pieces.Where(p => begin + p.Start < first && first < begin + p.End).Select(p => begin
                + p.End).ToList();
            return ends.Count > 0
                ? PlainNumbers.MinOf(new List<double> { soon }.Concat(new List<double> { running.End }).Concat(ends).ToList())
                : first;
        }

        /// <summary>Return a free slot among the times that never come.</summary>
        public static double FindSlot(Track track)
        {
            return PlainNumbers.MaxOf(
                new List<double> { Paused }.Concat(track.Speeches.Where(s => s.Start >= Paused).Select(s => s.End
                    + 1.0).ToList()).ToList()
            );
        }

        /// <summary>Return the track with an utterance ended at `stop`: its later pieces are not said.</summary>
        public static Track BreakOff(Track track, string ident, double stop)
        {
            var last = track.LastSpeech(ident);
            var speeches = new List<Speech>();
            foreach (Speech speech in track.Speeches)
            {
                if (speech.Id != ident || speech.End <= stop)
                {
                    speeches.Add(speech);
                }
                else if (speech.Start < stop)
                {
                    speeches.Add(ItemsRules.Cut(speech, stop));
                }
            }
            return last == null ? track : Closed(track, speeches, last, stop, true);
        }

        /// <summary>Return the track with an utterance that is over once all its known pieces are said.</summary>
        public static Track FinishSpeech(Track track, string ident, double soon)
        {
            var last = track.LastSpeech(ident);
            return last == null ? track : Closed(track, track.Speeches.ToList(), last, soon, false);
        }

        /// <summary>
        /// Return the track with these speeches, in which an utterance expects no more pieces. of: its last piece before. cuts:
        /// whether it was broken off.
        /// </summary>
        private static Track Closed(Track track, List<Speech> speeches, Speech of, double now, bool cuts)
        {
            var out_ = speeches.ToList();
            var end = now;
            foreach (int n in PlainNumbers.Range(out_.Count).AsEnumerable().Reverse().ToList())
            {
                var last = out_[n];
                if (last.Id != of.Id || last.Asked != of.Asked)
                {
                    continue;
                }
                var held = cuts && last.Length != null; // it was paused
                var silent = last.End < now && (last.More || held);
                var length = (cuts && last.More) ? ItemsRules.MeasureLine(last) : last.Length;
                out_[n] = new Speech(
                    last.Id,
                    last.Start,
                    last.End,
                    last.Line,
                    last.Text,
                    last.Priority,
                    length,
                    last.Timing,
                    last.Skip,
                    false,
                    silent ? now : last.Over,
                    last.Asked
                );
                end = Math.Max(last.End, now);
                break;
            }
            var moods = track.Moods.Select(m => (m.Id == of.Id && m.End == Paused) ? Until(m, end) : m).ToList();
            return new Track(track.Looks, out_.ToList(), track.Modes, track.Places, track.Blinks, track.Stays, moods.ToList());
        }

        private static MoodFrom Until(MoodFrom mood, double end)
        {
            return new MoodFrom(mood.Id, mood.Start, mood.Valence, mood.Arousal, mood.Intensity, end);
        }

        /// <summary>
        /// Return the track with an utterance paused from `stop` on, in `slot` (`find_slot`). made: ids of requests that belong
        /// to it; they wait, too, if they have not begun.
        /// </summary>
        public static Track Pause(Track track, string ident, HashSet<string> made, double stop, double slot)
        {
            var by = slot - stop;
            var kept = new List<Speech>();
            var held = new List<Speech>();
            foreach (Speech speech in track.Speeches)
            {
                if (speech.Id != ident || speech.Start >= Paused || speech.End <= stop)
                {
                    kept.Add(speech);
                }
                else if (speech.Start < stop)
                {
                    kept.Add(new Speech(
                        ItemsRules.Cut(speech, stop).Id,
                        ItemsRules.Cut(speech, stop).Start,
                        ItemsRules.Cut(speech, stop).End,
                        ItemsRules.Cut(speech, stop).Line,
                        ItemsRules.Cut(speech, stop).Text,
                        ItemsRules.Cut(speech, stop).Priority,
                        ItemsRules.Cut(speech, stop).Length,
                        ItemsRules.Cut(speech, stop).Timing,
                        ItemsRules.Cut(speech, stop).Skip,
                        false,
                        ItemsRules.Cut(speech, stop).Over,
                        ItemsRules.Cut(speech, stop).Asked
                    ));
                    var skip = stop - ItemsRules.FindLineStart(speech);
                    held.Add(new Speech(
                        speech.Id,
                        slot,
                        speech.End + by,
                        speech.Line,
                        speech.Text,
                        speech.Priority,
                        speech.Length,
                        speech.Timing,
                        skip,
                        speech.More,
                        speech.Over,
                        speech.Asked
                    ));
                }
                else
                {
                    held.Add(new Speech(
                        speech.Id,
                        speech.Start + by,
                        speech.End + by,
                        speech.Line,
                        speech.Text,
                        speech.Priority,
                        speech.Length,
                        speech.Timing,
                        speech.Skip,
                        speech.More,
                        speech.Over,
                        speech.Asked
                    ));
                }
            }
            var last = track.LastSpeech(ident);
            if (held.Count == 0 && last != null && last.More && last.Start < Paused)
            {
                held.Add(new Speech(ident, slot, slot, null, "", last.Priority, null, null, 0.0, true, null, last.Asked));
            }
            if (held.Count == 0)
            {
                return track;
            }
            var moods = track.Moods.Select(m => (m.Id == ident && m.Start < stop && m.End > stop)
                ? Until(m, Paused)
                : m).ToList();
            var left = new Track(
                track.Looks,
                kept.ToList(),
                track.Modes,
                track.Places,
                track.Blinks,
                track.Stays,
                moods.ToList()
            );
            return Moved(left, held, made, stop, Paused, by);
        }

        /// <summary>Return the track with an utterance that continues at `soon`. made: as for `pause`.</summary>
        public static Track Resume(Track track, string ident, HashSet<string> made, double soon)
        {
            var held = track.Speeches.Where(s => s.Id == ident && s.Start >= Paused).ToList();
            if (held.Count == 0)
            {
                return track;
            }
            var by = soon - held[0].Start;
            var kept = track.Speeches.Where(s => s.Id != ident || s.Start < Paused).ToList();
            var on = held.Where(s => s.End > s.Start).Select(s => new Speech(
                s.Id,
                s.Start + by,
                s.End + by,
                s.Line,
                s.Text,
                s.Priority,
                s.Length,
                s.Timing,
                s.Skip,
                s.More,
                s.Over,
                s.Asked
            )).ToList();
            var end = held[held.Count - 1].More ? Paused : held[held.Count - 1].End + by;
            var moods = track.Moods.Select(m => (m.Id == ident && m.End == Paused) ? Until(m, end) : m).ToList();
            var left = new Track(
                track.Looks,
                kept.ToList(),
                track.Modes,
                track.Places,
                track.Blinks,
                track.Stays,
                moods.ToList()
            );
            if (on.Count == 0) // it had fallen silent when it was paused
            {
                left = held[held.Count - 1].More ? left : FinishSpeech(left, ident, soon);
            }
            return Moved(left, on, made, Paused, double.PositiveInfinity, by);
        }

        /// <summary>
        /// Return the track with more speeches, and with the looks and moods of `made` that begin from `low` to before `high`
        /// moved by a number of seconds.
        /// </summary>
        private static Track Moved(Track track, List<Speech> speeches, HashSet<string> made, double low, double high, double by)
        {
            var looks = new List<LookAt>();
            foreach (LookAt x in track.Looks)
            {
                if (made.Contains(x.Id) && low <= x.Start && x.Start < high)
                {
                    looks.Add(new LookAt(x.Id, x.Start + by, x.End + by, x.To, x.Amount, x.Strict, x.Priority));
                }
            }
            var moods = new List<MoodFrom>();
            foreach (MoodFrom m in track.Moods)
            {
                if (made.Contains(m.Id) && low <= m.Start && m.Start < high)
                {
                    moods.Add(new MoodFrom(m.Id, m.Start + by, m.Valence, m.Arousal, m.Intensity, m.End + by));
                }
            }
            var gone = new HashSet<string>(looks.Select(x => x.Id));
            var over = new HashSet<string>(moods.Select(m => m.Id));
            var left = new Track(
                track.Looks.Where(x => !gone.Contains(x.Id) || x.Start < low || x.Start >= high).ToList(),
                track.Speeches,
                track.Modes,
                track.Places,
                track.Blinks,
                track.Stays,
                track.Moods.Where(m => !over.Contains(m.Id) || m.Start < low || m.Start >= high).ToList()
            );
            return left.Joined(
                new Track(
                    looks.ToList(),
                    speeches.ToList(),
                    new List<ModeFrom>(),
                    new List<PlaceFrom>(),
                    new List<BlinkAt>(),
                    new List<StayFrom>(),
                    moods.ToList()
                )
            );
        }

        /// <summary>
        /// Return why an utterance is over at the end of a piece: "finished", "interrupted" or "replaced"; "" if it is not over
        /// there.
        /// </summary>
        public static string ExplainEnd(List<Speech> speeches, Speech speech)
        {
            var coming = speeches.Where(s => s.Id == speech.Id && s.Start > speech.Start).FirstOrDefault();
            if (coming != null && coming.Asked == speech.Asked)
            {
                return "";
            }
            if (speech.More)
            {
                return coming == null ? "" : "replaced";
            }
            if (speech.Length == null)
            {
                return "finished";
            }
            return (coming == null || coming.Start > speech.End + Together) ? "interrupted" : "replaced";
        }
    }
}
