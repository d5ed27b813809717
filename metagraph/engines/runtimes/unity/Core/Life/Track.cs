using System;
using System.Collections.Generic;
using System.Linq;

namespace Metagraph
{
    /// <summary>Where to look: a name ("user", "ahead", a named point), or a point, metres in the character's space.</summary>
    public sealed class Spot
    {
        public readonly string Name;
        public readonly double[] Point;

        public Spot(string name)
        {
            Name = name;
        }

        public Spot(double[] point)
        {
            Point = point;
        }

        public bool Same(Spot other)
        {
            return Name == other.Name && (Point == null) == (other.Point == null) && (Point == null || Point.SequenceEqual(other.Point));
        }
    }

    /// <summary>Something that was asked for and lasts. End: its start where it has none.</summary>
    public abstract class Item
    {
        public readonly string Id;
        public readonly double Start, End;

        protected Item(string id, double start, double end)
        {
            Id = id;
            Start = start;
            End = end;
        }

        /// <summary>What answers call it.</summary>
        public abstract string Word { get; }

        public virtual bool Same(Item other)
        {
            return Id == other.Id && Start == other.Start && End == other.End;
        }

        /// <summary>The item as it is when it is taken back while it lasts.</summary>
        public virtual Item Ended(double now)
        {
            return this;
        }
    }

    /// <summary>Look somewhere until End, or until the next look. Strict: without averting.</summary>
    public sealed class LookAt : Item
    {
        public readonly Spot To;
        public readonly double Amount;
        public readonly bool Strict;
        public readonly int Priority;

        public LookAt(string id, double start, double end, Spot to, double amount, bool strict, int priority) : base(id, start, end)
        {
            To = to;
            Amount = amount;
            Strict = strict;
            Priority = priority;
        }

        public override string Word
        {
            get { return "look"; }
        }

        public override bool Same(Item other)
        {
            var look = (LookAt)other;
            return base.Same(other) && To.Same(look.To) && Amount == look.Amount && Strict == look.Strict && Priority == look.Priority;
        }

        public override Item Ended(double now)
        {
            return new LookAt(Id, Start, Math.Min(End, now), To, Amount, Strict, Priority);
        }
    }

    /// <summary>
    /// Something said: a line, or text alone. Length: seconds it would have taken, where something cut it short. Timing: when its
    /// words and mouth shapes come, null where that was not told.
    /// </summary>
    public sealed class Speech : Item
    {
        public readonly Line Line;
        public readonly string LineId, Text;
        public readonly int Priority;
        public readonly double? Length;
        public readonly LineTiming Timing;
        private Voice voice;

        public Speech(
            string id, double start, double end, Line line, string lineId, string text, int priority, double? length, LineTiming timing = null)
            : base(id, start, end)
        {
            Timing = timing;
            Line = line;
            LineId = lineId;
            Text = text;
            Priority = priority;
            Length = length;
        }

        public override string Word
        {
            get { return "speech"; }
        }

        /// <summary>As its words and shapes were told, its line's voice as exported, else one guessed from its text.</summary>
        public Voice Voice
        {
            get
            {
                if (voice == null)
                {
                    bool known = Line != null && Line.Voice != null;
                    double length = Math.Max(0.0, Length ?? End - Start);
                    voice = Timing != null ? Voice.FromTiming(Timing, length) : known ? Line.Voice : Voice.FromText(Text, length);
                }
                return voice;
            }
        }

        public override bool Same(Item other)
        {
            var speech = (Speech)other;
            return base.Same(other) && LineId == speech.LineId && Text == speech.Text && Priority == speech.Priority
                && Length == speech.Length && SameTiming(Timing, speech.Timing);
        }

        private static bool SameTiming(LineTiming a, LineTiming b)
        {
            if (a == null || b == null)
            {
                return a == b;
            }
            return a.Words.Count == b.Words.Count && a.Marks.Count == b.Marks.Count
                && !a.Words.Where((w, n) => w.Text != b.Words[n].Text || w.Start != b.Words[n].Start || w.End != b.Words[n].End).Any()
                && !a.Marks.Where((m, n) => m.At != b.Marks[n].At || m.Viseme != b.Marks[n].Viseme || m.Weight != b.Marks[n].Weight).Any();
        }

