// Translated from metagraph/playback/life/schedule.py; change that, and translate anew.
using System;
using System.Collections.Generic;
using System.Linq;

namespace Metagraph
{
    /// <summary>
    /// Everything that the life layers do by themselves from 0 to `end` seconds, in lanes. The columns of a lane's rows are
    /// listed here.
    ///
    /// modes: index in MODES. moods: valence, arousal, intensity. targets: what the gaze looks at. breaths: length s, depth.
    /// aversions: end s, right-to-left and upward part of the offset (of life's angle). saccades: offset to the left and up,
    /// degrees. blinks: 0 spontaneous, 1 on a stressed syllable, 2 requested, 3 spontaneous and incomplete. swells, emphases: of
    /// the face (`expressions`). drawn: seconds up to which the lanes are filled; the rest is what they were drawn from.
    /// </summary>
    public sealed class Schedule
    {
        public readonly double End;
        public readonly double Drawn;
        public readonly Lane Modes;
        public readonly Lane Moods;
        public readonly List<GazeTarget> Targets;
        public readonly Lane Breaths;
        public readonly Lane Aversions;
        public readonly Lane Saccades;
        public readonly Lane Blinks;
        public readonly Lane Swells;
        public readonly Lane Emphases;
        public readonly LifeSettings Life;
        public readonly Track Track;
        public readonly Voices Voices;
        public readonly uint Seed;

        public Schedule(
            double end = 0.0,
            double drawn = 0.0,
            Lane modes = null,
            Lane moods = null,
            List<GazeTarget> targets = null,
            Lane breaths = null,
            Lane aversions = null,
            Lane saccades = null,
            Lane blinks = null,
            Lane swells = null,
            Lane emphases = null,
            LifeSettings life = null,
            Track track = null,
            Voices voices = null,
            uint seed = 0
        )
        {
            End = end;
            Drawn = drawn;
            Modes = modes ?? new Lane(new List<double>(), new List<List<double>>(), 0, 1);
            Moods = moods ?? new Lane(new List<double>(), new List<List<double>>(), 0, 3);
            Targets = targets ?? new List<GazeTarget>();
            Breaths = breaths ?? new Lane(new List<double>(), new List<List<double>>(), 0, 2);
            Aversions = aversions ?? new Lane(new List<double>(), new List<List<double>>(), 0, 3);
            Saccades = saccades ?? new Lane(new List<double>(), new List<List<double>>(), 0, 2);
            Blinks = blinks ?? new Lane(new List<double>(), new List<List<double>>(), 0, 1);
            Swells = swells ?? new Lane(new List<double>(), new List<List<double>>(), 0, 3);
            Emphases = emphases ?? new Lane(new List<double>(), new List<List<double>>(), 0, 3);
            Life = life;
            Track = track;
            Voices = voices;
            Seed = seed;
        }

        /// <summary>Return the schedule without events that ended before `seconds`; later draws do not change.</summary>
        public Schedule Since(double seconds)
        {
            var breaths = Breaths.Since(seconds);
            var aversions = Aversions.Since(seconds);
            var saccades = Saccades.Since(seconds);
            var blinks = Blinks.Since(seconds);
            var rates = new List<double> { 1.0, 1.0, 1.0, 1.0 };
            if (Life != null)
            {
                rates = new List<double> { Life.BreathRate, Life.AversionRate, Life.SaccadeRate, Life.Blinks };
            }
            // Gaps run in modes' time from the event before, so the modes since then are needed.
            var lanes = new List<Lane> { breaths, aversions, saccades, blinks };
            var firsts = lanes.Where(kept => kept.Times.Count > 0).Select(kept => kept.Times[0]).ToList();
            var needed = firsts.Count > 0 ? PlainNumbers.MinOf(firsts) : seconds;
            if (PlainLists.Pairs(lanes, rates).Any(pair => pair.Item1.Times.Count == 0 && pair.Item2 > 0))
            {
                needed = 0.0;
            }
            var looked = PlainLists.Right(Targets.Select(t => t.Start).ToList(), Math.Min(needed, seconds - ScheduleRules.Recall))
                - 1;
            return new Schedule(
                this.End,
                this.Drawn,
                Modes.Since(needed, 0),
                Moods.Since(Math.Min(needed, seconds - ScheduleRules.Recall), 0),
                PlainLists.Part(Targets, Math.Max(0, looked)),
                breaths,
                aversions,
                saccades,
                blinks,
                Swells.Since(seconds),
                Emphases.Since(seconds, 3),
                this.Life,
                this.Track,
                this.Voices,
                this.Seed
            );
        }
    }

