// What is known of a spoken line's sound: how long it is, where it is stressed, and which mouth shapes it goes through.
#pragma once

#include "graphemes.hpp"
#include "life.hpp"

namespace metagraph {

/// duration: seconds. accents: times of the stressed syllables. weights [K, 15]: how much of each of the shapes the mouth
/// shows, evenly spaced over 0..max(duration, 0.001).
struct Voice {
    double duration = 0.0;
    List<double> accents;
    List<float> weights;
};

namespace voice {

inline const Ref<Alphabet>& alphabet() {
    static const Ref<Alphabet> one = lang::made<Alphabet>();
    return one;
}

/// Return a voice guessed from letters alone. duration: seconds.
inline Ref<Voice> from_text(const std::string& text, double duration) {
    const double length = std::max(duration, 0.0);
    const Ref<Spelled> found = graphemes::spelled(alphabet(), text, length);
    Voice out;
    out.duration = length;
    out.accents = mouth::accents_of(found->peaks, found->strengths);
    for (const auto& row : mouth::mouth_track(found->pieces, found->pieces.empty() ? 0 : length)) {
        out.weights.insert(out.weights.end(), row.begin(), row.end());
    }
    return lang::made<Voice>(out);
}

inline Ref<Voice> read(const Node& json) {
    Voice out;
    out.duration = json["duration"].within(0, 1e6);
    for (const Node& one : json["accents"].items()) out.accents.push_back(one.within(0, 1e6));
    const List<Node> rows = json["weights"].items();
    if (rows.size() < 2) json.wrong("should have two rows of weights or more");
    for (const Node& row : rows) {
        for (const double one : row.numbers(life::SHAPES)) out.weights.push_back(static_cast<float>(one));
    }
    return lang::made<Voice>(out);
}

}  // namespace voice
}  // namespace metagraph
