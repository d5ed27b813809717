// Translated from metagraph/playback/life/track.py; change that, and translate anew.
using System;
using System.Collections.Generic;
using System.Linq;

namespace Metagraph
{
    /// <summary>All lasting requests, each kind sorted by start. Speeches do not overlap.</summary>
    public sealed class Track
    {
        public readonly List<LookAt> Looks;
        public readonly List<Speech> Speeches;
        public readonly List<ModeFrom> Modes;
        public readonly List<PlaceFrom> Places;
        public readonly List<BlinkAt> Blinks;
        public readonly List<StayFrom> Stays;
        public readonly List<MoodFrom> Moods;

        public Track(
            List<LookAt> looks = null,
            List<Speech> speeches = null,
            List<ModeFrom> modes = null,
            List<PlaceFrom> places = null,
            List<BlinkAt> blinks = null,
            List<StayFrom> stays = null,
            List<MoodFrom> moods = null
        )
        {
            Looks = looks ?? new List<LookAt>();
            Speeches = speeches ?? new List<Speech>();
            Modes = modes ?? new List<ModeFrom>();
            Places = places ?? new List<PlaceFrom>();
            Blinks = blinks ?? new List<BlinkAt>();
            Stays = stays ?? new List<StayFrom>();
            Moods = moods ?? new List<MoodFrom>();
        }

        /// <summary>Return the ids of all items.</summary>
        public List<string> Idents()
        {
            var out_ = Looks.Select(x => x.Id).ToList();
            out_.AddRange(Speeches.Select(x => x.Id).ToList());
            out_.AddRange(Modes.Select(x => x.Id).ToList());
            out_.AddRange(Places.Select(x => x.Id).ToList());
            out_.AddRange(Blinks.Select(x => x.Id).ToList());
            out_.AddRange(Stays.Select(x => x.Id).ToList());
            out_.AddRange(Moods.Select(x => x.Id).ToList());
            return out_;
        }

        /// <summary>Return whether the models may not change a layer's stance at a time.</summary>
        public bool StaysAt(string layer, double seconds)
        {
            var last = Stays.AsEnumerable().Reverse().ToList().Where(s => s.Layer == layer
                && s.Start <= seconds).FirstOrDefault();
            return last != null && last.On && seconds < last.End;
        }

        /// <summary>
        /// Return the mode requested at a time, or talking while something is said; None if neither applies.
        /// </summary>
        public string ToldMode(double seconds)
        {
            var asked = PlainLists.Right(Modes.Select(m => m.Start).ToList(), seconds) - 1;
            if (asked >= 0 && Modes[asked].Mode != null)
            {
                return Modes[asked].Mode;
            }
            var said = PlainLists.Right(Speeches.Select(s => s.Start).ToList(), seconds) - 1;
            return (said >= 0 && seconds < Speeches[said].End) ? "talking" : null;
        }

        /// <summary>
        /// Return the track without items of these ids that begin at `now` or later; those that have begun end now, if they can.
        /// </summary>
        public Track Without(HashSet<string> idents, double now = -double.PositiveInfinity)
        {
            if (idents.Count == 0 || !Idents().Any(ident => idents.Contains(ident)))
            {
                return this;
            }
            return new Track(
                Looks.Where(x => !idents.Contains(x.Id) || x.Start < now).Select(x => idents.Contains(x.Id)
                    ? new LookAt(x.Id, x.Start, Math.Min(x.End, now), x.To, x.Amount, x.Strict, x.Priority)
                    : x).ToList(),
                Speeches.Where(x => !idents.Contains(x.Id) || x.Start < now).Select(x => idents.Contains(x.Id)
                    ? ItemsRules.Cut(x, now)
                    : x).ToList(),
                Modes.Where(x => !idents.Contains(x.Id) || x.Start < now).ToList(),
                Places.Where(x => !idents.Contains(x.Id) || x.Start < now).ToList(),
                Blinks.Where(x => !idents.Contains(x.Id) || x.Start < now).ToList(),
                Stays.Where(x => !idents.Contains(x.Id) || x.Start < now).Select(x => idents.Contains(x.Id)
                    ? new StayFrom(x.Id, x.Start, x.Layer, x.On, Math.Min(x.End, now))
                    : x).ToList(),
                Moods.Where(x => !idents.Contains(x.Id) || x.Start < now).Select(x => idents.Contains(x.Id)
                    ? new MoodFrom(x.Id, x.Start, x.Valence, x.Arousal, x.Intensity, Math.Min(x.End, now))
                    : x).ToList()
            );
        }

