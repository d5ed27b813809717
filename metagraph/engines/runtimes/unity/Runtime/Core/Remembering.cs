// Translated from metagraph/playback/planning/remembering.py; change that, and translate anew.
using System;
using System.Collections.Generic;
using System.Linq;

namespace Metagraph
{
    /// <summary>What the planner remembers of played actions: how often each played lately, and until when.</summary>
    public static class RememberingRules
    {
        public const int Remembered = 32; // draws of a stance and kind that spacing can look back on

        /// <summary>Return the key under which draws of a stance and kind are remembered.</summary>
        public static string Node(string stance, string kind)
        {
            return kind + " " + stance;
        }

        /// <summary>Return whether at least this many other draws came after an action's last one.</summary>
        public static bool Rested(List<string> recent, string ident, int needed)
        {
            if (needed <= 0)
            {
                return true;
            }
            return needed <= Remembered && !PlainLists.Part(recent, Math.Max(0, recent.Count - needed)).Contains(ident);
        }

        /// <summary>Note that a cue was played: count its action, and note when it ended.</summary>
        public static void Remember(
            Cue cue,
            Dictionary<string, int> uses,
            Dictionary<string, List<string>> recent,
            Dictionary<string, double> ended
        )
        {
            var ident = cue.Action.Id;
            var place = Node(cue.Stance, cue.Action.Kind);
            uses[ident] = PlainMaps.GetOr(uses, ident, 0) + 1;
            recent[place] = PlainLists.Part(PlainMaps.GetOr(recent, place, new List<string>()), 1 - Remembered).Concat(new List<string> { ident }).ToList();
            ended[ident] = cue.End;
        }
    }
}
