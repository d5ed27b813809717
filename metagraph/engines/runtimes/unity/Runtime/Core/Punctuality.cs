// Translated from metagraph/playback/planning/punctuality.py; change that, and translate anew.
using System;
using System.Collections.Generic;
using System.Linq;

namespace Metagraph
{
    /// <summary>
    /// Which actions meet the moment that a request names, and when an action has to be over for the next one.
    /// </summary>
    public static class PunctualityRules
    {
        /// <summary>
        /// Return the candidates that come least late, if that is not too late; among them those that leave the following
        /// requests the most time and serve the most of them.
        /// </summary>
        public static List<GraphAction> KeepTimely(LayerState state, Bound bound, List<GraphAction> fitting, double now)
        {
            var meta = bound.Meta;
            var request = meta.Request;
            var allowed = CueShapesRules.SlackOf(request);
            var mood = MannerRules.FindMood(state, request, now);
            var late = fitting.Select(a => (
                a.Id,
                CueShapesRules.Lateness(state.Project, a, request, MannerRules.ShapeInMood(state, a, request, now, mood))
            )).ToMap();
            var least = PlainNumbers.MinOf(fitting.Select(a => late[a.Id]).ToList());
            string waits = default(string);
            if (least > allowed + CueShapesRules.Fits)
            {
                waits = TellCause(state, request, now);
                state.Tell(
                    meta,
                    "too-late",
                    "would come "
                        + PlainText.Fixed(least, 2)
                        + " s late, "
                        + PlainText.Fixed(allowed, 2)
                        + " s are allowed; it waits for "
                        + waits,
                    false,
                    least
                );
                return new List<GraphAction>();
            }
            if (least > CueShapesRules.Fits)
            {
                waits = TellCause(state, request, now);
                state.Tell(meta, "late", "comes " + PlainText.Fixed(least, 2) + " s late; it waits for " + waits, true, least);
            }
            var timely = fitting.Where(a => late[a.Id] <= Math.Max(least, 0.0) + CueShapesRules.Fits).ToList();
            foreach (MetaAction other in bound.After)
            {
                if (!CueShapesRules.MayShare(request, other.Request))
                {
                    continue;
                }
                var both = timely.Where(a => CueShapesRules.Meets(a, other.Request)).ToList();
                var behind = 0.0;
                if (request.Stroke != null && other.Request.Stroke != null)
                {
                    behind = Math.Max(0.0, request.Stroke.Value + Math.Max(least, 0.0) - other.Request.Stroke.Value);
                }
                if (both.Count > 0 && other.Request.Late != null && behind <= other.Request.Late.Value + CueShapesRules.Fits)
                {
                    timely = both;
                    state.Served.Add(other.Key);
                    var message = "shares the stroke of '" + request.Id + "'";
                    state.Tell(other, "shared", message, true, behind, meta.Key);
                }
            }
            var following = bound.After.Where(other => !state.Served.Contains(other.Key)).ToList();
            foreach (MetaAction other in following)
            {
                foreach (double slack in new List<double> { 0.0, CueShapesRules.SlackOf(other.Request) })
                {
                    var by = FindLatest(state, other.Request) + slack;
                    var over = timely.Where(a => FindOver(state, a, request, now) <= by).ToList();
                    if (over.Count > 0)
                    {
                        return over;
                    }
                }
            }
            return timely;
        }

        /// <summary>Return the reason why a request comes late.</summary>
        public static string TellCause(LayerState state, MetaRequest request, double now)
        {
            if (now <= request.Start + CueShapesRules.Fits)
            {
                return "its own preparation";
            }
            if (state.Cues.Count > 0
                && state.Ready >= now - CueShapesRules.Fits
                && state.Cues[state.Cues.Count - 1].End >= state.Free - CueShapesRules.Fits)
            {
                return "'"
                    + state.Cues[state.Cues.Count - 1].Action.Name
                    + "', which plays until "
                    + PlainText.Fixed(state.Free, 2)
                    + " s";
            }
            return state.Cues.Count > 0 ? "what comes before it" : "the time it became known at";
        }

        /// <summary>
        /// Return the latest time at which a requested action has to begin to be on time; never in the past.
        /// </summary>
        public static double FindLatest(LayerState state, MetaRequest request)
        {
            if (request.Stroke == null)
            {
                return request.Start;
            }
            var least = double.PositiveInfinity;
            foreach (GraphAction action in state.Graph.Of(state.Stance, request.Kind))
            {
                var fits = CueShapesRules.Meets(action, request);
                if (request.Action != null)
                {
                    fits = action.Id == request.Action;
                }
                if (!fits || !RoutesRules.MayPlay(state, action))
                {
                    continue;
                }
                if (action.Kind != "gesture") // it has no stroke: it should begin when its request does
                {
                    least = Math.Min(least, request.Stroke.Value - request.Start);
                }
                else
                {
                    var found = PhasesRules.FindPhases(state.Project, action);
                    var lead = found.Stroke - found.Skip(action.Timing.BlendIn);
                    var speed = MannerRules.FindTempo(action, MannerRules.FindMood(state, request, request.Stroke.Value));
                    least = Math.Min(least, lead + MoodRules.Drag(lead, speed));
                }
            }
            return request.Stroke.Value - least;
        }

        /// <summary>Return the earliest time at which the next action could begin after this one.</summary>
        public static double FindOver(LayerState state, GraphAction action, MetaRequest request, double now)
        {
            var shape = MannerRules.ShapeInMood(state, action, request, now, MannerRules.FindMood(state, request, now));
            return shape.Start + CueShapesRules.Hurried(state.Project, action, shape) + state.Project.Settings.Rest
                - CueShapesRules.Fits;
        }

        /// <summary>
        /// Return when an action that should play to its end is left early all the same: early enough for the first following
        /// request that can then be in time, late enough for its own stroke; infinity for never.
        /// </summary>
        public static double FindUntil(LayerState state, GraphAction action, CueShape shape, Bound bound)
        {
            if (bound.After.Count == 0)
            {
                return double.PositiveInfinity;
            }
            var rest = state.Project.Settings.Rest;
            var soonest = shape.Start + CueShapesRules.Hurried(state.Project, action, shape);
            foreach (MetaAction other in bound.After)
            {
                var inTime = FindLatest(state, other.Request) + CueShapesRules.SlackOf(other.Request);
                if (!state.Served.Contains(other.Key) && soonest + rest <= inTime + CueShapesRules.Fits)
                {
                    return Math.Max(soonest, BoundsRules.Begins(other) - rest);
                }
            }
            return double.PositiveInfinity;
        }
    }
}
