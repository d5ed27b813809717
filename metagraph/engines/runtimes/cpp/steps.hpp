// Which actions a meta action may become: the transitions on the way, then the candidates.
//
// Translated from metagraph/playback/planning/steps.py; change that, and translate anew.
#pragma once

#include "model.hpp"
#include "meta_plan.hpp"
#include "directing.hpp"
#include "layer_state.hpp"
#include "remembering.hpp"
#include "routes.hpp"
#include "project.hpp"
#include "language.hpp"

namespace metagraph {


namespace steps {

inline std::optional<List<Ref<SamplingStep>>> choose_steps(
    const Ref<LayerState>& state,
    const Ref<MetaAction>& meta,
    double now
);
inline List<Ref<Action>> _find_candidates(const Ref<LayerState>& state, const Ref<MetaAction>& meta, double now);

}  // namespace steps

namespace steps {

/// Return each action in turn: the transitions to get there, then the action itself; None if it is impossible or not
/// needed, or if the model wrote it and every candidate played too recently.
inline std::optional<List<Ref<SamplingStep>>> choose_steps(
    const Ref<LayerState>& state,
    const Ref<MetaAction>& meta,
    double now
) {
    Ref<MetaRequest> request = meta->request;
    Ref<MetaGraph> graph = state->graph;
    if (request->action.has_value()) {
        Ref<Action> action = lang::get(graph->actions, *request->action);
        if (action == nullptr || !lang::contains(graph->stances, action->stance)) {
            state->tell(
                meta,
                "unknown-action",
                lang::text("there is no action '", *request->action, "' in the ", graph->layer, " layer")
            );
            return std::nullopt;
        }
        if (action->kind == "stance") {
            return routes::find_route(state, meta, action->stance);
        }
        if (!routes::arrives(state, action)) {
            state->tell(meta, "no-stance", lang::text("'", action->name, "' ends in a stance that has no loop"));
            return std::nullopt;
        }
        if (action->stance == state->stance) {
            return List<Ref<SamplingStep>>{lang::made<SamplingStep>(List<Ref<Action>>{action})};
        }
        std::optional<List<Ref<SamplingStep>>> way = routes::find_route(state, meta, action->stance);
        return !way.has_value()
            ? std::nullopt
            : std::optional<List<Ref<SamplingStep>>>(lang::together(
                *way,
                List<Ref<SamplingStep>>{lang::made<SamplingStep>(List<Ref<Action>>{action})}
            ));
    }
    if (request->stance.has_value() && lang::contains(List<std::string>{"transition", "stance"}, request->kind)) {
        if (!lang::contains(graph->stances, *request->stance)) {
            state->tell(
                meta,
                "no-stance",
                lang::text("there is no stance '", *request->stance, "' in the ", graph->layer, " layer")
            );
            return std::nullopt;
        }
        return routes::find_route(state, meta, *request->stance);
    }
    std::string leads = meta->written ? directing::find_lead(state, now) : std::string("");
    if (leads != "") {
        return routes::find_route(state, meta, leads);
    }
    List<Ref<Action>> found = steps::_find_candidates(state, meta, now);
    return lang::len(found) == 0
        ? std::nullopt
        : std::optional<List<Ref<SamplingStep>>>(List<Ref<SamplingStep>>{lang::made<SamplingStep>(found)});
}

/// Return the actions of the current stance that fit, none if every one played too recently for what the model wrote.
inline List<Ref<Action>> _find_candidates(const Ref<LayerState>& state, const Ref<MetaAction>& meta, double now) {
    Ref<MetaRequest> request = meta->request;
    Ref<MetaGraph> graph = state->graph;
    std::string here = remembering::node(state->stance, request->kind);
    if (!lang::contains(state->candidates, here)) {
        List<Ref<Action>> found2;
        for (const auto& a : graph->of(state->stance, request->kind)) {
            if (routes::may_play(state, a)) {
                found2.push_back(a);
            }
        }
        state->candidates[here] = found2;
    }
    List<Ref<Action>> every = state->candidates.at(here);
    if (lang::len(request->among) > 0) {
        List<Ref<Action>> found3;
        for (const auto& a : every) {
            if (lang::contains(request->among, a->id)) {
                found3.push_back(a);
            }
        }
        every = found3;
    }
    List<Ref<Action>> found = every;
    if (lang::len(request->tags) > 0) {
        List<Ref<Action>> found4;
        for (const auto& a : every) {
            bool are_all = true;
            for (const auto& tag : request->tags) {
                if (!lang::contains(a->tags, tag)) {
                    are_all = false;
                    break;
                }
            }
            if (are_all) {
                found4.push_back(a);
            }
        }
        found = found4;
    }
    List<Ref<Action>> exact = found;
    if (request->limb.has_value()) {
        List<Ref<Action>> found5;
        for (const auto& a : found) {
            if (a->limb == *request->limb) {
                found5.push_back(a);
            }
        }
        exact = found5;
    }
    bool directed = meta->written && state->project->settings->variety > 0;
    if (directed) { // the model's limb and tags are wishes, not orders
        every = directing::keep_fresh(state, meta, every, now);
        Set<std::string> fresh;
        for (const auto& a : every) {
            fresh.insert(a->id);
        }
        List<Ref<Action>> found6;
        for (const auto& a : found) {
            if (lang::contains(fresh, a->id)) {
                found6.push_back(a);
            }
        }
        found = found6;
        List<Ref<Action>> found7;
        for (const auto& a : exact) {
            if (lang::contains(fresh, a->id)) {
                found7.push_back(a);
            }
        }
        exact = found7;
        if (lang::len(every) == 0) {
            return directing::find_moves(state, meta, now);
        }
        if (lang::len(exact) == 0) {
            exact = lang::len(found) > 0 ? found : every;
        }
    } else if (meta->written) { // nor worth playing the same again
        List<std::string> again = lang::part(lang::get_or(state->recent, here, List<std::string>{}), -1);
        bool is_any = false;
        for (const auto& a : exact) {
            if (!lang::contains(again, a->id)) {
                is_any = true;
                break;
            }
        }
        if (!is_any) {
            bool is_any2 = false;
            for (const auto& a : found) {
                if (!lang::contains(again, a->id)) {
                    is_any2 = true;
                    break;
                }
            }
            exact = is_any2 ? found : every;
        }
    }
    exact = directing::keep_modest(state, meta, exact, now);
    if (lang::len(exact) == 0) {
        std::string name = graph->stances.at(state->stance)->name;
        std::string asked = lang::joined(lang::together(request->tags, List<std::string>{request->kind}), " ");
        if (request->limb.has_value()) {
            asked = lang::text(*request->limb, " ", asked);
        }
        if (lang::len(found) > 0) { // whose limb is a wish, too
            state->tell(
                meta,
                "other-limb",
                lang::text("stance '", name, "' has no ", asked, "; another will do"),
                true
            );
            return found;
        }
        std::string hint = meta->written ? std::string("") : routes::name_elsewhere(state, request);
        state->tell(meta, "no-candidate", lang::text("stance '", name, "' has no ", asked, hint));
    }
    return exact;
}

}  // namespace steps

}  // namespace metagraph
