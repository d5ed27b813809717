// The effect of requests on a running plan: what they take back, what lasts from then on, and which layers have to be
// planned again.
//
// Translated from metagraph/playback/planning/hearing.py; change that, and translate anew.
#pragma once

#include "words.hpp"
#include "items.hpp"
#include "spots.hpp"
#include "track.hpp"
#include "utterances.hpp"
#include "meta_plan.hpp"
#include "meaning.hpp"
#include "mood.hpp"
#include "language.hpp"

namespace metagraph {

struct Heard;
struct AddedSpeeches;
struct SteeredSpeech;

namespace hearing {

inline constexpr double LISTENS = 2.0; // seconds for which the gaze stays with the partner who interrupts
inline List<std::string> owners(const std::string& ident);
inline List<std::string> makers(const std::string& ident);
inline Ref<Heard> heard(
    const List<Ref<MetaRequest>>& requests,
    const Ref<Track>& track,
    const Ref<Meaning>& meant,
    double present,
    double now,
    double soon,
    const List<std::string>& turning
);
inline Ref<AddedSpeeches> add_speeches(const Ref<Meaning>& meant, const Ref<Track>& track, double present, double soon);
inline Set<std::string> _without(const Set<std::string>& idents, const std::string& ident);
inline double find_asked(
    const Ref<Track>& track,
    const Ref<Speech>& last,
    bool continues,
    const std::string& ident,
    double soon
);
inline Ref<Heard> _steer(
    const List<Ref<MetaRequest>>& requests,
    const Ref<Heard>& told,
    const Ref<Meaning>& meant,
    double now,
    double soon
);

}  // namespace hearing

/// track: lasting items. fresh: requests of layers, with those that continue after a pause. withdrawn: ids of earlier
/// requests that no longer hold; stopped: those of them that were taken back, not replaced. touched: layers that the
/// requests affect.
struct Heard {
    Ref<Track> track;
    List<Ref<MetaRequest>> fresh;
    Set<std::string> withdrawn;
    Set<std::string> stopped;
    Set<std::string> touched;

    Heard(
        Ref<Track> track_,
        List<Ref<MetaRequest>> fresh_,
        Set<std::string> withdrawn_,
        Set<std::string> stopped_,
        Set<std::string> touched_
    )
        : track(std::move(track_)),
            fresh(std::move(fresh_)),
            withdrawn(std::move(withdrawn_)),
            stopped(std::move(stopped_)),
            touched(std::move(touched_)) {}
};

/// New speeches, combined with those that are being said. said: all that are new or changed. begun: ids of changed
/// earlier ones among them; on: ids of those that continue. `anew`: ids under which something else was said before.
/// moods: the moods requested with them.
struct AddedSpeeches {
    List<Ref<Speech>> said;
    Set<std::string> begun;
    Set<std::string> on;
    Set<std::string> anew;
    List<Ref<MoodFrom>> moods;

    AddedSpeeches(
        List<Ref<Speech>> said_,
        Set<std::string> begun_,
        Set<std::string> on_,
        Set<std::string> anew_,
        List<Ref<MoodFrom>> moods_
    )
        : said(std::move(said_)),
            begun(std::move(begun_)),
            on(std::move(on_)),
            anew(std::move(anew_)),
            moods(std::move(moods_)) {}

    /// Return the part of a track that stays: moods of speeches that continue last as long as these, unless another
    /// mood is requested.
    Ref<Track> leave(const Ref<Track>& track) const;
};

/// A track and requests while asks steer speech. `anew`: ids of the requests that are made again; the other fields are
/// as in `Heard`.
struct SteeredSpeech {
    Ref<Track> track;
    Set<std::string> withdrawn;
    Set<std::string> stopped;
    Set<std::string> touched;
    List<Ref<MetaRequest>> requests;
    Set<std::string> anew;

    SteeredSpeech(
        Ref<Track> track_,
        Set<std::string> withdrawn_,
        Set<std::string> stopped_,
        Set<std::string> touched_,
        List<Ref<MetaRequest>> requests_ = List<Ref<MetaRequest>>{},
        Set<std::string> anew_ = Set<std::string>{}
    )
        : track(std::move(track_)),
            withdrawn(std::move(withdrawn_)),
            stopped(std::move(stopped_)),
            touched(std::move(touched_)),
            requests(std::move(requests_)),
            anew(std::move(anew_)) {}

