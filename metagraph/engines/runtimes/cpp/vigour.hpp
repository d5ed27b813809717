// How energetic an action is, as the export tells it.
#pragma once

#include "project.hpp"

namespace metagraph {
namespace vigour {

/// Beside others of its layer and kind, -1..1.
inline double measure_vigour(const Ref<Project>& project, const Ref<Action>& action) {
    const double* found = project->vigours.find(action->id);
    return found == nullptr ? 0 : *found;
}

}  // namespace vigour
}  // namespace metagraph
