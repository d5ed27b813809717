// Animations' buffer views packed as EXT_meshopt_compression says: attributes, and the filters that turns and moves have. After the
// specification of the extension (Khronos Group, appendices A and B).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>

#include "language.hpp"

namespace metagraph {
namespace meshopt {

/// Return `count` elements of `size` bytes; `wrong` says what is wrong, and stays empty where all is well.
inline List<std::uint8_t> attributes(const std::uint8_t* data, std::size_t length, std::size_t count, std::size_t size, std::string& wrong) {
    const std::size_t group = 16, tail = std::max<std::size_t>(32, size);
    wrong = "has packed attributes that are cut short";
    if (size == 0 || size % 4 != 0 || size > 256 || length < 1 + tail || data[0] != 0xA0) return {};
    // A block has a header of some bits for each group at least.
    const std::size_t block = std::min<std::size_t>(8192 / size & ~(group - 1), 256), end = length - tail;
    if (count / block * size > end) return {};
    List<std::uint8_t> out(count * size), before(data + length - size, data + length);
    std::size_t at = 1;
    for (std::size_t first = 0; first < count; first += block) {
        const std::size_t elements = std::min(block, count - first), groups = (elements + group - 1) / group;
        for (std::size_t k = 0; k < size; k++) {
            const std::size_t head = at;
            at += (groups + 3) / 4;
            if (at > end) return {};
            std::uint8_t value = before[k];
            for (std::size_t g = 0, n = 0; g < groups; g++) {
                const unsigned mode = data[head + g / 4] >> (g % 4 * 2) & 3, bits = 1u << mode, most = (1u << bits) - 1;
                std::size_t later = at + 4 * mode;
                if ((mode == 3 ? at + group : later) > end) return {};
                for (std::size_t i = 0; i < group; i++, n++) {
                    unsigned delta = 0;
                    if (mode == 3) {
                        delta = data[at + i];
                    } else if (mode != 0) {
                        delta = data[at + i * bits / 8] >> (8 - bits - i * bits % 8) & most;
                        if (delta == most) {
                            if (later >= end) return {};
                            delta = data[later++];
                        }
                    }
                    value = static_cast<std::uint8_t>(value + ((delta & 1) != 0 ? ~(delta >> 1) : delta >> 1));
                    if (n < elements) before[k] = out[(first + n) * size + k] = value;
                }
                at = mode == 3 ? at + group : later;
            }
        }
    }
    if (at != end) return {};
    wrong.clear();
    return out;
}

/// Turn little-endian attributes into what they were before a filter.
inline void unfilter(List<std::uint8_t>& bytes, std::size_t size, const std::string& filter, std::string& wrong) {
    if (filter == "EXPONENTIAL") {
        for (std::size_t n = 0; n + 4 <= bytes.size(); n += 4) {
            const std::int32_t mantissa = bytes[n] | bytes[n + 1] << 8 | static_cast<std::int8_t>(bytes[n + 2]) * 65536;
            const float value = std::ldexp(static_cast<float>(mantissa), static_cast<std::int8_t>(bytes[n + 3]));
            std::uint32_t raw = 0;
            std::memcpy(&raw, &value, sizeof raw);
            for (std::size_t k = 0; k < 4; k++) bytes[n + k] = static_cast<std::uint8_t>(raw >> (8 * k));
        }
    } else if (filter == "QUATERNION" && size == 8) {
        for (std::size_t n = 0; n + 8 <= bytes.size(); n += 8) {
            auto number = [&bytes, n](std::size_t k) { return bytes[n + 2 * k] + static_cast<std::int8_t>(bytes[n + 2 * k + 1]) * 256; };
            const int told = number(3);
            const double scale = std::sqrt(0.5) / (told | 3), x = number(0) * scale, y = number(1) * scale, z = number(2) * scale;
            const double values[] = {x, y, z, std::sqrt(std::max(0.0, 1 - x * x - y * y - z * z))};
            for (std::size_t k = 0; k < 4; k++) {
                const std::size_t place = (static_cast<std::size_t>(told & 3) + 1 + k) % 4;
                const auto whole = static_cast<std::int16_t>(std::lround(values[k] * 32767));
                bytes[n + 2 * place] = static_cast<std::uint8_t>(whole & 255);
                bytes[n + 2 * place + 1] = static_cast<std::uint8_t>(whole >> 8 & 255);
            }
        }
    } else if (filter != "NONE") {
        wrong = "is packed with a filter that animations do not have here";
    }
}

}  // namespace meshopt
}  // namespace metagraph
