// Keyed randomness: every draw is a hash of (seed, key, purpose), in 32-bit integers that any language can mix alike.
//
// Nothing is remembered between draws, so changing one request leaves the draws of all others as they were.
//
// Translated from metagraph/playback/choice.py; change that, and translate anew.
#pragma once

#include "hashing.hpp"
#include "language.hpp"

namespace metagraph {


namespace choice {

inline std::uint32_t key32(std::uint32_t seed, const List<std::string>& words);
inline double uniform(std::uint32_t seed, const List<std::string>& words);
inline std::string pick(
    std::uint32_t seed,
    const std::string& key,
    const std::string& purpose,
    const Map<std::string, double>& weights
);
inline double _unit(std::uint32_t bits);

}  // namespace choice

namespace choice {

/// Return the 32-bit hash of a seed and words: FNV-1a over their UTF-8 bytes, each word closed by a zero byte, then
/// mixed.
///
/// The seed, mixed, is xored into FNV's offset basis.
inline std::uint32_t key32(std::uint32_t seed, const List<std::string>& words) {
    int value = hashing::begun(seed);
    for (const auto& word : words) {
        value = hashing::absorb(value, word);
    }
    return hashing::mix(value);
}

/// Return a number in the open interval (0, 1).
inline double uniform(std::uint32_t seed, const List<std::string>& words) {
    return choice::_unit(choice::key32(seed, words));
}

/// Return one of the ids, id k with probability weight_k / sum.
///
/// Each id runs its own race, the shortest of exponential times -log(u_k) / weight_k wins; so adding or removing one
/// candidate changes the choice only where that candidate wins. Raises ValueError when no weight is positive.
inline std::string pick(
    std::uint32_t seed,
    const std::string& key,
    const std::string& purpose,
    const Map<std::string, double>& weights
) {
    std::string best = "";
    double shortest = INFINITY;
    int start = hashing::absorb(hashing::absorb(hashing::begun(seed), key), purpose);
    for (const auto& [ident, weight] : weights) {
        if (weight > 0) {
            double time = -std::log(choice::_unit(hashing::mix(hashing::absorb(start, ident)))) / weight;
            if (time < shortest || (time == shortest && ident < best)) {
                best = ident;
                shortest = time;
            }
        }
    }
    if (best == "") {
        lang::fail("nothing to choose from");
    }
    return best;
}

inline double _unit(std::uint32_t bits) {
    return (bits + 0.5) / 4294967296.0;
}

}  // namespace choice

}  // namespace metagraph
