// Requests of the life layers as segments in time: the mode of the character, and what it looks at.
//
// Translated from metagraph/playback/life/wanted.py; change that, and translate anew.
#pragma once

#include "life.hpp"
#include "words.hpp"
#include "items.hpp"
#include "spots.hpp"
#include "track.hpp"
#include "mood.hpp"
#include "life.hpp"
#include "spots.hpp"
#include "language.hpp"

namespace metagraph {

struct GazeTarget;

namespace wanted {

// whom the character talks with, and looks at when nothing else is asked for
inline const std::string PARTNER = "user";
inline const std::string AHEAD = "ahead"; // nothing in particular: eyes and head as the layers have them
// What changes what is looked at; of one time in this order.
inline constexpr int OVER = 0;
inline constexpr int LOOK = 1;
inline constexpr int PLACE = 2;
inline constexpr int BEGIN = 3;
inline std::string mode_at(const Ref<Track>& track, double seconds);
inline List<std::tuple<double, int>> modes_between(const Ref<Track>& track, double start, double end);
inline Ref<Moods> moods_of(const Ref<Life>& life, const Ref<Track>& track);
inline List<std::tuple<double, Ref<Mood>>> moods_between(const Ref<Moods>& moods, double start, double end);
inline Ref<Manner> ways_in(const Ref<Manner>& ways, const Ref<Mood>& mood);
inline List<Ref<GazeTarget>> targets_between(const Ref<Track>& track, double start, double end);
inline Ref<GazeTarget> _target(
    double at,
    double since,
    const Ref<LookAt>& look,
    const Map<std::string, List<double>>& places
);

}  // namespace wanted

/// The target of the gaze from `start` on: a point, or a name whose place the project knows. since: when the look at it
/// began; its place may have changed meanwhile. asked: whether a request set it.
struct GazeTarget {
    double start;
    Ref<Spot> to;
    double since;
    double amount;
    bool strict;
    bool asked;

    GazeTarget(
        double start_,
        Ref<Spot> to_,
        double since_ = 0.0,
        double amount_ = 1.0,
        bool strict_ = false,
        bool asked_ = false
    )
        : start(start_), to(std::move(to_)), since(since_), amount(amount_), strict(strict_), asked(asked_) {}

