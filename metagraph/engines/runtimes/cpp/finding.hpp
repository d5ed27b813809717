// Find actions and stances by id or name.
//
// Translated from metagraph/playback/planning/finding.py; change that, and translate anew.
#pragma once

#include "model.hpp"
#include "project.hpp"
#include "language.hpp"

namespace metagraph {


namespace finding {

inline Ref<Action> action_called(
    const List<Ref<MetaGraph>>& graphs,
    const std::string& word,
    const std::optional<std::string>& layer
);
inline Ref<Stance> stance_called(
    const List<Ref<MetaGraph>>& graphs,
    const std::string& word,
    const std::optional<std::string>& layer
);

}  // namespace finding

namespace finding {

/// Return the action with an id or, failing that, with a name; of several with the same name, the likeliest. layer:
/// None for any.
inline Ref<Action> action_called(
    const List<Ref<MetaGraph>>& graphs,
    const std::string& word,
    const std::optional<std::string>& layer
) {
    for (const auto& graph : graphs) {
        Ref<Action> found = lang::get(graph->actions, word);
        if (found != nullptr && (!layer.has_value() || *layer == graph->layer)) {
            return found;
        }
    }
    Ref<Action> best;
    for (const auto& graph : graphs) {
        if (!layer.has_value() || *layer == graph->layer) {
            for (const auto& action : lang::values(graph->actions)) {
                if (action->name == word && (best == nullptr || action->likelihood > best->likelihood)) {
                    best = action;
                }
            }
        }
    }
    return best;
}

/// Return the stance with an id or, failing that, with a name, in the first layer that has one.
inline Ref<Stance> stance_called(
    const List<Ref<MetaGraph>>& graphs,
    const std::string& word,
    const std::optional<std::string>& layer
) {
    for (const auto& graph : graphs) {
        if (!layer.has_value() || *layer == graph->layer) {
            Ref<Stance> found = lang::get(graph->stances, word);
            if (found != nullptr) {
                return found;
            }
            for (const auto& stance : lang::values(graph->stances)) {
                if (stance->name == word) {
                    return stance;
                }
            }
        }
    }
    return nullptr;
}

}  // namespace finding

}  // namespace metagraph
