// Temporal replanning: meta actions that may clash become a meta plan that does not (Borer et al., section 6.1).
//
// Greedy, by start time and then priority. The running action is never touched. If two overlap, the more important one
// keeps its time. The other is delayed past it, or cut where it begins; its remainder then plays afterwards if the
// request says so.
//
// Translated from metagraph/playback/planning/replan.py; change that, and translate anew.
#pragma once

#include "model.hpp"
#include "meta_plan.hpp"
#include "language.hpp"

namespace metagraph {


namespace replan {

inline std::tuple<List<Ref<MetaAction>>, List<Ref<Report>>> delay(
    const List<Ref<MetaAction>>& asked,
    double free,
    const Ref<Settings>& settings
);
inline std::tuple<List<Ref<MetaAction>>, List<Ref<Report>>> replan(
    const List<Ref<MetaAction>>& metas,
    const Ref<Settings>& settings,
    double busy = -INFINITY
);
inline std::tuple<List<Ref<MetaAction>>, List<Ref<Report>>> _fitted(
    const List<Ref<MetaAction>>& written,
    const List<Ref<MetaAction>>& placed,
    double shortest,
    double busy
);
inline std::tuple<double, int, std::string, int> _order(const Ref<MetaAction>& meta);
inline std::tuple<List<Ref<MetaAction>>, List<Ref<Report>>> _placed(
    const List<Ref<MetaAction>>& metas,
    const Ref<Settings>& settings
);
inline Ref<MetaAction> _after(const Ref<MetaAction>& meta, double free);
inline std::string _no_time(const Ref<MetaAction>& other);
inline Ref<Report> _told(
    const Ref<MetaAction>& meta,
    const std::string& outcome,
    const std::string& message,
    bool played = false
);

}  // namespace replan

namespace replan {

/// Let new requests wait until `free` seconds, the end of the running action, and drop those that would wait too long.
/// Requests that say how late they may be are judged later, when their lateness is known.
inline std::tuple<List<Ref<MetaAction>>, List<Ref<Report>>> delay(
    const List<Ref<MetaAction>>& asked,
    double free,
    const Ref<Settings>& settings
) {
    List<Ref<MetaAction>> metas;
    List<Ref<Report>> reports;
    for (const auto& meta : asked) {
        double late = free - meta->start;
        if (late <= 0) {
            metas.push_back(meta);
        } else if (meta->request->late.has_value()) {
            metas.push_back(replan::_after(meta, free));
        } else if (late > settings->wait) {
            reports.push_back(replan::_told(
                meta,
                "past",
                lang::text(
                    "asked for at ",
                    lang::fixed(meta->start, 2),
                    " s, ",
                    lang::fixed(late, 1),
                    " s before anything could start"
                )
            ));
        } else {
            metas.push_back(replan::_after(meta, free));
            reports.push_back(replan::_told(
                meta,
                "late",
                lang::text("waits ", lang::fixed(late, 2), " s for the running action"),
                true
            ));
        }
    }
    return std::tuple<List<Ref<MetaAction>>, List<Ref<Report>>>{metas, reports};
}

/// Return the meta plan, ascending and without overlaps, and what became of the rest.
///
/// Requests are placed first; what a model wrote fits into the gaps, from `busy` seconds on. Meta actions that do not
/// overlap stay as they are, so a plan that is placed again does not change. If start and priority are equal, the id
/// that sorts first goes first.
inline std::tuple<List<Ref<MetaAction>>, List<Ref<Report>>> replan(
    const List<Ref<MetaAction>>& metas,
    const Ref<Settings>& settings,
    double busy
) {
    List<Ref<MetaAction>> every = metas;
    List<Ref<MetaAction>> found;
    for (const auto& m : every) {
        if (!m->written) {
            found.push_back(m);
        }
    }
    auto [placed, reports] = replan::_placed(found, settings);
    List<Ref<MetaAction>> found2;
    for (const auto& m : every) {
        if (m->written) {
            found2.push_back(m);
        }
    }
    auto [written, told] = replan::_fitted(found2, placed, settings->shortest, busy);
    List<std::tuple<double, double>> keys;
    for (const auto& m : lang::together(placed, written)) {
        keys.push_back(std::tuple<double, double>{m->start, m->end});
    }
    return std::tuple<List<Ref<MetaAction>>, List<Ref<Report>>>{
        lang::ordered(lang::together(placed, written), keys),
        lang::together(reports, told)
    };
}

/// Return the parts of written meta actions that fit beside the placed ones: the first stretch of each that is long
/// enough.
inline std::tuple<List<Ref<MetaAction>>, List<Ref<Report>>> _fitted(
    const List<Ref<MetaAction>>& written,
    const List<Ref<MetaAction>>& placed,
    double shortest,
    double busy
) {
    List<Ref<MetaAction>> out;
    List<Ref<Report>> reports;
    List<double> starts;
    for (const auto& m : placed) {
        starts.push_back(m->start);
    }
    List<std::tuple<double, std::string>> keys;
    for (const auto& m : written) {
        keys.push_back(std::tuple<double, std::string>{m->start, m->request->id});
    }
    for (const auto& meta : lang::ordered(written, keys)) {
        double start = std::max(meta->start, std::max(busy, !out.empty() ? lang::at(out, -1)->end : busy));
        double end = meta->end;
        Ref<MetaAction> beside;
        for (const auto& other : lang::part(placed, std::max(0, lang::bisect_right(starts, start) - 1))) {
            if (other->start >= end) {
                break;
            }
            if (other->end <= start) {
                continue;
            }
            beside = other;
            if (other->start - start >= shortest) {
                end = other->start;
                break;
            }
            start = other->end;
        }
        if (start == meta->start && end == meta->end) {
            out.push_back(meta);
        } else if (end - start >= shortest) {
            out.push_back(lang::made<MetaAction>(meta->request, start, end, meta->part, meta->written));
            if (end < meta->end && beside != nullptr) {
                reports.push_back(replan::_told(
                    meta,
                    "cut",
                    lang::text(
                        "is cut at ",
                        lang::fixed(end, 2),
                        " s for '",
                        beside->request->id,
                        "', which is asked for"
                    ),
                    true
                ));
            }
        } else {
            std::string words = beside != nullptr
                ? replan::_no_time(beside)
                : std::string("no time left beside what plays");
            reports.push_back(replan::_told(meta, "covered", words));
        }
    }
    return std::tuple<List<Ref<MetaAction>>, List<Ref<Report>>>{out, reports};
}

/// Return the sort key that decides which is placed first.
inline std::tuple<double, int, std::string, int> _order(const Ref<MetaAction>& meta) {
    return std::tuple<double, int, std::string, int>{
        meta->start,
        -meta->request->priority,
        meta->request->id,
        meta->part
    };
}

inline std::tuple<List<Ref<MetaAction>>, List<Ref<Report>>> _placed(
    const List<Ref<MetaAction>>& metas,
    const Ref<Settings>& settings
) {
    List<std::tuple<double, int, std::string, int>> keys;
    for (const auto& item : metas) {
        keys.push_back(replan::_order(item));
    }
    List<Ref<MetaAction>> queue = lang::ordered(metas, keys);
    int at = 0; // what is before it was looked at
    List<Ref<MetaAction>> placed;
    List<Ref<Report>> reports;
    while (at < lang::len(queue)) {
        Ref<MetaAction> meta = lang::at(queue, at);
        at += 1;
        Ref<MetaAction> last = !placed.empty() ? lang::at(placed, -1) : nullptr;
        if (last == nullptr || last->end <= meta->start) {
            placed.push_back(meta);
            continue;
        }
        if (meta->request->priority > last->request->priority) {
            placed.pop_back();
            bool kept = meta->start - last->start >= settings->shortest;
            if (kept) {
                placed.push_back(lang::made<MetaAction>(
                    last->request,
                    last->start,
                    meta->start,
                    last->part,
                    last->written
                ));
            }
            // What was never begun goes on as itself, so that its draws stay the same.
            Ref<MetaAction> rest = lang::made<MetaAction>(
                last->request,
                meta->end,
                last->end,
                kept ? last->part + 1 : last->part,
                last->written
            );
            bool resumes = last->request->resume && rest->end - rest->start >= settings->shortest;
            if (resumes) {
                std::tuple<double, int, std::string, int> own = replan::_order(rest);
                int place = lang::len(queue);
                while (place > at && own < replan::_order(lang::at(queue, place - 1))) {
                    place -= 1;
                }
                lang::insert(queue, place, rest);
            }
            std::string word = kept ? std::string("is cut") : std::string("gives way");
            std::string after = resumes
                ? lang::text(" and goes on at ", lang::fixed(meta->end, 2), " s")
                : std::string("");
            std::string outcome = resumes ? std::string("resumed") : kept ? std::string("cut") : std::string("covered");
            std::string message = lang::text(
                word,
                " at ",
                lang::fixed(meta->start, 2),
                " s for '",
                meta->request->id,
                "', which is more important",
                after
            );
            reports.push_back(replan::_told(last, outcome, message, kept || resumes));
            std::tuple<double, int, std::string, int> own2 = replan::_order(meta);
            int place2 = lang::len(queue);
            while (place2 > at && own2 < replan::_order(lang::at(queue, place2 - 1))) {
                place2 -= 1;
            }
            lang::insert(queue, place2, meta);
        } else if (meta->request->late.has_value()) {
            std::tuple<double, int, std::string, int> own3 = replan::_order(replan::_after(meta, last->end));
            int place3 = lang::len(queue);
            while (place3 > at && own3 < replan::_order(lang::at(queue, place3 - 1))) {
                place3 -= 1;
            }
            lang::insert(queue, place3, replan::_after(meta, last->end));
        } else if (last->end - meta->request->start > settings->wait) {
            reports.push_back(replan::_told(meta, "covered", replan::_no_time(last)));
        } else {
            std::tuple<double, int, std::string, int> own4 = replan::_order(replan::_after(meta, last->end));
            int place4 = lang::len(queue);
            while (place4 > at && own4 < replan::_order(lang::at(queue, place4 - 1))) {
                place4 -= 1;
            }
            lang::insert(queue, place4, replan::_after(meta, last->end));
            reports.push_back(replan::_told(
                meta,
                "late",
                lang::text(
                    "waits ",
                    lang::fixed(last->end - meta->request->start, 2),
                    " s for '",
                    last->request->id,
                    "'"
                ),
                true
            ));
        }
    }
    return std::tuple<List<Ref<MetaAction>>, List<Ref<Report>>>{placed, reports};
}

/// Return a meta action that begins at `free` instead.
inline Ref<MetaAction> _after(const Ref<MetaAction>& meta, double free) {
    return lang::made<MetaAction>(meta->request, free, free + (meta->end - meta->start), meta->part, meta->written);
}

inline std::string _no_time(const Ref<MetaAction>& other) {
    return lang::text(
        "no time left beside '",
        other->request->id,
        "' (",
        lang::fixed(other->start, 2),
        "-",
        lang::fixed(other->end, 2),
        " s)"
    );
}

inline Ref<Report> _told(
    const Ref<MetaAction>& meta,
    const std::string& outcome,
    const std::string& message,
    bool played
) {
    return lang::made<Report>(
        meta->request->id,
        outcome,
        message,
        meta->request->layer,
        meta->start,
        played,
        meta->written
    );
}

}  // namespace replan

}  // namespace metagraph
