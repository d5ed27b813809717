// By when each meta action of a plan has to be over.
//
// Translated from metagraph/playback/bounds.py; change that, and translate anew.
#pragma once

#include "meta_plan.hpp"
#include "language.hpp"

namespace metagraph {

struct Bound;
struct _First;

namespace bounds {

inline List<Ref<Bound>> bounds(const List<Ref<MetaAction>>& metas);

}  // namespace bounds

/// A meta action with when the next more important one begins (limit), and the next as important that was asked for
/// (wish); infinity where there is none.
struct Bound {
    Ref<MetaAction> meta;
    double limit;
    double wish;

    Bound(Ref<MetaAction> meta_, double limit_, double wish_)
        : meta(std::move(meta_)), limit(limit_), wish(wish_) {}
};

/// The first of some meta actions of a rank, written or asked for, and when it starts.
struct _First {
    double rank;
    bool written;
    double start;

    _First(double rank_, bool written_, double start_)
        : rank(rank_), written(written_), start(start_) {}
};

namespace bounds {

/// Return each meta action with what bounds it.
inline List<Ref<Bound>> bounds(const List<Ref<MetaAction>>& metas) {
    List<Ref<Bound>> out;
    List<Ref<_First>> first;
    for (const auto& meta : lang::backwards(metas)) {
        double limit = INFINITY;
        double wish = INFINITY;
        Ref<_First> own;
        for (const auto& one : first) {
            if (one->rank > meta->rank()) {
                limit = std::min(limit, one->start);
            }
            if (one->rank >= meta->rank() && !one->written) {
                wish = std::min(wish, one->start);
            }
            if (one->rank == meta->rank() && one->written == meta->written) {
                own = one;
            }
        }
        out.push_back(lang::made<Bound>(meta, limit, wish));
        if (own == nullptr) {
            first.push_back(lang::made<_First>(meta->rank(), meta->written, meta->start));
        } else {
            own->start = meta->start;
        }
    }
    return lang::backwards(out);
}

}  // namespace bounds

}  // namespace metagraph
