// Compute how much of a cue, or of a stance's loop, shows at a time, with plain numbers. `player` and
// `Cue.clip_seconds` do the same with arrays.
//
// Translated from metagraph/playback/posing/cue_times.py; change that, and translate anew.
#pragma once

#include "model.hpp"
#include "meta_plan.hpp"
#include "project.hpp"
#include "language.hpp"

namespace metagraph {

struct LoopSpot;

namespace cue_times {

// clip seconds in which a cue that repeats makes its cycle's ends meet, at most half of the cycle
inline constexpr double SEAM = 0.4;
inline Ref<LoopSpot> loop_spot(const Ref<Project>& project, const Ref<Rest>& rest, double time);
inline double cue_weight(const Ref<Cue>& cue, double time);
inline double cue_seconds(const Ref<Cue>& cue, double time);
inline double seam_left(const Ref<Cue>& cue, double time);
inline double ease(double x);

}  // namespace cue_times

/// Where a loop is.
///
/// `seconds` is the time in its clip, `other` the time on the other side of its seam. `over` is how far it has blended
/// from there to here, 1 if no seam shows. `leaves` and `meets` are the clip seconds at which the two sides of the seam
/// begin and end.
struct LoopSpot {
    double seconds;
    double other;
    double over;
    double leaves;
    double meets;

    LoopSpot(double seconds_, double other_, double over_, double leaves_, double meets_)
        : seconds(seconds_), other(other_), over(over_), leaves(leaves_), meets(meets_) {}
};

namespace cue_times {

/// Return where a stance's loop is at a time, as `layers.compute_loop_seconds` does.
inline Ref<LoopSpot> loop_spot(const Ref<Project>& project, const Ref<Rest>& rest, double time) {
    Ref<Action> action = rest->action;
    auto [start, end] = project->span(action);
    double seam = std::min(std::max(0.0, action->timing->blend_in), (end - start) / 2.0);
    double period = end - start - seam;
    if (period <= 0.0) {
        return lang::made<LoopSpot>(start, start, 1.0, start, start);
    }
    double elapsed = time - rest->start;
    double phase = seam > 0.0 ? std::max(elapsed, 0.0) : elapsed;
    phase = phase - period * static_cast<int>(std::floor(phase / period));
    double over = (seam > 0.0 && elapsed >= period && phase < seam) ? phase / seam : 1.0;
    double other = start + std::min(period + phase, end - start);
    return lang::made<LoopSpot>(start + phase, other, over, start + period, start + seam);
}

/// Return how much of a cue shows at a time, 0..1.
inline double cue_weight(const Ref<Cue>& cue, double time) {
    if (time < cue->start || time >= cue->end) {
        return 0.0;
    }
    double rise = cue->blend_in > 0.0 ? cue_times::ease((time - cue->start) / cue->blend_in) : 1.0;
    double fall = cue->blend_out > 0.0 ? cue_times::ease((cue->end - time) / cue->blend_out) : 1.0;
    return rise * fall;
}

/// Return the second of its clip that a cue plays at a time.
inline double cue_seconds(const Ref<Cue>& cue, double time) {
    double elapsed = time - cue->start;
    if (cue->repeats()) {
        double cycle = cue->cycle_to - cue->cycle_from;
        double into = cue->entry - cue->cycle_from + elapsed * cue->tempo;
        return cue->cycle_from + into - cycle * static_cast<int>(std::floor(into / cycle));
    }
    if (cue->hold <= 0.0) {
        return cue->entry + elapsed * cue->tempo;
    }
    double held = std::min(std::max(elapsed - (cue->hold_from - cue->entry) / cue->tempo, 0.0), cue->hold);
    double more = (elapsed - held) * (cue->tempo - 1.0);
    return cue->entry + elapsed - held + more + held * ((cue->hold_to - cue->hold_from) / cue->hold);
}

/// Return the share, 0..1, of the offset between the end of one cycle and the beginning of the next that is still added
/// at a time, so that a cue that repeats does not jump.
inline double seam_left(const Ref<Cue>& cue, double time) {
    double cycle = cue->cycle_to - cue->cycle_from;
    double into = cue->entry - cue->cycle_from + (time - cue->start) * cue->tempo;
    if (!cue->repeats() || static_cast<int>(std::floor(into / cycle)) < 1) {
        return 0.0;
    }
    return 1.0
        - cue_times::ease(
            (into - cycle * static_cast<int>(std::floor(into / cycle))) / std::min(cue_times::SEAM, 0.5 * cycle)
        );
}

/// Return 3 x^2 - 2 x^3 of x clamped to 0..1.
inline double ease(double x) {
    x = std::min(std::max(x, 0.0), 1.0);
    return x * x * (3.0 - 2.0 * x);
}

}  // namespace cue_times

}  // namespace metagraph
