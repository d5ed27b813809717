// From the GLB's animations to what layers add to the base pose.
#pragma once

#include "glb.hpp"
#include "graph.hpp"

namespace metagraph {

/// A clip as it was read: every joint in every frame [F, J].
struct ReadClip {
    Ref<Motion> motion;
    List<List<Joined>> poses;
};

namespace clip {

inline constexpr double MOVED = 1e-7; // metres below which a translation is none

/// Return an animation's frames. nodes [J]: the GLB's node of each joint, -1 for none. rest [J]: where joints stay that it
/// does not move. morphs: names of the graph's morph targets, to which the clip's are added.
inline ReadClip read(
    const Glb& file, int animation, int frames, double fps, const List<int>& nodes, const List<Joined>& rest,
    List<std::string>& morphs
) {
    ReadClip out{lang::made<Motion>(), List<List<Joined>>(static_cast<std::size_t>(frames), rest)};
    out.motion->fps = fps;
    out.motion->frames = frames;
    for (const GlbTrack& track : file.tracks(animation)) {
        const List<float> values = glb::resample(track, frames, fps);
        if (track.path == "weights") {
            const List<std::string> names = file.morph_names(track.node);
            for (int n = 0; n < std::min(lang::len(names), track.width); n++) {
                if (!lang::contains(morphs, lang::at(names, n))) morphs.push_back(lang::at(names, n));
                MorphTrack own{lang::index(morphs, lang::at(names, n)), {}};
                for (int f = 0; f < frames; f++) own.weights.push_back(lang::at(values, f * track.width + n));
                out.motion->morphs.push_back(std::move(own));
            }
            continue;
        }
        const auto joint = static_cast<std::size_t>(lang::index(nodes, track.node));
        if (track.node < 0 || joint >= nodes.size()) continue;
        for (std::size_t f = 0; f < out.poses.size(); f++) {
            const float* v = &values[f * static_cast<std::size_t>(track.width)];
            if (track.path == "rotation") out.poses[f][joint].rotation = {v[0], v[1], v[2], v[3]};
            if (track.path == "translation") out.poses[f][joint].translation = {v[0], v[1], v[2]};
        }
    }
    return out;
}

/// Return a clip relative to the base pose, for the joints a layer reaches.
inline Ref<Offsets> offsets(const ReadClip& clip, const List<int>& reach, const List<Joined>& base) {
    auto out = lang::made<Offsets>();
    List<Quat> before(reach.size());
    for (const List<Joined>& pose : clip.poses) {
        for (std::size_t n = 0; n < reach.size(); n++) {
            const auto joint = static_cast<std::size_t>(reach[n]);
            Quat q = rotation::multiply(base[joint].rotation.back(), pose[joint].rotation);
            if (&pose != &clip.poses.front() && rotation::dot(q, before[n]) < 0) q = rotation::scaled(q, -1);
            before[n] = q;
            for (const double x : {q.x, q.y, q.z, q.w}) out->rotations.push_back(static_cast<float>(x));
        }
    }
    auto away = [&](const List<Joined>& pose, std::size_t n) {
        const auto joint = static_cast<std::size_t>(reach[n]);
        return pose[joint].translation - base[joint].translation;
    };
    for (std::size_t n = 0; n < reach.size(); n++) {
        bool moves = false;
        for (const List<Joined>& pose : clip.poses) {
            const Vec by = away(pose, n);
            moves = moves || std::max({std::abs(by.x), std::abs(by.y), std::abs(by.z)}) > MOVED;
        }
        if (moves) out->moved.push_back(static_cast<int>(n));
    }
    for (const List<Joined>& pose : clip.poses) {
        for (const int n : out->moved) {
            const Vec by = away(pose, static_cast<std::size_t>(n));
            for (const double x : {by.x, by.y, by.z}) out->translations.push_back(static_cast<float>(x));
        }
    }
    return out;
}

}  // namespace clip
}  // namespace metagraph