        /// <summary>
        /// The speech as it goes on where a line of the same id has begun by `now`, or begins with it: it keeps its start and what has been said of it.
        /// Only lines whose words or shapes were told with their times do.
        /// </summary>
        public Speech GoingOn(Track track, double now)
        {
            Speech old = track.Speeches.FindLast(speech => speech.Id == Id);
            if (old == null || old.Timing == null || Timing == null || old.Length != null)
            {
                return this;
            }
            if (Math.Max(old.Start, Start) > now && old.Start != Start)
            {
                return this;
            }
            LineTiming timing = LineTimingRules.Extended(old.Timing, Timing, Math.Max(now - old.Start, 0.0));
            double length = Math.Max(LineTimingRules.TimedSeconds(timing, null), End - Start);
            string text = Text == "" || Text == LineTimingRules.ToldText(Timing) ? LineTimingRules.ToldText(timing) : Text;
            return new Speech(Id, old.Start, old.Start + length, Line, LineId, text, Priority, null, timing);
        }

        /// <summary>The speech, ending no later than `now`; how long it would have been is remembered.</summary>
        public override Item Ended(double now)
        {
            return End <= now ? this : new Speech(Id, Start, now, Line, LineId, Text, Priority, Length ?? End - Start, Timing);
        }
    }

    /// <summary>The mode from Start on; null for talking while something is said and idling otherwise.</summary>
    public sealed class ModeFrom : Item
    {
        public readonly string Mode;

        public ModeFrom(string id, double start, string mode) : base(id, start, start)
        {
            Mode = mode;
        }

        public override string Word
        {
            get { return "mode"; }
        }

        public override bool Same(Item other)
        {
            return base.Same(other) && Mode == ((ModeFrom)other).Mode;
        }
    }

    /// <summary>Where a named point is from Start on.</summary>
    public sealed class PlaceFrom : Item
    {
        public readonly string Name;
        public readonly Spot Point;

        public PlaceFrom(string id, double start, string name, Spot point) : base(id, start, start)
        {
            Name = name;
            Point = point;
        }

        public override string Word
        {
            get { return "place"; }
        }

        public override bool Same(Item other)
        {
            var place = (PlaceFrom)other;
            return base.Same(other) && Name == place.Name && Point.Same(place.Point);
        }
    }

    /// <summary>A blink asked for.</summary>
    public sealed class BlinkAt : Item
    {
        public BlinkAt(string id, double start) : base(id, start, start) { }

        public override string Word
        {
            get { return "blink"; }
        }
    }

    /// <summary>From Start on the models change no stance of a layer (with On false, may again), until End or the next of these.</summary>
    public sealed class StayFrom : Item
    {
        public readonly string Layer;
        public readonly bool On;

        public StayFrom(string id, double start, string layer, bool on, double end = double.PositiveInfinity) : base(id, start, end)
        {
            Layer = layer;
            On = on;
        }

        public override string Word
        {
            get { return "stay"; }
        }

        public override bool Same(Item other)
        {
            var stay = (StayFrom)other;
            return base.Same(other) && Layer == stay.Layer && On == stay.On;
        }

        public override Item Ended(double now)
        {
            return new StayFrom(Id, Start, Layer, On, Math.Min(End, now));
        }
    }

    /// <summary>All that was asked for and lasts, each kind by start. Speeches do not overlap. Never changed.</summary>
    public sealed class Track
    {
        public static readonly Track Empty = new Track(new List<Item>());
        public readonly List<LookAt> Looks;
        public readonly List<Speech> Speeches;
        public readonly List<ModeFrom> Modes;
        public readonly List<PlaceFrom> Places;
        public readonly List<BlinkAt> Blinks;
        public readonly List<StayFrom> Stays;

        /// <summary>A track of items in any order.</summary>
        public Track(IEnumerable<Item> items)
        {
            List<Item> every = items.OrderBy(i => i.Start).ThenBy(i => i.Id, Comparer<string>.Create(Basics.Compare)).ToList();
            Looks = every.OfType<LookAt>().ToList();
            Speeches = Apart(every.OfType<Speech>());
            Modes = every.OfType<ModeFrom>().ToList();
            Places = every.OfType<PlaceFrom>().ToList();
            Blinks = every.OfType<BlinkAt>().ToList();
            Stays = every.OfType<StayFrom>().ToList();
        }

