// From letters to mouth shapes: what a mouth does if a line has neither sound nor phones.
//
// A few rules read English spelling. Other alphabets are read by their vowels. Unknown letters open and shut the mouth
// in turn.
//
// Translated from metagraph/playback/life/graphemes.py; change that, and translate anew.
#pragma once

#include "alphabet.hpp"
#include "mouth.hpp"
#include "language.hpp"

namespace metagraph {

struct Syllabary;
struct SpelledSound;
struct Spelled;

namespace graphemes {

inline constexpr double PACE = 14.0; // characters a second: about 150 words a minute
inline constexpr double SHORTEST = 0.4; // seconds
// Values: shapes in turn. The longest spelling that fits is taken.
inline const Map<std::string, List<std::string>> _SPELLINGS = Map<std::string, List<std::string>>{
    {"tion", List<std::string>{"CH", "nn"}},
    {"sch", List<std::string>{"CH"}},
    {"tch", List<std::string>{"CH"}},
    {"igh", List<std::string>{"aa", "I"}},
    {"eau", List<std::string>{"O"}},
    {"ough", List<std::string>{"O"}},
    {"th", List<std::string>{"TH"}},
    {"sh", List<std::string>{"CH"}},
    {"ch", List<std::string>{"CH"}},
    {"ph", List<std::string>{"FF"}},
    {"ck", List<std::string>{"kk"}},
    {"ng", List<std::string>{"nn"}},
    {"qu", List<std::string>{"kk", "U"}},
    {"wh", List<std::string>{"U"}},
    {"oo", List<std::string>{"U"}},
    {"ou", List<std::string>{"aa", "U"}},
    {"ow", List<std::string>{"O", "U"}},
    {"ee", List<std::string>{"I"}},
    {"ea", List<std::string>{"I"}},
    {"ai", List<std::string>{"E", "I"}},
    {"ay", List<std::string>{"E", "I"}},
    {"oi", List<std::string>{"O", "I"}},
    {"oy", List<std::string>{"O", "I"}},
    {"au", List<std::string>{"O"}},
    {"aw", List<std::string>{"O"}},
    {"ie", List<std::string>{"I"}},
    {"ei", List<std::string>{"E", "I"}},
    {"ue", List<std::string>{"U"}},
    {"oa", List<std::string>{"O"}},
    {"a", List<std::string>{"aa"}},
    {"e", List<std::string>{"E"}},
    {"i", List<std::string>{"I"}},
    {"o", List<std::string>{"O"}},
    {"u", List<std::string>{"U"}},
    {"y", List<std::string>{"I"}},
    {"ø", List<std::string>{"U"}},
    {"œ", List<std::string>{"U"}},
    {"æ", List<std::string>{"E"}},
    {"ı", List<std::string>{"I"}},
    {"b", List<std::string>{"PP"}},
    {"p", List<std::string>{"PP"}},
    {"m", List<std::string>{"PP"}},
    {"f", List<std::string>{"FF"}},
    {"v", List<std::string>{"FF"}},
    {"d", List<std::string>{"DD"}},
    {"t", List<std::string>{"DD"}},
    {"l", List<std::string>{"nn"}},
    {"n", List<std::string>{"nn"}},
    {"k", List<std::string>{"kk"}},
    {"g", List<std::string>{"kk"}},
    {"c", List<std::string>{"kk"}},
    {"q", List<std::string>{"kk"}},
    {"x", List<std::string>{"kk", "SS"}},
    {"h", List<std::string>{"kk"}},
    {"j", List<std::string>{"CH"}},
    {"s", List<std::string>{"SS"}},
    {"z", List<std::string>{"SS"}},
    {"r", List<std::string>{"RR"}},
    {"w", List<std::string>{"U"}},
    {"ß", List<std::string>{"SS"}},
    {"ð", List<std::string>{"TH"}},
    {"þ", List<std::string>{"TH"}},
    {"ł", List<std::string>{"nn"}},
    {"đ", List<std::string>{"DD"}}
};
// Greek and Cyrillic letters, and the Latin ones they stand for.
inline const Map<std::string, std::string> _ALIKE = Map<std::string, std::string>{
    {"α", "a"},
    {"ε", "e"},
    {"η", "e"},
    {"ι", "i"},
    {"ο", "o"},
    {"υ", "y"},
    {"ω", "o"},
    {"β", "b"},
    {"π", "p"},
    {"μ", "m"},
    {"φ", "f"},
    {"δ", "d"},
    {"τ", "t"},
    {"λ", "l"},
    {"ν", "n"},
    {"κ", "k"},
    {"γ", "g"},
    {"χ", "h"},
    {"ξ", "x"},
    {"σ", "s"},
    {"ς", "s"},
    {"ζ", "z"},
    {"ρ", "r"},
    {"θ", "þ"},
    {"а", "a"},
    {"б", "b"},
    {"в", "v"},
    {"г", "g"},
    {"д", "d"},
    {"е", "e"},
    {"ё", "e"},
    {"ж", "j"},
    {"з", "z"},
    {"и", "i"},
    {"й", "j"},
    {"к", "k"},
    {"л", "l"},
    {"м", "m"},
    {"н", "n"},
    {"о", "o"},
    {"п", "p"},
    {"р", "r"},
    {"с", "s"},
    {"т", "t"},
    {"у", "u"},
    {"ф", "f"},
    {"х", "h"},
    {"ц", "s"},
    {"ч", "j"},
    {"ш", "j"},
    {"щ", "j"},
    {"ы", "i"},
    {"э", "e"},
    {"ю", "u"},
    {"я", "a"},
    {"і", "i"},
    {"є", "e"},
    {"ї", "i"}
};
// of syllables nobody knows
inline const List<std::string> _CONSONANTS = List<std::string>{"DD", "nn", "SS", "kk", "PP"};
inline constexpr double _VOWEL_LENGTH = 1.25; // of one character's time
inline constexpr double _CONSONANT_LENGTH = 0.8;
inline const Map<std::string, double> _STOPS = Map<std::string, double>{
    {",", 1.5},
    {";", 2.0},
    {":", 2.0},
    {".", 3.0},
    {"!", 3.0},
    {"?", 3.0},
    {"…", 3.0},
    {"-", 0.3},
    {"–", 1.5},
    {"—", 1.5},
    {"(", 1.0},
    {")", 1.0},
    {"，", 1.5},
    {"、", 1.5},
    {"。", 3.0},
    {"！", 3.0},
    {"？", 3.0}
};
inline constexpr double _BLANK = 0.35; // characters' time of anything else between words
inline const List<Ref<Syllabary>> _SYLLABARIES = List<Ref<Syllabary>>{
    lang::made<Syllabary>(12353, 12543, 2.0),
    lang::made<Syllabary>(65382, 65437, 2.0),
    lang::made<Syllabary>(13312, 40959, 3.0),
    lang::made<Syllabary>(63744, 64255, 3.0),
    lang::made<Syllabary>(131072, 205743, 3.0),
    lang::made<Syllabary>(44032, 55203, 3.0)
};
inline List<std::string> shapes(const Ref<Alphabet>& alphabet, const std::string& word);
inline List<std::string> _unknown(
    const Ref<Alphabet>& alphabet,
    const std::string& letter,
    const List<std::string>& before
);
inline List<std::tuple<std::string, double>> split_words(const Ref<Alphabet>& alphabet, const std::string& text);
inline List<Ref<SpelledSound>> sounds(const Ref<Alphabet>& alphabet, const std::string& word);
inline double read_aloud(const Ref<Alphabet>& alphabet, const std::string& text);
inline double measure_letter(int code);
inline Ref<Spelled> spelled(const Ref<Alphabet>& alphabet, const std::string& text, double duration);

}  // namespace graphemes

/// Letters that are syllables, by their code points. size: characters' time of one.
struct Syllabary {
    int first;
    int last;
    double size;

