// How a listener takes up the mood of its partner and laughs along. The result is moods, which posture, face and life
// show like any others.
//
// What is known and followed here: faces take up others' expressions weakly, within about a second of seeing them
// (Dimberg 1982), as far as they are friendly: happy and sad ones, hardly angry ones (Hess and Fischer 2013); laughter
// brings smiles and laughter, often but not always (Provine 1992). How much, how late and how often is ours. Neutral
// moods are not taken up: a character with a mood of its own keeps it in front of a calm face.
//
// Translated from metagraph/playback/life/sympathy.py; change that, and translate anew.
#pragma once

#include "choice.hpp"
#include "mood.hpp"
#include "language.hpp"

namespace metagraph {

struct Laugh;

namespace sympathy {

inline constexpr double DELAY = 0.7; // seconds until a mood is taken up, at least; as much again by chance
inline constexpr double SHORTEST = 0.5; // seconds: what passes sooner is not taken up
inline constexpr double HOSTILE = 0.4; // of how much, for moods that are unpleasant and excited
// Laughing along.
inline constexpr double LAUGH_DELAY = 0.25; // seconds, at least; as much again by chance
inline constexpr double LAUGH_LASTS = 2.6; // seconds, at least
// seconds a smile stays after the other's laugh, at least; as much again by chance
inline constexpr double LAUGH_RINGS = 1.0;
inline constexpr double LAUGH_VALENCE = 0.9;
inline constexpr double LAUGH_AROUSAL = 0.45;
inline Ref<Mood> taken_up(const Ref<Mood>& own, const Ref<Mood>& other, double share);
inline List<Ref<MoodFrom>> moods_taken_up(
    const Ref<Moods>& own,
    const Ref<Moods>& other,
    double end,
    double share,
    std::uint32_t seed,
    const std::string& who
);
inline List<Ref<MoodFrom>> laughs_along(
    const Ref<Moods>& own,
    const List<Ref<Laugh>>& laughs,
    double share,
    std::uint32_t seed,
    const std::string& who
);

}  // namespace sympathy

/// A laugh of the other character, in seconds.
struct Laugh {
    double start;
    double end;

    Laugh(double start_, double end_)
        : start(start_), end(end_) {}
};

namespace sympathy {

/// Return the mood of a character that sees another's: `share`, 0..1, of the way to it; its own mood if the other's is
/// neutral.
inline Ref<Mood> taken_up(const Ref<Mood>& own, const Ref<Mood>& other, double share) {
    if (other->valence == 0 && other->arousal == 0) {
        return own;
    }
    double part = (other->valence < 0 && other->arousal > 0.3) ? share * sympathy::HOSTILE : share;
    return lang::made<Mood>(
        own->valence + part * (other->valence - own->valence),
        own->arousal + part * (other->arousal - own->arousal),
        own->intensity
    );
}

/// Return the moods of a character that sees the other's, from 0 to `end` seconds, by start. own: its mood without the
/// other; who: the key of the other, from which each delay is drawn.
inline List<Ref<MoodFrom>> moods_taken_up(
    const Ref<Moods>& own,
    const Ref<Moods>& other,
    double end,
    double share,
    std::uint32_t seed,
    const std::string& who
) {
    List<double> edges = mood::mood_edges(other, 0.0, end);
    for (const auto& edge : mood::mood_edges(own, 0.0, end)) {
        if (!lang::contains(edges, edge)) {
            edges.push_back(edge);
        }
    }
    edges = lang::in_order(edges);
    List<Ref<MoodFrom>> out;
    for (int n = 0; n < lang::len(edges); n++) {
        const auto& edge = lang::at(edges, n);
        double until = n + 1 < lang::len(edges) ? lang::at(edges, n + 1) : end;
        Ref<Mood> mine = mood::mood_at(own, edge);
        Ref<Mood> mood = sympathy::taken_up(mine, mood::mood_at(other, edge), share);
        if (until - edge < sympathy::SHORTEST || mood->like(mine)) {
            continue;
        }
        double late = edge <= 0
            ? 0.0
            : sympathy::DELAY + sympathy::DELAY * choice::uniform(seed, List<std::string>{who, lang::text(n), "mood"});
        double start = std::min(edge + late, until);
        out.push_back(lang::made<MoodFrom>(
            lang::text(who, " mood ", n),
            start,
            mood->valence,
            mood->arousal,
            std::nullopt,
            until
        ));
    }
    return out;
}

/// Return the moods of a character that laughs along with `share`, 0..1, of the other's laughs, by start.
inline List<Ref<MoodFrom>> laughs_along(
    const Ref<Moods>& own,
    const List<Ref<Laugh>>& laughs,
    double share,
    std::uint32_t seed,
    const std::string& who
) {
    List<Ref<MoodFrom>> out;
    for (int n = 0; n < lang::len(laughs); n++) {
        const auto& laugh = lang::at(laughs, n);
        if (choice::uniform(seed, List<std::string>{who, lang::text(n), "laugh"}) >= share) {
            continue;
        }
        double start = laugh->start + sympathy::LAUGH_DELAY
            + sympathy::LAUGH_DELAY * choice::uniform(seed, List<std::string>{who, lang::text(n), "late"});
        double rings = sympathy::LAUGH_RINGS
            + sympathy::LAUGH_RINGS * choice::uniform(seed, List<std::string>{who, lang::text(n), "rings"});
        Ref<Mood> mine = mood::mood_at(own, start);
        out.push_back(lang::made<MoodFrom>(
            lang::text(who, " laugh ", n),
            start,
            std::max(mine->valence, sympathy::LAUGH_VALENCE),
            std::max(mine->arousal, sympathy::LAUGH_AROUSAL),
            std::nullopt,
            std::max(start + sympathy::LAUGH_LASTS, laugh->end + rings)
        ));
    }
    return out;
}

}  // namespace sympathy

}  // namespace metagraph