    /// Return the ids of everything in it.
    List<std::string> idents();

    /// Break off an utterance at `stop`, and the requests that belong to it at `now`.
    void interrupt(const std::string& ident, const Set<std::string>& made, double stop, double now, double soon);

    /// Pause an utterance, and the requests that belong to it and whose moment has not come; those that have begun go
    /// back.
    void pause(const std::string& ident, const Set<std::string>& made, double stop, double now);

    /// Resume a paused utterance, and the requests that wait for it.
    void resume(const std::string& ident, const Set<std::string>& made, double now, double soon);

    /// Return a request moved by a number of seconds, but not to before `least`.
    Ref<MetaRequest> move_request(const Ref<MetaRequest>& request, double by, double least);
};

inline Ref<Track> AddedSpeeches::leave(const Ref<Track>& track) const {
    if (lang::len(this->on) == 0 && lang::len(this->begun) == 0) {
        return track;
    }
    Set<std::string> other;
    for (const auto& m2 : this->moods) {
        other.insert(m2->id);
    }
    Map<std::string, double> ends;
    for (const auto& speech : this->said) {
        if (lang::contains(this->on, speech->id)) {
            ends[speech->id] = speech->more ? utterances::PAUSED : speech->end;
        }
    }
    List<Ref<Speech>> speeches;
    for (const auto& s : track->speeches) {
        if (!lang::contains(this->begun, s->id)) {
            speeches.push_back(s);
        }
    }
    List<Ref<MoodFrom>> moods;
    for (const auto& m : track->moods) {
        if (!lang::contains(ends, m->id) || lang::contains(other, m->id)) {
            moods.push_back(m);
        } else {
            moods.push_back(lang::made<MoodFrom>(
                m->id,
                m->start,
                m->valence,
                m->arousal,
                m->intensity,
                ends.at(m->id)
            ));
        }
    }
    return lang::made<Track>(track->looks, speeches, track->modes, track->places, track->blinks, track->stays, moods);
}

inline List<std::string> SteeredSpeech::idents() {
    List<std::string> found;
    for (const auto& r : this->requests) {
        found.push_back(r->id);
    }
    return lang::together(found, this->track->idents());
}

inline void SteeredSpeech::interrupt(
    const std::string& ident,
    const Set<std::string>& made,
    double stop,
    double now,
    double soon
) {
    if (utterances::goes_on(this->track->speeches, ident, soon)) {
        this->track = utterances::break_off(this->track, ident, stop);
    }
    bool is_any = false;
    for (const auto& m : this->track->moods) {
        if (lang::contains(made, m->id)) {
            is_any = true;
            break;
        }
    }
    if (is_any) {
        for (const auto& layer : words::LAYERS) {
            this->touched.insert(layer);
        }
    }
    this->track = this->track->without(made, now);
    for (const auto& request : this->requests) {
        if (lang::contains(made, request->id)) {
            this->withdrawn.insert(request->id);
            this->stopped.insert(request->id);
            this->touched.insert(request->layer);
        }
    }
    List<Ref<MetaRequest>> found;
    for (const auto& r : this->requests) {
        if (!lang::contains(made, r->id)) {
            found.push_back(r);
        }
    }
    this->requests = found;
}

inline void SteeredSpeech::pause(const std::string& ident, const Set<std::string>& made, double stop, double now) {
    if (utterances::is_paused(stop)) {
        return;
    }
    double slot = utterances::find_slot(this->track);
    this->track = utterances::pause(this->track, ident, made, stop, slot);
    List<Ref<MetaRequest>> kept;
    for (const auto& request : this->requests) {
        if (!lang::contains(made, request->id) || utterances::is_paused(request->start)) {
            kept.push_back(request);
            continue;
        }
        this->withdrawn.insert(request->id);
        this->touched.insert(request->layer);
        if (request->start < now) {
            this->stopped.insert(request->id);
        }
        double wanted = !request->stroke.has_value() ? request->start : *request->stroke;
        if (wanted >= stop) {
            kept.push_back(this->move_request(request, slot - stop, 0.0));
            this->anew.insert(request->id);
        }
    }
    this->requests = kept;
}

inline void SteeredSpeech::resume(const std::string& ident, const Set<std::string>& made, double now, double soon) {
    Ref<Speech> first;
    for (const auto& s : this->track->speeches) {
        if (s->id == ident && utterances::is_paused(s->start)) {
            first = s;
            break;
        }
    }
    Ref<Speech> held = first;
    if (held == nullptr) {
        return;
    }
    this->track = utterances::resume(this->track, ident, made, soon);
    List<Ref<MetaRequest>> kept;
    for (const auto& request : this->requests) {
        if (lang::contains(made, request->id) && utterances::is_paused(request->start)) {
            this->withdrawn.insert(request->id);
            this->touched.insert(request->layer);
            this->anew.insert(request->id);
            kept.push_back(this->move_request(request, soon - held->start, now));
        } else {
            kept.push_back(request);
        }
    }
    this->requests = kept;
}

inline Ref<MetaRequest> SteeredSpeech::move_request(const Ref<MetaRequest>& request, double by, double least) {
    std::optional<double> stroke = !request->stroke.has_value()
        ? std::nullopt
        : std::optional<double>(*request->stroke + by);
    return lang::made<MetaRequest>(
        request->id,
        request->layer,
        request->kind,
        std::max(least, request->start + by),
        request->duration,
        request->action,
        request->tags,
        request->limb,
        request->stance,
        request->priority,
        request->resume,
        stroke,
        request->hold,
        request->prepare,
        request->among,
        request->late,
        request->valence,
        request->arousal,
        request->intensity
    );
}

namespace hearing {

/// Return the ids of the asks from which a request may come: its own id, and those of which it would be a part.
inline List<std::string> owners(const std::string& ident) {
    List<std::string> out = List<std::string>{ident};
    std::string left = ident;
    while (true) {
        std::string dot{};
        std::string number{};
        std::tie(left, dot, number) = lang::parted_last(left, ".");
        if (dot == "" || !lang::digits(number)) {
            return out;
        }
        out.push_back(left);
    }
}

/// Return the ids with which a request is taken back: its `owners`, and the speech that a gesture belongs to: "answer"
/// for "answer/2".
inline List<std::string> makers(const std::string& ident) {
    List<std::string> out = hearing::owners(ident);
    auto [said, slash, number] = lang::parted_last(lang::at(out, -1), "/");
    if (slash != "" && lang::digits(number)) {
        out.push_back(said);
    }
    return out;
}

/// Return the effect of asks. requests, track: of the plan. meant: the meaning of the asks; speeches may overlap in it.
/// present: when they became known. now: everything that begins earlier stays; soon: the same for voices. turning:
/// layers whose models perform differently in different modes.
inline Ref<Heard> heard(
    const List<Ref<MetaRequest>>& requests,
    const Ref<Track>& track,
    const Ref<Meaning>& meant,
    double present,
    double now,
    double soon,
    const List<std::string>& turning
) {
    Ref<Track> more = meant->track();
    Set<std::string> gone = lang::set_of(meant->withdrawn);
    for (const auto& report : meant->refused) {
        gone.insert(report->request);
    }
    for (const auto& request : meant->requests) {
        gone.insert(request->id);
    }
    for (const auto& ident : more->idents()) {
        gone.insert(ident);
    }
    Ref<AddedSpeeches> words = hearing::add_speeches(meant, track, present, soon);
    List<std::string> before;
    for (const auto& r : requests) {
        before.push_back(r->id);
    }
    lang::extend(before, track->idents());
    // A client that takes everything back keeps the look at the user.
    Set<std::string> user;
    for (const auto& x : track->looks) {
        if (x->start < now && spots::is_same_spot(x->to, spots::named("user"))) {
            user.insert(x->id);
        }
    }
    Set<std::string> taken;
    Set<std::string> stopped;
    Set<std::string> withdrawn = meant->withdrawn;
    for (const auto& ident : before) {
        bool every = lang::contains(withdrawn, "") && !lang::contains(user, ident);
        bool holds2 = every;
        if (!holds2) {
            bool holds = lang::len(withdrawn) > 0;
            if (holds) {
                bool is_any = false;
                for (const auto& o : hearing::makers(ident)) {
                    if (lang::contains(withdrawn, o)) {
                        is_any = true;
                        break;
                    }
                }
                holds = is_any;
            }
            holds2 = holds;
        }
        if (holds2) {
            stopped.insert(ident);
        } else {
            bool holds3 = lang::len(words->anew) > 0 && !lang::contains(words->anew, ident);
            if (holds3) {
                bool is_any2 = false;
                for (const auto& o : hearing::makers(ident)) {
                    if (lang::contains(words->anew, o)) {
                        is_any2 = true;
                        break;
                    }
                }
                holds3 = is_any2;
            }
            if (holds3) {
                stopped.insert(ident); // what was made for the words before
            }
        }
        bool holds5 = lang::contains(stopped, ident) || lang::contains(gone, ident);
        if (!holds5) {
            bool holds4 = lang::contains(ident, ".");
            if (holds4) {
                bool is_any3 = false;
                for (const auto& o : hearing::owners(ident)) {
                    if (lang::contains(gone, o)) {
                        is_any3 = true;
                        break;
                    }
                }
                holds4 = is_any3;
            }
            holds5 = holds4;
        }
        if (holds5) {
            taken.insert(ident);
        }
    }
    // Leave to change stances again means nothing if the models always may.
    Set<std::string> staying;
    for (const auto& s : track->stays) {
        if (s->on) {
            staying.insert(s->layer);
        }
    }
    for (const auto& stay : more->stays) {
        if (stay->on) {
            staying.insert(stay->layer);
        }
    }
    List<Ref<StayFrom>> stays;
    for (const auto& s : more->stays) {
        if (lang::contains(staying, s->layer)) {
            stays.push_back(s);
        }
    }
    Set<std::string> touched;
    for (const auto& r : meant->requests) {
        touched.insert(r->layer);
    }
    for (const auto& request : requests) {
        if (lang::contains(taken, request->id)) {
            touched.insert(request->layer);
        }
    }
    for (const auto& stay : lang::together(track->stays, stays)) {
        if (lang::contains(gone, stay->id) || lang::contains(taken, stay->id)) {
            touched.insert(stay->layer);
        }
    }
    bool holds6 = lang::len(more->modes) > 0 || lang::len(more->speeches) > 0 || lang::len(meant->steered) > 0;
    if (!holds6) {
        bool is_any4 = false;
        for (const auto& m : track->modes) {
            if (lang::contains(taken, m->id)) {
                is_any4 = true;
                break;
            }
        }
        holds6 = is_any4;
    }
    if (!holds6) {
        bool is_any5 = false;
        for (const auto& s : track->speeches) {
            if (lang::contains(taken, s->id)) {
                is_any5 = true;
                break;
            }
        }
        holds6 = is_any5;
    }
    bool turns = holds6;
    if (turns) { // talking and listening characters move differently
        for (const auto& layer : turning) {
            touched.insert(layer);
        }
    }
    bool holds7 = lang::len(more->moods) > 0;
    if (!holds7) {
        bool is_any6 = false;
        for (const auto& m : track->moods) {
            if (lang::contains(taken, m->id)) {
                is_any6 = true;
                break;
            }
        }
        holds7 = is_any6;
    }
    if (holds7) {
        for (const auto& layer : words::LAYERS) {
            touched.insert(layer);
        }
    }
    Ref<Track> left = track;
    for (const auto& ident : utterances::find_utterances(track, "", soon)) {
        if (lang::contains(stopped, ident)) {
            left = utterances::break_off(left, ident, now);
        }
    }
    Set<std::string> over;
    for (const auto& ident : taken) {
        if (!lang::contains(words->on, ident)) {
            over.insert(ident);
        }
    }
    left = words->leave(left->without(over, now));
    for (const auto& ident : over) {
        Ref<Speech> open_ = left->last_speech(ident);
        if (open_ != nullptr && open_->more) { // something else takes its place
            left = utterances::finish_speech(left, ident, soon);
        }
    }
    Ref<Track> lasting = lang::made<Track>(
        more->looks,
        words->said,
        more->modes,
        more->places,
        more->blinks,
        stays,
        words->moods
    );
    Ref<Heard> said = lang::made<Heard>(left->joined(lasting), meant->requests, taken, stopped, touched);
    return hearing::_steer(requests, said, meant, now, soon);
}

/// Return the effect of asks to say something on a track: a new line, a line after another, or more of one. present:
/// what ended by then is over, and its end was reported; more of it begins a new utterance.
inline Ref<AddedSpeeches> add_speeches(
    const Ref<Meaning>& meant,
    const Ref<Track>& track,
    double present,
    double soon
) {
    List<Ref<Speech>> said;
    Set<std::string> begun;
    Set<std::string> on;
    Set<std::string> anew;
    Map<std::string, double> later; // by how much those begin that are said behind others of their id
    for (const auto& told : meant->speeches) {
        bool taken = lang::contains(meant->withdrawn, told->id) || lang::contains(meant->withdrawn, "");
        Ref<Speech> before = taken ? nullptr : track->last_speech(told->id);
        Ref<Speech> first = before;
        for (const auto& s : lang::backwards(said)) {
            if (s->id == told->id) {
                first = s;
                break;
            }
        }
        Ref<Speech> last = first;
        Ref<Speech> asked = told;
        double now = soon;
        if (last != nullptr && utterances::is_paused(last->start) && told->start <= soon && !told->line.has_value()) {
            now = last->start; // it is said when that is
            asked = lang::made<Speech>(
                told->id,
                now,
                told->end + now - told->start,
                told->line,
                told->text,
                told->priority,
                told->length,
                told->timing,
                told->skip,
                told->more,
                told->over,
                told->asked
            );
        }
        bool paces = told->more || (last != nullptr && last->more);
        if (paces && asked->timing == nullptr && !asked->line.has_value()) {
            asked = items::pace_speech(meant->alphabet, asked);
        }
        Ref<Speech> one = items::going_on(last, asked, now);
        bool continues = false;
        if (one != asked && last != nullptr && one->start == last->start) {
            continues = true;
            List<Ref<Speech>> found;
            for (const auto& s : said) {
                if (s->id != one->id || s->start < one->start) {
                    found.push_back(s);
                }
            }
            said = found;
            if (last == before) {
                begun.insert(one->id);
                List<Ref<Speech>> found2;
                for (const auto& s : track->speeches) {
                    if (s->id == one->id && s != last) {
                        found2.push_back(s);
                    }
                }
                lang::extend(said, found2);
            }
        } else if (one == asked && last != nullptr) {
            List<Ref<Speech>> same;
            for (const auto& s : lang::together(track->speeches, said)) {
                if (s->id == last->id && s->asked == last->asked) {
                    same.push_back(s);
                }
            }
            one = items::behind(same, asked, now);
            continues = one != asked || (utterances::takes_more(last) && !told->line.has_value() && one->start <= now);
        }
        bool over = last != nullptr && last->end <= present && !utterances::takes_more(last);
        double since = hearing::find_asked(track, last, continues && !over, one->id, soon);
        if (!continues) { // it replaces what was asked for at the same time
            List<Ref<Speech>> found3;
            for (const auto& s : said) {
                if (s->id != one->id) {
                    found3.push_back(s);
                }
            }
            said = found3;
            begun = hearing::_without(begun, one->id);
            on = hearing::_without(on, one->id);
        }
        if (before != nullptr && since == before->asked) {
            on.insert(one->id);
        }
        if (one->start != told->start) {
            later[one->id] = one->start - told->start;
        }
        if (!continues && !lang::contains(on, one->id) && track->last_speech(one->id) != nullptr) {
            anew.insert(one->id);
        }
        said.push_back(lang::made<Speech>(
            one->id,
            one->start,
            one->end,
            one->line,
            one->text,
            one->priority,
            one->length,
            one->timing,
            one->skip,
            one->more,
            one->over,
            since
        ));
    }
    Set<std::string> opened;
    for (const auto& s : said) {
        if (s->more) {
            opened.insert(s->id);
        }
    }
    List<Ref<MoodFrom>> moods;
    for (const auto& m : meant->moods) {
        double by = (lang::contains(later, m->id) && !lang::contains(begun, m->id)) ? later.at(m->id) : 0.0;
        double end = lang::contains(opened, m->id) ? utterances::PAUSED : m->end + by;
        moods.push_back(lang::made<MoodFrom>(m->id, m->start + by, m->valence, m->arousal, m->intensity, end));
    }
    return lang::made<AddedSpeeches>(said, begun, on, anew, moods);
}

inline Set<std::string> _without(const Set<std::string>& idents, const std::string& ident) {
    Set<std::string> left;
    for (const auto& other : idents) {
        if (other != ident) {
            left.insert(other);
        }
    }
    return left;
}

/// Return when the utterance of a new piece was asked for. last: the piece before it, None if that is taken back;
/// continues: whether the new one goes on from it.
inline double find_asked(
    const Ref<Track>& track,
    const Ref<Speech>& last,
    bool continues,
    const std::string& ident,
    double soon
) {
    if (last != nullptr && continues) {
        return last->asked;
    }
    Ref<Speech> known = last == nullptr ? track->last_speech(ident) : last;
    return known == nullptr ? soon : std::max(soon, known->asked + utterances::TOGETHER);
}

/// Return the effect of asks that interrupt, pause, resume or finish speech, in order. requests: of the plan before.
inline Ref<Heard> _steer(
    const List<Ref<MetaRequest>>& requests,
    const Ref<Heard>& told,
    const Ref<Meaning>& meant,
    double now,
    double soon
) {
    if (lang::len(meant->steered) == 0) {
        return told;
    }
    Ref<SteeredSpeech> steered = lang::made<SteeredSpeech>(
        told->track,
        lang::set_of(told->withdrawn),
        lang::set_of(told->stopped),
        lang::set_of(told->touched)
    );
    List<Ref<MetaRequest>> found;
    for (const auto& r : requests) {
        if (!lang::contains(told->withdrawn, r->id)) {
            found.push_back(r);
        }
    }
    steered->requests = found;
    for (const auto& request : told->fresh) {
        steered->requests.push_back(request);
        steered->anew.insert(request->id);
    }
    for (const auto& ask : meant->steered) {
        List<std::string> ids = utterances::find_utterances(steered->track, ask->what, soon);
        if (ask->do_ == "interrupt") {
            if (lang::len(ids) > 0) {
                Ref<LookAt> look = lang::made<LookAt>(
                    ask->id,
                    now,
                    now + hearing::LISTENS,
                    spots::named("user"),
                    1.0,
                    true,
                    ask->priority
                );
                steered->track = steered->track->joined(lang::made<Track>(List<Ref<LookAt>>{look}));
            }
            if (ask->what != "" && !lang::contains(ids, ask->what)) { // it may have been said, and its gestures go on
                ids.push_back(ask->what);
            }
        }
        for (const auto& ident : ids) {
            Set<std::string> made;
            for (const auto& x : steered->idents()) {
                if (lang::starts_with(x, ident) && lang::contains(hearing::makers(x), ident)) {
                    made.insert(x);
                }
            }
            if (ask->do_ == "interrupt") {
                double stop = utterances::find_stop(meant->alphabet, steered->track, ident, soon, now);
                steered->interrupt(ident, made, std::min(stop, now), now, soon);
            } else if (ask->do_ == "pause") {
                steered->pause(
                    ident,
                    made,
                    utterances::find_stop(meant->alphabet, steered->track, ident, soon, now),
                    now
                );
            } else if (ask->do_ == "resume") {
                steered->resume(ident, made, now, soon);
            } else {
                steered->track = utterances::finish_speech(steered->track, ident, soon);
            }
        }
    }
    List<Ref<MetaRequest>> fresh;
    for (const auto& r : steered->requests) {
        if (lang::contains(steered->anew, r->id)) {
            fresh.push_back(r);
        }
    }
    return lang::made<Heard>(steered->track, fresh, steered->withdrawn, steered->stopped, steered->touched);
}

}  // namespace hearing

}  // namespace metagraph
