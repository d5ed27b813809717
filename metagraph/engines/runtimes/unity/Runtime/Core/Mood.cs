// Translated from metagraph/playback/planning/mood.py; change that, and translate anew.
using System;
using System.Collections.Generic;
using System.Linq;

namespace Metagraph
{
    /// <summary>valence, arousal: -1..1. intensity: 0..2, 1 is normal.</summary>
    public sealed class Mood
    {
        public readonly double Valence;
        public readonly double Arousal;
        public readonly double Intensity;

        public Mood(double valence = 0.0, double arousal = 0.0, double intensity = 1.0)
        {
            Valence = valence;
            Arousal = arousal;
            Intensity = intensity;
        }

        /// <summary>Whether it changes nothing.</summary>
        public bool Neutral
        {
            get
            {
                return Valence == 0 && Arousal == 0 && Intensity == 1;
            }
        }

        /// <summary>Whether it is the same.</summary>
        public bool Like(Mood other)
        {
            return Valence == other.Valence && Arousal == other.Arousal && Intensity == other.Intensity;
        }
    }

    /// <summary>
    /// A mood that holds from `start` until `end`; a field that it leaves out stays as it is without it. If two hold at once, the
    /// one that began later counts. When it is over, the other counts again.
    /// </summary>
    public sealed class MoodFrom
    {
        public readonly string Id;
        public readonly double Start;
        public readonly double? Valence;
        public readonly double? Arousal;
        public readonly double? Intensity;
        public readonly double End;

        public MoodFrom(
            string id,
            double start,
            double? valence = null,
            double? arousal = null,
            double? intensity = null,
            double end = double.PositiveInfinity
        )
        {
            Id = id;
            Start = start;
            Valence = valence;
            Arousal = arousal;
            Intensity = intensity;
            End = end;
        }
    }

    /// <summary>The mood over time. base: the mood where no other holds; told: the others, by start.</summary>
    public sealed class Moods
    {
        public readonly Mood Base;
        public readonly List<MoodFrom> Told;

        public Moods(Mood base_ = null, List<MoodFrom> told = null)
        {
            Base = base_ ?? new Mood();
            Told = told ?? new List<MoodFrom>();
        }
    }

    /// <summary>
    /// The factors by which a mood changes the amounts and rates of the life layers, as those of a manner.
    /// </summary>
    public sealed class LifeMood
    {
        public readonly double Breathing;
        public readonly double BreathRate;
        public readonly double AversionRate;
        public readonly double SaccadeRate;
        public readonly double Blinks;

        public LifeMood(double breathing, double breathRate, double aversionRate, double saccadeRate, double blinks)
        {
            Breathing = breathing;
            BreathRate = breathRate;
            AversionRate = aversionRate;
            SaccadeRate = saccadeRate;
            Blinks = blinks;
        }
    }

    /// <summary>
    /// Posture and face of a mood. droop: -0.4 upright .. 1 bowed. lift: of the shoulders, in breaths. lids: how far they hang,
    /// 0..1, or are open wide, below 0. smile, frown, brow_down, brow_up, brows: weights of the face, 0..1. thrust: how far the
    /// body leans forward, 0..1, or draws back, below 0. tension: of shoulders, arms and hands, 0..1. closed: how close the arms
    /// are kept, 0..1.
    /// </summary>
    public sealed class Bearing
    {
        public readonly double Droop;
        public readonly double Lift;
        public readonly double Lids;
        public readonly double Smile;
        public readonly double Frown;
        public readonly double BrowDown;
        public readonly double BrowUp;
        public readonly double Thrust;
        public readonly double Tension;
        public readonly double Brows;
        public readonly double Closed;

        public Bearing(
            double droop = 0.0,
            double lift = 0.0,
            double lids = 0.0,
            double smile = 0.0,
            double frown = 0.0,
            double browDown = 0.0,
            double browUp = 0.0,
            double thrust = 0.0,
            double tension = 0.0,
            double brows = 0.0,
            double closed = 0.0
        )
        {
            Droop = droop;
            Lift = lift;
            Lids = lids;
            Smile = smile;
            Frown = frown;
            BrowDown = browDown;
            BrowUp = browUp;
            Thrust = thrust;
            Tension = tension;
            Brows = brows;
            Closed = closed;
        }
    }

