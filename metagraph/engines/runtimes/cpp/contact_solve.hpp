// Keep hands in contact with the body, and outside it, by moving two-bone arms to their goals.
//
// The body's parts are capsules, each fixed to a joint. Rotations are quaternions xyzw, lengths metres; a place is an
// index into a rig's list of joints. The code computes one pose at a time, with plain numbers, the same in all
// languages.
//
// Translated from metagraph/motion/contact_solve.py; change that, and translate anew.
#pragma once

#include "plain_vectors.hpp"
#include "language.hpp"

namespace metagraph {

struct ContactArm;
struct BodyCapsule;
struct ContactRig;
struct HandGoal;
struct ContactPose;

namespace contact_solve {

inline constexpr double REACHED = 0.995; // of an arm's length: it does not snap straight
inline constexpr double FOLDED = 0.906; // cosine of the least angle inside an elbow, 25 degrees
// cosine of half of how far a contact may turn a hand from where it was, 70 degrees
inline constexpr double WRIST = 0.819;
inline constexpr double SOFT = 0.006; // metres of depth over which the push out of the body sets in
inline constexpr double FIRM = 0.03; // metres of depth from which on a part resists what pushes towards it
inline constexpr double THROUGH = 0.25; // of both radii: who is nearer to the other's line passes through it
inline constexpr double FULL = 0.9; // from here on, it is pushed all the way
inline constexpr double EVEN = 0.05; // how much the middle counts where lines are side by side
// where a straight arm bends to: no side in particular, but always one
inline const std::tuple<double, double, double> STRAIGHT = std::tuple<double, double, double>{0.31, 0.52, 0.8};
inline constexpr double ELBOW = 0.3; // how little a forearm is pushed near its elbow, which a wrist cannot move
inline constexpr int PASSES = 3; // of the guard
inline constexpr int OBSTACLE = 0; // what a capsule is to the guard: others are pushed out of it
inline constexpr int FOREARM = 1; // pushed out, from the elbow to the wrist
inline constexpr int HAND = 2; // pushed out
inline void spread(const Ref<ContactRig>& rig, const Ref<ContactPose>& pose);
inline void _join(const Ref<ContactRig>& rig, const Ref<ContactPose>& pose, int place);
inline bool solve_contacts(const Ref<ContactRig>& rig, const Ref<ContactPose>& pose, const List<Ref<HandGoal>>& goals);
inline bool _on_arm(const Ref<ContactRig>& rig, int place, int arm);
inline void _hold(
    const Ref<ContactRig>& rig,
    const Ref<ContactPose>& pose,
    const List<Ref<HandGoal>>& goals,
    int side,
    const std::tuple<double, double, double>& wrist,
    const std::tuple<double, double, double, double>& hand
);
inline std::tuple<double, double, double, double> _within_wrist(
    const std::tuple<double, double, double, double>& hand,
    const std::tuple<double, double, double, double>& turn
);
inline void bring(
    const Ref<ContactRig>& rig,
    const Ref<ContactPose>& pose,
    int side,
    const std::tuple<double, double, double>& goal,
    const std::tuple<double, double, double, double>& hand,
    const std::tuple<double, double, double>& side_of
);
inline std::tuple<double, double, double, double> _above(
    const Ref<ContactRig>& rig,
    const Ref<ContactPose>& pose,
    int place
);
inline bool _guarded(const Ref<ContactRig>& rig, const Ref<ContactPose>& pose, const List<double>& held, double across);
inline List<std::tuple<double, double, double>> capsule_ends(const Ref<ContactRig>& rig, const Ref<ContactPose>& pose);
inline List<std::tuple<double, double, double, double>> _balls(
    const Ref<ContactRig>& rig,
    const List<std::tuple<double, double, double>>& ends
);
inline std::tuple<double, double, double> _shift(
    const Ref<ContactRig>& rig,
    const List<std::tuple<double, double, double>>& ends,
    const List<std::tuple<double, double, double, double>>& balls,
    int side,
    const List<double>& held,
    double across,
    List<double>& whole,
    bool first
);
inline double _along(const List<std::tuple<double, double, double>>& ends, int i, int k);
inline std::tuple<double, double, double, double> apart(
    const List<std::tuple<double, double, double>>& ends,
    int i,
    int k
);

}  // namespace contact_solve

/// The places of an arm's joints, and of all joints from its upper arm on, parents first.
struct ContactArm {
    int upper;
    int lower;
    int hand;
    List<int> below;

