// Translated from metagraph/engines/single_rules.py; change that, and translate anew.
using System;
using System.Collections.Generic;
using System.Linq;

namespace Metagraph
{
    /// <summary>What a rule is asked with: numbers and texts, which are taken one after the other.</summary>
    public sealed class RuleInput
    {
        public List<double> Numbers;
        public List<string> Texts;
        public int At;
        public int Told;

        public RuleInput(List<double> numbers, List<string> texts, int at = 0, int told = 0)
        {
            Numbers = numbers;
            Texts = texts;
            At = at;
            Told = told;
        }

        /// <summary>Take the next number.</summary>
        public double Number()
        {
            At += 1;
            return Numbers[At - 1];
        }

        /// <summary>Take the next text.</summary>
        public string Text()
        {
            Told += 1;
            return Texts[Told - 1];
        }
    }

    public static class SingleRulesRules
    {
        public const double Open = 1000000000.0; // in the place of an end that is not known

        /// <summary>Return what a rule makes of numbers and texts; nothing for a rule that is not known.</summary>
        public static List<double> AnswerRule(Alphabet alphabet, uint seed, string rule, List<double> numbers, List<string> texts)
        {
            var given = new RuleInput(numbers, texts);
            if (new List<string> { "between", "apart", "unit", "contacts", "bring", "weight", "feet" }.Contains(rule))
            {
                return Geometry(rule, given);
            }
            if (new List<string> { "way", "steps", "track", "driven", "span", "key" }.Contains(rule))
            {
                return Places(rule, given);
            }
            if (new List<string> { "mouth", "soften", "accents", "spelled", "letters" }.Contains(rule))
            {
                return Mouth(alphabet, rule, given);
            }
            if (new List<string> { "timing", "piece" }.Contains(rule))
            {
                return Timing(alphabet, rule, given);
            }
            if (new List<string> { "mood", "moods", "shown", "lasting" }.Contains(rule))
            {
                return Mood(seed, rule, given);
            }
            return Times(seed, rule, given);
        }

        private static (double, double, double) Vector(RuleInput given)
        {
            var x = given.Number();
            var y = given.Number();
            var z = given.Number();
            return (x, y, z);
        }

        private static (double, double, double, double) Turn(RuleInput given)
        {
            var x = given.Number();
            var y = given.Number();
            var z = given.Number();
            var w = given.Number();
            return PlainVectorsRules.UnitTurn((x, y, z, w));
        }

        private static int Count(RuleInput given)
        {
            return (int)Math.Floor(given.Number() + 0.5);
        }

        private static void Put(List<double> out_, (double, double, double) v)
        {
            var found = v;
            double x = found.Item1;
            double y = found.Item2;
            double z = found.Item3;
            out_.AddRange(new List<double> { x, y, z });
        }

        private static void PutTurn(List<double> out_, (double, double, double, double) q)
        {
            var found = q;
            double x = found.Item1;
            double y = found.Item2;
            double z = found.Item3;
            double w = found.Item4;
            out_.AddRange(new List<double> { x, y, z, w });
        }

        // --- limbs
        /// <summary>Read a rig and a pose of it.</summary>
        private static ContactRig Rig(RuleInput given, ContactPose pose)
        {
            var parents = new List<int>();
            var joints = new List<int>();
            var size = Count(given);
            for (int n = 0; n < size; n++)
            {
                joints.Add(n);
                parents.Add(Count(given));
                pose.Moved.Add(Vector(given));
                pose.Local.Add(Turn(given));
            }
            var limbs = new List<ContactArm>();
            for (int side = 0; side < 2; side++)
            {
                var upper = Count(given);
                var lower = Count(given);
                var hand = Count(given);
                var below = new List<int>();
                size = Count(given);
                for (int n = 0; n < size; n++)
                {
                    below.Add(Count(given));
                }
                limbs.Add(new ContactArm(upper, lower, hand, below.ToList()));
            }
            var capsules = new List<BodyCapsule>();
            size = Count(given);
            for (int n = 0; n < size; n++)
            {
                var joint = Count(given);
                var a = Vector(given);
                var to = Count(given);
                var b = Vector(given);
                var radius = given.Number();
                var arm = Count(given);
                capsules.Add(new BodyCapsule(joint, a, to, b, radius, arm, Count(given)));
            }
            var guard = given.Number() > 0.0;
            var places = new Dictionary<string, int>();
            return new ContactRig(
                joints.ToList(),
                parents.ToList(),
                places,
                limbs.ToList(),
                new List<string> { "left", "right" },
                capsules.ToList(),
                true,
                guard
            );
        }

