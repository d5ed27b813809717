// Gestures that go with words, from the words alone: greetings, denial, doubt, contrast, lists, persons and places,
// emphasis, and a beat where there is none of these.
//
// After the idea of BEAT (Cassell, Vilhjalmsson and Bickmore, 2001): a text's words propose gestures by rules and a
// lexicon that anybody can edit, and the weaker ones of those that would collide are left out. A gesture with a meaning
// precedes its word by more than a beat does (ter Bekke et al. 2024: its stroke by some 0.2 s). All other numbers are
// ours. Times are seconds from where the text begins.
//
// Translated from metagraph/speech/word_gestures.py; change that, and translate anew.
#pragma once

#include "alphabet.hpp"
#include "graphemes.hpp"
#include "choice.hpp"
#include "language.hpp"

namespace metagraph {

struct GestureRule;
struct GestureWords;
struct TextWord;
struct ToldWord;
struct ProposedGesture;
struct GestureAsk;
struct SplitWord;

namespace word_gestures {

// seconds between two strokes of a layer, at least
inline const Map<std::string, double> APART = Map<std::string, double>{{"arms", 2.4}, {"head", 1.8}};
inline constexpr double AGAIN = 1.6; // and so many times as far where both are of the same tag
inline constexpr double LATE = 0.35; // seconds that a stroke may come after its word; later than that none is made
// seconds into a text up to which a stroke may come late: a hand needs as long to get there
inline constexpr double FIRST = 1.4;
inline constexpr double PLAIN = 0.55; // of the clauses that propose nothing, how many get a beat
inline constexpr double LEAD = 0.1; // seconds that a stroke comes before the middle of its word's vowels
inline constexpr double MEANING_LEAD = 0.2; // the same of a gesture that means something
// tags of gestures that go with any word
inline const List<std::string> BEATS = List<std::string>{"beat", "emphasis", "explain", "open"};
inline constexpr double NOD = 0.3; // seconds from where a nod begins to its first stroke
inline constexpr int CLAUSE = 3; // words of a clause that gets a beat, at least
inline constexpr int LONGEST = 20000; // letters of a text
inline const std::string ENDS = ".?!…。？！";
inline const std::string PAUSES = ",;:–—、，";
inline const std::string INSIDE = "'’-"; // what a word may have in the middle
inline const std::string CLOSING = "\"')”»"; // what may stand between a word and the mark behind it
inline List<Ref<TextWord>> words_of(
    const Ref<Alphabet>& alphabet,
    const std::string& text,
    const List<Ref<ToldWord>>& told = List<Ref<ToldWord>>{},
    const std::optional<double>& seconds = std::nullopt
);
inline bool _is_letter(const Ref<Alphabet>& alphabet, const std::string& letter);
inline bool telling(const Ref<Alphabet>& alphabet, const List<std::string>& letters);
inline List<Ref<SplitWord>> _split(const Ref<Alphabet>& alphabet, const List<std::string>& letters);
inline List<Ref<ProposedGesture>> proposed_for(
    const List<Ref<TextWord>>& words,
    const Set<std::string>& arms,
    bool head,
    const Ref<GestureWords>& lexicon,
    const Set<std::string>& small,
    std::uint32_t seed
);
inline std::tuple<Ref<GestureRule>, int> _fitting(
    const Ref<GestureWords>& lexicon,
    const List<Ref<TextWord>>& words,
    int n
);
inline bool _says(const List<Ref<TextWord>>& words, int first, const List<std::string>& parts);
inline List<Ref<ProposedGesture>> _of(
    const Ref<GestureRule>& rule,
    const Ref<TextWord>& word,
    const Set<std::string>& arms,
    bool head
);
inline List<Ref<ProposedGesture>> _spaced(const List<Ref<ProposedGesture>>& every);
inline bool _in_the_way(const Ref<ProposedGesture>& one, const Ref<ProposedGesture>& other);
inline List<Ref<GestureAsk>> gesture_asks(const List<Ref<ProposedGesture>>& every, double at);
inline int sentence_end(const Ref<Alphabet>& alphabet, const List<std::string>& letters, bool over);

}  // namespace word_gestures

/// A gesture that some words propose. words: small letters; several in a row for a phrase. tags: of a gesture of the
/// arms, the best first; the first one that the character has counts. head: its movement at the same time: "nod",
/// "shake" or nothing. strength: the stronger of two rules wins.
struct GestureRule {
    List<std::string> words;
    List<std::string> tags;
    std::string head;
    double strength;

