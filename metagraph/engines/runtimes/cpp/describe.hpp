// What may be asked of a character, as JSON.
#pragma once

#include "asks.hpp"
#include "repeating.hpp"

namespace metagraph {

namespace description {

inline Json action(const Action& action, const Phases& phases) {
    Json out = Json::object({
        {"id", action.id}, {"name", action.name}, {"kind", action.kind}, {"stance", action.stance},
        {"seconds", repeating::seconds_played(action.kind, action.timing, phases.start, phases.end)},
    });
    if (action.kind == "transition") out.set("to", Json::maybe(action.end_stance));
    if (action.limb != "both") out.set("limb", action.limb);
    if (!action.tags.empty()) out.set("tags", Json::texts(action.tags));
    return out;
}

}  // namespace description

/// Return what may be asked for: `project`, `words` (what `do` may be), `modes`, `joints` (name, parent, part), `layers`
/// (each `start`, `stances`, `actions` but loops of stances, `tags` with the number of their actions), `lines` (id, text),
/// `points` by name, metres, and, where there are any, `parameters`.
inline Json describe(const Graph& graph) {
    Json joints = Json::list(), layers = Json::object(), lines = Json::list(), points = Json::object();
    for (std::size_t n = 0; n < graph.joints.size(); n++) {
        const int parent = graph.parents[n];
        joints.items.push_back(Json::object({
            {"name", graph.joints[n]}, {"parent", parent < 0 ? Json() : Json(lang::at(graph.joints, parent))},
            {"part", graph.parts[n]},
        }));
    }
    for (const std::string& word : graph::LAYERS) {
        const MetaGraph& own = *graph.layer(word).graph;
        Json stances = Json::list(), actions = Json::list(), tags = Json::object();
        for (const auto& [id, stance] : own.stances) {
            stances.items.push_back(Json::object({{"id", id}, {"name", stance->name}}));
        }
        for (const auto& [id, action] : own.actions) {
            if (action->kind != "stance") actions.items.push_back(description::action(*action, *graph.project->phases.at(id)));
            for (const std::string& tag : action->tags) {
                const Json* count = tags.find(tag);
                tags.set(tag, count == nullptr ? 1.0 : count->number + 1);
            }
        }
        layers.set(word, Json::object({
            {"start", Json::maybe(own.start)}, {"stances", stances}, {"actions", actions}, {"tags", tags},
        }));
    }
    for (const std::string& id : lang::in_order(lang::keys(graph.lines))) {
        lines.items.push_back(Json::object({{"id", id}, {"text", graph.lines.at(id).text}}));
    }
    for (const auto& [name, at] : graph.points) points.set(name, Json::list({at.x, at.y, at.z}));
    Json out = Json::object({
        {"project", graph.name}, {"words", Json::texts(asks::all_words())}, {"modes", Json::texts(words::MODES)},
        {"joints", joints}, {"layers", layers}, {"lines", lines}, {"points", points},
    });
    if (!lang::keys(graph.parameters).empty()) out.set("parameters", parameters::describe(graph.parameters));
    return out;
}

}  // namespace metagraph
