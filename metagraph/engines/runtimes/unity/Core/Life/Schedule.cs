using System;
using System.Collections.Generic;
using System.Linq;

namespace Metagraph
{
    /// <summary>
    /// Everything that happens of itself from 0 to End seconds. Modes: place among the modes. Breaths: length s, depth.
    /// Aversions: end s, right-to-left and upward part of the offset. Saccades: offset to the left and up, degrees. Blinks: 0 of itself,
    /// 1 on a stressed syllable, 2 asked for. Drawn: seconds up to which the lanes are filled.
    /// </summary>
    public sealed class Schedule
    {
        public static readonly Schedule Empty = new Schedule();
        private const double Recall = 4.0; // seconds of looks kept when the past is forgotten: longer than any turn of the head takes
        public double End, Drawn;
        public Lane Modes = Lane.Empty, Breaths = Lane.Empty, Aversions = Lane.Empty, Saccades = Lane.Empty, Blinks = Lane.Empty;
        public List<Target> Targets = new List<Target>();
        internal Track Track; // what it was drawn from, null for nothing yet
        internal LifeSettings Life;

        internal Schedule Copy()
        {
            return (Schedule)MemberwiseClone();
        }

        /// <summary>The schedule without what ended before `seconds`; what is drawn on from it stays as it would have been.</summary>
        public Schedule Since(double seconds)
        {
            Schedule kept = Copy();
            kept.Breaths = Breaths.Since(seconds, 1);
            kept.Aversions = Aversions.Since(seconds, 1);
            kept.Saccades = Saccades.Since(seconds, 1);
            kept.Blinks = Blinks.Since(seconds, 1);
            // Gaps run in modes' time from the event before, so the modes since then are needed.
            var lanes = new[] { kept.Breaths, kept.Aversions, kept.Saccades, kept.Blinks };
            double[] rates = { 1, 1, 1, 1 };
            if (Life != null)
            {
                rates = new[] { Life.BreathRate, Life.AversionRate, Life.SaccadeRate, Life.Blinks };
            }
            double needed = lanes.Where(lane => lane.Count > 0).Select(lane => lane.Starts[0]).DefaultIfEmpty(seconds).Min();
            needed = lanes.Where((lane, n) => lane.Count == 0 && rates[n] > 0).Any() ? 0.0 : needed;
            int gone = Math.Max(0, Basics.BisectRight(Targets, Math.Min(needed, seconds - Recall), t => t.Start) - 1);
            kept.Modes = Modes.Since(needed, 0);
            kept.Targets = Targets.GetRange(gone, Targets.Count - gone);
            return kept;
        }
    }

    /// <summary>
    /// One extension of a schedule: lanes filled from a cut to a horizon. Each event depends only on the one before it and on what
    /// is asked meanwhile, and its chance on its number; so tick by tick gives what one call gives.
    /// </summary>
    internal sealed class Drawing
    {
        private const double Block = 8.0; // seconds drawn at a time, so that a running plan need not draw at every tick
        private const double AfterBlink = 1.0; // seconds after a blink before a stressed syllable brings another
        private const double BlinkGap = 0.57, BlinkChance = 0.845; // of the mean gap: the shortest, and what chance adds
        private const double Fixation = 0.2, Saccade = 1.2, LargestSaccade = 4.0, Upright = 0.6; // seconds; degrees; of that, up and down
        private const double AversionGap = 0.6, AversionChance = 0.8, BetweenAversions = 0.6, ShortestAversion = 0.25;
        private const double BreathLeast = 0.85, BreathChance = 0.3; // of the mean length and depth
        private const double Inf = double.PositiveInfinity;

        private readonly LifeSettings life;
        private readonly Track track;
        private readonly uint seed;
        private readonly double drawn, calm;
        private readonly Lane modes;
        private readonly List<Target> targets;
        private double cut;
        private double[] edges;
        private string[] modeAt;
        private bool[] strictAt;

