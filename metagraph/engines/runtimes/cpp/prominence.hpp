// How much an action stands out, as the export tells it.
#pragma once

#include "project.hpp"

namespace metagraph {
namespace prominence {

/// From 0 for hardly to 1 for much.
inline double measure_prominence(const Ref<Project>&, const Ref<Action>& action) {
    return action->prominence.value_or(0);
}

}  // namespace prominence
}  // namespace metagraph