    ContactArm(int upper_, int lower_, int hand_, List<int> below_)
        : upper(upper_), lower(lower_), hand(hand_), below(std::move(below_)) {}
};

/// A part of the body. joint, to: the places of the joints that carry the ends of its line; a, b: where the ends are,
/// in the spaces of those joints. arm: 0 left, 1 right, -1 neither. kind: whether it is pushed out of others: an
/// OBSTACLE is not; a FOREARM, from the elbow to the wrist, and a HAND are.
struct BodyCapsule {
    int joint;
    std::tuple<double, double, double> a;
    int to;
    std::tuple<double, double, double> b;
    double radius;
    int arm;
    int kind;

    BodyCapsule(
        int joint_,
        std::tuple<double, double, double> a_,
        int to_,
        std::tuple<double, double, double> b_,
        double radius_,
        int arm_ = -1,
        int kind_ = 0
    )
        : joint(joint_), a(std::move(a_)), to(to_), b(std::move(b_)), radius(radius_), arm(arm_), kind(kind_) {}
};

/// The part of a skeleton that contacts need. joints: parents first. parents: for each joint, the place of its parent,
/// -1 for a root. places: joint name -> place. arms: left, right; hands: the names of their hands. contacts, guard:
/// whether each is on.
struct ContactRig {
    List<int> joints;
    List<int> parents;
    Map<std::string, int> places;
    List<Ref<ContactArm>> arms;
    List<std::string> hands;
    List<Ref<BodyCapsule>> capsules;
    bool contacts;
    bool guard;

    ContactRig(
        List<int> joints_,
        List<int> parents_,
        Map<std::string, int> places_,
        List<Ref<ContactArm>> arms_,
        List<std::string> hands_,
        List<Ref<BodyCapsule>> capsules_,
        bool contacts_ = true,
        bool guard_ = true
    )
        : joints(std::move(joints_)),
            parents(std::move(parents_)),
            places(std::move(places_)),
            arms(std::move(arms_)),
            hands(std::move(hands_)),
            capsules(std::move(capsules_)),
            contacts(contacts_),
            guard(guard_) {}
};

/// Where a wrist should be. arm: 0 left, 1 right. to: a place; at, turn: in its space. weight: 0..1.
struct HandGoal {
    int arm;
    int to;
    std::tuple<double, double, double> at;
    std::tuple<double, double, double, double> turn;
    double weight;

    HandGoal(
        int arm_,
        int to_,
        std::tuple<double, double, double> at_,
        std::tuple<double, double, double, double> turn_,
        double weight_
    )
        : arm(arm_), to(to_), at(std::move(at_)), turn(std::move(turn_)), weight(weight_) {}
};

/// A pose of a rig's joints: `local` rotations and `moved` translations are in the parents' space; `turned` and `at`
/// are in the character's space, and `spread` computes them.
struct ContactPose {
    List<std::tuple<double, double, double, double>> local;
    List<std::tuple<double, double, double>> moved;
    List<std::tuple<double, double, double, double>> turned;
    List<std::tuple<double, double, double>> at;

