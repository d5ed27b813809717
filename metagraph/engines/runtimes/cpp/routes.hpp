// Which actions can play on a layer, and the way from stance to stance.
//
// Translated from metagraph/playback/planning/routes.py; change that, and translate anew.
#pragma once

#include "model.hpp"
#include "meta_plan.hpp"
#include "choice.hpp"
#include "layer_state.hpp"
#include "language.hpp"

namespace metagraph {

struct SamplingStep;

namespace routes {

inline bool may_play(const Ref<LayerState>& state, const Ref<Action>& action);
inline bool arrives(const Ref<LayerState>& state, const Ref<Action>& action);
inline List<std::string> find_hops(const Ref<LayerState>& state, const std::string& goal);
inline std::string name_elsewhere(const Ref<LayerState>& state, const Ref<MetaRequest>& request);
inline Ref<Action> draw_loop(const Ref<LayerState>& state, const std::string& stance, const std::string& key);
inline std::optional<List<Ref<SamplingStep>>> find_route(
    const Ref<LayerState>& state,
    const Ref<MetaAction>& meta,
    const std::string& goal
);

}  // namespace routes

/// One action of a chain: the candidates for it and, for a transition on the way, the stance it leads to.
struct SamplingStep {
    List<Ref<Action>> candidates;
    std::string hop;

    explicit SamplingStep(List<Ref<Action>> candidates_, std::string hop_ = "")
        : candidates(std::move(candidates_)), hop(std::move(hop_)) {}
};

namespace routes {

inline bool may_play(const Ref<LayerState>& state, const Ref<Action>& action) {
    return action->likelihood > 0 && routes::arrives(state, action);
}

/// Return whether an action leaves the layer in a stance that has a loop.
inline bool arrives(const Ref<LayerState>& state, const Ref<Action>& action) {
    std::optional<std::string> end = action->end_stance;
    if (action->kind != "transition") {
        return true;
    }
    return end.has_value()
        && lang::contains(state->graph->stances, *end)
        && lang::len(state->graph->of(*end, "stance")) > 0;
}

/// Return the stances after the current one on the shortest way of transitions that can play, the goal last; empty if
/// there is no way. Among equally short ways, the one whose transitions were placed first.
inline List<std::string> find_hops(const Ref<LayerState>& state, const std::string& goal) {
    Map<std::string, std::string> before = Map<std::string, std::string>{{state->stance, ""}};
    List<std::string> queue = List<std::string>{state->stance};
    int at = 0; // what is before it was looked at
    while (at < lang::len(queue) && !lang::contains(before, goal)) {
        std::string stance = lang::at(queue, at);
        at += 1;
        for (const auto& action : state->graph->of(stance, "transition")) {
            std::optional<std::string> end = action->end_stance;
            if (!end.has_value() || lang::contains(before, *end) || !lang::contains(state->graph->stances, *end)) {
                continue;
            }
            if (routes::may_play(state, action)) {
                before[*end] = stance;
                queue.push_back(*end);
            }
        }
    }
    List<std::string> way;
    if (!lang::contains(before, goal)) {
        return way;
    }
    std::string step = goal;
    while (step != state->stance) {
        way.push_back(step);
        step = before.at(step);
    }
    return lang::backwards(way);
}

inline std::string name_elsewhere(const Ref<LayerState>& state, const Ref<MetaRequest>& request) {
    for (const auto& action : lang::values(state->graph->actions)) {
        bool holds = action->kind == request->kind;
        if (holds) {
            bool are_all = true;
            for (const auto& tag : request->tags) {
                if (!lang::contains(action->tags, tag)) {
                    are_all = false;
                    break;
                }
            }
            holds = are_all;
        }
        if (holds) {
            holds = !request->limb.has_value() || *request->limb == action->limb;
        }
        bool fits = holds;
        if (fits && lang::contains(state->graph->stances, action->stance)) {
            return lang::text("; there is one in '", state->graph->stances.at(action->stance)->name, "'");
        }
    }
    return "";
}

/// Return one of a stance's loops, drawn by likelihood; None if it has none.
inline Ref<Action> draw_loop(const Ref<LayerState>& state, const std::string& stance, const std::string& key) {
    List<Ref<Action>> loops = state->graph->of(stance, "stance");
    if (lang::len(loops) == 1) {
        return lang::at(loops, 0);
    }
    Map<std::string, double> weights;
    for (const auto& a : loops) {
        if (a->likelihood > 0) {
            weights[a->id] = a->likelihood;
        }
    }
    if (lang::len(weights) == 0) {
        return lang::len(loops) > 0 ? lang::at(loops, 0) : nullptr;
    }
    std::string chosen = choice::pick(state->seed, key, "loop", weights);
    Ref<Action> first;
    for (const auto& a : loops) {
        if (a->id == chosen) {
            first = a;
            break;
        }
    }
    return first;
}

/// Return the transitions hop by hop from the current stance to `goal`.
inline std::optional<List<Ref<SamplingStep>>> find_route(
    const Ref<LayerState>& state,
    const Ref<MetaAction>& meta,
    const std::string& goal
) {
    if (goal == state->stance) {
        std::string name = state->graph->stances.at(goal)->name;
        state->tell(meta, "already-there", lang::text("the layer is in '", name, "' already"), true);
        return std::nullopt;
    }
    List<std::string> stances = routes::find_hops(state, goal);
    if (lang::len(stances) == 0) {
        std::string a = state->graph->stances.at(state->stance)->name;
        std::string b = state->graph->stances.at(goal)->name;
        state->tell(meta, "no-way", lang::text("no chain of transitions leads from '", a, "' to '", b, "'"));
        return std::nullopt;
    }
    List<Ref<SamplingStep>> steps;
    std::string at = state->stance;
    for (const auto& following : stances) {
        List<Ref<Action>> hops;
        for (const auto& a2 : state->graph->of(at, "transition")) {
            if (a2->end_stance == following && routes::may_play(state, a2)) {
                hops.push_back(a2);
            }
        }
        steps.push_back(lang::made<SamplingStep>(hops, following));
        at = following;
    }
    return steps;
}

}  // namespace routes

}  // namespace metagraph
