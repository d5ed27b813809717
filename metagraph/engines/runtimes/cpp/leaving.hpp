// How a running action is left early: for a request that can then be in time, or because it was stopped.
//
// Translated from metagraph/playback/planning/leaving.py; change that, and translate anew.
#pragma once

#include "meta_plan.hpp"
#include "bounds.hpp"
#include "cue_shapes.hpp"
#include "layer_state.hpp"
#include "punctuality.hpp"
#include "language.hpp"

namespace metagraph {


namespace leaving {

inline void make_way(
    const Ref<LayerState>& state,
    const Ref<MetaAction>& running,
    const List<Ref<MetaAction>>& asked,
    double now,
    bool stopped
);
inline void retract(const Ref<LayerState>& state, double now);

}  // namespace leaving

namespace leaving {

/// Leave the running action early for the first request that can then be in time, or if it was `stopped`. An action
/// that a model wrote, or that is less important, is left at once; others are left where their retraction begins.
inline void make_way(
    const Ref<LayerState>& state,
    const Ref<MetaAction>& running,
    const List<Ref<MetaAction>>& asked,
    double now,
    bool stopped
) {
    if (stopped) {
        leaving::retract(state, now);
        return;
    }
    Ref<Cue> cue = lang::at(state->cues, -1);
    if (running == nullptr || cue->action->kind == "transition" || cue->end - cue->blend_out <= now) {
        return;
    }
    double at_once = now + std::max(cue->blend_out, cue_shapes::RETRACTION);
    double retracts = at_once;
    if (!running->written) {
        double once = cue->end - cue->start;
        if (cue->repeats()) {
            once = std::min(
                once,
                (cue->cycle_to - cue->entry) / cue->tempo + std::max(cue->blend_out, cue_shapes::RETRACTION)
            );
        }
        Ref<CueShape> shape = lang::made<CueShape>(
            cue->start,
            cue->entry,
            cue->end - cue->start,
            once,
            cue->hold_from,
            cue->hold_to,
            cue->hold,
            cue->tempo
        );
        retracts = std::max(at_once, cue->start + cue_shapes::hurried(state->project, cue->action, shape));
    }
    double rest = state->project->settings->rest;
    for (const auto& meta : asked) {
        Ref<MetaRequest> request = meta->request;
        double in_time = punctuality::find_latest(state, request) + cue_shapes::slack_of(request);
        double soonest = meta->rank() > running->rank() ? at_once : retracts;
        if (!request->late.has_value()
            || meta->rank() < running->rank()
            || in_time < soonest + rest - cue_shapes::FITS) {
            continue;
        }
        double end = std::max(soonest, bounds::begins(meta) - rest);
        if (end < cue->end) {
            double out = std::max(cue->blend_out, cue_shapes::RETRACTION);
            double into = std::min(cue->blend_in, std::max(0.0, end - out - cue->start));
            lang::at(state->cues, -1) = lang::made<Cue>(
                cue->action,
                cue->start,
                end,
                cue->entry,
                into,
                out,
                cue->stance,
                cue->then,
                cue->meta,
                cue->hold_from,
                cue->hold_to,
                cue->hold,
                cue->extent,
                cue->tempo,
                cue->cycle_from,
                cue->cycle_to
            );
            state->free = end;
            state->ended[cue->action->id] = end;
        }
        return;
    }
}

/// Leave the running action: it returns to its stance from where it is. A transition ends in the stance it leads to.
inline void retract(const Ref<LayerState>& state, double now) {
    Ref<Cue> cue = lang::at(state->cues, -1);
    double end = now + cue_shapes::STOPPED;
    if (cue->action->kind == "transition" || cue->end - cue->blend_out <= now || cue->end <= end) {
        return;
    }
    lang::at(state->cues, -1) = lang::made<Cue>(
        cue->action,
        cue->start,
        end,
        cue->entry,
        cue->blend_in,
        cue_shapes::STOPPED,
        cue->stance,
        cue->then,
        cue->meta,
        cue->hold_from,
        cue->hold_to,
        cue->hold,
        cue->extent,
        cue->tempo,
        cue->cycle_from,
        cue->cycle_to
    );
    state->free = end;
    state->ended[cue->action->id] = end;
}

}  // namespace leaving

}  // namespace metagraph
