using System;
using System.Collections.Generic;
using System.Linq;

namespace Metagraph
{
    /// <summary>Requests in, a plan of specific actions out: meta actions, temporal replanning, sampling, layer by layer.</summary>
    public static class Planner
    {
        private static readonly HashSet<string> Temporal = new HashSet<string> { "late", "cut", "resumed", "past" }; // told once

        /// <summary>
        /// The plan with new requests worked in, others withdrawn, and the horizon moved to `end`. What starts before `now` stays as
        /// it was; what was planned for later is taken back to its meta actions and planned again. leave: layers that nothing new concerns.
        /// </summary>
        internal static Plan Extend(
            Graph graph, Plan plan, double now, IEnumerable<MetaRequest> requests, double end, IDictionary<string, string> stances, bool idle,
            HashSet<string> withdrawn, ICollection<string> leave)
        {
            List<MetaRequest> fresh = Unique(requests);
            var again = new HashSet<string>(fresh.Select(r => r.Id));
            again.UnionWith(withdrawn);
            var layers = new Dictionary<string, LayerPlan>();
            var reports = new List<Report>();
            foreach (string layer in Basics.Layers)
            {
                if (leave.Contains(layer))
                {
                    layers[layer] = plan.Layers[layer];
                    reports.AddRange(plan.Reports.Where(r => r.Layer == layer && !again.Contains(r.Request)));
                    continue;
                }
                List<MetaAction> asked = fresh.Where(r => r.Layer == layer).Select(r => Meta(r, graph.Planner)).ToList();
                string wish;
                wish = stances != null && stances.TryGetValue(layer, out wish) ? wish : null;
                layers[layer] = ExtendLayer(graph, plan, layer, now, asked, again, end, wish, idle, reports);
            }
            List<MetaRequest> kept = plan.Requests.Where(r => !again.Contains(r.Id)).Concat(fresh).ToList();
            Schedule life = Drawing.Extend(graph, plan.Track, plan.Seed, end, plan.Life, now);
            return new Plan(plan.Seed, end, layers, reports.OrderBy(r => r.At).ToList(), kept, plan.Track, life);
        }

        /// <summary>Of requests with one id the last, in the place of the first.</summary>
        private static List<MetaRequest> Unique(IEnumerable<MetaRequest> requests)
        {
            var found = new List<MetaRequest>();
            foreach (MetaRequest request in requests)
            {
                int place = found.FindIndex(r => r.Id == request.Id);
                if (place >= 0)
                {
                    found[place] = request;
                }
                else
                {
                    found.Add(request);
                }
            }
            return found;
        }

        private static MetaAction Meta(MetaRequest request, PlannerSettings settings)
        {
            double length = request.Duration == null ? settings.Window : Math.Max(0.0, request.Duration.Value);
            if (request.Stroke != null)
            {
                length = Math.Max(length, request.Stroke.Value - request.Start + Performer.Fits);
            }
            return new MetaAction(request, request.Start, request.Start + length);
        }

