// From asks at any level of abstraction to what the planner and the life layers work with (Borer et al., section 6,
// figure 5).
#pragma once

#include "asks.hpp"
#include "plan.hpp"
#include "told_timing.hpp"

namespace metagraph {

/// What asks mean. requests: for the layers. items: for the track. withdrawn: ids taken back; every id where it holds "".
/// refused: reports of what could not be understood.
struct Meaning {
    List<Ref<MetaRequest>> requests;
    Items items;
    Set<std::string> withdrawn;
    List<Ref<Report>> refused;
};

namespace understand {

inline constexpr double FOREVER = 1e9; // seconds; a look that lasts until the next

inline std::string lowered(std::string text) {
    for (char& c : text) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    return text;
}

/// Works out what asks of one moment mean. now: when those begin that do not say.
class Reader {
public:
    Meaning out;

    Reader(const Graph& graph, double now) : graph_(graph), now_(now) {}

    void read(const Json& data) {
        const Ask ask = asks::read(data);
        if (!ask.why.empty()) {
            const Json* id = data.find("id");
            return refuse(id != nullptr && id->is(Json::Kind::text) ? id->text : "", ask.why, now_, "arms");
        }
        Meaning meant;
        const double at = ask.maybe_number("at").value_or(now_);
        const std::string layer = ask.maybe_text("layer").value_or("arms"), why = meaning(ask, at, meant);
        lang::extend(out.refused, meant.refused);
        if (!why.empty()) return refuse(ask.text("id"), why, at, layer);
        lang::extend(out.requests, meant.requests);
        lang::extend(out.items, meant.items);
        out.withdrawn.insert(meant.withdrawn.begin(), meant.withdrawn.end());
    }

private:
    const Graph& graph_;
    double now_;

    void refuse(const std::string& id, const std::string& why, double at, const std::string& layer) {
        out.refused.push_back(lang::made<Report>(id, "not-understood", why, layer, at));
    }

    /// Return a request of an ask, with all that it says of how it is played.
    static Ref<MetaRequest> request(const Ask& ask, const std::string& layer, const std::string& kind, double start) {
        auto made = lang::made<MetaRequest>(ask.text("id"), layer, kind, start);
        made->priority = ask.priority();
        made->duration = ask.maybe_number("duration");
        made->tags = ask.texts("tags");
        made->limb = ask.maybe_text("limb");
        made->stroke = ask.maybe_number("stroke");
        made->hold = ask.maybe_number("hold");
        made->late = ask.maybe_number("late");
        made->prepare = ask.at("prepare").empty() || ask.at("prepare").flag;
        made->resume = ask.at("resume").flag;
        return made;
    }

    static Ref<Item> item(const Ask& ask, Item::Kind kind, double start) {
        auto made = lang::made<Item>();
        made->kind = kind;
        made->id = ask.text("id");
        made->start = start;
        made->end = start;
        made->priority = ask.priority();
        return made;
    }

