// Where the gaze goes at a time: eased moves from target to target, with aversions and saccades on top.
//
// The eyes jump (a saccade of A degrees takes 21 + 2.2 A milliseconds), the head follows a moment later and settles like a
// critically damped spring. What is looked at is the sum of all moves so far, each from the target before, so a target may
// change at any time:
//
//     angle(t) = sum over targets i of angle_i (S_i(t) - S_{i+1}(t)),  S_i: how far the move to target i has come, 0..1
#pragma once

#include "graph.hpp"
#include "schedule.hpp"

namespace metagraph {

/// A target as the gaze meets it. eyes, head: seconds the move to it takes them.
struct Aim {
    double start = 0.0;
    Vec at;
    double amount = 0.0;
    bool asked = false, strict = false;
    double eyes = 0.0, head = 0.0;
};

/// A schedule's gaze on a body; `at` leaves in it what the gaze does at a time.
class Gaze {
public:
    /// How much a target takes part: the eyes' and the head's share, together 1 each.
    struct Part {
        int aim = 0;
        double came = 0.0, moved = 0.0;
    };

    List<Aim> aims;
    List<Part> parts;
    // what aversions and saccades add, radians to the left and up
    double eyes[2] = {0, 0}, head[2] = {0, 0};

    Gaze(const Graph& graph, Ref<Schedule> schedule)
        : schedule_(std::move(schedule)), body_(*graph.body), calm_(1 - graph.life->stillness) {
        averting_ = graph.life->aversion_angle * RADIANS * calm_ * graph.life->gaze;
        darting_ = graph.life->saccades * RADIANS * calm_;
        angle_ = graph.life->aversion_angle;
        for (int n = 0; n < lang::len(schedule_->targets); n++) aims.push_back(aim(graph, n));
        parts.reserve(aims.size());
    }

    void at(double time) {
        int last = 0;
        while (last + 1 < lang::len(aims) && lang::at(schedule_->targets, last + 1)->start <= time) last++;
        double came = 0, turned = 0, strict = 0;
        parts.clear();
        for (int place = last; place >= 0 && (came < 1 || turned < 1); place--) {
            const Aim& aim = lang::at(aims, place);
            const double gone = time - aim.start;
            const double now = rotation::ease(gone / aim.eyes), moved = settle((gone - HEAD_LAG) / aim.head);
            parts.push_back({place, now - came, moved - turned});
            if (aim.strict) strict += now - came;
            came = now;
            turned = moved;
        }
        eyes[0] = eyes[1] = head[0] = head[1] = 0;
        avert(time, strict, lang::at(schedule_->targets, last)->since);
        dart(time);
    }

private:
    static constexpr double EYE_TIME = 0.021, EYE_TIME_PER_DEGREE = 0.0022; // seconds
    static constexpr double HEAD_LAG = 0.04; // seconds the head sets off after the eyes
    static constexpr double HEAD_TIME = 0.55, HEAD_TIME_PER_DEGREE = 0.006; // seconds until it has settled
    static constexpr double ENDING = 0.12; // seconds in which a new look ends an aversion
    static constexpr double SPRING = 8; // how many of the spring's own times a move takes; then all but 0.3 % is done
    static constexpr double RADIANS = lang::PI / 180;

    Ref<Schedule> schedule_;
    const Body& body_;
    double calm_, averting_ = 0.0, darting_ = 0.0, angle_ = 0.0;

    /// A critically damped spring's way from 0 to 1, for x from 0 to 1.
    static double settle(double x) {
        static const double settled = 1 - (1 + SPRING) * std::exp(-SPRING);
        return x <= 0 ? 0 : x >= 1 ? 1 : (1 - (1 + SPRING * x) * std::exp(-SPRING * x)) / settled;
    }
    static double eye_time(double angle) { return EYE_TIME + EYE_TIME_PER_DEGREE * angle; }
    static double head_time(double angle) { return HEAD_TIME + HEAD_TIME_PER_DEGREE * angle; }

    /// Where a target is, metres; nothing for what is nowhere: ahead.
    std::optional<Vec> point_of(const Graph& graph, const GazeTarget& target) const {
        if (target.to->point.has_value()) return target.to->point;
        if (target.to->name == wanted::AHEAD) return std::nullopt;
        const Vec* known = graph.points.find(target.to->name);
        if (known != nullptr) return *known;
        return target.to->name == wanted::PARTNER ? std::optional<Vec>(body_.partner) : std::nullopt;
    }
    /// The direction of a point from where the eyes are at rest.
    Vec towards(const std::optional<Vec>& point) const {
        return point.has_value() ? *point - body_.eyes_at_rest : body_.ahead;
    }
    /// The angle between two directions, degrees.
    static double between(const Vec& a, const Vec& b) {
        const double size = std::sqrt(rotation::dot(a, a) * rotation::dot(b, b));
        return std::acos(std::clamp(rotation::dot(a, b) / std::max(size, 1e-12), -1.0, 1.0)) / RADIANS;
    }

    Aim aim(const Graph& graph, int place) const {
        const GazeTarget& target = *lang::at(schedule_->targets, place);
        const auto point = point_of(graph, target);
        double angle = 0;
        if (place > 0) {
            angle = between(towards(point), towards(point_of(graph, *lang::at(schedule_->targets, place - 1))));
        }
        Aim out;
        out.start = place > 0 ? target.start : -INFINITY; // the first has always been looked at
        out.at = point.value_or(body_.partner);
        out.amount = point.has_value() ? target.amount : 0;
        out.asked = target.asked;
        out.strict = target.strict;
        out.eyes = eye_time(angle);
        out.head = head_time(angle);
        return out;
    }

    void avert(double time, double strict, double since) {
        const Lane& lane = *schedule_->aversions;
        const int n = lang::bisect_right(lane.times, time) - 1;
        if (n < 0 || !(averting_ > 0)) return;
        const List<double>& value = lang::at(lane.rows, n);
        const double start = lang::at(lane.times, n), end = value[0], x = value[1], y = value[2];
        const double size = std::hypot(x, y) * angle_;
        double scale = averting_ * (1 - strict);
        if (since > start) scale *= 1 - rotation::ease((time - since) / ENDING); // a new look ends it
        const double went = time - start, gone = time - end, slow = head_time(size), fast = eye_time(size);
        if (gone >= HEAD_LAG + slow) return;
        const double now = scale * (rotation::ease(went / fast) - rotation::ease(gone / fast));
        const double moved = scale * (settle((went - HEAD_LAG) / slow) - settle((gone - HEAD_LAG) / slow));
        eyes[0] = x * now;
        eyes[1] = y * now;
        head[0] = x * moved;
        head[1] = y * moved;
    }

    void dart(double time) {
        const Lane& lane = *schedule_->saccades;
        const int n = lang::bisect_right(lane.times, time) - 1;
        if (n < 0 || !(darting_ > 0)) return;
        const List<double>& value = lang::at(lane.rows, n);
        const double x = value[0], y = value[1];
        const double from_x = n > 0 ? lang::at(lane.rows, n - 1)[0] : 0, from_y = n > 0 ? lang::at(lane.rows, n - 1)[1] : 0;
        const double way = rotation::ease((time - lang::at(lane.times, n)) / eye_time(std::hypot(x - from_x, y - from_y)));
        eyes[0] += darting_ * (from_x + (x - from_x) * way);
        eyes[1] += darting_ * (from_y + (y - from_y) * way);
    }
};

}  // namespace metagraph
