// The mouth shapes of a voice, detected from its samples as they come in, from the levels of four bands relative to the
// loudest so far. The only delay is the shortest length of a shape, so every engine can analyse the sound that it
// plays.
//
// Open vowels have more energy around 800 Hz, the first formant of an open mouth, than around 300 Hz. Front vowels have
// more around 2200 Hz, their second formant. Sibilants have most above 3500 Hz. The bounds are ours, chosen by
// comparison with the results of `speech.sound` on whole recordings.
//
// Translated from metagraph/playback/life/streamed_voice.py; change that, and translate anew.
#pragma once

#include "line_timing.hpp"
#include "language.hpp"

namespace metagraph {

struct StreamedVoice;

namespace streamed_voice {

inline constexpr double HOP = 0.01; // seconds that are judged together
inline const List<double> HERTZ = List<double>{300.0, 800.0, 2200.0, 5000.0}; // middles of the bands
inline const List<double> QUALITY = List<double>{0.7, 1.0, 1.0, 0.7}; // and how narrow they are
inline constexpr double HIGHEST = 0.42; // of the rate: bands higher than this are left out
inline constexpr double LOUDEST = -32.0; // dB of full scale: a voice is taken to be at least as loud as this
inline constexpr double FORGET = 3.0; // dB a second by which the loudest is forgotten
inline constexpr double SHUT = -25.0; // dB beside the loudest: softer than this the mouth is shut
inline constexpr double SONOROUS = -16.0; // louder than this it is open
inline constexpr double HISSING = -33.0; // softer than this nothing hisses
inline constexpr double HISS = 3.0; // dB by which the highest band is above the lower ones where it does
inline constexpr double OPEN = -1.7; // dB of the second band beside the first: an open mouth, and
inline constexpr double HALF = -5.0; // half open
// dB of the third band beside the second: the tongue is in front, of half open mouths
inline constexpr double FRONT_HALF = -6.0;
inline constexpr double FRONT = -8.5; // and of others
inline constexpr double LEAST = 0.03; // seconds: anything shorter is not a shape
inline constexpr double STEP = 0.06; // seconds after which a shape that gets stronger or weaker
inline constexpr double GROWS = 0.15; // by this much is reported again
inline constexpr double BEHIND = 0.25; // seconds by which a piece may come late; a later one is heard when it comes

}  // namespace streamed_voice

/// The state of a voice that is analysed. rate: samples a second, 8000 or more. seconds: how much of it was heard.
/// missed: seconds of the line in which no sound came. The other fields are memory.
struct StreamedVoice {
    double rate;
    double seconds;
    double missed;
    std::string shape;
    double told;
    double weight;
    std::string coming;
    double since;
    double loudest;
    int judged;
    int inside;
    List<double> filters;
    List<double> memory;
    List<double> energy;

    explicit StreamedVoice(
        double rate_,
        double seconds_ = 0.0,
        double missed_ = 0.0,
        std::string shape_ = "sil",
        double told_ = 0.0,
        double weight_ = 1.0,
        std::string coming_ = "sil",
        double since_ = 0.0,
        double loudest_ = -120.0,
        int judged_ = 0,
        int inside_ = 0,
        List<double> filters_ = List<double>{},
        List<double> memory_ = List<double>{},
        List<double> energy_ = List<double>{}
    )
        : rate(rate_),
            seconds(seconds_),
            missed(missed_),
            shape(std::move(shape_)),
            told(told_),
            weight(weight_),
            coming(std::move(coming_)),
            since(since_),
            loudest(loudest_),
            judged(judged_),
            inside(inside_),
            filters(std::move(filters_)),
            memory(std::move(memory_)),
            energy(std::move(energy_)) {}

    /// Analyse the next samples, -1..1; return the shapes that begin in them: visemes of the set "oculus", at seconds
    /// from the line's start.
    List<Ref<VisemeMark>> hear(const List<double>& samples);

    /// Skip to where the line is if its sound came too late. said: seconds of the line that are over.
    void follow(double said);

    void _begin();

    /// Classify the last moment; return whether a shape begins or changes, at `told`.
    bool _judge(int size);