    /// Add what one ask means; return why it can mean nothing.
    std::string meaning(const Ask& ask, double at, Meaning& meant) {
        const std::string word = ask.text("do");
        if (word == "gesture" || word == "fidget") {
            const std::string layer = ask.text("layer");
            const auto stroke = ask.maybe_number("stroke");
            const double start = stroke.has_value() ? std::max(0.0, *stroke - longest_lead(layer, ask.texts("tags"))) : at;
            meant.requests.push_back(request(ask, layer, word, start));
        } else if (word == "action") {
            const Ref<Action> action = find_action(ask);
            if (action == nullptr) return "there is no action '" + ask.text("action") + "'" + in_layer(ask);
            const auto stroke = ask.maybe_number("stroke");
            const double start = stroke.has_value() ? std::max(0.0, *stroke - lead(*action)) : at;
            auto made = request(ask, action->layer, action->kind, start);
            made->action = action->id;
            meant.requests.push_back(made);
        } else if (word == "stance") {
            const auto [layer, stance] = find_stance(ask);
            if (layer.empty()) return "there is no stance '" + ask.text("stance") + "'" + in_layer(ask);
            auto made = request(ask, layer, "transition", at);
            made->stance = stance;
            meant.requests.push_back(made);
            auto stay = item(ask, Item::stay, at);
            stay->layer = layer;
            stay->on = ask.at("stay").flag;
            stay->end = INFINITY;
            meant.items.push_back(stay);
        } else if (word == "change") { // whichever arm was seen to move: stances are joined by few transitions, mostly of both
            auto made = request(ask, ask.text("layer"), "transition", at);
            made->limb.reset();
            made->duration.reset();
            meant.requests.push_back(made);
        } else if (word == "nod" || word == "shake") {
            auto made = request(ask, "head", "gesture", at);
            if (!head_gesture(word, *made)) {
                const List<std::string> tags = lang::together(List<std::string>{word}, ask.texts("tags"));
                return "the head layer has no gesture tagged or called '" + lang::joined(tags, "', '") + "'";
            }
            meant.requests.push_back(made);
        } else if (word == "look") {
            auto look = item(ask, Item::look, at);
            const auto duration = ask.maybe_number("duration");
            look->end = duration.has_value() ? at + *duration : FOREVER;
            look->to = spot(ask.at("to"));
            look->amount = ask.at("amount").number;
            look->strict = ask.at("strict").flag;
            meant.items.push_back(look);
        } else if (word == "blink") {
            meant.items.push_back(item(ask, Item::blink, at));
        } else if (word == "mode") {
            auto mode = item(ask, Item::mode_from, at);
            mode->mode = ask.maybe_text("mode");
            meant.items.push_back(mode);
        } else if (word == "place") {
            auto place = item(ask, Item::place, at);
            place->name = ask.text("name");
            place->to = spot(ask.at("point"));
            meant.items.push_back(place);
        } else if (word == "withdraw") {
            meant.withdrawn.insert(ask.text("what"));
        } else if (word == "say") {
            return said(ask, at, meant);
        } else {
            return "a runtime does not read BML: send it through Metagraph, or ask for what it says";
        }
        return "";
    }

    static Spot spot(const Json& json) {
        if (json.is(Json::Kind::text)) return {json.text, {}};
        return {"", Vec{json.items[0].number, json.items[1].number, json.items[2].number}};
    }

    /// Add the speech of a `say` and what its line asks for while it is said.
    std::string said(const Ask& ask, double at, Meaning& meant) {
        const Json& given = ask.at("line");
        std::optional<std::string> name;
        if (!given.empty()) name = given.is(Json::Kind::text) ? given.text : lang::fixed(given.number, 0);
        const Line* line = name.has_value() ? graph_.lines.find(*name) : nullptr;
        if (name.has_value() && line == nullptr) return "there is no line '" + *name + "'";
        const auto [timing, why] = told_timing::read(ask);
        if (!why.empty()) return why;
        const std::string told = timing == nullptr ? "" : line_timing::told_text(timing);
        const std::string text = !ask.text("text").empty() ? ask.text("text") : line != nullptr ? line->text : told;
        if (line == nullptr && text.empty() && timing == nullptr) {
            return "say what: a line's id, text, or words with their times";
        }
        auto speech = item(ask, Item::speech, at);
        speech->line = name;
        speech->text = text;
        speech->timing = timing;
        if (timing != nullptr) {
            speech->end = at + line_timing::timed_seconds(timing, ask.maybe_number("duration"));
            speech->voice = voice::from_timing(timing, speech->end - speech->start);
        } else {
            speech->end = at + spoken_seconds(ask, name, line, text);
            const bool heard = name.has_value() && graph_.voices.find(*name) != nullptr;
            if (!heard) speech->voice = voice::from_text(text, speech->end - speech->start);
        }
        meant.items.push_back(speech);
        if (line == nullptr || !ask.at("gestures").flag) return "";
        for (int n = 0; n < lang::len(line->asks); n++) {
            const std::string id = lang::text(ask.text("id"), ".", n + 1);
            Ask inner = asks::read(lang::at(line->asks, n));
            if (!inner.why.empty()) return "line '" + *name + "' asks for what cannot be read: " + inner.why;
            if (inner.text("do") == "say") return "line '" + *name + "' would say another line; its asks may not";
            const double begins = at + inner.maybe_number("at").value_or(0);
            if (inner.text("do") == "bml") { // the rest of the line is said all the same
                refuse(id, "a runtime does not read BML", at, ask.maybe_text("layer").value_or("arms"));
                continue;
            }
            inner.fields.set("id", id);
            inner.fields.set("at", begins);
            inner.fields.set("priority", std::max(inner.priority(), ask.priority()));
            const auto stroke = inner.maybe_number("stroke");
            if (stroke.has_value()) inner.fields.set("stroke", at + *stroke);
            const std::string why = meaning(inner, begins, meant);
            if (!why.empty()) return why;
        }
        return "";
    }