        private static WeightRig WeightRig(RuleInput given, ContactRig body)
        {
            var bends = new List<WeightBend>();
            var size = Count(given);
            int place = default(int);
            for (int n = 0; n < size; n++)
            {
                place = Count(given);
                var left = Vector(given);
                var up = Vector(given);
                var ahead = Vector(given);
                bends.Add(new WeightBend(place, left, up, ahead, given.Number()));
            }
            var collars = new List<WeightCollar>();
            size = Count(given);
            for (int n = 0; n < size; n++)
            {
                place = Count(given);
                var upper = Count(given);
                var axis = Vector(given);
                collars.Add(new WeightCollar(place, upper, axis, Count(given)));
            }
            var knees = new List<(double, double, double)>();
            var levers = new List<(double, double)>();
            for (int side = 0; side < 2; side++)
            {
                knees.Add(Vector(given));
                var aside = given.Number();
                levers.Add((aside, given.Number()));
            }
            var height = given.Number();
            return new WeightRig(
                body,
                bends.ToList(),
                collars.ToList(),
                knees.ToList(),
                levers.ToList(),
                (0.0, 1.0, 0.0),
                height,
                given.Number()
            );
        }

        private static List<double> Posed(ContactPose pose)
        {
            var out_ = new List<double>();
            for (int place = 0; place < pose.Local.Count; place++)
            {
                PutTurn(out_, pose.Local[place]);
                Put(out_, pose.At[place]);
            }
            return out_;
        }

        private static List<double> Geometry(string rule, RuleInput given)
        {
            var out_ = new List<double>();
            if (rule == "between")
            {
                var a = PlainVectorsRules.Unit(Vector(given));
                PutTurn(out_, PlainVectorsRules.Between(a, PlainVectorsRules.Unit(Vector(given))));
            }
            else if (rule == "unit")
            {
                Put(out_, PlainVectorsRules.Unit(Vector(given)));
                PutTurn(out_, Turn(given));
            }
            else if (rule == "apart")
            {
                var ends = new List<(double, double, double)>();
                for (int n = 0; n < 4; n++)
                {
                    ends.Add(Vector(given));
                }
                PutTurn(out_, ContactSolveRules.Apart(ends, 0, 2));
            }
            else
            {
                var pose = new ContactPose();
                var rig = Rig(given, pose);
                ContactSolveRules.Spread(rig, pose);
                var moved = false;
                if (rule == "bring")
                {
                    var side = Count(given);
                    var goal = Vector(given);
                    var turn = Turn(given);
                    ContactSolveRules.Bring(rig, pose, side, goal, turn, Vector(given));
                }
                else if (rule == "contacts")
                {
                    var goals = new List<HandGoal>();
                    var size = Count(given);
                    for (int n = 0; n < size; n++)
                    {
                        var arm = Count(given);
                        var to = Count(given);
                        var at = Vector(given);
                        var turn = Turn(given);
                        goals.Add(new HandGoal(arm, to, at, turn, given.Number()));
                    }
                    moved = ContactSolveRules.SolveContacts(rig, pose, goals);
                    foreach ((double, double, double) end in ContactSolveRules.CapsuleEnds(rig, pose))
                    {
                        Put(out_, end);
                    }
                }
                else
                {
                    var body = WeightRig(given, rig);
                    out_.Add(WeightSolveRules.StandsBy(body, pose));
                    if (rule == "weight")
                    {
                        var drive = new List<double>();
                        for (int n = 0; n < 16; n++)
                        {
                            drive.Add(given.Number());
                        }
                        var follow = given.Number();
                        moved = WeightSolveRules.AnswerArms(body, pose, drive, follow, given.Number());
                    }
                    else
                    {
                        for (int side = 0; side < 2; side++)
                        {
                            var foot = Vector(given);
                            var reach = given.Number();
                            out_.Add(WeightSolveRules.HipsSink(body, pose, side, foot, reach, given.Number()));
                        }
                        var feet = new List<FootGoal>();
                        var size = Count(given);
                        for (int n = 0; n < size; n++)
                        {
                            feet.Add(Foot(given));
                        }
                        moved = FeetSolveRules.PlantFeet(body, pose, feet, given.Number());
                    }
                }
                out_.Add(moved ? 1.0 : 0.0);
                ContactSolveRules.Spread(rig, pose);
                out_.AddRange(Posed(pose));
            }
            return out_;
        }

        // --- where hands and feet are
        private static FootGoal Foot(RuleInput given)
        {
            var at = Vector(given);
            var turn = Turn(given);
            var planted = given.Number();
            return new FootGoal(at, turn, planted, given.Number());
        }

