// What was asked of the life layers, as segments in time: which mode the character is in, and what it looks at.
#pragma once

#include "track.hpp"

namespace metagraph {

/// What is looked at from `start` on. since: when the look at it began; its place may have changed meanwhile. asked: not of
/// its own accord.
struct GazeTarget {
    double start = 0.0;
    Spot to;
    double since = 0.0, amount = 1.0;
    bool strict = false, asked = false;

    /// Whether it is the same but for its times.
    bool like(const GazeTarget& b) const {
        return to == b.to && amount == b.amount && strict == b.strict && asked == b.asked;
    }
};

namespace wanted {

inline const std::string PARTNER = "user"; // whom the character talks with, and looks at when nothing else is asked for
inline const std::string AHEAD = "ahead"; // nothing in particular: eyes and head as the layers have them

/// Return start and place among the modes of each mode from `start` to before `end`; the first begins at `start`. Where none
/// is asked for it is talking while something is said and idle otherwise.
inline List<std::pair<double, int>> modes_between(const Track& track, double start, double end) {
    Set<double> edges = {start};
    for (const auto& mode : track.modes()) edges.insert(mode->start);
    for (const auto& speech : track.speeches()) edges.insert({speech->start, speech->end});
    List<std::pair<double, int>> out;
    for (const double edge : edges) {
        if (edge < start || edge >= end) continue;
        const int mode = lang::index(words::MODES, track.told_mode(edge).value_or("idle"));
        if (out.empty() || out.back().second != mode) out.emplace_back(edge, mode);
    }
    return out;
}

/// Return what is looked at from `start` to before `end`; the first begins at `start`. The latest look holds until it ends
/// or another of its importance or more begins; a lesser one waits beneath.
inline List<Ref<const GazeTarget>> targets_between(const Track& track, double start, double end) {
    enum { over, begun, placed, first };
    struct Change {
        double at;
        int kind;
        Ref<const Item> what;
    };
    List<Change> changes;
    for (const auto& look : track.looks()) changes.push_back({look->start, begun, look});
    for (const auto& look : track.looks()) changes.push_back({look->end, over, look});
    for (const auto& place : track.places()) changes.push_back({place->start, placed, place});
    changes.push_back({start, first, nullptr});
    std::stable_sort(changes.begin(), changes.end(), [](const Change& a, const Change& b) {
        return a.at != b.at ? a.at < b.at : a.kind < b.kind;
    });
    Items looks; // the most important first; those beneath are older or lesser
    std::unordered_map<std::string, Vec> places;
    Ref<const Item> chosen;
    double since = 0;
    List<Ref<const GazeTarget>> out;
    for (std::size_t n = 0; n < changes.size(); n++) {
        const auto& [at, kind, what] = changes[n];
        if (at >= end) break;
        if (kind == begun) {
            Items above;
            for (const auto& look : looks) {
                if (look->priority > what->priority) above.push_back(look);
            }
            if (what->end > what->start) above.push_back(what);
            looks = above;
        } else if (kind == over) {
            looks.erase(std::remove(looks.begin(), looks.end(), what), looks.end());
        } else if (kind == placed) {
            places[what->name] = *what->to.point;
        }
        const Ref<const Item> top = looks.empty() ? nullptr : looks.front();
        if (chosen != top) {
            chosen = top;
            since = at;
        }
        if (at < start || (n + 1 < changes.size() && changes[n + 1].at == at)) continue;
        auto target = lang::made<GazeTarget>();
        target->start = at;
        target->since = since;
        target->to = chosen == nullptr ? Spot{PARTNER, {}} : chosen->to;
        const auto place = target->to.point.has_value() ? places.end() : places.find(target->to.name);
        if (place != places.end()) target->to = {"", place->second};
        if (chosen != nullptr) {
            target->amount = chosen->amount;
            target->strict = chosen->strict;
            target->asked = true;
        }
        if (out.empty() || !target->like(*out.back())) out.push_back(target);
    }
    return out;
}

}  // namespace wanted

/// Where a target is, metres; nothing for what is nowhere: ahead.
inline std::optional<Vec> place_of(const GazeTarget& target, const Map<std::string, Vec>& points, const Vec& partner) {
    if (target.to.point.has_value()) return target.to.point;
    if (target.to.name == wanted::AHEAD) return std::nullopt;
    const Vec* known = points.find(target.to.name);
    if (known != nullptr) return *known;
    return target.to.name == wanted::PARTNER ? std::optional<Vec>(partner) : std::nullopt;
}

}  // namespace metagraph