    public static class MoodRules
    {
        public const double Fade = 1.5; // seconds in which posture and face go from one mood to the next
        public const double LeastExtent = 0.6;
        public const double MostExtent = 1.25;
        public const double LeastTempo = 0.75;
        public const double MostTempo = 1.25;
        public const double Close = 0.5; // an action that is tagged with a mood no farther away than this was made for it
        public const string Pleasant = "positive"; // tags
        public const string Unpleasant = "negative";
        public const double AngryFrom = 0.02; // unpleasantness from which an excited mood is angry
        public const double AngryWide = 0.1; // and by how much more it is altogether
        public const double FearFrom = 0.15; // the same of fear
        public const double FearWide = 0.18;
        public const string Held = "contact"; // tag of actions that touch something: smaller or larger they would miss it
        // Named moods: valence, arousal. Directions are Russell's (1980, table of 28 words, by circular scaling): calm
        // 316.2, content 323, happy 7.8, excited 48.6, tense 92.8, angry 99, afraid 116, sad 207.5, bored 242 and
        // tired 267.7 degrees, at 0.8 from the middle, which is ours. "warm" is ours.
        public static readonly Dictionary<string, (double, double)> Moods = new Dictionary<string, (double, double)> {
            { "neutral", (0.0, 0.0) },
            { "calm", (0.58, -0.55) },
            { "content", (0.64, -0.48) },
            { "warm", (0.6, 0.1) },
            { "happy", (0.79, 0.11) },
            { "excited", (0.53, 0.6) },
            { "tense", (-0.04, 0.8) },
            { "angry", (-0.13, 0.79) },
            { "afraid", (-0.35, 0.72) },
            { "sad", (-0.71, -0.37) },
            { "bored", (-0.38, -0.71) },
            { "tired", (-0.03, -0.8) }
         };

        /// <summary>Return a mood with the given fields changed, each limited to its range.</summary>
        public static Mood Changed(Mood mood, double? valence, double? arousal, double? intensity)
        {
            return new Mood(
                valence == null ? mood.Valence : Within(valence.Value, -1.0, 1.0),
                arousal == null ? mood.Arousal : Within(arousal.Value, -1.0, 1.0),
                intensity == null ? mood.Intensity : Within(intensity.Value, 0.0, 2.0)
            );
        }

        /// <summary>Return the mood that holds at a time; posture and face follow it slowly (`shown`).</summary>
        public static Mood MoodAt(Moods moods, double seconds)
        {
            var out_ = moods.Base;
            foreach (MoodFrom told in moods.Told)
            {
                if (told.Start > seconds)
                {
                    break;
                }
                if (seconds < told.End)
                {
                    out_ = Changed(out_, told.Valence, told.Arousal, told.Intensity);
                }
            }
            return out_;
        }

        /// <summary>
        /// Return the moods that may still show at `seconds` or later: without those that are over and have faded, and without
        /// those that a mood without an end has replaced.
        /// </summary>
        public static List<MoodFrom> Lasting(List<MoodFrom> told, double seconds)
        {
            var out_ = new List<MoodFrom>();
            foreach (var pair in told.Select((item, n) => (n, item)))
            {
                var place = pair.Item1;
                var one = pair.Item2;
                if (one.End <= seconds - Fade)
                {
                    continue;
                }
                if (!PlainLists.Part(told, place + 1).Any(other => Replaces(other, one, seconds)))
                {
                    out_.Add(one);
                }
            }
            return out_;
        }

        private static bool Replaces(MoodFrom later, MoodFrom one, double seconds)
        {
            return later.End == double.PositiveInfinity
                && later.Start <= seconds - Fade
                && (one.Valence == null || later.Valence != null)
                && (one.Arousal == null || later.Arousal != null)
                && (one.Intensity == null || later.Intensity != null);
        }

        /// <summary>
        /// Return the times from `start` to before `end` at which the mood may change, ascending, `start` first.
        /// </summary>
        public static List<double> MoodEdges(Moods moods, double start, double end)
        {
            var edges = new List<double> { start };
            foreach (MoodFrom told in moods.Told)
            {
                foreach (double edge in new List<double> { told.Start, told.End })
                {
                    if (start < edge && edge < end && !edges.Contains(edge))
                    {
                        edges.Add(edge);
                    }
                }
            }
            return edges.OrderBy(x => x).ToList();
        }

        /// <summary>Return how much of a change shows after `x` of its fade: 3x^2 - 2x^3 of x clamped to 0..1.</summary>
        public static double Faded(double x)
        {
            var y = Within(x, 0.0, 1.0);
            return y * y * (3 - 2 * y);
        }

