// How a standing body reacts to its arms: the hips give way, spine and legs compensate, and the feet stay.
//
// Rotations are quaternions xyzw, lengths metres; a place is an index into a rig's list of joints. The code computes
// one pose at a time, with plain numbers, the same in all languages.
//
// How much: a standing person keeps the centre of mass over the feet, so the hips move back as far as the arms move it
// ahead. The weight of each segment is from de Leva 1996. That trunk and legs move against a raised arm is from
// Bouisset and Zattara 1987. The other amounts are ours, chosen by eye on the sample.
//
// Translated from metagraph/motion/weight_solve.py; change that, and translate anew.
#pragma once

#include "contact_solve.hpp"
#include "plain_vectors.hpp"
#include "language.hpp"

namespace metagraph {

struct WeightBend;
struct WeightCollar;
struct WeightRig;

namespace weight_solve {

inline constexpr double BALANCE = 1.4; // factor of the arms' shift of the centre of mass by which the hips compensate
inline constexpr double HASTE = 0.12; // seconds of the arms' speed that are added to the shift
inline constexpr double DIP = 0.05; // seconds: arms that rise this fast press the body down, half as far at most
inline constexpr double SPIN = 30.0; // seconds: how far the pelvis turns against what arms turn about the vertical
inline constexpr double ROLL = 3.0; // radians that the pelvis rolls for a shift to a side of its own height, and
inline constexpr double PITCH = 2.0; // bends for one ahead or back
inline constexpr double MOST_SHIFT = 0.02; // of the height
inline constexpr double MOST_TURN = 0.1; // radians
// how high a hip is above its ankle, of the leg's length: below this it does not stand
inline constexpr double SITTING = 0.75;
inline constexpr double STANDING = 0.15; // and this much above it stands altogether
inline constexpr double GIVE = 0.5; // of a shift: over so much a leg's full length makes itself felt
inline bool moves_body(const List<double>& drive);
inline bool answer_arms(
    const Ref<WeightRig>& rig,
    const Ref<ContactPose>& pose,
    const List<double>& drive,
    double follow,
    double lift
);
inline double stands_by(const Ref<WeightRig>& rig, const Ref<ContactPose>& pose);
inline void _give_way(
    const Ref<WeightRig>& rig,
    const Ref<ContactPose>& pose,
    const List<double>& drive,
    double follow
);
inline double hips_sink(
    const Ref<WeightRig>& rig,
    const Ref<ContactPose>& pose,
    int side,
    const std::tuple<double, double, double>& foot,
    double reach,
    double soft
);
inline double _soft(double x, double most);
inline std::tuple<double, double, double, double> _turn(const std::tuple<double, double, double>& axis, double angle);

}  // namespace weight_solve

/// A joint that turns. left, up, ahead: the character's directions in its own space. share: of the hips' rotation,
/// below 0 for the opposite direction.
struct WeightBend {
    int place;
    std::tuple<double, double, double> left;
    std::tuple<double, double, double> up;
    std::tuple<double, double, double> ahead;
    double share;

    WeightBend(
        int place_,
        std::tuple<double, double, double> left_,
        std::tuple<double, double, double> up_,
        std::tuple<double, double, double> ahead_,
        double share_
    )
        : place(place_), left(std::move(left_)), up(std::move(up_)), ahead(std::move(ahead_)), share(share_) {}
};

/// A collar bone. upper: the place of its arm. axis: what lifts it, in its own space. side: 0 left, 1 right.
struct WeightCollar {
    int place;
    int upper;
    std::tuple<double, double, double> axis;
    int side;

    WeightCollar(int place_, int upper_, std::tuple<double, double, double> axis_, int side_)
        : place(place_), upper(upper_), axis(std::move(axis_)), side(side_) {}
};

/// The part of a skeleton that reacts to its arms. body: its joints; its `arms` are the legs, left and right, its
/// `hands` the names of the hands. bends: from the hips up. knees: the direction in which straight legs bend, in the
/// upper legs' own spaces. levers: how far the arms are to the left and ahead of the hips. up: the character's up
/// direction. height: of the figure, metres. strength: how much of the arms' layer counts, 0..1.
struct WeightRig {
    Ref<ContactRig> body;
    List<Ref<WeightBend>> bends;
    List<Ref<WeightCollar>> collars;
    List<std::tuple<double, double, double>> knees;
    List<std::tuple<double, double>> levers;
    std::tuple<double, double, double> up;
    double height;
    double strength;

