// The mouth over time: from pieces of speech, each with one mouth shape, to smooth weights of all shapes.
//
// Coarticulation after Cohen and Massaro (1993): every piece rules the mouth around its own time, begins before it is
// heard and lingers after it; what the mouth shows is the mean of all pieces weighted by how much each rules. Lips that
// must meet rule more than a tongue nobody sees.
//
// Translated from metagraph/playback/life/mouth.py; change that, and translate anew.
#pragma once

#include "words.hpp"
#include "language.hpp"

namespace metagraph {

struct MouthPiece;

namespace mouth {

// How much each of VISEMES rules its neighbours: closed lips and teeth on the lip must be seen, tongue and
// palate need not.
inline const List<double> RULE = List<double>{
    0.8,
    6.0,
    4.0,
    1.0,
    0.7,
    0.5,
    1.6,
    1.2,
    0.7,
    0.9,
    1.5,
    1.3,
    1.2,
    1.7,
    1.9
};
inline constexpr double EARLY = 0.075; // seconds over which a shape comes before its sound begins
inline constexpr double LATE = 0.065; // and goes after it ends
inline constexpr double STEP = 0.02; // seconds between the rows of a track
inline constexpr double LEAST = 0.02; // how much rest rules everywhere
// seconds round a stressed syllable without another: blinks come as often as people's
inline constexpr double ACCENT = 2.0;
inline List<List<double>> mouth_track(const List<Ref<MouthPiece>>& pieces, double duration);
inline List<double> rest();
inline List<double> accents_of(const List<double>& peaks, const List<double>& strengths);
inline double _ease(double x);

}  // namespace mouth

/// A sound from `start` to `end` seconds: its mouth shape and how fully it is made, 0..1.
struct MouthPiece {
    double start;
    double end;
    std::string viseme;
    double strength;

    MouthPiece(double start_, double end_, std::string viseme_, double strength_ = 1.0)
        : start(start_), end(end_), viseme(std::move(viseme_)), strength(strength_) {}
};

namespace mouth {

/// Return rows `[K][15]` of the shapes' weights, summing to 1; shut at both ends. Their times are evenly spaced from 0
/// to the duration, at least 1 ms.
inline List<List<double>> mouth_track(const List<Ref<MouthPiece>>& pieces, double duration) {
    // as many for 0.88 s as languages that divide otherwise
    int count = std::max(2, static_cast<int>(std::ceil(duration / mouth::STEP - 1e-06)) + 1);
    double step = std::max(duration, 0.001) / (count - 1);
    List<List<double>> rows;
    for (int row = 0; row < count; row++) {
        List<double> found;
        for (int shape = 0; shape < lang::len(words::VISEMES); shape++) {
            found.push_back(0.0);
        }
        rows.push_back(found);
    }
    List<double> made;
    for (int row = 0; row < count; row++) {
        made.push_back(0.0);
    }
    for (const auto& piece : pieces) {
        int place = lang::index(words::VISEMES, piece->viseme);
        // Short sounds are not left out: their ramps overlap and still reach the top in the middle.
        double inside = std::min(0.5 * (piece->end - piece->start), 0.04);
        int first = std::max(0, static_cast<int>(std::ceil((piece->start - mouth::EARLY) / step)));
        for (int k = first; k < std::min(count, static_cast<int>(std::ceil((piece->end + mouth::LATE) / step))); k++) {
            double rise = mouth::_ease((k * step - piece->start + mouth::EARLY) / (mouth::EARLY + inside));
            double fall = mouth::_ease((piece->end + mouth::LATE - k * step) / (mouth::LATE + inside));
            double here = std::min(rise, fall);
            lang::at(made, k) += here;
            lang::at(lang::at(rows, k), place) += here * lang::at(mouth::RULE, place) * piece->strength;
            lang::at(lang::at(rows, k), 0) += here * lang::at(mouth::RULE, place) * (1 - piece->strength);
        }
    }
    List<List<double>> out = List<List<double>>{mouth::rest()};
    for (int k = 1; k < count - 1; k++) {
        lang::at(lang::at(rows, k), 0) += mouth::LEAST
            + lang::at(mouth::RULE, 0) * std::max(1 - lang::at(made, k), 0.0); // where no sound rules, rest does
        double whole = lang::sum(lang::at(rows, k));
        List<double> found2;
        for (const auto& weight : lang::at(rows, k)) {
            found2.push_back(weight / whole);
        }
        out.push_back(found2);
    }
    out.push_back(mouth::rest());
    return out;
}

/// Return the weights of a shut mouth.
inline List<double> rest() {
    List<double> found;
    for (int n = 0; n < lang::len(words::VISEMES); n++) {
        found.push_back(n == 0 ? 1.0 : 0.0);
    }
    return found;
}

/// Return the times of stressed syllables: the first peak, then the strongest that have no stronger one within `ACCENT`
/// seconds. People blink and gesture on these, not on every syllable.
inline List<double> accents_of(const List<double>& peaks, const List<double>& strengths) {
    List<double> taken;
    List<std::tuple<int, double, double>> keys;
    for (int i2 = 0; i2 < lang::len(peaks); i2++) {
        keys.push_back(std::tuple<int, double, double>{i2 == 0 ? 0 : 1, -lang::at(strengths, i2), lang::at(peaks, i2)});
    }
    for (const auto& i : lang::ordered(lang::range(lang::len(peaks)), keys)) {
        bool are_all = true;
        for (const auto& t : taken) {
            if (!(std::abs(lang::at(peaks, i) - t) >= mouth::ACCENT)) {
                are_all = false;
                break;
            }
        }
        if (are_all) {
            taken.push_back(lang::at(peaks, i));
        }
    }
    return lang::in_order(taken);
}

inline double _ease(double x) {
    if (x <= 0) {
        return 0.0;
    }
    return x >= 1 ? 1.0 : x * x * (3 - 2 * x);
}

}  // namespace mouth

}  // namespace metagraph
