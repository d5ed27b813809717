// Translated from metagraph/playback/planning/hearing.py; change that, and translate anew.
using System;
using System.Collections.Generic;
using System.Linq;

namespace Metagraph
{
    /// <summary>
    /// track: what lasts. withdrawn: ids of what was asked for before and is not any more. touched: layers that asks have to do
    /// with.
    /// </summary>
    public sealed class Heard
    {
        public readonly Track Track;
        public readonly HashSet<string> Withdrawn;
        public readonly HashSet<string> Touched;

        public Heard(Track track, HashSet<string> withdrawn, HashSet<string> touched)
        {
            Track = track;
            Withdrawn = withdrawn;
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
            var before = requests.Select(r => r.Id).ToList();
            before.AddRange(track.Idents());
            var taken = new HashSet<string>();
            foreach (string ident in before)
            {
                if (withdrawn.Contains("")
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
            var said = more.Speeches.Select(s => ItemsRules.GoingOn(track.LastSpeech(s.Id), s, now)).ToList();
            var begun = new HashSet<string>(); // of which more is said
            foreach (var one in PlainLists.Pairs(said, more.Speeches))
            {
                var new_ = one.Item1;
                var asked = one.Item2;
                if (new_ != asked)
                {
                    begun.Add(new_.Id);
                }
            }
            var over = new HashSet<string>();
            foreach (string ident in taken)
            {
                if (!begun.Contains(ident))
                {
                    over.Add(ident);
                }
            }
            var left = track.Without(over, now).Without(begun);
            var lasting = new Track(more.Looks, said.ToList(), more.Modes, more.Places, more.Blinks, stays.ToList(), more.Moods);
            return new Heard(left.Joined(lasting), taken, touched);
        }
    }
}
