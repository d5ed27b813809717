// Translated from metagraph/playback/planning/directing.py; change that, and translate anew.
using System;
using System.Collections.Generic;
using System.Linq;

namespace Metagraph
{
    /// <summary>
    /// What the character does of its own accord: when it acts, rests and thinks, and what it does not repeat. The times are
    /// those of `director`.
    /// </summary>
    public static class DirectingRules
    {
        /// <summary>
        /// Return whether what a model wrote is performed at a time: not out of a stance that a request holds, and as often as
        /// mode and mood say. Anything may begin a long thought, or end it.
        /// </summary>
        public static bool PerformsWritten(LayerState state, MetaAction meta, double now)
        {
            if (!MoodRules.Stirs(MoodRules.MoodAt(state.Moods, now), state.Seed, meta.Request.Id))
            {
                return false;
            }
            if (meta.Request.Kind == "transition" && state.Track.StaysAt(state.Graph.Layer, now))
            {
                return false;
            }
            if (state.Model == null || Muses(state, now) || HasMused(state, now))
            {
                return true;
            }
            return MarkovRules.Performs(state.Model, state.Seed, meta, WantedRules.ModeAt(state.Track, now));
        }

        /// <summary>
        /// Return whether what a model wrote begins at a time, which may be later than it was written for: not soon after an
        /// interruption, and nothing that would end a thought.
        /// </summary>
        public static bool MayBegin(LayerState state, MetaAction meta, double now)
        {
            if (state.Track.HushedAt(now) || !PerformsWritten(state, meta, now))
            {
                return false;
            }
            if (state.Model == null || FindLead(state, now) != "")
            {
                return true;
            }
            if (Lulls(state, now))
            {
                return false;
            }
            var there = state.Stance == DirectorRules.Musing(state.Graph.Stances);
            if (there && meta.Request.Kind == "transition" && Muses(state, now))
            {
                return false;
            }
            return MarkovRules.Performs(state.Model, state.Seed, meta, WantedRules.ModeAt(state.Track, now));
        }

        /// <summary>
        /// Return whether the arms rest at a time: after a burst of one who talks, else after any act. In a thought acts are rare
        /// anyway.
        /// </summary>
        public static bool Lulls(LayerState state, double now)
        {
            var variety = state.Project.Settings.Variety;
            if (state.Graph.Layer != "arms" || variety <= 0 || state.Cues.Count == 0 || HasMused(state, now))
            {
                return false;
            }
            var last = state.Cues[state.Cues.Count - 1];
            var mode = WantedRules.ModeAt(state.Track, now);
            if (now >= last.End + DirectorRules.MostLull || mode == "thinking")
            {
                return false;
            }
            var talks = mode == "talking";
            if (talks && last.Action.Kind == "transition") // it opens a burst
            {
                return false;
            }
            return now < last.End + DirectorRules.FindLull(state.Seed, last.Meta, talks, variety);
        }

        /// <summary>Return whether the arms take or keep the stance in which the character thinks.</summary>
        public static bool Muses(LayerState state, double now)
        {
            if (WantedRules.ModeAt(state.Track, now) != "thinking"
                || WantedRules.ModeAt(state.Track, now + DirectorRules.Muses) != "thinking")
            {
                return false;
            }
            if (state.Graph.Layer != "arms" || state.Project.Settings.Variety <= 0)
            {
                return false;
            }
            return !state.Track.StaysAt("arms", now) && DirectorRules.Musing(state.Graph.Stances) != "";
        }

        /// <summary>Return whether a thought of the character has ended just now.</summary>
        public static bool HasMused(LayerState state, double now)
        {
            if (state.Graph.Layer != "arms" || WantedRules.ModeAt(state.Track, now) == "thinking")
            {
                return false;
            }
            return state.Project.Settings.Variety > 0 && WantedRules.ModeAt(state.Track, now - DirectorRules.Mused) == "thinking";
        }

        /// <summary>
        /// Return the stance that the arms go to whatever a model wrote: the one in which the character thinks, and from there
        /// home as soon as the thought is over; "" for none.
        /// </summary>
        public static string FindLead(LayerState state, double now)
        {
            if (state.Graph.Layer != "arms" || state.Project.Settings.Variety <= 0)
            {
                return "";
            }
            var thoughtful = DirectorRules.Musing(state.Graph.Stances);
            if (thoughtful == "" || state.Track.StaysAt("arms", now))
            {
                return "";
            }
            var home = state.Graph.Start;
            var goal = "";
            if (Muses(state, now))
            {
                goal = thoughtful;
            }
            else if (state.Stance == thoughtful && home != null && WantedRules.ModeAt(state.Track, now) != "thinking")
            {
                var came = state.Moved();
                if (came >= 0 && WantedRules.ModeAt(state.Track, came) == "thinking")
                {
                    goal = home;
                }
            }
            if (goal == state.Stance || goal == "" || RoutesRules.FindHops(state, goal).Count == 0)
            {
                return "";
            }
            return goal;
        }

