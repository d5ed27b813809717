// Translated from metagraph/playback/planning/hearing.py; change that, and translate anew.
using System;
using System.Collections.Generic;
using System.Linq;

namespace Metagraph
{
    /// <summary>
    /// track: lasting items. fresh: requests of layers, with those that continue after a pause. withdrawn: ids of earlier
    /// requests that no longer hold; stopped: those of them that were taken back, not replaced. touched: layers that the requests
    /// affect.
    /// </summary>
    public sealed class Heard
    {
        public readonly Track Track;
        public readonly List<MetaRequest> Fresh;
        public readonly HashSet<string> Withdrawn;
        public readonly HashSet<string> Stopped;
        public readonly HashSet<string> Touched;

        public Heard(
            Track track,
            List<MetaRequest> fresh,
            HashSet<string> withdrawn,
            HashSet<string> stopped,
            HashSet<string> touched
        )
        {
            Track = track;
            Fresh = fresh;
            Withdrawn = withdrawn;
            Stopped = stopped;
            Touched = touched;
        }
    }

    /// <summary>
    /// New speeches, combined with those that are being said. said: all that are new or changed. begun: ids of changed earlier
    /// ones among them; on: ids of those that continue. `anew`: ids under which something else was said before. moods: the moods
    /// requested with them.
    /// </summary>
    public sealed class AddedSpeeches
    {
        public readonly List<Speech> Said;
        public readonly HashSet<string> Begun;
        public readonly HashSet<string> On;
        public readonly HashSet<string> Anew;
        public readonly List<MoodFrom> Moods;

        public AddedSpeeches(
            List<Speech> said,
            HashSet<string> begun,
            HashSet<string> on,
            HashSet<string> anew,
            List<MoodFrom> moods
        )
        {
            Said = said;
            Begun = begun;
            On = on;
            Anew = anew;
            Moods = moods;
        }

        /// <summary>
        /// Return the part of a track that stays: moods of speeches that continue last as long as these, unless another mood is
        /// requested.
        /// </summary>
        public Track Leave(Track track)
        {
            if (On.Count == 0 && Begun.Count == 0)
            {
                return track;
            }
            var other = new HashSet<string>(Moods.Select(m => m.Id));
            var ends = new Dictionary<string, double>();
            foreach (Speech speech in Said)
            {
                if (On.Contains(speech.Id))
                {
                    ends[speech.Id] = speech.More ? UtterancesRules.Paused : speech.End;
                }
            }
            var speeches = track.Speeches.Where(s => !Begun.Contains(s.Id)).ToList();
            var moods = new List<MoodFrom>();
            foreach (MoodFrom m in track.Moods)
            {
                if (!ends.ContainsKey(m.Id) || other.Contains(m.Id))
                {
                    moods.Add(m);
                }
                else
                {
                    moods.Add(new MoodFrom(m.Id, m.Start, m.Valence, m.Arousal, m.Intensity, ends[m.Id]));
                }
            }
            return new Track(
                track.Looks,
                speeches.ToList(),
                track.Modes,
                track.Places,
                track.Blinks,
                track.Stays,
                moods.ToList()
            );
        }
    }

    /// <summary>
    /// A track and requests while asks steer speech. `anew`: ids of the requests that are made again; the other fields are as in
    /// `Heard`.
    /// </summary>
    public sealed class SteeredSpeech
    {
        public Track Track;
        public HashSet<string> Withdrawn;
        public HashSet<string> Stopped;
        public HashSet<string> Touched;
        public List<MetaRequest> Requests;
        public HashSet<string> Anew;

        public SteeredSpeech(
            Track track,
            HashSet<string> withdrawn,
            HashSet<string> stopped,
            HashSet<string> touched,
            List<MetaRequest> requests = null,
            HashSet<string> anew = null
        )
        {
            Track = track;
            Withdrawn = withdrawn;
            Stopped = stopped;
            Touched = touched;
            Requests = requests ?? new List<MetaRequest>();
            Anew = anew ?? new HashSet<string>();
        }

        /// <summary>Return the ids of everything in it.</summary>
        public List<string> Idents()
        {
            return Requests.Select(r => r.Id).ToList().Concat(Track.Idents()).ToList();
        }

