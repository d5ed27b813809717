// From asks at any level of abstraction to what the planner and the life layers work with (Borer et al., section 6,
// figure 5).
#pragma once

#include "asks.hpp"
#include "meaning.hpp"
#include "plan.hpp"
#include "told_timing.hpp"

namespace metagraph {
namespace understand {

inline Ref<Spot> spot(const Json& json) {
    if (json.empty()) return nullptr;
    if (json.is(Json::Kind::text)) return spots::named(json.text);
    return spots::point({json.items[0].number, json.items[1].number, json.items[2].number});
}

/// What a mood that is asked for tells, as far as it does. T: `PlainAsk` or `SaidLine`. json: a mood's name, or a pair.
template <class T>
void felt(const Ref<T>& out, const Json& json, const std::optional<double>& intensity) {
    out->intensity = intensity;
    if (json.empty()) return;
    if (json.is(Json::Kind::text)) {
        std::tie(out->valence, out->arousal) = mood::MOODS.at(json.text);
    } else {
        out->valence = json.items[0].number;
        out->arousal = json.items[1].number;
    }
}

/// An ask with every field that any has, or what is wrong with it.
struct Plain {
    Ref<PlainAsk> ask;
    std::string wrong;
};

Plain plain(const Graph& graph, const Ask& ask);

/// Return a line as it is said, or what is wrong with what it asks for.
inline std::pair<Ref<SaidLine>, std::string> said(const Graph& graph, const std::string& name, bool gestures) {
    const Line* line = graph.lines.find(name);
    if (line == nullptr) return {nullptr, ""};
    List<Ref<PlainAsk>> asks;
    for (const Json& data : gestures ? line->asks : List<Json>{}) {
        const Ask inner = asks::read(data);
        if (!inner.why.empty()) return {nullptr, "line '" + name + "' asks for what cannot be read: " + inner.why};
        asks.push_back(inner.text("do") == "say" ? lang::made<PlainAsk>("say") : plain(graph, inner).ask);
    }
    const Ref<Voice>* voice = graph.voices->known.find(name);
    const auto seconds = voice != nullptr ? std::optional<double>((*voice)->duration) : line->duration;
    const auto out = lang::made<SaidLine>(line->text, seconds, asks);
    felt(out, line->mood, line->intensity);
    return {out, ""};
}

inline Plain plain(const Graph& graph, const Ask& ask) {
    const auto out = lang::made<PlainAsk>(ask.text("do"));
    out->id = ask.text("id");
    out->at = ask.maybe_number("at");
    out->priority = ask.priority();
    out->layer = ask.maybe_text("layer");
    out->tags = ask.texts("tags");
    out->limb = ask.maybe_text("limb");
    out->duration = ask.maybe_number("duration");
    out->stroke = ask.maybe_number("stroke");
    out->hold = ask.maybe_number("hold");
    out->late = ask.maybe_number("late");
    felt(out, ask.at("mood"), ask.maybe_number("intensity"));
    out->prepare = ask.at("prepare").empty() || ask.at("prepare").flag;
    out->resume = ask.at("resume").flag;
    out->stay = ask.at("stay").flag;
    out->action = ask.text("action");
    out->stance = ask.text("stance");
    out->to = spot(ask.at("to"));
    out->amount = ask.at("amount").number;
    out->strict = ask.at("strict").flag;
    out->text = ask.text("text");
    out->mode = ask.maybe_text("mode");
    out->name = ask.text("name");
    for (const Json& one : ask.at("point").items) out->point.push_back(one.number);
    out->what = ask.text("what");
    out->more = ask.at("more").flag;
    if (out->do_ != "say") return {out, ""};
    const auto [timing, why] = told_timing::read(ask);
    if (!why.empty()) return {nullptr, why};
    out->timing = timing;
    out->gestures = ask.at("gestures").flag;
    const Json& line = ask.at("line");
    if (line.empty()) return {out, ""};
    out->line = line.is(Json::Kind::text) ? line.text : lang::fixed(line.number, 0);
    const auto [found, wrong] = said(graph, *out->line, out->gestures);
    out->said = found;
    return {out, wrong};
}

/// Return what asks mean. now: when those begin that do not say; soon: when it is said, for what is said. An ask that makes
/// several requests gives them ids of its own: `<id>`, `<id>.1`, `<id>.2`, ...
inline Ref<Meaning> understand(const Graph& graph, const List<Json>& asks, double now, double soon) {
    List<Ref<MetaGraph>> graphs;
    for (const std::string& layer : graph::LAYERS) graphs.push_back(graph.layer(layer).graph);
    const auto out = lang::made<Meaning>(graph.project, graphs, voice::alphabet());
    for (const Json& data : asks) {
        const Ask ask = asks::read(data);
        if (!ask.why.empty()) {
            const Json* id = data.find("id");
            out->refuse(id != nullptr && id->is(Json::Kind::text) ? id->text : "", ask.why, std::nullopt, now);
            continue;
        }
        const Plain found = plain(graph, ask);
        if (found.wrong.empty()) {
            meaning::understood(out, found.ask, now, soon);
        } else {
            out->refuse(ask.text("id"), found.wrong, ask.maybe_text("layer"), ask.maybe_number("at").value_or(now));
        }
    }
    for (const auto& block : out->blocks) {
        out->refuse(
            block->id, "a runtime does not read BML: send it through Metagraph, or ask for what it says", std::nullopt, block->at
        );
    }
    return out;
}

}  // namespace understand
}  // namespace metagraph
