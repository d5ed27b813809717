// What is known of a spoken line's sound: how long it is, where it is stressed, and which mouth shapes it goes through.
#pragma once

#include "json.hpp"
#include "letters.hpp"
#include "mouth.hpp"

namespace metagraph {

/// duration: seconds. accents: times of the stressed syllables. weights [K, 15]: how much of each of the shapes the mouth
/// shows, evenly spaced over 0..max(duration, 0.001).
struct Voice {
    double duration = 0.0;
    List<double> accents;
    List<float> weights;
};

namespace voice {

inline constexpr double ACCENT = 2.0; // seconds round a stressed syllable without another

/// The first peak, then the loudest ones that have no louder one beside them. People blink and gesture on these.
inline List<double> accents_of(const List<double>& peaks, const List<double>& strengths) {
    List<std::tuple<bool, double, double>> keys;
    for (int n = 0; n < lang::len(peaks); n++) keys.emplace_back(n > 0, -lang::at(strengths, n), lang::at(peaks, n));
    List<double> taken;
    for (const double peak : lang::ordered(peaks, keys)) {
        bool apart = true;
        for (const double other : taken) apart = apart && std::abs(peak - other) >= ACCENT;
        if (apart) taken.push_back(peak);
    }
    return lang::in_order(taken);
}

/// Return a voice guessed from letters alone. duration: seconds.
inline Ref<Voice> from_text(const std::string& text, double duration) {
    const Spelled found = letters::spelled(text, duration);
    return lang::made<Voice>(Voice{
        found.length,
        accents_of(found.peaks, found.strengths),
        mouth::track(found.pieces, found.pieces.empty() ? 0 : found.length),
    });
}

inline Ref<Voice> read(const Node& json) {
    Voice out;
    out.duration = json["duration"].within(0, 1e6);
    for (const Node& one : json["accents"].items()) out.accents.push_back(one.within(0, 1e6));
    const List<Node> rows = json["weights"].items();
    if (rows.size() < 2) json.wrong("should have two rows of weights or more");
    for (const Node& row : rows) {
        const List<double> own = row.numbers(life::SHAPES);
        out.weights.insert(out.weights.end(), own.begin(), own.end());
    }
    return lang::made<Voice>(out);
}

}  // namespace voice
}  // namespace metagraph
