// All requests that last, in order; see `items`. Times are seconds.
//
// Translated from metagraph/playback/life/track.py; change that, and translate anew.
#pragma once

#include "items.hpp"
#include "mood.hpp"
#include "language.hpp"

namespace metagraph {

struct Track;

namespace track {

inline constexpr double HUSHED = 1.5; // seconds after what was said is broken off in which the models begin nothing

}  // namespace track

/// All lasting requests, each kind sorted by start. Speeches do not overlap.
struct Track : std::enable_shared_from_this<Track> {
    List<Ref<LookAt>> looks;
    List<Ref<Speech>> speeches;
    List<Ref<ModeFrom>> modes;
    List<Ref<PlaceFrom>> places;
    List<Ref<BlinkAt>> blinks;
    List<Ref<StayFrom>> stays;
    List<Ref<MoodFrom>> moods;

    explicit Track(
        List<Ref<LookAt>> looks_ = List<Ref<LookAt>>{},
        List<Ref<Speech>> speeches_ = List<Ref<Speech>>{},
        List<Ref<ModeFrom>> modes_ = List<Ref<ModeFrom>>{},
        List<Ref<PlaceFrom>> places_ = List<Ref<PlaceFrom>>{},
        List<Ref<BlinkAt>> blinks_ = List<Ref<BlinkAt>>{},
        List<Ref<StayFrom>> stays_ = List<Ref<StayFrom>>{},
        List<Ref<MoodFrom>> moods_ = List<Ref<MoodFrom>>{}
    )
        : looks(std::move(looks_)),
            speeches(std::move(speeches_)),
            modes(std::move(modes_)),
            places(std::move(places_)),
            blinks(std::move(blinks_)),
            stays(std::move(stays_)),
            moods(std::move(moods_)) {}

    /// Return the ids of all items.
    List<std::string> idents() const;

    /// Return whether the models may not change a layer's stance at a time.
    bool stays_at(const std::string& layer, double seconds) const;

    /// Return whether what was said was broken off shortly before a time, and nothing is said since: then the models
    /// begin nothing.
    bool hushed_at(double seconds) const;

    /// Return the mode requested at a time, or talking while something is said; None if neither applies.
    std::optional<std::string> told_mode(double seconds) const;

    /// Return the track without items of these ids that begin at `now` or later; those that have begun end now, if they
    /// can.
    Ref<Track> without(const Set<std::string>& idents, double now = -INFINITY) const;

    /// Return the track with the items of another one, whose speeches may overlap.
    Ref<Track> joined(const Ref<Track>& more) const;

    /// Return the track without items that are not needed from `seconds` on.
    Ref<Track> since(double seconds) const;

    /// Return the last speech with an id.
    Ref<Speech> last_speech(const std::string& ident) const;

    /// Return whether everything is the same that random draws depend on. Places and stays are not part of it.
    bool draws_like(const Ref<Track>& other) const;

