// What is known of a spoken line's sound: how long it is, where it is stressed, and which mouth shapes it goes through.
#pragma once

#include "graphemes.hpp"
#include "life.hpp"
#include "line_timing.hpp"

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

inline Ref<Voice> voiced(const Spelled& sounds, double duration) {
    Voice out;
    out.duration = duration;
    out.accents = mouth::accents_of(sounds.peaks, sounds.strengths);
    for (const auto& row : mouth::mouth_track(sounds.pieces, sounds.pieces.empty() ? 0 : duration)) {
        for (const double weight : row) out.weights.push_back(static_cast<float>(weight));
    }
    return lang::made<Voice>(out);
}

/// Return a voice guessed from letters alone. duration: seconds.
inline Ref<Voice> from_text(const std::string& text, double duration) {
    const double length = std::max(duration, 0.0);
    return voiced(*graphemes::spelled(alphabet(), text, length), length);
}

/// Return the voice of a line whose words and shapes are told with their times.
inline Ref<Voice> from_timing(const Ref<LineTiming>& timing, double duration) {
    return voiced(*line_timing::timed_sounds(alphabet(), timing), duration);
}

/// Whether two lines' times are the same.
inline bool alike(const Ref<LineTiming>& a, const Ref<LineTiming>& b) {
    if (a == b) return true;
    if (a == nullptr || b == nullptr) return false;
    auto word = [](const auto& x, const auto& y) { return x->text == y->text && x->start == y->start && x->end == y->end; };
    auto mark = [](const auto& x, const auto& y) { return x->at == y->at && x->viseme == y->viseme && x->weight == y->weight; };
    return std::equal(a->words.begin(), a->words.end(), b->words.begin(), b->words.end(), word)
        && std::equal(a->marks.begin(), a->marks.end(), b->marks.begin(), b->marks.end(), mark);
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
