// A lane of events in time, drawn one after another; never changed, extended at the end, forgotten at the front.
#pragma once

#include "language.hpp"

namespace metagraph {

/// starts ascend, seconds. values: what each event is. first: number of the first event that is still kept.
struct Lane {
    List<double> starts;
    List<List<double>> values;
    int first = 0;

    /// The number of the event to be drawn next.
    int next() const { return first + lang::len(starts); }
    bool empty() const { return starts.empty(); }
};

namespace lane {

inline Ref<const Lane> part(const Ref<const Lane>& lane, int first, int last) {
    if (first == 0 && last == lang::len(lane->starts)) return lane;
    auto out = lang::made<Lane>();
    out->starts = lang::part(lane->starts, first, last);
    out->values = lang::part(lane->values, first, last);
    out->first = lane->first + first;
    return out;
}

/// The lane with only what begins before a time.
inline Ref<const Lane> until(const Ref<const Lane>& lane, double seconds) {
    return part(lane, 0, lang::bisect_left(lane->starts, seconds));
}

/// The lane with later events.
inline Ref<const Lane> plus(const Ref<const Lane>& lane, const List<double>& starts, const List<List<double>>& values) {
    if (starts.empty()) return lane;
    auto out = lang::made<Lane>(*lane);
    lang::extend(out->starts, starts);
    lang::extend(out->values, values);
    return out;
}

/// The lane without what neither goes on at `seconds` nor comes later; `before`: how many more are kept.
inline Ref<const Lane> since(const Ref<const Lane>& lane, double seconds, int before = 1) {
    return part(lane, std::max(0, lang::bisect_right(lane->starts, seconds) - 1 - before), lang::len(lane->starts));
}

}  // namespace lane
}  // namespace metagraph
