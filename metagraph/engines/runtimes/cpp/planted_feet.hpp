// Find where the feet of a standing body should be while the body's layer blends. They do not glide from one pose to
// the other: they are held, and move one after the other in a step.
//
// A clip gives the positions of its feet, and when they stand. A pose depends only on plan and time, so each step's
// time, order and height follow from the two poses that it joins.
//
// Translated from metagraph/playback/posing/planted_feet.py; change that, and translate anew.
#pragma once

#include "feet_solve.hpp"
#include "plain_vectors.hpp"
#include "meta_plan.hpp"
#include "cue_times.hpp"
#include "project.hpp"
#include "language.hpp"

namespace metagraph {

struct FootTrack;

namespace planted_feet {

inline constexpr double FOOT_RATE = 10.0; // rows of a track in a second of its clip
inline constexpr double FOOT_UNIT = 1e-05; // the value of 1 in a row
inline constexpr int FOOT_NUMBERS = 8; // in a row, for each foot
inline constexpr double STEPPING = 0.5; // seconds that two steps take if a cue leaves them time
inline constexpr double LEAST_PART = 0.15; // of that time for the foot with the shorter way
inline constexpr double NEARBY = 0.015; // metres: feet with a shorter way move together, slowly
inline constexpr double WAITS = 0.12; // of a step's time: the foot is lifted before it moves and lowered after it
inline constexpr double LIFT = 0.25; // how high a foot is lifted for a short step, as a share of its way
inline constexpr double MOST_LIFT = 0.08; // metres: the limit that no foot reaches
inline constexpr double FAR = 0.25; // of the height: no foot steps that much farther
inline constexpr double TOO_FAR = 0.1;
inline constexpr double QUICK = 0.65; // of the height, a second: above, feet step less and glide more
inline constexpr double TOO_QUICK = 0.2; // as much quicker, they only glide
inline List<Ref<FootGoal>> foot_goals(
    const Ref<Project>& project,
    const Map<std::string, Ref<FootTrack>>& tracks,
    double height,
    const Ref<LayerPlan>& plan,
    const Ref<Cue>& cue,
    int place,
    double time
);
inline double _entering(const Ref<FootTrack>& track, const Ref<Cue>& cue);
inline double _leaving(const Ref<FootTrack>& track, const Ref<Cue>& cue);
inline double _lasting(const Ref<FootTrack>& track, const Ref<Cue>& cue, double blend, double edge, double way);
inline bool _stands(const Ref<FootTrack>& track, double seconds);
inline List<Ref<FootGoal>> stepped(
    double height,
    const List<Ref<FootGoal>>& before,
    const List<Ref<FootGoal>>& after,
    const List<Ref<FootGoal>>& first,
    const List<Ref<FootGoal>>& last,
    double passed,
    double seconds
);
inline Ref<FootGoal> _mixed(const Ref<FootGoal>& a, const Ref<FootGoal>& b, double x, double air, double share);
inline int _resting(const Ref<LayerPlan>& plan, int place, double time);
inline bool _fades(const Ref<LayerPlan>& plan, int place, double time);
inline bool _changes(const Ref<Project>& project, const Ref<LayerPlan>& plan, int place, double time);
inline List<Ref<FootGoal>> _stance(
    const Ref<Project>& project,
    const Map<std::string, Ref<FootTrack>>& tracks,
    double height,
    const Ref<LayerPlan>& plan,
    int place,
    double time
);
inline List<Ref<FootGoal>> _loop(
    const Ref<Project>& project,
    const Map<std::string, Ref<FootTrack>>& tracks,
    double height,
    const Ref<Rest>& rest,
    double time
);
inline List<Ref<FootGoal>> foot_row(const Ref<FootTrack>& track, double seconds);

}  // namespace planted_feet

/// Where a clip's feet are.
///
/// `rows` has a row for each tenth of a second, with the left foot and then the right: whether it stands (0 to 1), its
/// joint's position and rotation in the character's space; in units of `FOOT_UNIT`.
struct FootTrack {
    List<List<double>> rows;

