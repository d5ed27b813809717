// One pose brought to life: how head, eyes and lids turn. Angles radians.
#pragma once

#include "gaze.hpp"

namespace metagraph {
namespace solve {

inline constexpr double RADIANS = lang::PI / 180;
inline constexpr double SLIGHT = 15 * RADIANS; // of a turn smaller than this the head takes next to nothing
inline constexpr double TILT_SHARE = 0.8; // of up and down the head does less
inline constexpr double EYE_EASE = 20 * RADIANS; // the head takes all that is beyond what eyes do with ease
inline constexpr double TURNED_AWAY = 28 * RADIANS; // a body and head that both face farther away than this are turned back
inline constexpr double HEAD_SIDEWAYS = 65 * RADIANS, HEAD_UP = 30 * RADIANS, HEAD_DOWN = 35 * RADIANS;
inline constexpr double EYE_SIDEWAYS = 32 * RADIANS, EYE_UP = 26 * RADIANS, EYE_DOWN = 30 * RADIANS; // eyes never turn
inline constexpr double FREE = 0.7; // beyond these, and freely within this part of them
inline constexpr double LOOK_SIDEWAYS = 110 * RADIANS, LOOK_UPRIGHT = 65 * RADIANS; // beyond these nobody looks
// What is behind is looked at ever less, so that nothing turns from one side to the other in a moment.
inline constexpr double LOOK_BEHIND = 120 * RADIANS, TURN_BEHIND = 85 * RADIANS, EYES_BEHIND = 100 * RADIANS;
inline constexpr double TURNED_BACK = 95 * RADIANS; // the farthest that a body counts as turned away
inline constexpr double NEAREST = 0.25; // metres; nearer things are looked at as if they were there
inline constexpr double WIDEST = -0.8; // how far lids open beyond rest, of their shutting turn

inline double within(double x, double limit) { return std::clamp(x, -limit, limit); }
/// Return an angle kept within a limit, and ever less of it from `behind` to half a turn.
inline double turning(double angle, double most, double behind) {
    return within(angle, most) * (1 - rotation::ease((std::abs(angle) - behind) / (lang::PI - behind)));
}

inline double excess(double x, double free) { return (x < 0 ? -1 : 1) * std::max(std::abs(x) - free, 0.0); }

/// Return the head's part of a turn: `share` of a wide one, next to none of a slight one.
inline double head_part(double angle, double share) {
    const double size = std::abs(angle);
    return share * angle * size / (size + SLIGHT);
}

/// Return how far a lid is shut: 0 open as at rest, 1 shut. down: the eye's pitch. already: how far a clip has shut it.
inline double lid(double down, double follow, double already, double blink) {
    const double shut = std::clamp(already + follow * down, WIDEST, 1.0);
    return shut + blink * (1 - shut); // a blink shuts what is left, so that lids meet and go no farther
}

/// Return what a rotation near rest has in common with a row of an eye's `down` or of `shut_by`.
inline double part_along(const Quat& q, const Quat& row) {
    const double along = rotation::dot(q, row);
    return q.w >= 0 ? along : -along;
}

}  // namespace solve

/// Works out turns for one body; `look` leaves them in it.
class Solver {
public:
    List<Joined> chain; // in their parents' space, given
    List<Vec> turns; // rotation vectors of the lookers, in their own space
    double eyes[4] = {0, 0, 0, 0}; // left eye's turn to the left and up, then the right's

    explicit Solver(const Body& body)
        : chain(body.chain.size()), turns(body.lookers.size()), body_(body), whole_(body.chain.size()) {}

    void rest() {
        std::fill(turns.begin(), turns.end(), Vec{});
        std::fill(std::begin(eyes), std::end(eyes), 0.0);
    }

    /// Set `turns` and `eyes` for a gaze. amount: of all looking; calm: of what nobody asked for; share: the head's of a turn.
    void look(const Gaze& gaze, double amount, double calm, double share) {
        using namespace rotation;
        const Vec &left = body_.left, &up = body_.up, &ahead = body_.ahead;
        globals();
        const Joined& top = whole_.back();
        const Vec eye = top.translation + rotate(top.rotation, (body_.eyes[0].at + body_.eyes[1].at) * 0.5);
        // Where the targets are, seen from there; the eyes' and the head's share of each.
        double eyes_x = gaze.eyes[0], eyes_y = gaze.eyes[1], head_x = gaze.head[0], head_y = gaze.head[1];
        double closeness = 0, all = 0;
        for (const Gaze::Part& part : gaze.parts) {
            const Aim& aim = lang::at(gaze.aims, part.aim);
            const Vec away = aim.at - eye;
            const double x = dot(left, away), y = dot(up, away), z = dot(ahead, away);
            const double level = std::sqrt(x * x + z * z);
            const double sideways = solve::turning(std::atan2(x, z), solve::LOOK_SIDEWAYS, solve::LOOK_BEHIND);
            const double upwards = solve::within(std::atan2(y, level), solve::LOOK_UPRIGHT);
            const double weight = aim.amount * amount * (aim.asked ? 1 : calm);
            eyes_x += part.came * sideways;
            eyes_y += part.came * upwards;
            closeness += part.came / std::max(std::sqrt(level * level + y * y), solve::NEAREST);
            head_x += part.moved * weight * sideways;
            head_y += part.moved * weight * upwards;
            all += part.came * weight;
        }
        const double size = head(head_x, head_y, all, share);
        for (std::size_t n = 0; n < turns.size(); n++) {
            const Looker& looker = body_.lookers[n];
            turns[n] = rotate(lang::at(whole_, looker.place).rotation.back(), vector_) * looker.share;
        }
        // Where that brings the eyes: every joint that turns carries what is above it along.
        Vec moved_to = lang::at(whole_, body_.lookers[0].place).translation;
        double so_far = 0;
        for (std::size_t n = 0; n < turns.size(); n++) {
            so_far += body_.lookers[n].share;
            const Vec from = lang::at(whole_, body_.lookers[n].place).translation;
            const Vec to = n + 1 < turns.size() ? lang::at(whole_, body_.lookers[n + 1].place).translation : top.translation;
            moved_to += rotate(about(size, so_far), to - from);
        }
        const Quat turned = multiply(about(size, 1), top.rotation);
        // The point looked at, in the head's space; each eye turns to it the shortest way, so that it does not roll.
        const double distance = 1 / std::max(closeness, 1e-3);
        const double x = std::sin(eyes_x) * std::cos(eyes_y) * distance, y = std::sin(eyes_y) * distance;
        const double z = std::cos(eyes_x) * std::cos(eyes_y) * distance;
        const Vec inside = rotate(turned.back(), eye + left * x + up * y + ahead * z - moved_to);
        for (std::size_t n = 0; n < 2; n++) aim(n, inside, gaze, all);
    }

private:
    const Body& body_;
    List<Joined> whole_; // the chain in the character's space
    Vec vector_; // the head's turn: a rotation vector in the character's space

