using System;
using System.Collections.Generic;
using System.Linq;

namespace Metagraph
{
    /// <summary>
    /// What asks mean for the layers and for the track. Withdrawn: ids taken back; every id where it holds "". Refused: what could
    /// not be understood, and why.
    /// </summary>
    internal sealed class Understood
    {
        private const double Forever = 1e9; // seconds; a look that lasts until the next

        public readonly List<MetaRequest> Requests = new List<MetaRequest>();
        public readonly List<Item> Items = new List<Item>();
        public readonly HashSet<string> Withdrawn = new HashSet<string>();
        public readonly List<Report> Refused = new List<Report>();

        /// <summary>
        /// What asks mean. now: when those begin that do not say. An ask that makes several requests gives them ids of its own:
        /// its id, then id.1, id.2, ...
        /// </summary>
        public static Understood From(Graph graph, IEnumerable<Ask> asks, double now)
        {
            var all = new Understood();
            foreach (Ask ask in asks)
            {
                double at = ask.At ?? now;
                var one = new Understood(); // of an ask that is refused nothing remains
                try
                {
                    one.Take(graph, ask, at);
                    all.Requests.AddRange(one.Requests);
                    all.Items.AddRange(one.Items);
                    all.Withdrawn.UnionWith(one.Withdrawn);
                }
                catch (AskException error)
                {
                    all.Refused.Add(new Report(ask.Id, "not-understood", error.Message, ask.Layer ?? "arms", at));
                }
            }
            return all;
        }

        private void Take(Graph graph, Ask ask, double at)
        {
            switch (ask.Do)
            {
                case "gesture":
                    double start = ask.Stroke == null ? at : Math.Max(0.0, ask.Stroke.Value - LongestLead(graph, ask));
                    Requests.Add(new MetaRequest(
                        ask.Id, ask.Layer, "gesture", start, duration: ask.Duration, tags: ask.Tags.ToList(), limb: ask.Limb,
                        priority: ask.Priority, resume: ask.Resume, stroke: ask.Stroke, hold: ask.Hold, prepare: ask.Prepare, late: ask.Late));
                    break;
                case "fidget":
                    Requests.Add(new MetaRequest(
                        ask.Id, ask.Layer, "fidget", at, duration: ask.Duration, tags: ask.Tags.ToList(), limb: ask.Limb,
                        priority: ask.Priority, resume: ask.Resume, late: ask.Late));
                    break;
                case "action":
                    GraphAction action = FindAction(graph, ask.Action, ask.Layer);
                    double begin = ask.Stroke == null ? at : Math.Max(0.0, ask.Stroke.Value - Lead(action));
                    Requests.Add(new MetaRequest(
                        ask.Id, action.Layer, action.Kind, begin, action: action.Id, priority: ask.Priority,
                        stroke: ask.Stroke, hold: ask.Hold, prepare: ask.Prepare, late: ask.Late));
                    break;
                case "stance":
                    string stance, layer = FindStance(graph, ask.Stance, ask.Layer, out stance);
                    Requests.Add(new MetaRequest(ask.Id, layer, "transition", at, stance: stance, priority: ask.Priority, late: ask.Late));
                    Items.Add(new StayFrom(ask.Id, at, layer, ask.Stay));
                    break;
                case "change": // whichever arm was seen to move: stances are joined by few transitions, and mostly of both
                    Requests.Add(new MetaRequest(ask.Id, ask.Layer, "transition", at, priority: ask.Priority, late: ask.Late));
                    break;
                case "nod":
                case "shake":
                    Requests.Add(Head(graph, ask, at));
                    break;
                case "look":
                    double end = ask.Duration == null ? Forever : at + ask.Duration.Value;
                    Items.Add(new LookAt(ask.Id, at, end, ask.To, ask.Amount, ask.Strict, ask.Priority));
                    break;
                case "blink":
                    Items.Add(new BlinkAt(ask.Id, at));
                    break;
                case "mode":
                    Items.Add(new ModeFrom(ask.Id, at, ask.Mode));
                    break;
                case "place":
                    Items.Add(new PlaceFrom(ask.Id, at, ask.Name, new Spot(ask.Point)));
                    break;
                case "withdraw":
                    Withdrawn.Add(ask.What);
                    break;
                case "say":
                    Say(graph, ask, at);
                    break;
                default:
                    throw new AskException("BML is read by the desktop only; send requests instead");
            }
        }