        /// <summary>
        /// The schedule to `end` seconds. What `before` holds that begins before `now` stays exactly as it was; what it holds for later
        /// is kept, too, where nothing it was drawn from has changed.
        /// </summary>
        public static Schedule Extend(Graph graph, Track track, uint seed, double end, Schedule before, double now)
        {
            Schedule after = before.Copy();
            after.End = end;
            LifeSettings life = graph.Life;
            if (!life.On)
            {
                after.Life = life;
                after.Track = track;
                return after;
            }
            double drawn = Math.Max(Block, Math.Ceiling(end / Block) * Block);
            bool fresh = before.Track == null || before.Life != life;
            bool same = !fresh && (ReferenceEquals(before.Track, track) || before.Track.Same(track));
            if (same && drawn == before.Drawn)
            {
                return after;
            }
            bool draws = fresh || !before.Track.SameDraws(track); // else only places have changed, which chance does not depend on
            double cut = Math.Max(0.0, Math.Min(before.Drawn, same ? drawn : now));
            double chance = draws ? cut : same ? cut : Math.Min(before.Drawn, drawn);
            var draw = new Drawing(life, track, seed, cut, drawn, before);
            after.Drawn = drawn;
            after.Modes = draw.modes;
            after.Targets = draw.targets;
            after.Breaths = before.Breaths.Until(chance);
            after.Aversions = before.Aversions.Until(chance);
            after.Saccades = before.Saccades.Until(chance);
            after.Blinks = before.Blinks.Until(chance);
            if (chance < drawn)
            {
                draw.Begin(chance);
                after.Breaths = draw.Breaths(after.Breaths);
                after.Aversions = draw.Aversions(after.Aversions);
                after.Saccades = draw.Saccades(after.Saccades);
                after.Blinks = draw.Blinks(after.Blinks);
            }
            after.Life = life;
            after.Track = track;
            return after;
        }

        private Drawing(LifeSettings life, Track track, uint seed, double cut, double drawn, Schedule before)
        {
            this.life = life;
            this.track = track;
            this.seed = seed;
            this.drawn = drawn;
            this.cut = cut;
            calm = 1.0 - life.Stillness;
            modes = before.Modes.Until(cut);
            var starts = new List<double>();
            var places = new List<double[]>();
            Wanted.Modes(track, cut, drawn, starts, places);
            if (starts.Count > 0 && modes.Count > 0 && places[0][0] == modes.Values[modes.Count - 1][0])
            {
                starts.RemoveAt(0);
                places.RemoveAt(0);
            }
            modes = modes.Plus(starts, places);
            targets = before.Targets.GetRange(0, Basics.BisectLeft(before.Targets, cut, t => t.Start));
            foreach (Target target in Wanted.Targets(track, cut, drawn))
            {
                if (targets.Count == 0 || !target.Like(targets[targets.Count - 1]))
                {
                    targets.Add(target);
                }
            }
        }

        /// <summary>Lay modes and strict looks out in one row of segments.</summary>
        private void Begin(double from)
        {
            cut = from;
            var found = new HashSet<double>(modes.Starts);
            found.UnionWith(targets.Where((t, n) => n == 0 || t.Strict != targets[n - 1].Strict).Select(t => t.Start));
            edges = found.OrderBy(x => x).ToArray();
            modeAt = Array.ConvertAll(
                edges, edge => Basics.Modes[(int)modes.Values[Math.Max(0, Basics.BisectRight(modes.Starts, edge) - 1)][0]]);
            strictAt = Array.ConvertAll(edges, edge => targets[Math.Max(0, Basics.BisectRight(targets, edge, t => t.Start) - 1)].Strict);
        }

        private double Chance(string what, int number, string purpose)
        {
            return ChoiceRules.Uniform(seed, what, number.ToString(System.Globalization.CultureInfo.InvariantCulture), purpose);
        }

        private Manner MannerAt(double seconds)
        {
            return life.Manner(modeAt[Math.Max(0, Basics.BisectRight(edges, seconds) - 1)]);
        }

