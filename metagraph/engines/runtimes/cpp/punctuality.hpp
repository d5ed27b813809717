// Which actions meet the moment that a request names, and when an action has to be over for the next one.
//
// Translated from metagraph/playback/planning/punctuality.py; change that, and translate anew.
#pragma once

#include "model.hpp"
#include "meta_plan.hpp"
#include "bounds.hpp"
#include "cue_shapes.hpp"
#include "layer_state.hpp"
#include "manner.hpp"
#include "mood.hpp"
#include "routes.hpp"
#include "phase_times.hpp"
#include "phases.hpp"
#include "language.hpp"

namespace metagraph {


namespace punctuality {

inline List<Ref<Action>> keep_timely(
    const Ref<LayerState>& state,
    const Ref<Bound>& bound,
    const List<Ref<Action>>& fitting,
    double now
);
inline std::string tell_cause(const Ref<LayerState>& state, const Ref<MetaRequest>& request, double now);
inline double find_latest(const Ref<LayerState>& state, const Ref<MetaRequest>& request);
inline double find_over(
    const Ref<LayerState>& state,
    const Ref<Action>& action,
    const Ref<MetaRequest>& request,
    double now
);
inline double find_until(
    const Ref<LayerState>& state,
    const Ref<Action>& action,
    const Ref<CueShape>& shape,
    const Ref<Bound>& bound
);

}  // namespace punctuality

namespace punctuality {

/// Return the candidates that come least late, if that is not too late; among them those that leave the following
/// requests the most time and serve the most of them.
inline List<Ref<Action>> keep_timely(
    const Ref<LayerState>& state,
    const Ref<Bound>& bound,
    const List<Ref<Action>>& fitting,
    double now
) {
    Ref<MetaAction> meta = bound->meta;
    Ref<MetaRequest> request = meta->request;
    double allowed = cue_shapes::slack_of(request);
    Ref<Mood> mood = manner::find_mood(state, request, now);
    Map<std::string, double> late;
    for (const auto& a : fitting) {
        late[a->id] = cue_shapes::lateness(
            state->project,
            a,
            request,
            manner::shape_in_mood(state, a, request, now, mood)
        );
    }
    List<double> found;
    for (const auto& a : fitting) {
        found.push_back(late.at(a->id));
    }
    double least = lang::min_of(found);
    std::string waits{};
    if (least > allowed + cue_shapes::FITS) {
        waits = punctuality::tell_cause(state, request, now);
        state->tell(
            meta,
            "too-late",
            lang::text(
                "would come ",
                lang::fixed(least, 2),
                " s late, ",
                lang::fixed(allowed, 2),
                " s are allowed; it waits for ",
                waits
            ),
            false,
            least
        );
        return List<Ref<Action>>{};
    }
    if (least > cue_shapes::FITS) {
        waits = punctuality::tell_cause(state, request, now);
        state->tell(
            meta,
            "late",
            lang::text("comes ", lang::fixed(least, 2), " s late; it waits for ", waits),
            true,
            least
        );
    }
    List<Ref<Action>> timely;
    for (const auto& a : fitting) {
        if (late.at(a->id) <= std::max(least, 0.0) + cue_shapes::FITS) {
            timely.push_back(a);
        }
    }
    for (const auto& other : bound->after) {
        if (!cue_shapes::may_share(request, other->request)) {
            continue;
        }
        List<Ref<Action>> both;
        for (const auto& a : timely) {
            if (cue_shapes::meets(a, other->request)) {
                both.push_back(a);
            }
        }
        double behind = 0.0;
        if (request->stroke.has_value() && other->request->stroke.has_value()) {
            behind = std::max(0.0, *request->stroke + std::max(least, 0.0) - *other->request->stroke);
        }
        if (lang::len(both) > 0
            && other->request->late.has_value()
            && behind <= *other->request->late + cue_shapes::FITS) {
            timely = both;
            state->served.insert(other->key());
            std::string message = lang::text("shares the stroke of '", request->id, "'");
            state->tell(other, "shared", message, true, behind, meta->key());
        }
    }
    List<Ref<MetaAction>> following;
    for (const auto& other2 : bound->after) {
        if (!lang::contains(state->served, other2->key())) {
            following.push_back(other2);
        }
    }
    for (const auto& other : following) {
        for (const auto& slack : List<double>{0.0, cue_shapes::slack_of(other->request)}) {
            double by = punctuality::find_latest(state, other->request) + slack;
            List<Ref<Action>> over;
            for (const auto& a : timely) {
                if (punctuality::find_over(state, a, request, now) <= by) {
                    over.push_back(a);
                }
            }
            if (lang::len(over) > 0) {
                return over;
            }
        }
    }
    return timely;
}

/// Return the reason why a request comes late.
inline std::string tell_cause(const Ref<LayerState>& state, const Ref<MetaRequest>& request, double now) {
    if (now <= request->start + cue_shapes::FITS) {
        return "its own preparation";
    }
    if (lang::len(state->cues) > 0
        && state->ready() >= now - cue_shapes::FITS
        && lang::at(state->cues, -1)->end >= state->free - cue_shapes::FITS) {
        return lang::text(
            "'",
            lang::at(state->cues, -1)->action->name,
            "', which plays until ",
            lang::fixed(state->free, 2),
            " s"
        );
    }
    return lang::len(state->cues) > 0
        ? std::string("what comes before it")
        : std::string("the time it became known at");
}

/// Return the latest time at which a requested action has to begin to be on time; never in the past.
inline double find_latest(const Ref<LayerState>& state, const Ref<MetaRequest>& request) {
    if (!request->stroke.has_value()) {
        return request->start;
    }
    double least = INFINITY;
    for (const auto& action : state->graph->of(state->stance, request->kind)) {
        bool fits = cue_shapes::meets(action, request);
        if (request->action.has_value()) {
            fits = action->id == *request->action;
        }
        if (!fits || !routes::may_play(state, action)) {
            continue;
        }
        if (action->kind != "gesture") { // it has no stroke: it should begin when its request does
            least = std::min(least, *request->stroke - request->start);
        } else {
            Ref<Phases> found = phases::find_phases(state->project, action);
            double lead = found->stroke - found->skip(action->timing->blend_in);
            double speed = manner::find_tempo(action, manner::find_mood(state, request, *request->stroke));
            least = std::min(least, lead + mood::drag(lead, speed));
        }
    }
    return *request->stroke - least;
}

/// Return the earliest time at which the next action could begin after this one.
inline double find_over(
    const Ref<LayerState>& state,
    const Ref<Action>& action,
    const Ref<MetaRequest>& request,
    double now
) {
    Ref<CueShape> shape = manner::shape_in_mood(state, action, request, now, manner::find_mood(state, request, now));
    return shape->start + cue_shapes::hurried(state->project, action, shape) + state->project->settings->rest
        - cue_shapes::FITS;
}

/// Return when an action that should play to its end is left early all the same: early enough for the first following
/// request that can then be in time, late enough for its own stroke; infinity for never.
inline double find_until(
    const Ref<LayerState>& state,
    const Ref<Action>& action,
    const Ref<CueShape>& shape,
    const Ref<Bound>& bound
) {
    if (lang::len(bound->after) == 0) {
        return INFINITY;
    }
    double rest = state->project->settings->rest;
    double soonest = shape->start + cue_shapes::hurried(state->project, action, shape);
    for (const auto& other : bound->after) {
        double in_time = punctuality::find_latest(state, other->request) + cue_shapes::slack_of(other->request);
        if (!lang::contains(state->served, other->key()) && soonest + rest <= in_time + cue_shapes::FITS) {
            return std::max(soonest, bounds::begins(other) - rest);
        }
    }
    return INFINITY;
}

}  // namespace punctuality

}  // namespace metagraph
