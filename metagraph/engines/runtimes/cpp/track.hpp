// What was asked for and lasts: where to look, what to say, which mode to be in, which stance to stay in. Values; times are
// seconds.
#pragma once

#include <array>

#include "graph.hpp"

namespace metagraph {

/// A named point, or one in metres of the character's space.
struct Spot {
    std::string name;
    std::optional<Vec> point;

    bool operator==(const Spot& other) const { return name == other.name && point == other.point; }
};

/// Something asked for: `kind` tells which fields count. Never changed once made.
///
/// look: to, end, amount, strict, priority. speech: end, line (none for `text` alone), text, priority, length (seconds it
/// would have taken, where something cut it short), timing (when its words and mouth shapes come, none where that was not
/// told), voice (of the timing, else guessed from the text). mode: none for talking while something is said and idling
/// otherwise. place: name, to. stay: layer, on, end.
struct Item {
    enum Kind { look, speech, mode_from, place, blink, stay };
    static constexpr int KINDS = 6;

    Kind kind = look;
    std::string id;
    double start = 0.0, end = 0.0;
    Spot to;
    double amount = 1.0;
    bool strict = false;
    int priority = 1;
    std::optional<std::string> line;
    std::string text;
    std::optional<double> length;
    Ref<LineTiming> timing;
    Ref<Voice> voice;
    std::optional<std::string> mode;
    std::string name, layer;
    bool on = true;

    bool operator==(const Item& b) const {
        return kind == b.kind && id == b.id && start == b.start && end == b.end && to == b.to && amount == b.amount
            && strict == b.strict && priority == b.priority && line == b.line && text == b.text && length == b.length
            && voice::alike(timing, b.timing) && mode == b.mode && name == b.name && layer == b.layer && on == b.on;
    }
};

using Items = List<Ref<const Item>>;

/// All of it by kind, each by start. Speeches do not overlap.
struct Track {
    std::array<Items, Item::KINDS> lanes;

    const Items& looks() const { return lanes[Item::look]; }
    const Items& speeches() const { return lanes[Item::speech]; }
    const Items& modes() const { return lanes[Item::mode_from]; }
    const Items& places() const { return lanes[Item::place]; }
    const Items& blinks() const { return lanes[Item::blink]; }
    const Items& stays() const { return lanes[Item::stay]; }

    Items items() const {
        Items out;
        for (const Items& lane : lanes) lang::extend(out, lane);
        return out;
    }

    /// Whether the models may not change a layer's stance at a time.
    bool stays_at(const std::string& layer, double seconds) const {
        const Item* last = nullptr;
        for (const auto& stay : stays()) {
            if (stay->layer == layer && stay->start <= seconds) last = stay.get();
        }
        return last != nullptr && last->on && seconds < last->end;
    }

