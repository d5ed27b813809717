// What the planner remembers of played actions: how often each played lately, and until when.
//
// Translated from metagraph/playback/planning/remembering.py; change that, and translate anew.
#pragma once

#include "meta_plan.hpp"
#include "language.hpp"

namespace metagraph {


namespace remembering {

inline constexpr int REMEMBERED = 32; // draws of a stance and kind that spacing can look back on
inline std::string node(const std::string& stance, const std::string& kind);
inline bool rested(const List<std::string>& recent, const std::string& ident, int needed);
inline void remember(
    const Ref<Cue>& cue,
    Map<std::string, int>& uses,
    Map<std::string, List<std::string>>& recent,
    Map<std::string, double>& ended
);

}  // namespace remembering

namespace remembering {

/// Return the key under which draws of a stance and kind are remembered.
inline std::string node(const std::string& stance, const std::string& kind) {
    return lang::text(kind, " ", stance);
}

/// Return whether at least this many other draws came after an action's last one.
inline bool rested(const List<std::string>& recent, const std::string& ident, int needed) {
    if (needed <= 0) {
        return true;
    }
    return needed <= remembering::REMEMBERED
        && !lang::contains(lang::part(recent, std::max(0, lang::len(recent) - needed)), ident);
}

/// Note that a cue was played: count its action, and note when it ended.
inline void remember(
    const Ref<Cue>& cue,
    Map<std::string, int>& uses,
    Map<std::string, List<std::string>>& recent,
    Map<std::string, double>& ended
) {
    std::string ident = cue->action->id;
    std::string place = remembering::node(cue->stance, cue->action->kind);
    uses[ident] = lang::get_or(uses, ident, 0) + 1;
    recent[place] = lang::together(
        lang::part(lang::get_or(recent, place, List<std::string>{}), 1 - remembering::REMEMBERED),
        List<std::string>{ident}
    );
    ended[ident] = cue->end;
}

}  // namespace remembering

}  // namespace metagraph
