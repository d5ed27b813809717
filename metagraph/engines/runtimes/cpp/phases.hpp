// A gesture's phases, as the export tells them.
#pragma once

#include "project.hpp"

namespace metagraph {
namespace phases {

inline Ref<Phases> phases(const Ref<Project>& project, const Ref<Action>& action) { return project->phases.at(action->id); }

}  // namespace phases
}  // namespace metagraph
