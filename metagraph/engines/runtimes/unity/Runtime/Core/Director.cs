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
        public const double Stale = 0.05; // least factor of the likelihood of what has just been played
        public const double LeavesHome = 0.2; // share of the written tilts of the head that leave the stance it begins in
        public const double GoesHome = 0.7; // share of the written moves of a tilted head that go back there

        /// <summary>
        /// Return after how many seconds an action may be done again.
        ///
        /// That is 18 s for a beat that hardly shows, six minutes for a gesture that stands out, and 4 to 10 minutes for fidgets,
        /// which only time calls for. prominence: 0..1.
        /// </summary>
        public static double RepeatInterval(string kind, double prominence)
        {
            if (kind == "gesture")
            {
                return 18.0 * Math.Exp(Math.Log(20.0) * prominence);
            }
            return 240.0 * Math.Exp(Math.Log(2.5) * prominence);
        }

        /// <summary>Return how many seconds a stance is kept at least before the model changes it.</summary>
        public static double Posture(string layer)
        {
            if (layer == "body")
            {
                return 15.0;
            }
            return layer == "arms" ? 10.0 : 8.0;
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