    /// Return whether everything is the same.
    bool like(const Ref<Track>& other) const;
};

inline List<std::string> Track::idents() const {
    List<std::string> out;
    for (const auto& x : this->looks) {
        out.push_back(x->id);
    }
    List<std::string> found;
    for (const auto& x : this->speeches) {
        found.push_back(x->id);
    }
    lang::extend(out, found);
    List<std::string> found2;
    for (const auto& x : this->modes) {
        found2.push_back(x->id);
    }
    lang::extend(out, found2);
    List<std::string> found3;
    for (const auto& x : this->places) {
        found3.push_back(x->id);
    }
    lang::extend(out, found3);
    List<std::string> found4;
    for (const auto& x : this->blinks) {
        found4.push_back(x->id);
    }
    lang::extend(out, found4);
    List<std::string> found5;
    for (const auto& x : this->stays) {
        found5.push_back(x->id);
    }
    lang::extend(out, found5);
    List<std::string> found6;
    for (const auto& x : this->moods) {
        found6.push_back(x->id);
    }
    lang::extend(out, found6);
    return out;
}

inline bool Track::stays_at(const std::string& layer, double seconds) const {
    Ref<StayFrom> first;
    for (const auto& s : lang::backwards(this->stays)) {
        if (s->layer == layer && s->start <= seconds) {
            first = s;
            break;
        }
    }
    Ref<StayFrom> last = first;
    return last != nullptr && last->on && seconds < last->end;
}

inline bool Track::hushed_at(double seconds) const {
    List<double> found;
    for (const auto& s : this->speeches) {
        found.push_back(s->start);
    }
    int place = lang::bisect_right(found, seconds) - 1;
    if (place < 0 || !lang::at(this->speeches, place)->length.has_value()) {
        return false;
    }
    Ref<Speech> last = lang::at(this->speeches, place);
    double silent = !last->over.has_value() ? last->end : std::max(last->end, *last->over);
    return last->end <= seconds && seconds < silent + track::HUSHED;
}

inline std::optional<std::string> Track::told_mode(double seconds) const {
    List<double> found;
    for (const auto& m : this->modes) {
        found.push_back(m->start);
    }
    int asked = lang::bisect_right(found, seconds) - 1;
    if (asked >= 0 && lang::at(this->modes, asked)->mode.has_value()) {
        return lang::at(this->modes, asked)->mode;
    }
    List<double> found2;
    for (const auto& s : this->speeches) {
        found2.push_back(s->start);
    }
    int said = lang::bisect_right(found2, seconds) - 1;
    return (said >= 0 && seconds < lang::at(this->speeches, said)->end)
        ? std::optional<std::string>("talking")
        : std::nullopt;
}

inline Ref<Track> Track::without(const Set<std::string>& idents, double now) const {
    bool holds = lang::len(idents) == 0;
    if (!holds) {
        bool is_any = false;
        for (const auto& ident : this->idents()) {
            if (lang::contains(idents, ident)) {
                is_any = true;
                break;
            }
        }
        holds = !is_any;
    }
    if (holds) {
        return lang::self(this);
    }
    List<Ref<LookAt>> found;
    for (const auto& x : this->looks) {
        if (!lang::contains(idents, x->id) || x->start < now) {
            found.push_back(lang::contains(idents, x->id)
                ? lang::made<LookAt>(x->id, x->start, std::min(x->end, now), x->to, x->amount, x->strict, x->priority)
                : x);
        }
    }
    List<Ref<Speech>> found2;
    for (const auto& x : this->speeches) {
        if (!lang::contains(idents, x->id) || x->start < now) {
            found2.push_back(lang::contains(idents, x->id) ? items::cut(x, now) : x);
        }
    }
    List<Ref<ModeFrom>> found3;
    for (const auto& x : this->modes) {
        if (!lang::contains(idents, x->id) || x->start < now) {
            found3.push_back(x);
        }
    }
    List<Ref<PlaceFrom>> found4;
    for (const auto& x : this->places) {
        if (!lang::contains(idents, x->id) || x->start < now) {
            found4.push_back(x);
        }
    }
    List<Ref<BlinkAt>> found5;
    for (const auto& x : this->blinks) {
        if (!lang::contains(idents, x->id) || x->start < now) {
            found5.push_back(x);
        }
    }
    List<Ref<StayFrom>> found6;
    for (const auto& x : this->stays) {
        if (!lang::contains(idents, x->id) || x->start < now) {
            found6.push_back(lang::contains(idents, x->id)
                ? lang::made<StayFrom>(x->id, x->start, x->layer, x->on, std::min(x->end, now))
                : x);
        }
    }
    List<Ref<MoodFrom>> found7;
    for (const auto& x : this->moods) {
        if (!lang::contains(idents, x->id) || x->start < now) {
            found7.push_back(lang::contains(idents, x->id)
                ? lang::made<MoodFrom>(x->id, x->start, x->valence, x->arousal, x->intensity, std::min(x->end, now))
                : x);
        }
    }
    return lang::made<Track>(found, found2, found3, found4, found5, found6, found7);
}

inline Ref<Track> Track::joined(const Ref<Track>& more) const {
    if (lang::len(more->idents()) == 0) {
        return lang::self(this);
    }
    List<Ref<LookAt>> looks = this->looks;
    for (const auto& look : more->looks) {
        std::tuple<double, std::string> own = std::tuple<double, std::string>{look->start, look->id};
        int place2 = lang::len(looks);
        while (place2 > 0
            && own < std::tuple<double, std::string>{
                lang::at(looks, place2 - 1)->start,
                lang::at(looks, place2 - 1)->id
            }) {
            place2 -= 1;
        }
        lang::insert(looks, place2, look);
    }
    List<Ref<Speech>> speeches = this->speeches;
    for (const auto& speech : more->speeches) {
        std::tuple<double, std::string> own2 = std::tuple<double, std::string>{speech->start, speech->id};
        int place3 = lang::len(speeches);
        while (place3 > 0
            && own2 < std::tuple<double, std::string>{
                lang::at(speeches, place3 - 1)->start,
                lang::at(speeches, place3 - 1)->id
            }) {
            place3 -= 1;
        }
        lang::insert(speeches, place3, speech);
    }
    List<Ref<ModeFrom>> modes = this->modes;
    for (const auto& mode : more->modes) {
        std::tuple<double, std::string> own3 = std::tuple<double, std::string>{mode->start, mode->id};
        int place4 = lang::len(modes);
        while (place4 > 0
            && own3 < std::tuple<double, std::string>{
                lang::at(modes, place4 - 1)->start,
                lang::at(modes, place4 - 1)->id
            }) {
            place4 -= 1;
        }
        lang::insert(modes, place4, mode);
    }
    List<Ref<PlaceFrom>> places = this->places;
    for (const auto& place : more->places) {
        std::tuple<double, std::string> own4 = std::tuple<double, std::string>{place->start, place->id};
        int place5 = lang::len(places);
        while (place5 > 0
            && own4 < std::tuple<double, std::string>{
                lang::at(places, place5 - 1)->start,
                lang::at(places, place5 - 1)->id
            }) {
            place5 -= 1;
        }
        lang::insert(places, place5, place);
    }
    List<Ref<BlinkAt>> blinks = this->blinks;
    for (const auto& blink : more->blinks) {
        std::tuple<double, std::string> own5 = std::tuple<double, std::string>{blink->start, blink->id};
        int place6 = lang::len(blinks);
        while (place6 > 0
            && own5 < std::tuple<double, std::string>{
                lang::at(blinks, place6 - 1)->start,
                lang::at(blinks, place6 - 1)->id
            }) {
            place6 -= 1;
        }
        lang::insert(blinks, place6, blink);
    }
    List<Ref<StayFrom>> stays = this->stays;
    for (const auto& stay : more->stays) {
        std::tuple<double, std::string> own6 = std::tuple<double, std::string>{stay->start, stay->id};
        int place7 = lang::len(stays);
        while (place7 > 0
            && own6 < std::tuple<double, std::string>{
                lang::at(stays, place7 - 1)->start,
                lang::at(stays, place7 - 1)->id
            }) {
            place7 -= 1;
        }
        lang::insert(stays, place7, stay);
    }
    List<Ref<MoodFrom>> moods = this->moods;
    for (const auto& mood : more->moods) {
        std::tuple<double, std::string> own7 = std::tuple<double, std::string>{mood->start, mood->id};
        int place8 = lang::len(moods);
        while (place8 > 0
            && own7 < std::tuple<double, std::string>{
                lang::at(moods, place8 - 1)->start,
                lang::at(moods, place8 - 1)->id
            }) {
            place8 -= 1;
        }
        lang::insert(moods, place8, mood);
    }
    List<Ref<Speech>> said = lang::len(more->speeches) > 0 ? items::apart(speeches) : speeches;
    return lang::made<Track>(looks, said, modes, places, blinks, stays, moods);
}

inline Ref<Track> Track::since(double seconds) const {
    // Those that no later one has replaced; also what is over: it tells since when what shows has shown.
    List<Ref<LookAt>> looks;
    for (const auto& look : this->looks) {
        if (look->start <= seconds) {
            List<Ref<LookAt>> found;
            for (const auto& x : looks) {
                if (x->priority > look->priority) {
                    found.push_back(x);
                }
            }
            looks = found;
        }
        looks.push_back(look);
    }
    Map<std::string, Ref<Speech>> latest;
    for (const auto& x : this->speeches) {
        latest[x->id] = x;
    }
    Set<std::string> lasts;
    for (const auto& [ident, x] : latest) {
        if (x->more || x->end > seconds) {
            lasts.insert(ident);
        }
    }
    List<double> found2;
    for (const auto& m : this->modes) {
        found2.push_back(m->start);
    }
    int mode = std::max(0, lang::bisect_right(found2, seconds) - 1);
    Map<std::string, int> places;
    for (int n = 0; n < lang::len(this->places); n++) {
        const auto& x = lang::at(this->places, n);
        if (x->start <= seconds) {
            places[x->name] = n;
        }
    }
    Map<std::string, int> stays;
    for (int n = 0; n < lang::len(this->stays); n++) {
        const auto& x = lang::at(this->stays, n);
        if (x->start <= seconds) {
            stays[x->layer] = n;
        }
    }
    List<Ref<Speech>> found3;
    for (const auto& x : this->speeches) {
        if (x->start > seconds
            || x->end > seconds
            || (x->more && lang::contains(lasts, x->id))
            || (x->over.has_value() && *x->over > seconds - track::HUSHED)
            || (x->length.has_value() && x->end > seconds - track::HUSHED)) {
            found3.push_back(x);
        }
    }
    List<Ref<PlaceFrom>> found4;
    for (int n = 0; n < lang::len(this->places); n++) {
        const auto& x = lang::at(this->places, n);
        if (x->start > seconds || places.at(x->name) == n) {
            found4.push_back(x);
        }
    }
    List<Ref<BlinkAt>> found5;
    for (const auto& x : this->blinks) {
        if (x->start > seconds) {
            found5.push_back(x);
        }
    }
    List<Ref<StayFrom>> found6;
    for (int n = 0; n < lang::len(this->stays); n++) {
        const auto& x = lang::at(this->stays, n);
        if (x->start > seconds || stays.at(x->layer) == n) {
            found6.push_back(x);
        }
    }
    return lang::made<Track>(
        looks,
        found3,
        lang::part(this->modes, mode),
        found4,
        found5,
        found6,
        mood::lasting(this->moods, seconds)
    );
}

inline Ref<Speech> Track::last_speech(const std::string& ident) const {
    Ref<Speech> first;
    for (const auto& s : lang::backwards(this->speeches)) {
        if (s->id == ident) {
            first = s;
            break;
        }
    }
    return first;
}

inline bool Track::draws_like(const Ref<Track>& other) const {
    if (!items::alike_looks(this->looks, other->looks) || !items::alike_speeches(this->speeches, other->speeches)) {
        return false;
    }
    if (!items::alike_felt(this->moods, other->moods)) {
        return false;
    }
    return items::alike_modes(this->modes, other->modes) && items::alike_blinks(this->blinks, other->blinks);
}

inline bool Track::like(const Ref<Track>& other) const {
    if (!items::alike_places(this->places, other->places) || !items::alike_stays(this->stays, other->stays)) {
        return false;
    }
    return this->draws_like(other);
}

}  // namespace metagraph
