// Break off, pause, resume and finish utterances. An utterance is everything that is said under one id, piece by piece,
// until it is over. Times are seconds.
//
// A paused utterance is moved to a time that never comes (`PAUSED`), each to a slot of its own.
//
// Translated from metagraph/playback/life/utterances.py; change that, and translate anew.
#pragma once

#include "alphabet.hpp"
#include "graphemes.hpp"
#include "items.hpp"
#include "line_timing.hpp"
#include "track.hpp"
#include "mood.hpp"
#include "language.hpp"

namespace metagraph {


namespace utterances {

inline constexpr double PAUSED = 1000000000.0; // seconds from which on lies what is paused
inline constexpr double VOICE = 0.04; // seconds in which a voice can begin; more than lips look ahead
inline constexpr double EARLIER = 0.03; // seconds by which it can stop sooner, since a mouth takes its time to close
// seconds of silence after which nothing more is awaited of what was promised to go on
inline constexpr double FORGOTTEN = 60.0;
inline constexpr double TOGETHER = 0.001; // seconds between two pieces of one utterance, at most
inline double find_soon(double now, double lookahead);
inline bool is_paused(double start);
inline bool takes_more(const Ref<Speech>& speech);
inline bool goes_on(const List<Ref<Speech>>& speeches, const std::string& ident, double now);
inline List<std::string> find_utterances(const Ref<Track>& track, const std::string& what, double now);
inline List<std::string> find_forgotten(const Ref<Track>& track, double now);
inline double find_stop(
    const Ref<Alphabet>& alphabet,
    const Ref<Track>& track,
    const std::string& ident,
    double soon,
    double now
);
inline double find_slot(const Ref<Track>& track);
inline Ref<Track> break_off(const Ref<Track>& track, const std::string& ident, double stop);
inline Ref<Track> finish_speech(const Ref<Track>& track, const std::string& ident, double soon);
inline Ref<Track> _closed(
    const Ref<Track>& track,
    const List<Ref<Speech>>& speeches,
    const Ref<Speech>& of,
    double now,
    bool cuts
);
inline Ref<MoodFrom> _until(const Ref<MoodFrom>& mood, double end);
inline Ref<Track> pause(
    const Ref<Track>& track,
    const std::string& ident,
    const Set<std::string>& made,
    double stop,
    double slot
);
inline Ref<Track> resume(const Ref<Track>& track, const std::string& ident, const Set<std::string>& made, double soon);
inline Ref<Track> _moved(
    const Ref<Track>& track,
    const List<Ref<Speech>>& speeches,
    const Set<std::string>& made,
    double low,
    double high,
    double by
);
inline std::string explain_end(const List<Ref<Speech>>& speeches, const Ref<Speech>& speech);

}  // namespace utterances

namespace utterances {

/// Return when a voice can begin: sooner than gestures, which blend. At the very beginning it can begin at once,
/// because nothing has been shown.
inline double find_soon(double now, double lookahead) {
    return now > 0 ? now + std::min(lookahead, utterances::VOICE) : 0.0;
}

/// Return whether an item with this start is paused.
inline bool is_paused(double start) {
    return start >= utterances::PAUSED;
}

/// Return whether more can be added to a piece that is not being said: more was announced, or it is paused.
inline bool takes_more(const Ref<Speech>& speech) {
    return speech->more || speech->start >= utterances::PAUSED;
}

/// Return whether an utterance is not over at `now`: it is being said, will be said, is paused, or expects more.
inline bool goes_on(const List<Ref<Speech>>& speeches, const std::string& ident, double now) {
    Ref<Speech> first;
    for (const auto& s : lang::backwards(speeches)) {
        if (s->id == ident) {
            first = s;
            break;
        }
    }
    Ref<Speech> last = first;
    return last != nullptr && (last->end > now || last->more);
}

/// Return the ids of the utterances that are not over at `now`; what: of one, "" for all.
inline List<std::string> find_utterances(const Ref<Track>& track, const std::string& what, double now) {
    if (what != "") {
        return utterances::goes_on(track->speeches, what, now) ? List<std::string>{what} : List<std::string>{};
    }
    Map<std::string, Ref<Speech>> last;
    for (const auto& s : track->speeches) {
        last[s->id] = s;
    }
    Set<std::string> lasting;
    for (const auto& s : track->speeches) {
        if ((s->end > now || s->more) && last.at(s->id) == s) {
            lasting.insert(s->id);
        }
    }
    List<std::string> out;
    for (const auto& speech : track->speeches) {
        if (lang::contains(lasting, speech->id) && !lang::contains(out, speech->id)) {
            out.push_back(speech->id);
        }
    }
    return out;
}

/// Return the ids of the utterances of which more was promised, and nothing has come for `FORGOTTEN`.
inline List<std::string> find_forgotten(const Ref<Track>& track, double now) {
    List<Ref<Speech>> silent;
    for (const auto& s : track->speeches) {
        if (s->more && s->end < now - utterances::FORGOTTEN) {
            silent.push_back(s);
        }
    }
    List<std::string> found;
    for (const auto& s : silent) {
        if (track->last_speech(s->id) == s) {
            found.push_back(s->id);
        }
    }
    return found;
}

/// Return when the voice of an utterance stops: at the end of the current sound, at `soon` at the latest; at once if
/// its sounds are unknown or it is in a pause; at its start if it has not begun. now: when gestures can stop.
inline double find_stop(
    const Ref<Alphabet>& alphabet,
    const Ref<Track>& track,
    const std::string& ident,
    double soon,
    double now
) {
    double first = now > soon ? soon - utterances::EARLIER : soon;
    Ref<Speech> first2;
    for (const auto& s : track->speeches) {
        if (s->id == ident && s->start < first && first < s->end) {
            first2 = s;
            break;
        }
    }
    Ref<Speech> running = first2;
    if (running == nullptr) {
        List<double> coming;
        for (const auto& s : track->speeches) {
            if (s->id == ident && s->start >= first) {
                coming.push_back(s->start);
            }
        }
        return lang::len(coming) > 0 ? lang::min_of(lang::together(coming, List<double>{utterances::PAUSED})) : soon;
    }
    if (running->line.has_value() && running->timing == nullptr) {
        return first;
    }
    double begin = items::find_line_start(running);
    Ref<Spelled> said = running->timing == nullptr
        ? graphemes::spelled(alphabet, running->text, items::measure_line(running))
        : line_timing::timed_sounds(alphabet, running->timing);
    List<double> ends;
    for (const auto& p : said->pieces) {
        if (begin + p->start < first && first < begin + p->end) {
            ends.push_back(begin + p->end);
        }
    }
    return lang::len(ends) > 0
        ? lang::min_of(lang::together(List<double>{soon}, List<double>{running->end}, ends))
        : first;
}

/// Return a free slot among the times that never come.
inline double find_slot(const Ref<Track>& track) {
    List<double> found;
    for (const auto& s : track->speeches) {
        if (s->start >= utterances::PAUSED) {
            found.push_back(s->end + 1.0);
        }
    }
    return lang::max_of(lang::together(List<double>{utterances::PAUSED}, found));
}

/// Return the track with an utterance ended at `stop`: its later pieces are not said.
inline Ref<Track> break_off(const Ref<Track>& track, const std::string& ident, double stop) {
    Ref<Speech> last = track->last_speech(ident);
    List<Ref<Speech>> speeches;
    for (const auto& speech : track->speeches) {
        if (speech->id != ident || speech->end <= stop) {
            speeches.push_back(speech);
        } else if (speech->start < stop) {
            speeches.push_back(items::cut(speech, stop));
        }
    }
    return last == nullptr ? track : utterances::_closed(track, speeches, last, stop, true);
}

/// Return the track with an utterance that is over once all its known pieces are said.
inline Ref<Track> finish_speech(const Ref<Track>& track, const std::string& ident, double soon) {
    Ref<Speech> last = track->last_speech(ident);
    return last == nullptr ? track : utterances::_closed(track, track->speeches, last, soon, false);
}

/// Return the track with these speeches, in which an utterance expects no more pieces. of: its last piece before. cuts:
/// whether it was broken off.
inline Ref<Track> _closed(
    const Ref<Track>& track,
    const List<Ref<Speech>>& speeches,
    const Ref<Speech>& of,
    double now,
    bool cuts
) {
    List<Ref<Speech>> out = speeches;
    double end = now;
    for (const auto& n : lang::backwards(lang::range(lang::len(out)))) {
        Ref<Speech> last = lang::at(out, n);
        if (last->id != of->id || last->asked != of->asked) {
            continue;
        }
        bool held = cuts && last->length.has_value(); // it was paused
        bool silent = last->end < now && (last->more || held);
        std::optional<double> length = (cuts && last->more)
            ? std::optional<double>(items::measure_line(last))
            : last->length;
        lang::at(out, n) = lang::made<Speech>(
            last->id,
            last->start,
            last->end,
            last->line,
            last->text,
            last->priority,
            length,
            last->timing,
            last->skip,
            false,
            silent ? std::optional<double>(now) : last->over,
            last->asked
        );
        end = std::max(last->end, now);
        break;
    }
    List<Ref<MoodFrom>> moods;
    for (const auto& m : track->moods) {
        moods.push_back((m->id == of->id && m->end == utterances::PAUSED) ? utterances::_until(m, end) : m);
    }
    return lang::made<Track>(track->looks, out, track->modes, track->places, track->blinks, track->stays, moods);
}

inline Ref<MoodFrom> _until(const Ref<MoodFrom>& mood, double end) {
    return lang::made<MoodFrom>(mood->id, mood->start, mood->valence, mood->arousal, mood->intensity, end);
}

/// Return the track with an utterance paused from `stop` on, in `slot` (`find_slot`). made: ids of requests that belong
/// to it; they wait, too, if they have not begun.
inline Ref<Track> pause(
    const Ref<Track>& track,
    const std::string& ident,
    const Set<std::string>& made,
    double stop,
    double slot
) {
    double by = slot - stop;
    List<Ref<Speech>> kept;
    List<Ref<Speech>> held;
    for (const auto& speech : track->speeches) {
        if (speech->id != ident || speech->start >= utterances::PAUSED || speech->end <= stop) {
            kept.push_back(speech);
        } else if (speech->start < stop) {
            kept.push_back(lang::made<Speech>(
                items::cut(speech, stop)->id,
                items::cut(speech, stop)->start,
                items::cut(speech, stop)->end,
                items::cut(speech, stop)->line,
                items::cut(speech, stop)->text,
                items::cut(speech, stop)->priority,
                items::cut(speech, stop)->length,
                items::cut(speech, stop)->timing,
                items::cut(speech, stop)->skip,
                false,
                items::cut(speech, stop)->over,
                items::cut(speech, stop)->asked
            ));
            double skip = stop - items::find_line_start(speech);
            held.push_back(lang::made<Speech>(
                speech->id,
                slot,
                speech->end + by,
                speech->line,
                speech->text,
                speech->priority,
                speech->length,
                speech->timing,
                skip,
                speech->more,
                speech->over,
                speech->asked
            ));
        } else {
            held.push_back(lang::made<Speech>(
                speech->id,
                speech->start + by,
                speech->end + by,
                speech->line,
                speech->text,
                speech->priority,
                speech->length,
                speech->timing,
                speech->skip,
                speech->more,
                speech->over,
                speech->asked
            ));
        }
    }
    Ref<Speech> last = track->last_speech(ident);
    if (lang::len(held) == 0 && last != nullptr && last->more && last->start < utterances::PAUSED) {
        held.push_back(lang::made<Speech>(
            ident,
            slot,
            slot,
            std::nullopt,
            "",
            last->priority,
            std::nullopt,
            nullptr,
            0.0,
            true,
            std::nullopt,
            last->asked
        ));
    }
    if (lang::len(held) == 0) {
        return track;
    }
    List<Ref<MoodFrom>> moods;
    for (const auto& m : track->moods) {
        moods.push_back((m->id == ident && m->start < stop && m->end > stop)
            ? utterances::_until(m, utterances::PAUSED)
            : m);
    }
    Ref<Track> left = lang::made<Track>(
        track->looks,
        kept,
        track->modes,
        track->places,
        track->blinks,
        track->stays,
        moods
    );
    return utterances::_moved(left, held, made, stop, utterances::PAUSED, by);
}

/// Return the track with an utterance that continues at `soon`. made: as for `pause`.
inline Ref<Track> resume(const Ref<Track>& track, const std::string& ident, const Set<std::string>& made, double soon) {
    List<Ref<Speech>> held;
    for (const auto& s : track->speeches) {
        if (s->id == ident && s->start >= utterances::PAUSED) {
            held.push_back(s);
        }
    }
    if (lang::len(held) == 0) {
        return track;
    }
    double by = soon - lang::at(held, 0)->start;
    List<Ref<Speech>> kept;
    for (const auto& s : track->speeches) {
        if (s->id != ident || s->start < utterances::PAUSED) {
            kept.push_back(s);
        }
    }
    List<Ref<Speech>> on;
    for (const auto& s : held) {
        if (s->end > s->start) {
            on.push_back(lang::made<Speech>(
                s->id,
                s->start + by,
                s->end + by,
                s->line,
                s->text,
                s->priority,
                s->length,
                s->timing,
                s->skip,
                s->more,
                s->over,
                s->asked
            ));
        }
    }
    double end = lang::at(held, -1)->more ? utterances::PAUSED : lang::at(held, -1)->end + by;
    List<Ref<MoodFrom>> moods;
    for (const auto& m : track->moods) {
        moods.push_back((m->id == ident && m->end == utterances::PAUSED) ? utterances::_until(m, end) : m);
    }
    Ref<Track> left = lang::made<Track>(
        track->looks,
        kept,
        track->modes,
        track->places,
        track->blinks,
        track->stays,
        moods
    );
    if (lang::len(on) == 0) { // it had fallen silent when it was paused
        left = lang::at(held, -1)->more ? left : utterances::finish_speech(left, ident, soon);
    }
    return utterances::_moved(left, on, made, utterances::PAUSED, INFINITY, by);
}

/// Return the track with more speeches, and with the looks and moods of `made` that begin from `low` to before `high`
/// moved by a number of seconds.
inline Ref<Track> _moved(
    const Ref<Track>& track,
    const List<Ref<Speech>>& speeches,
    const Set<std::string>& made,
    double low,
    double high,
    double by
) {
    List<Ref<LookAt>> looks;
    for (const auto& x : track->looks) {
        if (lang::contains(made, x->id) && low <= x->start && x->start < high) {
            looks.push_back(lang::made<LookAt>(
                x->id,
                x->start + by,
                x->end + by,
                x->to,
                x->amount,
                x->strict,
                x->priority
            ));
        }
    }
    List<Ref<MoodFrom>> moods;
    for (const auto& m : track->moods) {
        if (lang::contains(made, m->id) && low <= m->start && m->start < high) {
            moods.push_back(lang::made<MoodFrom>(
                m->id,
                m->start + by,
                m->valence,
                m->arousal,
                m->intensity,
                m->end + by
            ));
        }
    }
    Set<std::string> gone;
    for (const auto& x2 : looks) {
        gone.insert(x2->id);
    }
    Set<std::string> over;
    for (const auto& m2 : moods) {
        over.insert(m2->id);
    }
    List<Ref<LookAt>> found;
    for (const auto& x3 : track->looks) {
        if (!lang::contains(gone, x3->id) || x3->start < low || x3->start >= high) {
            found.push_back(x3);
        }
    }
    List<Ref<MoodFrom>> found2;
    for (const auto& m3 : track->moods) {
        if (!lang::contains(over, m3->id) || m3->start < low || m3->start >= high) {
            found2.push_back(m3);
        }
    }
    Ref<Track> left = lang::made<Track>(
        found,
        track->speeches,
        track->modes,
        track->places,
        track->blinks,
        track->stays,
        found2
    );
    return left->joined(
        lang::made<Track>(
            looks,
            speeches,
            List<Ref<ModeFrom>>{},
            List<Ref<PlaceFrom>>{},
            List<Ref<BlinkAt>>{},
            List<Ref<StayFrom>>{},
            moods
        )
    );
}

/// Return why an utterance is over at the end of a piece: "finished", "interrupted" or "replaced"; "" if it is not over
/// there.
inline std::string explain_end(const List<Ref<Speech>>& speeches, const Ref<Speech>& speech) {
    Ref<Speech> first;
    for (const auto& s : speeches) {
        if (s->id == speech->id && s->start > speech->start) {
            first = s;
            break;
        }
    }
    Ref<Speech> coming = first;
    if (coming != nullptr && coming->asked == speech->asked) {
        return "";
    }
    if (speech->more) {
        return coming == nullptr ? std::string("") : std::string("replaced");
    }
    if (!speech->length.has_value()) {
        return "finished";
    }
    return (coming == nullptr || coming->start > speech->end + utterances::TOGETHER)
        ? std::string("interrupted")
        : std::string("replaced");
}

}  // namespace utterances

}  // namespace metagraph