    /// Set the turn of one eye to a point in the head's space.
    void aim(std::size_t n, const Vec& inside, const Gaze& gaze, double all) {
        const Eye& side = body_.eyes[n];
        const Vec away = inside - side.at;
        const double x = rotation::dot(side.left, away), y = rotation::dot(side.up, away);
        const double across = std::sqrt(x * x + y * y);
        const double way = solve::turning(std::atan2(across, rotation::dot(side.ahead, away)), lang::PI, solve::EYES_BEHIND);
        const double angle = way / std::max(across, 1e-12) * all;
        const double left = x * angle + gaze.eyes[0] * (1 - all), up = y * angle + gaze.eyes[1] * (1 - all);
        // Within what eyes can do, softly at the limit.
        const double a = left / solve::EYE_SIDEWAYS, b = up / (up > 0 ? solve::EYE_UP : solve::EYE_DOWN);
        const double beyond = std::sqrt(a * a + b * b), free = solve::FREE;
        const double k = beyond <= free ? 1 : (free + (1 - free) * std::tanh((beyond - free) / (1 - free))) / beyond;
        eyes[2 * n] = left * k;
        eyes[2 * n + 1] = up * k;
    }

    /// Leave in `vector_` the head's turn towards a target `left` and `up` of ahead; return its size.
    double head(double left, double up, double amount, double share) {
        const double beyond = std::min(1.0, 2 * share);
        double x = solve::head_part(left, share), y = solve::TILT_SHARE * solve::head_part(up, share);
        x += beyond * solve::excess(left - x, solve::EYE_EASE);
        y += beyond * solve::excess(up - y, solve::EYE_EASE);
        // A character that has turned away as a whole turns its head back; one whose head alone or body alone has, means it.
        const double trunk = gap(body_.trunk, body_.trunk_ahead, left), face = gap(lang::len(whole_) - 1, body_.head_ahead, left);
        const double both = std::max(std::min(trunk, face), 0.0) + std::min(std::max(trunk, face), 0.0);
        x += beyond * amount * solve::excess(both, std::max(solve::TURNED_AWAY, std::abs(left)));
        x = solve::within(x, solve::HEAD_SIDEWAYS);
        y = std::clamp(y, -solve::HEAD_DOWN, solve::HEAD_UP);
        // First up, then round: the head does not tilt to a shoulder.
        const double cx = std::cos(0.5 * x), sx = std::sin(0.5 * x), cy = std::cos(0.5 * y), sy = -std::sin(0.5 * y);
        const double a = cx * sy, b = sx * cy, c = -sx * sy;
        const double length = std::sqrt(a * a + b * b + c * c);
        const double size = 2 * std::atan2(length, cx * cy);
        const double k = length > 1e-12 ? size / length : 0;
        vector_ = (body_.left * a + body_.up * b + body_.ahead * c) * k;
        return size;
    }

    /// Return the angle from where a joint of the chain faces to `left`; less of it where that is behind, or where it faces up or down.
    double gap(int place, const Vec& facing, double left) const {
        const Vec ahead = rotation::rotate(lang::at(whole_, place).rotation, facing);
        const double x = rotation::dot(body_.left, ahead), z = rotation::dot(body_.ahead, ahead);
        const double gap = left - std::atan2(x, z);
        const double close = gap > lang::PI ? gap - 2 * lang::PI : gap < -lang::PI ? gap + 2 * lang::PI : gap;
        return solve::turning(close, solve::TURNED_BACK, solve::TURN_BEHIND) * rotation::ease(2 * std::sqrt(x * x + z * z));
    }

    /// Return the turn by a part of `vector_`, which is `size` long.
    Quat about(double size, double part) const {
        const double s = size > 1e-12 ? std::sin(0.5 * size * part) / size : 0;
        return {vector_.x * s, vector_.y * s, vector_.z * s, std::cos(0.5 * size * part)};
    }

    /// Bring the chain into the character's space.
    void globals() {
        whole_[0] = chain[0];
        for (std::size_t n = 1; n < chain.size(); n++) {
            const Joined& above = whole_[n - 1];
            whole_[n].translation = above.translation + rotation::rotate(above.rotation, chain[n].translation);
            whole_[n].rotation = rotation::multiply(above.rotation, chain[n].rotation);
        }
    }
};

}  // namespace metagraph
