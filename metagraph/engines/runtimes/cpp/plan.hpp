// What a character will do: a plan is a value, and planning on makes another.
#pragma once

#include "sampling.hpp"
#include "schedule.hpp"

namespace metagraph {

/// One layer's part. cues never overlap and ascend; rests ascend by fade_start, the first covering everything before. past:
/// what came before the first cue, where that was forgotten. cursor: where the model writes on. written: what it wrote for
/// later, as it wrote it.
struct LayerPlan {
    std::string layer;
    List<Ref<MetaAction>> metas;
    List<Ref<Cue>> cues;
    List<Ref<Rest>> rests;
    Ref<Past> past = lang::made<Past>();
    Ref<Cursor> cursor = lang::made<Cursor>();
    List<Ref<MetaAction>> written;
};

/// The specific actions of every layer from 0 to `end` seconds, and what became of requests that could not be met. track:
/// what was asked of the life layers; life: what they do.
struct Plan {
    std::uint32_t seed = 0;
    double end = 0.0;
    Map<std::string, Ref<const LayerPlan>> layers;
    List<Ref<Report>> reports;
    List<Ref<MetaRequest>> requests;
    Ref<const Track> track = lang::made<Track>();
    Ref<const Schedule> life = lang::made<Schedule>();

    /// A plan of nothing, up to 0 seconds.
    explicit Plan(std::uint32_t seed_ = 0) : seed(seed_) {
        for (const std::string& layer : graph::LAYERS) {
            auto own = lang::made<LayerPlan>();
            own->layer = layer;
            layers[layer] = own;
        }
    }
};

/// How planning goes: the stances layers begin in, by their ids, and whether the models fill the time nobody asks for.
struct PlanOptions {
    Map<std::string, std::string> stances;
    bool idle = true;
};

}  // namespace metagraph