    /// <summary>
    /// One extension: lanes filled from `cut` to `drawn` seconds. edges: when modes, moods or strict looks change; manners: the
    /// factors of the amounts from each edge on; strict: 1 if the look is strict from there on, else 0. phrases: when the
    /// character begins to speak.
    /// </summary>
    public sealed class LifeDraw
    {
        public LifeSettings Life;
        public Track Track;
        public Voices Voices;
        public uint Seed;
        public double Cut;
        public double Drawn;
        public double Calm;
        public Lane Modes;
        public Lane Moods;
        public List<GazeTarget> Targets;
        public List<double> Edges;
        public List<Manner> Manners;
        public List<int> Strict;
        public List<double> Phrases;

        public LifeDraw(
            LifeSettings life,
            Track track,
            Voices voices,
            uint seed,
            double cut,
            double drawn,
            double calm,
            Lane modes,
            Lane moods,
            List<GazeTarget> targets,
            List<double> edges = null,
            List<Manner> manners = null,
            List<int> strict = null,
            List<double> phrases = null
        )
        {
            Life = life;
            Track = track;
            Voices = voices;
            Seed = seed;
            Cut = cut;
            Drawn = drawn;
            Calm = calm;
            Modes = modes;
            Moods = moods;
            Targets = targets;
            Edges = edges ?? new List<double>();
            Manners = manners ?? new List<Manner>();
            Strict = strict ?? new List<int>();
            Phrases = phrases ?? new List<double>();
        }

        /// <summary>Combine modes, moods and strict looks into one list of segments.</summary>
        public void Begin(double cut)
        {
            Cut = cut;
            var talks = Track.Modes.Where(change => change.Mode == "talking").Select(change => change.Start).ToList();
            Phrases = Track.Speeches.Select(speech => speech.Start).ToList().Concat(talks).ToList().OrderBy(x => x).ToList();
            var edges = Modes.Times.ToList();
            edges.AddRange(Moods.Times);
            foreach (var one in Targets.Select((item, n) => (n, item)))
            {
                var n = one.Item1;
                var target = one.Item2;
                if (n == 0 || target.Strict != Targets[n - 1].Strict)
                {
                    edges.Add(target.Start);
                }
            }
            var begun = Targets.Select(t => t.Start).ToList();
            foreach (double edge in edges.OrderBy(x => x).ToList())
            {
                if (Edges.Count > 0 && Edges[Edges.Count - 1] == edge)
                {
                    continue;
                }
                var mode = Math.Max(0, PlainLists.Right(Modes.Times, edge) - 1);
                var look = Math.Max(0, PlainLists.Right(begun, edge) - 1);
                Edges.Add(edge);
                var felt = Moods.Rows[Math.Max(0, PlainLists.Right(Moods.Times, edge) - 1)];
                var ways = LifeRules.GetManner(Life, WordsRules.Modes[(int)(Modes.Rows[mode][0])]);
                Manners.Add(WantedRules.WaysIn(ways, new Mood(felt[0], felt[1], felt[2])));
                Strict.Add(Targets[look].Strict ? 1 : 0);
            }
        }

        /// <summary>Return the key of an event's random numbers, for `chance_of`.</summary>
        public uint Key(string what, int number)
        {
            return ChoiceRules.Keyed(Seed, what, PlainText.Of(number));
        }

        /// <summary>Return the index of the segment that contains a time.</summary>
        public int PlaceAt(double seconds)
        {
            return Math.Max(0, PlainLists.Right(Edges, seconds) - 1);
        }

        /// <summary>Return whether the character is thinking at a time: then it looks up and aside, never down.</summary>
        public bool Thinks(double seconds)
        {
            var mode = Math.Max(0, PlainLists.Right(Modes.Times, seconds) - 1);
            return WordsRules.Modes[(int)(Modes.Rows[mode][0])] == "thinking";
        }

        /// <summary>
        /// Return when `need` seconds have passed since `seconds` on a clock that runs at these rates, one for each segment;
        /// infinity if that is after the end.
        /// </summary>
        public double After(double seconds, double need, List<double> rates)
        {
            var at = seconds;
            var left = need;
            var place = PlaceAt(at);
            while (at < Drawn)
            {
                var end = place + 1 < Edges.Count ? Edges[place + 1] : Drawn;
                var rate = rates[place];
                if (rate > 0 && at + left / rate < end)
                {
                    return at + left / rate;
                }
                left -= rate * Math.Max(0.0, end - at);
                at = end;
                place += 1;
            }
            return double.PositiveInfinity;
        }

