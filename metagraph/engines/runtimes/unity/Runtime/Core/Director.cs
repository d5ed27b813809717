// Translated from metagraph/playback/planning/director.py; change that, and translate anew.
using System;
using System.Collections.Generic;
using System.Linq;

namespace Metagraph
{
    /// <summary>
    /// What keeps a performance from repeating itself and from being restless: how soon an action is done again, how long a
    /// posture is kept, how far apart acts are that stand out.
    ///
    /// Only what the Markov model writes is held back. Requests always play; of the actions that fit a request, those that have
    /// not played for long enough are likelier. `Settings.variety` multiplies every time here; 0 turns all of it off, as in Borer
    /// et al. The times are ours, chosen by what an hour of the sample then does (`docs/researchers/behaviour.md`).
    /// </summary>
    public static class DirectorRules
    {
        public const double StandsOut = 0.65; // prominence from which on an act is one that a viewer remembers
        public const double Apart = 30.0; // seconds between two of those on one layer
        public const double LongRest = 30.0; // seconds of rest after which actions need to have rested only `SHORTER` as long
        public const double Shorter = 0.3;
        public const double LeastBeats = 18.0; // seconds after which a gesture that hardly shows is done again, at least
        public const double MostBeats = 180.0; // and at most
        public const double Each = 7.0; // seconds of those for each gesture of the arms that the character has
        public const double Stale = 0.05; // least factor of the likelihood of what has just been played
        public const double EndsBurst = 0.25; // share of the acts of one who talks that end a burst: some 2.5 acts, then a rest
        public const double LeastLull = 5.0; // seconds of that rest at least
        public const double MostLull = 30.0; // and at most
        public const double Lull = 8.0; // its mean before it is clamped
        public const double LullSpread = 14.0; // and its standard deviation
        public const double LeavesHome = 0.2; // share of the written tilts of the head that leave the stance it begins in
        public const double GoesHome = 0.7; // share of the written moves of a tilted head that go back there
        public const double Muses = 2.0; // seconds that a thought goes on at least for which a hand goes to the chin
        public const double Mused = 10.0; // seconds after a thought in which anything that is written takes the hand away again
        // words of such a stance's name
        public static readonly List<string> Thoughtful = new List<string> { "chin", "thinking", "pondering", "musing" };

        /// <summary>Return the first stance of the arms whose name says that one thinks in it; "" for none.</summary>
        public static string Musing(Dictionary<string, Stance> stances)
        {
            foreach (var one in stances)
            {
                var ident = one.Key;
                var stance = one.Value;
                foreach (string word in PlainText.Words(stance.Name.ToLowerInvariant()))
                {
                    if (Thoughtful.Contains(word) || Thoughtful.Contains(PlainText.PartedLast(word, "_").Item3))
                    {
                        return ident;
                    }
                }
            }
            return "";
        }

        /// <summary>
        /// Return after how many seconds a gesture that hardly shows may be done again: with many gestures of the arms, not for
        /// minutes; with few, soon. gestures: how many the layer has.
        /// </summary>
        public static double BeatInterval(string layer, int gestures)
        {
            if (layer != "arms")
            {
                return LeastBeats;
            }
            return Math.Min(MostBeats, Math.Max(LeastBeats, Each * gestures));
        }

        /// <summary>
        /// Return after how many seconds an action may be done again.
        ///
        /// That is from `beats` (`beat_interval`) to six minutes for gestures, the longer the more they stand out, and 5 to 10
        /// minutes for fidgets, which only time calls for. prominence: 0..1.
        /// </summary>
        public static double RepeatInterval(string kind, double prominence, double beats)
        {
            if (kind == "gesture")
            {
                return beats * Math.Exp(Math.Log(360.0 / beats) * prominence);
            }
            return 300.0 * Math.Exp(Math.Log(2.0) * prominence);
        }

        /// <summary>Return how many seconds a stance is kept at least before the model changes it.</summary>
        public static double Posture(string layer)
        {
            if (layer == "body")
            {
                return 25.0;
            }
            return layer == "arms" ? 10.0 : 8.0;
        }

        /// <summary>
        /// Return how many seconds the arms rest at least after an act of theirs: nothing within a burst of one who talks, else
        /// from `LEAST_LULL` to `MOST_LULL`. key: of the act's meta action.
        /// </summary>
        public static double FindLull(uint seed, string key, bool talks, double variety)
        {
            if (talks && ChoiceRules.Uniform(seed, key, "burst") >= EndsBurst)
            {
                return 0.0;
            }
            var drawn = ChoiceRules.LogNormal(
                Lull,
                LullSpread,
                ChoiceRules.Uniform(seed, key, "lull"),
                ChoiceRules.Uniform(seed, key, "lull2")
            );
            return Math.Min(MostLull, Math.Max(LeastLull, drawn) * variety);
        }

        /// <summary>
        /// Return the factor of an action's likelihood. since: seconds since it ended; needed: its interval.
        /// </summary>
        public static double Freshness(double since, double needed)
        {
            if (since >= needed)
            {
                return 1.0;
            }
            return Math.Max(Stale, since / needed);
        }
    }
}
