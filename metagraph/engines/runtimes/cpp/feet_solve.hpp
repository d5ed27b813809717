// Move feet to where they should stand, with two-bone legs whose knees keep their direction. The hips move along and
// sink, so that no leg snaps straight.
//
// Rotations are quaternions xyzw, lengths metres. The code computes one pose at a time, with plain numbers, the same in
// all languages. All amounts are ours, chosen by eye.
//
// Translated from metagraph/motion/feet_solve.py; change that, and translate anew.
#pragma once

#include "contact_solve.hpp"
#include "plain_vectors.hpp"
#include "weight_solve.hpp"
#include "language.hpp"

namespace metagraph {

struct FootGoal;

namespace feet_solve {

inline constexpr double NEAR = 0.0001; // metres that a foot may be away before it is brought
inline constexpr double NEARLY = 0.001; // radians that it may be turned away
inline constexpr double FOLLOWS = 0.7; // of the feet's way the hips come along
inline constexpr double LEANS = 0.1; // of the way to the foot that stands, while the other is
inline constexpr double HIGH = 0.05; // metres in the air
inline constexpr double TURNING = 0.15; // metres that a turn of a radian counts as way
inline double foot_way(const Ref<FootGoal>& a, const Ref<FootGoal>& b);
inline bool plant_feet(
    const Ref<WeightRig>& rig,
    const Ref<ContactPose>& pose,
    const List<Ref<FootGoal>>& goals,
    double strength
);

}  // namespace feet_solve

/// Where a foot's joint should be, in the character's space. planted: how firmly it stands there, 0..1. lift: height of
/// a step above that, metres.
struct FootGoal {
    std::tuple<double, double, double> at;
    std::tuple<double, double, double, double> turn;
    double planted;
    double lift;

    FootGoal(
        std::tuple<double, double, double> at_,
        std::tuple<double, double, double, double> turn_,
        double planted_,
        double lift_
    )
        : at(std::move(at_)), turn(std::move(turn_)), planted(planted_), lift(lift_) {}
};

namespace feet_solve {

/// Return the distance between two places of a foot, in metres; a rotation counts as a distance, too.
inline double foot_way(const Ref<FootGoal>& a, const Ref<FootGoal>& b) {
    auto [ax, ay, az, aw] = a->turn;
    auto [bx, by, bz, bw] = b->turn;
    double along = std::abs(ax * bx + ay * by + az * bz + aw * bw);
    double turn = 2.0 * std::sqrt(std::max(0.0, 2.0 - 2.0 * along));
    return plain_vectors::length(plain_vectors::minus(b->at, a->at)) + feet_solve::TURNING * turn;
}

/// Move feet to their goals, as far as these are planted; return whether anything moved. goals: left and right, or
/// none. strength: the user's dial. You need not call `spread` first.
inline bool plant_feet(
    const Ref<WeightRig>& rig,
    const Ref<ContactPose>& pose,
    const List<Ref<FootGoal>>& goals,
    double strength
) {
    if (lang::len(goals) != 2 || strength <= 0.0) {
        return false;
    }
    Ref<ContactRig> body = rig->body;
    contact_solve::spread(body, pose);
    strength = strength * weight_solve::stands_by(rig, pose);
    if (strength <= 0.0) {
        return false;
    }
    List<std::tuple<double, double, double>> feet;
    for (const auto& leg : body->arms) {
        feet.push_back(lang::at(pose->at, leg->hand));
    }
    List<std::tuple<double, double, double, double>> soles;
    for (const auto& leg : body->arms) {
        soles.push_back(lang::at(pose->turned, leg->hand));
    }
    List<double> reaches;
    for (const auto& leg : body->arms) {
        reaches.push_back(plain_vectors::length(
            plain_vectors::minus(lang::at(pose->at, leg->hand), lang::at(pose->at, leg->upper))
        ));
    }
    int hips = lang::at(rig->bends, 0)->place;
    std::tuple<double, double, double> middle = lang::at(pose->at, hips);
    std::tuple<double, double, double> shift = std::tuple<double, double, double>{0.0, 0.0, 0.0};
    double size = 0.0;
    bool moved = false;
    for (int side = 0; side < 2; side++) {
        Ref<FootGoal> goal = lang::at(goals, side);
        double part = strength * goal->planted;
        std::tuple<double, double, double> way = plain_vectors::minus(
            plain_vectors::plus(goal->at, plain_vectors::scaled(rig->up, goal->lift)),
            lang::at(feet, side)
        );
        double far = plain_vectors::length(way);
        if (far > feet_solve::NEAR && part > 0.0) {
            way = plain_vectors::scaled(way, part * (far - feet_solve::NEAR) / far);
            double lean = feet_solve::LEANS * part * goal->lift / feet_solve::HIGH;
            shift = plain_vectors::plus(
                shift,
                plain_vectors::plus(
                    plain_vectors::scaled(way, 0.5 * feet_solve::FOLLOWS),
                    plain_vectors::scaled(plain_vectors::minus(lang::at(feet, 1 - side), middle), lean)
                )
            );
            lang::at(feet, side) = plain_vectors::plus(lang::at(feet, side), way);
            size += plain_vectors::length(way);
            moved = true;
        }
        auto [x, y, z, w] = plain_vectors::times(goal->turn, plain_vectors::back(lang::at(soles, side)));
        double turn = 2.0 * std::sqrt(x * x + y * y + z * z);
        if (turn > feet_solve::NEARLY && part > 0.0) {
            double k = part * (turn - feet_solve::NEARLY) / turn;
            double along = w < 0.0 ? -k : k; // the shorter way
            std::tuple<double, double, double, double> turned = plain_vectors::unit_turn(
                std::tuple<double, double, double, double>{x * along, y * along, z * along, 1.0 - k + std::abs(w) * k}
            );
            lang::at(soles, side) = plain_vectors::times(turned, lang::at(soles, side));
            moved = true;
        }
    }
    if (!moved) {
        return false;
    }
    shift = plain_vectors::minus(shift, plain_vectors::scaled(rig->up, plain_vectors::dot(shift, rig->up)));
    int above = lang::at(body->parents, hips);
    std::tuple<double, double, double, double> space = above < 0
        ? std::tuple<double, double, double, double>{0.0, 0.0, 0.0, 1.0}
        : plain_vectors::back(lang::at(pose->turned, above));
    lang::at(pose->moved, hips) = plain_vectors::plus(
        lang::at(pose->moved, hips),
        plain_vectors::rotated(space, shift)
    );
    contact_solve::spread(body, pose);
    double soft = weight_solve::GIVE * (size + plain_vectors::length(shift));
    double low = 0.0;
    for (int side = 0; side < 2; side++) {
        low = std::max(
            low,
            weight_solve::hips_sink(rig, pose, side, lang::at(feet, side), lang::at(reaches, side), soft)
        );
    }
    if (low > 0.0) {
        lang::at(pose->moved, hips) = plain_vectors::plus(
            lang::at(pose->moved, hips),
            plain_vectors::rotated(space, plain_vectors::scaled(rig->up, -low))
        );
        contact_solve::spread(body, pose);
    }
    for (int side = 0; side < 2; side++) {
        contact_solve::bring(body, pose, side, lang::at(feet, side), lang::at(soles, side), lang::at(rig->knees, side));
    }
    return true;
}

}  // namespace feet_solve

}  // namespace metagraph
