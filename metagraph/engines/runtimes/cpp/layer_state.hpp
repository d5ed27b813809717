// One layer while it is planned: what it may draw on, and what it has played so far.
//
// Translated from metagraph/playback/planning/layer_state.py; change that, and translate anew.
#pragma once

#include "model.hpp"
#include "track.hpp"
#include "meta_plan.hpp"
#include "director.hpp"
#include "mood.hpp"
#include "remembering.hpp"
#include "project.hpp"
#include "language.hpp"

namespace metagraph {

struct LayerState;

/// One layer being planned, cue after cue. It changes while planning, and never leaves the planner.
///
/// moods: the mood over time. track: what lasts, such as the mode. free: when the next action may begin. acted: when
/// the last action ended. uses: how often each action was used. recent: the last draws of each `node`. ended: when each
/// action ended. begun: keys of meta actions whose chain of transitions already plays. served: keys of those that the
/// action of another one serves, too. candidates: the actions of each `node` that may be drawn, for the nodes needed so
/// far. prominences: of actions, as far as needed. model: the one that wrote what was not requested, None if there is
/// none. beats: seconds after which a gesture that hardly shows may be done again.
struct LayerState {
    Ref<Project> project;
    Ref<MetaGraph> graph;
    std::uint32_t seed;
    std::string stance;
    Ref<Moods> moods;
    Ref<Track> track;
    double free;
    double acted;
    Map<std::string, int> uses;
    Map<std::string, List<std::string>> recent;
    Map<std::string, double> ended;
    List<Ref<Cue>> cues;
    List<Ref<Rest>> rests;
    List<Ref<Report>> reports;
    Set<std::string> begun;
    Set<std::string> served;
    Map<std::string, List<Ref<Action>>> candidates;
    Map<std::string, double> prominences;
    Ref<Markov> model;
    double beats;

    LayerState(
        Ref<Project> project_,
        Ref<MetaGraph> graph_,
        std::uint32_t seed_,
        std::string stance_,
        Ref<Moods> moods_,
        Ref<Track> track_,
        double free_ = 0.0,
        double acted_ = 0.0,
        Map<std::string, int> uses_ = Map<std::string, int>{},
        Map<std::string, List<std::string>> recent_ = Map<std::string, List<std::string>>{},
        Map<std::string, double> ended_ = Map<std::string, double>{},
        List<Ref<Cue>> cues_ = List<Ref<Cue>>{},
        List<Ref<Rest>> rests_ = List<Ref<Rest>>{},
        List<Ref<Report>> reports_ = List<Ref<Report>>{},
        Set<std::string> begun_ = Set<std::string>{},
        Set<std::string> served_ = Set<std::string>{},
        Map<std::string, List<Ref<Action>>> candidates_ = Map<std::string, List<Ref<Action>>>{},
        Map<std::string, double> prominences_ = Map<std::string, double>{},
        Ref<Markov> model_ = nullptr,
        double beats_ = director::LEAST_BEATS
    )
        : project(std::move(project_)),
            graph(std::move(graph_)),
            seed(seed_),
            stance(std::move(stance_)),
            moods(std::move(moods_)),
            track(std::move(track_)),
            free(free_),
            acted(acted_),
            uses(std::move(uses_)),
            recent(std::move(recent_)),
            ended(std::move(ended_)),
            cues(std::move(cues_)),
            rests(std::move(rests_)),
            reports(std::move(reports_)),
            begun(std::move(begun_)),
            served(std::move(served_)),
            candidates(std::move(candidates_)),
            prominences(std::move(prominences_)),
            model(std::move(model_)),
            beats(beats_) {}

    /// Note that a cue is played.
    void note(const Ref<Cue>& cue, const std::string& then);

    /// The earliest time at which the next action may begin.
    double ready();

    /// Return when the stance was last changed; minus infinity for never.
    double moved();

    void tell(
        const Ref<MetaAction>& meta,
        const std::string& outcome,
        const std::string& message,
        bool played = false,
        double late = 0.0,
        const std::string& by = ""
    );
};

inline void LayerState::note(const Ref<Cue>& cue, const std::string& then) {
    this->cues.push_back(cue);
    this->free = cue->end;
    this->acted = cue->end;
    this->stance = then;
    remembering::remember(cue, this->uses, this->recent, this->ended);
}

inline double LayerState::ready() {
    return this->free + (!this->ended.empty() ? this->project->settings->rest : 0.0);
}

inline double LayerState::moved() {
    double latest = -INFINITY;
    for (const auto& [ident, end] : this->ended) {
        Ref<Action> action = lang::get(this->graph->actions, ident);
        if (action != nullptr && action->kind == "transition") {
            latest = std::max(latest, end);
        }
    }
    return latest;
}

inline void LayerState::tell(
    const Ref<MetaAction>& meta,
    const std::string& outcome,
    const std::string& message,
    bool played,
    double late,
    const std::string& by
) {
    std::string layer = this->graph->layer;
    this->reports.push_back(lang::made<Report>(
        meta->request->id,
        outcome,
        message,
        layer,
        meta->start,
        played,
        meta->written,
        late,
        by
    ));
}

}  // namespace metagraph
