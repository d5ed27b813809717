// What a character will do: a plan is a value, and planning on makes another.
#pragma once

#include "meta_plan.hpp"
#include "schedule.hpp"

namespace metagraph {

/// The specific actions of every layer from 0 to `end` seconds, and what became of requests that could not be met. track:
/// what was asked of the life layers; life: what they do.
struct Plan {
    std::uint32_t seed = 0;
    double end = 0.0;
    Map<std::string, Ref<LayerPlan>> layers; // values, as all the rest
    List<Ref<Report>> reports;
    List<Ref<MetaRequest>> requests;
    Ref<Track> track = lang::made<Track>();
    Ref<Schedule> life = lang::made<Schedule>();

    /// A plan of nothing, up to 0 seconds.
    explicit Plan(std::uint32_t seed_ = 0) : seed(seed_) {
        for (const std::string& layer : graph::LAYERS) layers[layer] = lang::made<LayerPlan>(layer);
    }
};

/// How planning goes: the stances layers begin in, by their ids, and whether the models fill the time nobody asks for.
struct PlanOptions {
    Map<std::string, std::string> stances;
    bool idle = true;
};

}  // namespace metagraph
