// Parameters: the named values that a game sets without knowing any clip, stance or graph. Each is a typed name for a request: to set it
// asks for that, with one field filled in.
#pragma once

#include "node.hpp"

namespace metagraph {

/// type: number, boolean, enum, list, point or trigger. request, field: what setting it asks for, and which field its value goes into.
/// choices: words and what they put there; of a boolean for off, then for on. beside: parameters that fill other fields of the same; replaces:
/// those that are bound to the same.
struct Parameter {
    std::string type, field, about;
    Json request, initial;
    List<std::pair<std::string, Json>> choices;
    double least = 0.0, most = 1.0;
    List<std::string> beside, replaces;

    List<std::string> names() const {
        List<std::string> out;
        for (const auto& choice : choices) out.push_back(choice.first);
        return out;
    }

    /// What a value puts into the request's field.
    Json filled(const Json& value) const {
        if (type == "boolean") return choices[value.flag ? 1 : 0].second;
        if (type == "list") {
            Json out = Json::list();
            for (const auto& choice : choices) {
                for (const Json& one : value.items) {
                    if (one.text == choice.first) out.items.push_back(choice.second);
                }
            }
            return out;
        }
        if (type != "enum") return value;
        for (const auto& choice : choices) {
            if (choice.first == value.text) return choice.second;
        }
        return Json();
    }

    /// A value as it is kept; `wrong` says what is wrong with it, "" where nothing is.
    Json kept(const Json& value, std::string& wrong) const {
        wrong.clear();
        if (type == "trigger") {
            if (!value.empty()) wrong = "a trigger has none";
            return Json();
        }
        if (type == "number") {
            if (!value.is(Json::Kind::number) || std::isnan(value.number)) wrong = "should be a number";
            return Json(std::min(std::max(value.number, least), most));
        }
        if (type == "boolean") {
            if (!value.is(Json::Kind::flag)) wrong = "should be true or false";
            return value;
        }
        if (type == "enum") {
            if (!value.is(Json::Kind::text) || !lang::contains(names(), value.text)) wrong = "should be one of " + lang::joined(names(), ", ");
            return value;
        }
        if (type == "list") {
            bool fine = value.is(Json::Kind::list);
            List<std::string> given;
            for (const Json& one : value.items) {
                fine = fine && one.is(Json::Kind::text) && lang::contains(names(), one.text);
                given.push_back(one.text);
            }
            if (!fine) wrong = "should be a list of " + lang::joined(names(), ", ");
            Json out = Json::list();
            for (const std::string& name : names()) {
                if (lang::contains(given, name)) out.items.push_back(name);
            }
            return out;
        }
        bool fine = value.is(Json::Kind::list) && value.items.size() == 3;
        for (const Json& one : value.items) fine = fine && one.is(Json::Kind::number) && std::abs(one.number) <= 1e6;
        if (!fine) wrong = "should be three numbers, metres";
        return value;
    }
};

namespace parameters {

inline const List<std::string> TYPES = {"number", "boolean", "enum", "list", "point", "trigger"};

inline Parameter read(const Node& json) {
    Parameter out;
    out.type = json["type"].one_of(TYPES);
    const Node field = json.maybe("field"), about = json.maybe("about"), choices = json.maybe("choices"), beside = json.maybe("beside");
    const Node replaces = json.maybe("replaces");
    out.field = field.empty() ? "" : field.text();
    out.about = about.empty() ? "" : about.text();
    out.request = json["request"].value();
    out.initial = json.maybe("initial").value();
    out.least = json.maybe("least").within_or(-1e15, 1e15, 0.0);
    out.most = json.maybe("most").within_or(-1e15, 1e15, 1.0);
    if (!choices.empty()) {
        for (const Node& one : choices.items()) out.choices.emplace_back(one["name"].text(), one["value"].value());
    }
    if (!beside.empty()) out.beside = beside.texts();
    if (!replaces.empty()) out.replaces = replaces.texts();
    if (out.type == "boolean" && out.choices.size() != 2) json.wrong("should have two choices");
    return out;
}

inline Json describe(const Map<std::string, Parameter>& every) {
    Json out = Json::object();
    for (const auto& [name, one] : every) {
        Json told = Json::object({{"type", one.type}, {"about", one.about}});
        if (one.type != "trigger") told.set("initial", one.initial);
        if (one.type == "number") {
            told.set("least", one.least);
            told.set("most", one.most);
        }
        if (one.type == "enum" || one.type == "list") told.set("choices", Json::texts(one.names()));
        out.set(name, told);
    }
    return out;
}

/// Whether two values that parameters keep are the same.
inline bool same(const Json& a, const Json& b) {
    if (a.kind != b.kind || a.flag != b.flag || a.number != b.number || a.text != b.text || a.items.size() != b.items.size()) return false;
    for (std::size_t n = 0; n < a.items.size(); n++) {
        if (!same(a.items[n], b.items[n])) return false;
    }
    return true;
}

}  // namespace parameters

/// The values that a character's parameters were set to. made: the ids of their latest requests.
struct ParameterValues {
    Json set = Json::object();
    Map<std::string, std::string> made;

    /// The value of a parameter; nothing for a trigger, and where there is none of that name.
    Json get(const Map<std::string, Parameter>& parameters, const std::string& name) const {
        const Parameter* one = parameters.find(name);
        const Json* value = set.find(name);
        return one == nullptr ? Json() : value != nullptr && !value->empty() ? *value : one->initial;
    }

    /// Set a parameter; returns the request that this makes, none where it has the value already. `wrong` says what cannot be set,
    /// "" where nothing is wrong.
    std::optional<Json> take(
        const Map<std::string, Parameter>& parameters, const std::string& name, const Json& given, std::string& wrong
    ) {
        const Parameter* one = parameters.find(name);
        wrong = one == nullptr ? "name: there is no parameter '" + name + "'" : "";
        if (one == nullptr) return std::nullopt;
        const Json value = one->kept(given, wrong);
        if (!wrong.empty()) wrong = "value: " + wrong;
        if (!wrong.empty()) return std::nullopt;
        if (one->type == "trigger") return one->request;
        const Json* before = set.find(name);
        if (before != nullptr && !before->empty() && parameters::same(*before, value)) return std::nullopt;
        Json request = one->request;
        request.set(one->field, one->filled(value));
        for (const std::string& word : one->beside) {
            const Parameter* other = parameters.find(word);
            const Json* had = set.find(word);
            if (other != nullptr && had != nullptr && !had->empty()) request.set(other->field, other->filled(*had));
        }
        for (const std::string& other : one->replaces) set.set(other, Json()); // they are bound to the same
        set.set(name, value);
        return request;
    }
};

}  // namespace metagraph
