// Translated from metagraph/playback/planning/manner.py; change that, and translate anew.
using System;
using System.Collections.Generic;
using System.Linq;

namespace Metagraph
{
    /// <summary>How an action plays in a mood: how fast, how large, for how long.</summary>
    public static class MannerRules
    {
        /// <summary>Return how an action would play for a request from `now` on, or as a step on the way to it.</summary>
        public static CueShape ShapeInMood(LayerState state, GraphAction action, MetaRequest request, double now, Mood mood)
        {
            return CueShapesRules.ShapeOf(state.Project, action, request, now, FindTempo(action, mood));
        }

        /// <summary>Return the mood in which a request is played from `at` on, or at its stroke.</summary>
        public static Mood FindMood(LayerState state, MetaRequest request, double at)
        {
            if (request == null)
            {
                return MoodRules.MoodAt(state.Moods, at);
            }
            var mood = MoodRules.MoodAt(state.Moods, request.Stroke == null ? at : request.Stroke.Value);
            if (request.Valence == null && request.Arousal == null && request.Intensity == null)
            {
                return mood;
            }
            return MoodRules.Changed(mood, request.Valence, request.Arousal, request.Intensity);
        }

        /// <summary>Return the speed of an action in a mood, 1 if it was made for the mood.</summary>
        public static double FindTempo(GraphAction action, Mood mood)
        {
            return (mood.Neutral || MoodRules.MadeFor(mood, action.Tags)) ? 1.0 : MoodRules.Tempo(mood);
        }

        /// <summary>
        /// Return the extent of an action in a mood. Actions that move the feet, lead to another stance, touch something or were
        /// made for the mood keep their extent.
        /// </summary>
        public static double FindExtent(LayerState state, GraphAction action, Mood mood)
        {
            if (state.Graph.Layer == "body" || action.Kind == "transition" || mood.Neutral)
            {
                return 1.0;
            }
            return (action.Contacts.Count > 0 || action.Tags.Contains(MoodRules.Held) || MoodRules.MadeFor(mood, action.Tags))
                ? 1.0
                : MoodRules.Extent(mood);
        }
    }
}
