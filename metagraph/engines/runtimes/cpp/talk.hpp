// Text, whole or piece by piece, as speech with the gestures that go with its words.
#pragma once

#include "character.hpp"
#include "gesture_word_lists.hpp"
#include "word_gestures.hpp"

namespace metagraph {

/// What was said: the id of the words, and those of their gestures.
struct SaidText {
    std::string id;
    List<std::string> gestures;
};

/// language: "en" or "de-AT"; English where there is no lexicon of it. lexicon: one of your own, as the files have it; nothing for the
/// language's. name: what ids begin with.
struct TalkOptions {
    std::string language = "en";
    Json lexicon;
    std::uint32_t seed = 1;
    std::string name = "talk";
};

/// What a character says. It keeps a reference to the character. Times are seconds of the character's own.
class Talk {
public:
    explicit Talk(Character& character, const TalkOptions& options = {})
        : character_(character), seed_(options.seed), name_(options.name) {
        std::tie(lexicon_, small_) = lexicon_of(options.language, options.lexicon);
        for (const auto& [_, action] : character.graph().layer("arms").graph->actions) {
            if (action->kind == "gesture") arms_.insert(action->tags.begin(), action->tags.end());
        }
        for (const auto& [_, action] : character.graph().layer("head").graph->actions) {
            head_ = head_ || (action->kind == "gesture" && !action->tags.empty());
        }
    }

    /// A language's lexicon, and its words that say little by themselves. own: a lexicon as the files have them, instead.
    static std::tuple<Ref<GestureWords>, Set<std::string>> lexicon_of(const std::string& language, const Json& own = {}) {
        std::string code = lang::lowered(language);
        code = code.substr(0, code.find_first_of("-_"));
        const std::string listed = gesture_word_lists::of(code), text = listed.empty() ? gesture_word_lists::of("en") : listed;
        json::Parser parser(text);
        const Json known = parser.parse();
        const Json& given = own.is(Json::Kind::object) ? own : known;
        List<Ref<GestureRule>> rules;
        if (const Json* told = given.find("rules")) {
            for (const Json& one : told->items) rules.push_back(rule(&one));
        }
        Set<std::string> small;
        const Json* told = given.find("small");
        for (const std::string& word : texts(told != nullptr ? told : known.find("small"))) small.insert(word);
        auto lexicon = lang::made<GestureWords>(
            rules, code, rule(given.find("question")), rule(given.find("exclamation")), rule(given.find("clause"))
        );
        return {lexicon, small};
    }

    /// From when on nothing is said yet.
    double free() const { return free_; }

    /// Say a text, with gestures on its words. more: further fields of the request `say`: `words` that are told with starts and ends
    /// tell when gestures come, else `duration`, else how long lips take. Where it cannot be understood, its answer says why.
    SaidText say(const std::string& text, const Json& more = Json::object()) {
        count_++;
        SaidText said;
        const Json* own = more.find("id");
        said.id = own != nullptr && !own->text.empty() ? own->text : lang::text(name_, count_);
        const double at = number(more.find("at")).value_or(character_.now() + number(more.find("after")).value_or(START));
        Json request = Json::object({{"do", "say"}});
        for (const auto& [name, value] : more.fields) {
            if (name != "after") request.set(name, value);
        }
        request.set("do", "say");
        request.set("id", said.id);
        request.set("text", text);
        request.set("at", at);
        character_.ask(request);
        if (character_.answer(said.id).state == "refused") return said;
        const List<Ref<ToldWord>> told = times(more.find("words"));
        const std::optional<double> duration = number(more.find("duration"));
        const double aloud = told.empty() ? graphemes::read_aloud(voice::alphabet(), text) : told.back()->end;
        free_ = at + duration.value_or(aloud) + BETWEEN;
        for (const auto& ask : word_gestures::gesture_asks(proposed(word_gestures::words_of(voice::alphabet(), text, told, duration)), at)) {
            Json gesture = Json::object({{"do", ask->do_}, {"id", lang::text(said.id, "/", said.gestures.size())}, {"at", ask->at}});
            gesture.set("late", ask->late);
            if (ask->stroke.has_value()) {
                gesture.set("layer", ask->layer);
                gesture.set("tags", Json::texts(ask->tags));
                gesture.set("stroke", *ask->stroke);
            }
            said.gestures.push_back(character_.ask(gesture));
        }
        return said;
    }

    /// Break off all that is said, because the other speaks, and forget what came in and is not said yet. What is said next begins at
    /// once. Returns the request's id.
    std::string interrupt() {
        text_.clear();
        free_ = 0.0;
        return character_.ask(Json::object({{"do", "interrupt"}}));
    }

    /// The gestures that go with words.
    List<Ref<ProposedGesture>> proposed(const List<Ref<TextWord>>& words) const {
        return word_gestures::proposed_for(words, arms_, head_, lexicon_, small_, seed_ + count_);
    }

    /// Take in what comes next of a text, as a language model writes it: each sentence is said when it is whole, after the one before.
    /// over: whether the text ends here. Returns what was said by it.
    List<SaidText> take(const std::string& piece, bool over = false) {
        text_ += piece;
        List<SaidText> out;
        while (true) {
            const List<std::string> letters = voice::alphabet()->letters(text_);
            const int end = word_gestures::sentence_end(voice::alphabet(), letters, over);
            if (end == 0) return out;
            const List<std::string> first = lang::part(letters, 0, end);
            text_ = lang::joined(lang::part(letters, end), "");
            if (!word_gestures::telling(voice::alphabet(), first)) continue;
            const double at = std::max(free_, character_.now() + START);
            out.push_back(say(voice::alphabet()->stripped(lang::joined(first, "")), Json::object({{"at", at}})));
        }
    }

private:
    static constexpr double START = 0.35; // seconds before a text begins, so that a hand can be where its first stroke needs it
    static constexpr double BETWEEN = 0.25; // seconds between two sentences

    Character& character_;
    Ref<GestureWords> lexicon_;
    Set<std::string> small_, arms_;
    bool head_ = false;
    std::uint32_t seed_, count_ = 0;
    std::string name_, text_; // what came in and is no whole sentence
    double free_ = 0.0;

    static std::optional<double> number(const Json* json) {
        return json != nullptr && json->is(Json::Kind::number) ? std::optional<double>(json->number) : std::nullopt;
    }

    static List<std::string> texts(const Json* json) {
        List<std::string> out;
        if (json == nullptr) return out;
        for (const Json& one : json->items) out.push_back(one.text);
        return out;
    }

    static Ref<GestureRule> rule(const Json* json) {
        if (json == nullptr) return lang::made<GestureRule>();
        const Json* head = json->find("head");
        return lang::made<GestureRule>(
            texts(json->find("words")), texts(json->find("tags")), head == nullptr ? "" : head->text,
            number(json->find("strength")).value_or(1.0)
        );
    }

    /// Words' times, as requests have them; none where an end is not told.
    static List<Ref<ToldWord>> times(const Json* words) {
        List<Ref<ToldWord>> out;
        if (words == nullptr) return out;
        for (const Json& word : words->items) {
            const bool row = word.items.size() > 2;
            const auto start = number(row ? &word.items[1] : word.find("start"));
            const auto end = number(row ? &word.items[2] : word.find("end"));
            if (!start.has_value() || !end.has_value()) return {};
            out.push_back(lang::made<ToldWord>(*start, *end));
        }
        return out;
    }
};

}  // namespace metagraph
