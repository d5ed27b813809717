// The values a project is made of. All are frozen; mappings in them are never changed in place.
//
// Ids are made once from the project's counter and never change; names are free text for people.
//
// Translated from metagraph/graph/model.py; change that, and translate anew.
#pragma once

#include "contact_spans.hpp"
#include "language.hpp"

namespace metagraph {

struct Timing;
struct Action;
struct Stance;
struct Markov;
struct Settings;

/// When an action plays within its clip; seconds of the clip.
///
/// start, end: the part that plays; `end` None is the clip's end. blend_in, blend_out: seconds of blending from and to
/// the stance, within start..end (for a looping stance, blend_in is the overlap at the loop's seam). loop: repeats.
/// earliest_exit: from here on the action may be left, or None to play it through. stroke: its most telling moment.
/// ready, stroke_end, relax: where a gesture's preparation, stroke and hold end (its retraction ends with it); None as
/// found from the motion (`playback.timing.phases`).
struct Timing {
    double start;
    std::optional<double> end;
    double blend_in;
    double blend_out;
    bool loop;
    std::optional<double> earliest_exit;
    std::optional<double> stroke;
    std::optional<double> ready;
    std::optional<double> stroke_end;
    std::optional<double> relax;

    explicit Timing(
        double start_ = 0.0,
        std::optional<double> end_ = std::nullopt,
        double blend_in_ = 0.2,
        double blend_out_ = 0.3,
        bool loop_ = false,
        std::optional<double> earliest_exit_ = std::nullopt,
        std::optional<double> stroke_ = std::nullopt,
        std::optional<double> ready_ = std::nullopt,
        std::optional<double> stroke_end_ = std::nullopt,
        std::optional<double> relax_ = std::nullopt
    )
        : start(start_),
            end(end_),
            blend_in(blend_in_),
            blend_out(blend_out_),
            loop(loop_),
            earliest_exit(earliest_exit_),
            stroke(stroke_),
            ready(ready_),
            stroke_end(stroke_end_),
            relax(relax_) {}
};

/// One use of a clip in the graph.
///
/// stance: id of the stance it starts from (for kind "stance", the stance whose loop it is). end_stance: only for
/// transitions. limb: which arm it needs; the other keeps to the stance. joints: names of the only joints it moves;
/// empty means all. joint_weights: how far those move that move in part, (name, above 0 and below 1); the rest of the
/// way they keep to the stance. tags: free words, "positive" and "negative" among them. likelihood: relative, > 0.
/// cooldown: seconds after it has ended in which it is not drawn again. spacing: how many other actions of its kind and
/// stance are drawn before it may be drawn again; None as the settings' never_twice says. contacts: where its hands
/// stay on the body. clip_name, clip_sha256: which clip it was made of, where that is not the one it has; "" otherwise
/// (see `formats.clip_identity`).
struct Action {
    std::string id;
    std::string clip;
    std::string kind;
    std::string layer;
    std::string stance;
    std::string name;
    std::optional<std::string> end_stance;
    Ref<Timing> timing;
    std::string limb;
    List<std::string> joints;
    List<std::string> tags;
    double likelihood;
    double cooldown;
    std::optional<int> spacing;
    List<Ref<ContactSpan>> contacts;
    List<std::tuple<std::string, double>> joint_weights;
    std::string clip_name;
    std::string clip_sha256;

    Action(
        std::string id_,
        std::string clip_,
        std::string kind_,
        std::string layer_,
        std::string stance_,
        std::string name_,
        std::optional<std::string> end_stance_ = std::nullopt,
        Ref<Timing> timing_ = lang::made<Timing>(),
        std::string limb_ = "both",
        List<std::string> joints_ = List<std::string>{},
        List<std::string> tags_ = List<std::string>{},
        double likelihood_ = 1.0,
        double cooldown_ = 0.0,
        std::optional<int> spacing_ = std::nullopt,
        List<Ref<ContactSpan>> contacts_ = List<Ref<ContactSpan>>{},
        List<std::tuple<std::string, double>> joint_weights_ = List<std::tuple<std::string, double>>{},
        std::string clip_name_ = "",
        std::string clip_sha256_ = ""
    )
        : id(std::move(id_)),
            clip(std::move(clip_)),
            kind(std::move(kind_)),
            layer(std::move(layer_)),
            stance(std::move(stance_)),
            name(std::move(name_)),
            end_stance(std::move(end_stance_)),
            timing(std::move(timing_)),
            limb(std::move(limb_)),
            joints(std::move(joints_)),
            tags(std::move(tags_)),
            likelihood(likelihood_),
            cooldown(cooldown_),
            spacing(spacing_),
            contacts(std::move(contacts_)),
            joint_weights(std::move(joint_weights_)),
            clip_name(std::move(clip_name_)),
            clip_sha256(std::move(clip_sha256_)) {}
};

struct Stance {
    std::string id;
    std::string layer;
    std::string name;

    Stance(std::string id_, std::string layer_, std::string name_)
        : id(std::move(id_)), layer(std::move(layer_)), name(std::move(name_)) {}
};

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
    std::string tag(int state) const;
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

inline std::string Markov::tag(int state) const {
    return !this->tags.empty() ? lang::at(this->tags, state) : std::string("");
}

}  // namespace metagraph
