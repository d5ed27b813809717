// Translated from metagraph/playback/planning/leaving.py; change that, and translate anew.
using System;
using System.Collections.Generic;
using System.Linq;

namespace Metagraph
{
    /// <summary>
    /// How a running action is left early: for a request that can then be in time, or because it was stopped.
    /// </summary>
    public static class LeavingRules
    {
        /// <summary>
        /// Leave the running action early for the first request that can then be in time, or if it was `stopped`. An action that
        /// a model wrote, or that is less important, is left at once; others are left where their retraction begins.
        /// </summary>
        public static void MakeWay(LayerState state, MetaAction running, List<MetaAction> asked, double now, bool stopped)
        {
            if (stopped)
            {
                Retract(state, now);
                return;
            }
            var cue = state.Cues[state.Cues.Count - 1];
            if (running == null || cue.Action.Kind == "transition" || cue.End - cue.BlendOut <= now)
            {
                return;
            }
            var atOnce = now + Math.Max(cue.BlendOut, CueShapesRules.Retraction);
            var retracts = atOnce;
            if (!running.Written)
            {
                var once = cue.End - cue.Start;
                if (cue.Repeats)
                {
                    once = Math.Min(
                        once,
                        (cue.CycleTo - cue.Entry) / cue.Tempo + Math.Max(cue.BlendOut, CueShapesRules.Retraction)
                    );
                }
                var shape = new CueShape(
                    cue.Start,
                    cue.Entry,
                    cue.End - cue.Start,
                    once,
                    cue.HoldFrom,
                    cue.HoldTo,
                    cue.Hold,
                    cue.Tempo
                );
                retracts = Math.Max(atOnce, cue.Start + CueShapesRules.Hurried(state.Project, cue.Action, shape));
            }
            var rest = state.Project.Settings.Rest;
            foreach (MetaAction meta in asked)
            {
                var request = meta.Request;
                var inTime = PunctualityRules.FindLatest(state, request) + CueShapesRules.SlackOf(request);
                var soonest = meta.Rank > running.Rank ? atOnce : retracts;
                if (request.Late == null || meta.Rank < running.Rank || inTime < soonest + rest - CueShapesRules.Fits)
                {
                    continue;
                }
                var end = Math.Max(soonest, BoundsRules.Begins(meta) - rest);
                if (end < cue.End)
                {
                    var out_ = Math.Max(cue.BlendOut, CueShapesRules.Retraction);
                    var into = Math.Min(cue.BlendIn, Math.Max(0.0, end - out_ - cue.Start));
                    state.Cues[state.Cues.Count - 1] = new Cue(
                        cue.Action,
                        cue.Start,
                        end,
                        cue.Entry,
                        into,
                        out_,
                        cue.Stance,
                        cue.Then,
                        cue.Meta,
                        cue.HoldFrom,
                        cue.HoldTo,
                        cue.Hold,
                        cue.Extent,
                        cue.Tempo,
                        cue.CycleFrom,
                        cue.CycleTo
                    );
                    state.Free = end;
                    state.Ended[cue.Action.Id] = end;
                }
                return;
            }
        }

        /// <summary>
        /// Leave the running action: it returns to its stance from where it is. A transition ends in the stance it leads to.
        /// </summary>
        public static void Retract(LayerState state, double now)
        {
            var cue = state.Cues[state.Cues.Count - 1];
            var end = now + CueShapesRules.Stopped;
            if (cue.Action.Kind == "transition" || cue.End - cue.BlendOut <= now || cue.End <= end)
            {
                return;
            }
            state.Cues[state.Cues.Count - 1] = new Cue(
                cue.Action,
                cue.Start,
                end,
                cue.Entry,
                cue.BlendIn,
                CueShapesRules.Stopped,
                cue.Stance,
                cue.Then,
                cue.Meta,
                cue.HoldFrom,
                cue.HoldTo,
                cue.Hold,
                cue.Extent,
                cue.Tempo,
                cue.CycleFrom,
                cue.CycleTo
            );
            state.Free = end;
            state.Ended[cue.Action.Id] = end;
        }
    }
}
