// The draw of one action among the candidates that did not play too recently (Borer et al., section 6.2).
//
// Translated from metagraph/playback/planning/drawing.py; change that, and translate anew.
#pragma once

#include "model.hpp"
#include "choice.hpp"
#include "directing.hpp"
#include "layer_state.hpp"
#include "mood.hpp"
#include "remembering.hpp"
#include "vigour.hpp"
#include "language.hpp"

namespace metagraph {


namespace drawing {

inline Ref<Action> draw_action(
    const Ref<LayerState>& state,
    const List<Ref<Action>>& candidates,
    const std::string& key,
    double now,
    const Ref<Mood>& mood
);
inline List<Ref<Action>> keep_spaced(const Ref<LayerState>& state, const List<Ref<Action>>& candidates);
inline double count_uses(const Ref<LayerState>& state, const std::string& ident, double now);
inline double find_cooled(const Ref<LayerState>& state, const Ref<Action>& action);

}  // namespace drawing

namespace drawing {

/// Draw with p_k ~ likelihood_k / max(c_k, 1), times the factors of mood and variety. Actions used too recently are
/// left out as long as others are left.
inline Ref<Action> draw_action(
    const Ref<LayerState>& state,
    const List<Ref<Action>>& candidates,
    const std::string& key,
    double now,
    const Ref<Mood>& mood
) {
    List<Ref<Action>> left = drawing::keep_spaced(state, candidates);
    if (lang::len(left) == 1) {
        return lang::at(left, 0);
    }
    bool neutral = mood->neutral();
    Map<std::string, double> weights;
    for (const auto& a : left) {
        double favoured = neutral ? 1.0 : mood::favour(mood, a->tags, vigour::measure_vigour(state->project, a));
        double weight = a->likelihood / std::max(drawing::count_uses(state, a->id, now), 1.0) * favoured;
        weights[a->id] = weight * directing::weigh_variety(state, a, now);
    }
    bool is_any = false;
    for (const auto& w : lang::values(weights)) {
        if (w > 0) {
            is_any = true;
            break;
        }
    }
    if (!is_any) {
        return lang::at(left, 0);
    }
    std::string chosen = choice::pick(state->seed, key, "action", weights);
    Ref<Action> first;
    for (const auto& a2 : left) {
        if (a2->id == chosen) {
            first = a2;
            break;
        }
    }
    return first;
}

/// Leave out actions that need more other actions before they play again. If nothing is left, all need one less, and so
/// on.
inline List<Ref<Action>> keep_spaced(const Ref<LayerState>& state, const List<Ref<Action>>& candidates) {
    int default_ = state->project->settings->never_twice ? 1 : 0;
    Ref<Action> first = lang::at(candidates, 0);
    List<std::string> before = lang::get_or(state->recent, remembering::node(first->stance, first->kind), List<std::string>{});
    if (lang::len(candidates) < 2 || lang::len(before) == 0) {
        return candidates;
    }
    Map<std::string, int> needs;
    for (const auto& a : candidates) {
        needs[a->id] = !a->spacing.has_value() ? default_ : *a->spacing;
    }
    List<int> found;
    for (const auto& a : candidates) {
        found.push_back(needs.at(a->id));
    }
    for (int less = 0; less < lang::max_of(found) + 1; less++) {
        List<Ref<Action>> left;
        for (const auto& a : candidates) {
            if (remembering::rested(before, a->id, needs.at(a->id) - less)) {
                left.push_back(a);
            }
        }
        if (lang::len(left) > 0) {
            return left;
        }
    }
    return candidates;
}

/// Return c_k of section 6.2, alpha times the uses, over the settings' memory.
inline double count_uses(const Ref<LayerState>& state, const std::string& ident, double now) {
    double memory = state->project->settings->memory;
    double alpha = state->project->settings->alpha;
    if (memory <= 0) {
        return alpha * lang::get_or(state->uses, ident, 0);
    }
    int used = 0;
    for (const auto& cue : lang::backwards(state->cues)) {
        if (cue->start < now - memory) {
            break;
        }
        if (cue->action->id == ident) {
            used += 1;
        }
    }
    return alpha * used;
}

/// Return the time from which an action may be drawn again.
inline double find_cooled(const Ref<LayerState>& state, const Ref<Action>& action) {
    if (action->cooldown > 0 && lang::contains(state->ended, action->id)) {
        return state->ended.at(action->id) + action->cooldown;
    }
    return -INFINITY;
}

}  // namespace drawing

}  // namespace metagraph
