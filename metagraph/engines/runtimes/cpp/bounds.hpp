// The times by which the meta actions of a plan have to be over.
//
// Translated from metagraph/playback/planning/bounds.py; change that, and translate anew.
#pragma once

#include "meta_plan.hpp"
#include "language.hpp"

namespace metagraph {

struct Bound;
struct _First;

namespace bounds {

inline constexpr int LOOKED_AT = 6; // how many of those that follow a meta action are listed
inline List<Ref<Bound>> bounds(const List<Ref<MetaAction>>& metas);
inline double begins(const Ref<MetaAction>& meta);

}  // namespace bounds

/// A meta action and its bounds. limit: when the next more important one begins; wish: when the next equally important
/// request begins; infinity if there is none. after: equally important requests that say how late they may be, the next
/// one first.
struct Bound {
    Ref<MetaAction> meta;
    double limit;
    double wish;
    List<Ref<MetaAction>> after;

    Bound(Ref<MetaAction> meta_, double limit_, double wish_, List<Ref<MetaAction>> after_ = List<Ref<MetaAction>>{})
        : meta(std::move(meta_)), limit(limit_), wish(wish_), after(std::move(after_)) {}
};

/// The first of some meta actions of a rank, written or requested, and when it starts.
struct _First {
    double rank;
    bool written;
    double start;

    _First(double rank_, bool written_, double start_)
        : rank(rank_), written(written_), start(start_) {}
};

namespace bounds {

/// Return each meta action with its bounds.
inline List<Ref<Bound>> bounds(const List<Ref<MetaAction>>& metas) {
    List<Ref<Bound>> out;
    List<Ref<_First>> first;
    List<Ref<MetaAction>> pressing; // what says how late it may be, the last first
    for (const auto& meta : lang::backwards(metas)) {
        double limit = INFINITY;
        double wish = INFINITY;
        Ref<_First> own;
        double start = bounds::begins(meta);
        double rank = meta->rank();
        for (const auto& one : first) {
            if (one->rank > rank) {
                limit = std::min(limit, one->start);
            }
            if (one->rank >= rank && !one->written) {
                wish = std::min(wish, one->start);
            }
            if (one->rank == rank && one->written == meta->written) {
                own = one;
            }
        }
        List<Ref<MetaAction>> after;
        if (lang::len(pressing) > 0) {
            List<Ref<MetaAction>> found;
            for (const auto& one2 : lang::backwards(lang::part(pressing, -bounds::LOOKED_AT))) {
                if (one2->rank() >= rank) {
                    found.push_back(one2);
                }
            }
            after = found;
        }
        out.push_back(lang::made<Bound>(meta, limit, wish, after));
        if (meta->request->late.has_value()) {
            pressing.push_back(meta);
        }
        if (own == nullptr) {
            first.push_back(lang::made<_First>(rank, meta->written, start));
        } else {
            own->start = start;
        }
    }
    return lang::backwards(out);
}

/// Return the earliest time at which a meta action may begin. One whose stroke is judged is placed where its stroke
/// comes.
inline double begins(const Ref<MetaAction>& meta) {
    if (meta->request->late.has_value() && meta->request->stroke.has_value()) {
        return std::min(meta->start, meta->request->start);
    }
    return meta->start;
}

}  // namespace bounds

}  // namespace metagraph
