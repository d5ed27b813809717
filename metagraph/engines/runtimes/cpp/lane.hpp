// A lane of events in time, drawn one after another. It never changes: it is extended at the end and forgotten at the
// front.
//
// Translated from metagraph/playback/life/lane.py; change that, and translate anew.
#pragma once

#include "language.hpp"

namespace metagraph {

struct Lane;

/// times: when events begin, ascending, seconds. rows: the values of each event. first: number of the first event that
/// is still kept. width: how many numbers a row has.
struct Lane : std::enable_shared_from_this<Lane> {
    List<double> times;
    List<List<double>> rows;
    int first;
    int width;

    explicit Lane(
        List<double> times_ = List<double>{},
        List<List<double>> rows_ = List<List<double>>{},
        int first_ = 0,
        int width_ = 1
    )
        : times(std::move(times_)), rows(std::move(rows_)), first(first_), width(width_) {}

    /// The number of the event to be drawn next.
    int next() const;

    /// Return the lane with only the events that begin before a time.
    Ref<Lane> until(double seconds) const;

    /// Return the lane with later events.
    Ref<Lane> plus(const List<double>& times, const List<List<double>>& rows) const;

    /// Return the lane without events that are over at `seconds`; `before`: how many of those to keep.
    Ref<Lane> since(double seconds, int before = 1) const;
};

inline int Lane::next() const {
    return this->first + lang::len(this->times);
}

inline Ref<Lane> Lane::until(double seconds) const {
    int count = lang::bisect_left(this->times, seconds);
    if (count == lang::len(this->times)) {
        return lang::self(this);
    }
    return lang::made<Lane>(
        lang::part(this->times, 0, count),
        lang::part(this->rows, 0, count),
        this->first,
        this->width
    );
}

inline Ref<Lane> Lane::plus(const List<double>& times, const List<List<double>>& rows) const {
    if (lang::len(times) == 0) {
        return lang::self(this);
    }
    return lang::made<Lane>(
        lang::together(this->times, times),
        lang::together(this->rows, rows),
        this->first,
        this->width
    );
}

inline Ref<Lane> Lane::since(double seconds, int before) const {
    int gone = std::max(0, lang::bisect_right(this->times, seconds) - 1 - before);
    if (gone == 0) {
        return lang::self(this);
    }
    return lang::made<Lane>(
        lang::part(this->times, gone),
        lang::part(this->rows, gone),
        this->first + gone,
        this->width
    );
}

}  // namespace metagraph