    Syllabary(int first_, int last_, double size_)
        : first(first_), last(last_), size(size_) {}
};

/// A sound of a text. shape: "" for a pause. size: characters' time. strength: of a syllable, 0 for anything else.
struct SpelledSound {
    std::string shape;
    double size;
    double strength;

    SpelledSound(std::string shape_, double size_, double strength_ = 0.0)
        : shape(std::move(shape_)), size(size_), strength(strength_) {}
};

/// Something said, timed by its letters: pieces in time, and times and strengths (0..1) of its syllables.
struct Spelled {
    List<Ref<MouthPiece>> pieces;
    List<double> peaks;
    List<double> strengths;

    explicit Spelled(
        List<Ref<MouthPiece>> pieces_ = List<Ref<MouthPiece>>{},
        List<double> peaks_ = List<double>{},
        List<double> strengths_ = List<double>{}
    )
        : pieces(std::move(pieces_)), peaks(std::move(peaks_)), strengths(std::move(strengths_)) {}

    /// Add sounds that last from `start` to `end` seconds together.
    void add(const List<Ref<SpelledSound>>& plan, double start, double end);
};

inline void Spelled::add(const List<Ref<SpelledSound>>& plan, double start, double end) {
    double at = start;
    List<double> found;
    for (const auto& sound2 : plan) {
        found.push_back(sound2->size);
    }
    double scale = (end - start) / lang::sum(found);
    for (const auto& sound : plan) {
        double then = at + sound->size * scale;
        if (sound->shape != "") {
            double fully = lang::contains(mouth::VOWELS, sound->shape)
                ? std::min(1.0, 0.7 + 0.4 * sound->strength)
                : 1.0;
            this->pieces.push_back(lang::made<MouthPiece>(at, then, sound->shape, fully));
        }
        if (sound->strength > 0) {
            this->peaks.push_back(0.5 * (at + then));
            this->strengths.push_back(sound->strength);
        }
        at = then;
    }
}

namespace graphemes {

/// Return the mouth shapes of a word's letters, in turn.
inline List<std::string> shapes(const Ref<Alphabet>& alphabet, const std::string& word) {
    List<std::string> out;
    List<std::string> letters;
    for (const auto& c : alphabet->plain(word)) {
        letters.push_back(lang::get_or(graphemes::_ALIKE, c, c));
    }
    int at = 0;
    while (at < lang::len(letters)) {
        int size = std::min(4, lang::len(letters) - at);
        while (size > 1
            && !lang::contains(graphemes::_SPELLINGS, lang::joined(lang::part(letters, at, at + size), ""))) {
            size -= 1;
        }
        std::string spelling = lang::joined(lang::part(letters, at, at + size), "");
        List<std::string> found = lang::contains(graphemes::_SPELLINGS, spelling)
            ? graphemes::_SPELLINGS.at(spelling)
            : graphemes::_unknown(alphabet, spelling, out);
        bool last = at == lang::len(letters) - 1;
        bool holds = spelling == "e" && last && lang::len(out) > 1;
        if (holds) {
            bool is_any = false;
            for (const auto& s : out) {
                if (lang::contains(mouth::VOWELS, s)) {
                    is_any = true;
                    break;
                }
            }
            holds = is_any;
        }
        bool final_e = holds;
        bool twice = at > 0 && size == 1 && lang::at(letters, at) == lang::at(letters, at - 1);
        if (lang::len(found) > 0 && !final_e && !(twice && !lang::contains(mouth::VOWELS, lang::at(found, 0)))) {
            lang::extend(out, found);
        }
        at += size;
    }
    return out;
}

inline List<std::string> _unknown(
    const Ref<Alphabet>& alphabet,
    const std::string& letter,
    const List<std::string>& before
) {
    std::string kind = alphabet->kind(letter);
    if (kind == "syllable") {
        int code = alphabet->code(letter);
        return List<std::string>{
            lang::at(graphemes::_CONSONANTS, lang::modulo(code, 5)),
            lang::at(mouth::VOWELS, lang::modulo(lang::floored(code, 5), 5))
        };
    }
    if (kind == "letter") {
        return (lang::len(before) > 0 && !lang::contains(mouth::VOWELS, lang::at(before, -1)))
            ? List<std::string>{"aa"}
            : List<std::string>{"DD"};
    }
    return List<std::string>{};
}

/// Return each word, and the pause after it, measured in characters.
inline List<std::tuple<std::string, double>> split_words(const Ref<Alphabet>& alphabet, const std::string& text) {
    List<std::tuple<std::string, double>> out;
    std::string word = "";
    double pause = 0.0;
    for (const auto& c : alphabet->letters(text)) {
        if (alphabet->kind(c) != "" || c == "'" || c == "’") {
            if (pause > 0) {
                out.push_back(std::tuple<std::string, double>{word, pause});
                word = "";
                pause = 0.0;
            }
            word += c;
        } else {
            pause += lang::get_or(graphemes::_STOPS, c, graphemes::_BLANK);
        }
    }
    if (word != "" || pause > 0) {
        out.push_back(std::tuple<std::string, double>{word, pause});
    }
    return out;
}

/// Return a word's sounds, in turn.
///
/// Content words are longer than the words between them. The first vowel usually has the stress.
inline List<Ref<SpelledSound>> sounds(const Ref<Alphabet>& alphabet, const std::string& word) {
    List<Ref<SpelledSound>> out;
    List<std::string> found = graphemes::shapes(alphabet, word);
    double weight = std::min(1.0, 0.35 + 0.09 * lang::len(alphabet->letters(word)))
        - 0.1 * alphabet->scatter(word) / 100;
    bool first = true;
    std::string before = "";
    for (const auto& shape : found) {
        bool vowel = lang::contains(mouth::VOWELS, shape);
        bool syllable = vowel && !lang::contains(mouth::VOWELS, before);
        double strength = syllable ? first ? weight : 0.6 * weight : 0.0;
        first = first && !syllable;
        out.push_back(lang::made<SpelledSound>(
            shape,
            vowel ? graphemes::_VOWEL_LENGTH : graphemes::_CONSONANT_LENGTH,
            strength
        ));
        before = shape;
    }
    return out;
}

/// Return how long a text takes to say, seconds.
inline double read_aloud(const Ref<Alphabet>& alphabet, const std::string& text) {
    List<std::string> letters = alphabet->letters(alphabet->stripped(text));
    List<double> found;
    for (const auto& letter : letters) {
        found.push_back(graphemes::measure_letter(alphabet->code(letter)));
    }
    return std::max(graphemes::SHORTEST, lang::sum(found) / graphemes::PACE);
}

/// Return how long a letter takes, measured in characters, by its code point: a Chinese, Japanese or Korean one is a
/// syllable.
inline double measure_letter(int code) {
    for (const auto& script : graphemes::_SYLLABARIES) {
        if (script->first <= code && code <= script->last) {
            return script->size;
        }
    }
    return 1.0;
}

/// Return the sounds of a text that lasts `duration` seconds; none if it has no known letter.
inline Ref<Spelled> spelled(const Ref<Alphabet>& alphabet, const std::string& text, double duration) {
    Ref<Spelled> out = lang::made<Spelled>();
    List<Ref<SpelledSound>> plan;
    for (const auto& [word, pause] : graphemes::split_words(alphabet, alphabet->stripped(text))) {
        lang::extend(plan, graphemes::sounds(alphabet, word));
        if (pause > 0) {
            plan.push_back(lang::made<SpelledSound>("", pause));
        }
    }
    bool holds = duration >= 0.001;
    if (holds) {
        bool is_any = false;
        for (const auto& sound : plan) {
            if (sound->shape != "") {
                is_any = true;
                break;
            }
        }
        holds = is_any;
    }
    if (holds) {
        double edge = std::min(0.06, 0.1 * duration);
        out->add(plan, edge, duration - edge);
    }
    return out;
}

}  // namespace graphemes

}  // namespace metagraph
