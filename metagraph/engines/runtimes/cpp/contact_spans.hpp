// Contacts of an action: where on the body a hand stays, or moves along it, for a part of its clip.
//
// A contact gives the position of the wrist and the rotation of the hand in the space of a joint. So it holds whatever
// else moves that joint: a breathing spine, a layer below, a body of another shape.
//
// Translated from metagraph/motion/contact_spans.py; change that, and translate anew.
#pragma once

#include "language.hpp"

namespace metagraph {

struct ContactKey;
struct ContactSpan;

namespace contact_spans {

inline const List<std::string> HANDS = List<std::string>{"left", "right"};
inline const List<std::string> PLACES = List<std::string>{"palm", "fingertips", "back", "wrist"};
inline constexpr double EASE = 0.15; // seconds in which a hand comes to a contact, and leaves it, by default
// seconds it takes at least where the contact lasts: what it touches may be far from its place
inline constexpr double SETTLES = 0.3;
inline double contact_weight(const Ref<ContactSpan>& span, double seconds, double first, double last);
inline Ref<ContactKey> contact_key(const Ref<ContactSpan>& span, double seconds);

}  // namespace contact_spans

/// Where a hand is on a joint at a moment. time: clip seconds. at: the wrist in the joint's own space, metres. turn:
/// how the hand is turned there, xyzw.
struct ContactKey {
    double time;
    std::tuple<double, double, double> at;
    std::tuple<double, double, double, double> turn;

    ContactKey(double time_, std::tuple<double, double, double> at_, std::tuple<double, double, double, double> turn_)
        : time(time_), at(std::move(at_)), turn(std::move(turn_)) {}
};

/// A hand that stays at a place on the body.
///
/// hand: left or right. place: the part of the hand that touches: palm, fingertips, back, wrist. to: the name of the
/// joint it stays with. start, end: clip seconds. keys: one for a hand that stays, more, in order, for one that moves
/// over the body. ease_in, ease_out: seconds inside the span in which the contact sets in and fades out; they do not
/// apply if the action begins, or ends, within the span.
struct ContactSpan {
    std::string hand;
    std::string place;
    std::string to;
    double start;
    double end;
    List<Ref<ContactKey>> keys;
    double ease_in;
    double ease_out;

    ContactSpan(
        std::string hand_,
        std::string place_,
        std::string to_,
        double start_,
        double end_,
        List<Ref<ContactKey>> keys_,
        double ease_in_ = contact_spans::EASE,
        double ease_out_ = contact_spans::EASE
    )
        : hand(std::move(hand_)),
            place(std::move(place_)),
            to(std::move(to_)),
            start(start_),
            end(end_),
            keys(std::move(keys_)),
            ease_in(ease_in_),
            ease_out(ease_out_) {}
};

namespace contact_spans {

/// Return how much a hand is held at a second of the clip, 0..1. first, last: the seconds of the clip that play.
inline double contact_weight(const Ref<ContactSpan>& span, double seconds, double first, double last) {
    if (seconds < span->start || seconds > span->end) {
        return 0.0;
    }
    double shown = 1.0;
    bool comes = span->start > first && span->ease_in > 0.0;
    bool goes = span->end < last && span->ease_out > 0.0;
    double least = std::min(contact_spans::SETTLES, (span->end - span->start) / ((comes && goes) ? 2.0 : 1.0));
    if (comes) {
        shown = std::min(shown, (seconds - span->start) / std::max(span->ease_in, least));
    }
    if (goes) {
        shown = std::min(shown, (span->end - seconds) / std::max(span->ease_out, least));
    }
    return shown * shown * (3.0 - 2.0 * shown);
}

/// Return where a hand is at a second of the clip, interpolated linearly between two keys.
inline Ref<ContactKey> contact_key(const Ref<ContactSpan>& span, double seconds) {
    Ref<ContactKey> before = lang::at(span->keys, 0);
    for (const auto& after : span->keys) {
        if (after->time >= seconds) {
            if (after->time <= before->time) {
                return after;
            }
            double part = (seconds - before->time) / (after->time - before->time);
            auto [ax, ay, az] = before->at;
            auto [bx, by, bz] = after->at;
            std::tuple<double, double, double> at = std::tuple<double, double, double>{
                ax + (bx - ax) * part,
                ay + (by - ay) * part,
                az + (bz - az) * part
            };
            auto [px, py, pz, pw] = before->turn;
            auto [qx, qy, qz, qw] = after->turn;
            double other = px * qx + py * qy + pz * qz + pw * qw < 0.0 ? -part : part;
            double own = 1.0 - part;
            double x = px * own + qx * other;
            double y = py * own + qy * other;
            double z = pz * own + qz * other;
            double w = pw * own + qw * other;
            double size = 1.0 / std::max(std::sqrt(x * x + y * y + z * z + w * w), 1e-12);
            return lang::made<ContactKey>(
                seconds,
                at,
                std::tuple<double, double, double, double>{x * size, y * size, z * size, w * size}
            );
        }
        before = after;
    }
    return before;
}

}  // namespace contact_spans

}  // namespace metagraph