    /// The mode asked for at a time, or talking while something is said; none where neither tells.
    std::optional<std::string> told_mode(double seconds) const {
        const Item* asked = latest(modes(), seconds);
        if (asked != nullptr && asked->mode.has_value()) return asked->mode;
        const Item* said = latest(speeches(), seconds);
        return said != nullptr && seconds < said->end ? std::optional<std::string>("talking") : std::nullopt;
    }

private:
    static const Item* latest(const Items& lane, double seconds) {
        const Item* out = nullptr;
        for (const auto& item : lane) {
            if (item->start <= seconds) out = item.get();
        }
        return out;
    }
};

namespace track {

/// The speech, ending no later than `at`; how long it would have been is remembered.
inline Ref<const Item> cut(const Ref<const Item>& speech, double at) {
    if (speech->end <= at) return speech;
    auto out = lang::made<Item>(*speech);
    out->end = at;
    out->length = speech->length.value_or(speech->end - speech->start);
    return out;
}

/// Speeches without overlaps: one that is at least as important cuts the running one, a lesser one is not said.
inline Items apart(const Items& speeches) {
    Items out;
    for (const auto& speech : speeches) {
        if (!out.empty() && out.back()->end > speech->start) {
            if (speech->priority < out.back()->priority) continue;
            if (out.back()->start >= speech->start) {
                out.pop_back();
            } else {
                out.back() = cut(out.back(), speech->start);
            }
        }
        out.push_back(speech);
    }
    return out;
}

/// The track without items of these ids that begin at `now` or later; what has begun ends now, if it can.
inline Ref<const Track> without(const Ref<const Track>& track, const Set<std::string>& ids, double now) {
    const Items every = track->items();
    if (std::none_of(every.begin(), every.end(), [&ids](const auto& item) { return ids.count(item->id) > 0; })) return track;
    auto out = lang::made<Track>();
    for (const auto& item : every) {
        Items& lane = out->lanes[item->kind];
        if (ids.count(item->id) == 0) {
            lane.push_back(item);
        } else if (item->start < now && item->kind == Item::speech) {
            lane.push_back(cut(item, now));
        } else if (item->start < now && (item->kind == Item::look || item->kind == Item::stay)) {
            auto ended = lang::made<Item>(*item);
            ended->end = std::min(item->end, now);
            lane.push_back(ended);
        } else if (item->start < now) {
            lane.push_back(item);
        }
    }
    return out;
}

inline bool before(const Ref<const Item>& a, const Ref<const Item>& b) {
    return a->start != b->start ? a->start < b->start : a->id < b->id;
}

/// The track with more items; of speeches that overlap the later or more important cuts the other short.
inline Ref<const Track> plus(const Ref<const Track>& track, Items items) {
    if (items.empty()) return track;
    auto out = lang::made<Track>(*track);
    std::stable_sort(items.begin(), items.end(), before);
    bool speaks = false;
    for (const auto& item : items) {
        Items& lane = out->lanes[item->kind];
        lane.insert(std::upper_bound(lane.begin(), lane.end(), item, before), item);
        speaks = speaks || item->kind == Item::speech;
    }
    if (speaks) out->lanes[Item::speech] = apart(out->speeches());
    return out;
}

/// An item as it goes on where a line of the same id has begun by `now`, or begins with it: it keeps its start and what has
/// been said of it. Only lines whose words or shapes were told with their times do.
inline Ref<const Item> goes_on(const Track& track, const Ref<const Item>& item, double now) {
    if (item->kind != Item::speech || item->timing == nullptr) return item;
    const Item* old = nullptr;
    for (const auto& speech : track.speeches()) {
        if (speech->id == item->id) old = speech.get();
    }
    if (old == nullptr || old->timing == nullptr || old->length.has_value()) return item;
    if (std::max(old->start, item->start) > now && old->start != item->start) return item;
    auto out = lang::made<Item>(*item);
    out->timing = line_timing::extended(old->timing, item->timing, std::max(now - old->start, 0.0));
    const double length = std::max(line_timing::timed_seconds(out->timing, std::nullopt), item->end - item->start);
    out->start = old->start;
    out->end = old->start + length;
    if (item->text.empty() || item->text == line_timing::told_text(item->timing)) out->text = line_timing::told_text(out->timing);
    out->voice = voice::from_timing(out->timing, out->end - out->start);
    return out;
}

/// The track without what no time from `seconds` on needs.
inline Ref<const Track> since(const Ref<const Track>& track, double seconds) {
    Map<std::string, const Item*> last; // of modes, of each place, of each layer's stays
    List<const Item*> kept; // looks that no later one has replaced; also what is over: it tells since when what shows has shown
    for (const auto& item : track->items()) {
        if (item->start > seconds) continue;
        if (item->kind == Item::mode_from) last["mode"] = item.get();
        if (item->kind == Item::place) last["place " + item->name] = item.get();
        if (item->kind == Item::stay) last["stay " + item->layer] = item.get();
        if (item->kind != Item::look) continue;
        List<const Item*> above;
        for (const Item* look : kept) {
            if (look->priority > item->priority) above.push_back(look);
        }
        above.push_back(item.get());
        kept = above;
    }
    lang::extend(kept, lang::values(last));
    auto out = lang::made<Track>();
    for (const auto& item : track->items()) {
        const bool goes_on = item->kind == Item::speech && item->end > seconds;
        if (item->start > seconds || goes_on || lang::contains(kept, item.get())) out->lanes[item->kind].push_back(item);
    }
    return out;
}

/// Whether two tracks hold the same in a lane.
inline bool alike(const Track& a, const Track& b, Item::Kind kind) {
    const Items &one = a.lanes[kind], &other = b.lanes[kind];
    return std::equal(one.begin(), one.end(), other.begin(), other.end(), [](const auto& x, const auto& y) {
        return x == y || *x == *y;
    });
}

}  // namespace track

/// The voice of something said: as its words and shapes were told, as its line's was read from the sound, else guessed from its
/// text.
inline Ref<Voice> voice_of(const Map<std::string, Ref<Voice>>& voices, const Item& speech) {
    const Ref<Voice>* known = speech.timing == nullptr && speech.line.has_value() ? voices.find(*speech.line) : nullptr;
    return known == nullptr ? speech.voice : *known;
}

}  // namespace metagraph
