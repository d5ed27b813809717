// What can be asked of a character, as JSON: `do` says which ask it is; docs/agents/requests.md describes all of them. Times are
// seconds, points metres in the character's space (Y up, the character looks along +Z).
#pragma once

#include "graph.hpp"
#include "meta_plan.hpp"
#include "mood.hpp"

namespace metagraph {

/// An ask with every field it may have, or why it cannot be read.
struct Ask {
    Json fields;
    std::string why;

    const Json& at(const std::string& name) const {
        static const Json none;
        const Json* found = fields.find(name);
        return found == nullptr ? none : *found;
    }
    std::string text(const std::string& name) const { return at(name).text; }
    std::optional<std::string> maybe_text(const std::string& name) const {
        return at(name).empty() ? std::nullopt : std::optional<std::string>(at(name).text);
    }
    std::optional<double> maybe_number(const std::string& name) const {
        return at(name).empty() ? std::nullopt : std::optional<double>(at(name).number);
    }
    List<std::string> texts(const std::string& name) const {
        List<std::string> out;
        for (const Json& one : at(name).items) out.push_back(one.text);
        return out;
    }
    int priority() const { return static_cast<int>(at("priority").number); }
};

namespace asks {

/// What may stand in a field, or "" for anything of that kind; what is said of all else.
using Check = std::string (*)(const Json&);

inline std::string ranged(const Json& value, double low, double high) {
    const bool fine = value.is(Json::Kind::number) && value.number >= low && value.number <= high;
    return fine ? "" : lang::text("should be a number from ", low, " to ", high);
}
inline std::string whole(const Json& value, double low, double high) {
    const bool fine = value.is(Json::Kind::number) && value.number == std::floor(value.number);
    return fine ? ranged(value, low, high) : "should be a whole number";
}
inline std::string sized(const Json& value, std::size_t low, std::size_t high) {
    const std::size_t size = json::code_points(value.text).size();
    const bool fine = value.is(Json::Kind::text) && size >= low && size <= high;
    return fine ? "" : lang::text("should be a text of ", low, " to ", high, " letters");
}
inline std::string one_of(const Json& value, const List<std::string>& words) {
    const bool fine = value.is(Json::Kind::text) && lang::contains(words, value.text);
    return fine ? "" : "should be one of " + lang::joined(words, ", ");
}
inline std::string tags(const Json& value) {
    bool fine = value.is(Json::Kind::list);
    for (const Json& tag : value.items) fine = fine && sized(tag, 0, 200).empty();
    return fine ? "" : "should be a list of texts";
}
inline std::string point(const Json& value) {
    bool fine = value.is(Json::Kind::list) && value.items.size() == 3;
    for (const Json& one : value.items) fine = fine && ranged(one, -1e6, 1e6).empty();
    return fine ? "" : "should be three numbers, metres";
}
inline std::string list(const Json& value, std::size_t most) {
    const bool fine = value.is(Json::Kind::list) && value.items.size() <= most;
    return fine ? "" : lang::text("should be a list of at most ", most, " entries");
}
inline std::string word_list(const Json& value) { return list(value, 4000); }
inline std::string viseme_list(const Json& value) { return list(value, 20000); }
inline std::string viseme_set(const Json& value) { return one_of(value, line_timing::SETS); }
inline std::string flag(const Json& value) { return value.is(Json::Kind::flag) ? "" : "should be true or false"; }
inline std::string id(const Json& value) { return sized(value, 0, 200); }
inline std::string name(const Json& value) { return sized(value, 1, 200); }
inline std::string words(const Json& value) { return sized(value, 0, 20000); }
inline std::string block(const Json& value) { return sized(value, 0, 200000); }
inline std::string seconds(const Json& value) { return ranged(value, 0, 1e6); }
inline std::string late(const Json& value) { return ranged(value, 0, 600); }
inline std::string hold(const Json& value) { return ranged(value, 0, 600); }
inline std::string share(const Json& value) { return ranged(value, 0, 1); }
inline std::string priority(const Json& value) { return whole(value, -1000, 1000); }
inline std::string layer(const Json& value) { return one_of(value, graph::LAYERS); }
inline std::string limb(const Json& value) { return one_of(value, graph::LIMBS); }
inline std::string mode(const Json& value) { return one_of(value, words::MODES); }
inline std::string place(const Json& value) {
    const std::string no_name = name(value);
    return no_name.empty() ? "" : point(value);
}
inline std::string feeling(const Json& value) {
    if (value.is(Json::Kind::text)) return one_of(value, lang::keys(mood::MOODS));
    bool fine = value.is(Json::Kind::list) && value.items.size() == 2;
    for (const Json& one : value.items) fine = fine && ranged(one, -1, 1).empty();
    return fine ? "" : "should be a mood's name, or valence and arousal";
}
inline std::string intensity(const Json& value) { return ranged(value, 0, 2); }
inline std::string line(const Json& value) {
    const std::string no_name = name(value);
    return no_name.empty() ? "" : whole(value, -1e15, 1e15);
}

/// A field: its name, its default (null may be said where it is the default), and what may stand there. must: it has none.
struct Field {
    const char* name;
    Json usual;
    Check check;
    bool must = false;
};

inline const List<Field>& common() {
    static const List<Field> out = {
        {"id", "", id}, {"at", Json(), seconds}, {"told", Json(), seconds}, {"priority", meta_plan::ASKED, priority},
    };
    return out;
}

/// Each ask's own fields, by what `do` says.
inline const Map<std::string, List<Field>>& fields() {
    static const Field layer_{"layer", "arms", layer}, any_layer{"layer", Json(), layer}, tags_{"tags", Json::list(), tags};
    static const Field limb_{"limb", Json(), limb}, duration{"duration", Json(), seconds}, stroke{"stroke", Json(), seconds};
    static const Field hold_{"hold", Json(), hold}, prepare{"prepare", true, flag}, resume{"resume", false, flag};
    static const Field late_{"late", Json(), late};
    static const Field mood_{"mood", Json(), feeling}, intensity_{"intensity", Json(), intensity};
    static const Map<std::string, List<Field>> out = {
        {"gesture", {layer_, tags_, limb_, duration, stroke, hold_, prepare, resume, late_, mood_, intensity_}},
        {"fidget", {layer_, tags_, limb_, duration, resume, late_, mood_, intensity_}},
        {"action", {{"action", Json(), name, true}, any_layer, duration, stroke, hold_, prepare, late_, mood_, intensity_}},
        {"stance", {{"stance", Json(), name, true}, any_layer, {"stay", false, flag}, late_}},
        {"change", {layer_, limb_, duration, late_}},
        {"nod", {tags_, late_, mood_, intensity_}},
        {"shake", {tags_, late_, mood_, intensity_}},
        {"look", {{"to", "user", place}, duration, {"amount", 1.0, share}, {"strict", false, flag}}},
        {"blink", {}},
        {"say",
         {{"line", Json(), line}, {"text", "", words}, duration, {"gestures", true, flag},
          {"words", Json::list(), word_list}, {"visemes", Json::list(), viseme_list},
          {"characters", Json::list(), viseme_list}, {"more", false, flag}, {"set", Json(), viseme_set}, mood_, intensity_}},
        {"mode", {{"mode", Json(), mode}}},
        {"mood", {mood_, intensity_, duration}},
        {"place", {{"name", Json(), name, true}, {"point", Json(), point, true}}},
        {"withdraw", {{"what", "", id}}},
        {"interrupt", {{"what", "", id}}},
        {"pause", {{"what", "", id}}},
        {"resume", {{"what", "", id}}},
        {"finish", {{"what", "", id}}},
        {"bml", {{"bml", Json(), block, true}}},
    };
    return out;
}

/// What `do` may be; blocks of BML are read by the desktop alone.
inline List<std::string> all_words() {
    List<std::string> out;
    for (const auto& one : fields()) {
        if (one.first != "bml") out.push_back(one.first);
    }
    return out;
}

/// Return the ask that plain data says.
inline Ask read(const Json& data) {
    if (!data.is(Json::Kind::object)) return {Json(), "a request should be an object"};
    const Json* word = data.find("do");
    const List<Field>* own = word != nullptr && word->is(Json::Kind::text) ? fields().find(word->text) : nullptr;
    if (own == nullptr) {
        return {Json(), "do: should be one of " + lang::joined(lang::keys(fields()), ", ")};
    }
    const List<Field> every = lang::together(common(), *own);
    for (const auto& given : data.fields) {
        const bool known = std::any_of(every.begin(), every.end(), [&given](const Field& f) { return given.first == f.name; });
        if (given.first != "do" && !known) return {Json(), given.first + ": '" + word->text + "' has no such field"};
    }
    Ask out{Json::object(), ""};
    out.fields.set("do", *word);
    for (const Field& field : every) {
        const Json* given = data.find(field.name);
        if (given == nullptr && field.must) return {Json(), lang::text(field.name, ": is missing")};
        const Json& value = given == nullptr ? field.usual : *given;
        const bool none = value.empty() && field.usual.empty() && !field.must;
        const std::string wrong = none ? "" : field.check(value);
        if (!wrong.empty()) return {Json(), lang::text(field.name, ": ", wrong)};
        out.fields.set(field.name, value);
    }
    return out;
}

}  // namespace asks
}  // namespace metagraph
