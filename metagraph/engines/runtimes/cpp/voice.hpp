// What is known of a spoken line's sound: how long it is, where it is stressed, and which mouth shapes it goes through.
#pragma once

#include "graphemes.hpp"
#include "items.hpp"
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

/// The voices of lines by their ids, as an export has them.
struct Voices {
    Map<std::string, Ref<Voice>> known;

    /// The voice of something said: as its words and shapes were told, as its line's was read from the sound, else guessed
    /// from its text. What was made is remembered, a while, by each thread.
    Ref<Voice> of(const Ref<Speech>& speech) const {
        const Ref<Voice>* known_ = speech->timing == nullptr && speech->line.has_value() ? known.find(*speech->line) : nullptr;
        if (known_ != nullptr) return *known_;
        static thread_local std::vector<std::pair<std::weak_ptr<Speech>, Ref<Voice>>> made;
        static thread_local std::size_t next = 0;
        for (const auto& one : made) {
            if (!one.first.owner_before(speech) && !speech.owner_before(one.first)) return one.second;
        }
        const double length = std::max(0.0, items::measure_line(speech));
        const auto out = speech->timing != nullptr ? voice::from_timing(speech->timing, length) : voice::from_text(speech->text, length);
        if (made.size() < MOST) made.emplace_back();
        made[next] = {speech, out};
        next = (next + 1) % MOST;
        return out;
    }

private:
    static constexpr std::size_t MOST = 256;
};

namespace voice {

/// Times of the stressed syllables of something said.
inline List<double> stressed(const Ref<Voices>& voices, const Ref<Speech>& speech) { return voices->of(speech)->accents; }

inline bool are_same_voices(const Ref<Voices>& one, const Ref<Voices>& other) { return one == other; }

}  // namespace voice
}  // namespace metagraph
