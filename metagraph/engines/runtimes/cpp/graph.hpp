// The exported graph and its clips, loaded once and shared by all characters that use it; nothing of it changes then.
#pragma once

#include "body.hpp"
#include "contact_solve.hpp"
#include "follow_through.hpp"
#include "parameters.hpp"
#include "planted_feet.hpp"
#include "project.hpp"
#include "voice.hpp"
#include "weight_solve.hpp"

namespace metagraph {

/// The weights of one morph target in a clip, a frame each. place: among the graph's.
struct MorphTrack {
    int place = 0;
    List<float> weights;
};

/// A clip as far as it is played. morphs: what it moves of a mesh.
struct Motion {
    double fps = 30.0;
    int frames = 1;
    List<MorphTrack> morphs;
};

/// A clip relative to the base pose, for the joints a layer reaches: rotations [F, n, 4], neighbours on the same side;
/// translations [F, m, 3], metres, for the places `moved` [m] in the reach.
struct Offsets {
    List<float> rotations, translations;
    List<int> moved;
};

/// An action with what it shows. motion, offsets: none where its clip is missing. partly: places in the layer's reach of
/// joints that it does not move wholly, and how far it does, 0..1.
struct PlacedAction : Action {
    explicit PlacedAction(Action action) : Action(std::move(action)) {}

    Ref<Motion> motion;
    Ref<Offsets> offsets;
    List<std::pair<int, double>> partly;
};

/// How a layer reaches the joints: their places [n], and its weights on them. strength: how much of the arms it moves, 0..1.
/// kinds: of its actions.
struct LayerGraph {
    Ref<MetaGraph> graph;
    Ref<Markov> markov;
    List<int> reach;
    List<double> weights;
    double strength = 0.0;
    Set<std::string> kinds;
};

/// A line of dialogue. asks: what it asks for while it is said. mood, intensity: what it is said in, if that is told.
struct Line {
    std::string text;
    std::optional<double> duration;
    List<Json> asks;
    Json mood;
    std::optional<double> intensity;
};

/// Everything of an export that planning and posing need. Joints are told by their places, parents first.
///
/// base: the pose that offsets are taken against, local. morphs: names of all morph targets that anything moves.
/// problems: what the GLB lacks, in words; the rest plays all the same. project: what the planner works with.
struct Graph {
    std::string name;
    List<std::string> joints, parts, sides, problems, morphs;
    List<char> larger, smaller; // which joints turn farther, and which less far, where a cue is played larger or smaller than made
    List<int> parents;
    List<Joined> base;
    Ref<Project> project;
    std::uint32_t seed = 0;
    Map<std::string, Ref<LayerGraph>> layers;
    Ref<Life> life = lang::made<Life>();
    Map<std::string, Vec> points;
    Map<std::string, Line> lines;
    Map<std::string, Parameter> parameters; // what games set, by name
    Ref<Voices> voices = lang::made<Voices>();
    std::optional<Body> body;
    Ref<ContactRig> contact_rig;
    Ref<WeightRig> weight_rig;
    Map<std::string, Ref<ArmTrack>> arm_tracks;
    Map<std::string, Ref<FootTrack>> foot_tracks;
    std::string feet_layer = "body"; // it moves the legs

    const LayerGraph& layer(const std::string& word) const { return *layers.at(word); }
};

namespace graph {

using words::LAYERS;
inline const List<std::string> KINDS = {"stance", "gesture", "fidget", "transition"};
inline const List<std::string> LIMBS = {"left", "right", "both"};

}  // namespace graph
}  // namespace metagraph
