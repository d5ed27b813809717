// Requests that last: where to look, what to say, which mode to be in, which stance to stay in. Values; times are
// seconds.
//
// Translated from metagraph/playback/life/items.py; change that, and translate anew.
#pragma once

#include "alphabet.hpp"
#include "line_timing.hpp"
#include "spots.hpp"
#include "mood.hpp"
#include "spots.hpp"
#include "language.hpp"

namespace metagraph {

struct LookAt;
struct Speech;
struct ModeFrom;
struct PlaceFrom;
struct BlinkAt;
struct StayFrom;

namespace items {

inline double find_line_start(const Ref<Speech>& speech);
inline double measure_line(const Ref<Speech>& speech);
inline Ref<Speech> cut(const Ref<Speech>& speech, double at);
inline List<Ref<Speech>> apart(const List<Ref<Speech>>& speeches);
inline Ref<Speech> behind(const List<Ref<Speech>>& said, const Ref<Speech>& new_, double now);
inline Ref<Speech> going_on(const Ref<Speech>& old, const Ref<Speech>& new_, double now);
inline Ref<Speech> pace_speech(const Ref<Alphabet>& alphabet, const Ref<Speech>& new_);
inline Ref<Speech> _behind_words(
    const Ref<Speech>& old,
    const Ref<LineTiming>& told,
    const Ref<Speech>& new_,
    const Ref<LineTiming>& more,
    double now
);
inline bool alike_looks(const List<Ref<LookAt>>& one, const List<Ref<LookAt>>& other);
inline bool _same_look(const Ref<LookAt>& a, const Ref<LookAt>& b);
inline bool alike_speeches(const List<Ref<Speech>>& one, const List<Ref<Speech>>& other);
inline bool _same_speech(const Ref<Speech>& a, const Ref<Speech>& b);
inline bool alike_modes(const List<Ref<ModeFrom>>& one, const List<Ref<ModeFrom>>& other);
inline bool alike_places(const List<Ref<PlaceFrom>>& one, const List<Ref<PlaceFrom>>& other);
inline bool _same_place(const Ref<PlaceFrom>& a, const Ref<PlaceFrom>& b);
inline bool alike_blinks(const List<Ref<BlinkAt>>& one, const List<Ref<BlinkAt>>& other);
inline bool alike_stays(const List<Ref<StayFrom>>& one, const List<Ref<StayFrom>>& other);
inline bool _same_stay(const Ref<StayFrom>& a, const Ref<StayFrom>& b);
inline bool alike_felt(const List<Ref<MoodFrom>>& one, const List<Ref<MoodFrom>>& other);
inline bool _same_felt(const Ref<MoodFrom>& a, const Ref<MoodFrom>& b);

}  // namespace items

/// Look at a point or a named point from `start` until `end`, or until the next look. strict: without looking away.
struct LookAt {
    std::string id;
    double start;
    double end;
    Ref<Spot> to;
    double amount;
    bool strict;
    int priority;

    LookAt(
        std::string id_,
        double start_,
        double end_,
        Ref<Spot> to_,
        double amount_ = 1.0,
        bool strict_ = false,
        int priority_ = 1
    )
        : id(std::move(id_)),
            start(start_),
            end(end_),
            to(std::move(to_)),
            amount(amount_),
            strict(strict_),
            priority(priority_) {}
};

/// Something said. line: id of the project's line, None for `text` alone. priority: a higher one interrupts a lower
/// one. length: seconds that all of it would have taken, if it was cut short. timing: the times of its words and mouth
/// shapes, if known. skip: seconds of it that were said before a pause. more: whether more of it may come, so that it
/// is not over when it falls silent. over: when it was finished, if it had fallen silent before. asked: when the first
/// piece of its utterance was asked for, which all its pieces share and no other utterance of its id has.
struct Speech {
    std::string id;
    double start;
    double end;
    std::optional<std::string> line;
    std::string text;
    int priority;
    std::optional<double> length;
    Ref<LineTiming> timing;
    double skip;
    bool more;
    std::optional<double> over;
    double asked;

    Speech(
        std::string id_,
        double start_,
        double end_,
        std::optional<std::string> line_ = std::nullopt,
        std::string text_ = "",
        int priority_ = 1,
        std::optional<double> length_ = std::nullopt,
        Ref<LineTiming> timing_ = nullptr,
        double skip_ = 0.0,
        bool more_ = false,
        std::optional<double> over_ = std::nullopt,
        double asked_ = 0.0
    )
        : id(std::move(id_)),
            start(start_),
            end(end_),
            line(std::move(line_)),
            text(std::move(text_)),
            priority(priority_),
            length(length_),
            timing(std::move(timing_)),
            skip(skip_),
            more(more_),
            over(over_),
            asked(asked_) {}
};

/// The mode from `start` on; None for talking while something is said and idling otherwise.
struct ModeFrom {
    std::string id;
    double start;
    std::optional<std::string> mode;

