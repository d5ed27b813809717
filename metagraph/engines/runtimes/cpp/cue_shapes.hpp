// How an action would play for a request: when it begins, how long it lasts and how late it is.
//
// A gesture waits for its stroke or cuts its preparation to catch up with it; its hold is stretched, and its retraction
// may be cut (Borer et al., section 6.2).
//
// Translated from metagraph/playback/planning/cue_shapes.py; change that, and translate anew.
#pragma once

#include "model.hpp"
#include "repeating.hpp"
#include "meta_plan.hpp"
#include "mood.hpp"
#include "phase_times.hpp"
#include "phases.hpp"
#include "project.hpp"
#include "language.hpp"

namespace metagraph {

struct CueShape;

namespace cue_shapes {

inline constexpr double FITS = 1e-06; // seconds by which sums of times may be off
inline constexpr double HURRY = 2.0; // a hold is played at most this many times as fast as it was made
// seconds in which an action that is taken back goes back to its stance, from where it is
inline constexpr double STOPPED = 0.3;
// seconds in which an action whose retraction is cut goes back to its stance, at the least
inline constexpr double RETRACTION = 0.4;
inline constexpr double SHARED = 0.25; // seconds within which two strokes may be one
inline Ref<CueShape> shape_of(
    const Ref<Project>& project,
    const Ref<Action>& action,
    const Ref<MetaRequest>& request,
    double now,
    double speed
);
inline bool fits_before(const Ref<CueShape>& shape, double limit);
inline double lateness(
    const Ref<Project>& project,
    const Ref<Action>& action,
    const Ref<MetaRequest>& request,
    const Ref<CueShape>& shape
);
inline double slack_of(const Ref<MetaRequest>& request);
inline double hurried(const Ref<Project>& project, const Ref<Action>& action, const Ref<CueShape>& shape);
inline bool may_share(const Ref<MetaRequest>& request, const Ref<MetaRequest>& other);
inline bool meets(const Ref<Action>& action, const Ref<MetaRequest>& request);
inline Ref<MetaRequest> remaining(const Ref<MetaAction>& meta, double now);

}  // namespace cue_shapes

/// How an action would play: from `start` on, for `length` seconds, at least `shortest`; the other fields are those of
/// a cue.
struct CueShape {
    double start;
    double entry;
    double length;
    double shortest;
    double hold_from;
    double hold_to;
    double hold;
    double tempo;