        /// <summary>When `need` has passed since `seconds`, of a clock that runs at speed(manner, strict); infinite if too late.</summary>
        private double After(double seconds, double need, Func<Manner, bool, double> speed)
        {
            int place = Math.Max(0, Basics.BisectRight(edges, seconds) - 1);
            while (seconds < drawn)
            {
                double end = place + 1 < edges.Length ? edges[place + 1] : drawn;
                double rate = speed(life.Manner(modeAt[place]), strictAt[place]);
                if (rate > 0 && seconds + need / rate < end)
                {
                    return seconds + need / rate;
                }
                need -= rate * Math.Max(0.0, end - seconds);
                seconds = end;
                place++;
            }
            return Inf;
        }

        /// <summary>Each breath follows the one before; the first began before time 0, so that not everybody breathes alike.</summary>
        private Lane Breaths(Lane lane)
        {
            var starts = new List<double>();
            var values = new List<double[]>();
            int n = lane.Next, last = lane.Count - 1;
            double? at = lane.Count > 0 ? lane.Starts[last] + lane.Values[last][0] : (double?)null;
            while (true)
            {
                at = at == null ? at : Math.Max(at.Value, cut);
                Manner ways = MannerAt(at ?? 0.0);
                double rate = life.BreathRate * ways.BreathRate / 60;
                if (rate <= 0) // no breath until another mode begins
                {
                    int later = Basics.BisectRight(edges, at ?? 0.0);
                    if (life.BreathRate <= 0 || later == edges.Length)
                    {
                        break;
                    }
                    at = edges[later];
                    continue;
                }
                double length = (BreathLeast + BreathChance * Chance("breath", n, "length")) / rate;
                length *= 1 + 2 * life.Stillness; // slower, too, but never halting
                double depth = ways.Breathing * (BreathLeast + BreathChance * Chance("breath", n, "depth"));
                at = at ?? -length * ChoiceRules.Uniform(seed, "breath", "first");
                if (at >= drawn)
                {
                    break;
                }
                starts.Add(at.Value);
                values.Add(new[] { length, depth });
                at = at + length;
                n++;
            }
            return lane.Plus(starts, values);
        }

        private Lane Saccades(Lane lane)
        {
            if (life.SaccadeRate <= 0 || calm <= 0)
            {
                return lane;
            }
            double mean = Math.Max(60 / life.SaccadeRate, Fixation + 0.01);
            var starts = new List<double>();
            var values = new List<double[]>();
            double last = lane.Count > 0 ? lane.Starts[lane.Count - 1] : 0.0;
            for (int n = lane.Next; ; n++)
            {
                double need = Fixation + (mean - Fixation) * Math.Min(4.0, -Math.Log(Chance("saccade", n, "gap")));
                last = Math.Max(cut, After(last, need, (ways, strict) => ways.SaccadeRate * calm));
                if (!(last < drawn))
                {
                    return lane.Plus(starts, values);
                }
                double size = Math.Min(LargestSaccade, -Saccade * Math.Log(Chance("saccade", n, "size"))) * MannerAt(last).Saccades;
                double turn = 2 * Math.PI * Chance("saccade", n, "way");
                starts.Add(last);
                values.Add(new[] { size * Math.Sin(turn + Math.PI / 2), Upright * size * Math.Sin(turn) });
            }
        }