        /// <summary>Break off an utterance at `stop`, and the requests that belong to it at `now`.</summary>
        public void Interrupt(string ident, HashSet<string> made, double stop, double now, double soon)
        {
            if (UtterancesRules.GoesOn(Track.Speeches, ident, soon))
            {
                Track = UtterancesRules.BreakOff(Track, ident, stop);
            }
            if (Track.Moods.Any(m => made.Contains(m.Id)))
            {
                foreach (string layer in WordsRules.Layers)
                {
                    Touched.Add(layer);
                }
            }
            Track = Track.Without(made, now);
            foreach (MetaRequest request in Requests)
            {
                if (made.Contains(request.Id))
                {
                    Withdrawn.Add(request.Id);
                    Stopped.Add(request.Id);
                    Touched.Add(request.Layer);
                }
            }
            Requests = Requests.Where(r => !made.Contains(r.Id)).ToList();
        }

        /// <summary>
        /// Pause an utterance, and the requests that belong to it and whose moment has not come; those that have begun go back.
        /// </summary>
        public void Pause(string ident, HashSet<string> made, double stop, double now)
        {
            if (UtterancesRules.IsPaused(stop))
            {
                return;
            }
            var slot = UtterancesRules.FindSlot(Track);
            Track = UtterancesRules.Pause(Track, ident, made, stop, slot);
            var kept = new List<MetaRequest>();
            foreach (MetaRequest request in Requests)
            {
                if (!made.Contains(request.Id) || UtterancesRules.IsPaused(request.Start))
                {
                    kept.Add(request);
                    continue;
                }
                Withdrawn.Add(request.Id);
                Touched.Add(request.Layer);
                if (request.Start < now)
                {
                    Stopped.Add(request.Id);
                }
                var wanted = request.Stroke == null ? request.Start : request.Stroke.Value;
                if (wanted >= stop)
                {
                    kept.Add(MoveRequest(request, slot - stop, 0.0));
                    Anew.Add(request.Id);
                }
            }
            Requests = kept;
        }

        /// <summary>Resume a paused utterance, and the requests that wait for it.</summary>
        public void Resume(string ident, HashSet<string> made, double now, double soon)
        {
            var held = Track.Speeches.Where(s => s.Id == ident && UtterancesRules.IsPaused(s.Start)).FirstOrDefault();
            if (held == null)
            {
                return;
            }
            Track = UtterancesRules.Resume(Track, ident, made, soon);
            var kept = new List<MetaRequest>();
            foreach (MetaRequest request in Requests)
            {
                if (made.Contains(request.Id) && UtterancesRules.IsPaused(request.Start))
                {
                    Withdrawn.Add(request.Id);
                    Touched.Add(request.Layer);
                    Anew.Add(request.Id);
                    kept.Add(MoveRequest(request, soon - held.Start, now));
                }
                else
                {
                    kept.Add(request);
                }
            }
            Requests = kept;
        }

        /// <summary>Return a request moved by a number of seconds, but not to before `least`.</summary>
        public MetaRequest MoveRequest(MetaRequest request, double by, double least)
        {
            var stroke = request.Stroke == null ? (double?)null : request.Stroke.Value + by;
            return new MetaRequest(
                request.Id,
                request.Layer,
                request.Kind,
                Math.Max(least, request.Start + by),
                request.Duration,
                request.Action,
                request.Tags,
                request.Limb,
                request.Stance,
                request.Priority,
                request.Resume,
                stroke,
                request.Hold,
                request.Prepare,
                request.Among,
                request.Late,
                request.Valence,
                request.Arousal,
                request.Intensity
            );
        }
    }

    public static class HearingRules
    {
        public const double Listens = 2.0; // seconds for which the gaze stays with the partner who interrupts

        /// <summary>
        /// Return the ids of the asks from which a request may come: its own id, and those of which it would be a part.
        /// </summary>
        public static List<string> Owners(string ident)
        {
            var out_ = new List<string> { ident };
            var left = ident;
            while (true)
            {
                string dot = default(string);
                string number = default(string);
                var found = PlainText.PartedLast(left, ".");
                left = found.Item1;
                dot = found.Item2;
                number = found.Item3;
                if (dot == "" || !PlainText.Digits(number))
                {
                    return out_;
                }
                out_.Add(left);
            }
        }