        /// <summary>Return the actions that the character may do by itself; see `director`.</summary>
        public static List<GraphAction> KeepFresh(LayerState state, MetaAction meta, List<GraphAction> candidates, double now)
        {
            var variety = state.Project.Settings.Variety;
            var layer = state.Graph.Layer;
            if (meta.Request.Kind == "transition")
            {
                if (now < state.Moved() + DirectorRules.Posture(layer) * variety)
                {
                    return new List<GraphAction>();
                }
                if (layer == "arms" && now < state.Acted + DirectorRules.LeastLull * variety)
                {
                    return new List<GraphAction>();
                }
                if (layer != "head")
                {
                    return candidates.ToList();
                }
                if (state.Stance == state.Graph.Start)
                {
                    var leaves = ChoiceRules.Uniform(state.Seed, meta.Key, "leaves") < DirectorRules.LeavesHome;
                    return leaves ? candidates.ToList() : new List<GraphAction>();
                }
                var home = candidates.Where(a => a.EndStance == state.Graph.Start).ToList();
                var returns = home.Count > 0 && ChoiceRules.Uniform(state.Seed, meta.Key, "home") < DirectorRules.GoesHome;
                return returns ? home : candidates.ToList();
            }
            var share = now < state.Acted + DirectorRules.LongRest * variety ? variety : variety * DirectorRules.Shorter;
            var reminded = HasShown(state, now - DirectorRules.Apart * variety);
            var converses = meta.Request.Kind == "fidget" && WantedRules.ModeAt(state.Track, now) != "idle";
            var out_ = new List<GraphAction>();
            foreach (GraphAction action in candidates)
            {
                var shows = MeasureShowing(state, action);
                if ((reminded || converses) && shows >= DirectorRules.StandsOut)
                {
                    continue;
                }
                var needed = DirectorRules.RepeatInterval(action.Kind, shows, state.Beats) * share;
                if (!state.Ended.ContainsKey(action.Id) || now >= state.Ended[action.Id] + needed)
                {
                    out_.Add(action);
                }
            }
            return out_;
        }

        /// <summary>
        /// Return the candidates for a requested fidget in a conversation without those that stand out, if others are left and no
        /// tags are requested; else all.
        /// </summary>
        public static List<GraphAction> KeepModest(LayerState state, MetaAction meta, List<GraphAction> candidates, double now)
        {
            var request = meta.Request;
            var every = candidates.ToList();
            if (request.Kind != "fidget" || request.Tags.Count > 0 || state.Project.Settings.Variety <= 0)
            {
                return every;
            }
            if (meta.Written || WantedRules.ModeAt(state.Track, now) == "idle")
            {
                return every;
            }
            var left = every.Where(a => MeasureShowing(state, a) < DirectorRules.StandsOut).ToList();
            return left.Count > 0 ? left : every;
        }

        /// <summary>
        /// Return the transitions of the arms that may play for a gesture where all gestures of the stance have played too
        /// recently, and others of another stance have not.
        /// </summary>
        public static List<GraphAction> FindMoves(LayerState state, MetaAction meta, double now)
        {
            var out_ = new List<GraphAction>();
            if (state.Graph.Layer != "arms" || meta.Request.Kind != "gesture" || state.Track.StaysAt("arms", now))
            {
                return out_;
            }
            var variety = state.Project.Settings.Variety;
            if (now < state.Moved() + DirectorRules.Posture("arms") * variety
                || now < state.Acted + DirectorRules.LeastLull * variety)
            {
                return out_;
            }
            foreach (GraphAction action in state.Graph.Of(state.Stance, "transition"))
            {
                if (RoutesRules.MayPlay(state, action) && CountFresh(state, action.EndStance, now) > 0)
                {
                    out_.Add(action);
                }
            }
            return out_;
        }

        /// <summary>Return how many gestures of a stance have not played for long enough.</summary>
        public static int CountFresh(LayerState state, string stance, double now)
        {
            if (stance == null)
            {
                return 0;
            }
            var variety = state.Project.Settings.Variety;
            var count = state.Graph.Of(stance, "gesture").Count;
            foreach (var one in state.Ended)
            {
                var ident = one.Key;
                var end = one.Value;
                var action = PlainMaps.Get(state.Graph.Actions, ident);
                if (action == null || action.Kind != "gesture" || action.Stance != stance)
                {
                    continue;
                }
                var shows = MeasureShowing(state, action);
                if (now < end + DirectorRules.RepeatInterval("gesture", shows, state.Beats) * variety)
                {
                    count -= 1;
                }
            }
            return count;
        }

        /// <summary>Return whether an act that stands out was done since a time.</summary>
        public static bool HasShown(LayerState state, double since)
        {
            foreach (var one in state.Ended)
            {
                var ident = one.Key;
                var end = one.Value;
                var action = PlainMaps.Get(state.Graph.Actions, ident);
                if (action == null || action.Kind == "transition" || end < since)
                {
                    continue;
                }
                if (MeasureShowing(state, action) >= DirectorRules.StandsOut)
                {
                    return true;
                }
            }
            return false;
        }

        /// <summary>Return how much an action stands out.</summary>
        public static double MeasureShowing(LayerState state, GraphAction action)
        {
            if (!state.Prominences.ContainsKey(action.Id))
            {
                state.Prominences[action.Id] = ProminenceRules.MeasureProminence(state.Project, action);
            }
            return state.Prominences[action.Id];
        }

        /// <summary>Return the factor by which variety changes an action's likelihood.</summary>
        public static double WeighVariety(LayerState state, GraphAction action, double now)
        {
            var variety = state.Project.Settings.Variety;
            if (variety <= 0)
            {
                return 1.0;
            }
            if (action.Kind == "transition")
            {
                var talks = state.Graph.Layer == "arms" && WantedRules.ModeAt(state.Track, now) == "talking";
                return talks ? 1.0 + CountFresh(state, action.EndStance, now) : 1.0;
            }
            if (!state.Ended.ContainsKey(action.Id))
            {
                return 1.0;
            }
            var shows = MeasureShowing(state, action);
            var needed = DirectorRules.RepeatInterval(action.Kind, shows, state.Beats) * variety;
            return DirectorRules.Freshness(now - state.Ended[action.Id], needed);
        }
    }
}