        private static List<FootGoal> Feet(RuleInput given)
        {
            var out_ = new List<FootGoal>();
            var size = Count(given);
            for (int n = 0; n < size; n++)
            {
                out_.Add(Foot(given));
            }
            return out_;
        }

        private static void PutFeet(List<double> out_, List<FootGoal> feet)
        {
            foreach (FootGoal foot in feet)
            {
                Put(out_, foot.At);
                PutTurn(out_, foot.Turn);
                out_.AddRange(new List<double> { foot.Planted, foot.Lift });
            }
        }

        private static List<List<double>> Rows(RuleInput given, int count, int width)
        {
            var out_ = new List<List<double>>();
            for (int n = 0; n < count; n++)
            {
                var row = new List<double>();
                for (int k = 0; k < width; k++)
                {
                    row.Add(given.Number());
                }
                out_.Add(row);
            }
            return out_;
        }

        private static ContactSpan Span(RuleInput given)
        {
            var start = given.Number();
            var end = given.Number();
            var easeIn = given.Number();
            var easeOut = given.Number();
            var keys = new List<ContactKey>();
            var size = Count(given);
            for (int n = 0; n < size; n++)
            {
                var time = given.Number();
                var at = Vector(given);
                keys.Add(new ContactKey(time, at, Turn(given)));
            }
            return new ContactSpan("left", "palm", "Chest", start, end, keys.ToList(), easeIn, easeOut);
        }

        private static List<double> Places(string rule, RuleInput given)
        {
            var out_ = new List<double>();
            if (rule == "way")
            {
                var one = Foot(given);
                out_.Add(FeetSolveRules.FootWay(one, Foot(given)));
            }
            else if (rule == "steps")
            {
                var height = given.Number();
                var before = Feet(given);
                var after = Feet(given);
                var first = Feet(given);
                var last = Feet(given);
                var passed = given.Number();
                PutFeet(out_, PlantedFeetRules.Stepped(height, before, after, first, last, passed, given.Number()));
            }
            else if (rule == "track")
            {
                var rows = Rows(given, Count(given), 16);
                PutFeet(out_, PlantedFeetRules.FootRow(new FootTrack(rows), given.Number()));
            }
            else if (rule == "driven")
            {
                var sways = Rows(given, 4, 8);
                out_.AddRange(FollowThroughRules.Driven(sways, given.Number()));
            }
            else if (rule == "span")
            {
                var span = Span(given);
                var first = given.Number();
                var last = given.Number();
                var size = Count(given);
                for (int n = 0; n < size; n++)
                {
                    out_.Add(ContactSpansRules.ContactWeight(span, given.Number(), first, last));
                }
            }
            else
            {
                var span = Span(given);
                var size = Count(given);
                for (int n = 0; n < size; n++)
                {
                    var key = ContactSpansRules.ContactKey(span, given.Number());
                    out_.Add(key.Time);
                    Put(out_, key.At);
                    PutTurn(out_, key.Turn);
                }
            }
            return out_;
        }

        // --- the mouth
        private static void PutSpelled(List<double> out_, Spelled found)
        {
            foreach (MouthPiece piece in found.Pieces)
            {
                out_.AddRange(new List<double> {
                    piece.Start,
                    piece.End,
                    WordsRules.Visemes.IndexOf(piece.Viseme),
                    piece.Strength
                 });
            }
            out_.AddRange(found.Peaks);
            out_.AddRange(found.Strengths);
        }

        private static List<double> Mouth(Alphabet alphabet, string rule, RuleInput given)
        {
            var out_ = new List<double>();
            if (rule == "mouth")
            {
                var pieces = new List<MouthPiece>();
                var size = Count(given);
                for (int n = 0; n < size; n++)
                {
                    var start = given.Number();
                    var end = given.Number();
                    var strength = given.Number();
                    pieces.Add(new MouthPiece(start, end, given.Text(), strength));
                }
                foreach (List<double> row in MouthRules.MouthTrack(pieces, given.Number()))
                {
                    out_.AddRange(row);
                }
            }
            else if (rule == "soften")
            {
                var rows = Rows(given, 3, 14);
                out_.AddRange(rows[1]);
                MouthRules.Soften(out_, rows[0], rows[1], rows[2]);
            }
            else if (rule == "accents")
            {
                var count = Count(given);
                var rows = Rows(given, 2, count);
                out_.AddRange(MouthRules.AccentsOf(rows[0], rows[1]));
            }
            else if (rule == "letters")
            {
                var size = Count(given);
                for (int n = 0; n < size; n++)
                {
                    out_.Add(GraphemesRules.MeasureLetter(Count(given)));
                }
            }
            else
            {
                var text = given.Text();
                out_.Add(GraphemesRules.ReadAloud(alphabet, text));
                PutSpelled(out_, GraphemesRules.Spelled(alphabet, text, given.Number()));
            }
            return out_;
        }