    /// Return whether it is the same apart from its times.
    bool like(const Ref<GazeTarget>& other) const;
};

inline bool GazeTarget::like(const Ref<GazeTarget>& other) const {
    if (this->amount != other->amount || this->strict != other->strict || this->asked != other->asked) {
        return false;
    }
    return spots::is_same_spot(this->to, other->to);
}

namespace wanted {

/// Return the requested mode; without one, talking while something is said and idle otherwise.
inline std::string mode_at(const Ref<Track>& track, double seconds) {
    std::optional<std::string> told = track->told_mode(seconds);
    return !told.has_value() ? std::string("idle") : *told;
}

/// Return (start, place among MODES) of each mode from `start` to before `end`; the first begins at `start`.
inline List<std::tuple<double, int>> modes_between(const Ref<Track>& track, double start, double end) {
    List<double> edges = List<double>{start};
    List<double> found;
    for (const auto& m : track->modes) {
        found.push_back(m->start);
    }
    lang::extend(edges, found);
    List<double> found2;
    for (const auto& s : track->speeches) {
        found2.push_back(s->start);
    }
    lang::extend(edges, found2);
    List<double> found3;
    for (const auto& s : track->speeches) {
        found3.push_back(s->end);
    }
    lang::extend(edges, found3);
    List<std::tuple<double, int>> out;
    int last = -1;
    List<double> found4;
    for (const auto& e : edges) {
        if (start <= e && e < end) {
            found4.push_back(e);
        }
    }
    for (const auto& edge : lang::in_order(found4)) {
        int mode = lang::index(words::MODES, wanted::mode_at(track, edge));
        if (mode != last) {
            out.push_back(std::tuple<double, int>{edge, mode});
        }
        last = mode;
    }
    return out;
}

/// Return the moods of a character: the one set in its life layers, and those requested over time.
inline Ref<Moods> moods_of(const Ref<Life>& life, const Ref<Track>& track) {
    return lang::made<Moods>(lang::made<Mood>(life->valence, life->arousal, life->intensity), track->moods);
}

/// Return (start, mood) of each mood from `start` to before `end`; the first begins at `start`.
inline List<std::tuple<double, Ref<Mood>>> moods_between(const Ref<Moods>& moods, double start, double end) {
    List<std::tuple<double, Ref<Mood>>> out;
    for (const auto& edge : mood::mood_edges(moods, start, end)) {
        Ref<Mood> mood = mood::mood_at(moods, edge);
        if (lang::len(out) == 0 || !mood->like(std::get<1>(lang::at(out, -1)))) {
            out.push_back(std::tuple<double, Ref<Mood>>{edge, mood});
        }
    }
    return out;
}

/// Return the factors of the amounts for a mode and a mood.
inline Ref<Manner> ways_in(const Ref<Manner>& ways, const Ref<Mood>& mood) {
    if (mood->neutral()) {
        return ways;
    }
    Ref<LifeMood> of = mood::life_of(mood);
    return life::scaled(ways, of->breathing, of->breath_rate, of->aversion_rate, of->saccade_rate, of->blinks);
}

/// Return the targets of the gaze from `start` to before `end`; the first begins at `start`.
///
/// The latest look holds until it ends or another of at least the same importance begins; a less important one waits.
inline List<Ref<GazeTarget>> targets_between(const Ref<Track>& track, double start, double end) {
    List<std::tuple<double, int, int>> changes;
    for (int n2 = 0; n2 < lang::len(track->looks); n2++) {
        const auto& x = lang::at(track->looks, n2);
        changes.push_back(std::tuple<double, int, int>{x->start, wanted::LOOK, n2});
    }
    List<std::tuple<double, int, int>> found;
    for (int n3 = 0; n3 < lang::len(track->looks); n3++) {
        const auto& x = lang::at(track->looks, n3);
        found.push_back(std::tuple<double, int, int>{x->end, wanted::OVER, n3});
    }
    lang::extend(changes, found);
    List<std::tuple<double, int, int>> found2;
    for (int n4 = 0; n4 < lang::len(track->places); n4++) {
        const auto& p = lang::at(track->places, n4);
        if (p->start >= start) {
            found2.push_back(std::tuple<double, int, int>{p->start, wanted::PLACE, n4});
        }
    }
    lang::extend(changes, found2);
    changes.push_back(std::tuple<double, int, int>{start, wanted::BEGIN, 0});
    List<std::tuple<double, int>> keys;
    for (const auto& c : changes) {
        keys.push_back(std::tuple<double, int>{std::get<0>(c), std::get<1>(c)});
    }
    changes = lang::ordered(changes, keys);
    List<int> looks; // indices of looks, the most important first; the others are older or less important
    Map<std::string, List<double>> places;
    for (const auto& place : track->places) { // a point that is sent again and again has thousands
        if (place->start < start) {
            places[place->name] = place->point;
        }
    }
    int chosen = -1;
    double since = 0.0;
    List<Ref<GazeTarget>> out;
    for (int n = 0; n < lang::len(changes); n++) {
        auto [at, kind, which] = lang::at(changes, n);
        if (at >= end) {
            break;
        }
        if (kind == wanted::LOOK) {
            Ref<LookAt> look = lang::at(track->looks, which);
            List<int> found3;
            for (const auto& x : looks) {
                if (lang::at(track->looks, x)->priority > look->priority) {
                    found3.push_back(x);
                }
            }
            looks = found3;
            if (look->end > look->start) {
                looks.push_back(which);
            }
        } else if (kind == wanted::OVER) {
            List<int> found4;
            for (const auto& x : looks) {
                if (x != which) {
                    found4.push_back(x);
                }
            }
            looks = found4;
        } else if (kind == wanted::PLACE) {
            places[lang::at(track->places, which)->name] = lang::at(track->places, which)->point;
        }
        int first = lang::len(looks) > 0 ? lang::at(looks, 0) : -1;
        if (chosen != first) {
            chosen = first;
            since = at;
        }
        if (at < start || (n + 1 < lang::len(changes) && std::get<0>(lang::at(changes, n + 1)) == at)) {
            continue;
        }
        Ref<GazeTarget> target = wanted::_target(
            at,
            since,
            chosen < 0 ? nullptr : lang::at(track->looks, chosen),
            places
        );
        if (lang::len(out) == 0 || !target->like(lang::at(out, -1))) {
            out.push_back(target);
        }
    }
    return out;
}

inline Ref<GazeTarget> _target(
    double at,
    double since,
    const Ref<LookAt>& look,
    const Map<std::string, List<double>>& places
) {
    if (look == nullptr) {
        return lang::made<GazeTarget>(at, spots::placed(places, spots::named(wanted::PARTNER)), since);
    }
    return lang::made<GazeTarget>(at, spots::placed(places, look->to), since, look->amount, look->strict, true);
}

}  // namespace wanted

}  // namespace metagraph
