// The words and visemes of a line as synthesisers tell them: pairs and triples, Amazon Polly's speech marks, Azure's events.
#pragma once

#include "asks.hpp"

namespace metagraph {
namespace told_timing {

inline constexpr double THOUSAND = 1e3, TICKS = 1e7; // of a second, in which Polly and Azure count

inline Json field(const Json& entry, const std::string& name) {
    const Json* found = entry.find(name);
    return found == nullptr ? Json() : *found;
}
inline Json seconds(const Json& value, double of) { return value.is(Json::Kind::number) ? Json(value.number / of) : value; }

/// Whether what an entry tells is a list of two or three.
inline bool told(const Json& entry) { return entry.is(Json::Kind::list) && (entry.items.size() == 2 || entry.items.size() == 3); }

/// Add the word an entry tells; return whether it is one. named: only where it says so itself.
inline bool add_word(const Json& entry, List<Ref<SpokenWord>>& out, bool named) {
    Json word = entry;
    if (entry.is(Json::Kind::object)) {
        const Json kind = field(entry, "type");
        if (kind.text == "sentence" || kind.text == "ssml") return true; // marks of Polly's that no mouth needs
        if (named && kind.text != "word") return false;
        if (kind.text == "word") {
            word = Json::list({field(entry, "value"), seconds(field(entry, "time"), THOUSAND)});
        } else if (entry.find("audioOffset") != nullptr) {
            const Json start = field(entry, "audioOffset"), length = field(entry, "duration");
            const bool both = start.is(Json::Kind::number) && length.is(Json::Kind::number);
            const Json end = both ? Json((start.number + length.number) / TICKS) : Json();
            word = Json::list({field(entry, "text"), seconds(start, TICKS), end});
        } else {
            const char* name = entry.find("word") != nullptr ? "word" : entry.find("text") != nullptr ? "text" : "character";
            const Json text = field(entry, name);
            word = Json::list({text, field(entry, "start"), field(entry, "end")});
        }
    } else if (named) {
        return false;
    }
    if (!told(word) || !word.items[0].is(Json::Kind::text) || !word.items[1].is(Json::Kind::number)) return false;
    const Json end = word.items.size() == 3 ? word.items[2] : Json();
    if (!end.empty() && !end.is(Json::Kind::number)) return false;
    const auto until = end.empty() ? std::nullopt : std::optional<double>(end.number);
    out.push_back(lang::made<SpokenWord>(word.items[0].text, word.items[1].number, until));
    return true;
}

/// Add the visemes an entry tells; return whether it tells any.
inline bool add_mark(const Json& entry, List<Ref<VisemeMark>>& out) {
    Json mark = entry;
    if (entry.is(Json::Kind::object)) {
        const Json* kind = entry.find("type");
        if (kind != nullptr && kind->text != "viseme") return false;
        const Json weights = field(entry, "weights");
        if (kind != nullptr) {
            mark = Json::list({seconds(field(entry, "time"), THOUSAND), field(entry, "value")});
        } else if (entry.find("audioOffset") != nullptr) {
            mark = Json::list({seconds(field(entry, "audioOffset"), TICKS), field(entry, "visemeId")});
        } else if (weights.is(Json::Kind::object)) {
            bool all = true;
            for (const auto& [name, weight] : weights.fields) {
                all = all && add_mark(Json::list({field(entry, "time"), name, weight}), out);
            }
            return all;
        } else {
            const Json id = field(entry, entry.find("viseme") != nullptr ? "viseme" : "id");
            const Json weight = entry.find("weight") == nullptr ? Json(1.0) : field(entry, "weight");
            mark = Json::list({field(entry, "time"), id, weight});
        }
    }
    if (!told(mark) || !mark.items[0].is(Json::Kind::number)) return false;
    Json id = mark.items[1];
    const Json weight = mark.items.size() == 3 ? mark.items[2] : Json(1.0);
    if (id.is(Json::Kind::number) && id.number == std::floor(id.number)) id = lang::fixed(id.number, 0);
    if (!id.is(Json::Kind::text) || !weight.is(Json::Kind::number)) return false;
    out.push_back(lang::made<VisemeMark>(mark.items[0].number, id.text, weight.number));
    return true;
}

/// Return when a line's words and shapes come, nothing where that is not told, or why that cannot be read.
inline std::pair<Ref<LineTiming>, std::string> read(const Ask& ask) {
    List<Ref<SpokenWord>> words;
    List<Ref<VisemeMark>> marks;
    const List<Json>&told_words = ask.at("words").items, &told_marks = ask.at("visemes").items;
    for (std::size_t n = 0; n < told_words.size(); n++) {
        if (add_word(told_words[n], words, false)) continue;
        return {nullptr, lang::text("words[", n, "]: should be [word, start, end], seconds from the line's start")};
    }
    List<Ref<SpokenWord>> letters;
    const List<Json>& told_letters = ask.at("characters").items;
    for (std::size_t n = 0; n < told_letters.size(); n++) {
        if (add_word(told_letters[n], letters, false)) continue;
        return {nullptr, lang::text("characters[", n, "]: should be [letter, start, end], seconds from the line's start")};
    }
    if (words.empty()) words = line_timing::join_letters(voice::alphabet(), letters);
    for (std::size_t n = 0; n < told_marks.size(); n++) {
        if (add_mark(told_marks[n], marks) || add_word(told_marks[n], words, true)) continue;
        return {nullptr, lang::text("visemes[", n, "]: should be [seconds, viseme], or with its weight from 0 to 1")};
    }
    if (words.empty() && marks.empty()) return {nullptr, ""};
    const std::string set = ask.text("set"), why = line_timing::wrong_in(words, marks, set, ask.maybe_number("duration"));
    if (!why.empty()) return {nullptr, why};
    return {line_timing::timing_of(voice::alphabet(), words, marks, set), ""};
}

}  // namespace told_timing
}  // namespace metagraph