    WeightRig(
        Ref<ContactRig> body_,
        List<Ref<WeightBend>> bends_,
        List<Ref<WeightCollar>> collars_,
        List<std::tuple<double, double, double>> knees_,
        List<std::tuple<double, double>> levers_,
        std::tuple<double, double, double> up_,
        double height_,
        double strength_
    )
        : body(std::move(body_)),
            bends(std::move(bends_)),
            collars(std::move(collars_)),
            knees(std::move(knees_)),
            levers(std::move(levers_)),
            up(std::move(up_)),
            height(height_),
            strength(strength_) {}
};

namespace weight_solve {

/// Return whether there is anything to react to.
inline bool moves_body(const List<double>& drive) {
    bool is_any = false;
    for (const auto& x : drive) {
        if (x != 0.0) {
            is_any = true;
            break;
        }
    }
    return is_any;
}

/// Change a pose of the rig's joints in reaction to its arms; return whether it changed.
///
/// drive: as `posing.follow_through.driven` returns it. follow, lift: the user's dials. You need not call `spread`
/// first.
inline bool answer_arms(
    const Ref<WeightRig>& rig,
    const Ref<ContactPose>& pose,
    const List<double>& drive,
    double follow,
    double lift
) {
    follow = follow * rig->strength;
    lift = lift * rig->strength;
    if ((follow <= 0.0 && lift <= 0.0) || !weight_solve::moves_body(drive)) {
        return false;
    }
    for (const auto& collar : rig->collars) {
        std::tuple<double, double, double, double> turn = weight_solve::_turn(
            collar->axis,
            lift * lang::at(drive, 6 + collar->side)
        );
        lang::at(pose->local, collar->place) = plain_vectors::times(lang::at(pose->local, collar->place), turn);
        lang::at(pose->local, collar->upper) = plain_vectors::times(
            plain_vectors::back(turn),
            lang::at(pose->local, collar->upper)
        );
    }
    if (follow <= 0.0) {
        return true;
    }
    contact_solve::spread(rig->body, pose);
    follow = follow * weight_solve::stands_by(rig, pose);
    if (follow <= 0.0) {
        return true;
    }
    weight_solve::_give_way(rig, pose, drive, follow);
    return true;
}

/// Return how much a figure stands: 0 if it sits or lies, 1 on straight legs.
inline double stands_by(const Ref<WeightRig>& rig, const Ref<ContactPose>& pose) {
    double least = 1.0;
    for (const auto& leg : rig->body->arms) {
        std::tuple<double, double, double> hip = lang::at(pose->at, leg->upper);
        std::tuple<double, double, double> knee = lang::at(pose->at, leg->lower);
        std::tuple<double, double, double> ankle = lang::at(pose->at, leg->hand);
        double whole = plain_vectors::length(plain_vectors::minus(knee, hip))
            + plain_vectors::length(plain_vectors::minus(ankle, knee));
        if (whole > 1e-06) {
            least = std::min(least, plain_vectors::dot(plain_vectors::minus(hip, ankle), rig->up) / whole);
        }
    }
    double x = std::min(std::max((least - weight_solve::SITTING) / weight_solve::STANDING, 0.0), 1.0);
    return x * x * (3.0 - 2.0 * x);
}

/// Shift and rotate the hips, undo that in the spine, and move the legs so that the feet stay.
inline void _give_way(
    const Ref<WeightRig>& rig,
    const Ref<ContactPose>& pose,
    const List<double>& drive,
    double follow
) {
    Ref<ContactRig> body = rig->body;
    double vx = lang::at(drive, 8) + lang::at(drive, 11);
    double vy = lang::at(drive, 9) + lang::at(drive, 12);
    double vz = lang::at(drive, 10) + lang::at(drive, 13);
    double spin = 0.0;
    for (int side = 0; side < lang::len(rig->levers); side++) {
        const auto& lever = lang::at(rig->levers, side);
        auto [lx, lz] = lever;
        spin += lz * lang::at(drive, 8 + 3 * side) - lx * lang::at(drive, 10 + 3 * side);
    }
    double most = weight_solve::MOST_SHIFT * rig->height;
    double x = weight_solve::_soft(
        -follow * weight_solve::BALANCE * (lang::at(drive, 0) + lang::at(drive, 3) + weight_solve::HASTE * vx),
        most
    );
    double y = weight_solve::_soft(-follow * weight_solve::DIP * vy, 0.5 * most);
    double z = weight_solve::_soft(
        -follow * weight_solve::BALANCE * (lang::at(drive, 2) + lang::at(drive, 5) + weight_solve::HASTE * vz),
        most
    );
    double yaw = weight_solve::_soft(
        -follow * weight_solve::SPIN * spin / (rig->height * rig->height),
        weight_solve::MOST_TURN
    );
    double roll = weight_solve::ROLL * x / rig->height;
    double pitch = -weight_solve::PITCH * z / rig->height;
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
    Ref<WeightBend> hips = lang::at(rig->bends, 0);
    std::tuple<double, double, double> shift = plain_vectors::plus(
        plain_vectors::plus(plain_vectors::scaled(hips->left, x), plain_vectors::scaled(hips->up, y)),
        plain_vectors::scaled(hips->ahead, z)
    );
    shift = plain_vectors::rotated(lang::at(pose->turned, hips->place), shift);
    for (const auto& bend : rig->bends) {
        std::tuple<double, double, double> axis = plain_vectors::plus(
            plain_vectors::plus(plain_vectors::scaled(bend->left, pitch), plain_vectors::scaled(bend->up, yaw)),
            plain_vectors::scaled(bend->ahead, roll)
        );
        lang::at(pose->local, bend->place) = plain_vectors::times(
            lang::at(pose->local, bend->place),
            weight_solve::_turn(axis, bend->share)
        );
    }
    int above = lang::at(body->parents, hips->place);
    std::tuple<double, double, double, double> space = above < 0
        ? std::tuple<double, double, double, double>{0.0, 0.0, 0.0, 1.0}
        : plain_vectors::back(lang::at(pose->turned, above));
    lang::at(pose->moved, hips->place) = plain_vectors::plus(
        lang::at(pose->moved, hips->place),
        plain_vectors::rotated(space, shift)
    );
    contact_solve::spread(body, pose);
    double size = plain_vectors::length(std::tuple<double, double, double>{x, y, z})
        + 0.1 * rig->height * plain_vectors::length(std::tuple<double, double, double>{yaw, roll, pitch});
    double low = 0.0;
    for (int side = 0; side < lang::len(feet); side++) {
        low = std::max(
            low,
            weight_solve::hips_sink(
                rig,
                pose,
                side,
                lang::at(feet, side),
                lang::at(reaches, side),
                weight_solve::GIVE * size
            )
        );
    }
    if (low > 0.0) {
        std::tuple<double, double, double> down = plain_vectors::rotated(space, plain_vectors::scaled(rig->up, -low));
        lang::at(pose->moved, hips->place) = plain_vectors::plus(lang::at(pose->moved, hips->place), down);
        contact_solve::spread(body, pose);
    }
    for (int side = 0; side < lang::len(feet); side++) {
        contact_solve::bring(body, pose, side, lang::at(feet, side), lang::at(soles, side), lang::at(rig->knees, side));
    }
}

/// Return how far the hips have to sink so that the leg reaches the foot. It sets in gently, a little before the limit.
/// reach: the distance of hip and foot before.
inline double hips_sink(
    const Ref<WeightRig>& rig,
    const Ref<ContactPose>& pose,
    int side,
    const std::tuple<double, double, double>& foot,
    double reach,
    double soft
) {
    Ref<ContactArm> leg = lang::at(rig->body->arms, side);
    std::tuple<double, double, double> hip = lang::at(pose->at, leg->upper);
    std::tuple<double, double, double> knee = lang::at(pose->at, leg->lower);
    std::tuple<double, double, double> ankle = lang::at(pose->at, leg->hand);
    double whole = plain_vectors::length(plain_vectors::minus(knee, hip))
        + plain_vectors::length(plain_vectors::minus(ankle, knee));
    double most = std::max(contact_solve::REACHED * whole, reach);
    std::tuple<double, double, double> way = plain_vectors::minus(hip, foot);
    double high = plain_vectors::dot(way, rig->up);
    double aside = plain_vectors::dot(way, way) - high * high;
    if (high <= 0.0 || aside >= most * most || soft <= 0.0) {
        return 0.0;
    }
    double over = high - std::sqrt(most * most - aside);
    if (over >= soft) {
        return over;
    }
    return over <= -soft ? 0.0 : (over + soft) * (over + soft) / (4.0 * soft);
}

/// Return a number limited smoothly to below `most`; small numbers stay almost as they are.
inline double _soft(double x, double most) {
    return x / std::sqrt(1.0 + x / most * (x / most));
}

/// Return the rotation about an axis by its length times an angle, radians.
inline std::tuple<double, double, double, double> _turn(const std::tuple<double, double, double>& axis, double angle) {
    auto [x, y, z] = axis;
    double size = plain_vectors::length(axis);
    if (size <= 0.0) {
        return std::tuple<double, double, double, double>{0.0, 0.0, 0.0, 1.0};
    }
    double half = 0.5 * size * angle;
    double k = std::sin(half) / size;
    return std::tuple<double, double, double, double>{x * k, y * k, z * k, std::cos(half)};
}

}  // namespace weight_solve

}  // namespace metagraph
