using System;
using System.Collections.Generic;
using System.Globalization;

namespace Metagraph
{
    /// <summary>The model that performs when nobody asks for anything: a first-order chain over (limb, kind).</summary>
    internal static class Markov
    {
        private static readonly string[] Performed = { "gesture", "fidget", "transition" }; // as in a row of the modes

        /// <summary>
        /// Append the meta actions that start before `until` seconds, from the cursor on; return the cursor before the first one left
        /// out. Rests are drawn between 0.35 and 1.65 times the mean gap. Each draw is keyed by the meta action's number, so a longer
        /// horizon only appends.
        /// </summary>
        public static Cursor Write(LayerGraph graph, uint seed, double until, Cursor cursor, List<MetaAction> found)
        {
            MarkovModel chain = graph.Markov;
            int count = chain.Limbs.Length, number = cursor.Number, state = cursor.State;
            double time = cursor.Time;
            var open = new double[count]; // states of kinds the layer has no action of are passed over
            for (int i = 0; i < count; i++)
            {
                open[i] = graph.HasKind(chain.Kinds[i]) ? 1.0 : 0.0;
            }
            while (Array.Exists(open, x => x > 0))
            {
                string key = "auto/" + graph.Layer + "/" + Word(number);
                double start = time + chain.Gap * (0.35 + 1.3 * Choice.Uniform(seed, key, "gap"));
                if (start >= until)
                {
                    break;
                }
                state = int.Parse(Choice.Pick(seed, key, "state", Row(chain, state, open)), CultureInfo.InvariantCulture);
                double seconds = Length(chain, state, seed, key);
                string[] tags = Basics.None;
                if (chain.Tags.Length > 0)
                {
                    tags = chain.Tags[state].Split((char[])null, StringSplitOptions.RemoveEmptyEntries);
                }
                else if (chain.Kinds[state] == "gesture")
                {
                    double draw = Choice.Uniform(seed, key, "tag");
                    string tag = draw < chain.Positive ? "positive" : draw < chain.Positive + chain.Negative ? "negative" : null;
                    tags = tag == null ? tags : new[] { tag };
                }
                var request = new Request
                {
                    Id = key, Layer = graph.Layer, Kind = chain.Kinds[state], Start = start, Duration = seconds, Tags = tags,
                    Limb = chain.Limbs[state], Priority = 0,
                };
                found.Add(new MetaAction(request, start, start + seconds, 0, true));
                number++;
                time = start + seconds;
            }
            return new Cursor { Number = number, State = state, Time = time };
        }

        /// <summary>Whether something the model wrote is performed while somebody idles, listens or talks; null where that is not known.</summary>
        public static bool Performs(MarkovModel chain, uint seed, MetaAction meta, string mode)
        {
            int place = Array.IndexOf(Performed, meta.Request.Kind);
            if (chain.Modes.Length == 0 || mode == null || place < 0)
            {
                return true;
            }
            double share = chain.Modes[Array.IndexOf(Basics.Modes, mode)][place];
            return share >= 1 || Choice.Uniform(seed, meta.Request.Id, "mode") < share;
        }

        /// <summary>The chances of the next state; all alike where nothing leads on.</summary>
        private static List<KeyValuePair<string, double>> Row(MarkovModel chain, int state, double[] open)
        {
            var row = (double[])open.Clone();
            if (state >= 0 && state < open.Length)
            {
                for (int i = 0; i < row.Length; i++)
                {
                    row[i] *= chain.Matrix[state][i];
                }
            }
            double[] chosen = Array.Exists(row, x => x != 0) ? row : open;
            var weights = new List<KeyValuePair<string, double>>();
            for (int i = 0; i < chosen.Length; i++)
            {
                weights.Add(new KeyValuePair<string, double>(Word(i), chosen[i]));
            }
            return weights;
        }

        /// <summary>Seconds of a meta action: 1 to 3, evenly, where the model has no lengths, else log-normal.</summary>
        private static double Length(MarkovModel chain, int state, uint seed, string key)
        {
            double u = Choice.Uniform(seed, key, "length");
            if (chain.Lengths.Length == 0)
            {
                return 1.0 + 2.0 * u;
            }
            double mean = chain.Lengths[state][0], deviation = chain.Lengths[state][1];
            double spread = Math.Log(1.0 + deviation / mean * (deviation / mean));
            double z = Math.Sqrt(-2.0 * Math.Log(u)) * Math.Cos(2.0 * Math.PI * Choice.Uniform(seed, key, "length2"));
            return mean * Math.Exp(Math.Sqrt(spread) * z - spread / 2.0);
        }

        private static string Word(int number)
        {
            return number.ToString(CultureInfo.InvariantCulture);
        }
    }
}