    CueShape(
        double start_,
        double entry_,
        double length_,
        double shortest_,
        double hold_from_ = 0.0,
        double hold_to_ = 0.0,
        double hold_ = 0.0,
        double tempo_ = 1.0
    )
        : start(start_),
            entry(entry_),
            length(length_),
            shortest(shortest_),
            hold_from(hold_from_),
            hold_to(hold_to_),
            hold(hold_),
            tempo(tempo_) {}
};

namespace cue_shapes {

/// Return how an action would play for a request from `now` on, or as a step on the way to it. speed: a factor of the
/// action's own speed.
inline Ref<CueShape> shape_of(
    const Ref<Project>& project,
    const Ref<Action>& action,
    const Ref<MetaRequest>& request,
    double now,
    double speed
) {
    auto [start, end] = project->span(action);
    double begin = now;
    double entry = start;
    double hold_from = 0.0;
    double hold_to = 0.0;
    double hold = 0.0;
    double cycle = repeating::cycle_of(action->kind, action->timing, start, end);
    if (request != nullptr
        && action->kind == "gesture"
        && (request->hold.has_value() || request->stroke.has_value() || !request->prepare)) {
        Ref<Phases> found = phases::find_phases(project, action);
        double latest = found->skip(action->timing->blend_in);
        entry = request->prepare ? start : latest;
        // Wait for the stroke, or catch up with it by cutting the preparation.
        if (request->stroke.has_value()) {
            begin = std::max(now, *request->stroke - (found->stroke - entry) / speed);
            double missed = found->stroke - std::max(0.0, *request->stroke - begin) * speed;
            entry = std::min(std::max(entry, missed), std::max(entry, latest));
        }
        if (request->hold.has_value() && cycle <= 0) {
            hold_from = found->stroke_end;
            hold_to = found->relax;
            hold = std::max(*request->hold, (hold_to - hold_from) / cue_shapes::HURRY);
            if (hold <= 0) {
                hold_from = 0.0;
                hold_to = 0.0;
            }
        }
    }
    double natural = hold_to - hold_from;
    double length = end - entry + hold - natural + mood::drag(end - entry - natural, speed);
    double shortest = length;
    std::optional<double> exit_at = action->timing->earliest_exit;
    if (cycle > 0) {
        double wanted = std::min(action->timing->repeat, repeating::LONGEST_REPEAT);
        if (request != nullptr && request->hold.has_value()) {
            wanted = *request->hold; // what repeats goes on for as long as another gesture would be held
        }
        if (request != nullptr && request->duration.has_value()) {
            wanted = *request->duration;
        }
        length += (repeating::times_played(cycle, wanted * speed) - 1.0) * cycle / speed;
        exit_at = !exit_at.has_value() ? end : *exit_at;
    }
    if (exit_at.has_value()) {
        double left = *exit_at - entry + (*exit_at >= hold_to ? hold - natural : 0.0);
        left += mood::drag(*exit_at - entry - (*exit_at >= hold_to ? natural : 0.0), speed);
        shortest = std::min(length, std::max(0.0, left) + action->timing->blend_out);
    }
    return lang::made<CueShape>(begin, entry, length, shortest, hold_from, hold_to, hold, speed);
}

/// Return whether something with this shape is over by a limit.
inline bool fits_before(const Ref<CueShape>& shape, double limit) {
    return shape->start + shape->shortest <= limit + cue_shapes::FITS;
}

/// Return by how many seconds an action with this shape comes late, measured at its stroke if the request has one;
/// below 0 if it comes early.
inline double lateness(
    const Ref<Project>& project,
    const Ref<Action>& action,
    const Ref<MetaRequest>& request,
    const Ref<CueShape>& shape
) {
    if (request->stroke.has_value() && action->kind == "gesture") {
        Ref<Phases> found = phases::find_phases(project, action);
        double until = found->stroke - shape->entry;
        return shape->start + found->stroke - shape->entry + mood::drag(until, shape->tempo) - *request->stroke;
    }
    return shape->start - request->start;
}

/// Return by how many seconds a request may come late, 0 if it does not say.
inline double slack_of(const Ref<MetaRequest>& request) {
    return !request->late.has_value() ? 0.0 : *request->late;
}

/// Return how many seconds a gesture takes if its retraction is cut and its hold is left out, unless the request has a
/// hold.
inline double hurried(const Ref<Project>& project, const Ref<Action>& action, const Ref<CueShape>& shape) {
    auto [start, end] = project->span(action);
    bool repeats = repeating::cycle_of(action->kind, action->timing, start, end) > 0;
    if (action->kind != "gesture" || action->timing->earliest_exit.has_value() || repeats) {
        return shape->shortest;
    }
    Ref<Phases> found = phases::find_phases(project, action);
    double left = found->relax - shape->entry + shape->hold - (shape->hold_to - shape->hold_from);
    double moving = found->relax - shape->entry - (shape->hold_to - shape->hold_from);
    if (shape->hold <= 0) {
        left = found->stroke_end - shape->entry;
        moving = left;
    }
    left += mood::drag(moving, shape->tempo);
    return std::min(shape->length, left + std::max(action->timing->blend_out, cue_shapes::RETRACTION));
}

/// Return whether one stroke may meet two requests.
inline bool may_share(const Ref<MetaRequest>& request, const Ref<MetaRequest>& other) {
    if (!request->stroke.has_value() || !other->stroke.has_value()) {
        return false;
    }
    return !request->action.has_value()
        && !other->action.has_value()
        && request->kind == other->kind
        && (!other->hold.has_value() || *other->hold == request->hold)
        && std::abs(*request->stroke - *other->stroke) <= cue_shapes::SHARED;
}

/// Return whether an action fits a request that does not name one.
inline bool meets(const Ref<Action>& action, const Ref<MetaRequest>& request) {
    bool are_all = true;
    for (const auto& tag : request->tags) {
        if (!lang::contains(action->tags, tag)) {
            are_all = false;
            break;
        }
    }
    return are_all
        && (!request->limb.has_value() || action->limb == *request->limb)
        && (lang::len(request->among) == 0 || lang::contains(request->among, action->id));
}

/// Return the request of a meta action; for a remainder, with the duration that is left. What a model wrote has no
/// duration.
inline Ref<MetaRequest> remaining(const Ref<MetaAction>& meta, double now) {
    Ref<MetaRequest> request = meta->request;
    if (!request->duration.has_value() || (meta->part == 0 && !meta->written)) {
        return request;
    }
    return lang::made<MetaRequest>(
        request->id,
        request->layer,
        request->kind,
        request->start,
        meta->written ? std::nullopt : std::optional<double>(std::max(0.0, meta->end - now)),
        request->action,
        request->tags,
        request->limb,
        request->stance,
        request->priority,
        request->resume,
        request->stroke,
        request->hold,
        request->prepare,
        request->among,
        request->late,
        request->valence,
        request->arousal,
        request->intensity
    );
}

}  // namespace cue_shapes

}  // namespace metagraph
