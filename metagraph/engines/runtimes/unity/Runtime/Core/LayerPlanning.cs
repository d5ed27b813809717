// Translated from metagraph/playback/planning/layer_planning.py; change that, and translate anew.
using System;
using System.Collections.Generic;
using System.Linq;

namespace Metagraph
{
    /// <summary>
    /// A layer placed in time, not yet performed.
    ///
    /// able: whether the layer can perform at all. done: meta actions that were performed before. placed: those to perform, in
    /// order; those that a model wrote are performed as the mode says. reports: the reports so far.
    /// </summary>
    public sealed class LayerDraft
    {
        public string Layer;
        public LayerState State;
        public bool Able;
        public List<MetaAction> Done;
        public List<MetaAction> Placed;
        public List<Report> Reports;
        public Past Past;
        public Cursor Cursor;
        public List<MetaAction> Written;

        public LayerDraft(
            string layer,
            LayerState state,
            bool able,
            List<MetaAction> done,
            List<MetaAction> placed,
            List<Report> reports,
            Past past,
            Cursor cursor,
            List<MetaAction> written
        )
        {
            Layer = layer;
            State = state;
            Able = able;
            Done = done;
            Placed = placed;
            Reports = reports;
            Past = past;
            Cursor = cursor;
            Written = written;
        }

        /// <summary>Return the layer's plan with the given meta actions performed; `reports` is then complete.</summary>
        public LayerPlan Performed(List<MetaAction> metas, double end)
        {
            var cues = new List<Cue>();
            var rests = new List<Rest>();
            if (Able)
            {
                SamplingRules.PerformMetas(State, metas, end);
                SamplingRules.VaryRests(State, end);
                cues = State.Cues;
                rests = State.Rests;
                Reports.AddRange(State.Reports);
            }
            var every = Done.Concat(Placed).ToList();
            return new LayerPlan(Layer, every, cues.ToList(), rests.ToList(), Past, Cursor, Written.ToList());
        }
    }

    public static class LayerPlanningRules
    {
        public const double Window = 1.0; // seconds a request may use when it does not say how long

