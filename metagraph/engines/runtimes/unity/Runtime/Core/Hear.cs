using System;
using System.Collections.Generic;
using System.Linq;

namespace Metagraph
{
    /// <summary>What became of an ask. State: planned, late, refused or done. At, Until: seconds, when it plays, null when not.</summary>
    public sealed class Answer
    {
        public string Id, State, Why = "";
        public double? At, Until;
        public string[] What = Basics.None;
    }

    /// <summary>Working into a running plan what has just been asked, forgetting what is over, and saying what became of asks.</summary>
    public static class Hearing
    {
        /// <summary>
        /// The plan with asks worked in that became known at `now`, and the horizon moved to `end`. What begins before now + lookahead
        /// stays, but at the very beginning; voices begin and stop sooner. Asks need ids; of two with one id the later counts. stances: layer -> where it begins.
        /// </summary>
        public static Plan Hear(
            Graph graph, Plan plan, double now, IList<Ask> asks, double end, IDictionary<string, string> stances = null, bool idle = true)
        {
            double begins = now > 0 ? now + graph.Settings.Lookahead : 0.0;
            double soon = UtterancesRules.FindSoon(now, graph.Settings.Lookahead);
            Meaning meant = Understood.From(graph, asks, begins, soon);
            List<string> turning = Basics.Layers.Where(layer => graph.Layers[layer].Markov.Modes.Count > 0).ToList();
            Heard heard = HearingRules.Heard(plan.Requests, plan.Track, meant, now, begins, soon, turning);
            bool partly = asks.Count > 0 && now > 0 && end == plan.End;
            string[] leave = partly ? Basics.Layers.Where(layer => !heard.Touched.Contains(layer)).ToArray() : Basics.None;
            plan = plan.With(heard.Track);
            Plan after = Planner.Extend(graph, plan, begins, heard.Fresh, end, stances, idle, heard.Withdrawn, leave, heard.Stopped);
            after.Reports.AddRange(meant.Refused);
            return after;
        }

        /// <summary>What a plan does about an ask: when it will play, or why it will not.</summary>
        public static Answer AnswerTo(Plan plan, string id)
        {
            return Answers(plan, new[] { id })[0];
        }

        /// <summary>What a plan does about each of many asks, in time that grows with the plan alone.</summary>
        public static List<Answer> Answers(Plan plan, ICollection<string> ids)
        {
            Dictionary<string, Found> found = ids.ToDictionary(id => id, id => new Found());
            Func<string, IEnumerable<Found>> of = made => HearingRules.Owners(made).Where(found.ContainsKey).Select(owner => found[owner]);
            foreach (LayerPlan layer in plan.Layers.Values)
            {
                layer.Cues.ForEach(cue => Each(of(cue.Meta.Split('+')[0]), one => one.Cues.Add(cue)));
                foreach (Report report in plan.Reports.Where(r => r.By.Length > 0))
                {
                    layer.Cues.FindAll(cue => cue.Meta == report.By).ForEach(cue => Each(of(report.Request), one => one.Cues.Add(cue)));
                }
                layer.Metas.FindAll(m => m.Start >= plan.End).ForEach(m => Each(of(m.Request.Id), one => one.Waiting.Add(m.Start)));
            }
            foreach ((string, double, double, string) item in Lasting(plan.Track))
            {
                bool paused = UtterancesRules.IsPaused(item.Item2);
                Each(of(item.Item1), one => { if (paused) { one.Waiting.Add(item.Item2); } else { one.Items.Add(item); } });
            }
            plan.Reports.ForEach(report => Each(of(report.Request), one => one.Told.Add(report)));
            return ids.Select(id => AnswerOf(id, found[id])).ToList();
        }

        /// <summary>Id, start, end and word of what lasts; where a layer stays is told by the way to it.</summary>
        private static IEnumerable<(string, double, double, string)> Lasting(Track track)
        {
            return track.Looks.Select(x => (x.Id, x.Start, x.End, "look"))
                .Concat(track.Speeches.Where(x => track.LastSpeech(x.Id) == x).Select(x => (x.Id, x.Start, x.End, "speech")))
                .Concat(track.Modes.Select(x => (x.Id, x.Start, MeaningRules.Forever, "mode")))
                .Concat(track.Places.Select(x => (x.Id, x.Start, MeaningRules.Forever, "place")))
                .Concat(track.Blinks.Select(x => (x.Id, x.Start, x.Start, "blink")))
                .Concat(track.Moods.Select(x => (x.Id, x.Start, x.End, "mood")));
        }

