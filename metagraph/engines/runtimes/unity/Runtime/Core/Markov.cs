// Translated from metagraph/playback/planning/markov.py; change that, and translate anew.
using System;
using System.Collections.Generic;
using System.Linq;

namespace Metagraph
{
    /// <summary>
    /// The Markov model that performs when there are no requests: a first-order chain over (limb, kind).
    ///
    /// The arms matrix is the paper's (Borer et al., figure 11), learned from annotated casual conversation. Body and head have
    /// no published matrix; theirs are ours, shaped on the paper's labels: the head nods and now and then changes its tilt, the
    /// body mostly rests, shifts and fidgets. The shares of what is performed in the modes idle, listening and talking are ours,
    /// too: the hands gesture with the character's own speech, and the head nods at the other's.
    /// </summary>
    public static class MarkovRules
    {
        // as in `Markov.modes`
        public static readonly List<string> Kinds = new List<string> { "gesture", "fidget", "transition" };
        public const int Listens = 1; // place of the row that stands for modes of which a model says nothing
        public static readonly Cursor Begin = new Cursor();
        public const double Rests = 0.9; // standard deviation of rests, times their mean

        /// <summary>
        /// Return the meta actions that start before `until` seconds, from the cursor on, and the cursor before the first one
        /// left out.
        ///
        /// Rests are log-normal about the mean gap (`rest_length`): most are short, some long, as people's are. Windows are as
        /// `length` says. kinds: those that the graph has; states of other kinds are passed over, so that half-filled graphs
        /// perform, too.
        ///
        /// Each draw is keyed by the meta action's number. So a longer horizon only appends, and continuing from a cursor gives
        /// bit for bit the same as writing in one go. After a row of zeros, the chain starts again from any state.
        /// </summary>
        public static (List<MetaAction>, Cursor) Write(
            Markov chain,
            uint seed,
            double until,
            HashSet<string> kinds = null,
            Cursor cursor = null
        )
        {
            cursor = cursor ?? Begin;
            var number = cursor.Number;
            var state = cursor.State;
            var time = cursor.Time;
            var openTo = chain.States.Select(pair => (kinds == null || kinds.Contains(pair.Item2)) ? 1.0 : 0.0).ToList();
            var rows = new Dictionary<int, Dictionary<string, double>>();
            var out_ = new List<MetaAction>();
            var able = openTo.Any(p => p > 0);
            while (able)
            {
                var ident = "auto/" + chain.Layer + "/" + PlainText.Of(number);
                var key = ChoiceRules.Keyed(seed, ident);
                var start = time + RestLength(chain, key);
                if (!(start < until)) // nor when it is no number
                {
                    break;
                }
                if (!rows.ContainsKey(state))
                {
                    rows[state] = Row(chain, state, openTo);
                }
                state = PlainText.Whole(ChoiceRules.Picked(key, "state", rows[state]));
                var found = chain.States[state];
                string limb = found.Item1;
                string kind = found.Item2;
                var seconds = Length(chain, state, key);
                var tags = PlainText.Words(chain.Tag(state)).ToList();
                if (kind == "gesture" && chain.Tags.Count == 0)
                {
                    var draw = ChoiceRules.ChanceOf(key, "tag");
                    if (draw < chain.Positive)
                    {
                        tags = new List<string> { "positive" };
                    }
                    else if (draw < chain.Positive + chain.Negative)
                    {
                        tags = new List<string> { "negative" };
                    }
                }
                var request = new MetaRequest(
                    ident,
                    chain.Layer,
                    kind,
                    start,
                    seconds,
                    null,
                    tags,
                    limb,
                    null,
                    MetaPlanRules.Written
                );
                out_.Add(new MetaAction(request, start, start + seconds, 0, true));
                number = number + 1;
                time = start + seconds;
            }
            return (out_, new Cursor(number, state, time));
        }

        /// <summary>
        /// Return the probability of each state that may follow a state (-1: before the first), by its index; of all allowed
        /// states if none may follow.
        /// </summary>
        private static Dictionary<string, double> Row(Markov chain, int state, List<double> openTo)
        {
            var row = openTo.ToList();
            if (0 <= state && state < row.Count)
            {
                row = chain.Matrix[state].Zip(openTo, (p, may) => p * may).ToList();
            }
            if (!row.Any(p => p > 0))
            {
                row = openTo.ToList();
            }
            return row.Select((item, n) => (n, item)).Where(pair => pair.Item2 > 0).Select(pair => (
                PlainText.Of(pair.Item1),
                pair.Item2
            )).ToMap();
        }

        /// <summary>
        /// Return whether something that the model wrote is performed in a mode (`Markov.modes`). What is left out does not
        /// change the rest, so it does not matter when a mode became known.
        /// </summary>
        public static bool Performs(Markov chain, uint seed, MetaAction meta, string mode)
        {
            if (chain.Modes.Count == 0 || !Kinds.Contains(meta.Request.Kind))
            {
                return true;
            }
            var place = WordsRules.Modes.IndexOf(mode);
            var row = chain.Modes[place < chain.Modes.Count ? place : Listens];
            var share = row[Kinds.IndexOf(meta.Request.Kind)];
            return share >= 1 || ChoiceRules.Uniform(seed, meta.Request.Id, "mode") < share;
        }

        /// <summary>
        /// Return how many seconds a meta action of a key lasts: uniform from 1 to 3 if the model has no lengths; else log-normal
        /// with the state's mean and standard deviation.
        /// </summary>
        public static double Length(Markov chain, int state, uint key)
        {
            if (chain.Lengths.Count == 0)
            {
                return 1.0 + 2.0 * ChoiceRules.ChanceOf(key, "length");
            }
            var found = chain.Lengths[state];
            double mean = found.Item1;
            double deviation = found.Item2;
            return ChoiceRules.LogNormal(
                mean,
                deviation,
                ChoiceRules.ChanceOf(key, "length"),
                ChoiceRules.ChanceOf(key, "length2")
            );
        }

        /// <summary>
        /// Return how many seconds of rest come before a meta action of a key: log-normal with the mean `chain.gap`, between a
        /// fifth and five times of it.
        /// </summary>
        public static double RestLength(Markov chain, uint key)
        {
            var drawn = ChoiceRules.LogNormal(
                chain.Gap,
                Rests * chain.Gap,
                ChoiceRules.ChanceOf(key, "gap"),
                ChoiceRules.ChanceOf(key, "gap2")
            );
            return Math.Min(5.0 * chain.Gap, Math.Max(0.2 * chain.Gap, drawn));
        }
    }
}