        /// <summary>
        /// Return a layer's plan cut at `now`, with the requests placed again.
        ///
        /// chain: the model that writes when there are no requests, or None. kinds: the kinds of actions that the layer has.
        /// told: reports of the plan so far. fresh: new requests, of all layers. replaced: ids of requests that are replaced or
        /// withdrawn; stopped: those withdrawn, whose running action is left. stance: the stance in which the layer would begin.
        /// moods: the mood over time. track: what lasts, such as the mode.
        /// </summary>
        public static LayerDraft Draft(
            Graph project,
            LayerGraph graph,
            Markov chain,
            HashSet<string> kinds,
            LayerPlan old,
            List<Report> told,
            uint seed,
            double now,
            List<MetaRequest> fresh,
            HashSet<string> replaced,
            HashSet<string> stopped,
            double end,
            string stance,
            Moods moods,
            Track track
        )
        {
            var layer = graph.Layer;
            var asked = fresh.Where(request => request.Layer == layer).Select(request => MetaOf(InTime(request, moods))).ToList();
            var kept = old.Cues.Where(cue => cue.Start < now).ToList();
            var played = new HashSet<string>(kept.Select(cue => cue.Meta));
            // also those whose chain of transitions has begun
            var waiting = new HashSet<string>(PlainLists.Part(old.Cues, kept.Count).Select(cue => cue.Meta));
            // Who lies ahead may be called as what was played long ago: a request that is asked for again and again.
            var playing = new HashSet<string>(kept.Where(cue => cue.End > now).Select(cue => cue.Meta));
            var written = new List<MetaAction>();
            var cursor = old.Cursor;
            // What another's action has served since it began is played as that is.
            var served = new HashSet<string>(told.Where(report => report.Outcome == "shared"
                && played.Contains(report.By)).Select(report => report.Request));
            var again = new HashSet<string>(replaced);
            if (chain != null)
            {
                List<MetaAction> more = default(List<MetaAction>);
                var found = MarkovRules.Write(chain, seed, end, kinds, old.Cursor);
                more = found.Item1;
                cursor = found.Item2;
                foreach (MetaAction meta in old.Written.Concat(more).ToList())
                {
                    if (meta.Start >= now)
                    {
                        written.Add(meta);
                        again.Add(meta.Request.Id);
                    }
                }
            }
            var future = new List<MetaAction>();
            var planned = new Dictionary<string, List<double>>(); // again: when those of a request start
            var judged = new HashSet<string>(); // those whose lateness is known once they are performed
            foreach (MetaAction meta in old.Metas)
            {
                if (again.Contains(meta.Request.Id) || served.Contains(meta.Request.Id))
                {
                    continue;
                }
                if (waiting.Contains(meta.Key) || (meta.Start >= now && !playing.Contains(meta.Key)))
                {
                    future.Add(meta);
                    if (meta.Request.Late != null)
                    {
                        judged.Add(meta.Request.Id);
                    }
                    planned[meta.Request.Id] = PlainMaps.GetOr(planned, meta.Request.Id, new List<double>()).Concat(new List<double> { meta.Start }).ToList();
                }
            }
            // Reports about time still hold; those that are planned again report the rest.
            var done = old.Metas.Where(meta => !again.Contains(meta.Request.Id)
                && !PlainMaps.GetOr(planned, meta.Request.Id, new List<double>()).Contains(meta.Start)
                && (playing.Contains(meta.Key) || meta.Start < now || served.Contains(meta.Request.Id))).ToList();
            var reports = told.Where(report => report.Layer == layer
                && !again.Contains(report.Request)
                && ((MetaPlanRules.Temporal.Contains(report.Outcome) && !judged.Contains(report.Request))
                    || !PlainMaps.GetOr(planned, report.Request, new List<double>()).Contains(report.At))).ToList();
            var begin = Begin(graph, old, stance);
            var state = SamplingRules.ResumeLayer(project, graph, seed, begin, old.Past, kept, moods, track);
            state.Model = chain;
            if (begin == "" || !SamplingRules.BeginLayer(state, begin))
            {
                var why = "the " + layer + " layer has no stance with a loop to begin in";
                var waits = future.Concat(asked).ToList();
                foreach (MetaAction meta in waits)
                {
                    if (!meta.Written)
                    {
                        reports.Add(new Report(meta.Request.Id, "no-stance", why, layer, meta.Start));
                    }
                }
                return new LayerDraft(layer, state, false, done, waits, reports, old.Past, cursor, written);
            }
            state.Begun = Begun(old, kept.Count);
            if (kept.Count > 0 && kept[kept.Count - 1].End > now)
            {
                var running = old.Metas.Where(meta => meta.Key == kept[kept.Count - 1].Meta).FirstOrDefault();
                var leaves = Leaves(running, stopped, track, now);
                LeavingRules.MakeWay(state, running, asked, now, leaves);
            }
            if (old.Rests.Count > 0 && now > 0)
            {
                var begun = new HashSet<double>(state.Cues.Select(cue => cue.End - cue.BlendOut));
                state.Rests = old.Rests.Where(rest => rest.FadeStart < now || begun.Contains(rest.Start)).ToList();
            }
            state.Free = Math.Max(now - (state.Ready - state.Free), state.Free);
            List<Report> delayed = default(List<Report>);
            var found2 = ReplanRules.Delay(asked, state.Ready, project.Settings);
            asked = found2.Item1;
            delayed = found2.Item2;
            var busy = double.NegativeInfinity; // what runs keeps the time it was wanted for, from the models
            foreach (MetaAction meta in done)
            {
                if (!meta.Written)
                {
                    busy = Math.Max(busy, meta.End);
                }
            }
            var found3 = ReplanRules.Replan(future.Concat(written).Concat(asked).ToList(), project.Settings, busy);
            List<MetaAction> placed = found3.Item1;
            List<Report> moved = found3.Item2;
            var every = reports.Concat(delayed).Concat(moved).ToList();
            return new LayerDraft(layer, state, true, done, placed, every, old.Past, cursor, written);
        }