        /// <summary>
        /// Draw breaths, each after the previous one. The first began before time 0, so that characters do not breathe in step.
        /// </summary>
        public Lane Breaths(Lane lane)
        {
            var times = new List<double>();
            var rows = new List<List<double>>();
            var number = lane.Next;
            var begun = lane.Times.Count > 0;
            var at = begun ? lane.Times[lane.Times.Count - 1] + lane.Rows[lane.Rows.Count - 1][0] : 0.0;
            while (true)
            {
                if (begun)
                {
                    at = Math.Max(at, Cut);
                }
                var ways = Manners[PlaceAt(at)];
                var rate = Life.BreathRate * ways.BreathRate / 60.0;
                if (rate <= 0) // no breath until another mode begins
                {
                    var later = PlainLists.Right(Edges, at);
                    if (Life.BreathRate <= 0 || later == Edges.Count)
                    {
                        break;
                    }
                    at = Edges[later];
                    begun = true;
                    continue;
                }
                var key = Key("breath", number);
                var length = (ScheduleRules.Breath + ScheduleRules.BreathChance * ChoiceRules.ChanceOf(key, "length")) / rate;
                length *= 1.0 + 2.0 * Life.Stillness; // slower, too, but never halting
                length = begun ? ToPhrase(at, length) : length;
                var depth = ways.Breathing
                    * (ScheduleRules.Breath + ScheduleRules.BreathChance * ChoiceRules.ChanceOf(key, "depth"));
                if (!begun)
                {
                    at = -length * ChoiceRules.Uniform(Seed, "breath", "first");
                    begun = true;
                }
                if (at >= Drawn)
                {
                    break;
                }
                times.Add(at);
                rows.Add(new List<double> { length, depth });
                at += length;
                number += 1;
            }
            return lane.Plus(times, rows);
        }

        /// <summary>
        /// Return the length of a breath that begins at `at`, so that the next one begins right before the character speaks.
        /// </summary>
        public double ToPhrase(double at, double length)
        {
            var place = PlainLists.Left(Phrases, at + (1.0 - ScheduleRules.Stretch) * length + ScheduleRules.BreathesIn);
            if (place == Phrases.Count)
            {
                return length;
            }
            var wanted = Phrases[place] - ScheduleRules.BreathesIn - at;
            return wanted <= (1.0 + ScheduleRules.Stretch) * length ? wanted : length;
        }

        /// <summary>Draw the small jumps of the eyes.</summary>
        public Lane Saccades(Lane lane)
        {
            if (Life.SaccadeRate <= 0 || Calm <= 0)
            {
                return lane;
            }
            var mean = Math.Max(60.0 / Life.SaccadeRate, ScheduleRules.Fixation + 0.01);
            var rates = Manners.Select(ways => ways.SaccadeRate * Calm).ToList();
            var times = new List<double>();
            var rows = new List<List<double>>();
            var number = lane.Next;
            var last = lane.Times.Count > 0 ? lane.Times[lane.Times.Count - 1] : 0.0;
            while (true)
            {
                var key = Key("saccade", number);
                var need = ScheduleRules.Fixation
                    + (mean - ScheduleRules.Fixation) * Math.Min(4.0, -Math.Log(ChoiceRules.ChanceOf(key, "gap")));
                last = Math.Max(Cut, After(last, need, rates));
                if (!(last < Drawn))
                {
                    return lane.Plus(times, rows);
                }
                var size = Math.Min(
                    ScheduleRules.LargestSaccade,
                    -ScheduleRules.Saccade * Math.Log(ChoiceRules.ChanceOf(key, "size"))
                );
                size *= Manners[PlaceAt(last)].Saccades;
                var turn = 2.0 * Math.PI * ChoiceRules.ChanceOf(key, "way");
                times.Add(last);
                rows.Add(new List<double> {
                    size * Math.Sin(turn + Math.PI / 2.0),
                    ScheduleRules.Upright * size * Math.Sin(turn)
                 });
                number += 1;
            }
        }