        /// <summary>
        /// Return the ids with which a request is taken back: its `owners`, and the speech that a gesture belongs to: "answer"
        /// for "answer/2".
        /// </summary>
        public static List<string> Makers(string ident)
        {
            var out_ = Owners(ident);
            var found = PlainText.PartedLast(out_[out_.Count - 1], "/");
            string said = found.Item1;
            string slash = found.Item2;
            string number = found.Item3;
            if (slash != "" && PlainText.Digits(number))
            {
                out_.Add(said);
            }
            return out_;
        }

        /// <summary>
        /// Return the effect of asks. requests, track: of the plan. meant: the meaning of the asks; speeches may overlap in it.
        /// present: when they became known. now: everything that begins earlier stays; soon: the same for voices. turning: layers
        /// whose models perform differently in different modes.
        /// </summary>
        public static Heard Heard(
            List<MetaRequest> requests,
            Track track,
            Meaning meant,
            double present,
            double now,
            double soon,
            List<string> turning
        )
        {
            var more = meant.Track();
            var gone = new HashSet<string>(meant.Withdrawn);
            foreach (Report report in meant.Refused)
            {
                gone.Add(report.Request);
            }
            foreach (MetaRequest request in meant.Requests)
            {
                gone.Add(request.Id);
            }
            foreach (string ident in more.Idents())
            {
                gone.Add(ident);
            }
            var words = AddSpeeches(meant, track, present, soon);
            var before = requests.Select(r => r.Id).ToList();
            before.AddRange(track.Idents());
            // A client that takes everything back keeps the look at the user.
            var user = new HashSet<string>(track.Looks.Where(x => x.Start < now
                && SpotsRules.IsSameSpot(x.To, SpotsRules.Named("user"))).Select(x => x.Id));
            var taken = new HashSet<string>();
            var stopped = new HashSet<string>();
            var withdrawn = meant.Withdrawn;
            foreach (string ident in before)
            {
                var every = withdrawn.Contains("") && !user.Contains(ident);
                if (every || (withdrawn.Count > 0 && Makers(ident).Any(o => withdrawn.Contains(o))))
                {
                    stopped.Add(ident);
                }
                else if (words.Anew.Count > 0 && !words.Anew.Contains(ident) && Makers(ident).Any(o => words.Anew.Contains(o)))
                {
                    stopped.Add(ident); // what was made for the words before
                }
                if (stopped.Contains(ident)
                    || gone.Contains(ident)
                    || (ident.Contains(".") && Owners(ident).Any(o => gone.Contains(o))))
                {
                    taken.Add(ident);
                }
            }
            // Leave to change stances again means nothing if the models always may.
            var staying = new HashSet<string>(track.Stays.Where(s => s.On).Select(s => s.Layer));
            foreach (StayFrom stay in more.Stays)
            {
                if (stay.On)
                {
                    staying.Add(stay.Layer);
                }
            }
            var stays = more.Stays.Where(s => staying.Contains(s.Layer)).ToList();
            var touched = new HashSet<string>(meant.Requests.Select(r => r.Layer));
            foreach (MetaRequest request in requests)
            {
                if (taken.Contains(request.Id))
                {
                    touched.Add(request.Layer);
                }
            }
            foreach (StayFrom stay in track.Stays.Concat(stays).ToList())
            {
                if (gone.Contains(stay.Id) || taken.Contains(stay.Id))
                {
                    touched.Add(stay.Layer);
                }
            }
            var turns = more.Modes.Count > 0
                || more.Speeches.Count > 0
                || meant.Steered.Count > 0
                || track.Modes.Any(m => taken.Contains(m.Id))
                || track.Speeches.Any(s => taken.Contains(s.Id));
            if (turns) // talking and listening characters move differently
            {
                foreach (string layer in turning)
                {
                    touched.Add(layer);
                }
            }
            if (more.Moods.Count > 0 || track.Moods.Any(m => taken.Contains(m.Id)))
            {
                foreach (string layer in WordsRules.Layers)
                {
                    touched.Add(layer);
                }
            }
            var left = track;
            foreach (string ident in UtterancesRules.FindUtterances(track, "", soon))
            {
                if (stopped.Contains(ident))
                {
                    left = UtterancesRules.BreakOff(left, ident, now);
                }
            }
            var over = new HashSet<string>();
            foreach (string ident in taken)
            {
                if (!words.On.Contains(ident))
                {
                    over.Add(ident);
                }
            }
            left = words.Leave(left.Without(over, now));
            foreach (string ident in over)
            {
                var open = left.LastSpeech(ident);
                if (open != null && open.More) // something else takes its place
                {
                    left = UtterancesRules.FinishSpeech(left, ident, soon);
                }
            }
            var lasting = new Track(
                more.Looks,
                words.Said.ToList(),
                more.Modes,
                more.Places,
                more.Blinks,
                stays.ToList(),
                words.Moods.ToList()
            );
            var said = new Heard(left.Joined(lasting), meant.Requests, taken, stopped, touched);
            return Steer(requests, said, meant, now, soon);
        }