        /// <summary>
        /// Return whether the running action is left: it was stopped, or it is a gesture of the character's own and what it said
        /// was broken off.
        /// </summary>
        private static bool Leaves(MetaAction running, HashSet<string> stopped, Track track, double now)
        {
            if (running == null)
            {
                return false;
            }
            var own = running.Written && running.Request.Kind == "gesture";
            return stopped.Contains(running.Request.Id) || (own && track.HushedAt(now));
        }

        /// <summary>
        /// Return the key of the meta action whose chain of transitions plays where the first cues are kept; none if none does.
        /// An earlier action may have had the same key, so that only the last cue can be of a chain.
        /// </summary>
        private static HashSet<string> Begun(LayerPlan old, int kept)
        {
            var out_ = new HashSet<string>();
            if (0 < kept && kept < old.Cues.Count)
            {
                var last = old.Cues[kept - 1];
                var following = old.Cues[kept];
                if (last.Meta == following.Meta && following.Start <= last.End)
                {
                    out_.Add(last.Meta);
                }
            }
            return out_;
        }

        /// <summary>
        /// Return a request that may begin earlier, by the extra time that its preparation takes in its mood.
        /// </summary>
        public static MetaRequest InTime(MetaRequest request, Moods moods)
        {
            if (request.Stroke == null)
            {
                return request;
            }
            var mood = MoodRules.MoodAt(moods, request.Stroke.Value);
            var speed = MoodRules.Tempo(MoodRules.Changed(mood, request.Valence, request.Arousal, request.Intensity));
            if (speed >= 1)
            {
                return request;
            }
            return new MetaRequest(
                request.Id,
                request.Layer,
                request.Kind,
                Math.Max(0.0, request.Stroke.Value - (request.Stroke.Value - request.Start) / speed),
                request.Duration,
                request.Action,
                request.Tags,
                request.Limb,
                request.Stance,
                request.Priority,
                request.Resume,
                request.Stroke,
                request.Hold,
                request.Prepare,
                request.Among,
                request.Late,
                request.Valence,
                request.Arousal,
                request.Intensity
            );
        }

        /// <summary>
        /// Return a request as a meta action with the window it may use; if its stroke is judged, with the moment of the stroke.
        /// </summary>
        public static MetaAction MetaOf(MetaRequest request)
        {
            if (request.Late != null && request.Stroke != null)
            {
                return new MetaAction(request, request.Stroke.Value, request.Stroke.Value + CueShapesRules.Fits);
            }
            var length = request.Duration == null ? Window : Math.Max(0.0, request.Duration.Value);
            if (request.Stroke != null)
            {
                length = Math.Max(length, request.Stroke.Value - request.Start + CueShapesRules.Fits);
            }
            return new MetaAction(request, request.Start, request.Start + length);
        }

        /// <summary>
        /// Return the stance in which a layer begins: that of the plan before, the given one, the graph's start, or the first
        /// that has a loop; "" for none.
        /// </summary>
        private static string Begin(LayerGraph graph, LayerPlan old, string stance)
        {
            var wishes = new List<string> { old.Past.Stance };
            if (old.Rests.Count > 0)
            {
                wishes.Add(old.Rests[0].Stance);
            }
            if (stance != null)
            {
                wishes.Add(stance);
            }
            if (graph.Start != null)
            {
                wishes.Add(graph.Start);
            }
            wishes.AddRange(graph.Stances.Keys.ToList());
            foreach (string wish in wishes)
            {
                if (graph.Stances.ContainsKey(wish) && graph.Of(wish, "stance").Count > 0)
                {
                    return wish;
                }
            }
            return "";
        }
    }
}
