// The Markov model that performs when there are no requests: a first-order chain over (limb, kind).
//
// The arms matrix is the paper's (Borer et al., figure 11), learned from annotated casual conversation. Body and head
// have no published matrix; theirs are ours, shaped on the paper's labels: the head nods and now and then changes its
// tilt, the body mostly rests, shifts and fidgets. The shares of what is performed in the modes idle, listening and
// talking are ours, too: the hands gesture with the character's own speech, and the head nods at the other's.
//
// Translated from metagraph/playback/planning/markov.py; change that, and translate anew.
#pragma once

#include "model.hpp"
#include "words.hpp"
#include "meta_plan.hpp"
#include "choice.hpp"
#include "language.hpp"

namespace metagraph {


namespace markov {

inline const List<std::string> KINDS = List<std::string>{"gesture", "fidget", "transition"}; // as in `Markov.modes`
inline constexpr int LISTENS = 1; // place of the row that stands for modes of which a model says nothing
inline const Ref<Cursor> BEGIN = lang::made<Cursor>();
inline constexpr double RESTS = 0.9; // standard deviation of rests, times their mean
inline std::tuple<List<Ref<MetaAction>>, Ref<Cursor>> write(
    const Ref<Markov>& chain,
    std::uint32_t seed,
    double until,
    const std::optional<Set<std::string>>& kinds = std::nullopt,
    const Ref<Cursor>& cursor = markov::BEGIN
);
inline Map<std::string, double> _row(const Ref<Markov>& chain, int state, const List<double>& open_to);
inline bool performs(
    const Ref<Markov>& chain,
    std::uint32_t seed,
    const Ref<MetaAction>& meta,
    const std::string& mode
);
inline double length(const Ref<Markov>& chain, int state, std::uint32_t key);
inline double rest_length(const Ref<Markov>& chain, std::uint32_t key);

}  // namespace markov

namespace markov {

/// Return the meta actions that start before `until` seconds, from the cursor on, and the cursor before the first one
/// left out.
///
/// Rests are log-normal about the mean gap (`rest_length`): most are short, some long, as people's are. Windows are as
/// `length` says. kinds: those that the graph has; states of other kinds are passed over, so that half-filled graphs
/// perform, too.
///
/// Each draw is keyed by the meta action's number. So a longer horizon only appends, and continuing from a cursor gives
/// bit for bit the same as writing in one go. After a row of zeros, the chain starts again from any state.
inline std::tuple<List<Ref<MetaAction>>, Ref<Cursor>> write(
    const Ref<Markov>& chain,
    std::uint32_t seed,
    double until,
    const std::optional<Set<std::string>>& kinds,
    const Ref<Cursor>& cursor
) {
    int number = cursor->number;
    int state = cursor->state;
    double time = cursor->time;
    List<double> open_to;
    for (const auto& [_, kind2] : chain->states) {
        open_to.push_back((!kinds.has_value() || lang::contains(*kinds, kind2)) ? 1.0 : 0.0);
    }
    Map<int, Map<std::string, double>> rows;
    List<Ref<MetaAction>> out;
    bool is_any = false;
    for (const auto& p : open_to) {
        if (p > 0) {
            is_any = true;
            break;
        }
    }
    bool able = is_any;
    while (able) {
        std::string ident = lang::text("auto/", chain->layer, "/", number);
        int key = choice::keyed(seed, List<std::string>{ident});
        double start = time + markov::rest_length(chain, key);
        if (!(start < until)) { // nor when it is no number
            break;
        }
        if (!lang::contains(rows, state)) {
            rows[state] = markov::_row(chain, state, open_to);
        }
        state = std::stoi(choice::picked(key, "state", rows.at(state)));
        auto [limb, kind] = lang::at(chain->states, state);
        double seconds = markov::length(chain, state, key);
        List<std::string> tags = lang::words(chain->tag(state));
        if (kind == "gesture" && lang::len(chain->tags) == 0) {
            double draw = choice::chance_of(key, "tag");
            if (draw < chain->positive) {
                tags = List<std::string>{"positive"};
            } else if (draw < chain->positive + chain->negative) {
                tags = List<std::string>{"negative"};
            }
        }
        Ref<MetaRequest> request = lang::made<MetaRequest>(
            ident,
            chain->layer,
            kind,
            start,
            seconds,
            std::nullopt,
            tags,
            limb,
            std::nullopt,
            meta_plan::WRITTEN
        );
        out.push_back(lang::made<MetaAction>(request, start, start + seconds, 0, true));
        number = number + 1;
        time = start + seconds;
    }
    return std::tuple<List<Ref<MetaAction>>, Ref<Cursor>>{out, lang::made<Cursor>(number, state, time)};
}

/// Return the probability of each state that may follow a state (-1: before the first), by its index; of all allowed
/// states if none may follow.
inline Map<std::string, double> _row(const Ref<Markov>& chain, int state, const List<double>& open_to) {
    List<double> row = open_to;
    if (0 <= state && state < lang::len(row)) {
        List<double> found;
        for (int n = 0; n < lang::len(lang::at(chain->matrix, state)); n++) {
            const auto& p = lang::at(lang::at(chain->matrix, state), n);
            const auto& may = lang::at(open_to, n);
            found.push_back(p * may);
        }
        row = found;
    }
    bool is_any = false;
    for (const auto& p : row) {
        if (p > 0) {
            is_any = true;
            break;
        }
    }
    if (!is_any) {
        row = open_to;
    }
    Map<std::string, double> found2;
    for (int i = 0; i < lang::len(row); i++) {
        const auto& p = lang::at(row, i);
        if (p > 0) {
            found2[lang::text(i)] = p;
        }
    }
    return found2;
}

/// Return whether something that the model wrote is performed in a mode (`Markov.modes`). What is left out does not
/// change the rest, so it does not matter when a mode became known.
inline bool performs(
    const Ref<Markov>& chain,
    std::uint32_t seed,
    const Ref<MetaAction>& meta,
    const std::string& mode
) {
    if (lang::len(chain->modes) == 0 || !lang::contains(markov::KINDS, meta->request->kind)) {
        return true;
    }
    int place = lang::index(words::MODES, mode);
    List<double> row = lang::at(chain->modes, place < lang::len(chain->modes) ? place : markov::LISTENS);
    double share = lang::at(row, lang::index(markov::KINDS, meta->request->kind));
    return share >= 1 || choice::uniform(seed, List<std::string>{meta->request->id, "mode"}) < share;
}

/// Return how many seconds a meta action of a key lasts: uniform from 1 to 3 if the model has no lengths; else
/// log-normal with the state's mean and standard deviation.
inline double length(const Ref<Markov>& chain, int state, std::uint32_t key) {
    if (lang::len(chain->lengths) == 0) {
        return 1.0 + 2.0 * choice::chance_of(key, "length");
    }
    auto [mean, deviation] = lang::at(chain->lengths, state);
    return choice::log_normal(mean, deviation, choice::chance_of(key, "length"), choice::chance_of(key, "length2"));
}

/// Return how many seconds of rest come before a meta action of a key: log-normal with the mean `chain.gap`, between a
/// fifth and five times of it.
inline double rest_length(const Ref<Markov>& chain, std::uint32_t key) {
    double drawn = choice::log_normal(
        chain->gap,
        markov::RESTS * chain->gap,
        choice::chance_of(key, "gap"),
        choice::chance_of(key, "gap2")
    );
    return std::min(5.0 * chain->gap, std::max(0.2 * chain->gap, drawn));
}

}  // namespace markov

}  // namespace metagraph
