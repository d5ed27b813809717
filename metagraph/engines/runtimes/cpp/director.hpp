// What keeps a performance from repeating itself and from being restless: how soon an action is done again, how long a
// posture is kept, how far apart acts are that stand out.
//
// Only what the Markov model writes is held back. Requests always play; of the actions that fit a request, those that
// have not played for long enough are likelier. `Settings.variety` multiplies every time here; 0 turns all of it off,
// as in Borer et al. The times are ours, chosen by what an hour of the sample then does
// (`docs/researchers/behaviour.md`).
//
// Translated from metagraph/playback/planning/director.py; change that, and translate anew.
#pragma once

#include "language.hpp"

namespace metagraph {


namespace director {

inline constexpr double STANDS_OUT = 0.65; // prominence from which on an act is one that a viewer remembers
inline constexpr double APART = 30.0; // seconds between two of those on one layer
// seconds of rest after which actions need to have rested only `SHORTER` as long
inline constexpr double LONG_REST = 30.0;
inline constexpr double SHORTER = 0.3;
inline constexpr double STALE = 0.05; // least factor of the likelihood of what has just been played
inline constexpr double LEAVES_HOME = 0.2; // share of the written tilts of the head that leave the stance it begins in
inline constexpr double GOES_HOME = 0.7; // share of the written moves of a tilted head that go back there
inline double repeat_interval(const std::string& kind, double prominence);
inline double posture(const std::string& layer);
inline double freshness(double since, double needed);

}  // namespace director

namespace director {

/// Return after how many seconds an action may be done again.
///
/// That is 18 s for a beat that hardly shows, six minutes for a gesture that stands out, and 4 to 10 minutes for
/// fidgets, which only time calls for. prominence: 0..1.
inline double repeat_interval(const std::string& kind, double prominence) {
    if (kind == "gesture") {
        return 18.0 * std::exp(std::log(20.0) * prominence);
    }
    return 240.0 * std::exp(std::log(2.5) * prominence);
}

/// Return how many seconds a stance is kept at least before the model changes it.
inline double posture(const std::string& layer) {
    if (layer == "body") {
        return 15.0;
    }
    return layer == "arms" ? 10.0 : 8.0;
}

/// Return the factor of an action's likelihood. since: seconds since it ended; needed: its interval.
inline double freshness(double since, double needed) {
    if (since >= needed) {
        return 1.0;
    }
    return std::max(director::STALE, since / needed);
}

}  // namespace director

}  // namespace metagraph