        /// <summary>Draw short looks away.</summary>
        public Lane Aversions(Lane lane)
        {
            var life = Life;
            if (life.AversionRate <= 0 || life.AversionLength <= 0 || life.AversionAngle <= 0 || Calm <= 0)
            {
                return lane;
            }
            var rates = new List<double>();
            foreach (var one in PlainLists.Pairs(Manners, Strict))
            {
                var ways = one.Item1;
                var strict = one.Item2;
                var rate = life.AversionRate * ways.AversionRate;
                if (strict == 1 || rate <= 0)
                {
                    rates.Add(0.0);
                }
                else
                {
                    var mean = Math.Max(ScheduleRules.BetweenAversions, 60.0 / rate - life.AversionLength * ways.AversionLength);
                    rates.Add(Calm / mean);
                }
            }
            var times = new List<double>();
            var rows = new List<List<double>>();
            var number = lane.Next;
            var last = lane.Rows.Count > 0 ? lane.Rows[lane.Rows.Count - 1][0] : 0.0;
            while (true)
            {
                var key = Key("aversion", number);
                var need = ScheduleRules.AversionGap + ScheduleRules.AversionChance * ChoiceRules.ChanceOf(key, "gap");
                var at = Math.Max(Cut, Math.Max(last + ScheduleRules.BetweenAversions, After(last, need, rates)));
                if (!(at < Drawn))
                {
                    return lane.Plus(times, rows);
                }
                var own = Manners[PlaceAt(at)];
                var length = life.AversionLength * own.AversionLength;
                length *= 0.6 + 0.8 * ChoiceRules.ChanceOf(key, "length");
                last = at + Math.Max(ScheduleRules.ShortestAversion, length);
                var size = own.AversionAngle * (0.7 + 0.6 * ChoiceRules.ChanceOf(key, "size"));
                var turn = 2.0 * Math.PI * ChoiceRules.ChanceOf(key, "way");
                var up = ScheduleRules.Upright * size * Math.Sin(turn);
                times.Add(at);
                rows.Add(new List<double> { last, size * Math.Sin(turn + Math.PI / 2.0), Thinks(at) ? Math.Abs(up) : up });
                number += 1;
            }
        }

        /// <summary>
        /// Draw blinks: spontaneous ones, those on stressed syllables and requested ones, in the order in which they come.
        /// </summary>
        public Lane Blinks(Lane lane)
        {
            var life = Life;
            var shut = life.BlinkClose + life.BlinkOpen;
            var mean = (life.Blinks > 0 && Calm > 0) ? 60.0 / life.Blinks : double.PositiveInfinity;
            var rates = Manners.Select(ways => ways.Blinks * Calm).ToList();
            var last = -0.5 * Math.Min(mean, 10.0) * ChoiceRules.Uniform(Seed, "blink", "first");
            if (lane.Times.Count > 0)
            {
                last = lane.Times[lane.Times.Count - 1];
            }
            var accents = new List<(double, bool)>();
            if (Calm > 0 && life.AccentBlinks > 0)
            {
                accents = Accents(Math.Max(0.0, Math.Min(Cut, last)));
            }
            var asked = Track.Blinks.Select(b => b.Start).ToList();
            var times = new List<double>();
            var rows = new List<List<double>>();
            var number = lane.Next;
            var place = 0;
            while (true)
            {
                var own = double.PositiveInfinity;
                if (mean < double.PositiveInfinity)
                {
                    var key = Key("blink", number);
                    var drawn = ChoiceRules.LogNormal(
                        mean,
                        ScheduleRules.BlinkSpread * mean,
                        ChoiceRules.ChanceOf(key, "gap"),
                        ChoiceRules.ChanceOf(key, "gap2")
                    );
                    var need = ChoiceRules.ChanceOf(key, "double") < ScheduleRules.Doubles
                        ? ScheduleRules.Double
                        : Math.Max(ScheduleRules.Double, drawn);
                    own = Math.Max(Cut, After(last, need, rates));
                }
                // A stressed syllable may bring a blink: the first of a speech always, the others some time after
                // the last blink.
                while (place < accents.Count)
                {
                    var found = accents[place];
                    double accent = found.Item1;
                    bool first = found.Item2;
                    if (accent >= Cut && accent >= last + (first ? shut + 0.1 : ScheduleRules.AfterBlink / Calm))
                    {
                        break;
                    }
                    place += 1;
                }
                var heard = place < accents.Count ? accents[place].Item1 : double.PositiveInfinity;
                var wish = PlainLists.Left(asked, Math.Max(Cut, last + shut));
                var wanted = wish < asked.Count ? asked[wish] : double.PositiveInfinity;
                var at = Math.Min(own, Math.Min(heard, wanted));
                if (at >= Drawn)
                {
                    return lane.Plus(times, rows);
                }
                times.Add(at);
                var kind = at == heard ? 1.0 : 0.0;
                if (at == own && at != heard && ChoiceRules.ChanceOf(Key("blink", number), "half") < ScheduleRules.Halves)
                {
                    kind = 3.0;
                }
                rows.Add(new List<double> { at == wanted ? 2.0 : kind });
                last = at;
                number += 1;
            }
        }

