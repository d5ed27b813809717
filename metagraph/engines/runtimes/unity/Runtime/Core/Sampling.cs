// Translated from metagraph/playback/planning/sampling.py; change that, and translate anew.
using System;
using System.Collections.Generic;
using System.Linq;

namespace Metagraph
{
    /// <summary>
    /// From a meta plan to specific actions: candidates, the three temporal cases, cues and rests (Borer et al., section 6.2).
    /// </summary>
    public static class SamplingRules
    {
        public const double OnTime = 0.1; // seconds by which a request may begin later and still be on time
        // seconds of crossfade when a long rest changes from one loop of its stance to another
        public const double LoopFade = 0.6;

        /// <summary>Return the layer as it is after a past and the cues that played since.</summary>
        public static LayerState ResumeLayer(
            Graph project,
            LayerGraph graph,
            uint seed,
            string begin,
            Past past,
            List<Cue> cues,
            Moods moods,
            Track track
        )
        {
            var stance = graph.Stances.ContainsKey(past.Stance) ? past.Stance : begin;
            var out_ = new LayerState(
                project,
                graph,
                seed,
                stance,
                moods,
                track,
                past.Free,
                past.Free,
                new Dictionary<string, int>(past.Uses),
                new Dictionary<string, List<string>>(past.Recent),
                new Dictionary<string, double>(past.Ended)
            );
            out_.Beats = DirectorRules.BeatInterval(
                graph.Layer,
                graph.Actions.Values.ToList().Where(a => a.Kind == "gesture").ToList().Count
            );
            foreach (Cue cue in cues)
            {
                out_.Note(cue, graph.Stances.ContainsKey(cue.Then) ? cue.Then : begin);
            }
            return out_;
        }

        /// <summary>Lay the first loop down; return whether the layer can perform at all.</summary>
        public static bool BeginLayer(LayerState state, string stance)
        {
            var loop = RoutesRules.DrawLoop(state, stance, "rest/" + state.Graph.Layer);
            if (loop == null)
            {
                return false;
            }
            state.Rests.Add(new Rest(stance, loop, 0.0, 0.0, 0.0));
            return true;
        }

        /// <summary>Realise in order those meta actions of a conflict-free meta plan that start before `end`.</summary>
        public static void PerformMetas(LayerState state, List<MetaAction> metas, double end)
        {
            var performed = metas.Where(m => !m.Written || DirectingRules.PerformsWritten(state, m, m.Start)).ToList();
            foreach (Bound bound in BoundsRules.Bounds(performed))
            {
                var meta = bound.Meta;
                if (BoundsRules.Begins(meta) >= end)
                {
                    continue;
                }
                if (state.Served.Count > 0 && state.Served.Contains(meta.Key))
                {
                    continue;
                }
                if (meta.Request.Late != null)
                {
                    Realise(state, bound, Math.Max(state.Ready, BoundsRules.Begins(meta)));
                    continue;
                }
                var ready = state.Ready;
                if (meta.Start < ready && !state.Begun.Contains(meta.Key))
                {
                    var running = "the running action";
                    if (state.Cues.Count > 0)
                    {
                        running = "'" + state.Cues[state.Cues.Count - 1].Action.Name + "'";
                    }
                    var waits = ready - meta.Start;
                    if (meta.End <= ready + CueShapesRules.Fits)
                    {
                        waits = ready - meta.Request.Start;
                        // What is wanted for a certain time is over; what is wanted once may come late.
                        var wanted = meta.Written || meta.Request.Duration != null;
                        if (wanted || waits > state.Project.Settings.Wait)
                        {
                            var why = "wholly covered by "
                                + running
                                + ", which plays until "
                                + PlainText.Fixed(state.Free, 2)
                                + " s";
                            state.Tell(meta, "covered", why);
                            continue;
                        }
                    }
                    // What a model wrote is wanted at no certain time.
                    if (!meta.Written && waits > OnTime)
                    {
                        state.Tell(meta, "queued", "waits " + PlainText.Fixed(waits, 2) + " s for " + running, true);
                    }
                }
                Realise(state, bound, Math.Max(ready, meta.Start));
            }
        }

