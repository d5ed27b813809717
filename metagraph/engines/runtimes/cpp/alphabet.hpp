// What is known of letters: their plain forms and what kind of character they are, as Unicode has it below 65536.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <unordered_map>

#include "language.hpp"
#include "letters_table.hpp"

namespace metagraph {

class Alphabet {
public:
    Alphabet()
        : letters_(edges(letters_table::LETTERS)), digits_(edges(letters_table::DIGITS)),
          syllables_(edges(letters_table::SYLLABLES)), marks_(edges(letters_table::MARKS)) {
        for (const auto& [plain, from] : letters_table::PLAIN) {
            for (const auto& letter : letters(from)) plain_[letter] = letters(plain);
        }
        const List<std::string> pairs = letters(letters_table::PAIRS);
        for (std::size_t n = 0; n + 1 < pairs.size(); n += 2) plain_[pairs[n]] = {pairs[n + 1]};
        List<std::string> word;
        for (const auto& letter : letters(letters_table::SPELLED)) {
            if (letter != " ") {
                word.push_back(letter);
            } else {
                plain_[word.front()] = List<std::string>(word.begin() + 1, word.end());
                word.clear();
            }
        }
    }

    /// A text's code points, a text each; bytes that are no UTF-8 stand alone.
    List<std::string> letters(const std::string& text) const {
        List<std::string> out;
        for (std::size_t n = 0; n < text.size();) {
            const auto first = static_cast<unsigned char>(text[n]);
            std::size_t size = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : first >= 0xC0 ? 2 : 1;
            size = std::min(size, text.size() - n);
            out.push_back(text.substr(n, size));
            n += size;
        }
        return out;
    }

    /// A text without blanks at its ends.
    std::string stripped(const std::string& text) const {
        const List<std::string> all = letters(text);
        std::size_t first = 0, last = all.size();
        while (first < last && is_blank(all[first])) first++;
        while (last > first && is_blank(all[last - 1])) last--;
        return lang::joined(List<std::string>(all.begin() + first, all.begin() + last), "");
    }

    /// A word in small letters without accents, a letter each.
    List<std::string> plain(const std::string& word) const {
        List<std::string> out;
        for (const auto& letter : letters(word)) {
            const int number = code(letter);
            if (number >= 0xAC00 && number <= 0xD7A3) {  // Hangul: its syllables are taken apart
                const int tail = (number - 0xAC00) % 28, rest = (number - 0xAC00) / 28;
                out.push_back(encoded(0x1100 + rest / 21));
                out.push_back(encoded(0x1161 + rest % 21));
                if (tail > 0) out.push_back(encoded(0x11A7 + tail));
            } else if (!is(marks_, number)) {
                const auto found = plain_.find(letter);
                if (found == plain_.end()) {
                    out.push_back(letter);
                } else {
                    lang::extend(out, found->second);
                }
            }
        }
        return out;
    }

    /// "syllable" for a digit and for a letter of a script without small ones, "letter" for others, "mark" for what
    /// combines with the letter before it; "" for all else.
    std::string kind(const std::string& letter) const {
        const int number = code(letter);
        if (number >= 0x20000 && number < 0x32000) return "syllable";  // rare Han characters
        if (is(letters_, number)) return is(digits_, number) || is(syllables_, number) ? "syllable" : "letter";
        return is(marks_, number) ? "mark" : "";
    }

    /// A letter's code point.
    int code(const std::string& letter) const {
        const auto first = static_cast<unsigned char>(letter[0]);
        if (letter.size() == 1) return first;
        int out = letter.size() == 4 ? first & 0x07 : letter.size() == 3 ? first & 0x0F : first & 0x1F;
        for (std::size_t n = 1; n < letter.size(); n++) out = out << 6 | (static_cast<unsigned char>(letter[n]) & 0x3F);
        return out;
    }

    /// 0..99, the same for the same word: the checksum that ZIP files use.
    int scatter(const std::string& word) const {
        std::uint32_t out = 0xFFFFFFFF;
        for (const unsigned char byte : word) {
            out ^= byte;
            for (int bit = 0; bit < 8; bit++) out = out >> 1 ^ (out & 1 ? 0xEDB88320 : 0);
        }
        return static_cast<int>((out ^ 0xFFFFFFFF) % 100);
    }

private:
    List<int> letters_, digits_, syllables_, marks_;
    std::unordered_map<std::string, List<std::string>> plain_;

    template <std::size_t Count>
    static List<int> edges(const std::uint32_t (&runs)[Count]) {
        List<int> out;
        int at = 0;
        for (const std::uint32_t run : runs) out.push_back(at += static_cast<int>(run));
        return out;
    }

    static bool is(const List<int>& edges, int number) {
        if (number >= 0x10000) return false;
        return (std::upper_bound(edges.begin(), edges.end(), number) - edges.begin()) % 2 == 1;
    }

    bool is_blank(const std::string& letter) const {
        const int c = code(letter);
        return (c >= 9 && c <= 13) || (c >= 28 && c <= 32) || c == 0x85 || c == 0xA0 || c == 0x1680
            || (c >= 0x2000 && c <= 0x200A) || c == 0x2028 || c == 0x2029 || c == 0x202F || c == 0x205F || c == 0x3000;
    }

    static std::string encoded(int number) {  // of three bytes, as Hangul is
        return {static_cast<char>(0xE0 | number >> 12), static_cast<char>(0x80 | (number >> 6 & 0x3F)),
                static_cast<char>(0x80 | (number & 0x3F))};
    }
};

}  // namespace metagraph