        public IEnumerable<Item> Items
        {
            get { return Looks.Concat<Item>(Speeches).Concat(Modes).Concat(Places).Concat(Blinks).Concat(Stays); }
        }

        /// <summary>Whether the models may not change a layer's stance at a time.</summary>
        public bool StaysAt(string layer, double seconds)
        {
            StayFrom last = Stays.FindLast(s => s.Layer == layer && s.Start <= seconds);
            return last != null && last.On && seconds < last.End;
        }

        /// <summary>The mode asked for at a time, or talking while something is said; null where neither tells.</summary>
        public string ToldMode(double seconds)
        {
            int asked = Basics.BisectRight(Modes, seconds, m => m.Start) - 1;
            if (asked >= 0 && Modes[asked].Mode != null)
            {
                return Modes[asked].Mode;
            }
            int said = Basics.BisectRight(Speeches, seconds, s => s.Start) - 1;
            return said >= 0 && seconds < Speeches[said].End ? "talking" : null;
        }

        /// <summary>The track without items of these ids that begin at `now` or later; what has begun ends now, if it can.</summary>
        public Track Without(HashSet<string> ids, double now)
        {
            if (!Items.Any(item => ids.Contains(item.Id)))
            {
                return this;
            }
            IEnumerable<Item> kept = Items.Where(item => !ids.Contains(item.Id) || item.Start < now);
            return new Track(kept.Select(item => ids.Contains(item.Id) ? item.Ended(now) : item));
        }

        /// <summary>The track with more items; of speeches that overlap the later or more important cuts the other short.</summary>
        public Track Plus(List<Item> items)
        {
            return items.Count == 0 ? this : new Track(Items.Concat(items));
        }

        /// <summary>The track without what no time from `seconds` on needs.</summary>
        public Track Since(double seconds)
        {
            var old = new HashSet<Item>();
            old.UnionWith(Places.Where(p => p.Start <= seconds).GroupBy(p => p.Name).Select(group => group.Last()));
            old.UnionWith(Stays.Where(s => s.Start <= seconds).GroupBy(s => s.Layer).Select(group => group.Last()));
            old.Add(Modes.LastOrDefault(x => x.Start <= seconds));
            var looks = new List<LookAt>(); // that no later one has replaced; what is over tells since when what shows has shown
            foreach (LookAt look in Looks.Where(x => x.Start <= seconds))
            {
                looks.RemoveAll(x => x.Priority <= look.Priority);
                looks.Add(look);
            }
            old.UnionWith(looks);
            return new Track(Items.Where(i => i.Start > seconds || old.Contains(i) || (i is Speech && i.End > seconds)));
        }

        public bool Same(Track other)
        {
            return SameDraws(other) && Same(Places, other.Places) && Same(Stays, other.Stays);
        }

        /// <summary>Whether all that chance depends on is the same: what stays and where things are does not matter.</summary>
        public bool SameDraws(Track other)
        {
            return Same(Looks, other.Looks) && Same(Speeches, other.Speeches) && Same(Modes, other.Modes) && Same(Blinks, other.Blinks);
        }

        private static bool Same<T>(List<T> a, List<T> b) where T : Item
        {
            return a.Count == b.Count && !a.Where((item, n) => !ReferenceEquals(item, b[n]) && !item.Same(b[n])).Any();
        }

        /// <summary>Speeches without overlaps: one at least as important cuts the running one, a lesser one is not said.</summary>
        private static List<Speech> Apart(IEnumerable<Speech> speeches)
        {
            var found = new List<Speech>();
            foreach (Speech speech in speeches)
            {
                Speech last = found.Count > 0 ? found[found.Count - 1] : null;
                if (last != null && last.End > speech.Start)
                {
                    if (speech.Priority < last.Priority)
                    {
                        continue;
                    }
                    found.RemoveAt(found.Count - 1);
                    if (last.Start < speech.Start)
                    {
                        found.Add((Speech)last.Ended(speech.Start));
                    }
                }
                found.Add(speech);
            }
            return found;
        }
    }
}