        /// <summary>
        /// Return the mood that shows at a time, while it fades from the previous ones. starts: when each begins, ascending;
        /// values: valence, arousal, intensity of each. Before the first it is the first.
        /// </summary>
        public static Mood Shown(List<double> starts, List<List<double>> values, double seconds)
        {
            var place = starts.Count - 1;
            while (place > 0 && starts[place] > seconds)
            {
                place -= 1;
            }
            if (place < 0)
            {
                return new Mood();
            }
            var valence = 0.0;
            var arousal = 0.0;
            var intensity = 0.0;
            var left = 1.0;
            while (left > 0)
            {
                var share = left;
                if (place > 0)
                {
                    share = Math.Min(left, Faded((seconds - starts[place]) / Fade) - (1 - left));
                }
                valence += share * values[place][0];
                arousal += share * values[place][1];
                intensity += share * values[place][2];
                left -= share;
                place -= 1;
            }
            return new Mood(valence, arousal, intensity);
        }

        /// <summary>Return a number clamped to a range.</summary>
        public static double Within(double x, double low, double high)
        {
            return Math.Min(Math.Max(x, low), high);
        }

        /// <summary>Return 1 at 0, `most` at 1 and 1 / `most` at -1, and beyond as there; smooth and rising.</summary>
        public static double Leaning(double x, double most)
        {
            var y = Within(x, -1.0, 1.0) * (most - 1) / (most + 1);
            return (1 + y) / (1 - y);
        }

        /// <summary>
        /// Return how lively a mood is, -1..1: its arousal, plus some if it is pleasant, less if it is unpleasant and not
        /// exciting.
        /// </summary>
        public static double Liveliness(Mood mood)
        {
            var well = Math.Max(0.0, mood.Valence);
            var ill = Math.Max(0.0, -mood.Valence);
            var calm = 1 - Math.Max(0.0, mood.Arousal);
            return Within(mood.Arousal + 0.5 * well - 0.6 * ill * calm, -1.0, 1.0);
        }

        /// <summary>Return how afraid a mood is, 0..1.</summary>
        public static double Fear(Mood mood)
        {
            var much = Math.Min(1.0, 1.25 * Math.Max(0.0, mood.Arousal));
            return much * Faded((-mood.Valence - FearFrom) / FearWide);
        }

        /// <summary>Return how angry a mood is, 0..1.</summary>
        public static double Anger(Mood mood)
        {
            var much = Math.Min(1.0, 1.25 * Math.Max(0.0, mood.Arousal));
            return much * Faded((-mood.Valence - AngryFrom) / AngryWide) - Fear(mood);
        }

        /// <summary>
        /// Return how large gestures and fidgets of arms and head are played: a factor of their turns away from the stance.
        /// </summary>
        public static double Extent(Mood mood)
        {
            var size = Within(Liveliness(mood) - 1.5 * Fear(mood), -1.0, 1.0);
            var byMood = size > 0 ? 1 + 0.25 * size : 1 + 0.4 * size;
            var dial = mood.Intensity - 1;
            var byDial = dial > 0 ? 1 + 0.25 * dial : 1 + 0.4 * dial;
            return Within(byMood * byDial, LeastExtent, MostExtent);
        }

        /// <summary>Return how fast actions are played: a factor of their own speed.</summary>
        public static double Tempo(Mood mood)
        {
            return Within(1 + 0.25 * Liveliness(mood), LeastTempo, MostTempo);
        }

        /// <summary>
        /// Return how much longer clip seconds take at a speed than at their own speed, exactly 0 at that speed.
        /// </summary>
        public static double Drag(double seconds, double speed)
        {
            return seconds * (((double)1 / speed) - 1);
        }

        /// <summary>
        /// Return how far a joint turns away from its stance, a factor, for that of a cue. real: the real part of the original
        /// rotation, a unit quaternion. Rotations of nearly half a circle, whose short way changes sides, stay as they are.
        /// </summary>
        public static double TurnExtent(double factor, double real)
        {
            return 1 + (factor - 1) * Faded((Math.Abs(real) - 0.1) / 0.4);
        }

        /// <summary>Return whether an action was made for a mood: whether it has the tag of a mood that is near.</summary>
        public static bool MadeFor(Mood mood, List<string> tags)
        {
            return tags.Any(tag => Moods.ContainsKey(tag) && Distance(mood, tag) <= Close);
        }

        /// <summary>Return how far a mood is from a named one, 0..2.8.</summary>
        public static double Distance(Mood mood, string name)
        {
            var found = Moods[name];
            double valence = found.Item1;
            double arousal = found.Item2;
            var x = mood.Valence - valence;
            var y = mood.Arousal - arousal;
            return Math.Sqrt(x * x + y * y);
        }