        private static void Realise(LayerState state, Bound bound, double now)
        {
            var meta = bound.Meta;
            if (meta.Written && !state.Begun.Contains(meta.Key) && !DirectingRules.MayBegin(state, meta, now))
            {
                return;
            }
            var steps = StepsRules.ChooseSteps(state, meta, now);
            if (steps == null)
            {
                return;
            }
            var cues = new List<Cue>();
            var stance = state.Stance;
            foreach (SamplingStep step in steps)
            {
                var hops = step.Hop != "";
                var asked = hops ? null : CueShapesRules.Remaining(meta, now);
                var mood = MannerRules.FindMood(state, asked, now);
                var fitting = Fit(state, bound, step, asked, now, mood);
                if (fitting.Count == 0)
                {
                    return;
                }
                // On the way to a stance it counts when that begins.
                if (meta.Request.Late != null && (!hops || (cues.Count == 0 && steps[steps.Count - 1].Hop != "")))
                {
                    fitting = PunctualityRules.KeepTimely(state, bound, fitting, now);
                    if (fitting.Count == 0)
                    {
                        return;
                    }
                }
                var action = DrawingRules.DrawAction(state, fitting, hops ? meta.Key + "/" + step.Hop : meta.Key, now, mood);
                var shape = MannerRules.ShapeInMood(state, action, asked, now, mood);
                var cue = Cue(state, action, shape, bound, hops, stance, mood);
                cues.Add(cue);
                now = cue.End;
                stance = cue.Then;
            }
            foreach (Cue one in cues)
            {
                Keep(state, one);
            }
        }

        /// <summary>Return the candidates of a step that are over in time and have cooled down. If none, tell why.</summary>
        private static List<GraphAction> Fit(
            LayerState state,
            Bound bound,
            SamplingStep step,
            MetaRequest asked,
            double now,
            Mood mood
        )
        {
            var meta = bound.Meta;
            var fitting = step.Candidates.ToList();
            if (bound.Limit < double.PositiveInfinity) // else all fit
            {
                fitting = step.Candidates.Where(a => CueShapesRules.FitsBefore(
                    MannerRules.ShapeInMood(state, a, asked, now, mood),
                    bound.Limit
                )).ToList();
            }
            if (fitting.Count == 0)
            {
                var before = meta.Written ? "" : " before something more important";
                var left = Math.Max(0.0, bound.Limit - now);
                state.Tell(meta, "no-room", "nothing fits into the " + PlainText.Fixed(left, 2) + " s" + before);
                return fitting;
            }
            if (step.Hop != "" || meta.Request.Action != null)
            {
                return fitting;
            }
            var warm = fitting.Where(a => a.Cooldown <= 0
                || DrawingRules.FindCooled(state, a)
                    <= MannerRules.ShapeInMood(state, a, asked, now, mood).Start + CueShapesRules.Fits).ToList();
            if (warm.Count == 0)
            {
                var soonest = PlainNumbers.MinOf(fitting.Select(a => DrawingRules.FindCooled(state, a)).ToList());
                var why = "all that fit are cooling down; the first may play again at " + PlainText.Fixed(soonest, 2) + " s";
                state.Tell(meta, "cooling", why);
            }
            return warm;
        }

