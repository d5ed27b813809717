// The part of an utterance that was spoken until a moment, for the history from which a language model continues.
//
// Translated from metagraph/speech/spoken_so_far.py; change that, and translate anew.
#pragma once

#include "alphabet.hpp"
#include "items.hpp"
#include "line_timing.hpp"
#include "utterances.hpp"
#include "word_gestures.hpp"
#include "language.hpp"

namespace metagraph {


namespace spoken_so_far {

inline std::tuple<std::string, std::string> spoken_until(
    const Ref<Alphabet>& alphabet,
    const List<Ref<Speech>>& said,
    const std::string& ident,
    double seconds
);
inline List<Ref<Speech>> _pieces(const List<Ref<Speech>>& said, const std::string& ident, double seconds);
inline std::tuple<std::string, std::string> _spoken_of(
    const Ref<Alphabet>& alphabet,
    const Ref<Speech>& piece,
    double seconds
);
inline bool _parts(const Ref<Alphabet>& alphabet, const std::string& letter);
inline int _end_of_letters(const List<std::string>& letters, const List<std::string>& word, int first);

}  // namespace spoken_so_far

namespace spoken_so_far {

/// Return the part of an utterance that was spoken until `seconds`, up to the word that was begun, and that word; "" if
/// nothing was spoken. said: all speeches, by start.
inline std::tuple<std::string, std::string> spoken_until(
    const Ref<Alphabet>& alphabet,
    const List<Ref<Speech>>& said,
    const std::string& ident,
    double seconds
) {
    std::string text = "";
    std::string last = "";
    bool paced = false;
    List<Ref<Speech>> pieces = spoken_so_far::_pieces(said, ident, seconds);
    for (int n = 0; n < lang::len(pieces); n++) {
        const auto& piece = lang::at(pieces, n);
        auto [words, word] = spoken_so_far::_spoken_of(
            alphabet,
            piece,
            std::min(seconds, piece->end) - items::find_line_start(piece)
        );
        bool joins = paced && piece->timing != nullptr && piece->timing->paced;
        if (n > 0 && text != "" && words != "" && !joins) {
            text += " ";
        }
        text += words;
        last = word == "" ? last : word;
        paced = piece->timing != nullptr && piece->timing->paced;
    }
    return std::tuple<std::string, std::string>{alphabet->stripped(text), last};
}

/// Return the pieces of the last utterance with an id; one that continues after a pause is one utterance.
inline List<Ref<Speech>> _pieces(const List<Ref<Speech>>& said, const std::string& ident, double seconds) {
    List<Ref<Speech>> out;
    for (const auto& piece : said) {
        if (piece->id != ident || piece->start >= seconds || utterances::is_paused(piece->start)) {
            continue;
        }
        if (lang::len(out) > 0 && lang::at(out, -1)->asked != piece->asked) {
            out = List<Ref<Speech>>{};
        } else if (lang::len(out) > 0 && piece->skip > 0) {
            out.pop_back();
        }
        out.push_back(piece);
    }
    return out;
}

/// Return the part of one piece that was spoken in its first `seconds`, and its last word.
inline std::tuple<std::string, std::string> _spoken_of(
    const Ref<Alphabet>& alphabet,
    const Ref<Speech>& piece,
    double seconds
) {
    List<std::string> letters = alphabet->letters(piece->text);
    List<Ref<SpokenWord>> words;
    if (piece->timing != nullptr && lang::len(piece->timing->words) > 0) {
        words = piece->timing->words;
    } else if (piece->timing == nullptr || !piece->timing->paced) {
        List<Ref<SpokenWord>> found;
        for (const auto& w : word_gestures::words_of(
            alphabet,
            piece->text,
            List<Ref<ToldWord>>{},
            items::measure_line(piece)
        )) {
            found.push_back(lang::made<SpokenWord>(w->text, w->start));
        }
        words = found;
    }
    List<std::string> begun;
    for (const auto& word2 : words) {
        if (word2->start < seconds) {
            begun.push_back(word2->text);
        }
    }
    if (lang::len(begun) == 0) {
        bool silent = piece->timing != nullptr && piece->timing->paced && lang::len(words) == 0;
        return std::tuple<std::string, std::string>{silent ? piece->text : std::string(""), ""};
    }
    int end = 0;
    for (const auto& word : begun) {
        end = spoken_so_far::_end_of_letters(letters, alphabet->letters(word), end);
        if (end < 0) { // the text says it otherwise
            return std::tuple<std::string, std::string>{lang::joined(begun, " "), lang::at(begun, -1)};
        }
    }
    int stop = end;
    while (stop < lang::len(letters) && !spoken_so_far::_parts(alphabet, lang::at(letters, stop))) {
        stop += 1;
    }
    int first = end;
    while (first > 0 && alphabet->stripped(lang::at(letters, first - 1)) != "") {
        first -= 1;
    }
    if (lang::len(begun) == lang::len(words) && piece->timing != nullptr && piece->timing->paced) {
        stop = lang::len(letters);
    }
    List<Ref<TextWord>> whole = word_gestures::words_of(alphabet, lang::joined(lang::part(letters, first, end), ""));
    return std::tuple<std::string, std::string>{
        lang::joined(lang::part(letters, 0, stop), ""),
        lang::len(whole) > 0 ? lang::at(whole, -1)->text : lang::at(begun, -1)
    };
}

/// Return whether a letter after a word is not a mark that belongs to it.
inline bool _parts(const Ref<Alphabet>& alphabet, const std::string& letter) {
    return alphabet->stripped(letter) == "" || word_gestures::telling(alphabet, List<std::string>{letter});
}

/// Return the index after a word in a text, searching from `first`; -1 if it is not there.
inline int _end_of_letters(const List<std::string>& letters, const List<std::string>& word, int first) {
    for (int start = first; start < lang::len(letters) - lang::len(word) + 1; start++) {
        bool are_all = true;
        for (int n = 0; n < lang::len(word); n++) {
            const auto& letter = lang::at(word, n);
            if (!(lang::at(letters, start + n) == letter)) {
                are_all = false;
                break;
            }
        }
        if (are_all) {
            return start + lang::len(word);
        }
    }
    return -1;
}

}  // namespace spoken_so_far

}  // namespace metagraph
