// Say how long actions play that repeat a part of their clip, such as one cycle of a wave.
//
// Translated from metagraph/graph/repeating.py; change that, and translate anew.
#pragma once

#include "model.hpp"
#include "language.hpp"

namespace metagraph {


namespace repeating {

inline constexpr double LEAST_CYCLE = 0.1; // seconds of a part that can repeat
inline constexpr double MOST_TIMES = 1000000.0; // that a cycle plays in a row
inline constexpr double LONGEST_REPEAT = 60.0; // most seconds that an action repeats if no request says how long
inline double cycle_of(const std::string& kind, const Ref<Timing>& timing, double start, double end);
inline double times_played(double cycle, double seconds);
inline double seconds_played(const std::string& kind, const Ref<Timing>& timing, double start, double end);

}  // namespace repeating

namespace repeating {

/// Return the length in seconds of the part from `start` to `end` that an action repeats, 0 if it plays once.
inline double cycle_of(const std::string& kind, const Ref<Timing>& timing, double start, double end) {
    bool repeats = timing->repeat > 0 && lang::contains(List<std::string>{"gesture", "fidget"}, kind);
    return (repeats && end - start >= repeating::LEAST_CYCLE) ? end - start : 0.0;
}

/// Return how many whole times, at least one, a cycle must play to last as close to `seconds` as possible.
inline double times_played(double cycle, double seconds) {
    return std::max(
        1.0,
        static_cast<double>(static_cast<int>(std::floor(std::min(seconds / cycle, repeating::MOST_TIMES) + 0.5)))
    );
}

/// Return how many seconds an action plays at its own speed if no request says how long.
inline double seconds_played(const std::string& kind, const Ref<Timing>& timing, double start, double end) {
    double cycle = repeating::cycle_of(kind, timing, start, end);
    if (cycle <= 0) {
        return end - start;
    }
    return cycle * repeating::times_played(cycle, std::min(timing->repeat, repeating::LONGEST_REPEAT));
}

}  // namespace repeating

}  // namespace metagraph