        /// <summary>
        /// Return the stressed syllables from `start` to the end that may bring blinks, and whether each is a speech's first.
        /// </summary>
        public List<(double, bool)> Accents(double start)
        {
            var out_ = new List<(double, bool)>();
            foreach (Speech speech in Track.Speeches)
            {
                if (speech.End <= start || speech.Start >= Drawn)
                {
                    continue;
                }
                var end = Math.Min(speech.End, Drawn);
                foreach (var one in VoiceRules.Stressed(Voices, speech).Select((item, n) => (n, item)))
                {
                    var n = one.Item1;
                    var peak = one.Item2;
                    var at = ItemsRules.FindLineStart(speech) + peak;
                    if (at < Math.Max(start, speech.Start) || at >= end)
                    {
                        continue;
                    }
                    if (n == 0 || ChoiceRules.Uniform(Seed, speech.Id, "accent", PlainText.Of(n)) < Life.AccentBlinks)
                    {
                        out_.Add((at, n == 0));
                    }
                }
            }
            return out_;
        }
    }

    public static class ScheduleRules
    {
        public const double Block = 8.0; // seconds drawn at a time, so that a running plan need not draw at every tick
        // seconds of looks kept when the past is forgotten: longer than any turn of the head takes
        public const double Recall = 4.0;
        // Blinks: on stressed syllables at least so many seconds after the last (Yang et al., section 7.3); of
        // themselves after gaps that spread as people's do, log-normal, a few of them doubles.
        public const double AfterBlink = 1.0;
        public const double BlinkSpread = 0.7; // standard deviation of the gaps, times their mean
        public const double Doubles = 0.06; // share of blinks that follow the one before at once
        public const double Double = 0.4; // seconds after which they do
        public const double Halves = 0.12; // share of blinks by themselves that are incomplete
        public const double Half = 0.6; // how far these shut the eyes
        // Saccades: fixations last 0.2 s and more; sizes fall off as in "Eyes Alive", small ones only: the eyes stay
        // with what they look at.
        public const double Fixation = 0.2;
        public const double Saccade = 1.2; // degrees on average
        public const double LargestSaccade = 4.0; // degrees
        public const double Upright = 0.6; // how much of an offset goes up and down
        // Aversions: at somewhat regular intervals, in a random direction, more often to the sides.
        public const double AversionGap = 0.6;
        public const double AversionChance = 0.8;
        public const double BetweenAversions = 0.6; // seconds at least
        public const double ShortestAversion = 0.25;
        public const double Breath = 0.85; // of the mean length and depth: the least
        public const double BreathChance = 0.3; // and what chance adds
        // A character breathes in before it speaks: a breath begins so long before the first word, and the one before
        // it is shortened or drawn out by so much of its length at most. Ours.
        public const double BreathesIn = 0.55; // seconds
        public const double Stretch = 0.5;

