// Which shape the mouth has: the voices of what is said, at any time.
#pragma once

#include "graph.hpp"
#include "mouth.hpp"
#include "track.hpp"

namespace metagraph {
namespace lips {

inline constexpr double CLOSING = 0.12; // seconds the mouth takes to close where speech was cut

/// How much of each shape but silence the mouth shows.
using Shown = std::array<double, life::SHAPES - 1>;

inline List<double> shown(const Voice& voice, const Speech& speech, double time) {
    List<double> out(static_cast<std::size_t>(life::SHAPES - 1), 0.0);
    if (time < speech.start) return out;
    const double kept = 1 - rotation::ease((time - speech.end) / CLOSING);
    const int last = static_cast<int>(voice.weights.size()) / life::SHAPES - 1;
    const double at = (std::min(time, speech.end) - speech.start + speech.skip) / std::max(voice.duration, 1e-3) * last;
    const int low = std::clamp(static_cast<int>(std::floor(std::min(at, 1e9))), 0, last - 1);
    const double part = std::clamp(at - low, 0.0, 1.0);
    for (int k = 1; k < life::SHAPES; k++) {
        const int a = low * life::SHAPES + k;
        const double weight = lang::at(voice.weights, a) * (1 - part) + lang::at(voice.weights, a + life::SHAPES) * part;
        out[static_cast<std::size_t>(k - 1)] = kept * weight;
    }
    return out;
}

/// Return what the mouth shows at a time; all 0 where nothing is said.
inline Shown at(const Graph& graph, const Track& track, double time) {
    Shown out{};
    const double smoothing = graph.life->lip_smoothing;
    for (const auto& speech : track.speeches) {
        if (speech->start > time + smoothing) break;
        if (speech->end + CLOSING + smoothing <= time || time <= speech->start - smoothing) continue;
        const Ref<Voice> voice = graph.voices->of(speech);
        const List<double> now = shown(*voice, *speech, time);
        List<double> soft = now;
        if (smoothing > 0) {
            mouth::soften(soft, shown(*voice, *speech, time - smoothing), now, shown(*voice, *speech, time + smoothing));
        }
        for (std::size_t k = 0; k < out.size(); k++) out[k] += soft[k];
    }
    double sum = 0;
    for (const double one : out) sum += one;
    for (double& one : out) one /= std::max(sum, 1.0); // two speeches may meet; together they are one mouth
    return out;
}

}  // namespace lips
}  // namespace metagraph