        private static void Each<T>(IEnumerable<T> items, Action<T> act)
        {
            foreach (T item in items)
            {
                act(item);
            }
        }

        /// <summary>What in a plan belongs to one ask. Waiting: seconds at which what is not chosen yet begins.</summary>
        private sealed class Found
        {
            public readonly List<Cue> Cues = new List<Cue>();
            public readonly List<(string, double, double, string)> Items = new List<(string, double, double, string)>();
            public readonly List<Report> Told = new List<Report>();
            public readonly List<double> Waiting = new List<double>();
        }

        private static Answer AnswerOf(string id, Found found)
        {
            List<Report> told = found.Told;
            var answer = new Answer { Id = id, Why = string.Join("; ", told.Select(r => r.Message).Distinct().ToArray()) };
            if (found.Cues.Count > 0 || found.Items.Count > 0)
            {
                string[] late = { "late", "queued", "resumed" };
                answer.State = told.Exists(r => late.Contains(r.Outcome)) ? "late" : "planned";
                answer.At = found.Cues.Select(c => c.Start).Concat(found.Items.Select(i => i.Item2)).Min();
                answer.Until = found.Cues.Select(c => c.End).Concat(found.Items.Select(i => i.Item3)).Max();
                answer.What = found.Cues.Select(c => c.Action.Name).Concat(found.Items.Select(i => i.Item4)).ToArray();
            }
            else if (told.Exists(r => r.Outcome == "already-there"))
            {
                answer.State = "done";
            }
            else if (found.Waiting.Count > 0 && UtterancesRules.IsPaused(found.Waiting[0]))
            {
                answer.State = "planned";
                answer.Why = "it is paused";
            }
            else if (found.Waiting.Count > 0 && told.All(r => r.Played))
            {
                answer.State = told.Count > 0 ? "late" : "planned";
                answer.At = found.Waiting[0];
                answer.Why = answer.Why.Length > 0 ? answer.Why : "chosen when its time is nearer";
            }
            else
            {
                answer.State = "refused";
                answer.Why = answer.Why.Length > 0 ? answer.Why : "nothing came of it";
            }
            return answer;
        }

        /// <summary>
        /// A running plan without what ended before `seconds`; what is planned on from it stays as it would have been. Poses before
        /// `seconds` are lost. What must not be forgotten is the settings' memory.
        /// </summary>
        public static Plan Since(Plan plan, double seconds)
        {
            var layers = new Dictionary<string, LayerPlan>();
            foreach (KeyValuePair<string, LayerPlan> one in plan.Layers)
            {
                layers[one.Key] = Since(one.Value, seconds);
            }
            var known = new HashSet<string>(layers.Values.SelectMany(layer => layer.Metas).Select(m => m.Request.Id));
            return new Plan(
                plan.Seed, plan.End, layers, plan.Reports.FindAll(r => r.At >= seconds),
                plan.Requests.FindAll(r => r.Start >= seconds || known.Contains(r.Id)), plan.Track.Since(seconds),
                plan.Life.Since(seconds));
        }

        private static LayerPlan Since(LayerPlan plan, double seconds)
        {
            int gone = plan.Cues.FindIndex(cue => cue.End >= seconds);
            gone = gone < 0 ? plan.Cues.Count : gone;
            List<Cue> cues = plan.Cues.GetRange(gone, plan.Cues.Count - gone);
            var played = new HashSet<string>(cues.Select(cue => cue.Meta));
            List<MetaAction> metas = plan.Metas.FindAll(m => m.End >= seconds || played.Contains(m.Key));
            int first = Math.Max(0, plan.Rests.FindLastIndex(rest => rest.FadeStart + rest.Fade <= seconds));
            List<Rest> rests = plan.Rests.GetRange(first, plan.Rests.Count - first);
            Past past = plan.Past;
            if (gone > 0)
            {
                Cue last = plan.Cues[gone - 1];
                past = new Past(
                    last.End, last.Then, new Dictionary<string, int>(past.Uses), new Dictionary<string, List<string>>(past.Recent),
                    new Dictionary<string, double>(past.Ended));
                plan.Cues.GetRange(0, gone).ForEach(cue => RememberingRules.Remember(cue, past.Uses, past.Recent, past.Ended));
            }
            return new LayerPlan(plan.Layer, metas, cues, rests, past, plan.Cursor, plan.Written);
        }
    }
}
