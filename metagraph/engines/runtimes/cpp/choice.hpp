// Keyed randomness: every draw is a hash of (seed, key, purpose), in 32-bit integers that any language mixes in the
// same way.
//
// Draws remember nothing, so a change of one request does not change the draws of the others.
//
// Translated from metagraph/playback/planning/choice.py; change that, and translate anew.
#pragma once

#include "hashing.hpp"
#include "language.hpp"

namespace metagraph {


namespace choice {

inline constexpr double ALL = 4294967296.0; // numbers of 32 bits
inline std::uint32_t key32(std::uint32_t seed, const List<std::string>& words);
inline std::uint32_t keyed(std::uint32_t seed, const List<std::string>& words);
inline double uniform(std::uint32_t seed, const List<std::string>& words);
inline double chance_of(std::uint32_t key, const std::string& purpose);
inline double log_normal(double mean, double deviation, double u, double v);
inline std::string pick(
    std::uint32_t seed,
    const std::string& key,
    const std::string& purpose,
    const Map<std::string, double>& weights
);
inline std::string picked(std::uint32_t key, const std::string& purpose, const Map<std::string, double>& weights);

}  // namespace choice

namespace choice {

/// Return the 32-bit hash of a seed and words: FNV-1a over their UTF-8 bytes, each word closed by a zero byte, then
/// mixed.
///
/// The mixed seed is xored into FNV's offset basis.
inline std::uint32_t key32(std::uint32_t seed, const List<std::string>& words) {
    return hashing::mix(choice::keyed(seed, words));
}

/// Return the hash of a seed and words before it is mixed, which all draws of one key share.
inline std::uint32_t keyed(std::uint32_t seed, const List<std::string>& words) {
    int value = hashing::begun(seed);
    for (const auto& word : words) {
        value = hashing::absorb(value, word);
    }
    return value;
}

/// Return a number in the open interval (0, 1).
inline double uniform(std::uint32_t seed, const List<std::string>& words) {
    return (hashing::mix(choice::keyed(seed, words)) + 0.5) / choice::ALL;
}

/// Return the number that `uniform` returns for a key and one more word.
inline double chance_of(std::uint32_t key, const std::string& purpose) {
    return (hashing::mix(hashing::absorb(key, purpose)) + 0.5) / choice::ALL;
}

/// Return a log-normal number from two uniform ones in (0, 1) by Box and Muller, in a way that any language can
/// compute: `a = ln(1 + (s / m)^2)`, `z = sqrt(-2 ln u) cos(2 pi v)`, `m exp(sqrt(a) z - a / 2)`.
inline double log_normal(double mean, double deviation, double u, double v) {
    double share = deviation / mean;
    double spread = std::log1p(share * share);
    double z = std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * lang::PI * v);
    return mean * std::exp(std::sqrt(spread) * z - spread / 2.0);
}

/// Return one of the ids, chosen as by `picked`.
inline std::string pick(
    std::uint32_t seed,
    const std::string& key,
    const std::string& purpose,
    const Map<std::string, double>& weights
) {
    return choice::picked(choice::keyed(seed, List<std::string>{key}), purpose, weights);
}

/// Return one of the ids, id k with probability weight_k / sum.
///
/// Each id draws its own exponential time, -log(u_k) / weight_k, and the shortest wins. So adding or removing a
/// candidate changes the choice only if that candidate wins. Raises ValueError when no weight is positive.
inline std::string picked(std::uint32_t key, const std::string& purpose, const Map<std::string, double>& weights) {
    std::string best = "";
    double shortest = INFINITY;
    int start = hashing::absorb(key, purpose);
    for (const auto& [ident, weight] : weights) {
        if (weight > 0) {
            double time = -std::log((hashing::mix(hashing::absorb(start, ident)) + 0.5) / choice::ALL) / weight;
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

}  // namespace choice

}  // namespace metagraph