        /// <summary>
        /// Return the effect of asks to say something on a track: a new line, a line after another, or more of one. present: what
        /// ended by then is over, and its end was reported; more of it begins a new utterance.
        /// </summary>
        public static AddedSpeeches AddSpeeches(Meaning meant, Track track, double present, double soon)
        {
            var said = new List<Speech>();
            var begun = new HashSet<string>();
            var on = new HashSet<string>();
            var anew = new HashSet<string>();
            var later = new Dictionary<string, double>(); // by how much those begin that are said behind others of their id
            foreach (Speech told in meant.Speeches)
            {
                var taken = meant.Withdrawn.Contains(told.Id) || meant.Withdrawn.Contains("");
                var before = taken ? null : track.LastSpeech(told.Id);
                var last = said.AsEnumerable().Reverse().ToList().Where(s => s.Id == told.Id).DefaultIfEmpty(before).First();
                var asked = told;
                var now = soon;
                if (last != null && UtterancesRules.IsPaused(last.Start) && told.Start <= soon && told.Line == null)
                {
                    now = last.Start; // it is said when that is
                    asked = new Speech(
                        told.Id,
                        now,
                        told.End + now - told.Start,
                        told.Line,
                        told.Text,
                        told.Priority,
                        told.Length,
                        told.Timing,
                        told.Skip,
                        told.More,
                        told.Over,
                        told.Asked
                    );
                }
                var paces = told.More || (last != null && last.More);
                if (paces && asked.Timing == null && asked.Line == null)
                {
                    asked = ItemsRules.PaceSpeech(meant.Alphabet, asked);
                }
                var one = ItemsRules.GoingOn(last, asked, now);
                var continues = false;
                if (one != asked && last != null && one.Start == last.Start)
                {
                    continues = true;
                    said = said.Where(s => s.Id != one.Id || s.Start < one.Start).ToList();
                    if (last == before)
                    {
                        begun.Add(one.Id);
                        said.AddRange(track.Speeches.Where(s => s.Id == one.Id && s != last).ToList());
                    }
                }
                else if (one == asked && last != null)
                {
                    var same = track.Speeches.Concat(said).ToList().Where(s => s.Id == last.Id && s.Asked == last.Asked).ToList();
                    one = ItemsRules.Behind(same, asked, now);
                    continues = one != asked || (UtterancesRules.TakesMore(last) && told.Line == null && one.Start <= now);
                }
                var over = last != null && last.End <= present && !UtterancesRules.TakesMore(last);
                var since = FindAsked(track, last, continues && !over, one.Id, soon);
                if (!continues) // it replaces what was asked for at the same time
                {
                    said = said.Where(s => s.Id != one.Id).ToList();
                    begun = Without(begun, one.Id);
                    on = Without(on, one.Id);
                }
                if (before != null && since == before.Asked)
                {
                    on.Add(one.Id);
                }
                if (one.Start != told.Start)
                {
                    later[one.Id] = one.Start - told.Start;
                }
                if (!continues && !on.Contains(one.Id) && track.LastSpeech(one.Id) != null)
                {
                    anew.Add(one.Id);
                }
                said.Add(new Speech(
                    one.Id,
                    one.Start,
                    one.End,
                    one.Line,
                    one.Text,
                    one.Priority,
                    one.Length,
                    one.Timing,
                    one.Skip,
                    one.More,
                    one.Over,
                    since
                ));
            }
            var opened = new HashSet<string>(said.Where(s => s.More).Select(s => s.Id));
            var moods = new List<MoodFrom>();
            foreach (MoodFrom m in meant.Moods)
            {
                var by = (later.ContainsKey(m.Id) && !begun.Contains(m.Id)) ? later[m.Id] : 0.0;
                var end = opened.Contains(m.Id) ? UtterancesRules.Paused : m.End + by;
                moods.Add(new MoodFrom(m.Id, m.Start + by, m.Valence, m.Arousal, m.Intensity, end));
            }
            return new AddedSpeeches(said, begun, on, anew, moods);
        }