        /// <summary>
        /// Return the schedule to `end` seconds. Events of `before` that begin before `now` stay exactly as they were.
        ///
        /// Its later events stay, too, if nothing that they were drawn from has changed.
        /// </summary>
        public static Schedule Schedule(
            LifeSettings life,
            Track track,
            Voices voices,
            uint seed,
            double end,
            Schedule before,
            double now
        )
        {
            if (!life.On)
            {
                return new Schedule(
                    end,
                    before.Drawn,
                    before.Modes,
                    before.Moods,
                    before.Targets,
                    before.Breaths,
                    before.Aversions,
                    before.Saccades,
                    before.Blinks,
                    before.Swells,
                    before.Emphases,
                    life,
                    track,
                    voices,
                    seed
                );
            }
            var drawn = Math.Max(Block, (int)Math.Ceiling(end / Block) * Block);
            var change = Change(before, life, track, voices, seed);
            if (change == "" && drawn == before.Drawn)
            {
                return new Schedule(
                    end,
                    before.Drawn,
                    before.Modes,
                    before.Moods,
                    before.Targets,
                    before.Breaths,
                    before.Aversions,
                    before.Saccades,
                    before.Blinks,
                    before.Swells,
                    before.Emphases,
                    before.Life,
                    before.Track,
                    before.Voices,
                    before.Seed
                );
            }
            var cut = Math.Max(0.0, Math.Min(before.Drawn, change == "" ? drawn : now));
            var chance = change == "places" ? Math.Min(before.Drawn, drawn) : cut;
            var draw = Draw(life, track, voices, seed, cut, drawn, before);
            var breaths = before.Breaths.Until(chance);
            var aversions = before.Aversions.Until(chance);
            var saccades = before.Saccades.Until(chance);
            var blinks = before.Blinks.Until(chance);
            var swells = before.Swells.Until(chance);
            var emphases = before.Emphases.Until(chance);
            if (chance < drawn)
            {
                draw.Begin(chance);
                breaths = draw.Breaths(breaths);
                aversions = draw.Aversions(aversions);
                saccades = draw.Saccades(saccades);
                blinks = draw.Blinks(blinks);
                swells = ExpressionsRules.SwellsOn(track, seed, chance, drawn, swells);
                emphases = ExpressionsRules.EmphasesOn(life, track, voices, seed, chance, drawn, emphases);
            }
            return new Schedule(
                end,
                drawn,
                draw.Modes,
                draw.Moods,
                draw.Targets,
                breaths,
                aversions,
                saccades,
                blinks,
                swells,
                emphases,
                life,
                track,
                voices,
                seed
            );
        }

        /// <summary>
        /// Return "" if nothing that a schedule was drawn from has changed, "places" if only places have, else "all".
        /// </summary>
        private static string Change(Schedule before, LifeSettings life, Track track, Voices voices, uint seed)
        {
            if (before.Track == null || before.Seed != seed || !LifeRules.IsSameLife(before.Life, life))
            {
                return "all";
            }
            if (!VoiceRules.AreSameVoices(before.Voices, voices))
            {
                return "all";
            }
            if (before.Track == track || before.Track.Like(track))
            {
                return "";
            }
            return before.Track.DrawsLike(track) ? "places" : "all";
        }

        /// <summary>
        /// Return the draw that extends a schedule from `cut` to `drawn` seconds, with modes and looks filled in.
        /// </summary>
        private static LifeDraw Draw(
            LifeSettings life,
            Track track,
            Voices voices,
            uint seed,
            double cut,
            double drawn,
            Schedule before
        )
        {
            var modes = before.Modes.Until(cut);
            var last = modes.Rows.Count > 0 ? (int)(modes.Rows[modes.Rows.Count - 1][0]) : -1;
            var times = new List<double>();
            var rows = new List<List<double>>();
            foreach (var one in WantedRules.ModesBetween(track, cut, drawn))
            {
                var at = one.Item1;
                var mode = one.Item2;
                if (times.Count > 0 || mode != last)
                {
                    times.Add(at);
                    rows.Add(new List<double> { mode });
                }
            }
            var moods = before.Moods.Until(cut);
            var felt = new List<double>();
            if (moods.Rows.Count > 0)
            {
                felt = moods.Rows[moods.Rows.Count - 1].ToList();
            }
            var changes = new List<double>();
            var wanted = new List<List<double>>();
            foreach (var one in WantedRules.MoodsBetween(WantedRules.MoodsOf(life, track), cut, drawn))
            {
                var at = one.Item1;
                var mood = one.Item2;
                var same = felt.Count > 0 && felt[0] == mood.Valence && felt[1] == mood.Arousal && felt[2] == mood.Intensity;
                if (changes.Count > 0 || !same)
                {
                    changes.Add(at);
                    wanted.Add(new List<double> { mood.Valence, mood.Arousal, mood.Intensity });
                }
            }
            var begun = PlainLists.Left(before.Targets.Select(t => t.Start).ToList(), cut);
            var targets = PlainLists.Part(before.Targets, 0, begun);
            foreach (GazeTarget target in WantedRules.TargetsBetween(track, cut, drawn))
            {
                if (targets.Count == 0 || !target.Like(targets[targets.Count - 1]))
                {
                    targets.Add(target);
                }
            }
            return new LifeDraw(
                life,
                track,
                voices,
                seed,
                cut,
                drawn,
                1.0 - life.Stillness,
                modes.Plus(times, rows),
                moods.Plus(changes, wanted),
                targets.ToList()
            );
        }
    }
}
