// From a meta plan to specific actions: candidates, the three temporal cases, cues and rests (Borer et al., section
// 6.2).
//
// Translated from metagraph/playback/planning/sampling.py; change that, and translate anew.
#pragma once

#include "model.hpp"
#include "repeating.hpp"
#include "track.hpp"
#include "meta_plan.hpp"
#include "bounds.hpp"
#include "cue_shapes.hpp"
#include "directing.hpp"
#include "director.hpp"
#include "drawing.hpp"
#include "layer_state.hpp"
#include "manner.hpp"
#include "mood.hpp"
#include "punctuality.hpp"
#include "routes.hpp"
#include "steps.hpp"
#include "phase_times.hpp"
#include "project.hpp"
#include "language.hpp"

namespace metagraph {


namespace sampling {

inline constexpr double ON_TIME = 0.1; // seconds by which a request may begin later and still be on time
// seconds of crossfade when a long rest changes from one loop of its stance to another
inline constexpr double LOOP_FADE = 0.6;
inline Ref<LayerState> resume_layer(
    const Ref<Project>& project,
    const Ref<MetaGraph>& graph,
    std::uint32_t seed,
    const std::string& begin,
    const Ref<Past>& past,
    const List<Ref<Cue>>& cues,
    const Ref<Moods>& moods,
    const Ref<Track>& track
);
inline bool begin_layer(const Ref<LayerState>& state, const std::string& stance);
inline void perform_metas(const Ref<LayerState>& state, const List<Ref<MetaAction>>& metas, double end);
inline void _realise(const Ref<LayerState>& state, const Ref<Bound>& bound, double now);
inline List<Ref<Action>> _fit(
    const Ref<LayerState>& state,
    const Ref<Bound>& bound,
    const Ref<SamplingStep>& step,
    const Ref<MetaRequest>& asked,
    double now,
    const Ref<Mood>& mood
);
inline Ref<Cue> _cue(
    const Ref<LayerState>& state,
    const Ref<Action>& action,
    const Ref<CueShape>& shape,
    const Ref<Bound>& bound,
    bool hops,
    const std::string& stance,
    const Ref<Mood>& mood
);
inline void _keep(const Ref<LayerState>& state, const Ref<Cue>& cue);
inline void vary_rests(const Ref<LayerState>& state, double end);

}  // namespace sampling

namespace sampling {

/// Return the layer as it is after a past and the cues that played since.
inline Ref<LayerState> resume_layer(
    const Ref<Project>& project,
    const Ref<MetaGraph>& graph,
    std::uint32_t seed,
    const std::string& begin,
    const Ref<Past>& past,
    const List<Ref<Cue>>& cues,
    const Ref<Moods>& moods,
    const Ref<Track>& track
) {
    std::string stance = lang::contains(graph->stances, past->stance) ? past->stance : begin;
    Ref<LayerState> out = lang::made<LayerState>(
        project,
        graph,
        seed,
        stance,
        moods,
        track,
        past->free,
        past->free,
        past->uses,
        past->recent,
        past->ended
    );
    List<Ref<Action>> found;
    for (const auto& a : lang::values(graph->actions)) {
        if (a->kind == "gesture") {
            found.push_back(a);
        }
    }
    out->beats = director::beat_interval(graph->layer, lang::len(found));
    for (const auto& cue : cues) {
        out->note(cue, lang::contains(graph->stances, cue->then) ? cue->then : begin);
    }
    return out;
}

/// Lay the first loop down; return whether the layer can perform at all.
inline bool begin_layer(const Ref<LayerState>& state, const std::string& stance) {
    Ref<Action> loop = routes::draw_loop(state, stance, lang::text("rest/", state->graph->layer));
    if (loop == nullptr) {
        return false;
    }
    state->rests.push_back(lang::made<Rest>(stance, loop, 0.0, 0.0, 0.0));
    return true;
}

/// Realise in order those meta actions of a conflict-free meta plan that start before `end`.
inline void perform_metas(const Ref<LayerState>& state, const List<Ref<MetaAction>>& metas, double end) {
    List<Ref<MetaAction>> performed;
    for (const auto& m : metas) {
        if (!m->written || directing::performs_written(state, m, m->start)) {
            performed.push_back(m);
        }
    }
    for (const auto& bound : bounds::bounds(performed)) {
        Ref<MetaAction> meta = bound->meta;
        if (bounds::begins(meta) >= end) {
            continue;
        }
        if (lang::len(state->served) > 0 && lang::contains(state->served, meta->key())) {
            continue;
        }
        if (meta->request->late.has_value()) {
            sampling::_realise(state, bound, std::max(state->ready(), bounds::begins(meta)));
            continue;
        }
        double ready = state->ready();
        if (meta->start < ready && !lang::contains(state->begun, meta->key())) {
            std::string running = "the running action";
            if (lang::len(state->cues) > 0) {
                running = lang::text("'", lang::at(state->cues, -1)->action->name, "'");
            }
            double waits = ready - meta->start;
            if (meta->end <= ready + cue_shapes::FITS) {
                waits = ready - meta->request->start;
                // What is wanted for a certain time is over; what is wanted once may come late.
                bool wanted = meta->written || meta->request->duration.has_value();
                if (wanted || waits > state->project->settings->wait) {
                    std::string why = lang::text(
                        "wholly covered by ",
                        running,
                        ", which plays until ",
                        lang::fixed(state->free, 2),
                        " s"
                    );
                    state->tell(meta, "covered", why);
                    continue;
                }
            }
            // What a model wrote is wanted at no certain time.
            if (!meta->written && waits > sampling::ON_TIME) {
                state->tell(meta, "queued", lang::text("waits ", lang::fixed(waits, 2), " s for ", running), true);
            }
        }
        sampling::_realise(state, bound, std::max(ready, meta->start));
    }
}

inline void _realise(const Ref<LayerState>& state, const Ref<Bound>& bound, double now) {
    Ref<MetaAction> meta = bound->meta;
    if (meta->written && !lang::contains(state->begun, meta->key()) && !directing::may_begin(state, meta, now)) {
        return;
    }
    std::optional<List<Ref<SamplingStep>>> steps = steps::choose_steps(state, meta, now);
    if (!steps.has_value()) {
        return;
    }
    List<Ref<Cue>> cues;
    std::string stance = state->stance;
    for (const auto& step : *steps) {
        bool hops = step->hop != "";
        Ref<MetaRequest> asked = hops ? nullptr : cue_shapes::remaining(meta, now);
        Ref<Mood> mood = manner::find_mood(state, asked, now);
        List<Ref<Action>> fitting = sampling::_fit(state, bound, step, asked, now, mood);
        if (lang::len(fitting) == 0) {
            return;
        }
        // On the way to a stance it counts when that begins.
        if (meta->request->late.has_value()
            && (!hops || (lang::len(cues) == 0 && lang::at(*steps, lang::len(*steps) - 1)->hop != ""))) {
            fitting = punctuality::keep_timely(state, bound, fitting, now);
            if (lang::len(fitting) == 0) {
                return;
            }
        }
        Ref<Action> action = drawing::draw_action(
            state,
            fitting,
            hops ? lang::text(meta->key(), "/", step->hop) : meta->key(),
            now,
            mood
        );
        Ref<CueShape> shape = manner::shape_in_mood(state, action, asked, now, mood);
        Ref<Cue> cue = sampling::_cue(state, action, shape, bound, hops, stance, mood);
        cues.push_back(cue);
        now = cue->end;
        stance = cue->then;
    }
    for (const auto& one : cues) {
        sampling::_keep(state, one);
    }
}

/// Return the candidates of a step that are over in time and have cooled down. If none, tell why.
inline List<Ref<Action>> _fit(
    const Ref<LayerState>& state,
    const Ref<Bound>& bound,
    const Ref<SamplingStep>& step,
    const Ref<MetaRequest>& asked,
    double now,
    const Ref<Mood>& mood
) {
    Ref<MetaAction> meta = bound->meta;
    List<Ref<Action>> fitting = step->candidates;
    if (bound->limit < INFINITY) { // else all fit
        List<Ref<Action>> found;
        for (const auto& a : step->candidates) {
            if (cue_shapes::fits_before(manner::shape_in_mood(state, a, asked, now, mood), bound->limit)) {
                found.push_back(a);
            }
        }
        fitting = found;
    }
    if (lang::len(fitting) == 0) {
        std::string before = meta->written ? std::string("") : std::string(" before something more important");
        double left = std::max(0.0, bound->limit - now);
        state->tell(meta, "no-room", lang::text("nothing fits into the ", lang::fixed(left, 2), " s", before));
        return fitting;
    }
    if (step->hop != "" || meta->request->action.has_value()) {
        return fitting;
    }
    List<Ref<Action>> warm;
    for (const auto& a : fitting) {
        if (a->cooldown <= 0
            || drawing::find_cooled(state, a)
                <= manner::shape_in_mood(state, a, asked, now, mood)->start + cue_shapes::FITS) {
            warm.push_back(a);
        }
    }
    if (lang::len(warm) == 0) {
        List<double> found2;
        for (const auto& a : fitting) {
            found2.push_back(drawing::find_cooled(state, a));
        }
        double soonest = lang::min_of(found2);
        std::string why = lang::text(
            "all that fit are cooling down; the first may play again at ",
            lang::fixed(soonest, 2),
            " s"
        );
        state->tell(meta, "cooling", why);
    }
    return warm;
}

/// hops: whether it is a transition on the way to the requested action.
inline Ref<Cue> _cue(
    const Ref<LayerState>& state,
    const Ref<Action>& action,
    const Ref<CueShape>& shape,
    const Ref<Bound>& bound,
    bool hops,
    const std::string& stance,
    const Ref<Mood>& mood
) {
    double length = shape->length;
    double into = std::max(0.0, action->timing->blend_in);
    double out = std::max(0.0, action->timing->blend_out);
    auto [begin, until] = state->project->span(action);
    double cycle = repeating::cycle_of(action->kind, action->timing, begin, until);
    if (action->timing->earliest_exit.has_value() || cycle > 0) {
        double wish = hops ? INFINITY : bound->wish;
        length = std::min(length, std::max(shape->shortest, std::min(bound->limit, wish) - shape->start));
    } else if (!hops) {
        length = std::min(length, punctuality::find_until(state, action, shape, bound) - shape->start);
        if (length < shape->length) {
            out = std::max(out, cue_shapes::RETRACTION);
        }
    }
    if (shape->entry > begin) {
        into = std::max(into, phase_times::LEAST_BLEND);
    }
    double squeeze = into + out > 0 ? std::min(1.0, length / (into + out)) : 1.0;
    std::string then = stance;
    if (action->kind == "transition" && action->end_stance.has_value()) {
        then = *action->end_stance;
    }
    double end = shape->start + length;
    return lang::made<Cue>(
        action,
        shape->start,
        end,
        shape->entry,
        into * squeeze,
        out * squeeze,
        stance,
        then,
        bound->meta->key(),
        shape->hold_from,
        shape->hold_to,
        shape->hold,
        manner::find_extent(state, action, mood),
        shape->tempo,
        cycle > 0 ? begin : 0.0,
        cycle > 0 ? begin + cycle : 0.0
    );
}

inline void _keep(const Ref<LayerState>& state, const Ref<Cue>& cue) {
    state->note(cue, cue->then);
    Ref<Action> loop = routes::draw_loop(state, cue->then, cue->meta);
    if (loop != nullptr) {
        // The loop begins again under the action, so that the action's last pose meets the loop's first.
        // On joints that the action does not move, the change shows. It takes its time there, like a
        // transition.
        bool partial = cue->action->limb != "both"
            || lang::len(cue->action->joints) > 0
            || lang::len(cue->action->joint_weights) > 0;
        double begin = cue->start + cue->blend_in;
        double until = cue->end - cue->blend_out;
        double fade = std::max(0.0, until - begin);
        if (partial) {
            fade = cue->then != cue->stance
                ? cue->end - cue->start
                : std::min(sampling::LOOP_FADE, cue->end - cue->start);
            begin = std::max(cue->start, until - fade);
        }
        state->rests.push_back(lang::made<Rest>(cue->then, loop, until, begin, fade));
    }
}

/// Change between the loops of a stance in long rests, at the end of a loop.
inline void vary_rests(const Ref<LayerState>& state, double end) {
    List<Ref<Rest>> out;
    for (int place = 0; place < lang::len(state->rests); place++) {
        const auto& rest = lang::at(state->rests, place);
        out.push_back(rest);
        List<Ref<Action>> loops = state->graph->of(rest->stance, "stance");
        if (lang::len(loops) < 2) {
            continue;
        }
        double until = place + 1 < lang::len(state->rests) ? lang::at(state->rests, place + 1)->fade_start : end;
        Ref<Rest> current = rest;
        double change = rest->start;
        while (true) {
            auto [start, stop] = state->project->span(current->action);
            change += std::max(1.0, stop - start - current->action->timing->blend_in);
            if (!(change <= until)) { // nor when it is no number
                break;
            }
            Ref<Action> loop = routes::draw_loop(
                state,
                rest->stance,
                lang::text(state->graph->layer, "/", lang::fixed(change, 3))
            );
            if (loop != nullptr && loop->id != current->action->id) {
                current = lang::made<Rest>(
                    rest->stance,
                    loop,
                    change,
                    change - sampling::LOOP_FADE,
                    sampling::LOOP_FADE
                );
                out.push_back(current);
            }
        }
    }
    state->rests = out;
}

}  // namespace sampling

}  // namespace metagraph