        /// <summary>A layer's plan; its reports, old and new, are added. again: requests that replace what was asked before.</summary>
        private static LayerPlan ExtendLayer(
            Graph whole, Plan plan, string layer, double now, List<MetaAction> asked, HashSet<string> again, double end, string wish,
            bool idle, List<Report> reports)
        {
            LayerGraph graph = whole.Layers[layer];
            LayerPlan old = plan.Layers[layer];
            List<Cue> kept = old.Cues.Where(cue => cue.Start < now).ToList();
            var played = new HashSet<string>(kept.Select(cue => cue.Meta));
            var waiting = new HashSet<string>(old.Cues.Skip(kept.Count).Select(cue => cue.Meta)); // also chains that have begun
            var written = new List<MetaAction>();
            Cursor cursor = old.Cursor;
            if (idle) // what the model writes from now on, as it writes it
            {
                var more = MarkovRules.Write(graph.Markov, plan.Seed, end, graph.Kinds, cursor);
                written = old.Written.Concat(more.Item1).Where(m => m.Start >= now).ToList();
                cursor = more.Item2;
            }
            var gone = new HashSet<string>(again);
            gone.UnionWith(written.Select(m => m.Request.Id));
            List<MetaAction> staying = old.Metas.Where(m => !gone.Contains(m.Request.Id)).ToList();
            List<MetaAction> future = staying.Where(m => waiting.Contains(m.Key) || (m.Start >= now && !played.Contains(m.Key))).ToList();
            // What was told about time still holds; the rest will be told again by those that are planned again.
            var planned = new HashSet<(string, double)>(future.Select(m => Place(m.Request.Id, m.Start)));
            List<MetaAction> done = staying.Where(
                m => !planned.Contains(Place(m.Request.Id, m.Start)) && (played.Contains(m.Key) || m.Start < now)).ToList();
            reports.AddRange(plan.Reports.Where(
                r => r.Layer == layer && !gone.Contains(r.Request) && (Temporal.Contains(r.Outcome) || !planned.Contains(Place(r.Request, r.At)))));
            string begin = Begin(graph, old, wish);
            Performer performer = begin == null ? null : new Performer(whole.Planner, graph, plan.Seed, begin, old.Past, kept);
            if (performer == null || !performer.Begin(begin))
            {
                string why = "the " + layer + " layer has no stance with a loop to begin in";
                reports.AddRange(future.Concat(asked).Where(m => !m.Written).Select(
                    m => new Report(m.Request.Id, "no-stance", why, layer, m.Start)));
                List<MetaAction> all = done.Concat(future).Concat(asked).ToList();
                return new LayerPlan(layer, all, new List<Cue>(), new List<Rest>(), old.Past, cursor, written);
            }
            if (old.Rests.Count > 0 && now > 0)
            {
                var begun = new HashSet<double>(kept.Select(cue => cue.End - cue.BlendOut));
                performer.Rests = old.Rests.Where(r => r.FadeStart < now || begun.Contains(r.Start)).ToList();
            }
            performer.Begun = new HashSet<string>(played.Where(waiting.Contains));
            performer.Free = Math.Max(now - (performer.Ready - performer.Free), performer.Free);
            var delayed = ReplanRules.Delay(asked, performer.Ready, whole.Planner);
            reports.AddRange(delayed.Item2);
            // What runs keeps the time it was wanted for, from the models.
            double busy = done.Where(m => !m.Written).Select(m => m.End).DefaultIfEmpty(double.NegativeInfinity).Max();
            List<MetaAction> every = future.Concat(written).Concat(delayed.Item1).ToList();
            var placed = ReplanRules.Replan(every, whole.Planner, busy);
            reports.AddRange(placed.Item2);
            performer.Perform(placed.Item1.FindAll(m => !m.Written || Performed(graph.Markov, plan, m)), end);
            performer.VaryRests(end);
            reports.AddRange(performer.Reports);
            return new LayerPlan(layer, done.Concat(placed.Item1).ToList(), performer.Cues, performer.Rests, old.Past, cursor, written);
        }

        private static (string, double) Place(string request, double at)
        {
            return (request, at);
        }

        /// <summary>Whether what a model wrote is performed: not where it would leave a stance that was asked for, to stay in.</summary>
        private static bool Performed(Markov model, Plan plan, MetaAction meta)
        {
            bool leaves = meta.Request.Kind == "transition" && plan.Track.StaysAt(meta.Request.Layer, meta.Start);
            return !leaves && MarkovRules.Performs(model, plan.Seed, meta, plan.Track.ToldMode(meta.Start));
        }

        /// <summary>The stance a layer begins in: as it did before, as asked, the graph's start, or the first that has a loop.</summary>
        private static string Begin(LayerGraph graph, LayerPlan old, string wish)
        {
            var wishes = new List<string> { old.Past.Stance, old.Rests.Count > 0 ? old.Rests[0].Stance : null, wish, graph.Start };
            wishes.AddRange(graph.Stances.Select(s => s.Key));
            return wishes.Find(s => graph.HasStance(s) && graph.Of(s, "stance").Count > 0);
        }
    }
}
