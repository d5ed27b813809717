// The planner: requests in, a plan of specific actions out.
//
// Meta actions -> temporal replanning -> sampling, layer by layer (Borer et al., section 6). Planning from nothing and
// extending a running plan are the same function.
#pragma once

#include "markov.hpp"
#include "plan.hpp"
#include "replan.hpp"

namespace metagraph {
namespace planner {

inline constexpr double WINDOW = 1.0; // seconds a request may use when it does not say how long
inline const Set<std::string> TEMPORAL = {"late", "cut", "resumed", "past"}; // told by temporal replanning, once

/// What all layers are planned on with. again: requests that replace what was asked before.
struct Extension {
    const Graph& graph;
    const Plan& plan;
    double now, end;
    bool idle;
    Set<std::string> again;
};

inline Ref<MetaAction> meta_of(const Ref<MetaRequest>& request) {
    double length = request->duration.has_value() ? std::max(0.0, *request->duration) : WINDOW;
    if (request->stroke.has_value()) length = std::max(length, *request->stroke - request->start + sampling::FITS);
    return lang::made<MetaAction>(request, request->start, request->start + length);
}

/// Return the stance a layer begins in: as it did before, as asked, the graph's start, or the first that has a loop.
inline std::string begin_stance(const MetaGraph& graph, const LayerPlan& old, const std::string& asked) {
    List<std::string> wishes = {old.past->stance, old.rests.empty() ? "" : old.rests[0]->stance, asked, graph.start.value_or("")};
    for (const std::string& id : lang::keys(graph.stances)) wishes.push_back(id);
    for (const std::string& wish : wishes) {
        if (graph.stances.find(wish) != nullptr && !graph.of(wish, "stance").empty()) return wish;
    }
    return "";
}

/// Return a layer's plan, and add its reports, old and new.
inline Ref<const LayerPlan> extend_layer(
    const Extension& with, const std::string& layer, List<Ref<MetaAction>> asked, const std::string& begin,
    List<Ref<Report>>& reports
) {
    const LayerGraph& own = with.graph.layer(layer);
    const LayerPlan& old = *with.plan.layers.at(layer);
    auto out = lang::made<LayerPlan>();
    out->layer = layer;
    out->past = old.past;
    out->cursor = old.cursor;
    List<Ref<Cue>> kept;
    Set<std::string> played, waiting; // also those whose chain of transitions has begun
    for (const auto& cue : old.cues) {
        const bool begun = cue->start < with.now;
        (begun ? played : waiting).insert(cue->meta);
        if (begun) kept.push_back(cue);
    }
    Set<std::string> again = with.again;
    if (with.idle) {
        const auto written = markov::write(own.markov, with.plan.seed, with.end, own.kinds, old.cursor);
        out->cursor = std::get<1>(written);
        for (const auto& meta : lang::together(old.written, std::get<0>(written))) {
            if (meta->start < with.now) continue;
            out->written.push_back(meta);
            again.insert(meta->request->id);
        }
    }
    // What was told about time still holds; the rest will be told again by those that are planned again.
    List<Ref<MetaAction>> future, done;
    Set<std::pair<std::string, double>> planned_again;
    for (const auto& m : old.metas) {
        if (again.count(m->request->id) > 0) continue;
        if (waiting.count(m->key()) == 0 && (m->start < with.now || played.count(m->key()) > 0)) continue;
        future.push_back(m);
        planned_again.insert({m->request->id, m->start});
    }
    for (const auto& m : old.metas) {
        if (again.count(m->request->id) > 0 || planned_again.count({m->request->id, m->start}) > 0) continue;
        if (played.count(m->key()) > 0 || m->start < with.now) done.push_back(m);
    }
    for (const auto& r : with.plan.reports) {
        if (r->layer != layer || again.count(r->request) > 0) continue;
        if (TEMPORAL.count(r->outcome) > 0 || planned_again.count({r->request, r->at}) == 0) reports.push_back(r);
    }
    const Ref<Performer> performer
        = sampling::performer_after(with.graph.project, own.graph, with.plan.seed, begin, old.past, kept);
    if (begin.empty() || !performer->begin(begin)) {
        const std::string message = "the " + layer + " layer has no stance with a loop to begin in";
        for (const auto& m : lang::together(future, asked)) {
            if (!m->written) reports.push_back(lang::made<Report>(m->request->id, "no-stance", message, layer, m->start));
        }
        out->metas = lang::together(done, future, asked);
        return out;
    }
    if (!old.rests.empty() && with.now > 0) {
        Set<double> begun;
        for (const auto& cue : kept) begun.insert(cue->end - cue->blend_out);
        performer->rests.clear();
        for (const auto& rest : old.rests) {
            if (rest->fade_start < with.now || begun.count(rest->start) > 0) performer->rests.push_back(rest);
        }
    }
    performer->begun.clear();
    for (const auto& key : played) {
        if (waiting.count(key) > 0) performer->begun.insert(key);
    }
    performer->free = std::max(with.now - (performer->ready() - performer->free), performer->free);
    const auto delayed = replan::delay(asked, performer->ready(), with.graph.project->settings);
    double busy = -INFINITY; // what runs keeps the time it was wanted for, from the models
    for (const auto& m : done) {
        if (!m->written) busy = std::max(busy, m->end);
    }
    const auto placed = replan::replan(
        lang::together(future, out->written, std::get<0>(delayed)), with.graph.project->settings, busy
    );
    const Track& track = *with.plan.track;
    List<Ref<MetaAction>> performed;
    for (const auto& m : std::get<0>(placed)) {
        const bool leaves = m->request->kind == "transition" && track.stays_at(layer, m->start);
        if (m->written && (leaves || !markov::performs(own.markov, with.plan.seed, m, track.told_mode(m->start)))) continue;
        performed.push_back(m);
    }
    performer->perform(performed, with.end);
    performer->vary_rests(with.end);
    out->metas = lang::together(done, std::get<0>(placed));
    out->cues = performer->cues;
    out->rests = performer->rests;
    lang::extend(reports, lang::together(std::get<1>(delayed), std::get<1>(placed), performer->reports));
    return out;
}

/// Return the plan with new requests worked in, others withdrawn, and the horizon moved to `end`.
///
/// What starts before `now` stays exactly as it was. What was planned for later is taken back to its meta actions, merged
/// with the new ones and planned again. An extension in many steps gives what one in a single step does. leave: layers that
/// are planned to `end` already and that nothing new concerns.
inline Ref<const Plan> extend(
    const Graph& graph, const Plan& plan, double now, const List<Ref<MetaRequest>>& requests, double end,
    const PlanOptions& options, const Set<std::string>& withdrawn, const Set<std::string>& leave
) {
    Map<std::string, Ref<MetaRequest>> fresh; // of two with one id the later counts
    for (const auto& request : requests) fresh[request->id] = request;
    Extension with{graph, plan, now, end, options.idle, withdrawn};
    for (const auto& one : fresh) with.again.insert(one.first);
    auto out = lang::made<Plan>(plan);
    out->end = end;
    out->reports.clear();
    for (const std::string& layer : graph::LAYERS) {
        if (leave.count(layer) > 0) {
            for (const auto& r : plan.reports) {
                if (r->layer == layer && with.again.count(r->request) == 0) out->reports.push_back(r);
            }
            continue;
        }
        List<Ref<MetaAction>> asked;
        for (const auto& one : fresh) {
            if (one.second->layer == layer) asked.push_back(meta_of(one.second));
        }
        const std::string wish = lang::get_or(options.stances, layer, std::string());
        const std::string begin = begin_stance(*graph.layer(layer).graph, *plan.layers.at(layer), wish);
        out->layers[layer] = extend_layer(with, layer, asked, begin, out->reports);
    }
    std::stable_sort(out->reports.begin(), out->reports.end(), [](const auto& a, const auto& b) { return a->at < b->at; });
    out->requests.clear();
    for (const auto& request : plan.requests) {
        if (with.again.count(request->id) == 0) out->requests.push_back(request);
    }
    lang::extend(out->requests, lang::values(fresh));
    out->life = schedule::extended(graph.life, graph.voices, plan.track, plan.seed, end, plan.life, now);
    return out;
}

}  // namespace planner
}  // namespace metagraph