    explicit FootTrack(List<List<double>> rows_)
        : rows(std::move(rows_)) {}
};

namespace planted_feet {

/// Return where both feet should be at a time; an empty list if nothing blends or it is unknown.
///
/// `tracks` are by action. `height` is the figure's. `plan` is the body's layer. `cue` is the one that plays, if it has
/// motion, and `place` the index of the rest in force, -1 for none.
inline List<Ref<FootGoal>> foot_goals(
    const Ref<Project>& project,
    const Map<std::string, Ref<FootTrack>>& tracks,
    double height,
    const Ref<LayerPlan>& plan,
    const Ref<Cue>& cue,
    int place,
    double time
) {
    if (place < 0) {
        return List<Ref<FootGoal>>{};
    }
    if (cue == nullptr) {
        if (!planted_feet::_changes(project, plan, place, time)) {
            return List<Ref<FootGoal>>{};
        }
        return planted_feet::_stance(project, tracks, height, plan, place, time);
    }
    Ref<FootTrack> track = lang::get(tracks, cue->action->id);
    bool masked = lang::len(cue->action->joints) > 0 || lang::len(cue->action->joint_weights) > 0;
    if (track == nullptr || lang::len(track->rows) == 0 || masked) {
        return List<Ref<FootGoal>>{};
    }
    double came = cue->start + planted_feet::_entering(track, cue);
    double goes = cue->end - planted_feet::_leaving(track, cue);
    if (time >= came && time < goes) {
        return List<Ref<FootGoal>>{};
    }
    List<Ref<FootGoal>> here = planted_feet::foot_row(track, cue_times::cue_seconds(cue, time));
    double at{};
    List<Ref<FootGoal>> first{};
    List<Ref<FootGoal>> last{};
    if (time < came) {
        at = std::min(time, cue->start + cue->blend_in);
        List<Ref<FootGoal>> before = planted_feet::_stance(project, tracks, height, plan, place, at);
        first = planted_feet::_stance(project, tracks, height, plan, place, cue->start);
        last = planted_feet::foot_row(track, cue_times::cue_seconds(cue, came));
        return planted_feet::stepped(height, before, here, first, last, time - cue->start, came - cue->start);
    }
    at = std::max(time, cue->end - cue->blend_out);
    List<Ref<FootGoal>> after = planted_feet::_stance(project, tracks, height, plan, place, at);
    first = planted_feet::foot_row(track, cue_times::cue_seconds(cue, goes));
    last = planted_feet::_stance(project, tracks, height, plan, place, cue->end);
    return planted_feet::stepped(height, here, after, first, last, time - goes, cue->end - goes);
}

/// Return how long the feet take to enter a cue: its blend, and longer while it stands.
inline double _entering(const Ref<FootTrack>& track, const Ref<Cue>& cue) {
    return planted_feet::_lasting(track, cue, cue->blend_in, cue->start, 1.0);
}

/// Return how long the feet take to leave a cue.
inline double _leaving(const Ref<FootTrack>& track, const Ref<Cue>& cue) {
    return planted_feet::_lasting(track, cue, cue->blend_out, cue->end, -1.0);
}

inline double _lasting(const Ref<FootTrack>& track, const Ref<Cue>& cue, double blend, double edge, double way) {
    if (blend <= 0.0) {
        return 0.0;
    }
    double spare = std::max(0.0, cue->end - cue->start - cue->blend_in - cue->blend_out);
    double most = std::min(planted_feet::STEPPING, blend + 0.5 * spare);
    double out = blend;
    double step = 1.0 / planted_feet::FOOT_RATE;
    while (out < most
        && planted_feet::_stands(track, cue_times::cue_seconds(cue, edge + way * std::min(out + step, most)))) {
        out = std::min(out + step, most);
    }
    return out;
}

inline bool _stands(const Ref<FootTrack>& track, double seconds) {
    List<Ref<FootGoal>> goals = planted_feet::foot_row(track, seconds);
    return lang::at(goals, 0)->planted >= 1.0 && lang::at(goals, 1)->planted >= 1.0;
}

/// Return both feet during a step, after `passed` of its `seconds`. `first` and `last` are their places when it begins
/// and ends, which decide the order and size of the steps.
inline List<Ref<FootGoal>> stepped(
    double height,
    const List<Ref<FootGoal>>& before,
    const List<Ref<FootGoal>>& after,
    const List<Ref<FootGoal>>& first,
    const List<Ref<FootGoal>>& last,
    double passed,
    double seconds
) {
    if (lang::len(before) == 0 || lang::len(after) == 0 || lang::len(first) == 0 || lang::len(last) == 0) {
        return List<Ref<FootGoal>>{};
    }
    List<double> ways;
    for (int side = 0; side < 2; side++) { // a foot that does not stand before or after needs no time for a step
        double stands = lang::at(first, side)->planted * lang::at(last, side)->planted;
        ways.push_back(stands * feet_solve::foot_way(lang::at(first, side), lang::at(last, side)));
    }
    double part = 0.5;
    if (lang::at(ways, 0) + lang::at(ways, 1) > 0.0) {
        part = std::min(
            std::max(lang::at(ways, 0) / (lang::at(ways, 0) + lang::at(ways, 1)), planted_feet::LEAST_PART),
            1.0 - planted_feet::LEAST_PART
        );
    }
    // To the left, the left foot goes first: the right foot would have to pass it.
    std::tuple<double, double, double> moved = plain_vectors::plus(
        plain_vectors::minus(lang::at(last, 0)->at, lang::at(first, 0)->at),
        plain_vectors::minus(lang::at(last, 1)->at, lang::at(first, 1)->at)
    );
    bool left_first = plain_vectors::dot(moved, plain_vectors::minus(lang::at(first, 0)->at, lang::at(first, 1)->at))
        >= -1e-09;
    double longer = std::max(lang::at(ways, 0), lang::at(ways, 1));
    double far = 1.0 - cue_times::ease((longer / height - planted_feet::FAR) / planted_feet::TOO_FAR);
    double apart = cue_times::ease(longer / planted_feet::NEARBY);
    List<double> shares = List<double>{1.0 - apart * (1.0 - part), 1.0 - apart * part};
    double quickest = std::max(lang::at(ways, 0) / lang::at(shares, 0), lang::at(ways, 1) / lang::at(shares, 1));
    far *= 1.0
        - cue_times::ease(
            (quickest / (height * std::max(seconds, 0.001)) - planted_feet::QUICK) / planted_feet::TOO_QUICK
        );
    double u = seconds > 0.0 ? passed / seconds : 1.0;
    List<Ref<FootGoal>> out;
    for (int side = 0; side < 2; side++) {
        double share = lang::at(shares, side);
        double begin = left_first == (side == 0) ? 0.0 : 1.0 - share;
        double x = std::min(std::max((u - begin) / share, 0.0), 1.0);
        double go = cue_times::ease((x - planted_feet::WAITS) / (1.0 - 2.0 * planted_feet::WAITS));
        double rise = planted_feet::LIFT * lang::at(ways, side);
        double air = 16.0 * x * x * (1.0 - x) * (1.0 - x) * rise / (1.0 + rise / planted_feet::MOST_LIFT);
        out.push_back(planted_feet::_mixed(lang::at(before, side), lang::at(after, side), go, air, far));
    }
    return out;
}

/// Return a foot between two places.
inline Ref<FootGoal> _mixed(const Ref<FootGoal>& a, const Ref<FootGoal>& b, double x, double air, double share) {
    auto [ax, ay, az, aw] = a->turn;
    auto [bx, by, bz, bw] = b->turn;
    double k = ax * bx + ay * by + az * bz + aw * bw < 0.0 ? -x : x;
    double rest = 1.0 - x;
    std::tuple<double, double, double, double> turn = plain_vectors::unit_turn(
        std::tuple<double, double, double, double>{
            ax * rest + bx * k,
            ay * rest + by * k,
            az * rest + bz * k,
            aw * rest + bw * k
        }
    );
    std::tuple<double, double, double> at = plain_vectors::plus(
        a->at,
        plain_vectors::scaled(plain_vectors::minus(b->at, a->at), x)
    );
    return lang::made<FootGoal>(at, turn, share * a->planted * b->planted, a->lift * rest + b->lift * x + air);
}

/// Return the index of the rest in force at a time, searching from another.
inline int _resting(const Ref<LayerPlan>& plan, int place, double time) {
    while (place > 0 && lang::at(plan->rests, place)->fade_start > time) {
        place -= 1;
    }
    while (place + 1 < lang::len(plan->rests) && lang::at(plan->rests, place + 1)->fade_start <= time) {
        place += 1;
    }
    return place;
}

inline bool _fades(const Ref<LayerPlan>& plan, int place, double time) {
    Ref<Rest> rest = lang::at(plan->rests, place);
    return place > 0 && rest->fade_start + rest->fade > time;
}

/// Return whether a stance blends: between two rests, or at a loop's seam.
inline bool _changes(const Ref<Project>& project, const Ref<LayerPlan>& plan, int place, double time) {
    Ref<Rest> rest = lang::at(plan->rests, place);
    if (planted_feet::_fades(plan, place, time)) {
        return true;
    }
    return cue_times::loop_spot(project, rest, time)->over < 1.0;
}

/// Return where the feet of the stance under the cues are at a time.
inline List<Ref<FootGoal>> _stance(
    const Ref<Project>& project,
    const Map<std::string, Ref<FootTrack>>& tracks,
    double height,
    const Ref<LayerPlan>& plan,
    int place,
    double time
) {
    place = planted_feet::_resting(plan, place, time);
    Ref<Rest> rest = lang::at(plan->rests, place);
    List<Ref<FootGoal>> goals = planted_feet::_loop(project, tracks, height, rest, time);
    if (!planted_feet::_fades(plan, place, time)) {
        return goals;
    }
    Ref<Rest> old = lang::at(plan->rests, place - 1);
    double ends = rest->fade_start + rest->fade;
    return planted_feet::stepped(
        height,
        planted_feet::_loop(project, tracks, height, old, time),
        goals,
        planted_feet::_loop(project, tracks, height, old, rest->fade_start),
        planted_feet::_loop(project, tracks, height, rest, ends),
        time - rest->fade_start,
        rest->fade
    );
}

/// Return where the feet of a loop are. They also go from its end to its beginning in steps.
inline List<Ref<FootGoal>> _loop(
    const Ref<Project>& project,
    const Map<std::string, Ref<FootTrack>>& tracks,
    double height,
    const Ref<Rest>& rest,
    double time
) {
    Ref<FootTrack> track = lang::get(tracks, rest->action->id);
    if (track == nullptr || lang::len(track->rows) == 0) {
        return List<Ref<FootGoal>>{};
    }
    Ref<LoopSpot> spot = cue_times::loop_spot(project, rest, time);
    List<Ref<FootGoal>> here = planted_feet::foot_row(track, spot->seconds);
    if (spot->over >= 1.0) {
        return here;
    }
    double seam = spot->meets - std::get<0>(project->span(rest->action));
    List<Ref<FootGoal>> before = planted_feet::foot_row(track, spot->other);
    List<Ref<FootGoal>> leaves = planted_feet::foot_row(track, spot->leaves);
    List<Ref<FootGoal>> meets = planted_feet::foot_row(track, spot->meets);
    return planted_feet::stepped(height, before, here, leaves, meets, spot->over * seam, seam);
}

/// Return where a clip's feet are at a second of the clip, interpolated linearly.
inline List<Ref<FootGoal>> foot_row(const Ref<FootTrack>& track, double seconds) {
    int last = lang::len(track->rows) - 1;
    double at = std::min(std::max(seconds * planted_feet::FOOT_RATE, 0.0), static_cast<double>(last));
    int low = std::min(static_cast<int>(std::floor(at)), std::max(0, last - 1));
    double part = at - low;
    List<double> a = lang::at(track->rows, low);
    List<double> b = lang::at(track->rows, std::min(low + 1, last));
    List<double> v;
    for (int n2 = 0; n2 < 2 * planted_feet::FOOT_NUMBERS; n2++) {
        v.push_back(planted_feet::FOOT_UNIT * (lang::at(a, n2) + (lang::at(b, n2) - lang::at(a, n2)) * part));
    }
    List<Ref<FootGoal>> out;
    for (int side = 0; side < 2; side++) {
        int n = planted_feet::FOOT_NUMBERS * side;
        std::tuple<double, double, double, double> turn = plain_vectors::unit_turn(
            std::tuple<double, double, double, double>{
                lang::at(v, n + 4),
                lang::at(v, n + 5),
                lang::at(v, n + 6),
                lang::at(v, n + 7)
            }
        );
        out.push_back(lang::made<FootGoal>(
            std::tuple<double, double, double>{lang::at(v, n + 1), lang::at(v, n + 2), lang::at(v, n + 3)},
            turn,
            lang::at(v, n),
            0.0
        ));
    }
    return out;
}

}  // namespace planted_feet

}  // namespace metagraph
