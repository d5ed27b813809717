// The times of a line's words and mouth shapes, as a synthesiser reports them: the mouth follows them and is shut in
// between. Times are seconds from the line's start.
//
// Translated from metagraph/playback/life/line_timing.py; change that, and translate anew.
#pragma once

#include "alphabet.hpp"
#include "graphemes.hpp"
#include "mouth.hpp"
#include "language.hpp"

namespace metagraph {

struct SpokenWord;
struct VisemeMark;
struct LineTiming;

namespace line_timing {

inline constexpr double WORD = 0.15; // seconds that a word takes if only its start is known and nothing comes sooner
inline constexpr double LETTER = 0.07; // and seconds for each of its letters
inline constexpr double SHAPE = 0.2; // seconds for which the last shape of a line stays
inline constexpr double FARTHEST = 3600.0; // seconds of a line
inline constexpr double AGAIN = 0.1; // a later piece belongs to a line from this many seconds before its last shape on
inline constexpr double SLACK = 0.05; // seconds by which times may exceed the given end
inline constexpr double MISSED = 0.1; // seconds by which a word may come late and only be cut short
// What each viseme of a set shows of the mouth shapes, and how fully.
inline const Map<std::string, std::string> OCULUS = Map<std::string, std::string>{
    {"sil", "sil"},
    {"PP", "PP"},
    {"FF", "FF"},
    {"TH", "TH"},
    {"DD", "DD"},
    {"kk", "kk"},
    {"CH", "CH"},
    {"SS", "SS"},
    {"nn", "nn"},
    {"RR", "RR"},
    {"aa", "aa"},
    {"E", "E"},
    {"ih", "I"},
    {"oh", "O"},
    {"ou", "U"},
    {"I", "I"},
    {"O", "O"},
    {"U", "U"}
};
// SAPI's numbers, which Azure has, too.
inline const Map<std::string, std::string> AZURE = Map<std::string, std::string>{
    {"0", "sil"},
    {"1", "E"},
    {"2", "aa"},
    {"3", "O"},
    {"4", "E"},
    {"5", "RR"},
    {"6", "I"},
    {"7", "U"},
    {"8", "O"},
    {"9", "aa"},
    {"10", "O"},
    {"11", "aa"},
    {"12", "kk"},
    {"13", "RR"},
    {"14", "nn"},
    {"15", "SS"},
    {"16", "CH"},
    {"17", "TH"},
    {"18", "FF"},
    {"19", "DD"},
    {"20", "kk"},
    {"21", "PP"}
};
// Amazon Polly's speech marks.
inline const Map<std::string, std::string> POLLY = Map<std::string, std::string>{
    {"sil", "sil"},
    {"p", "PP"},
    {"t", "DD"},
    {"S", "CH"},
    {"T", "TH"},
    {"f", "FF"},
    {"k", "kk"},
    {"i", "I"},
    {"r", "RR"},
    {"s", "SS"},
    {"u", "U"},
    {"@", "E"},
    {"a", "aa"},
    {"e", "E"},
    {"E", "E"},
    {"o", "O"},
    {"O", "O"}
};
// Of ARKit's blend shapes those that make the mouth.
inline const Map<std::string, std::string> ARKIT = Map<std::string, std::string>{
    {"jawOpen", "aa"},
    {"mouthClose", "PP"},
    {"mouthPressLeft", "PP"},
    {"mouthPressRight", "PP"},
    {"mouthFunnel", "O"},
    {"mouthPucker", "U"},
    {"mouthRollLower", "FF"},
    {"mouthRollUpper", "PP"},
    {"mouthStretchLeft", "E"},
    {"mouthStretchRight", "E"},
    {"mouthSmileLeft", "I"},
    {"mouthSmileRight", "I"},
    {"mouthShrugUpper", "CH"},
    {"tongueOut", "TH"}
};
inline const List<std::string> SETS = List<std::string>{"oculus", "azure", "sapi", "polly", "arkit"};
inline const Map<std::string, double> WEAK = Map<std::string, double>{
    {"@", 0.6},
    {"12", 0.5},
    {"1", 0.8},
    {"mouthSmileLeft", 0.3},
    {"mouthSmileRight", 0.3}
};
inline bool alike_timings(const Ref<LineTiming>& one, const Ref<LineTiming>& other);
inline Map<std::string, std::string> _table(const std::string& name);
inline std::string set_of(const List<Ref<VisemeMark>>& marks);
inline std::string wrong_in(
    const List<Ref<SpokenWord>>& words,
    const List<Ref<VisemeMark>>& marks,
    const std::string& name,
    const std::optional<double>& duration
);
inline std::string _out_of_range(double seconds);
inline Ref<LineTiming> timing_of(
    const Ref<Alphabet>& alphabet,
    const List<Ref<SpokenWord>>& words,
    const List<Ref<VisemeMark>>& marks,
    const std::string& name
);
inline double measure_text(const Ref<Alphabet>& alphabet, const std::string& text);
inline Ref<LineTiming> pace_text(
    const Ref<Alphabet>& alphabet,
    const std::string& text,
    const std::optional<double>& seconds
);
inline double _measure_word(const Ref<Alphabet>& alphabet, const std::string& word);
inline List<Ref<SpokenWord>> join_letters(const Ref<Alphabet>& alphabet, const List<Ref<SpokenWord>>& letters);
inline std::string told_text(const Ref<LineTiming>& timing);
inline double timed_seconds(const Ref<LineTiming>& timing, const std::optional<double>& duration);
inline Ref<Spelled> timed_sounds(const Ref<Alphabet>& alphabet, const Ref<LineTiming>& timing);
inline List<double> _ends(const List<Ref<VisemeMark>>& marks);
inline bool tells_on(const Ref<LineTiming>& old, const Ref<LineTiming>& new_);
inline Ref<LineTiming> shifted(const Ref<LineTiming>& timing, double by);
inline Ref<LineTiming> place_told(const Ref<LineTiming>& old, const Ref<LineTiming>& new_, double said);
inline bool comes_late(double first, double last, double silent, double said);
inline bool restarts(const Ref<LineTiming>& old, const Ref<LineTiming>& new_, double said);
inline bool _alike(const Ref<SpokenWord>& one, const Ref<SpokenWord>& other);
inline double _end(const Ref<SpokenWord>& word);
inline double _end_of(const Ref<LineTiming>& timing);
inline Ref<LineTiming> extended(const Ref<LineTiming>& old, const Ref<LineTiming>& new_, double said);
inline bool _told(const List<Ref<VisemeMark>>& marks, const Ref<VisemeMark>& mark);

}  // namespace line_timing

/// A word from `start` to `end`; `end` is None if only its start is known.
struct SpokenWord {
    std::string text;
    double start;
    std::optional<double> end;

