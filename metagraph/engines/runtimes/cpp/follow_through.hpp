// Compute how far the arms of a plan have moved their mass away from its stance at a time.
//
// The body reacts with a delay. So it does not follow the arms at one moment, but a cubic B-spline through their places
// at four earlier fixed times. This is smooth, and depends only on plan and time.
//
// Translated from metagraph/playback/posing/follow_through.py; change that, and translate anew.
#pragma once

#include "model.hpp"
#include "meta_plan.hpp"
#include "cue_times.hpp"
#include "project.hpp"
#include "language.hpp"

namespace metagraph {

struct ArmTrack;

namespace follow_through {

inline constexpr double STEP = 0.08; // seconds between the sampled times; the answer comes two of them late
// seconds by which they are shifted from whole steps, where cues begin and end
inline constexpr double OFFSET = 0.0111;
inline constexpr int KNOTS = 4;
inline constexpr double RATE = 10.0; // rows of a track in a second of its clip
inline constexpr double UNIT = 1e-05; // metres, or radians, of 1 in a row
inline constexpr int NUMBERS = 8; // in a row
inline int knot_before(double time);
inline double knot_time(int number);
inline List<double> arm_sway(
    const Ref<Project>& project,
    const Map<std::string, Ref<ArmTrack>>& tracks,
    const List<std::string>& hands,
    const Ref<LayerPlan>& arms,
    const Ref<Cue>& cue,
    int place,
    const Ref<LayerPlan>& body,
    const Ref<Cue>& body_cue,
    int body_place,
    double time
);
inline List<double> driven(const List<List<double>>& sways, double time);
inline bool _moves(const Ref<Action>& action, const std::string& side, const std::string& hand);
inline double _shown(
    const Map<std::string, Ref<ArmTrack>>& tracks,
    const Ref<LayerPlan>& plan,
    const Ref<Cue>& cue,
    int place,
    const std::string& clip,
    double time
);
inline bool _is_of(const Map<std::string, Ref<ArmTrack>>& tracks, const Ref<Action>& action, const std::string& clip);
inline List<double> _stance(
    const Ref<Project>& project,
    const Map<std::string, Ref<ArmTrack>>& tracks,
    const Ref<LayerPlan>& plan,
    int place,
    double time
);
inline List<double> _loop(
    const Ref<Project>& project,
    const Map<std::string, Ref<ArmTrack>>& tracks,
    const Ref<Rest>& rest,
    double time
);
inline List<double> _row(const Ref<ArmTrack>& track, double seconds);

}  // namespace follow_through

/// How the arms of a clip move their mass.
///
/// `clip` is its id. `rows` has a row for each tenth of a second, relative to the base pose: how far the left arm
/// shifts the centre of mass of the whole body to the left, up and ahead, the same for the right arm, and how far each
/// collar bone lags behind its arm; in units of `UNIT`.
struct ArmTrack {
    std::string clip;
    List<List<double>> rows;

