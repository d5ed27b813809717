// What the planner asks of a character: its layers' stances and actions, settings, and when actions play.
#pragma once

#include "model.hpp"
#include "phase_times.hpp"

namespace metagraph {

/// One layer: its stances and actions by id, in the order they were placed.
struct MetaGraph {
    std::string layer;
    Map<std::string, Ref<Stance>> stances;
    Map<std::string, Ref<Action>> actions;
    std::optional<std::string> start;

    MetaGraph(std::string layer_, const List<Ref<Stance>>& stances_, const List<Ref<Action>>& actions_,
              std::optional<std::string> start_ = std::nullopt)
        : layer(std::move(layer_)), start(std::move(start_)) {
        for (const auto& stance : stances_) stances[stance->id] = stance;
        for (const auto& action : actions_) {
            actions[action->id] = action;
            index_[action->kind + " " + action->stance].push_back(action);
        }
    }

    /// The actions of a kind placed on a stance.
    List<Ref<Action>> of(const std::string& stance, const std::string& kind) const {
        const auto* found = index_.find(kind + " " + stance);
        return found == nullptr ? List<Ref<Action>>{} : *found;
    }

private:
    Map<std::string, List<Ref<Action>>> index_;
};

/// Settings, and of each action when it plays and its phases, and how energetic it is, by id.
struct Project {
    Ref<Settings> settings;
    Map<std::string, Ref<Phases>> phases;
    Map<std::string, double> vigours;

    explicit Project(Ref<Settings> settings_, Map<std::string, Ref<Phases>> phases_ = {}, Map<std::string, double> vigours_ = {})
        : settings(std::move(settings_)), phases(std::move(phases_)), vigours(std::move(vigours_)) {}

    /// Clip seconds in which an action plays.
    std::tuple<double, double> span(const Ref<Action>& action) const {
        const auto& found = phases.at(action->id);
        return {found->start, found->end};
    }
};

}  // namespace metagraph
