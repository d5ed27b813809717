// Thirty-two bits from texts: FNV-1a over their UTF-8 bytes, and MurmurHash3's finaliser.
#pragma once

#include <cstdint>
#include <string>

namespace metagraph {
namespace hashing {

inline constexpr std::uint32_t OFFSET = 0x811C9DC5, PRIME = 0x01000193;  // FNV-1a's, 32 bits

/// Scramble 32 bits: two rounds of shift-xor and odd multiplication.
inline std::uint32_t mix(std::uint32_t value) {
    value ^= value >> 16;
    value *= 0x85EBCA6B;
    value ^= value >> 13;
    value *= 0xC2B2AE35;
    return value ^ (value >> 16);
}

/// Take a word and the zero byte that closes it into a hash.
inline std::uint32_t absorb(std::uint32_t value, const std::string& word) {
    for (const unsigned char byte : word) value = (value ^ byte) * PRIME;
    return value * PRIME;
}

/// The hash before any word.
inline std::uint32_t begun(std::uint32_t seed) { return OFFSET ^ mix(seed); }

}  // namespace hashing
}  // namespace metagraph