        /// <summary>Return the track with the items of another one, whose speeches may overlap.</summary>
        public Track Joined(Track more)
        {
            if (more.Idents().Count == 0)
            {
                return this;
            }
            var looks = Looks.ToList();
            foreach (LookAt look in more.Looks)
            {
                PlainLists.Insert(looks, look, 0, x => (x.Start, x.Id));
            }
            var speeches = Speeches.ToList();
            foreach (Speech speech in more.Speeches)
            {
                PlainLists.Insert(speeches, speech, 0, x => (x.Start, x.Id));
            }
            var modes = Modes.ToList();
            foreach (ModeFrom mode in more.Modes)
            {
                PlainLists.Insert(modes, mode, 0, x => (x.Start, x.Id));
            }
            var places = Places.ToList();
            foreach (PlaceFrom place in more.Places)
            {
                PlainLists.Insert(places, place, 0, x => (x.Start, x.Id));
            }
            var blinks = Blinks.ToList();
            foreach (BlinkAt blink in more.Blinks)
            {
                PlainLists.Insert(blinks, blink, 0, x => (x.Start, x.Id));
            }
            var stays = Stays.ToList();
            foreach (StayFrom stay in more.Stays)
            {
                PlainLists.Insert(stays, stay, 0, x => (x.Start, x.Id));
            }
            var moods = Moods.ToList();
            foreach (MoodFrom mood in more.Moods)
            {
                PlainLists.Insert(moods, mood, 0, x => (x.Start, x.Id));
            }
            var said = more.Speeches.Count > 0 ? ItemsRules.Apart(speeches) : speeches;
            return new Track(
                looks.ToList(),
                said.ToList(),
                modes.ToList(),
                places.ToList(),
                blinks.ToList(),
                stays.ToList(),
                moods.ToList()
            );
        }

        /// <summary>Return the track without items that are not needed from `seconds` on.</summary>
        public Track Since(double seconds)
        {
            // Those that no later one has replaced; also what is over: it tells since when what shows has shown.
            var looks = new List<LookAt>();
            foreach (LookAt look in Looks)
            {
                if (look.Start <= seconds)
                {
                    looks = looks.Where(x => x.Priority > look.Priority).ToList();
                }
                looks.Add(look);
            }
            var latest = Speeches.Select(x => (x.Id, x)).ToMap();
            var lasts = new HashSet<string>(latest.Select(entry => (entry.Key, entry.Value)).Where(pair => pair.Item2.More
                || pair.Item2.End > seconds).Select(pair => pair.Item1));
            var mode = Math.Max(0, PlainLists.Right(Modes.Select(m => m.Start).ToList(), seconds) - 1);
            var places = Places.Select((item, n) => (n, item)).Where(pair => pair.Item2.Start <= seconds).Select(pair => (
                pair.Item2.Name,
                pair.Item1
            )).ToMap();
            var stays = Stays.Select((item, n) => (n, item)).Where(pair => pair.Item2.Start <= seconds).Select(pair => (
                pair.Item2.Layer,
                pair.Item1
            )).ToMap();
            return new Track(
                looks.ToList(),
                Speeches.Where(x => x.Start > seconds
                    || x.End > seconds
                    || (x.More && lasts.Contains(x.Id))
                    || (x.Over != null && x.Over.Value > seconds)).ToList(),
                PlainLists.Part(Modes, mode),
                Places.Select((item, n) => (n, item)).Where(pair => pair.Item2.Start > seconds
                    || places[pair.Item2.Name] == pair.Item1).Select(pair => pair.Item2).ToList(),
                Blinks.Where(x => x.Start > seconds).ToList(),
                Stays.Select((item, n) => (n, item)).Where(pair => pair.Item2.Start > seconds
                    || stays[pair.Item2.Layer] == pair.Item1).Select(pair => pair.Item2).ToList(),
                MoodRules.Lasting(Moods, seconds).ToList()
            );
        }

        /// <summary>Return the last speech with an id.</summary>
        public Speech LastSpeech(string ident)
        {
            return Speeches.AsEnumerable().Reverse().ToList().Where(s => s.Id == ident).FirstOrDefault();
        }

        /// <summary>
        /// Return whether everything is the same that random draws depend on. Places and stays are not part of it.
        /// </summary>
        public bool DrawsLike(Track other)
        {
            if (!ItemsRules.AlikeLooks(Looks, other.Looks) || !ItemsRules.AlikeSpeeches(Speeches, other.Speeches))
            {
                return false;
            }
            if (!ItemsRules.AlikeFelt(Moods, other.Moods))
            {
                return false;
            }
            return ItemsRules.AlikeModes(Modes, other.Modes) && ItemsRules.AlikeBlinks(Blinks, other.Blinks);
        }

        /// <summary>Return whether everything is the same.</summary>
        public bool Like(Track other)
        {
            if (!ItemsRules.AlikePlaces(Places, other.Places) || !ItemsRules.AlikeStays(Stays, other.Stays))
            {
                return false;
            }
            return DrawsLike(other);
        }
    }
}
