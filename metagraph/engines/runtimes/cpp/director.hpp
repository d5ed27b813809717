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

#include "model.hpp"
#include "choice.hpp"
#include "language.hpp"

namespace metagraph {


namespace director {

inline constexpr double STANDS_OUT = 0.65; // prominence from which on an act is one that a viewer remembers
inline constexpr double APART = 30.0; // seconds between two of those on one layer
// seconds of rest after which actions need to have rested only `SHORTER` as long
inline constexpr double LONG_REST = 30.0;
inline constexpr double SHORTER = 0.3;
inline constexpr double LEAST_BEATS = 18.0; // seconds after which a gesture that hardly shows is done again, at least
inline constexpr double MOST_BEATS = 180.0; // and at most
inline constexpr double EACH = 7.0; // seconds of those for each gesture of the arms that the character has
inline constexpr double STALE = 0.05; // least factor of the likelihood of what has just been played
// share of the acts of one who talks that end a burst: some 2.5 acts, then a rest
inline constexpr double ENDS_BURST = 0.25;
inline constexpr double LEAST_LULL = 5.0; // seconds of that rest at least
inline constexpr double MOST_LULL = 30.0; // and at most
inline constexpr double LULL = 8.0; // its mean before it is clamped
inline constexpr double LULL_SPREAD = 14.0; // and its standard deviation
inline constexpr double LEAVES_HOME = 0.2; // share of the written tilts of the head that leave the stance it begins in
inline constexpr double GOES_HOME = 0.7; // share of the written moves of a tilted head that go back there
inline constexpr double MUSES = 2.0; // seconds that a thought goes on at least for which a hand goes to the chin
// seconds after a thought in which anything that is written takes the hand away again
inline constexpr double MUSED = 10.0;
// words of such a stance's name
inline const List<std::string> THOUGHTFUL = List<std::string>{"chin", "thinking", "pondering", "musing"};
inline std::string musing(const Map<std::string, Ref<Stance>>& stances);
inline double beat_interval(const std::string& layer, int gestures);
inline double repeat_interval(const std::string& kind, double prominence, double beats);
inline double posture(const std::string& layer);
inline double find_lull(std::uint32_t seed, const std::string& key, bool talks, double variety);
inline double freshness(double since, double needed);

}  // namespace director

namespace director {

/// Return the first stance of the arms whose name says that one thinks in it; "" for none.
inline std::string musing(const Map<std::string, Ref<Stance>>& stances) {
    for (const auto& [ident, stance] : stances) {
        for (const auto& word : lang::words(lang::lowered(stance->name))) {
            if (lang::contains(director::THOUGHTFUL, word)
                || lang::contains(director::THOUGHTFUL, std::get<2>(lang::parted_last(word, "_")))) {
                return ident;
            }
        }
    }
    return "";
}

/// Return after how many seconds a gesture that hardly shows may be done again: with many gestures of the arms, not for
/// minutes; with few, soon. gestures: how many the layer has.
inline double beat_interval(const std::string& layer, int gestures) {
    if (layer != "arms") {
        return director::LEAST_BEATS;
    }
    return std::min(director::MOST_BEATS, std::max(director::LEAST_BEATS, director::EACH * gestures));
}

/// Return after how many seconds an action may be done again.
///
/// That is from `beats` (`beat_interval`) to six minutes for gestures, the longer the more they stand out, and 5 to 10
/// minutes for fidgets, which only time calls for. prominence: 0..1.
inline double repeat_interval(const std::string& kind, double prominence, double beats) {
    if (kind == "gesture") {
        return beats * std::exp(std::log(360.0 / beats) * prominence);
    }
    return 300.0 * std::exp(std::log(2.0) * prominence);
}

/// Return how many seconds a stance is kept at least before the model changes it.
inline double posture(const std::string& layer) {
    if (layer == "body") {
        return 25.0;
    }
    return layer == "arms" ? 10.0 : 8.0;
}

/// Return how many seconds the arms rest at least after an act of theirs: nothing within a burst of one who talks, else
/// from `LEAST_LULL` to `MOST_LULL`. key: of the act's meta action.
inline double find_lull(std::uint32_t seed, const std::string& key, bool talks, double variety) {
    if (talks && choice::uniform(seed, List<std::string>{key, "burst"}) >= director::ENDS_BURST) {
        return 0.0;
    }
    double drawn = choice::log_normal(
        director::LULL,
        director::LULL_SPREAD,
        choice::uniform(seed, List<std::string>{key, "lull"}),
        choice::uniform(seed, List<std::string>{key, "lull2"})
    );
    return std::min(director::MOST_LULL, std::max(director::LEAST_LULL, drawn) * variety);
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