        private static HashSet<string> Without(HashSet<string> idents, string ident)
        {
            var left = new HashSet<string>();
            foreach (string other in idents)
            {
                if (other != ident)
                {
                    left.Add(other);
                }
            }
            return left;
        }

        /// <summary>
        /// Return when the utterance of a new piece was asked for. last: the piece before it, None if that is taken back;
        /// continues: whether the new one goes on from it.
        /// </summary>
        public static double FindAsked(Track track, Speech last, bool continues, string ident, double soon)
        {
            if (last != null && continues)
            {
                return last.Asked;
            }
            var known = last == null ? track.LastSpeech(ident) : last;
            return known == null ? soon : Math.Max(soon, known.Asked + UtterancesRules.Together);
        }

        /// <summary>
        /// Return the effect of asks that interrupt, pause, resume or finish speech, in order. requests: of the plan before.
        /// </summary>
        private static Heard Steer(List<MetaRequest> requests, Heard told, Meaning meant, double now, double soon)
        {
            if (meant.Steered.Count == 0)
            {
                return told;
            }
            var steered = new SteeredSpeech(
                told.Track,
                new HashSet<string>(told.Withdrawn),
                new HashSet<string>(told.Stopped),
                new HashSet<string>(told.Touched)
            );
            steered.Requests = requests.Where(r => !told.Withdrawn.Contains(r.Id)).ToList();
            foreach (MetaRequest request in told.Fresh)
            {
                steered.Requests.Add(request);
                steered.Anew.Add(request.Id);
            }
            foreach (SteeringAsk ask in meant.Steered)
            {
                var ids = UtterancesRules.FindUtterances(steered.Track, ask.What, soon);
                if (ask.Do == "interrupt")
                {
                    if (ids.Count > 0)
                    {
                        var look = new LookAt(ask.Id, now, now + Listens, SpotsRules.Named("user"), 1.0, true, ask.Priority);
                        steered.Track = steered.Track.Joined(new Track(new List<LookAt> { look }));
                    }
                    if (ask.What != "" && !ids.Contains(ask.What)) // it may have been said, and its gestures go on
                    {
                        ids.Add(ask.What);
                    }
                }
                foreach (string ident in ids)
                {
                    var made = new HashSet<string>(steered.Idents().Where(x => x.StartsWith(ident, StringComparison.Ordinal)
                        && Makers(x).Contains(ident)));
                    if (ask.Do == "interrupt")
                    {
                        var stop = UtterancesRules.FindStop(meant.Alphabet, steered.Track, ident, soon, now);
                        steered.Interrupt(ident, made, Math.Min(stop, now), now, soon);
                    }
                    else if (ask.Do == "pause")
                    {
                        steered.Pause(
                            ident,
                            made,
                            UtterancesRules.FindStop(meant.Alphabet, steered.Track, ident, soon, now),
                            now
                        );
                    }
                    else if (ask.Do == "resume")
                    {
                        steered.Resume(ident, made, now, soon);
                    }
                    else
                    {
                        steered.Track = UtterancesRules.FinishSpeech(steered.Track, ident, soon);
                    }
                }
            }
            var fresh = steered.Requests.Where(r => steered.Anew.Contains(r.Id)).ToList();
            return new Heard(steered.Track, fresh, steered.Withdrawn, steered.Stopped, steered.Touched);
        }
    }
}
