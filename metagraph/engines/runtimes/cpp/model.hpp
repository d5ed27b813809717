// The values a project is made of. All are frozen; mappings in them are never changed in place.
//
// Ids are made once from the project's counter and never change; names are free text for people.
//
// Translated from metagraph/graph/model.py; change that, and translate anew.
#pragma once

#include "language.hpp"

namespace metagraph {

struct Markov;
struct Settings;

/// A first-order model over (limb, kind) that writes meta actions when nobody asks for any (Borer et al., 7.3).
///
/// matrix: rows of probabilities, each summing to 1. gap: mean seconds of rest between two actions. positive, negative:
/// share of gestures asked for with that tag, where tags are not part of the states. tags: one text a state, the tags
/// (blanks between them) it asks for; empty when tags are not part of the states. lengths: (mean, standard deviation)
/// seconds of each state's actions; empty where that is not known. modes: what is performed of what it writes while one
/// is said to idle, to listen and to talk, a row each: shares of gestures, fidgets and transitions, 0..1; empty where
/// the mode makes no difference.
struct Markov {
    std::string layer;
    List<std::tuple<std::string, std::string>> states;
    List<List<double>> matrix;
    double gap;
    double positive;
    double negative;
    List<std::string> tags;
    List<std::tuple<double, double>> lengths;
    List<List<double>> modes;

    Markov(
        std::string layer_,
        List<std::tuple<std::string, std::string>> states_,
        List<List<double>> matrix_,
        double gap_ = 2.5,
        double positive_ = 0.0,
        double negative_ = 0.0,
        List<std::string> tags_ = List<std::string>{},
        List<std::tuple<double, double>> lengths_ = List<std::tuple<double, double>>{},
        List<List<double>> modes_ = List<List<double>>{}
    )
        : layer(std::move(layer_)),
            states(std::move(states_)),
            matrix(std::move(matrix_)),
            gap(gap_),
            positive(positive_),
            negative(negative_),
            tags(std::move(tags_)),
            lengths(std::move(lengths_)),
            modes(std::move(modes_)) {}

    /// Return the tags a state asks for, "" for none.
    std::string tag(int state) const {
        return !tags.empty() ? lang::at(tags, state) : std::string("");
    }
};

/// Planner constants. alpha: how quickly a used action becomes unlikely (4 in the paper). seed: 32-bit.
///
/// never_twice: an action is not played twice in a row where there is another. shortest: seconds below which the
/// remainder of a cut meta action is not worth keeping. wait: how late, in seconds, a request may start. memory:
/// seconds after which a use no longer counts, 0 for never (as in the paper). rest: least seconds in the stance between
/// two actions of a layer. lookahead: seconds ahead of now in which a running plan is not changed any more.
struct Settings {
    double alpha;
    int seed;
    bool never_twice;
    double shortest;
    double wait;
    double memory;
    double rest;
    double lookahead;

    explicit Settings(
        double alpha_ = 4.0,
        int seed_ = 1,
        bool never_twice_ = true,
        double shortest_ = 0.4,
        double wait_ = 4.0,
        double memory_ = 0.0,
        double rest_ = 0.0,
        double lookahead_ = 0.1
    )
        : alpha(alpha_),
            seed(seed_),
            never_twice(never_twice_),
            shortest(shortest_),
            wait(wait_),
            memory(memory_),
            rest(rest_),
            lookahead(lookahead_) {}
};

}  // namespace metagraph
