// What of a body breathes and looks, as the export's `rig` has it.
#pragma once

#include <array>

#include "life.hpp"
#include "rotation.hpp"

namespace metagraph {

/// An eye. at: its place in the head's space. left, up, ahead: its directions there. joint: -1 where it has none; then what
/// turns it to the left and up by a radian, and what its own rotation says about its pitch.
struct Eye {
    Vec at, left, up, ahead;
    int joint = -1;
    Vec turn_left, turn_up;
    Quat down;
};

/// A joint of the chain that turns with the gaze. place: in the chain. share: of a turn of the head.
struct Looker {
    int place = 0;
    double share = 0.0;
};

/// A shoulder that rises with the breath, or another joint that tightens. turn: rotation vector at the top of a breath; tense: at full
/// tension; closed: of arms kept close.
struct Shoulder {
    int joint = 0;
    Vec turn, tense, closed;
};

/// Part of a morph target that shows a value of the face: its place among `Face::SHOWN`, the target's among the graph's.
struct MorphShare {
    int value = 0, target = 0;
    double weight = 0.0;
};

/// joints [F]: those that shapes move. turns, shifts [C][F]: rotation vectors in the joints' own space and metres in their
/// parents', both at 1. follows [4]: how much each lid shuts for an eye that looks down by a radian. lids [4]: its joint, -1
/// for none. shut_by [4]: what a lid's own rotation says about how far it is shut.
struct Face {
    List<int> joints;
    List<List<Vec>> turns, shifts;
    List<double> follows;
    List<int> lids;
    List<Quat> shut_by;
    List<MorphShare> morphs;
};

/// Directions are the character's; metres, radians.
///
/// chain: joints from the root to the head. breath: axis (xyz) and angle (w) of each at the top of a breath.
/// bowed: angle of each in a bowed posture, thrust: in one that leans into it.
struct Body {
    Vec left, up, ahead;
    List<int> chain;
    List<Quat> breath;
    List<double> bowed, thrust;
    List<Shoulder> shoulders;
    List<Looker> lookers;
    int trunk = 0;
    Vec trunk_ahead, head_ahead, partner, eyes_at_rest;
    std::array<Eye, 2> eyes;
    Face face;
};

namespace body {

/// What morph targets stand for, in the order in which `Enlivener::morphs` works it out.
inline const List<std::string> SHOWN = [] {
    List<std::string> out = {"blink"};
    for (const char* side : {"left", "right"}) {
        for (const char* what : {"blink", "wide", "look_left", "look_right", "look_up", "look_down"}) {
            out.push_back(lang::text(what, "_", side));
        }
    }
    out.push_back("jaw_open");
    for (int n = 1; n < life::SHAPES; n++) out.push_back("viseme_" + lang::at(words::VISEMES, n));
    for (const char* what : {"smile", "frown", "brow_down", "brow_up", "brows", "cheeks"}) out.push_back(what);
    return out;
}();

inline Vec vector(const Node& json) {
    const List<double> v = json.numbers(3);
    return {v[0], v[1], v[2]};
}
inline Quat quaternion(const Node& json) {
    const List<double> q = json.numbers(4);
    return {q[0], q[1], q[2], q[3]};
}
/// A joint's place, or -1 where that may be.
inline int joint(const Node& json, int joints, int least) {
    const int found = json.count(-1);
    if (found >= least && found < joints) return found;
    json.wrong("is no joint");
    return std::max(0, least);
}

inline List<List<Vec>> shapes(const Node& json, std::size_t joints) {
    List<List<Vec>> out;
    for (const Node& row : json.items()) {
        List<Vec> own;
        for (const Node& one : row.items()) own.push_back(vector(one));
        if (own.size() != joints) row.wrong("should have a row for each joint of the face");
        own.resize(joints);
        out.push_back(own);
    }
    if (lang::len(out) != life::CHANNELS) json.wrong(lang::text("should have ", life::CHANNELS, " channels"));
    out.resize(life::CHANNELS, List<Vec>(joints));
    return out;
}

/// Return a face. morphs: names of the graph's morph targets, to which those of the face are added.
inline Face face(const Node& json, int joints, List<std::string>& morphs) {
    Face out;
    for (const Node& one : json["joints"].items()) out.joints.push_back(joint(one, joints, 0));
    for (const Node& one : json["lid_joints"].items()) out.lids.push_back(joint(one, joints, -1));
    out.turns = shapes(json["turns"], out.joints.size());
    out.shifts = shapes(json["shifts"], out.joints.size());
    out.follows = json["follows"].numbers(life::LIDS);
    for (const Node& one : json["shut_by"].items()) out.shut_by.push_back(quaternion(one));
    if (lang::len(out.lids) != life::LIDS || lang::len(out.shut_by) != life::LIDS) json.wrong("should have four lids");
    out.lids.resize(life::LIDS, -1);
    out.shut_by.resize(life::LIDS);
    for (const auto& [channel, targets] : json["morphs"].fields()) {
        for (const auto& [name, weight] : targets.fields()) {
            if (!lang::contains(morphs, name)) morphs.push_back(name);
            if (!lang::contains(SHOWN, channel)) continue;
            out.morphs.push_back({lang::index(SHOWN, channel), lang::index(morphs, name), weight.number()});
        }
    }
    return out;
}

inline Body read(const Node& json, int joints, List<std::string>& morphs) {
    Body out;
    out.left = vector(json["left"]);
    out.up = vector(json["up"]);
    out.ahead = vector(json["ahead"]);
    for (const Node& one : json["chain"].items()) out.chain.push_back(joint(one, joints, 0));
    for (const Node& one : json["breath"].items()) out.breath.push_back(quaternion(one));
    for (const Node& one : json["shoulders"].items()) {
        const Node tense = one.maybe("tense"), closed = one.maybe("closed");
        out.shoulders.push_back({joint(one["joint"], joints, 0), vector(one["turn"]), tense.empty() ? Vec{} : vector(tense),
            closed.empty() ? Vec{} : vector(closed)});
    }
    const int count = lang::len(out.chain);
    if (count == 0 || lang::len(out.breath) != count) json.wrong("should have a chain of joints, and a breath for each");
    out.breath.resize(out.chain.size());
    const Node bowed = json.maybe("bowed");
    if (!bowed.empty() && !bowed.items().empty()) out.bowed = bowed.numbers(count);
    out.bowed.resize(out.chain.size(), 0.0);
    const Node thrust = json.maybe("thrust");
    if (!thrust.empty() && !thrust.items().empty()) out.thrust = thrust.numbers(count);
    out.thrust.resize(out.chain.size(), 0.0);
    for (const Node& one : json["lookers"].items()) {
        out.lookers.push_back({one["place"].count(0, std::max(0, count - 1)), one["share"].number()});
    }
    out.trunk = json["trunk"].count(0, std::max(0, count - 1));
    out.trunk_ahead = vector(json["trunk_ahead"]);
    out.head_ahead = vector(json["head_ahead"]);
    out.partner = vector(json["partner"]);
    out.eyes_at_rest = vector(json["eyes_at_rest"]);
    const List<Node> eyes = json["eyes"].items();
    if (eyes.size() != 2) json.wrong("should have two eyes");
    for (std::size_t n = 0; n < 2 && n < eyes.size(); n++) {
        Eye& eye = out.eyes[n];
        eye.at = vector(eyes[n]["at"]);
        eye.left = vector(eyes[n]["left"]);
        eye.up = vector(eyes[n]["up"]);
        eye.ahead = vector(eyes[n]["ahead"]);
        eye.joint = joint(eyes[n]["joint"], joints, -1);
        eye.turn_left = vector(eyes[n]["turn_left"]);
        eye.turn_up = vector(eyes[n]["turn_up"]);
        eye.down = quaternion(eyes[n]["down"]);
    }
    out.face = face(json["face"], joints, morphs);
    return out;
}

}  // namespace body
}  // namespace metagraph
