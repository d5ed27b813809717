// The planner: requests in, a plan of specific actions out.
//
// Meta actions -> temporal replanning -> sampling, layer by layer (Borer et al., section 6). Planning from nothing and
// extending a running plan are the same function.
#pragma once

#include "layer_planning.hpp"
#include "plan.hpp"

namespace metagraph {
namespace planner {

/// Return the plan with new requests worked in, others withdrawn, and the horizon moved to `end`.
///
/// What starts before `now` stays exactly as it was. What was planned for later is taken back to its meta actions, merged
/// with the new ones and planned again. An extension in many steps gives what one in a single step does. leave: layers that
/// are planned to `end` already and that nothing new concerns. stopped: those withdrawn whose running action is left, too.
inline Ref<const Plan> extend(
    const Graph& graph, const Plan& plan, double now, const List<Ref<MetaRequest>>& requests, double end,
    const PlanOptions& options, const Set<std::string>& withdrawn, const Set<std::string>& leave,
    const Set<std::string>& stopped = {}
) {
    Map<std::string, Ref<MetaRequest>> fresh; // of two with one id the later counts
    for (const auto& request : requests) fresh[request->id] = request;
    Set<std::string> again = withdrawn;
    for (const auto& one : fresh) again.insert(one.first);
    auto out = lang::made<Plan>(plan);
    out->end = end;
    out->reports.clear();
    const Ref<Moods> moods = wanted::moods_of(graph.life, plan.track);
    for (const std::string& layer : graph::LAYERS) {
        if (leave.count(layer) > 0) {
            for (const auto& r : plan.reports) {
                if (r->layer == layer && again.count(r->request) == 0) out->reports.push_back(r);
            }
            continue;
        }
        const LayerGraph& own = graph.layer(layer);
        const Ref<LayerDraft> draft = layer_planning::draft(
            graph.project, own.graph, options.idle ? own.markov : nullptr, own.kinds, plan.layers.at(layer), plan.reports,
            plan.seed, now, lang::values(fresh), again, stopped, end, lang::get(options.stances, layer), moods,
            plan.track
        );
        out->layers[layer] = draft->performed(draft->placed, end);
        lang::extend(out->reports, draft->reports);
    }
    std::stable_sort(out->reports.begin(), out->reports.end(), [](const auto& a, const auto& b) { return a->at < b->at; });
    out->requests.clear();
    for (const auto& request : plan.requests) {
        if (again.count(request->id) == 0) out->requests.push_back(request);
    }
    lang::extend(out->requests, lang::values(fresh));
    out->life = schedule::schedule(graph.life, plan.track, graph.voices, plan.seed, end, plan.life, now);
    return out;
}

}  // namespace planner
}  // namespace metagraph
