// What asks do to a running plan: what they take back, what lasts from then on, and which layers have to be planned
// again.
//
// Translated from metagraph/playback/planning/hearing.py; change that, and translate anew.
#pragma once

#include "words.hpp"
#include "items.hpp"
#include "spots.hpp"
#include "track.hpp"
#include "meta_plan.hpp"
#include "mood.hpp"
#include "language.hpp"

namespace metagraph {

struct Heard;

namespace hearing {

inline List<std::string> owners(const std::string& ident);
inline List<std::string> makers(const std::string& ident);
inline Ref<Heard> heard(
    const List<Ref<MetaRequest>>& requests,
    const Ref<Track>& track,
    const List<Ref<MetaRequest>>& fresh,
    const Ref<Track>& more,
    const Set<std::string>& withdrawn,
    const List<std::string>& refused,
    double now,
    const List<std::string>& turning
);

}  // namespace hearing

/// track: what lasts. withdrawn: ids of what was asked for before and is not any more; stopped: those of them that were
/// taken back and not asked for anew. touched: layers that asks have to do with.
struct Heard {
    Ref<Track> track;
    Set<std::string> withdrawn;
    Set<std::string> stopped;
    Set<std::string> touched;

    Heard(Ref<Track> track_, Set<std::string> withdrawn_, Set<std::string> stopped_, Set<std::string> touched_)
        : track(std::move(track_)),
            withdrawn(std::move(withdrawn_)),
            stopped(std::move(stopped_)),
            touched(std::move(touched_)) {}
};

namespace hearing {

/// Return the asks a request may have been made by: that of its own id, and those of which it would be a part.
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

/// Return what a request goes with when it is taken back: its `owners`, and what is said that a gesture was made for:
/// "answer" for "answer/2".
inline List<std::string> makers(const std::string& ident) {
    List<std::string> out = hearing::owners(ident);
    auto [said, slash, number] = lang::parted_last(lang::at(out, -1), "/");
    if (slash != "" && lang::digits(number)) {
        out.push_back(said);
    }
    return out;
}

/// Return what asks do. requests, track: of the plan. fresh, more: what is asked for, where speeches may overlap.
/// withdrawn: ids taken back; every one where it holds "". refused: ids of what could not be understood. now: what
/// begins before stays. turning: layers whose models perform one thing in one mode and another in another.
inline Ref<Heard> heard(
    const List<Ref<MetaRequest>>& requests,
    const Ref<Track>& track,
    const List<Ref<MetaRequest>>& fresh,
    const Ref<Track>& more,
    const Set<std::string>& withdrawn,
    const List<std::string>& refused,
    double now,
    const List<std::string>& turning
) {
    Set<std::string> gone = lang::set_of(withdrawn);
    for (const auto& ident : refused) {
        gone.insert(ident);
    }
    for (const auto& request : fresh) {
        gone.insert(request->id);
    }
    for (const auto& ident : more->idents()) {
        gone.insert(ident);
    }
    List<Ref<Speech>> said;
    Set<std::string> begun; // of which more is said
    Set<std::string> anew; // of which something else was said before
    Map<std::string, double> later; // by how much those begin that are said behind others of their id
    for (const auto& asked : more->speeches) {
        Ref<Speech> before_it = lang::contains(withdrawn, asked->id) ? nullptr : track->last_speech(asked->id);
        Ref<Speech> first = before_it;
        for (const auto& s : lang::backwards(said)) {
            if (s->id == asked->id) {
                first = s;
                break;
            }
        }
        Ref<Speech> last = first;
        Ref<Speech> one = items::going_on(last, asked, now);
        if (one != asked && last != nullptr && one->start == last->start) {
            begun.insert(one->id);
            List<Ref<Speech>> found;
            for (const auto& s : said) {
                if (s->id != one->id) {
                    found.push_back(s);
                }
            }
            said = found;
        } else if (one == asked && !lang::contains(withdrawn, asked->id)) {
            one = items::behind(lang::together(track->speeches, said), asked, now);
            if (one != asked) {
                later[one->id] = one->start - asked->start;
            }
        }
        if (one == asked && track->last_speech(one->id) != nullptr) {
            anew.insert(one->id);
        }
        said.push_back(one);
    }
    List<std::string> before;
    for (const auto& r : requests) {
        before.push_back(r->id);
    }
    lang::extend(before, track->idents());
    // Who takes everything back still looks at whom it talks with.
    Set<std::string> user;
    for (const auto& x : track->looks) {
        if (x->start < now && spots::is_same_spot(x->to, spots::named("user"))) {
            user.insert(x->id);
        }
    }
    Set<std::string> taken;
    Set<std::string> stopped;
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
            bool holds3 = lang::len(anew) > 0 && !lang::contains(anew, ident);
            if (holds3) {
                bool is_any2 = false;
                for (const auto& o : hearing::makers(ident)) {
                    if (lang::contains(anew, o)) {
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
    // Where the models may change stances again means nothing where they always might.
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
    for (const auto& r : fresh) {
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
    bool holds6 = lang::len(more->modes) > 0 || lang::len(more->speeches) > 0;
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
    if (turns) { // who talks moves otherwise than who listens
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
    Set<std::string> over;
    for (const auto& ident : taken) {
        if (!lang::contains(begun, ident) && !lang::contains(later, ident)) {
            over.insert(ident);
        }
    }
    List<Ref<MoodFrom>> moods;
    for (const auto& m : more->moods) {
        moods.push_back(lang::contains(later, m->id)
            ? lang::made<MoodFrom>(
                m->id,
                m->start + later.at(m->id),
                m->valence,
                m->arousal,
                m->intensity,
                m->end + later.at(m->id)
            )
            : m);
    }
    Ref<Track> left = track->without(over, now)->without(begun);
    Ref<Track> lasting = lang::made<Track>(more->looks, said, more->modes, more->places, more->blinks, stays, moods);
    return lang::made<Heard>(left->joined(lasting), taken, stopped, touched);
}

}  // namespace hearing

}  // namespace metagraph