    explicit GestureRule(
        List<std::string> words_ = List<std::string>{},
        List<std::string> tags_ = List<std::string>{},
        std::string head_ = "",
        double strength_ = 1.0
    )
        : words(std::move(words_)), tags(std::move(tags_)), head(std::move(head_)), strength(strength_) {}
};

/// A lexicon. question, exclamation: proposed at the end of a sentence, for its last content word. clause: proposed for
/// a clause without other proposals.
struct GestureWords {
    List<Ref<GestureRule>> rules;
    std::string language;
    Ref<GestureRule> question;
    Ref<GestureRule> exclamation;
    Ref<GestureRule> clause;

    explicit GestureWords(
        List<Ref<GestureRule>> rules_,
        std::string language_ = "en",
        Ref<GestureRule> question_ = lang::made<GestureRule>(),
        Ref<GestureRule> exclamation_ = lang::made<GestureRule>(),
        Ref<GestureRule> clause_ = lang::made<GestureRule>()
    )
        : rules(std::move(rules_)),
            language(std::move(language_)),
            question(std::move(question_)),
            exclamation(std::move(exclamation_)),
            clause(std::move(clause_)) {}
};

/// A word of a text. plain: in small letters. mark: the punctuation after it.
struct TextWord {
    std::string text;
    std::string plain;
    double start;
    double end;
    std::string mark;

    TextWord(std::string text_, std::string plain_, double start_, double end_, std::string mark_ = "")
        : text(std::move(text_)), plain(std::move(plain_)), start(start_), end(end_), mark(std::move(mark_)) {}
};

/// A word with the times at which a synthesiser says it.
struct ToldWord {
    double start;
    double end;

    ToldWord(double start_, double end_)
        : start(start_), end(end_) {}
};

/// A gesture that goes with a word. do: "gesture", "nod" or "shake". at: time of its stroke. tags: empty for gestures
/// of the head.
struct ProposedGesture {
    std::string layer;
    double at;
    List<std::string> tags;
    double strength;
    std::string word;
    std::string do_;

    ProposedGesture(
        std::string layer_,
        double at_,
        List<std::string> tags_,
        double strength_,
        std::string word_,
        std::string do_ = "gesture"
    )
        : layer(std::move(layer_)),
            at(at_),
            tags(std::move(tags_)),
            strength(strength_),
            word(std::move(word_)),
            do_(std::move(do_)) {}
};

/// The request for a gesture. at: the earliest second of the session at which it may begin. stroke: the time of its
/// stroke, None for the head. late: by how many seconds it may come late.
struct GestureAsk {
    std::string do_;
    std::string layer;
    List<std::string> tags;
    double at;
    std::optional<double> stroke;
    double late;

    GestureAsk(
        std::string do_,
        std::string layer_,
        List<std::string> tags_,
        double at_,
        std::optional<double> stroke_,
        double late_
    )
        : do_(std::move(do_)),
            layer(std::move(layer_)),
            tags(std::move(tags_)),
            at(at_),
            stroke(stroke_),
            late(late_) {}
};

/// A word, the number of letters of the text up to its end, and the mark after it.
struct SplitWord {
    std::string text;
    int end;
    std::string mark;

