// Hips, spine and legs that answer the arms, and feet that stay planted: what an export says of them, and what comes of it in a pose.
#pragma once

#include "contacts.hpp"
#include "graph.hpp"

namespace metagraph {

namespace weight {

inline constexpr std::size_t KEPT = 4096; // times that are remembered of a plan

/// A weight rig, as exported. joints: how many there are.
inline Ref<WeightRig> read_rig(const Node& json, int count_of_joints) {
    List<int> joints, parents;
    for (const Node& one : json["joints"].items()) joints.push_back(contacts::place(one, count_of_joints));
    const int count = lang::len(joints);
    for (const Node& one : json["parents"].items()) {
        parents.push_back(static_cast<int>(one.within(-1, std::max(-1, lang::len(parents) - 1))));
    }
    if (lang::len(parents) != count || count == 0) {
        json["parents"].wrong("should be one for each joint");
        return nullptr;
    }
    List<Ref<ContactArm>> legs;
    for (const Node& one : json["legs"].items()) {
        List<int> three;
        for (const Node& each : one.items()) three.push_back(contacts::place(each, count));
        if (three.size() != 3) {
            one.wrong("should be three places");
            return nullptr;
        }
        List<int> below{three[0]};
        for (int n = three[0] + 1; n < count; n++) {
            if (lang::contains(below, lang::at(parents, n))) below.push_back(n);
        }
        legs.push_back(lang::made<ContactArm>(three[0], three[1], three[2], below));
    }
    List<std::string> hands;
    for (const Node& one : json["hands"].items()) hands.push_back(one.text());
    List<Ref<WeightBend>> bends;
    for (const Node& one : json["bends"].items()) {
        bends.push_back(lang::made<WeightBend>(
            contacts::place(one["place"], count), contacts::three(one["left"]), contacts::three(one["up"]),
            contacts::three(one["ahead"]), one["share"].number()
        ));
    }
    List<Ref<WeightCollar>> collars;
    for (const Node& one : json["collars"].items()) {
        collars.push_back(lang::made<WeightCollar>(
            contacts::place(one["place"], count), contacts::place(one["upper"], count), contacts::three(one["axis"]),
            static_cast<int>(one["side"].within(0, 1))
        ));
    }
    List<std::tuple<double, double, double>> knees;
    for (const Node& one : json["knees"].items()) knees.push_back(contacts::three(one));
    List<std::tuple<double, double>> levers;
    for (const Node& one : json["levers"].items()) {
        const List<double> two = one.numbers(2);
        levers.push_back({two[0], two[1]});
    }
    if (legs.size() != 2 || hands.size() != 2 || knees.size() != 2 || levers.size() != 2 || bends.empty()) {
        json.wrong("should have two legs, hands, knees and levers, and hips");
        return nullptr;
    }
    const auto body = lang::made<ContactRig>(
        joints, parents, Map<std::string, int>(), legs, hands, List<Ref<BodyCapsule>>(), false, false
    );
    return lang::made<WeightRig>(
        body, bends, collars, knees, levers, contacts::three(json["up"]), json["height"].number(), json["strength"].within(0, 1)
    );
}

/// What the actions of arms and body weigh, by action.
inline Map<std::string, Ref<ArmTrack>> read_tracks(const Graph& graph, const Node& clips) {
    Map<std::string, List<List<double>>> rows;
    for (const Node& one : clips.items()) {
        const Node arms = one.maybe("arms");
        List<List<double>>& own = rows[one["id"].text()];
        if (arms.empty()) continue;
        for (const Node& row : arms.items()) own.push_back(row.numbers(follow_through::NUMBERS));
    }
    Map<std::string, Ref<ArmTrack>> out;
    for (const char* layer : {"arms", "body"}) {
        for (const auto& [id, action] : graph.layer(layer).graph->actions) out[id] = lang::made<ArmTrack>(action->clip, rows[action->clip]);
    }
    return out;
}

/// Where the feet of the actions are of the layer that moves the legs, by action.
inline Map<std::string, Ref<FootTrack>> read_feet(const Graph& graph, const Node& clips) {
    Map<std::string, List<List<double>>> rows;
    for (const Node& one : clips.items()) {
        const Node feet = one.maybe("feet");
        List<List<double>>& own = rows[one["id"].text()];
        if (feet.empty()) continue;
        for (const Node& row : feet.items()) own.push_back(row.numbers(2 * planted_feet::FOOT_NUMBERS));
    }
    Map<std::string, Ref<FootTrack>> out;
    for (const auto& [id, action] : graph.layer(graph.feet_layer).graph->actions) out[id] = lang::made<FootTrack>(rows[action->clip]);
    return out;
}

/// Change a pose as its feet stay planted, and as the body answers its arms. feet: where they should be, if anywhere; drive: what
/// moves the body, if anything; planted, follow, lift: the dials.
inline void answer(
    const Ref<WeightRig>& rig, const List<Ref<FootGoal>>& feet, const List<double>& drive, double planted, double follow, double lift,
    List<Joined>& pose
) {
    auto found = lang::made<ContactPose>();
    for (const int joint : rig->body->joints) {
        const Joined& one = lang::at(pose, joint);
        found->local.push_back({one.rotation.x, one.rotation.y, one.rotation.z, one.rotation.w});
        found->moved.push_back({one.translation.x, one.translation.y, one.translation.z});
    }
    bool moved = feet_solve::plant_feet(rig, found, feet, planted);
    if (!drive.empty() && weight_solve::answer_arms(rig, found, drive, follow, lift)) moved = true;
    if (!moved) return;
    for (int place = 0; place < lang::len(found->local); place++) {
        const auto [x, y, z, w] = lang::at(found->local, place);
        lang::at(pose, lang::at(rig->body->joints, place)).rotation = {x, y, z, w};
    }
    const int hips = lang::at(rig->bends, 0)->place;
    const auto [x, y, z] = lang::at(found->moved, hips);
    lang::at(pose, lang::at(rig->body->joints, hips)).translation = {x, y, z};
}

}  // namespace weight
}  // namespace metagraph
