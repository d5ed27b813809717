using System.Collections.Generic;
using System.Linq;

namespace Metagraph
{
    /// <summary>From asks at any level of abstraction to what the planner and the life layers work with.</summary>
    internal static class Understood
    {
        /// <summary>
        /// What asks mean. now: when those begin that do not say; soon: when it is said, for what is said. An ask that makes several requests gives them ids of its own:
        /// its id, then id.1, id.2, ...
        /// </summary>
        public static Meaning From(Graph graph, IEnumerable<Ask> asks, double now, double soon)
        {
            var all = new Meaning(graph, Basics.Layers.Select(layer => graph.Layers[layer]).ToList(), Alphabet.Common);
            foreach (Ask ask in asks)
            {
                try
                {
                    MeaningRules.Understood(all, Plain(graph, ask), now, soon);
                }
                catch (AskException error)
                {
                    all.Refuse(ask.Id, error.Message, ask.Layer, ask.At ?? now);
                }
            }
            foreach (AskedBlock block in all.Blocks)
            {
                all.Refuse(block.Id, "BML is read by the desktop only; send requests instead", null, block.At);
            }
            return all;
        }

        /// <summary>An ask with every field that any has. Raises AskException for times that make no sense.</summary>
        private static PlainAsk Plain(Graph graph, Ask ask)
        {
            LineTiming timing = ask.Do == "say" ? ToldTiming.Of(ask.Words, ask.Visemes, ask.Characters, ask.Set, ask.Duration) : null;
            SaidLine said = ask.Do == "say" && ask.Line != null && graph.Lines.ContainsKey(ask.Line) ? Said(graph, ask) : null;
            List<double> point = ask.Point == null ? new List<double>() : ask.Point.ToList();
            return new PlainAsk(
                ask.Do, ask.Id, ask.At, ask.Priority, ask.Layer, ask.Tags.ToList(), ask.Limb, ask.Duration, ask.Stroke, ask.Hold, ask.Late,
                ask.Valence, ask.Arousal, ask.Intensity, ask.Prepare, ask.Resume, ask.Stay, ask.Action ?? "", ask.Stance ?? "", ask.To,
                ask.Amount, ask.Strict, ask.Line, said, ask.Text, ask.Gestures, timing, ask.Mode, ask.Name ?? "", point, ask.What,
                ask.More);
        }

        private static SaidLine Said(Graph graph, Ask ask)
        {
            Line line = graph.Lines[ask.Line];
            IEnumerable<Ask> asks = ask.Gestures ? line.Asks : new List<Ask>();
            return new SaidLine(
                line.Text, line.Voice != null ? line.Voice.Duration : line.Duration,
                asks.Select(inner => inner.Do == "say" ? new PlainAsk("say") : Plain(graph, inner)).ToList(),
                line.Mood.Valence, line.Mood.Arousal, line.Mood.Intensity);
        }
    }
}