    SpokenWord(std::string text_, double start_, std::optional<double> end_ = std::nullopt)
        : text(std::move(text_)), start(start_), end(end_) {}
};

/// A mouth shape from `at` until the next mark of a later time. viseme: its name in its set; in a `LineTiming`, one of
/// `VISEMES`. weight: how fully it is made, 0..1.
struct VisemeMark {
    double at;
    std::string viseme;
    double weight;

    VisemeMark(double at_, std::string viseme_, double weight_ = 1.0)
        : at(at_), viseme(std::move(viseme_)), weight(weight_) {}
};

/// A line's words and mouth shapes, each by time. later: seconds by which later pieces are delayed, because one came
/// after its time. paced: whether the times are estimated from the letters.
struct LineTiming {
    List<Ref<SpokenWord>> words;
    List<Ref<VisemeMark>> marks;
    double later;
    bool paced;

    explicit LineTiming(
        List<Ref<SpokenWord>> words_ = List<Ref<SpokenWord>>{},
        List<Ref<VisemeMark>> marks_ = List<Ref<VisemeMark>>{},
        double later_ = 0.0,
        bool paced_ = false
    )
        : words(std::move(words_)), marks(std::move(marks_)), later(later_), paced(paced_) {}
};

namespace line_timing {

/// Return whether two lines have the same words and shapes at the same times.
inline bool alike_timings(const Ref<LineTiming>& one, const Ref<LineTiming>& other) {
    if (one == nullptr || other == nullptr) {
        return one == nullptr && other == nullptr;
    }
    if (lang::len(one->words) != lang::len(other->words) || lang::len(one->marks) != lang::len(other->marks)) {
        return false;
    }
    bool are_all = true;
    for (int n = 0; n < lang::len(one->words); n++) {
        const auto& a = lang::at(one->words, n);
        const auto& b = lang::at(other->words, n);
        if (!(a->text == b->text && a->start == b->start && a->end == b->end)) {
            are_all = false;
            break;
        }
    }
    bool words = are_all;
    bool holds = words;
    if (holds) {
        bool are_all2 = true;
        for (int n = 0; n < lang::len(one->marks); n++) {
            const auto& a = lang::at(one->marks, n);
            const auto& b = lang::at(other->marks, n);
            if (!(a->at == b->at && a->viseme == b->viseme && a->weight == b->weight)) {
                are_all2 = false;
                break;
            }
        }
        holds = are_all2;
    }
    return holds;
}

inline Map<std::string, std::string> _table(const std::string& name) {
    if (name == "oculus") {
        return line_timing::OCULUS;
    }
    if (name == "polly") {
        return line_timing::POLLY;
    }
    return name == "arkit" ? line_timing::ARKIT : line_timing::AZURE;
}

/// Return the first set that has all of the visemes, "" if none has.
inline std::string set_of(const List<Ref<VisemeMark>>& marks) {
    for (const auto& name : line_timing::SETS) {
        bool are_all = true;
        for (const auto& mark : marks) {
            if (!lang::contains(line_timing::_table(name), mark->viseme)) {
                are_all = false;
                break;
            }
        }
        if (are_all) {
            return name;
        }
    }
    return "";
}

/// Return what is wrong with a line's times, where, and what would be right; "" if nothing is wrong.
///
/// name: of the visemes' set, "" to find it by their names. duration: seconds of its sound, None if unknown.
inline std::string wrong_in(
    const List<Ref<SpokenWord>>& words,
    const List<Ref<VisemeMark>>& marks,
    const std::string& name,
    const std::optional<double>& duration
) {
    double last = 0.0;
    std::string why{};
    for (int n = 0; n < lang::len(words); n++) {
        const auto& word = lang::at(words, n);
        std::string place = lang::text("words[", n, "] '", word->text, "'");
        why = line_timing::_out_of_range(word->start);
        if (why == "" && word->start < last) {
            why = lang::text(
                "begins at ",
                lang::fixed(word->start, 3),
                " s, before the one before it; put words in order"
            );
        }
        double end = !word->end.has_value() ? word->start : *word->end;
        if (why == "" && !(end >= word->start)) {
            why = lang::text(
                "ends at ",
                lang::fixed(end, 3),
                " s, before it begins; give [word, start, end] in seconds"
            );
        }
        if (why == "" && duration.has_value() && end > *duration + line_timing::SLACK) {
            why = lang::text(
                "ends at ",
                lang::fixed(end, 3),
                " s, past the end at ",
                lang::fixed(*duration, 3),
                " s; give a longer duration"
            );
        }
        if (why != "") {
            return lang::text(place, ": ", why);
        }
        last = word->start;
    }
    if (name != "" && !lang::contains(line_timing::SETS, name)) {
        return lang::text("set: '", name, "' is no set of visemes; there are ", lang::joined(line_timing::SETS, ", "));
    }
    std::string found = name == "" ? line_timing::set_of(marks) : name;
    last = 0.0;
    for (int n = 0; n < lang::len(marks); n++) {
        const auto& mark = lang::at(marks, n);
        why = line_timing::_out_of_range(mark->at);
        if (why == "" && mark->at < last) {
            why = lang::text(
                "comes at ",
                lang::fixed(mark->at, 3),
                " s, before the one before it; put visemes in order"
            );
        }
        if (why == "" && duration.has_value() && mark->at > *duration + line_timing::SLACK) {
            why = lang::text(
                "comes at ",
                lang::fixed(mark->at, 3),
                " s, past the end at ",
                lang::fixed(*duration, 3),
                " s; give a longer duration"
            );
        }
        if (why == "" && !(0 <= mark->weight && mark->weight <= 1)) {
            why = lang::text("has the weight ", lang::fixed(mark->weight, 3), "; weights are from 0 to 1");
        }
        if (why == "" && found == "" && line_timing::set_of(List<Ref<VisemeMark>>{mark}) == "") {
            why = lang::text("is in no set of visemes; there are ", lang::joined(line_timing::SETS, ", "));
        }
        if (why == "" && found != "" && !lang::contains(line_timing::_table(found), mark->viseme)) {
            why = lang::text(
                "is not in the set '",
                found,
                "', which has ",
                lang::joined(lang::keys(line_timing::_table(found)), ", ")
            );
        }
        if (why != "") {
            return lang::text("visemes[", n, "] '", mark->viseme, "': ", why);
        }
        last = mark->at;
    }
    if (found == "") {
        return lang::text("visemes: no set has all of them; there are ", lang::joined(line_timing::SETS, ", "));
    }
    return "";
}

inline std::string _out_of_range(double seconds) {
    if (0 <= seconds && seconds <= line_timing::FARTHEST) {
        return "";
    }
    return lang::text(
        "is at ",
        lang::fixed(seconds, 3),
        " s; times are from 0 to ",
        lang::fixed(line_timing::FARTHEST, 1),
        " s from the line's start"
    );
}

/// Return the timing of words and visemes that are valid. name: as for `wrong_in`.
inline Ref<LineTiming> timing_of(
    const Ref<Alphabet>& alphabet,
    const List<Ref<SpokenWord>>& words,
    const List<Ref<VisemeMark>>& marks,
    const std::string& name
) {
    Map<std::string, std::string> table = line_timing::_table(name == "" ? line_timing::set_of(marks) : name);
    List<Ref<VisemeMark>> shown;
    for (const auto& m : marks) {
        shown.push_back(lang::made<VisemeMark>(
            m->at,
            table.at(m->viseme),
            m->weight * lang::get_or(line_timing::WEAK, m->viseme, 1.0)
        ));
    }
    List<Ref<SpokenWord>> said;
    for (int n = 0; n < lang::len(words); n++) {
        const auto& word = lang::at(words, n);
        double end = !word->end.has_value()
            ? word->start + line_timing::WORD + line_timing::LETTER * lang::len(alphabet->letters(word->text))
            : *word->end;
        if (n + 1 < lang::len(words)) {
            end = std::min(end, lang::at(words, n + 1)->start);
        }
        if (!word->end.has_value()) { // a pause ends it
            double first = end;
            for (const auto& m : shown) {
                if (m->viseme == "sil" && m->at > word->start) {
                    first = m->at;
                    break;
                }
            }
            end = std::min(end, first);
        }
        said.push_back(lang::made<SpokenWord>(word->text, word->start, std::max(end, word->start)));
    }
    return lang::made<LineTiming>(said, shown);
}

/// Return how many seconds a text takes as a part of a longer text.
inline double measure_text(const Ref<Alphabet>& alphabet, const std::string& text) {
    double out = 0.0;
    for (const auto& [word, pause] : graphemes::split_words(alphabet, text)) {
        out += line_timing::_measure_word(alphabet, word) + pause / graphemes::PACE;
    }
    return out;
}

/// Return the words of a text, one after the other. seconds: how long all of it takes, None to estimate it from the
/// letters.
inline Ref<LineTiming> pace_text(
    const Ref<Alphabet>& alphabet,
    const std::string& text,
    const std::optional<double>& seconds
) {
    double scale = !seconds.has_value() ? 1.0 : *seconds / std::max(line_timing::measure_text(alphabet, text), 0.001);
    double at = 0.0;
    List<Ref<SpokenWord>> words;
    for (const auto& [word, pause] : graphemes::split_words(alphabet, text)) {
        double end = at + scale * line_timing::_measure_word(alphabet, word);
        if (word != "") {
            words.push_back(lang::made<SpokenWord>(word, at, end));
        }
        at = end + scale * pause / graphemes::PACE;
    }
    return lang::made<LineTiming>(words, List<Ref<VisemeMark>>{}, 0.0, true);
}

/// Return how long a word takes, seconds.
inline double _measure_word(const Ref<Alphabet>& alphabet, const std::string& word) {
    List<double> found;
    for (const auto& letter : alphabet->letters(word)) {
        found.push_back(graphemes::measure_letter(alphabet->code(letter)));
    }
    return lang::sum(found) / graphemes::PACE;
}

/// Return the words of letters that have a time each. Blanks separate words, and so does each letter that is a
/// syllable.
inline List<Ref<SpokenWord>> join_letters(const Ref<Alphabet>& alphabet, const List<Ref<SpokenWord>>& letters) {
    List<Ref<SpokenWord>> out;
    bool parted = true;
    for (const auto& letter : letters) {
        if (alphabet->stripped(letter->text) == "") {
            parted = true;
            continue;
        }
        bool alone = graphemes::measure_letter(alphabet->code(lang::at(alphabet->letters(letter->text), 0))) > 1;
        if (parted || alone) {
            out.push_back(letter);
        } else {
            Ref<SpokenWord> last = lang::at(out, -1);
            lang::at(out, lang::len(out) - 1) = lang::made<SpokenWord>(
                last->text + letter->text,
                last->start,
                letter->end
            );
        }
        parted = alone;
    }
    return out;
}

/// Return the words of a line as its text.
inline std::string told_text(const Ref<LineTiming>& timing) {
    List<std::string> found;
    for (const auto& word : timing->words) {
        found.push_back(word->text);
    }
    return lang::joined(found, " ");
}

/// Return how long a line lasts, rounded to whole rows of the mouth's track, so that later additions move nothing.
/// duration: of its sound, None for as long as its words and shapes need.
inline double timed_seconds(const Ref<LineTiming>& timing, const std::optional<double>& duration) {
    double last = line_timing::_end_of(timing);
    return static_cast<int>(std::ceil((!duration.has_value() ? last + mouth::LATE : std::max(*duration, last))
                / mouth::STEP
            - 1e-06))
        * mouth::STEP;
}

/// Return the mouth's pieces and the syllables of a line's words and shapes: the mouth follows the shapes if there are
/// any; gestures and blinks follow the words.
inline Ref<Spelled> timed_sounds(const Ref<Alphabet>& alphabet, const Ref<LineTiming>& timing) {
    Ref<Spelled> out = lang::made<Spelled>();
    for (const auto& word : timing->words) {
        List<Ref<SpelledSound>> plan = graphemes::sounds(alphabet, word->text);
        double over = !word->end.has_value() ? word->start : *word->end;
        if (lang::len(plan) > 0 && over > word->start) {
            out->add(plan, word->start, over);
        }
    }
    if (lang::len(timing->marks) == 0) {
        return out;
    }
    Ref<Spelled> shown = lang::made<Spelled>();
    std::string before = "sil";
    for (int n = 0; n < lang::len(timing->marks); n++) {
        const auto& mark = lang::at(timing->marks, n);
        const auto& end = lang::at(line_timing::_ends(timing->marks), n);
        if (mark->viseme != "sil" && end > mark->at) {
            shown->pieces.push_back(lang::made<MouthPiece>(mark->at, end, mark->viseme, mark->weight));
            if (lang::contains(mouth::VOWELS, mark->viseme)
                && !lang::contains(mouth::VOWELS, before)
                && mark->weight > 0) {
                shown->peaks.push_back(0.5 * (mark->at + end));
                shown->strengths.push_back(mark->weight * std::min(1.0, 0.3 + 4 * (end - mark->at)));
            }
        }
        before = mark->viseme;
    }
    if (lang::len(out->peaks) > 0) {
        return lang::made<Spelled>(shown->pieces, out->peaks, out->strengths);
    }
    return shown;
}

/// Return when each mark ends: marks at the same time show together.
inline List<double> _ends(const List<Ref<VisemeMark>>& marks) {
    List<double> out;
    double end = 0.0;
    double at = -1.0;
    for (const auto& mark : lang::backwards(marks)) {
        if (mark->at != at) {
            end = at < 0 ? mark->at + line_timing::SHAPE : at;
            at = mark->at;
        }
        out.push_back(end);
    }
    return lang::backwards(out);
}

/// Return whether a piece that comes after the end of a line belongs to the same line: it begins after the last known
/// word or shape, or repeats all with more behind it. Otherwise it is something else under the same id.
inline bool tells_on(const Ref<LineTiming>& old, const Ref<LineTiming>& new_) {
    if (lang::len(new_->words) > 0 && lang::len(old->words) > 0) {
        Ref<SpokenWord> first = lang::at(new_->words, 0);
        if (first->start > lang::at(old->words, -1)->start) {
            return true;
        }
        bool same = first->text == lang::at(old->words, 0)->text && first->start == lang::at(old->words, 0)->start;
        return same && lang::len(new_->words) > lang::len(old->words);
    }
    if (lang::len(new_->marks) > 0 && lang::len(old->marks) > 0) {
        Ref<VisemeMark> shape = lang::at(new_->marks, 0);
        if (shape->at >= lang::at(old->marks, -1)->at - line_timing::AGAIN) {
            return true;
        }
        return shape->at == lang::at(old->marks, 0)->at && lang::len(new_->marks) > lang::len(old->marks);
    }
    return false;
}

/// Return a timing `by` seconds later.
inline Ref<LineTiming> shifted(const Ref<LineTiming>& timing, double by) {
    if (by == 0) {
        return timing;
    }
    List<Ref<SpokenWord>> words;
    for (const auto& word : timing->words) {
        words.push_back(lang::made<SpokenWord>(
            word->text,
            word->start + by,
            !word->end.has_value() ? std::nullopt : std::optional<double>(*word->end + by)
        ));
    }
    List<Ref<VisemeMark>> found;
    for (const auto& mark : timing->marks) {
        found.push_back(lang::made<VisemeMark>(mark->at + by, mark->viseme, mark->weight));
    }
    return lang::made<LineTiming>(words, found);
}

/// Return a later piece of a line with the times at which it is said. A piece that counts from its own beginning
/// follows the earlier pieces. A piece that comes too late, because the voice had stopped, is said at once, and
/// everything after it is delayed. said: seconds of the line that are over.
inline Ref<LineTiming> place_told(const Ref<LineTiming>& old, const Ref<LineTiming>& new_, double said) {
    double end = line_timing::_end_of(old);
    if (line_timing::restarts(old, new_, said)) {
        return lang::made<LineTiming>(
            line_timing::shifted(new_, std::max(said, end))->words,
            line_timing::shifted(new_, std::max(said, end))->marks,
            old->later,
            line_timing::shifted(new_, std::max(said, end))->paced
        );
    }
    Ref<LineTiming> told = line_timing::shifted(new_, old->later);
    double by = 0.0;
    if (lang::len(old->words) > 0 && lang::len(told->words) > 0) {
        List<Ref<SpokenWord>> words;
        for (const auto& word : told->words) {
            if (word->start > lang::at(old->words, -1)->start) {
                words.push_back(word);
            }
        }
        bool holds = lang::len(words) > 0;
        if (holds) {
            List<double> found;
            for (const auto& word : words) {
                found.push_back(line_timing::_end(word));
            }
            holds = line_timing::comes_late(lang::at(words, 0)->start, lang::max_of(found), end, said);
        }
        if (holds) {
            by = std::max(said, end) - lang::at(words, 0)->start;
        }
    } else if (lang::len(old->marks) > 0 && lang::len(told->marks) > 0) {
        List<Ref<VisemeMark>> marks;
        for (const auto& mark : told->marks) {
            if (mark->at > lang::at(old->marks, -1)->at) {
                marks.push_back(mark);
            }
        }
        if (lang::len(marks) > 0
            && line_timing::comes_late(
                lang::at(marks, 0)->at,
                lang::at(marks, -1)->at + line_timing::SHAPE,
                end,
                said
            )) {
            by = std::max(said, end) - lang::at(marks, 0)->at;
        }
    }
    return lang::made<LineTiming>(
        line_timing::shifted(told, by)->words,
        line_timing::shifted(told, by)->marks,
        old->later + by,
        line_timing::shifted(told, by)->paced
    );
}

/// Return whether what is new of a line comes too late: all of it, or its beginning after the voice had stopped. first,
/// last: when it would begin and end; silent: when what was known before ends; said: as for `place_told`.
inline bool comes_late(double first, double last, double silent, double said) {
    return last <= said || (first < said - line_timing::MISSED && silent <= said);
}

/// Return whether a piece of a line counts its times from 0 again: it lies at the beginning of the line, but does not
/// repeat it.
inline bool restarts(const Ref<LineTiming>& old, const Ref<LineTiming>& new_, double said) {
    bool again{};
    if (lang::len(old->words) > 0 && lang::len(new_->words) > 0) {
        int same = 0;
        while (same < std::min(lang::len(old->words), lang::len(new_->words))
            && line_timing::_alike(lang::at(old->words, same), lang::at(new_->words, same))) {
            same += 1;
        }
        again = same > 0 && lang::len(new_->words) >= lang::len(old->words);
        return same < lang::len(new_->words)
            && !again
            && lang::at(new_->words, 0)->start < line_timing::_end(lang::at(old->words, 0));
    }
    if (lang::len(old->marks) > 0 && lang::len(new_->marks) > 0) {
        bool are_all = true;
        for (int n = 0; n < lang::len(old->marks); n++) {
            const auto& a = lang::at(old->marks, n);
            const auto& b = lang::at(new_->marks, n);
            if (!(a->viseme == b->viseme && std::abs(a->at - b->at) < line_timing::SLACK)) {
                are_all = false;
                break;
            }
        }
        again = are_all;
        double first = lang::at(new_->marks, 0)->at;
        return !again && first < lang::at(old->marks, 0)->at + line_timing::SLACK && first < said;
    }
    return false;
}

inline bool _alike(const Ref<SpokenWord>& one, const Ref<SpokenWord>& other) {
    return one->text == other->text && std::abs(one->start - other->start) < line_timing::SLACK;
}

inline double _end(const Ref<SpokenWord>& word) {
    return !word->end.has_value() ? word->start : *word->end;
}

/// Return when the last word or shape ends.
inline double _end_of(const Ref<LineTiming>& timing) {
    List<double> found;
    for (const auto& word : timing->words) {
        found.push_back(line_timing::_end(word));
    }
    double end = lang::max_of(lang::together(List<double>{0.0}, found));
    if (lang::len(timing->marks) > 0) {
        Ref<VisemeMark> mark = lang::at(timing->marks, -1);
        end = std::max(end, mark->at + (mark->viseme == "sil" ? 0.0 : line_timing::SHAPE));
    }
    return end;
}

/// Return a line's timing with a later piece: the old timing stays up to `said` seconds, and up to the beginning of the
/// new piece. Of a word or shape that has begun meanwhile, the rest is said.
inline Ref<LineTiming> extended(const Ref<LineTiming>& old, const Ref<LineTiming>& new_, double said) {
    List<Ref<SpokenWord>> words = old->words;
    List<double> found;
    for (const auto& word : old->words) {
        if (word->start < said) {
            found.push_back(word->start);
        }
    }
    double begun = lang::max_of(lang::together(List<double>{-1.0}, found));
    List<Ref<SpokenWord>> coming;
    for (const auto& word : new_->words) {
        if (word->start >= said
            || (word->start > begun && (!word->end.has_value() ? word->start : *word->end) > said)) {
            coming.push_back(word);
        }
    }
    double until{};
    if (lang::len(coming) > 0) {
        until = std::max(said, lang::at(new_->words, 0)->start);
        double first = std::max(lang::at(coming, 0)->start, said);
        List<Ref<SpokenWord>> found2;
        for (const auto& word : old->words) {
            if (word->start < until) {
                found2.push_back(lang::made<SpokenWord>(
                    word->text,
                    word->start,
                    std::min(!word->end.has_value() ? first : *word->end, first)
                ));
            }
        }
        words = found2;
        List<Ref<SpokenWord>> found3;
        for (const auto& word : coming) {
            found3.push_back(lang::made<SpokenWord>(word->text, std::max(word->start, said), word->end));
        }
        lang::extend(words, found3);
    }
    List<Ref<VisemeMark>> marks = old->marks;
    List<double> found4;
    for (const auto& mark : new_->marks) {
        if (mark->at < said) {
            found4.push_back(mark->at);
        }
    }
    double now = lang::max_of(lang::together(List<double>{-1.0}, found4));
    List<double> found5;
    for (const auto& mark : old->marks) {
        if (mark->at < said) {
            found5.push_back(mark->at);
        }
    }
    double over = lang::max_of(lang::together(List<double>{-1.0}, found5));
    List<Ref<VisemeMark>> shown;
    for (const auto& mark : new_->marks) {
        if (mark->at >= said || (mark->at == now && now >= over && !line_timing::_told(old->marks, mark))) {
            shown.push_back(lang::made<VisemeMark>(std::max(mark->at, said), mark->viseme, mark->weight));
        }
    }
    if (lang::len(shown) > 0) {
        until = std::max(said, lang::at(new_->marks, 0)->at);
        List<Ref<VisemeMark>> found6;
        for (const auto& mark : old->marks) {
            if (mark->at < until) {
                found6.push_back(mark);
            }
        }
        marks = found6;
        lang::extend(marks, shown);
    }
    return lang::made<LineTiming>(words, marks, new_->later);
}

inline bool _told(const List<Ref<VisemeMark>>& marks, const Ref<VisemeMark>& mark) {
    bool is_any = false;
    for (const auto& m : marks) {
        if (m->at == mark->at && m->viseme == mark->viseme) {
            is_any = true;
            break;
        }
    }
    return is_any;
}

}  // namespace line_timing

}  // namespace metagraph
