// How an action plays in a mood: how fast, how large, for how long.
//
// Translated from metagraph/playback/planning/manner.py; change that, and translate anew.
#pragma once

#include "model.hpp"
#include "meta_plan.hpp"
#include "cue_shapes.hpp"
#include "layer_state.hpp"
#include "mood.hpp"
#include "language.hpp"

namespace metagraph {


namespace manner {

inline Ref<CueShape> shape_in_mood(
    const Ref<LayerState>& state,
    const Ref<Action>& action,
    const Ref<MetaRequest>& request,
    double now,
    const Ref<Mood>& mood
);
inline Ref<Mood> find_mood(const Ref<LayerState>& state, const Ref<MetaRequest>& request, double at);
inline double find_tempo(const Ref<Action>& action, const Ref<Mood>& mood);
inline double find_extent(const Ref<LayerState>& state, const Ref<Action>& action, const Ref<Mood>& mood);

}  // namespace manner

namespace manner {

/// Return how an action would play for a request from `now` on, or as a step on the way to it.
inline Ref<CueShape> shape_in_mood(
    const Ref<LayerState>& state,
    const Ref<Action>& action,
    const Ref<MetaRequest>& request,
    double now,
    const Ref<Mood>& mood
) {
    return cue_shapes::shape_of(state->project, action, request, now, manner::find_tempo(action, mood));
}

/// Return the mood in which a request is played from `at` on, or at its stroke.
inline Ref<Mood> find_mood(const Ref<LayerState>& state, const Ref<MetaRequest>& request, double at) {
    if (request == nullptr) {
        return mood::mood_at(state->moods, at);
    }
    Ref<Mood> mood = mood::mood_at(state->moods, !request->stroke.has_value() ? at : *request->stroke);
    if (!request->valence.has_value() && !request->arousal.has_value() && !request->intensity.has_value()) {
        return mood;
    }
    return mood::changed(mood, request->valence, request->arousal, request->intensity);
}

/// Return the speed of an action in a mood, 1 if it was made for the mood.
inline double find_tempo(const Ref<Action>& action, const Ref<Mood>& mood) {
    return (mood->neutral() || mood::made_for(mood, action->tags)) ? 1.0 : mood::tempo(mood);
}

/// Return the extent of an action in a mood. Actions that move the feet, lead to another stance, touch something or
/// were made for the mood keep their extent.
inline double find_extent(const Ref<LayerState>& state, const Ref<Action>& action, const Ref<Mood>& mood) {
    if (state->graph->layer == "body" || action->kind == "transition" || mood->neutral()) {
        return 1.0;
    }
    return (lang::len(action->contacts) > 0
            || lang::contains(action->tags, mood::HELD)
            || mood::made_for(mood, action->tags))
        ? 1.0
        : mood::extent(mood);
}

}  // namespace manner

}  // namespace metagraph
