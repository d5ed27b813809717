// A gesture's phases, as the export tells them.
#pragma once

#include "project.hpp"

namespace metagraph {
namespace phases {

inline Ref<Phases> find_phases(const Ref<Project>& project, const Ref<Action>& action) { return project->phases.at(action->id); }

/// The seconds from an action's start to its stroke.
inline double lead(const Ref<Project>& project, const Ref<Action>& action) {
    const auto& found = project->phases.at(action->id);
    return found->stroke - found->start;
}

/// How long before its stroke any gesture of a layer with these tags begins.
inline double find_longest_lead(const Ref<Project>& project, const Ref<MetaGraph>& graph, const List<std::string>& tags) {
    double longest = 0;
    for (const auto& [_, action] : graph->actions) {
        const auto& own = action->tags;
        const bool fits = std::all_of(tags.begin(), tags.end(), [&own](const auto& tag) { return lang::contains(own, tag); });
        if (action->kind == "gesture" && fits) longest = std::max(longest, lead(project, action));
    }
    return longest;
}

}  // namespace phases
}  // namespace metagraph
