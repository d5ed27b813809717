// Hands that stay where they touch, and out of the body: what contacts and the guard make of a composed pose.
#pragma once

#include "contact_goals.hpp"
#include "graph.hpp"

namespace metagraph {

namespace contacts {

inline std::tuple<double, double, double> three(const Node& json) {
    const List<double> v = json.numbers(3);
    return {v[0], v[1], v[2]};
}

inline int place(const Node& json, int count) { return static_cast<int>(json.within(0, std::max(0, count - 1))); }

/// An action's contacts, as exported.
inline List<Ref<ContactSpan>> read(const Node& json) {
    List<Ref<ContactSpan>> out;
    for (const Node& one : json.items()) {
        List<Ref<ContactKey>> keys;
        for (const Node& row : one["keys"].items()) {
            const List<double> k = row.numbers(8);
            keys.push_back(lang::made<ContactKey>(k[0], std::make_tuple(k[1], k[2], k[3]), std::make_tuple(k[4], k[5], k[6], k[7])));
        }
        out.push_back(lang::made<ContactSpan>(
            one["hand"].text(), one["place"].text(), one["to"].text(), one["start"].number(), one["end"].number(), keys,
            one["ease_in"].number(), one["ease_out"].number()
        ));
    }
    return out;
}

/// A contact rig, as exported. names: of all joints.
inline Ref<ContactRig> read_rig(const Node& json, const List<std::string>& names) {
    List<int> joints, parents;
    for (const Node& one : json["joints"].items()) joints.push_back(place(one, lang::len(names)));
    const int count = lang::len(joints);
    for (const Node& one : json["parents"].items()) {
        parents.push_back(static_cast<int>(one.within(-1, std::max(-1, lang::len(parents) - 1))));
    }
    if (lang::len(parents) != count || count == 0) {
        json["parents"].wrong("should be one for each joint");
        return nullptr;
    }
    List<Ref<ContactArm>> arms;
    List<std::string> hands;
    for (const Node& one : json["arms"].items()) {
        List<int> three;
        for (const Node& each : one.items()) three.push_back(place(each, count));
        if (three.size() != 3) {
            one.wrong("should be three places");
            return nullptr;
        }
        List<int> below{three[0]};
        for (int n = three[0] + 1; n < count; n++) {
            if (lang::contains(below, lang::at(parents, n))) below.push_back(n);
        }
        arms.push_back(lang::made<ContactArm>(three[0], three[1], three[2], below));
        hands.push_back(lang::at(names, lang::at(joints, three[2])));
    }
    if (arms.size() != 2) {
        json["arms"].wrong("should be two");
        return nullptr;
    }
    List<Ref<BodyCapsule>> capsules;
    for (const Node& one : json["capsules"].items()) {
        capsules.push_back(lang::made<BodyCapsule>(
            place(one["joint"], count), three(one["a"]), place(one["to"], count), three(one["b"]), one["radius"].number(),
            static_cast<int>(one["arm"].within(-1, 1)), static_cast<int>(one["kind"].within(0, 2))
        ));
    }
    Map<std::string, int> places;
    for (int n = 0; n < count; n++) places[lang::at(names, lang::at(joints, n))] = n;
    return lang::made<ContactRig>(joints, parents, places, arms, hands, capsules, json["contacts"].flag(), json["guard"].flag());
}

/// Change a pose so that hands are at their goals, and out of the body.
inline void touch(const Ref<ContactRig>& rig, const List<Ref<HandGoal>>& goals, List<Joined>& pose) {
    if (goals.empty() && !rig->guard) return;
    auto found = lang::made<ContactPose>();
    for (const int joint : rig->joints) {
        const Joined& one = lang::at(pose, joint);
        found->local.push_back({one.rotation.x, one.rotation.y, one.rotation.z, one.rotation.w});
        found->moved.push_back({one.translation.x, one.translation.y, one.translation.z});
    }
    contact_solve::spread(rig, found);
    if (!contact_solve::solve_contacts(rig, found, goals)) return;
    for (const auto& arm : rig->arms) {
        for (const int at : {arm->upper, arm->lower, arm->hand}) {
            const auto [x, y, z, w] = lang::at(found->local, at);
            lang::at(pose, lang::at(rig->joints, at)).rotation = {x, y, z, w};
        }
    }
}

}  // namespace contacts
}  // namespace metagraph