        private Lane Aversions(Lane lane)
        {
            if (life.AversionRate <= 0 || life.AversionLength <= 0 || life.AversionAngle <= 0 || calm <= 0)
            {
                return lane;
            }
            var starts = new List<double>();
            var values = new List<double[]>();
            double last = lane.Count > 0 ? lane.Values[lane.Count - 1][0] : 0.0;
            for (int n = lane.Next; ; n++)
            {
                double need = AversionGap + AversionChance * Chance("aversion", n, "gap");
                double at = Math.Max(cut, Math.Max(last + BetweenAversions, After(last, need, AversionSpeed)));
                if (!(at < drawn))
                {
                    return lane.Plus(starts, values);
                }
                Manner ways = MannerAt(at);
                double length = life.AversionLength * ways.AversionLength * (0.6 + 0.8 * Chance("aversion", n, "length"));
                last = at + Math.Max(ShortestAversion, length);
                double size = ways.AversionAngle * (0.7 + 0.6 * Chance("aversion", n, "size"));
                double turn = 2 * Math.PI * Chance("aversion", n, "way");
                starts.Add(at);
                values.Add(new[] { last, size * Math.Sin(turn + Math.PI / 2), Upright * size * Math.Sin(turn) });
            }
        }

        private double AversionSpeed(Manner ways, bool strict)
        {
            double rate = life.AversionRate * ways.AversionRate;
            if (strict || rate <= 0)
            {
                return 0.0;
            }
            return calm / Math.Max(BetweenAversions, 60 / rate - life.AversionLength * ways.AversionLength);
        }

        private Lane Blinks(Lane lane)
        {
            double shut = life.BlinkClose + life.BlinkOpen, mean = life.Blinks > 0 && calm > 0 ? 60 / life.Blinks : Inf;
            double last = -0.5 * Math.Min(mean, 10.0) * ChoiceRules.Uniform(seed, "blink", "first");
            last = lane.Count > 0 ? lane.Starts[lane.Count - 1] : last;
            var accents = new List<KeyValuePair<double, bool>>();
            if (calm > 0 && life.AccentBlinks > 0)
            {
                Accents(Math.Max(0.0, Math.Min(cut, last)), accents);
            }
            var starts = new List<double>();
            var values = new List<double[]>();
            int place = 0;
            for (int n = lane.Next; ; n++)
            {
                double need = mean * (BlinkGap + BlinkChance * Chance("blink", n, "gap"));
                double own = need < Inf ? Math.Max(cut, After(last, need, (ways, strict) => ways.Blinks * calm)) : Inf;
                while (place < accents.Count && !Suits(accents[place].Key, accents[place].Value, last, shut))
                {
                    place++;
                }
                double stressed = place < accents.Count ? accents[place].Key : Inf;
                int wish = Basics.BisectLeft(track.Blinks, Math.Max(cut, last + shut), b => b.Start);
                double wanted = wish < track.Blinks.Count ? track.Blinks[wish].Start : Inf;
                last = Math.Min(own, Math.Min(stressed, wanted));
                if (last >= drawn)
                {
                    return lane.Plus(starts, values);
                }
                starts.Add(last);
                values.Add(new[] { last == wanted ? 2.0 : last == stressed ? 1.0 : 0.0 });
            }
        }

        /// <summary>Whether a stressed syllable may bring a blink: a speech's first always, others some time after the last.</summary>
        private bool Suits(double at, bool first, double last, double shut)
        {
            return at >= cut && at >= last + (first ? shut + 0.1 : AfterBlink / calm);
        }

        /// <summary>The stressed syllables from `start` to the end that may bring blinks, and whether each is a speech's first.</summary>
        private void Accents(double start, List<KeyValuePair<double, bool>> found)
        {
            foreach (Speech speech in track.Speeches.Where(s => s.End > start && s.Start < drawn))
            {
                double[] accents = speech.Voice.Accents;
                for (int n = 0; n < accents.Length; n++)
                {
                    double at = speech.Start + accents[n];
                    if (start <= at && at < Math.Min(speech.End, drawn) && Chance(speech.Id, "accent", n) < life.AccentBlinks)
                    {
                        found.Add(new KeyValuePair<double, bool>(at, n == 0));
                    }
                }
            }
        }

        private double Chance(string what, string purpose, int number)
        {
            return ChoiceRules.Uniform(seed, what, purpose, number.ToString(System.Globalization.CultureInfo.InvariantCulture));
        }
    }
}
