// The mouth over time: turn pieces of speech, each with one mouth shape, into smooth weights of all shapes.
//
// Coarticulation after Cohen and Massaro (1993): every piece dominates the mouth around its own time, begins before it
// is heard and lingers after it. The mouth shows the mean of all pieces, weighted by their dominance. A mean never
// closes a mouth. So lips that meet (p, b, m) and teeth on the lip (f, v) are added on top (`_closed`): in their middle
// nothing else shows, however quick the speech is. Lips round for a rounded vowel as soon as the consonants before it
// begin (look-ahead, Henke 1966), at most a quarter of a second before it (Bell-Berti and Harris 1981 found it begin at
// about a fixed time before the vowel). The numbers are ours.
//
// Translated from metagraph/playback/life/mouth.py; change that, and translate anew.
#pragma once

#include "words.hpp"
#include "language.hpp"

namespace metagraph {

struct MouthPiece;

namespace mouth {

// How much each of VISEMES rules its neighbours: tongue and palate need not be seen. What closes the mouth
// does not take part in the mean.
inline const List<double> RULE = List<double>{
    0.8,
    0.0,
    0.0,
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
inline const List<std::string> CLOSURES = List<std::string>{"PP", "FF"};
inline const List<std::string> VOWELS = List<std::string>{"aa", "E", "I", "O", "U"};
inline const List<std::string> ROUNDED = List<std::string>{"O", "U"};
inline constexpr double EARLY = 0.075; // seconds over which a shape comes before its sound begins
inline constexpr double LATE = 0.065; // and goes after it ends
inline constexpr double STEP = 0.02; // seconds between the rows of a track
inline constexpr double LOOK_AHEAD = 0.25; // seconds by which a rounded vowel may come before its sound
inline constexpr double PAUSE = 0.03; // seconds without a sound that end a run of consonants
// seconds before and after its middle that a closure lasts at least: a row on each side
inline constexpr double HELD = 0.02;
inline constexpr double SHUTTING = 0.09; // seconds it takes to close and to open again
inline constexpr double PARTING = 0.03; // seconds one closure takes to make way for the other
inline constexpr double LEAST = 0.02; // how much rest rules everywhere
// seconds round a stressed syllable without another: blinks come as often as people's
inline constexpr double ACCENT = 2.0;
inline List<List<double>> mouth_track(const List<Ref<MouthPiece>>& pieces, double duration);
inline List<std::tuple<double, double>> _gates(
    const List<Ref<MouthPiece>>& pieces,
    const std::string& viseme,
    int count,
    double step
);
inline List<double> _closed(
    const List<double>& row,
    const std::tuple<double, double>& lips,
    const std::tuple<double, double>& teeth
);
inline void soften(List<double>& out, const List<double>& before, const List<double>& now, const List<double>& after);
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

/// Return rows `[K][15]` of the shapes' weights, which sum to 1; the mouth is shut at both ends. Their times are evenly
/// spaced from 0 to the duration, at least 1 ms.
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
    double begun = 0.0;
    double last = -1.0; // of a run of consonants; where the sound before ended
    for (const auto& piece : pieces) {
        int place = lang::index(words::VISEMES, piece->viseme);
        if (piece->start - last > mouth::PAUSE) {
            begun = piece->start;
        }
        double early = mouth::EARLY;
        if (lang::contains(mouth::ROUNDED, piece->viseme)) {
            early = std::min(std::max(piece->start - begun, mouth::EARLY), mouth::LOOK_AHEAD);
        }
        last = piece->end;
        if (lang::contains(mouth::VOWELS, piece->viseme)) {
            begun = piece->end;
        }
        // Short sounds are not left out: their ramps overlap and still reach the top in the middle.
        double inside = std::min(0.5 * (piece->end - piece->start), 0.04);
        int first = std::max(0, static_cast<int>(std::ceil((piece->start - early) / step)));
        for (int k = first; k < std::min(count, static_cast<int>(std::ceil((piece->end + mouth::LATE) / step))); k++) {
            double rise = mouth::_ease((k * step - piece->start + early) / (early + inside));
            double fall = mouth::_ease((piece->end + mouth::LATE - k * step) / (mouth::LATE + inside));
            double here = std::min(rise, fall);
            lang::at(made, k) += here;
            lang::at(lang::at(rows, k), place) += here * lang::at(mouth::RULE, place) * piece->strength;
            lang::at(lang::at(rows, k), 0) += here * lang::at(mouth::RULE, place) * (1 - piece->strength);
        }
    }
    List<List<std::tuple<double, double>>> shut;
    for (const auto& name : mouth::CLOSURES) {
        shut.push_back(mouth::_gates(pieces, name, count, step));
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
        out.push_back(mouth::_closed(found2, lang::at(lang::at(shut, 0), k), lang::at(lang::at(shut, 1), k)));
    }
    out.push_back(mouth::rest());
    return out;
}

/// Return rows (how far a closure has progressed, how far it suppresses the other one), 0..1.
inline List<std::tuple<double, double>> _gates(
    const List<Ref<MouthPiece>>& pieces,
    const std::string& viseme,
    int count,
    double step
) {
    List<std::tuple<double, double>> out;
    for (int row = 0; row < count; row++) {
        out.push_back(std::tuple<double, double>{0.0, 0.0});
    }
    for (const auto& piece : pieces) {
        if (piece->viseme != viseme) {
            continue;
        }
        double middle = 0.5 * (piece->start + piece->end);
        double held = std::max(mouth::HELD, 0.5 * (piece->end - piece->start) - 0.01);
        int first = std::max(0, static_cast<int>(std::ceil((middle - held - mouth::SHUTTING) / step)));
        for (int k = first; k < std::min(
            count,
            static_cast<int>(std::ceil((middle + held + mouth::SHUTTING) / step))
        ); k++) {
            double away = std::max(0.0, std::abs(k * step - middle) - held);
            double wide = piece->strength * mouth::_ease(1 - away / mouth::SHUTTING);
            double narrow = piece->strength * mouth::_ease(1 - away / mouth::PARTING);
            lang::at(out, k) = std::tuple<double, double>{
                std::max(std::get<0>(lang::at(out, k)), wide),
                std::max(std::get<1>(lang::at(out, k)), narrow)
            };
        }
    }
    return out;
}

/// Return a row with the closures on top: they suppress the rest as far as they are closed.
inline List<double> _closed(
    const List<double>& row,
    const std::tuple<double, double>& lips,
    const std::tuple<double, double>& teeth
) {
    double most = std::max(std::get<0>(lips), std::get<0>(teeth));
    if (most <= 0) {
        return row;
    }
    double one = std::get<0>(lips) * (1 - std::get<1>(teeth));
    double other = std::get<0>(teeth) * (1 - std::get<1>(lips));
    if (one + other <= 0) {
        one = std::get<0>(lips);
        other = std::get<0>(teeth);
    }
    List<double> out;
    for (const auto& weight : row) {
        out.push_back((1 - most) * weight);
    }
    lang::at(out, 1) += most * one / (one + other);
    lang::at(out, 2) += most * other / (one + other);
    return out;
}

/// Write the shapes without silence `[14]`, smoothed over three moments. Shapes that close the mouth keep their present
/// weights, and the others share what is left: smoothing must not part lips that meet.
inline void soften(List<double>& out, const List<double>& before, const List<double>& now, const List<double>& after) {
    for (int n = 0; n < lang::len(out); n++) {
        lang::at(out, n) = 0.25 * lang::at(before, n) + 0.5 * lang::at(now, n) + 0.25 * lang::at(after, n);
    }
    double open_ = 1 - lang::at(out, 0) - lang::at(out, 1);
    lang::at(out, 0) = lang::at(now, 0);
    lang::at(out, 1) = lang::at(now, 1);
    double left = open_ > 1e-09 ? std::max(0.0, 1 - lang::at(out, 0) - lang::at(out, 1)) / open_ : 0.0;
    for (int n = 2; n < lang::len(out); n++) {
        lang::at(out, n) *= std::min(1.0, left);
    }
}

/// Return the weights of a shut mouth.
inline List<double> rest() {
    List<double> found;
    for (int n = 0; n < lang::len(words::VISEMES); n++) {
        found.push_back(n == 0 ? 1.0 : 0.0);
    }
    return found;
}

/// Return the times of stressed syllables: the first peak, then those with no stronger one within `ACCENT` seconds.
/// People blink and gesture on these, not on every syllable.
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