    ModeFrom(std::string id_, double start_, std::optional<std::string> mode_)
        : id(std::move(id_)), start(start_), mode(std::move(mode_)) {}
};

/// Where a named point is from `start` on.
struct PlaceFrom {
    std::string id;
    double start;
    std::string name;
    List<double> point;

    PlaceFrom(std::string id_, double start_, std::string name_, List<double> point_)
        : id(std::move(id_)), start(start_), name(std::move(name_)), point(std::move(point_)) {}
};

/// A requested blink.
struct BlinkAt {
    std::string id;
    double start;

    BlinkAt(std::string id_, double start_)
        : id(std::move(id_)), start(start_) {}
};

/// From `start` on, the models change no stance of a layer, or may do so again with `on` false, until `end` or the next
/// item of this kind.
struct StayFrom {
    std::string id;
    double start;
    std::string layer;
    bool on;
    double end;

    StayFrom(std::string id_, double start_, std::string layer_, bool on_ = true, double end_ = INFINITY)
        : id(std::move(id_)), start(start_), layer(std::move(layer_)), on(on_), end(end_) {}
};

namespace items {

/// Return the second from which the times of a speech count: before its start if it continues after a pause.
inline double find_line_start(const Ref<Speech>& speech) {
    return speech->start - speech->skip;
}

/// Return how many seconds all of a speech takes, with the part before a pause and the part that was cut off.
inline double measure_line(const Ref<Speech>& speech) {
    return !speech->length.has_value() ? speech->end - items::find_line_start(speech) : *speech->length;
}

/// Return the speech, ending no later than `at`; it remembers its full length.
inline Ref<Speech> cut(const Ref<Speech>& speech, double at) {
    return speech->end <= at
        ? speech
        : lang::made<Speech>(
            speech->id,
            speech->start,
            at,
            speech->line,
            speech->text,
            speech->priority,
            items::measure_line(speech),
            speech->timing,
            speech->skip,
            speech->more,
            speech->over,
            speech->asked
        );
}

/// Return speeches, given in order, without overlaps: one of equal or higher importance cuts the running one, with its
/// later pieces; a less important one is dropped.
inline List<Ref<Speech>> apart(const List<Ref<Speech>>& speeches) {
    List<Ref<Speech>> out;
    Map<std::string, double> ends; // when what was cut would have ended
    for (const auto& speech : speeches) {
        if (lang::contains(ends, speech->id) && speech->start == ends.at(speech->id)) {
            ends[speech->id] = speech->end;
            continue;
        }
        if (lang::len(out) > 0 && lang::at(out, -1)->end > speech->start) {
            Ref<Speech> last = lang::at(out, -1);
            if (speech->priority < last->priority) {
                continue;
            }
            out.pop_back();
            if (last->id != speech->id) {
                ends[last->id] = last->end;
            }
            if (last->start < speech->start) {
                out.push_back(lang::made<Speech>(
                    items::cut(last, speech->start)->id,
                    items::cut(last, speech->start)->start,
                    items::cut(last, speech->start)->end,
                    items::cut(last, speech->start)->line,
                    items::cut(last, speech->start)->text,
                    items::cut(last, speech->start)->priority,
                    items::cut(last, speech->start)->length,
                    items::cut(last, speech->start)->timing,
                    items::cut(last, speech->start)->skip,
                    false,
                    items::cut(last, speech->start)->over,
                    items::cut(last, speech->start)->asked
                ));
            }
        }
        out.push_back(speech);
    }
    return out;
}

/// Return a text moved to after another one of its id that is being said, also if more of it may come. said: in order.
inline Ref<Speech> behind(const List<Ref<Speech>>& said, const Ref<Speech>& new_, double now) {
    if ((new_->timing != nullptr && !new_->timing->paced) || new_->line.has_value() || new_->start > now) {
        return new_;
    }
    double end = new_->start;
    for (const auto& speech : said) {
        bool paced = speech->timing == nullptr || speech->timing->paced;
        bool plain = paced && !speech->line.has_value() && !speech->length.has_value();
        if (speech->id == new_->id && plain && speech->start <= end && end < speech->end) {
            end = speech->end;
        }
    }
    return end == new_->start
        ? new_
        : lang::made<Speech>(
            new_->id,
            end,
            end + (new_->end - new_->start),
            new_->line,
            new_->text,
            new_->priority,
            new_->length,
            new_->timing,
            new_->skip,
            new_->more,
            new_->over,
            new_->asked
        );
}

/// Return a line as the continuation of the last one with the same id, if that has begun by `now` or begins with it: it
/// keeps the start and what has been said. Only lines whose words or shapes have times continue.
inline Ref<Speech> going_on(const Ref<Speech>& old, const Ref<Speech>& new_, double now) {
    if (old == nullptr || old->timing == nullptr || new_->timing == nullptr || old->length.has_value()) {
        return new_;
    }
    if (new_->timing->paced) {
        return old->end <= now ? new_ : items::_behind_words(old, old->timing, new_, new_->timing, now);
    }
    if (std::max(old->start, new_->start) > now && old->start != new_->start) {
        return new_;
    }
    double said = std::max(now - items::find_line_start(old), old->skip);
    if (old->end <= now
        && !line_timing::tells_on(old->timing, line_timing::shifted(new_->timing, old->timing->later))) {
        return new_;
    }
    Ref<LineTiming> told = (old->start > now && old->skip == 0)
        ? new_->timing
        : line_timing::place_told(old->timing, new_->timing, said);
    Ref<LineTiming> timing = line_timing::extended(old->timing, told, said);
    double length = std::max(line_timing::timed_seconds(timing, std::nullopt), new_->end - new_->start);
    bool more = new_->text == "" || new_->text == line_timing::told_text(new_->timing);
    return lang::made<Speech>(
        new_->id,
        old->start,
        items::find_line_start(old) + length,
        new_->line,
        more ? line_timing::told_text(timing) : new_->text,
        new_->priority,
        new_->length,
        timing,
        old->skip,
        new_->more,
        new_->over,
        new_->asked
    );
}

/// Return a text with times estimated from its letters, so that later pieces can be added.
inline Ref<Speech> pace_speech(const Ref<Alphabet>& alphabet, const Ref<Speech>& new_) {
    Ref<LineTiming> timing = line_timing::pace_text(alphabet, new_->text, std::nullopt);
    double length = line_timing::timed_seconds(timing, line_timing::measure_text(alphabet, new_->text));
    return lang::made<Speech>(
        new_->id,
        new_->start,
        new_->start + length,
        new_->line,
        new_->text,
        new_->priority,
        new_->length,
        timing,
        new_->skip,
        new_->more,
        new_->over,
        new_->asked
    );
}

/// Return a line with a text after its known words. told, more: the words of both.
inline Ref<Speech> _behind_words(
    const Ref<Speech>& old,
    const Ref<LineTiming>& told,
    const Ref<Speech>& new_,
    const Ref<LineTiming>& more,
    double now
) {
    double begin = items::find_line_start(old);
    double at = std::max(now - begin, std::max(old->skip, old->end - begin));
    Ref<LineTiming> timing = lang::made<LineTiming>(
        lang::together(told->words, line_timing::shifted(more, at)->words),
        told->marks,
        told->later,
        true
    );
    double length = line_timing::timed_seconds(timing, at + new_->end - new_->start);
    return lang::made<Speech>(
        new_->id,
        old->start,
        begin + length,
        new_->line,
        old->text + new_->text,
        new_->priority,
        new_->length,
        timing,
        old->skip,
        new_->more,
        new_->over,
        new_->asked
    );
}

/// Return whether the looks of two tracks are the same. The functions below compare other items.
inline bool alike_looks(const List<Ref<LookAt>>& one, const List<Ref<LookAt>>& other) {
    bool holds = lang::len(one) == lang::len(other);
    if (holds) {
        bool are_all = true;
        for (int n = 0; n < lang::len(one); n++) {
            const auto& a = lang::at(one, n);
            const auto& b = lang::at(other, n);
            if (!(a == b || items::_same_look(a, b))) {
                are_all = false;
                break;
            }
        }
        holds = are_all;
    }
    return holds;
}

inline bool _same_look(const Ref<LookAt>& a, const Ref<LookAt>& b) {
    if (!spots::is_same_spot(a->to, b->to) || a->amount != b->amount || a->strict != b->strict) {
        return false;
    }
    return a->id == b->id && a->start == b->start && a->end == b->end && a->priority == b->priority;
}

inline bool alike_speeches(const List<Ref<Speech>>& one, const List<Ref<Speech>>& other) {
    bool holds = lang::len(one) == lang::len(other);
    if (holds) {
        bool are_all = true;
        for (int n = 0; n < lang::len(one); n++) {
            const auto& a = lang::at(one, n);
            const auto& b = lang::at(other, n);
            if (!(a == b || items::_same_speech(a, b))) {
                are_all = false;
                break;
            }
        }
        holds = are_all;
    }
    return holds;
}

inline bool _same_speech(const Ref<Speech>& a, const Ref<Speech>& b) {
    if (a->line != b->line || a->text != b->text || a->length != b->length || a->priority != b->priority) {
        return false;
    }
    if (a->skip != b->skip || a->more != b->more || a->over != b->over || a->asked != b->asked) {
        return false;
    }
    return a->id == b->id
        && a->start == b->start
        && a->end == b->end
        && line_timing::alike_timings(a->timing, b->timing);
}

inline bool alike_modes(const List<Ref<ModeFrom>>& one, const List<Ref<ModeFrom>>& other) {
    bool holds = lang::len(one) == lang::len(other);
    if (holds) {
        bool are_all = true;
        for (int n = 0; n < lang::len(one); n++) {
            const auto& a = lang::at(one, n);
            const auto& b = lang::at(other, n);
            if (!(a == b || (a->id == b->id && a->start == b->start && a->mode == b->mode))) {
                are_all = false;
                break;
            }
        }
        holds = are_all;
    }
    return holds;
}

inline bool alike_places(const List<Ref<PlaceFrom>>& one, const List<Ref<PlaceFrom>>& other) {
    bool holds = lang::len(one) == lang::len(other);
    if (holds) {
        bool are_all = true;
        for (int n = 0; n < lang::len(one); n++) {
            const auto& a = lang::at(one, n);
            const auto& b = lang::at(other, n);
            if (!(a == b || items::_same_place(a, b))) {
                are_all = false;
                break;
            }
        }
        holds = are_all;
    }
    return holds;
}

inline bool _same_place(const Ref<PlaceFrom>& a, const Ref<PlaceFrom>& b) {
    if (a->id != b->id || a->start != b->start || a->name != b->name) {
        return false;
    }
    bool are_all = true;
    for (int n = 0; n < lang::len(a->point); n++) {
        const auto& x = lang::at(a->point, n);
        const auto& y = lang::at(b->point, n);
        if (!(x == y)) {
            are_all = false;
            break;
        }
    }
    return are_all;
}

inline bool alike_blinks(const List<Ref<BlinkAt>>& one, const List<Ref<BlinkAt>>& other) {
    bool holds = lang::len(one) == lang::len(other);
    if (holds) {
        bool are_all = true;
        for (int n = 0; n < lang::len(one); n++) {
            const auto& a = lang::at(one, n);
            const auto& b = lang::at(other, n);
            if (!(a == b || (a->id == b->id && a->start == b->start))) {
                are_all = false;
                break;
            }
        }
        holds = are_all;
    }
    return holds;
}

inline bool alike_stays(const List<Ref<StayFrom>>& one, const List<Ref<StayFrom>>& other) {
    bool holds = lang::len(one) == lang::len(other);
    if (holds) {
        bool are_all = true;
        for (int n = 0; n < lang::len(one); n++) {
            const auto& a = lang::at(one, n);
            const auto& b = lang::at(other, n);
            if (!(a == b || items::_same_stay(a, b))) {
                are_all = false;
                break;
            }
        }
        holds = are_all;
    }
    return holds;
}

inline bool _same_stay(const Ref<StayFrom>& a, const Ref<StayFrom>& b) {
    if (a->layer != b->layer || a->on != b->on || a->end != b->end) {
        return false;
    }
    return a->id == b->id && a->start == b->start;
}

inline bool alike_felt(const List<Ref<MoodFrom>>& one, const List<Ref<MoodFrom>>& other) {
    bool holds = lang::len(one) == lang::len(other);
    if (holds) {
        bool are_all = true;
        for (int n = 0; n < lang::len(one); n++) {
            const auto& a = lang::at(one, n);
            const auto& b = lang::at(other, n);
            if (!(a == b || items::_same_felt(a, b))) {
                are_all = false;
                break;
            }
        }
        holds = are_all;
    }
    return holds;
}

inline bool _same_felt(const Ref<MoodFrom>& a, const Ref<MoodFrom>& b) {
    if (a->valence != b->valence || a->arousal != b->arousal || a->intensity != b->intensity) {
        return false;
    }
    return a->id == b->id && a->start == b->start && a->end == b->end;
}

}  // namespace items

}  // namespace metagraph
