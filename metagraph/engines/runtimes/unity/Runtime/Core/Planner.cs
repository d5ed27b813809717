using System;
using System.Collections.Generic;
using System.Linq;

namespace Metagraph
{
    /// <summary>Requests in, a plan of specific actions out: meta actions, temporal replanning, sampling, layer by layer.</summary>
    public static class Planner
    {
        /// <summary>
        /// The plan with new requests worked in, others withdrawn, and the horizon moved to `end`. What starts before `now` stays as
        /// it was; what was planned for later is taken back to its meta actions and planned again. leave: layers that nothing new concerns.
        /// stopped: those withdrawn whose running action is left, too.
        /// </summary>
        internal static Plan Extend(
            Graph graph, Plan plan, double now, IEnumerable<MetaRequest> requests, double end, IDictionary<string, string> stances, bool idle,
            HashSet<string> withdrawn, ICollection<string> leave, HashSet<string> stopped)
        {
            List<MetaRequest> fresh = Unique(requests);
            var again = new HashSet<string>(fresh.Select(r => r.Id));
            again.UnionWith(withdrawn);
            var layers = new Dictionary<string, LayerPlan>();
            var reports = new List<Report>();
            Moods moods = WantedRules.MoodsOf(graph.Life, plan.Track);
            foreach (string layer in Basics.Layers)
            {
                if (leave.Contains(layer))
                {
                    layers[layer] = plan.Layers[layer];
                    reports.AddRange(plan.Reports.Where(r => r.Layer == layer && !again.Contains(r.Request)));
                    continue;
                }
                LayerGraph of = graph.Layers[layer];
                string stance;
                stance = stances != null && stances.TryGetValue(layer, out stance) ? stance : null;
                LayerDraft drafted = LayerPlanningRules.Draft(
                    graph, of, idle ? of.Markov : null, of.Kinds, plan.Layers[layer], plan.Reports, plan.Seed, now, fresh, again, stopped, end,
                    stance, moods);
                layers[layer] = drafted.Performed(drafted.Placed.FindAll(m => !m.Written || Performed(of.Markov, plan, m, moods)), end);
                reports.AddRange(drafted.Reports);
            }
            List<MetaRequest> kept = plan.Requests.Where(r => !again.Contains(r.Id)).Concat(fresh).ToList();
            Schedule life = ScheduleRules.Schedule(graph.Life, plan.Track, graph.Voices, plan.Seed, end, plan.Life, now);
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

        /// <summary>
        /// Whether what a model wrote is performed: not where it would leave a stance that was asked for, to stay in, and as often as its
        /// mode and mood say.
        /// </summary>
        private static bool Performed(Markov model, Plan plan, MetaAction meta, Moods moods)
        {
            if (!MoodRules.Stirs(MoodRules.MoodAt(moods, meta.Start), plan.Seed, meta.Request.Id))
            {
                return false;
            }
            bool leaves = meta.Request.Kind == "transition" && plan.Track.StaysAt(meta.Request.Layer, meta.Start);
            return !leaves && MarkovRules.Performs(model, plan.Seed, meta, WantedRules.ModeAt(plan.Track, meta.Start));
        }
    }
}