    /// Return the shape of a moment. levels: dB of the bands, without the highest band at low rates.
    std::string _shape_of(const List<double>& levels);
};

inline List<Ref<VisemeMark>> StreamedVoice::hear(const List<double>& samples) {
    List<Ref<VisemeMark>> out;
    if (lang::len(this->filters) == 0) {
        this->_begin();
    }
    int size = std::max(1, static_cast<int>(streamed_voice::HOP * this->rate));
    int count = lang::len(this->energy);
    for (const auto& sample : samples) {
        for (int band = 0; band < count; band++) {
            // A band-pass of two poles, in the transposed direct form II.
            int f = 3 * band;
            int m = 2 * band;
            double y = lang::at(this->filters, f) * sample + lang::at(this->memory, m);
            lang::at(this->memory, m) = lang::at(this->memory, m + 1) - lang::at(this->filters, f + 1) * y;
            lang::at(this->memory, m + 1) = -lang::at(this->filters, f) * sample - lang::at(this->filters, f + 2) * y;
            lang::at(this->energy, band) = lang::at(this->energy, band) + y * y;
        }
        this->inside += 1;
        if (this->inside == size && this->_judge(size)) {
            out.push_back(lang::made<VisemeMark>(this->told + this->missed, this->shape, this->weight));
        }
    }
    this->seconds = lang::divided(this->judged * size + this->inside, this->rate) + this->missed;
    return out;
}

inline void StreamedVoice::follow(double said) {
    if (this->seconds < said - streamed_voice::BEHIND) {
        this->missed += said - this->seconds;
        this->seconds = said;
    }
}

inline void StreamedVoice::_begin() {
    for (int n = 0; n < lang::len(streamed_voice::HERTZ); n++) {
        const auto& hertz = lang::at(streamed_voice::HERTZ, n);
        const auto& quality = lang::at(streamed_voice::QUALITY, n);
        if (hertz <= streamed_voice::HIGHEST * this->rate) {
            double turn = 2.0 * lang::PI * hertz / this->rate;
            double wide = std::sin(turn) / (2.0 * quality);
            this->filters.push_back(wide / (1.0 + wide));
            this->filters.push_back(-2.0 * std::cos(turn) / (1.0 + wide));
            this->filters.push_back((1.0 - wide) / (1.0 + wide));
            this->memory.push_back(0.0);
            this->memory.push_back(0.0);
            this->energy.push_back(0.0);
        }
    }
}

inline bool StreamedVoice::_judge(int size) {
    double now = lang::divided(this->judged * size, this->rate);
    List<double> levels;
    for (const auto& energy : this->energy) {
        levels.push_back(10.0 / std::log(10.0) * std::log(energy / size + 1e-12));
    }
    for (int band = 0; band < lang::len(this->energy); band++) {
        lang::at(this->energy, band) = 0.0;
    }
    this->inside = 0;
    this->judged += 1;
    double voiced = std::max(lang::at(levels, 0), std::max(lang::at(levels, 1), lang::at(levels, 2)));
    this->loudest = std::max(
        voiced,
        std::max(streamed_voice::LOUDEST, this->loudest - streamed_voice::FORGET * size / this->rate)
    );
    std::string shape = this->_shape_of(levels);
    if (shape != this->coming) {
        this->coming = shape;
        this->since = now;
    }
    double weight = 1.0;
    if (shape != "sil" && shape != "SS" && shape != "nn") {
        weight = 0.35 + 0.65 * std::min(1.0, std::max(0.0, 1.0 + (voiced - this->loudest) / -streamed_voice::SONOROUS));
    }
    bool begins = shape != this->shape && now + lang::divided(size, this->rate) - this->since >= streamed_voice::LEAST;
    if (begins
        || (shape == this->shape
            && std::abs(weight - this->weight) >= streamed_voice::GROWS
            && now - this->told >= streamed_voice::STEP)) {
        this->shape = shape;
        this->told = begins ? this->since : now;
        this->weight = weight;
        return true;
    }
    return false;
}

inline std::string StreamedVoice::_shape_of(const List<double>& levels) {
    double low = lang::at(levels, 0);
    double middle = lang::at(levels, 1);
    double high = lang::at(levels, 2);
    if (lang::len(levels) > 3
        && lang::at(levels, 3) > this->loudest + streamed_voice::HISSING
        && lang::at(levels, 3) > std::max(low, middle) + streamed_voice::HISS) {
        return "SS";
    }
    double loud = std::max(low, std::max(middle, high)) - this->loudest;
    if (loud < streamed_voice::SHUT) {
        return "sil";
    }
    if (loud < streamed_voice::SONOROUS) {
        return "nn";
    }
    if (middle - low > streamed_voice::OPEN) {
        return "aa";
    }
    if (middle - low > streamed_voice::HALF) {
        return high - middle > streamed_voice::FRONT_HALF ? std::string("E") : std::string("O");
    }
    return high - middle > streamed_voice::FRONT ? std::string("I") : std::string("U");
}

}  // namespace metagraph