    explicit ContactPose(
        List<std::tuple<double, double, double, double>> local_ = List<std::tuple<double, double, double, double>>{},
        List<std::tuple<double, double, double>> moved_ = List<std::tuple<double, double, double>>{},
        List<std::tuple<double, double, double, double>> turned_ = List<std::tuple<double, double, double, double>>{},
        List<std::tuple<double, double, double>> at_ = List<std::tuple<double, double, double>>{}
    )
        : local(std::move(local_)), moved(std::move(moved_)), turned(std::move(turned_)), at(std::move(at_)) {}
};

namespace contact_solve {

/// Compute where all joints are.
inline void spread(const Ref<ContactRig>& rig, const Ref<ContactPose>& pose) {
    pose->turned = pose->local;
    pose->at = pose->moved;
    for (int place = 0; place < lang::len(rig->parents); place++) {
        contact_solve::_join(rig, pose, place);
    }
}

inline void _join(const Ref<ContactRig>& rig, const Ref<ContactPose>& pose, int place) {
    int above = lang::at(rig->parents, place);
    if (above < 0) {
        lang::at(pose->turned, place) = lang::at(pose->local, place);
        lang::at(pose->at, place) = lang::at(pose->moved, place);
    } else {
        std::tuple<double, double, double, double> turn = lang::at(pose->turned, above);
        auto [x, y, z] = plain_vectors::rotated(turn, lang::at(pose->moved, place));
        auto [ax, ay, az] = lang::at(pose->at, above);
        lang::at(pose->turned, place) = plain_vectors::times(turn, lang::at(pose->local, place));
        lang::at(pose->at, place) = std::tuple<double, double, double>{ax + x, ay + y, az + z};
    }
}

/// Move hands to their goals, then push hands and forearms out of the body; return whether anything moved. Call
/// `spread` first.
inline bool solve_contacts(const Ref<ContactRig>& rig, const Ref<ContactPose>& pose, const List<Ref<HandGoal>>& goals) {
    bool moved = false;
    List<double> held = List<double>{0.0, 0.0};
    double across = 0.0; // how much one arm is held on the other
    for (const auto& goal : goals) {
        lang::at(held, goal->arm) = std::min(1.0, lang::at(held, goal->arm) + goal->weight);
        if (contact_solve::_on_arm(rig, goal->to, 1 - goal->arm)) {
            across = std::max(across, goal->weight);
        }
    }
    int rounds = lang::len(goals) == 0 ? 0 : across > 0.0 ? 2 : 1;
    List<std::tuple<double, double, double>> wrists;
    for (const auto& arm : rig->arms) {
        wrists.push_back(lang::at(pose->at, arm->hand));
    }
    List<std::tuple<double, double, double, double>> hands;
    for (const auto& arm : rig->arms) {
        hands.push_back(lang::at(pose->turned, arm->hand));
    }
    while (rounds > 0) {
        rounds -= 1;
        for (int side = 0; side < lang::len(rig->arms); side++) {
            if (lang::at(held, side) > 0.0) {
                contact_solve::_hold(rig, pose, goals, side, lang::at(wrists, side), lang::at(hands, side));
                moved = true;
            }
        }
    }
    List<std::tuple<double, double, double>> kept;
    for (const auto& arm : rig->arms) {
        kept.push_back(lang::at(pose->at, arm->hand));
    }
    if (rig->guard && contact_solve::_guarded(rig, pose, held, across)) {
        moved = true;
        for (int side = 0; side < lang::len(rig->arms); side++) {
            if (across > 0.0 && lang::at(held, side) > 0.0) {
                std::tuple<double, double, double> pushed = plain_vectors::minus(
                    lang::at(pose->at, lang::at(rig->arms, side)->hand),
                    lang::at(kept, side)
                );
                contact_solve::_hold(
                    rig,
                    pose,
                    goals,
                    side,
                    plain_vectors::plus(lang::at(wrists, side), pushed),
                    lang::at(hands, side)
                );
            }
        }
    }
    return moved;
}

inline bool _on_arm(const Ref<ContactRig>& rig, int place, int arm) {
    bool is_any = false;
    for (const auto& below : lang::at(rig->arms, arm)->below) {
        if (place == below) {
            is_any = true;
            break;
        }
    }
    return is_any;
}

/// Move a hand to the weighted mean of its goals. wrist, hand: its position and rotation without goals.
inline void _hold(
    const Ref<ContactRig>& rig,
    const Ref<ContactPose>& pose,
    const List<Ref<HandGoal>>& goals,
    int side,
    const std::tuple<double, double, double>& wrist,
    const std::tuple<double, double, double, double>& hand
) {
    double total = 0.0;
    double x = 0.0;
    double y = 0.0;
    double z = 0.0;
    double a = 0.0;
    double b = 0.0;
    double c = 0.0;
    double d = 0.0;
    auto [hx, hy, hz, hw] = hand;
    double k{};
    for (const auto& goal : goals) {
        if (goal->arm == side && goal->weight > 0.0) {
            k = goal->weight;
            auto [px, py, pz] = plain_vectors::plus(
                lang::at(pose->at, goal->to),
                plain_vectors::rotated(lang::at(pose->turned, goal->to), goal->at)
            );
            auto [qx, qy, qz, qw] = plain_vectors::times(lang::at(pose->turned, goal->to), goal->turn);
            x = x + k * px;
            y = y + k * py;
            z = z + k * pz;
            total = total + k;
            if (qx * hx + qy * hy + qz * hz + qw * hw < 0.0) {
                k = -k;
            }
            a = a + k * qx;
            b = b + k * qy;
            c = c + k * qz;
            d = d + k * qw;
        }
    }
    double weight = std::min(1.0, total);
    std::tuple<double, double, double> mean = std::tuple<double, double, double>{x / total, y / total, z / total};
    std::tuple<double, double, double, double> turn = contact_solve::_within_wrist(
        hand,
        plain_vectors::unit_turn(std::tuple<double, double, double, double>{a, b, c, d})
    );
    auto [tx, ty, tz, tw] = turn;
    double rest = 1.0 - weight;
    k = tx * hx + ty * hy + tz * hz + tw * hw < 0.0 ? -weight : weight;
    turn = plain_vectors::unit_turn(
        std::tuple<double, double, double, double>{
            hx * rest + tx * k,
            hy * rest + ty * k,
            hz * rest + tz * k,
            hw * rest + tw * k
        }
    );
    contact_solve::bring(
        rig,
        pose,
        side,
        plain_vectors::plus(wrist, plain_vectors::scaled(plain_vectors::minus(mean, wrist), weight)),
        turn,
        contact_solve::STRAIGHT
    );
}

/// Return a hand's rotation, limited to what the wrist allows from the hand's earlier rotation.
inline std::tuple<double, double, double, double> _within_wrist(
    const std::tuple<double, double, double, double>& hand,
    const std::tuple<double, double, double, double>& turn
) {
    auto [x, y, z, w] = plain_vectors::times(turn, plain_vectors::back(hand));
    if (w < 0.0) {
        x = -x;
        y = -y;
        z = -z;
        w = -w;
    }
    if (w >= contact_solve::WRIST) {
        return turn;
    }
    double k = std::sqrt(1.0 - contact_solve::WRIST * contact_solve::WRIST)
        / std::max(std::sqrt(x * x + y * y + z * z), 1e-12);
    return plain_vectors::times(
        std::tuple<double, double, double, double>{x * k, y * k, z * k, contact_solve::WRIST},
        hand
    );
}

/// Move a wrist to a goal, or as near as the arm reaches, with the elbow on the side to which it is bent; rotate the
/// hand. side_of: the direction in which a straight arm bends, in the upper arm's own space.
inline void bring(
    const Ref<ContactRig>& rig,
    const Ref<ContactPose>& pose,
    int side,
    const std::tuple<double, double, double>& goal,
    const std::tuple<double, double, double, double>& hand,
    const std::tuple<double, double, double>& side_of
) {
    Ref<ContactArm> arm = lang::at(rig->arms, side);
    std::tuple<double, double, double> root = lang::at(pose->at, arm->upper);
    std::tuple<double, double, double> elbow = lang::at(pose->at, arm->lower);
    std::tuple<double, double, double> wrist = lang::at(pose->at, arm->hand);
    std::tuple<double, double, double> bone = plain_vectors::minus(elbow, root);
    std::tuple<double, double, double> fore = plain_vectors::minus(wrist, elbow);
    double above_elbow = plain_vectors::length(bone);
    double below_elbow = plain_vectors::length(fore);
    double now = plain_vectors::length(plain_vectors::minus(wrist, root));
    if (above_elbow < 1e-06 || below_elbow < 1e-06 || now < 1e-06) {
        return;
    }
    std::tuple<double, double, double> way = plain_vectors::minus(goal, root);
    double most = std::max(contact_solve::REACHED * (above_elbow + below_elbow), now);
    double least = std::min(
        std::sqrt(above_elbow * above_elbow + below_elbow * below_elbow
            - 2.0 * contact_solve::FOLDED * above_elbow * below_elbow),
        now
    );
    double far = std::min(std::max(plain_vectors::length(way), least), most);
    std::tuple<double, double, double> ahead = plain_vectors::unit(way);
    std::tuple<double, double, double> before = plain_vectors::scaled(plain_vectors::minus(wrist, root), 1.0 / now);
    std::tuple<double, double, double> aside = plain_vectors::minus(
        bone,
        plain_vectors::scaled(before, plain_vectors::dot(bone, before))
    );
    // A straight arm has no side: it bends to one that goes with its bone.
    std::tuple<double, double, double> spare = plain_vectors::rotated(lang::at(pose->turned, arm->upper), side_of);
    spare = plain_vectors::minus(spare, plain_vectors::scaled(before, plain_vectors::dot(spare, before)));
    aside = plain_vectors::plus(
        aside,
        plain_vectors::scaled(spare, std::max(0.0, 0.01 * above_elbow - plain_vectors::length(aside)))
    );
    aside = plain_vectors::unit(plain_vectors::rotated(plain_vectors::between(before, ahead), aside));
    double along = (above_elbow * above_elbow + far * far - below_elbow * below_elbow) / (2.0 * far);
    double high = std::sqrt(std::max(0.0, above_elbow * above_elbow - along * along));
    std::tuple<double, double, double> knee = plain_vectors::plus(
        plain_vectors::scaled(ahead, along),
        plain_vectors::scaled(aside, high)
    );
    std::tuple<double, double, double, double> swing = plain_vectors::between(
        plain_vectors::unit(bone),
        plain_vectors::unit(knee)
    );
    std::tuple<double, double, double, double> fold = plain_vectors::between(
        plain_vectors::unit(plain_vectors::rotated(swing, fore)),
        plain_vectors::unit(plain_vectors::minus(plain_vectors::scaled(ahead, far), knee))
    );
    std::tuple<double, double, double, double> both = plain_vectors::times(fold, swing);
    std::tuple<double, double, double, double> above = contact_solve::_above(rig, pose, arm->upper);
    lang::at(pose->local, arm->upper) = plain_vectors::times(
        plain_vectors::back(above),
        plain_vectors::times(swing, lang::at(pose->turned, arm->upper))
    );
    above = plain_vectors::times(swing, contact_solve::_above(rig, pose, arm->lower));
    lang::at(pose->local, arm->lower) = plain_vectors::times(
        plain_vectors::back(above),
        plain_vectors::times(both, lang::at(pose->turned, arm->lower))
    );
    above = plain_vectors::times(both, contact_solve::_above(rig, pose, arm->hand));
    lang::at(pose->local, arm->hand) = plain_vectors::times(plain_vectors::back(above), hand);
    for (const auto& place : arm->below) {
        contact_solve::_join(rig, pose, place);
    }
}

inline std::tuple<double, double, double, double> _above(
    const Ref<ContactRig>& rig,
    const Ref<ContactPose>& pose,
    int place
) {
    int above = lang::at(rig->parents, place);
    return above < 0 ? std::tuple<double, double, double, double>{0.0, 0.0, 0.0, 1.0} : lang::at(pose->turned, above);
}

/// Push forearms and hands out of the capsules they are inside, by the smallest shift of the wrists; return whether any
/// was inside. held: how much a contact holds each hand, which is then not pushed.
///
/// An arm that passes through a capsule is pushed to one side before the middle and to the other side after it. The
/// push gets weaker towards the middle, so that the arm does not jump.
inline bool _guarded(
    const Ref<ContactRig>& rig,
    const Ref<ContactPose>& pose,
    const List<double>& held,
    double across
) {
    List<std::tuple<double, double, double, double>> local = pose->local;
    List<std::tuple<double, double, double, double>> turned = pose->turned;
    List<std::tuple<double, double, double>> at = pose->at;
    List<double> whole = List<double>{1.0, 1.0};
    bool moved = false;
    for (int number = 0; number < contact_solve::PASSES; number++) {
        List<std::tuple<double, double, double>> ends = contact_solve::capsule_ends(rig, pose);
        List<std::tuple<double, double, double, double>> balls = contact_solve::_balls(rig, ends);
        bool found = false;
        bool first = number == 0;
        List<std::tuple<double, double, double>> shifts;
        for (int side2 = 0; side2 < lang::len(rig->arms); side2++) {
            shifts.push_back(contact_solve::_shift(rig, ends, balls, side2, held, across, whole, first));
        }
        for (int side = 0; side < lang::len(shifts); side++) {
            const auto& shift = lang::at(shifts, side);
            if (plain_vectors::length(shift) > 0.0) {
                int hand = lang::at(rig->arms, side)->hand;
                contact_solve::bring(
                    rig,
                    pose,
                    side,
                    plain_vectors::plus(lang::at(pose->at, hand), shift),
                    lang::at(pose->turned, hand),
                    contact_solve::STRAIGHT
                );
                found = true;
            }
        }
        if (!found) {
            break;
        }
        moved = true;
    }
    if (moved && std::min(lang::at(whole, 0), lang::at(whole, 1)) < 1.0) {
        List<std::tuple<double, double, double>> goals;
        for (const auto& arm2 : rig->arms) {
            goals.push_back(lang::at(pose->at, arm2->hand));
        }
        pose->local = local;
        pose->turned = turned;
        pose->at = at;
        for (int side = 0; side < lang::len(rig->arms); side++) {
            const auto& arm = lang::at(rig->arms, side);
            std::tuple<double, double, double> way = plain_vectors::minus(
                lang::at(goals, side),
                lang::at(pose->at, arm->hand)
            );
            if (plain_vectors::length(way) > 0.0) {
                std::tuple<double, double, double> goal = plain_vectors::plus(
                    lang::at(pose->at, arm->hand),
                    plain_vectors::scaled(way, lang::at(whole, side))
                );
                contact_solve::bring(rig, pose, side, goal, lang::at(pose->turned, arm->hand), contact_solve::STRAIGHT);
            }
        }
    }
    return moved;
}

/// Return both ends of every capsule's line, one after the other.
inline List<std::tuple<double, double, double>> capsule_ends(const Ref<ContactRig>& rig, const Ref<ContactPose>& pose) {
    List<std::tuple<double, double, double>> out;
    for (const auto& capsule : rig->capsules) {
        out.push_back(plain_vectors::plus(
            lang::at(pose->at, capsule->joint),
            plain_vectors::rotated(lang::at(pose->turned, capsule->joint), capsule->a)
        ));
        out.push_back(plain_vectors::plus(
            lang::at(pose->at, capsule->to),
            plain_vectors::rotated(lang::at(pose->turned, capsule->to), capsule->b)
        ));
    }
    return out;
}

/// Return a ball round each capsule: its middle and radius.
inline List<std::tuple<double, double, double, double>> _balls(
    const Ref<ContactRig>& rig,
    const List<std::tuple<double, double, double>>& ends
) {
    List<std::tuple<double, double, double, double>> out;
    for (int n = 0; n < lang::len(rig->capsules); n++) {
        const auto& capsule = lang::at(rig->capsules, n);
        auto [ax, ay, az] = lang::at(ends, 2 * n);
        auto [bx, by, bz] = lang::at(ends, 2 * n + 1);
        double x = bx - ax;
        double y = by - ay;
        double z = bz - az;
        double size = 0.5 * std::sqrt(x * x + y * y + z * z) + capsule->radius;
        out.push_back(std::tuple<double, double, double, double>{ax + 0.5 * x, ay + 0.5 * y, az + 0.5 * z, size});
    }
    return out;
}

/// Return the shift of a wrist that brings its arm out of all other capsules, or closer to that. whole: for each side,
/// the share of the shift to apply, which the first pass finds.
inline std::tuple<double, double, double> _shift(
    const Ref<ContactRig>& rig,
    const List<std::tuple<double, double, double>>& ends,
    const List<std::tuple<double, double, double, double>>& balls,
    int side,
    const List<double>& held,
    double across,
    List<double>& whole,
    bool first
) {
    std::tuple<double, double, double> shift = std::tuple<double, double, double>{0.0, 0.0, 0.0};
    double own = 1.0 - lang::at(held, side);
    if (own <= 0.0) {
        return shift;
    }
    for (int i = 0; i < lang::len(rig->capsules); i++) {
        const auto& mine = lang::at(rig->capsules, i);
        if (mine->arm != side || mine->kind == contact_solve::OBSTACLE) {
            continue;
        }
        auto [mx, my, mz, size] = lang::at(balls, i);
        for (int k = 0; k < lang::len(balls); k++) {
            auto [ox, oy, oz, most] = lang::at(balls, k);
            double dx = ox - mx;
            double dy = oy - my;
            double dz = oz - mz;
            double reach = most + size;
            if (dx * dx + dy * dy + dz * dz >= reach * reach) {
                continue; // most are nowhere near
            }
            Ref<BodyCapsule> other = lang::at(rig->capsules, k);
            if (other->arm == side) {
                continue;
            }
            double share = own;
            if (other->arm >= 0) {
                share = std::min(own, 1.0 - across);
                if (other->kind != contact_solve::OBSTACLE) { // both give way
                    share = share * (1.0 - 0.5 * (1.0 - lang::at(held, other->arm)));
                }
            }
            if (share <= 0.0) {
                continue;
            }
            auto [x, y, z, gap] = contact_solve::apart(ends, 2 * i, 2 * k);
            double radii = mine->radius + other->radius;
            if (gap >= radii || gap < 1e-09) {
                continue;
            }
            double depth = radii - gap;
            double amount = depth > contact_solve::SOFT
                ? depth - 0.5 * contact_solve::SOFT
                : depth * depth / (2.0 * contact_solve::SOFT);
            // Near to the line it is not pushed all the way, and about it not at all.
            double inner = std::min(
                1.0,
                std::max(0.0, (gap / radii - contact_solve::THROUGH) / (contact_solve::FULL - contact_solve::THROUGH))
            );
            inner = inner * inner * (3.0 - 2.0 * inner);
            if (first) {
                lang::at(whole, side) = std::min(lang::at(whole, side), 1.0 - share * (1.0 - inner));
                inner = 1.0;
            }
            amount = amount * share * inner;
            double part = mine->kind == contact_solve::FOREARM ? contact_solve::_along(ends, 2 * i, 2 * k) : 1.0;
            std::tuple<double, double, double> way = std::tuple<double, double, double>{x / gap, y / gap, z / gap};
            double pushed = part * plain_vectors::dot(way, shift);
            if (pushed < 0.0) { // others push towards it: what hardly touches or hardly counts hardly resists
                pushed = pushed * share * std::min(1.0, depth / contact_solve::FIRM);
            }
            double left = amount - pushed;
            if (left > 0.0) {
                shift = plain_vectors::plus(
                    shift,
                    plain_vectors::scaled(way, left * part / (part * part + contact_solve::ELBOW * (1.0 - part)))
                );
            }
        }
    }
    return shift;
}

/// Return where on the line that begins at `ends[i]` the shortest way from the line at `ends[k]` ends, 0..1. For nearly
/// parallel lines, where it could end anywhere, the result moves towards the middle.
inline double _along(const List<std::tuple<double, double, double>>& ends, int i, int k) {
    std::tuple<double, double, double> a = lang::at(ends, i);
    std::tuple<double, double, double> c = lang::at(ends, k);
    std::tuple<double, double, double> u = plain_vectors::minus(lang::at(ends, i + 1), a);
    std::tuple<double, double, double> v = plain_vectors::minus(lang::at(ends, k + 1), c);
    std::tuple<double, double, double> w = plain_vectors::minus(a, c);
    double uu = plain_vectors::dot(u, u);
    double uv = plain_vectors::dot(u, v);
    double vv = plain_vectors::dot(v, v);
    double uw = plain_vectors::dot(u, w);
    double vw = plain_vectors::dot(v, w);
    if (uu <= 1e-12) {
        return 0.0;
    }
    double stiff = (1.0 + contact_solve::EVEN) * uu;
    double middle = 0.5 * contact_solve::EVEN * uu - uw;
    if (vv <= 1e-12) {
        return std::min(std::max(middle / stiff, 0.0), 1.0);
    }
    double s = std::min(std::max((vv * middle + uv * vw) / (stiff * vv - uv * uv), 0.0), 1.0);
    double t = (uv * s + vw) / vv;
    if (t < 0.0 || t > 1.0) {
        s = std::min(std::max((uv * std::min(std::max(t, 0.0), 1.0) + middle) / stiff, 0.0), 1.0);
    }
    return s;
}

/// Return the shortest way from the line that begins at `ends[k]` to the one at `ends[i]`, and its length. Its vectors
/// are written out, since a guarded pose asks some thirty times.
inline std::tuple<double, double, double, double> apart(
    const List<std::tuple<double, double, double>>& ends,
    int i,
    int k
) {
    auto [ax, ay, az] = lang::at(ends, i);
    auto [bx, by, bz] = lang::at(ends, i + 1);
    auto [cx, cy, cz] = lang::at(ends, k);
    auto [dx, dy, dz] = lang::at(ends, k + 1);
    double ux = bx - ax;
    double uy = by - ay;
    double uz = bz - az;
    double vx = dx - cx;
    double vy = dy - cy;
    double vz = dz - cz;
    double wx = ax - cx;
    double wy = ay - cy;
    double wz = az - cz;
    double uu = ux * ux + uy * uy + uz * uz;
    double uv = ux * vx + uy * vy + uz * vz;
    double vv = vx * vx + vy * vy + vz * vz;
    double uw = ux * wx + uy * wy + uz * wz;
    double vw = vx * wx + vy * wy + vz * wz;
    double s = 0.0;
    double t = 0.0;
    if (uu > 1e-12) {
        double below = uu * vv - uv * uv;
        if (below > 1e-09 * uu * vv) {
            s = std::min(std::max((uv * vw - vv * uw) / below, 0.0), 1.0);
        }
        if (vv > 1e-12) {
            t = (uv * s + vw) / vv;
            if (t < 0.0 || t > 1.0) {
                t = std::min(std::max(t, 0.0), 1.0);
                s = std::min(std::max((uv * t - uw) / uu, 0.0), 1.0);
            }
        } else {
            s = std::min(std::max(-uw / uu, 0.0), 1.0);
        }
    } else if (vv > 1e-12) {
        t = std::min(std::max(vw / vv, 0.0), 1.0);
    }
    double x = wx + ux * s - vx * t;
    double y = wy + uy * s - vy * t;
    double z = wz + uz * s - vz * t;
    return std::tuple<double, double, double, double>{x, y, z, std::sqrt(x * x + y * y + z * z)};
}

}  // namespace contact_solve

}  // namespace metagraph