    /// Return how long something takes to say: as asked, as its sound, as the line says, or as its text is long.
    double spoken_seconds(const Ask& ask, const std::optional<std::string>& name, const Line* line, const std::string& text) {
        const auto asked = ask.maybe_number("duration");
        if (asked.has_value()) return *asked;
        const Ref<Voice>* voice = name.has_value() ? graph_.voices.find(*name) : nullptr;
        if (voice != nullptr) return (*voice)->duration;
        if (line != nullptr && line->duration.has_value()) return *line->duration;
        return graphemes::read_aloud(voice::alphabet(), text);
    }

    /// Nods are gestures tagged so; where none is, one of those called so. Return whether there is any.
    bool head_gesture(const std::string& word, MetaRequest& made) const {
        for (const auto& [id, action] : graph_.layer("head").graph->actions) {
            if (action->kind != "gesture" || !tagged(*action, made.tags)) continue;
            if (lang::contains(action->tags, word)) {
                made.tags.insert(made.tags.begin(), word);
                made.among.clear();
                return true;
            }
            if (lang::contains(lowered(action->name), word)) made.among.push_back(id);
        }
        made.tags.clear();
        return !made.among.empty();
    }

    static bool tagged(const Action& action, const List<std::string>& tags) {
        return std::all_of(tags.begin(), tags.end(), [&action](const auto& tag) { return lang::contains(action.tags, tag); });
    }

    /// Return the seconds from an action's start to its stroke.
    double lead(const Action& action) const {
        const Phases& phases = *graph_.project->phases.at(action.id);
        return phases.stroke - phases.start;
    }

    /// Return how long before its stroke any gesture with these tags begins.
    double longest_lead(const std::string& layer, const List<std::string>& tags) const {
        double longest = 0;
        for (const auto& [_, action] : graph_.layer(layer).graph->actions) {
            if (action->kind == "gesture" && tagged(*action, tags)) longest = std::max(longest, lead(*action));
        }
        return longest;
    }

    static std::string in_layer(const Ask& ask) {
        const auto layer = ask.maybe_text("layer");
        return layer.has_value() ? " in the " + *layer + " layer" : "";
    }

    /// Return the action of an id or, failing that, a name; of several of one name the likeliest.
    Ref<Action> find_action(const Ask& ask) const {
        const std::string word = ask.text("action");
        Ref<Action> called;
        for (const std::string& layer : graph::LAYERS) {
            if (ask.maybe_text("layer").value_or(layer) != layer) continue;
            const auto& actions = graph_.layer(layer).graph->actions;
            const Ref<Action>* found = actions.find(word);
            if (found != nullptr) return *found;
        }
        for (const std::string& layer : graph::LAYERS) {
            if (ask.maybe_text("layer").value_or(layer) != layer) continue;
            for (const auto& [_, action] : graph_.layer(layer).graph->actions) {
                if (action->name == word && (called == nullptr || action->likelihood > called->likelihood)) called = action;
            }
        }
        return called;
    }

    /// Return layer and id of a stance from its id or name; "" where there is none.
    std::pair<std::string, std::string> find_stance(const Ask& ask) const {
        const std::string word = ask.text("stance");
        for (const std::string& layer : graph::LAYERS) {
            if (ask.maybe_text("layer").value_or(layer) != layer) continue;
            const auto& stances = graph_.layer(layer).graph->stances;
            if (stances.find(word) != nullptr) return {layer, word};
            for (const auto& [id, stance] : stances) {
                if (stance->name == word) return {layer, id};
            }
        }
        return {"", ""};
    }
};

/// Return what asks mean. An ask that makes several requests gives them ids of its own: `<id>`, `<id>.1`, `<id>.2`, ...
inline Meaning understand(const Graph& graph, const List<Json>& asks, double now) {
    Reader reader(graph, now);
    for (const Json& ask : asks) reader.read(ask);
    return reader.out;
}

}  // namespace understand
}  // namespace metagraph
