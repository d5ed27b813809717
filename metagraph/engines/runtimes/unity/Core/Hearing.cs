// Translated from metagraph/playback/planning/hearing.py; change that, and translate anew.
using System;
using System.Collections.Generic;
using System.Linq;

namespace Metagraph
{
    /// <summary>
    /// track: what lasts. withdrawn: ids of what was asked for before and is not any more; stopped: those of them that were taken
    /// back and not asked for anew. touched: layers that asks have to do with.
    /// </summary>
    public sealed class Heard
    {
        public readonly Track Track;
        public readonly HashSet<string> Withdrawn;
        public readonly HashSet<string> Stopped;
        public readonly HashSet<string> Touched;

        public Heard(Track track, HashSet<string> withdrawn, HashSet<string> stopped, HashSet<string> touched)
        {
            Track = track;
            Withdrawn = withdrawn;
            Stopped = stopped;
            Touched = touched;
        }
    }

    public static class HearingRules
    {
        /// <summary>
        /// Return the asks a request may have been made by: that of its own id, and those of which it would be a part.
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
        /// Return what a request goes with when it is taken back: its `owners`, and what is said that a gesture was made for:
        /// "answer" for "answer/2".
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
        /// Return what asks do. requests, track: of the plan. fresh, more: what is asked for, where speeches may overlap.
        /// withdrawn: ids taken back; every one where it holds "". refused: ids of what could not be understood. now: what begins
        /// before stays. turning: layers whose models perform one thing in one mode and another in another.
        /// </summary>
        public static Heard Heard(
            List<MetaRequest> requests,
            Track track,
            List<MetaRequest> fresh,
            Track more,
            HashSet<string> withdrawn,
            List<string> refused,
            double now,
            List<string> turning
        )
        {
            var gone = new HashSet<string>(withdrawn);
            foreach (string ident in refused)
            {
                gone.Add(ident);
            }
            foreach (MetaRequest request in fresh)
            {
                gone.Add(request.Id);
            }
            foreach (string ident in more.Idents())
            {
                gone.Add(ident);
            }
            var said = new List<Speech>();
            var begun = new HashSet<string>(); // of which more is said
            var anew = new HashSet<string>(); // of which something else was said before
            var later = new Dictionary<string, double>(); // by how much those begin that are said behind others of their id
            foreach (Speech asked in more.Speeches)
            {
                var beforeIt = withdrawn.Contains(asked.Id) ? null : track.LastSpeech(asked.Id);
                var last = said.AsEnumerable().Reverse().ToList().Where(s => s.Id == asked.Id).DefaultIfEmpty(beforeIt).First();
                var one = ItemsRules.GoingOn(last, asked, now);
                if (one != asked && last != null && one.Start == last.Start)
                {
                    begun.Add(one.Id);
                    said = said.Where(s => s.Id != one.Id).ToList();
                }
                else if (one == asked && !withdrawn.Contains(asked.Id))
                {
                    one = ItemsRules.Behind(track.Speeches.Concat(said).ToList(), asked, now);
                    if (one != asked)
                    {
                        later[one.Id] = one.Start - asked.Start;
                    }
                }
                if (one == asked && track.LastSpeech(one.Id) != null)
                {
                    anew.Add(one.Id);
                }
                said.Add(one);
            }
            var before = requests.Select(r => r.Id).ToList();
            before.AddRange(track.Idents());
            // Who takes everything back still looks at whom it talks with.
            var user = new HashSet<string>(track.Looks.Where(x => x.Start < now
                && SpotsRules.IsSameSpot(x.To, SpotsRules.Named("user"))).Select(x => x.Id));
            var taken = new HashSet<string>();
            var stopped = new HashSet<string>();
            foreach (string ident in before)
            {
                var every = withdrawn.Contains("") && !user.Contains(ident);
                if (every || (withdrawn.Count > 0 && Makers(ident).Any(o => withdrawn.Contains(o))))
                {
                    stopped.Add(ident);
                }
                else if (anew.Count > 0 && !anew.Contains(ident) && Makers(ident).Any(o => anew.Contains(o)))
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
            // Where the models may change stances again means nothing where they always might.
            var staying = new HashSet<string>(track.Stays.Where(s => s.On).Select(s => s.Layer));
            foreach (StayFrom stay in more.Stays)
            {
                if (stay.On)
                {
                    staying.Add(stay.Layer);
                }
            }
            var stays = more.Stays.Where(s => staying.Contains(s.Layer)).ToList();
            var touched = new HashSet<string>(fresh.Select(r => r.Layer));
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
                || track.Modes.Any(m => taken.Contains(m.Id))
                || track.Speeches.Any(s => taken.Contains(s.Id));
            if (turns) // who talks moves otherwise than who listens
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
            var over = new HashSet<string>();
            foreach (string ident in taken)
            {
                if (!begun.Contains(ident) && !later.ContainsKey(ident))
                {
                    over.Add(ident);
                }
            }
            var moods = more.Moods.Select(m => later.ContainsKey(m.Id)
                ? new MoodFrom(m.Id, m.Start + later[m.Id], m.Valence, m.Arousal, m.Intensity, m.End + later[m.Id])
                : m).ToList();
            var left = track.Without(over, now).Without(begun);
            var lasting = new Track(
                more.Looks,
                said.ToList(),
                more.Modes,
                more.Places,
                more.Blinks,
                stays.ToList(),
                moods.ToList()
            );
            return new Heard(left.Joined(lasting), taken, stopped, touched);
        }
    }
}
