// What asks do to a running plan: what they take back, what lasts from then on, and which layers have to be planned
// again.
//
// Translated from metagraph/playback/planning/hearing.py; change that, and translate anew.
#pragma once

#include "words.hpp"
#include "items.hpp"
#include "track.hpp"
#include "meta_plan.hpp"
#include "language.hpp"

namespace metagraph {

struct Heard;

namespace hearing {

inline List<std::string> owners(const std::string& ident);
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

/// track: what lasts. withdrawn: ids of what was asked for before and is not any more. touched: layers that asks have
/// to do with.
struct Heard {
    Ref<Track> track;
    Set<std::string> withdrawn;
    Set<std::string> touched;

    Heard(Ref<Track> track_, Set<std::string> withdrawn_, Set<std::string> touched_)
        : track(std::move(track_)), withdrawn(std::move(withdrawn_)), touched(std::move(touched_)) {}
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
    List<std::string> before;
    for (const auto& r : requests) {
        before.push_back(r->id);
    }
    lang::extend(before, track->idents());
    Set<std::string> taken;
    for (const auto& ident : before) {
        bool holds2 = lang::contains(withdrawn, "") || lang::contains(gone, ident);
        if (!holds2) {
            bool holds = lang::contains(ident, ".");
            if (holds) {
                bool is_any = false;
                for (const auto& o : hearing::owners(ident)) {
                    if (lang::contains(gone, o)) {
                        is_any = true;
                        break;
                    }
                }
                holds = is_any;
            }
            holds2 = holds;
        }
        if (holds2) {
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
    bool holds3 = lang::len(more->modes) > 0 || lang::len(more->speeches) > 0;
    if (!holds3) {
        bool is_any2 = false;
        for (const auto& m : track->modes) {
            if (lang::contains(taken, m->id)) {
                is_any2 = true;
                break;
            }
        }
        holds3 = is_any2;
    }
    if (!holds3) {
        bool is_any3 = false;
        for (const auto& s : track->speeches) {
            if (lang::contains(taken, s->id)) {
                is_any3 = true;
                break;
            }
        }
        holds3 = is_any3;
    }
    bool turns = holds3;
    if (turns) { // who talks moves otherwise than who listens
        for (const auto& layer : turning) {
            touched.insert(layer);
        }
    }
    bool holds4 = lang::len(more->moods) > 0;
    if (!holds4) {
        bool is_any4 = false;
        for (const auto& m : track->moods) {
            if (lang::contains(taken, m->id)) {
                is_any4 = true;
                break;
            }
        }
        holds4 = is_any4;
    }
    if (holds4) {
        for (const auto& layer : words::LAYERS) {
            touched.insert(layer);
        }
    }
    List<Ref<Speech>> said;
    for (const auto& s : more->speeches) {
        said.push_back(items::going_on(track->last_speech(s->id), s, now));
    }
    Set<std::string> begun; // of which more is said
    for (int n = 0; n < lang::len(said); n++) {
        const auto& new_ = lang::at(said, n);
        const auto& asked = lang::at(more->speeches, n);
        if (new_ != asked) {
            begun.insert(new_->id);
        }
    }
    Set<std::string> over;
    for (const auto& ident : taken) {
        if (!lang::contains(begun, ident)) {
            over.insert(ident);
        }
    }
    Ref<Track> left = track->without(over, now)->without(begun);
    Ref<Track> lasting = lang::made<Track>(
        more->looks,
        said,
        more->modes,
        more->places,
        more->blinks,
        stays,
        more->moods
    );
    return lang::made<Heard>(left->joined(lasting), taken, touched);
}

}  // namespace hearing

}  // namespace metagraph