        private void Say(Graph graph, Ask ask, double at)
        {
            Line line = null;
            if (ask.Line != null && !graph.Lines.TryGetValue(ask.Line, out line))
            {
                throw new AskException("there is no line '" + ask.Line + "'");
            }
            LineTiming timing = ToldTiming.Of(ask.Words, ask.Visemes, ask.Set, ask.Duration);
            string told = timing == null ? "" : LineTimingRules.ToldText(timing);
            string text = ask.Text.Length > 0 ? ask.Text : line != null ? line.Text : told;
            if (line == null && text.Length == 0 && timing == null)
            {
                throw new AskException("say what: a line's id, text, or words with their times");
            }
            double length = GraphemesRules.ReadAloud(Alphabet.Common, text);
            if (timing != null)
            {
                length = LineTimingRules.TimedSeconds(timing, ask.Duration);
            }
            else if (ask.Duration != null)
            {
                length = Math.Max(ask.Duration.Value, 0.0);
            }
            else if (line != null)
            {
                length = line.Voice != null ? line.Voice.Duration : line.Duration ?? length;
            }
            Items.Add(new Speech(ask.Id, at, at + length, line, ask.Line, text, ask.Priority, null, timing));
            for (int n = 0; line != null && ask.Gestures && n < line.Asks.Count; n++)
            {
                Ask inner = line.Asks[n];
                if (inner.Do == "say")
                {
                    throw new AskException("line '" + ask.Line + "' would say another line; its asks may not");
                }
                double begins = at + (inner.At ?? 0.0);
                Ask shifted = inner.With(ask.Id + "." + (n + 1), begins);
                shifted.Priority = Math.Max(inner.Priority, ask.Priority);
                shifted.Stroke = at + inner.Stroke;
                Take(graph, shifted, begins);
            }
        }

        /// <summary>Nods are gestures tagged so; where none is, the likeliest of those called so, whatever stance it needs.</summary>
        private static MetaRequest Head(Graph graph, Ask ask, double at)
        {
            string word = ask.Do;
            List<GraphAction> gestures = graph.Layers["head"].Actions.Values.Where(x => x.Kind == "gesture" && x.HasTags(ask.Tags)).ToList();
            if (gestures.Exists(x => x.Tags.Contains(word)))
            {
                List<string> tagged = new[] { word }.Concat(ask.Tags).ToList();
                return new MetaRequest(ask.Id, "head", "gesture", at, tags: tagged, priority: ask.Priority, late: ask.Late);
            }
            List<string> among = gestures.Where(x => x.Name.ToLowerInvariant().Contains(word)).Select(x => x.Id).ToList();
            if (among.Count == 0)
            {
                string tags = ask.Tags.Length > 0 ? " with the tags " + string.Join(", ", ask.Tags) : "";
                throw new AskException("the head layer has no gesture tagged or called '" + word + "'" + tags);
            }
            return new MetaRequest(ask.Id, "head", "gesture", at, priority: ask.Priority, among: among, late: ask.Late);
        }

        /// <summary>How long before its stroke any gesture with an ask's tags begins.</summary>
        private static double LongestLead(Graph graph, Ask ask)
        {
            IEnumerable<GraphAction> gestures = graph.Layers[ask.Layer].Actions.Values.Where(x => x.Kind == "gesture" && x.HasTags(ask.Tags));
            return gestures.Select(Lead).DefaultIfEmpty(0.0).Max();
        }

        /// <summary>Seconds from an action's start to its stroke.</summary>
        private static double Lead(GraphAction action)
        {
            return action.Phases.Stroke - action.Start;
        }

        /// <summary>The action of an id or, failing that, a name; of several of one name the likeliest.</summary>
        private static GraphAction FindAction(Graph graph, string word, string layer)
        {
            GraphAction found = graph.Action(word);
            if (found != null && (layer == null || layer == found.Layer))
            {
                return found;
            }
            found = null;
            foreach (GraphAction x in Basics.Layers.Where(l => layer == null || l == layer).SelectMany(l => graph.Layers[l].Actions.Values))
            {
                if (x.Name == word && (found == null || x.Likelihood > found.Likelihood))
                {
                    found = x;
                }
            }
            if (found == null)
            {
                throw new AskException("there is no action '" + word + "'" + (layer == null ? "" : " in the " + layer + " layer"));
            }
            return found;
        }

        /// <summary>Layer and id of a stance from its id or name.</summary>
        private static string FindStance(Graph graph, string word, string layer, out string stance)
        {
            foreach (string each in Basics.Layers.Where(l => layer == null || l == layer))
            {
                LayerGraph of = graph.Layers[each];
                stance = of.Stances.ContainsKey(word) ? word : of.Stances.Values.Where(s => s.Name == word).Select(s => s.Id).FirstOrDefault();
                if (stance != null)
                {
                    return each;
                }
            }
            throw new AskException("there is no stance '" + word + "'" + (layer == null ? "" : " in the " + layer + " layer"));
        }
    }
}