    ArmTrack(std::string clip_, List<List<double>> rows_)
        : clip(std::move(clip_)), rows(std::move(rows_)) {}
};

namespace follow_through {

/// Return the number of the last sampled time for a pose at `time`.
inline int knot_before(double time) {
    return static_cast<int>(std::floor((time - follow_through::OFFSET) / follow_through::STEP));
}

/// Return the time of a sample, in seconds.
inline double knot_time(int number) {
    return number * follow_through::STEP + follow_through::OFFSET;
}

/// Return how far the arms are from their stance at a time, as a row of a track, in metres and radians.
///
/// `tracks` are by action. `hands` names the joints of the hands. `cue` is that of the arms' layer, if it has motion,
/// and `place` the index of the rest in force, -1 for none; `body_cue` and `body_place` are the same for the body's
/// layer. A cue whose clip the body's layer also shows moves the hips itself and does not count.
inline List<double> arm_sway(
    const Ref<Project>& project,
    const Map<std::string, Ref<ArmTrack>>& tracks,
    const List<std::string>& hands,
    const Ref<LayerPlan>& arms,
    const Ref<Cue>& cue,
    int place,
    const Ref<LayerPlan>& body,
    const Ref<Cue>& body_cue,
    int body_place,
    double time
) {
    List<double> out;
    for (int n2 = 0; n2 < follow_through::NUMBERS; n2++) {
        out.push_back(0.0);
    }
    if (cue == nullptr) {
        return out;
    }
    Ref<ArmTrack> track = lang::get(tracks, cue->action->id);
    if (track == nullptr || lang::len(track->rows) == 0) {
        return out;
    }
    double weight = cue_times::cue_weight(cue, time);
    double share = cue->extent * (1.0 - follow_through::_shown(tracks, body, body_cue, body_place, track->clip, time));
    if (weight <= 0.0 || share <= 0.0) {
        return out;
    }
    List<double> row = follow_through::_row(track, cue_times::cue_seconds(cue, time));
    List<double> rest = follow_through::_stance(project, tracks, arms, place, time);
    bool entering = time < cue->start + cue->blend_in;
    if (cue->repeats()) {
        double back = cue_times::seam_left(cue, time);
        List<double> ends = follow_through::_row(track, cue->cycle_to);
        List<double> begins = follow_through::_row(track, cue->cycle_from);
        List<double> found;
        for (int n3 = 0; n3 < follow_through::NUMBERS; n3++) {
            found.push_back(lang::at(row, n3) + back * (lang::at(ends, n3) - lang::at(begins, n3)));
        }
        row = found;
        List<double> found2;
        for (int n4 = 0; n4 < follow_through::NUMBERS; n4++) {
            found2.push_back(lang::at(rest, n4) + weight * (lang::at(row, n4) - lang::at(rest, n4)));
        }
        row = found2;
    } else if (entering || time >= cue->end - cue->blend_out) {
        List<double> edge = follow_through::_row(track, entering ? cue->entry : cue_times::cue_seconds(cue, cue->end));
        List<double> found3;
        for (int n5 = 0; n5 < follow_through::NUMBERS; n5++) {
            found3.push_back(lang::at(row, n5) + (1.0 - weight) * (lang::at(rest, n5) - lang::at(edge, n5)));
        }
        row = found3;
    }
    double left = follow_through::_moves(cue->action, "left", lang::at(hands, 0)) ? share * follow_through::UNIT : 0.0;
    double right = follow_through::_moves(cue->action, "right", lang::at(hands, 1))
        ? share * follow_through::UNIT
        : 0.0;
    for (int n = 0; n < follow_through::NUMBERS; n++) {
        lang::at(out, n) = (lang::at(row, n) - lang::at(rest, n)) * ((n < 3 || n == 6) ? left : right);
    }
    return out;
}

/// Return the eight numbers that move the body at a time, and their change per second. `sways` has the rows of the last
/// `KNOTS` times before it.
inline List<double> driven(const List<List<double>>& sways, double time) {
    double u = (time - follow_through::OFFSET) / follow_through::STEP;
    u = u - static_cast<int>(std::floor(u));
    double back = 1.0 - u;
    List<double> weights = List<double>{
        back * back * back / 6.0,
        (3.0 * u * u * u - 6.0 * u * u + 4.0) / 6.0,
        (3.0 * u + 3.0 * u * u - 3.0 * u * u * u + 1.0) / 6.0,
        u * u * u / 6.0
    };
    List<double> slopes = List<double>{
        -back * back / 2.0,
        (3.0 * u * u - 4.0 * u) / 2.0,
        (1.0 + 2.0 * u - 3.0 * u * u) / 2.0,
        u * u / 2.0
    };
    List<double> out;
    for (int n2 = 0; n2 < 2 * follow_through::NUMBERS; n2++) {
        out.push_back(0.0);
    }
    for (int n = 0; n < follow_through::NUMBERS; n++) {
        for (int k = 0; k < follow_through::KNOTS; k++) {
            lang::at(out, n) += lang::at(weights, k) * lang::at(lang::at(sways, k), n);
            lang::at(out, follow_through::NUMBERS + n) += lang::at(slopes, k) * lang::at(lang::at(sways, k), n)
                / follow_through::STEP;
        }
    }
    return out;
}

/// Return whether an action moves an arm, instead of leaving it in the stance.
inline bool _moves(const Ref<Action>& action, const std::string& side, const std::string& hand) {
    if (!lang::contains(List<std::string>{"both", side}, action->limb)) {
        return false;
    }
    return lang::len(action->joints) == 0 || lang::contains(action->joints, hand);
}

/// Return how much a layer shows of a clip, 0..1.
inline double _shown(
    const Map<std::string, Ref<ArmTrack>>& tracks,
    const Ref<LayerPlan>& plan,
    const Ref<Cue>& cue,
    int place,
    const std::string& clip,
    double time
) {
    double left = 1.0;
    double out = 0.0;
    if (cue != nullptr) {
        double weight = cue_times::cue_weight(cue, time);
        left = 1.0 - weight;
        if (follow_through::_is_of(tracks, cue->action, clip)) {
            out += weight;
        }
    }
    if (place >= 0) {
        Ref<Rest> rest = lang::at(plan->rests, place);
        double over = 1.0;
        if (place > 0 && rest->fade_start + rest->fade > time) {
            over = cue_times::ease((time - rest->fade_start) / rest->fade);
            if (follow_through::_is_of(tracks, lang::at(plan->rests, place - 1)->action, clip)) {
                out += left * (1.0 - over);
            }
        }
        if (follow_through::_is_of(tracks, rest->action, clip)) {
            out += left * over;
        }
    }
    return std::min(1.0, out);
}

inline bool _is_of(const Map<std::string, Ref<ArmTrack>>& tracks, const Ref<Action>& action, const std::string& clip) {
    Ref<ArmTrack> track = lang::get(tracks, action->id);
    return track != nullptr && track->clip == clip;
}

/// Return the row of the stance under the cues.
inline List<double> _stance(
    const Ref<Project>& project,
    const Map<std::string, Ref<ArmTrack>>& tracks,
    const Ref<LayerPlan>& plan,
    int place,
    double time
) {
    if (place < 0) {
        List<double> found;
        for (int n = 0; n < follow_through::NUMBERS; n++) {
            found.push_back(0.0);
        }
        return found;
    }
    Ref<Rest> rest = lang::at(plan->rests, place);
    List<double> row = follow_through::_loop(project, tracks, rest, time);
    if (place > 0 && rest->fade_start + rest->fade > time) {
        double over = cue_times::ease((time - rest->fade_start) / rest->fade);
        List<double> before = follow_through::_loop(project, tracks, lang::at(plan->rests, place - 1), time);
        List<double> found2;
        for (int n = 0; n < follow_through::NUMBERS; n++) {
            found2.push_back(lang::at(before, n) + (lang::at(row, n) - lang::at(before, n)) * over);
        }
        row = found2;
    }
    return row;
}

/// Return the row of a loop, with its end blended into its beginning.
inline List<double> _loop(
    const Ref<Project>& project,
    const Map<std::string, Ref<ArmTrack>>& tracks,
    const Ref<Rest>& rest,
    double time
) {
    Ref<ArmTrack> track = lang::get(tracks, rest->action->id);
    if (track == nullptr || lang::len(track->rows) == 0) {
        List<double> found;
        for (int n = 0; n < follow_through::NUMBERS; n++) {
            found.push_back(0.0);
        }
        return found;
    }
    Ref<LoopSpot> spot = cue_times::loop_spot(project, rest, time);
    List<double> row = follow_through::_row(track, spot->seconds);
    if (spot->over < 1.0) {
        double old = 1.0 - cue_times::ease(spot->over);
        List<double> before = follow_through::_row(track, spot->other);
        List<double> found2;
        for (int n = 0; n < follow_through::NUMBERS; n++) {
            found2.push_back(lang::at(row, n) + (lang::at(before, n) - lang::at(row, n)) * old);
        }
        row = found2;
    }
    return row;
}

/// Return a track's row at a second of the clip, interpolated linearly.
inline List<double> _row(const Ref<ArmTrack>& track, double seconds) {
    int last = lang::len(track->rows) - 1;
    double at = std::min(std::max(seconds * follow_through::RATE, 0.0), static_cast<double>(last));
    int low = std::min(static_cast<int>(std::floor(at)), std::max(0, last - 1));
    double part = at - low;
    List<double> a = lang::at(track->rows, low);
    List<double> b = lang::at(track->rows, std::min(low + 1, last));
    List<double> found;
    for (int n = 0; n < follow_through::NUMBERS; n++) {
        found.push_back(lang::at(a, n) + (lang::at(b, n) - lang::at(a, n)) * part);
    }
    return found;
}

}  // namespace follow_through

}  // namespace metagraph
