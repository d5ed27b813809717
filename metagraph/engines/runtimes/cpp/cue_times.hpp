// What of a cue shows at a time, in plain numbers: `player` and `Cue.clip_seconds` have it for arrays.
//
// Translated from metagraph/playback/cue_times.py; change that, and translate anew.
#pragma once

#include "meta_plan.hpp"
#include "language.hpp"

namespace metagraph {


namespace cue_times {

inline double cue_weight(const Ref<Cue>& cue, double time);
inline double cue_seconds(const Ref<Cue>& cue, double time);
inline double ease(double x);

}  // namespace cue_times

namespace cue_times {

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
    if (cue->hold <= 0.0) {
        return cue->entry + elapsed * cue->tempo;
    }
    double held = std::min(std::max(elapsed - (cue->hold_from - cue->entry) / cue->tempo, 0.0), cue->hold);
    double more = (elapsed - held) * (cue->tempo - 1.0);
    return cue->entry + elapsed - held + more + held * ((cue->hold_to - cue->hold_from) / cue->hold);
}

/// Return 3 x^2 - 2 x^3 of x within 0..1.
inline double ease(double x) {
    x = std::min(std::max(x, 0.0), 1.0);
    return x * x * (3.0 - 2.0 * x);
}

}  // namespace cue_times

}  // namespace metagraph