        // --- the times of lines
        private static LineTiming Line(RuleInput given)
        {
            var words = new List<SpokenWord>();
            var size = Count(given);
            for (int n = 0; n < size; n++)
            {
                var start = given.Number();
                var end = given.Number();
                words.Add(new SpokenWord(given.Text(), start, end >= Open ? (double?)null : end));
            }
            var marks = new List<VisemeMark>();
            size = Count(given);
            for (int n = 0; n < size; n++)
            {
                var at = given.Number();
                var weight = given.Number();
                marks.Add(new VisemeMark(at, given.Text(), weight));
            }
            return new LineTiming(words.ToList(), marks.ToList(), given.Number());
        }

        private static void PutLine(Alphabet alphabet, List<double> out_, LineTiming line)
        {
            foreach (SpokenWord word in line.Words)
            {
                out_.AddRange(new List<double> {
                    word.Start,
                    word.End == null ? Open : word.End.Value,
                    alphabet.Letters(word.Text).Count
                 });
            }
            foreach (VisemeMark mark in line.Marks)
            {
                out_.AddRange(new List<double> { mark.At, mark.Viseme.Length, mark.Weight });
            }
            out_.Add(line.Later);
        }

        private static double Yes(bool which)
        {
            return which ? 1.0 : 0.0;
        }

        private static List<double> Timing(Alphabet alphabet, string rule, RuleInput given)
        {
            var out_ = new List<double>();
            if (rule == "timing")
            {
                var name = given.Text();
                var duration = given.Number();
                var raw = Line(given);
                var wrong = LineTimingRules.WrongIn(raw.Words, raw.Marks, name, duration >= Open ? (double?)null : duration);
                out_.AddRange(new List<double> { wrong.Length, LineTimingRules.SetOf(raw.Marks).Length });
                PutLine(alphabet, out_, new LineTiming(LineTimingRules.JoinLetters(alphabet, raw.Words).ToList()));
                var paced = LineTimingRules.PaceText(alphabet, given.Text(), duration >= Open ? (double?)null : duration);
                PutLine(alphabet, out_, paced);
                if (wrong != "")
                {
                    return out_;
                }
                var line = LineTimingRules.TimingOf(alphabet, raw.Words, raw.Marks, name);
                PutLine(alphabet, out_, line);
                PutLine(alphabet, out_, LineTimingRules.Shifted(line, 0.5));
                out_.Add(LineTimingRules.TimedSeconds(line, duration >= Open ? (double?)null : duration));
                PutSpelled(out_, LineTimingRules.TimedSounds(alphabet, line));
            }
            else
            {
                var old = Line(given);
                var new_ = Line(given);
                var said = given.Number();
                out_.Add(Yes(LineTimingRules.AlikeTimings(old, new_)));
                out_.Add(Yes(LineTimingRules.AlikeTimings(old, null)));
                out_.Add(Yes(LineTimingRules.AlikeTimings(null, null)));
                out_.Add(Yes(LineTimingRules.TellsOn(old, new_)));
                out_.Add(Yes(LineTimingRules.Restarts(old, new_, said)));
                var first = given.Number();
                var last = given.Number();
                out_.Add(Yes(LineTimingRules.ComesLate(first, last, given.Number(), said)));
                PutLine(alphabet, out_, LineTimingRules.PlaceTold(old, new_, said));
                PutLine(alphabet, out_, LineTimingRules.Extended(old, new_, said));
            }
            return out_;
        }

        // --- moods
        private static Mood MoodOf(RuleInput given)
        {
            var valence = given.Number();
            var arousal = given.Number();
            return new Mood(valence, arousal, given.Number());
        }

        /// <summary>Read moods; numbers above 8 stand for what is not told.</summary>
        private static List<MoodFrom> Told(RuleInput given)
        {
            var out_ = new List<MoodFrom>();
            var size = Count(given);
            for (int n = 0; n < size; n++)
            {
                var start = given.Number();
                var valence = given.Number();
                var arousal = given.Number();
                var intensity = given.Number();
                var end = given.Number();
                out_.Add(new MoodFrom(
                    "told",
                    start,
                    valence > 8 ? (double?)null : valence,
                    arousal > 8 ? (double?)null : arousal,
                    intensity > 8 ? (double?)null : intensity,
                    end >= Open ? double.PositiveInfinity : end
                ));
            }
            return out_;
        }