    SplitWord(std::string text_, int end_, std::string mark_)
        : text(std::move(text_)), end(end_), mark(std::move(mark_)) {}
};

namespace word_gestures {

/// Return a text's words with their times: those of a synthesiser, else as long as lips would take.
///
/// told: the times of the words in order; words without times are left out. seconds: how long all of it takes, if only
/// that is known.
inline List<Ref<TextWord>> words_of(
    const Ref<Alphabet>& alphabet,
    const std::string& text,
    const List<Ref<ToldWord>>& told,
    const std::optional<double>& seconds
) {
    List<std::string> letters = alphabet->letters(text);
    double pace = 1.0;
    if (seconds.has_value() && lang::len(told) == 0) {
        pace = *seconds / std::max(0.001, graphemes::read_aloud(alphabet, text));
    }
    List<Ref<TextWord>> out;
    for (const auto& split : word_gestures::_split(alphabet, lang::part(letters, 0, word_gestures::LONGEST))) {
        List<std::string> small = alphabet->letters(lang::lowered(split->text));
        List<std::string> found;
        for (const auto& letter : small) {
            found.push_back(letter == "’" ? std::string("'") : letter);
        }
        std::string plain = lang::joined(found, "");
        if (lang::len(told) > 0) {
            if (lang::len(out) == lang::len(told)) {
                break;
            }
            Ref<ToldWord> times = lang::at(told, lang::len(out));
            out.push_back(lang::made<TextWord>(split->text, plain, times->start, times->end, split->mark));
        } else {
            double stop = pace * graphemes::read_aloud(alphabet, lang::joined(lang::part(letters, 0, split->end), ""));
            double before = lang::len(out) > 0 ? lang::at(out, lang::len(out) - 1)->end : 0.0;
            double start = std::max(before, stop - pace * graphemes::read_aloud(alphabet, split->text));
            out.push_back(lang::made<TextWord>(split->text, plain, start, stop, split->mark));
        }
    }
    return out;
}

inline bool _is_letter(const Ref<Alphabet>& alphabet, const std::string& letter) {
    std::string kind = alphabet->kind(letter);
    return kind == "syllable" || kind == "letter";
}

/// Return whether letters contain words, so that there is something to say.
inline bool telling(const Ref<Alphabet>& alphabet, const List<std::string>& letters) {
    bool is_any = false;
    for (const auto& letter : letters) {
        if (word_gestures::_is_letter(alphabet, letter)) {
            is_any = true;
            break;
        }
    }
    return is_any;
}

inline List<Ref<SplitWord>> _split(const Ref<Alphabet>& alphabet, const List<std::string>& letters) {
    List<Ref<SplitWord>> out;
    int at = 0;
    int count = lang::len(letters);
    while (at < count) {
        if (!word_gestures::_is_letter(alphabet, lang::at(letters, at))) {
            at += 1;
            continue;
        }
        int first = at;
        while (at < count) {
            bool goes_on = word_gestures::_is_letter(alphabet, lang::at(letters, at));
            if (!goes_on && lang::contains(word_gestures::INSIDE, lang::at(letters, at)) && at + 1 < count) {
                goes_on = word_gestures::_is_letter(alphabet, lang::at(letters, at + 1));
            }
            if (!goes_on) {
                break;
            }
            at += 1;
        }
        int behind = at;
        while (behind < count && lang::contains(word_gestures::CLOSING, lang::at(letters, behind))) {
            behind += 1;
        }
        std::string mark = "";
        if (behind < count
            && (lang::contains(word_gestures::ENDS, lang::at(letters, behind))
                || lang::contains(word_gestures::PAUSES, lang::at(letters, behind)))) {
            mark = lang::at(letters, behind);
        }
        out.push_back(lang::made<SplitWord>(lang::joined(lang::part(letters, first, at), ""), at, mark));
    }
    return out;
}

/// Return the gestures that go with words, in order and without collisions.
///
/// arms: tags of the character's gestures of the arms; others are not proposed. head: whether the head moves. small:
/// words that say little by themselves.
inline List<Ref<ProposedGesture>> proposed_for(
    const List<Ref<TextWord>>& words,
    const Set<std::string>& arms,
    bool head,
    const Ref<GestureWords>& lexicon,
    const Set<std::string>& small,
    std::uint32_t seed
) {
    List<Ref<ProposedGesture>> every;
    List<Ref<TextWord>> clause;
    bool proposes = false;
    for (int n = 0; n < lang::len(words); n++) {
        const auto& word = lang::at(words, n);
        clause.push_back(word);
        auto [rule, length] = word_gestures::_fitting(lexicon, words, n);
        if (length > 0) {
            lang::extend(every, word_gestures::_of(rule, lang::at(words, n + length - 1), arms, head));
            proposes = true;
        }
        if (word->mark == "" && n + 1 < lang::len(words)) {
            continue;
        }
        List<Ref<TextWord>> large;
        for (const auto& w : clause) {
            if (!lang::contains(small, w->plain)) {
                large.push_back(w);
            }
        }
        Ref<TextWord> last = lang::len(large) > 0
            ? lang::at(large, lang::len(large) - 1)
            : lang::at(clause, lang::len(clause) - 1);
        if (word->mark == "?" || word->mark == "？") {
            lang::extend(every, word_gestures::_of(lexicon->question, last, arms, head));
        } else if (word->mark == "!" || word->mark == "！") {
            lang::extend(every, word_gestures::_of(lexicon->exclamation, last, arms, head));
        } else if (!proposes
            && lang::len(clause) >= word_gestures::CLAUSE
            && choice::uniform(seed, List<std::string>{lang::text(n, "/", last->plain), "beat"})
                < word_gestures::PLAIN) {
            lang::extend(every, word_gestures::_of(lexicon->clause, last, arms, head));
        }
        clause = List<Ref<TextWord>>{};
        proposes = false;
    }
    List<Ref<ProposedGesture>> kept = word_gestures::_spaced(every);
    List<double> keys;
    for (const auto& one : kept) {
        keys.push_back(one->at);
    }
    return lang::ordered(kept, keys);
}

/// Return the rule with the longest phrase that begins at a word, and the number of its words; 0 if there is none.
inline std::tuple<Ref<GestureRule>, int> _fitting(
    const Ref<GestureWords>& lexicon,
    const List<Ref<TextWord>>& words,
    int n
) {
    Ref<GestureRule> best = lexicon->clause;
    int longest = 0;
    for (const auto& rule : lexicon->rules) {
        for (const auto& phrase : rule->words) {
            List<std::string> parts = lang::words(phrase);
            if (lang::len(parts) > longest && word_gestures::_says(words, n, parts)) {
                best = rule;
                longest = lang::len(parts);
            }
        }
    }
    return std::tuple<Ref<GestureRule>, int>{best, longest};
}

/// Return whether a phrase begins at a word, without a pause inside it.
inline bool _says(const List<Ref<TextWord>>& words, int first, const List<std::string>& parts) {
    if (first + lang::len(parts) > lang::len(words)) {
        return false;
    }
    for (int k = 0; k < lang::len(parts); k++) {
        const auto& part = lang::at(parts, k);
        if (lang::at(words, first + k)->plain != part
            || (k + 1 < lang::len(parts) && lang::at(words, first + k)->mark != "")) {
            return false;
        }
    }
    return true;
}

inline List<Ref<ProposedGesture>> _of(
    const Ref<GestureRule>& rule,
    const Ref<TextWord>& word,
    const Set<std::string>& arms,
    bool head
) {
    double at = std::max(0.0, (word->start + word->end) / 2 - word_gestures::LEAD);
    List<Ref<ProposedGesture>> out;
    for (const auto& tag : rule->tags) {
        if (lang::contains(arms, tag)) {
            double early = lang::contains(word_gestures::BEATS, tag)
                ? 0.0
                : word_gestures::MEANING_LEAD - word_gestures::LEAD;
            out.push_back(lang::made<ProposedGesture>(
                "arms",
                std::max(0.0, at - early),
                List<std::string>{tag},
                rule->strength,
                word->text
            ));
            break;
        }
    }
    if (rule->head != "" && head) {
        out.push_back(lang::made<ProposedGesture>(
            "head",
            at,
            List<std::string>{},
            rule->strength,
            word->text,
            rule->head
        ));
    }
    return out;
}

/// Leave out gestures that are too near to a stronger one of their layer; of two equal ones the earlier stays. The same
/// tag twice in a row needs more room.
inline List<Ref<ProposedGesture>> _spaced(const List<Ref<ProposedGesture>>& every) {
    List<Ref<ProposedGesture>> kept;
    List<std::tuple<double, double>> keys;
    for (const auto& one2 : every) {
        keys.push_back(std::tuple<double, double>{-one2->strength, one2->at});
    }
    for (const auto& one : lang::ordered(every, keys)) {
        bool is_any = false;
        for (const auto& other : kept) {
            if (word_gestures::_in_the_way(one, other)) {
                is_any = true;
                break;
            }
        }
        if (!is_any) {
            kept.push_back(one);
        }
    }
    return kept;
}

inline bool _in_the_way(const Ref<ProposedGesture>& one, const Ref<ProposedGesture>& other) {
    if (one->layer != other->layer) {
        return false;
    }
    double room = word_gestures::APART.at(one->layer);
    if (lang::len(one->tags) == 0
        || (lang::len(other->tags) > 0 && lang::at(one->tags, 0) == lang::at(other->tags, 0))) {
        room *= word_gestures::AGAIN;
    }
    return std::abs(one->at - other->at) < room;
}

/// Return the requests for the gestures of a text that begins at `at` seconds of the session. Gestures that cannot be
/// in time are refused, not made late.
inline List<Ref<GestureAsk>> gesture_asks(const List<Ref<ProposedGesture>>& every, double at) {
    List<Ref<GestureAsk>> out;
    for (const auto& one : every) {
        double late = std::max(word_gestures::LATE, word_gestures::FIRST - one->at);
        if (one->do_ == "gesture") {
            out.push_back(lang::made<GestureAsk>(one->do_, one->layer, one->tags, at, at + one->at, late));
        } else {
            out.push_back(lang::made<GestureAsk>(
                one->do_,
                one->layer,
                List<std::string>{},
                at + std::max(0.0, one->at - word_gestures::NOD),
                std::nullopt,
                late
            ));
        }
    }
    return out;
}

/// Return the number of letters after which the first sentence of a text ends, 0 if it goes on. over: whether the text
/// is complete.
inline int sentence_end(const Ref<Alphabet>& alphabet, const List<std::string>& letters, bool over) {
    bool some = false;
    for (int n = 0; n < lang::len(letters); n++) {
        const auto& letter = lang::at(letters, n);
        bool blank = alphabet->stripped(letter) == "";
        if (letter == "\n" && some) {
            return n + 1;
        }
        // An end is one once something else follows: "3." may become "3.5".
        if (lang::contains(word_gestures::ENDS, letter)
            && n + 1 < lang::len(letters)
            && (lang::contains("。？！", letter) || alphabet->stripped(lang::at(letters, n + 1)) == "")) {
            return n + 1;
        }
        some = some || !blank;
    }
    return (over && some) ? lang::len(letters) : 0;
}

}  // namespace word_gestures

}  // namespace metagraph
