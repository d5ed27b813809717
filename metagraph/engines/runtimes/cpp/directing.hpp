// What the character does of its own accord: when it acts, rests and thinks, and what it does not repeat. The times are
// those of `director`.
//
// Translated from metagraph/playback/planning/directing.py; change that, and translate anew.
#pragma once

#include "model.hpp"
#include "wanted.hpp"
#include "meta_plan.hpp"
#include "choice.hpp"
#include "director.hpp"
#include "layer_state.hpp"
#include "markov.hpp"
#include "mood.hpp"
#include "prominence.hpp"
#include "routes.hpp"
#include "language.hpp"

namespace metagraph {


namespace directing {

inline bool performs_written(const Ref<LayerState>& state, const Ref<MetaAction>& meta, double now);
inline bool may_begin(const Ref<LayerState>& state, const Ref<MetaAction>& meta, double now);
inline bool lulls(const Ref<LayerState>& state, double now);
inline bool muses(const Ref<LayerState>& state, double now);
inline bool has_mused(const Ref<LayerState>& state, double now);
inline std::string find_lead(const Ref<LayerState>& state, double now);
inline List<Ref<Action>> keep_fresh(
    const Ref<LayerState>& state,
    const Ref<MetaAction>& meta,
    const List<Ref<Action>>& candidates,
    double now
);
inline List<Ref<Action>> keep_modest(
    const Ref<LayerState>& state,
    const Ref<MetaAction>& meta,
    const List<Ref<Action>>& candidates,
    double now
);
inline List<Ref<Action>> find_moves(const Ref<LayerState>& state, const Ref<MetaAction>& meta, double now);
inline int count_fresh(const Ref<LayerState>& state, const std::optional<std::string>& stance, double now);
inline bool has_shown(const Ref<LayerState>& state, double since);
inline double measure_showing(const Ref<LayerState>& state, const Ref<Action>& action);
inline double weigh_variety(const Ref<LayerState>& state, const Ref<Action>& action, double now);

}  // namespace directing

namespace directing {

/// Return whether what a model wrote is performed at a time: not out of a stance that a request holds, and as often as
/// mode and mood say. Anything may begin a long thought, or end it.
inline bool performs_written(const Ref<LayerState>& state, const Ref<MetaAction>& meta, double now) {
    if (!mood::stirs(mood::mood_at(state->moods, now), state->seed, meta->request->id)) {
        return false;
    }
    if (meta->request->kind == "transition" && state->track->stays_at(state->graph->layer, now)) {
        return false;
    }
    if (state->model == nullptr || directing::muses(state, now) || directing::has_mused(state, now)) {
        return true;
    }
    return markov::performs(state->model, state->seed, meta, wanted::mode_at(state->track, now));
}

/// Return whether what a model wrote begins at a time, which may be later than it was written for: not soon after an
/// interruption, and nothing that would end a thought.
inline bool may_begin(const Ref<LayerState>& state, const Ref<MetaAction>& meta, double now) {
    if (state->track->hushed_at(now) || !directing::performs_written(state, meta, now)) {
        return false;
    }
    if (state->model == nullptr || directing::find_lead(state, now) != "") {
        return true;
    }
    if (directing::lulls(state, now)) {
        return false;
    }
    bool there = state->stance == director::musing(state->graph->stances);
    if (there && meta->request->kind == "transition" && directing::muses(state, now)) {
        return false;
    }
    return markov::performs(state->model, state->seed, meta, wanted::mode_at(state->track, now));
}

/// Return whether the arms rest at a time: after a burst of one who talks, else after any act. In a thought acts are
/// rare anyway.
inline bool lulls(const Ref<LayerState>& state, double now) {
    double variety = state->project->settings->variety;
    if (state->graph->layer != "arms"
        || variety <= 0
        || lang::len(state->cues) == 0
        || directing::has_mused(state, now)) {
        return false;
    }
    Ref<Cue> last = lang::at(state->cues, -1);
    std::string mode = wanted::mode_at(state->track, now);
    if (now >= last->end + director::MOST_LULL || mode == "thinking") {
        return false;
    }
    bool talks = mode == "talking";
    if (talks && last->action->kind == "transition") { // it opens a burst
        return false;
    }
    return now < last->end + director::find_lull(state->seed, last->meta, talks, variety);
}

/// Return whether the arms take or keep the stance in which the character thinks.
inline bool muses(const Ref<LayerState>& state, double now) {
    if (wanted::mode_at(state->track, now) != "thinking"
        || wanted::mode_at(state->track, now + director::MUSES) != "thinking") {
        return false;
    }
    if (state->graph->layer != "arms" || state->project->settings->variety <= 0) {
        return false;
    }
    return !state->track->stays_at("arms", now) && director::musing(state->graph->stances) != "";
}

/// Return whether a thought of the character has ended just now.
inline bool has_mused(const Ref<LayerState>& state, double now) {
    if (state->graph->layer != "arms" || wanted::mode_at(state->track, now) == "thinking") {
        return false;
    }
    return state->project->settings->variety > 0 && wanted::mode_at(state->track, now - director::MUSED) == "thinking";
}

/// Return the stance that the arms go to whatever a model wrote: the one in which the character thinks, and from there
/// home as soon as the thought is over; "" for none.
inline std::string find_lead(const Ref<LayerState>& state, double now) {
    if (state->graph->layer != "arms" || state->project->settings->variety <= 0) {
        return "";
    }
    std::string thoughtful = director::musing(state->graph->stances);
    if (thoughtful == "" || state->track->stays_at("arms", now)) {
        return "";
    }
    std::optional<std::string> home = state->graph->start;
    std::string goal = "";
    if (directing::muses(state, now)) {
        goal = thoughtful;
    } else if (state->stance == thoughtful && home.has_value() && wanted::mode_at(state->track, now) != "thinking") {
        double came = state->moved();
        if (came >= 0 && wanted::mode_at(state->track, came) == "thinking") {
            goal = *home;
        }
    }
    if (goal == state->stance || goal == "" || lang::len(routes::find_hops(state, goal)) == 0) {
        return "";
    }
    return goal;
}

/// Return the actions that the character may do by itself; see `director`.
inline List<Ref<Action>> keep_fresh(
    const Ref<LayerState>& state,
    const Ref<MetaAction>& meta,
    const List<Ref<Action>>& candidates,
    double now
) {
    double variety = state->project->settings->variety;
    std::string layer = state->graph->layer;
    if (meta->request->kind == "transition") {
        if (now < state->moved() + director::posture(layer) * variety) {
            return List<Ref<Action>>{};
        }
        if (layer == "arms" && now < state->acted + director::LEAST_LULL * variety) {
            return List<Ref<Action>>{};
        }
        if (layer != "head") {
            return candidates;
        }
        if (state->stance == state->graph->start) {
            bool leaves = choice::uniform(state->seed, List<std::string>{meta->key(), "leaves"})
                < director::LEAVES_HOME;
            return leaves ? candidates : List<Ref<Action>>{};
        }
        List<Ref<Action>> home;
        for (const auto& a : candidates) {
            if (a->end_stance == state->graph->start) {
                home.push_back(a);
            }
        }
        bool returns = lang::len(home) > 0
            && choice::uniform(state->seed, List<std::string>{meta->key(), "home"}) < director::GOES_HOME;
        return returns ? home : candidates;
    }
    double share = now < state->acted + director::LONG_REST * variety ? variety : variety * director::SHORTER;
    bool reminded = directing::has_shown(state, now - director::APART * variety);
    bool converses = meta->request->kind == "fidget" && wanted::mode_at(state->track, now) != "idle";
    List<Ref<Action>> out;
    for (const auto& action : candidates) {
        double shows = directing::measure_showing(state, action);
        if ((reminded || converses) && shows >= director::STANDS_OUT) {
            continue;
        }
        double needed = director::repeat_interval(action->kind, shows, state->beats) * share;
        if (!lang::contains(state->ended, action->id) || now >= state->ended.at(action->id) + needed) {
            out.push_back(action);
        }
    }
    return out;
}

/// Return the candidates for a requested fidget in a conversation without those that stand out, if others are left and
/// no tags are requested; else all.
inline List<Ref<Action>> keep_modest(
    const Ref<LayerState>& state,
    const Ref<MetaAction>& meta,
    const List<Ref<Action>>& candidates,
    double now
) {
    Ref<MetaRequest> request = meta->request;
    List<Ref<Action>> every = candidates;
    if (request->kind != "fidget" || lang::len(request->tags) > 0 || state->project->settings->variety <= 0) {
        return every;
    }
    if (meta->written || wanted::mode_at(state->track, now) == "idle") {
        return every;
    }
    List<Ref<Action>> left;
    for (const auto& a : every) {
        if (directing::measure_showing(state, a) < director::STANDS_OUT) {
            left.push_back(a);
        }
    }
    return lang::len(left) > 0 ? left : every;
}

/// Return the transitions of the arms that may play for a gesture where all gestures of the stance have played too
/// recently, and others of another stance have not.
inline List<Ref<Action>> find_moves(const Ref<LayerState>& state, const Ref<MetaAction>& meta, double now) {
    List<Ref<Action>> out;
    if (state->graph->layer != "arms" || meta->request->kind != "gesture" || state->track->stays_at("arms", now)) {
        return out;
    }
    double variety = state->project->settings->variety;
    if (now < state->moved() + director::posture("arms") * variety
        || now < state->acted + director::LEAST_LULL * variety) {
        return out;
    }
    for (const auto& action : state->graph->of(state->stance, "transition")) {
        if (routes::may_play(state, action) && directing::count_fresh(state, action->end_stance, now) > 0) {
            out.push_back(action);
        }
    }
    return out;
}

/// Return how many gestures of a stance have not played for long enough.
inline int count_fresh(const Ref<LayerState>& state, const std::optional<std::string>& stance, double now) {
    if (!stance.has_value()) {
        return 0;
    }
    double variety = state->project->settings->variety;
    int count = lang::len(state->graph->of(*stance, "gesture"));
    for (const auto& [ident, end] : state->ended) {
        Ref<Action> action = lang::get(state->graph->actions, ident);
        if (action == nullptr || action->kind != "gesture" || action->stance != *stance) {
            continue;
        }
        double shows = directing::measure_showing(state, action);
        if (now < end + director::repeat_interval("gesture", shows, state->beats) * variety) {
            count -= 1;
        }
    }
    return count;
}

/// Return whether an act that stands out was done since a time.
inline bool has_shown(const Ref<LayerState>& state, double since) {
    for (const auto& [ident, end] : state->ended) {
        Ref<Action> action = lang::get(state->graph->actions, ident);
        if (action == nullptr || action->kind == "transition" || end < since) {
            continue;
        }
        if (directing::measure_showing(state, action) >= director::STANDS_OUT) {
            return true;
        }
    }
    return false;
}

/// Return how much an action stands out.
inline double measure_showing(const Ref<LayerState>& state, const Ref<Action>& action) {
    if (!lang::contains(state->prominences, action->id)) {
        state->prominences[action->id] = prominence::measure_prominence(state->project, action);
    }
    return state->prominences.at(action->id);
}

/// Return the factor by which variety changes an action's likelihood.
inline double weigh_variety(const Ref<LayerState>& state, const Ref<Action>& action, double now) {
    double variety = state->project->settings->variety;
    if (variety <= 0) {
        return 1.0;
    }
    if (action->kind == "transition") {
        bool talks = state->graph->layer == "arms" && wanted::mode_at(state->track, now) == "talking";
        return talks ? 1.0 + directing::count_fresh(state, action->end_stance, now) : 1.0;
    }
    if (!lang::contains(state->ended, action->id)) {
        return 1.0;
    }
    double shows = directing::measure_showing(state, action);
    double needed = director::repeat_interval(action->kind, shows, state->beats) * variety;
    return director::freshness(now - state->ended.at(action->id), needed);
}

}  // namespace directing

}  // namespace metagraph
