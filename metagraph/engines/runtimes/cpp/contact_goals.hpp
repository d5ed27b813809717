// Find the goals that contacts set for the hands at a time: contacts of the cue that plays and of the loops under it,
// each weighted by how much of it shows.
//
// Translated from metagraph/playback/posing/contact_goals.py; change that, and translate anew.
#pragma once

#include "model.hpp"
#include "contact_solve.hpp"
#include "contact_spans.hpp"
#include "meta_plan.hpp"
#include "cue_times.hpp"
#include "project.hpp"
#include "language.hpp"

namespace metagraph {


namespace contact_goals {

inline constexpr double LEAST = 1e-06; // of a hand: goals with less weight are not solved
inline List<Ref<HandGoal>> layer_goals(
    const Ref<ContactRig>& rig,
    const Ref<Project>& project,
    const Ref<LayerPlan>& plan,
    const Ref<Cue>& cue,
    int place,
    double time,
    double strength
);
inline List<Ref<HandGoal>> _loop_goals(
    const Ref<ContactRig>& rig,
    const Ref<Project>& project,
    const Ref<Rest>& rest,
    double time,
    double strength,
    const List<double>& shown
);
inline List<Ref<HandGoal>> _goals(
    const Ref<ContactRig>& rig,
    const Ref<Project>& project,
    const Ref<Action>& action,
    double seconds,
    const List<double>& shares
);
inline int _arm(const Ref<ContactSpan>& span);
inline bool _moves(const Ref<ContactRig>& rig, const Ref<Action>& action, int arm, const std::string& hand);

}  // namespace contact_goals

namespace contact_goals {

/// Return a layer's goals for the hands at a time.
///
/// `cue` is the one that plays, if it has motion. `place` is the index of the rest in force, -1 for none. `strength` is
/// how much of the arms the layer moves, 0..1.
inline List<Ref<HandGoal>> layer_goals(
    const Ref<ContactRig>& rig,
    const Ref<Project>& project,
    const Ref<LayerPlan>& plan,
    const Ref<Cue>& cue,
    int place,
    double time,
    double strength
) {
    List<Ref<HandGoal>> out;
    List<double> shown = List<double>{0.0, 0.0};
    if (cue != nullptr) {
        double weight = cue_times::cue_weight(cue, time);
        for (int arm = 0; arm < lang::len(contact_spans::HANDS); arm++) {
            const auto& hand = lang::at(contact_spans::HANDS, arm);
            if (contact_goals::_moves(rig, cue->action, arm, hand)) {
                lang::at(shown, arm) = weight;
            }
        }
        if (lang::len(cue->action->contacts) > 0) {
            double left = cue_times::seam_left(cue, time);
            if (left > 0.0) { // the goals at the end of the previous cycle, as far as its pose still shows
                List<double> found;
                for (const auto& w : shown) {
                    found.push_back(strength * left * w);
                }
                lang::extend(out, contact_goals::_goals(rig, project, cue->action, cue->cycle_to, found));
            }
            double share = strength * (1.0 - left);
            List<double> found2;
            for (const auto& w : shown) {
                found2.push_back(share * w);
            }
            lang::extend(out, contact_goals::_goals(
                rig,
                project,
                cue->action,
                cue_times::cue_seconds(cue, time),
                found2
            ));
        }
    }
    if (place >= 0) {
        Ref<Rest> rest = lang::at(plan->rests, place);
        double over = 1.0;
        if (place > 0 && rest->fade_start + rest->fade > time) {
            over = cue_times::ease((time - rest->fade_start) / rest->fade);
            lang::extend(out, contact_goals::_loop_goals(
                rig,
                project,
                lang::at(plan->rests, place - 1),
                time,
                strength * (1.0 - over),
                shown
            ));
        }
        lang::extend(out, contact_goals::_loop_goals(rig, project, rest, time, strength * over, shown));
    }
    return out;
}

/// Return a loop's goals for the hands, reduced by the cue above it.
inline List<Ref<HandGoal>> _loop_goals(
    const Ref<ContactRig>& rig,
    const Ref<Project>& project,
    const Ref<Rest>& rest,
    double time,
    double strength,
    const List<double>& shown
) {
    List<Ref<HandGoal>> out;
    Ref<Action> action = rest->action;
    if (lang::len(action->contacts) == 0) {
        return out;
    }
    List<double> left;
    for (const auto& w : shown) {
        left.push_back(strength * (1.0 - w));
    }
    auto [start, end] = project->span(action);
    double seam = std::min(std::max(0.0, action->timing->blend_in), (end - start) / 2.0);
    double period = end - start - seam;
    if (period <= 0.0) {
        return contact_goals::_goals(rig, project, action, start, left);
    }
    double elapsed = time - rest->start;
    double phase = seam > 0.0 ? std::max(elapsed, 0.0) : elapsed;
    phase = phase - period * static_cast<int>(std::floor(phase / period));
    double old = 0.0;
    if (seam > 0.0 && elapsed >= period) {
        old = 1.0 - cue_times::ease(phase / seam);
    }
    if (old > 0.0) {
        double before = start + std::min(period + phase, end - start);
        List<double> found;
        for (const auto& w : left) {
            found.push_back(old * w);
        }
        lang::extend(out, contact_goals::_goals(rig, project, action, before, found));
    }
    List<double> found2;
    for (const auto& w : left) {
        found2.push_back((1.0 - old) * w);
    }
    lang::extend(out, contact_goals::_goals(rig, project, action, start + phase, found2));
    return out;
}

/// Return the goals of an action at a second of its clip. `shares` says how much of it shows at the left and the right
/// hand.
inline List<Ref<HandGoal>> _goals(
    const Ref<ContactRig>& rig,
    const Ref<Project>& project,
    const Ref<Action>& action,
    double seconds,
    const List<double>& shares
) {
    List<Ref<HandGoal>> out;
    auto [start, end] = project->span(action);
    for (const auto& span : action->contacts) {
        int arm = contact_goals::_arm(span);
        std::optional<int> to = lang::get(rig->places, span->to);
        if (!to.has_value() || lang::len(span->keys) == 0 || lang::at(shares, arm) <= contact_goals::LEAST) {
            continue;
        }
        double weight = lang::at(shares, arm) * contact_spans::contact_weight(span, seconds, start, end);
        if (weight > contact_goals::LEAST) {
            Ref<ContactKey> key = contact_spans::contact_key(span, seconds);
            out.push_back(lang::made<HandGoal>(arm, *to, key->at, key->turn, weight));
        }
    }
    return out;
}

inline int _arm(const Ref<ContactSpan>& span) {
    return span->hand == "left" ? 0 : 1;
}

/// Return whether an action moves a hand, instead of leaving it in the stance.
inline bool _moves(const Ref<ContactRig>& rig, const Ref<Action>& action, int arm, const std::string& hand) {
    if (!lang::contains(List<std::string>{"both", hand}, action->limb)) {
        return false;
    }
    return lang::len(action->joints) == 0 || lang::contains(action->joints, lang::at(rig->hands, arm));
}

}  // namespace contact_goals

}  // namespace metagraph