        /// <summary>
        /// Return the factor of an action's likelihood. vigour: how energetic it is compared with others of its layer and kind,
        /// -1..1. The factor is up to 4 for vigour, 4 for a tag of valence and 9 for a tag that names a mood, and the inverse if
        /// they contradict the mood.
        /// </summary>
        public static double Favour(Mood mood, List<string> tags, double vigour)
        {
            var out_ = Leaning(vigour * Within(Liveliness(mood) + (mood.Intensity - 1), -1.0, 1.0), 4.0);
            if (tags.Contains(Pleasant))
            {
                out_ *= Leaning(mood.Valence, 4.0);
            }
            if (tags.Contains(Unpleasant))
            {
                out_ *= Leaning(-mood.Valence, 4.0);
            }
            var strength = Math.Min(1.0, Math.Sqrt(mood.Valence * mood.Valence + mood.Arousal * mood.Arousal) / Close);
            foreach (string tag in tags)
            {
                if (Moods.ContainsKey(tag))
                {
                    out_ *= Leaning(strength * (1 - Distance(mood, tag) / Close), 9.0);
                }
            }
            return out_;
        }

        /// <summary>
        /// Return whether something that a model wrote is performed in a mood: less of it in a less lively mood, down to 0.6.
        /// </summary>
        public static bool Stirs(Mood mood, uint seed, string key)
        {
            var lively = Liveliness(mood);
            return lively >= 0 || ChoiceRules.Uniform(seed, key, "mood") < 1 + 0.4 * lively;
        }

        /// <summary>
        /// Return how a mood changes the life layers. With arousal, breath is quicker and deeper, and eyes dart and blink more.
        /// In an unpleasant mood the character looks away more, in a pleasant one less. The amounts are ours.
        /// </summary>
        public static LifeMood LifeOf(Mood mood)
        {
            var a = mood.Arousal;
            var v = mood.Valence;
            return new LifeMood(
                1 + 0.25 * a,
                a > 0 ? 1 + 0.4 * a : 1 + 0.25 * a,
                v < 0 ? 1 - 0.4 * v : 1 - 0.25 * v,
                1 + 0.4 * a,
                a > 0 ? 1 + 0.4 * a : 1 + 0.25 * a
            );
        }

        /// <summary>
        /// Return posture and face of a mood, stronger with its intensity. The head bows with sadness (Roether et al. 2009);
        /// shoulders rise, fists close and the body leans forward with arousal that is not joy; fear draws back (Coulson 2004);
        /// the amounts are ours.
        /// </summary>
        public static Bearing Bearing(Mood mood)
        {
            var v = mood.Valence;
            var a = mood.Arousal;
            var i = mood.Intensity;
            var up = Math.Max(0.0, a);
            var down = Math.Max(0.0, -a);
            var well = Math.Max(0.0, v);
            var ill = Math.Max(0.0, -v);
            var scared = Fear(mood);
            var cross = Anger(mood);
            return new Bearing(
                Within(i * (-0.7 * v - 0.5 * a), -0.4, 1.0),
                Within(i * (2.0 * up * (1 - well) + 4.5 * scared - 1.5 * down - ill * (1 - up)), -2.0, 6.0),
                Within(i * (0.5 * down - 0.5 * scared - 0.15 * cross - 1.1 * up * well), -0.6, 0.5),
                Within(i * well * (1.2 + 0.3 * up - 0.6 * down), 0.0, 1.0),
                Within(i * (1.4 * ill * (1 - up) * (1 - 0.6 * down) + 0.35 * cross + 0.4 * scared), 0.0, 1.0),
                Within(i * (0.5 * up * Math.Max(0.0, 0.4 - v) + 0.8 * cross) * (1 - scared), 0.0, 1.0),
                Within(i * (2.0 * ill * (1 - up) * (1 - down) + 0.9 * scared), 0.0, 1.0),
                Within(i * (0.3 * up * Math.Max(0.0, 0.3 - v) + 0.9 * cross - 0.7 * scared), -1.0, 1.0),
                Within(i * 1.2 * up * Math.Max(0.0, 1.0 - 2.0 * well) * (1 - 0.8 * scared), 0.0, 1.0),
                Within(i * (0.6 * scared + 1.6 * up * well), 0.0, 1.0),
                Within(i * (0.5 * scared + 0.4 * ill * (1 - up)), 0.0, 1.0)
            );
        }

        /// <summary>
        /// Return how far lids are shut: as far as a blink shuts them or, if they hang farther, as far as they do; below 0 where
        /// they are open wide.
        /// </summary>
        public static double ShutIn(double blink, double lids)
        {
            return lids > 0 ? Math.Max(blink, lids) : blink + lids * (1 - blink);
        }
    }
}