        private static void PutMood(List<double> out_, Mood mood)
        {
            out_.AddRange(new List<double> { mood.Valence, mood.Arousal, mood.Intensity });
        }

        private static List<double> Mood(uint seed, string rule, RuleInput given)
        {
            var out_ = new List<double>();
            if (rule == "mood")
            {
                var mood = MoodOf(given);
                var tags = new List<string> { given.Text(), given.Text() };
                var life = MoodRules.LifeOf(mood);
                var how = MoodRules.Bearing(mood);
                out_.AddRange(new List<double> {
                    MoodRules.Liveliness(mood),
                    MoodRules.Fear(mood),
                    MoodRules.Anger(mood),
                    MoodRules.Extent(mood),
                    MoodRules.Tempo(mood)
                 });
                out_.AddRange(new List<double> {
                    life.Breathing,
                    life.BreathRate,
                    life.AversionRate,
                    life.SaccadeRate,
                    life.Blinks
                 });
                out_.AddRange(new List<double> { how.Droop, how.Lift, how.Lids, how.Smile, how.Frown, how.BrowDown });
                out_.AddRange(new List<double> { how.BrowUp, how.Thrust, how.Tension, how.Brows, how.Closed });
                out_.Add(MoodRules.Favour(mood, tags, given.Number()));
                out_.Add(Yes(MoodRules.MadeFor(mood, tags)));
                out_.Add(MoodRules.Distance(mood, "happy"));
                for (int n = 0; n < 4; n++)
                {
                    out_.Add(Yes(MoodRules.Stirs(mood, seed, tags[0] + PlainText.Of(n))));
                }
                var valence = given.Number();
                var arousal = given.Number();
                PutMood(out_, MoodRules.Changed(mood, valence, arousal, given.Number()));
            }
            else if (rule == "moods")
            {
                var base_ = MoodOf(given);
                var moods = new Moods(base_, Told(given));
                var start = given.Number();
                var edges = MoodRules.MoodEdges(moods, start, given.Number());
                out_.AddRange(edges);
                foreach (double edge in edges)
                {
                    PutMood(out_, MoodRules.MoodAt(moods, edge));
                }
            }
            else if (rule == "shown")
            {
                var count = Count(given);
                var starts = Rows(given, 1, count);
                var values = Rows(given, count, 3);
                PutMood(out_, MoodRules.Shown(starts[0], values, given.Number()));
            }
            else
            {
                var told = Told(given);
                foreach (MoodFrom one in MoodRules.Lasting(told, given.Number()))
                {
                    out_.AddRange(new List<double> { one.Start, one.End > Open ? Open : one.End });
                }
            }
            return out_;
        }

        // --- times
        private static List<double> Times(uint seed, string rule, RuleInput given)
        {
            var out_ = new List<double>();
            if (rule == "lull")
            {
                var key = given.Text();
                var talks = given.Number() > 0.0;
                out_.Add(DirectorRules.FindLull(seed, key, talks, given.Number()));
            }
            else if (rule == "intervals")
            {
                var count = Count(given);
                var share = given.Number();
                var beats = DirectorRules.BeatInterval("arms", count);
                out_.AddRange(new List<double> {
                    beats,
                    DirectorRules.BeatInterval("head", count),
                    DirectorRules.Posture("body"),
                    DirectorRules.Posture("arms"),
                    DirectorRules.Posture("head")
                 });
                out_.AddRange(new List<double> {
                    DirectorRules.RepeatInterval("gesture", share, beats),
                    DirectorRules.RepeatInterval("fidget", share, beats)
                 });
                out_.Add(DirectorRules.Freshness(given.Number(), beats));
            }
            else if (rule == "curves")
            {
                var x = given.Number();
                out_.AddRange(new List<double> {
                    MoodRules.Faded(x),
                    CueTimesRules.Ease(x),
                    MoodRules.Leaning(x, 4.0),
                    MoodRules.TurnExtent(1.25, x)
                 });
                out_.AddRange(new List<double> {
                    MoodRules.ShutIn(0.25, x),
                    MoodRules.ShutIn(0.75, x),
                    MoodRules.Drag(2.0, 1.0 + 0.5 * x * x)
                 });
                out_.Add(ChoiceRules.LogNormal(8.0, 14.0, 0.25 + 0.125 * x * x, 0.5));
            }
            return out_;
        }
    }
}