        /// <summary>hops: whether it is a transition on the way to the requested action.</summary>
        private static Cue Cue(
            LayerState state,
            GraphAction action,
            CueShape shape,
            Bound bound,
            bool hops,
            string stance,
            Mood mood
        )
        {
            var length = shape.Length;
            var into = Math.Max(0.0, action.Timing.BlendIn);
            var out_ = Math.Max(0.0, action.Timing.BlendOut);
            var found = state.Project.Span(action);
            double begin = found.Item1;
            double until = found.Item2;
            var cycle = RepeatingRules.CycleOf(action.Kind, action.Timing, begin, until);
            if (action.Timing.EarliestExit != null || cycle > 0)
            {
                var wish = hops ? double.PositiveInfinity : bound.Wish;
                length = Math.Min(length, Math.Max(shape.Shortest, Math.Min(bound.Limit, wish) - shape.Start));
            }
            else if (!hops)
            {
                length = Math.Min(length, PunctualityRules.FindUntil(state, action, shape, bound) - shape.Start);
                if (length < shape.Length)
                {
                    out_ = Math.Max(out_, CueShapesRules.Retraction);
                }
            }
            if (shape.Entry > begin)
            {
                into = Math.Max(into, PhaseTimesRules.LeastBlend);
            }
            var squeeze = into + out_ > 0 ? Math.Min(1.0, length / (into + out_)) : 1.0;
            var then = stance;
            if (action.Kind == "transition" && action.EndStance != null)
            {
                then = action.EndStance;
            }
            var end = shape.Start + length;
            return new Cue(
                action,
                shape.Start,
                end,
                shape.Entry,
                into * squeeze,
                out_ * squeeze,
                stance,
                then,
                bound.Meta.Key,
                shape.HoldFrom,
                shape.HoldTo,
                shape.Hold,
                MannerRules.FindExtent(state, action, mood),
                shape.Tempo,
                cycle > 0 ? begin : 0.0,
                cycle > 0 ? begin + cycle : 0.0
            );
        }

        private static void Keep(LayerState state, Cue cue)
        {
            state.Note(cue, cue.Then);
            var loop = RoutesRules.DrawLoop(state, cue.Then, cue.Meta);
            if (loop != null)
            {
                // The loop begins again under the action, so that the action's last pose meets the loop's first.
                // On joints that the action does not move, the change shows. It takes its time there, like a
                // transition.
                var partial = cue.Action.Limb != "both" || cue.Action.Joints.Count > 0 || cue.Action.JointWeights.Count > 0;
                var begin = cue.Start + cue.BlendIn;
                var until = cue.End - cue.BlendOut;
                var fade = Math.Max(0.0, until - begin);
                if (partial)
                {
                    fade = cue.Then != cue.Stance ? cue.End - cue.Start : Math.Min(LoopFade, cue.End - cue.Start);
                    begin = Math.Max(cue.Start, until - fade);
                }
                state.Rests.Add(new Rest(cue.Then, loop, until, begin, fade));
            }
        }

        /// <summary>Change between the loops of a stance in long rests, at the end of a loop.</summary>
        public static void VaryRests(LayerState state, double end)
        {
            var out_ = new List<Rest>();
            foreach (var one in state.Rests.Select((item, n) => (n, item)))
            {
                var place = one.Item1;
                var rest = one.Item2;
                out_.Add(rest);
                var loops = state.Graph.Of(rest.Stance, "stance");
                if (loops.Count < 2)
                {
                    continue;
                }
                var until = place + 1 < state.Rests.Count ? state.Rests[place + 1].FadeStart : end;
                var current = rest;
                var change = rest.Start;
                while (true)
                {
                    var found = state.Project.Span(current.Action);
                    double start = found.Item1;
                    double stop = found.Item2;
                    change += Math.Max(1.0, stop - start - current.Action.Timing.BlendIn);
                    if (!(change <= until)) // nor when it is no number
                    {
                        break;
                    }
                    var loop = RoutesRules.DrawLoop(state, rest.Stance, state.Graph.Layer + "/" + PlainText.Fixed(change, 3));
                    if (loop != null && loop.Id != current.Action.Id)
                    {
                        current = new Rest(rest.Stance, loop, change, change - LoopFade, LoopFade);
                        out_.Add(current);
                    }
                }
            }
            state.Rests = out_;
        }
    }
}
