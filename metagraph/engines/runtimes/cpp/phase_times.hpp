// When a gesture prepares, strikes, holds and retracts (Kendon; BML's ready, stroke-end and relax).
//
// Translated from metagraph/playback/timing/phase_times.py; change that, and translate anew.
#pragma once

#include "language.hpp"

namespace metagraph {

struct Phases;

namespace phase_times {

inline constexpr double LEAST_BLEND = 0.25; // seconds in which a gesture that skips its preparation comes in

}  // namespace phase_times

/// Clip seconds, ascending: start, ready (preparation ends), stroke (its peak), stroke_end (the hold begins), relax
/// (the hold ends), end.
struct Phases {
    double start;
    double ready;
    double stroke;
    double stroke_end;
    double relax;
    double end;

    Phases(double start_, double ready_, double stroke_, double stroke_end_, double relax_, double end_)
        : start(start_), ready(ready_), stroke(stroke_), stroke_end(stroke_end_), relax(relax_), end(end_) {}

    /// Return where a gesture begins if it skips its preparation: as late as it can blend in and be ready.
    double skip(double blend_in) const;
};

inline double Phases::skip(double blend_in) const {
    return std::max(this->start, this->ready - std::max(blend_in, phase_times::LEAST_BLEND));
}

}  // namespace metagraph
