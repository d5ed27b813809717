// Define the values that a project is made of. All are frozen, and their mappings never change in place.
//
// Ids are made once from the content they are for and never change. Names are free text for people.
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

/// When an action plays within its clip. All times are seconds of the clip.
///
/// `start` and `end` bound the part that plays; an `end` of None is the clip's end. `blend_in` and `blend_out` are the
/// seconds of blending from and to the stance, inside that part. For a looping stance, `blend_in` is the overlap at the
/// loop's seam. `loop` repeats the part. From `earliest_exit` on, the next action may start; None plays the action to
/// its end. `stroke` is its most expressive moment. `ready`, `stroke_end` and `relax` are the ends of a gesture's
/// preparation, stroke and hold; its retraction ends with the action. None takes the times found from the motion
/// (`playback.timing.phases`). `repeat` is the number of seconds for which a gesture or fidget repeats its part if no
/// request says how long; it plays the nearest whole number of times. 0 plays it once.
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
    double repeat;

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
        std::optional<double> relax_ = std::nullopt,
        double repeat_ = 0.0
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
            relax(relax_),
            repeat(repeat_) {}
};

/// One use of a clip in the graph.
///
/// `stance` is the id of the stance it starts from; for kind "stance", of the stance whose loop it is. Only transitions
/// have an `end_stance`. `limb` is the arm it needs; the other arm stays in the stance. `joints` names the only joints
/// it moves; empty means all. `joint_weights` has pairs of a name and a weight, above 0 and below 1, for joints that it
/// moves in part; the rest of their motion is the stance's. `tags` are free words, "positive" and "negative" among
/// them. `likelihood` is relative, above 0. `cooldown` is the number of seconds after its end in which it is not chosen
/// again. `spacing` is the number of other actions of its kind and stance that are chosen before it may be chosen
/// again; None follows the setting `never_twice`. `prominence` says how much it stands out, 0..1; None takes what its
/// motion and name say. `contacts` are the times when its hands stay on the body. `clip_name` and `clip_sha256` name
/// the clip it was made from if it has another clip now, else "" (see `formats.clip_identity`).
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
    std::optional<double> prominence;

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
        std::string clip_sha256_ = "",
        std::optional<double> prominence_ = std::nullopt
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
            clip_sha256(std::move(clip_sha256_)),
            prominence(prominence_) {}
};

struct Stance {
    std::string id;
    std::string layer;
    std::string name;

    Stance(std::string id_, std::string layer_, std::string name_)
        : id(std::move(id_)), layer(std::move(layer_)), name(std::move(name_)) {}
};

/// A first-order model over (limb, kind). It writes meta actions when there are no requests (Borer et al., 7.3).
///
/// `matrix` has rows of probabilities, each of which sums to 1. `gap` is the mean rest between two actions, in seconds.
/// `positive` and `negative` are the shares of gestures that request that tag, if tags are not part of the states.
/// `tags` has one text for each state: the tags it requests, with blanks between them; it is empty if tags are not part
/// of the states. `lengths` has the mean and standard deviation of each state's actions, in seconds; it is empty if
/// they are unknown. `modes` has one row for each mode, in the order of `words.MODES`: the shares, 0 to 1, of the
/// written gestures, fidgets and transitions that are performed in that mode. Without the last two rows, thinking and
/// reacting are as listening. It is empty if the mode makes no difference.
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

    /// Return the tags that a state requests, "" for none.
    std::string tag(int state) const;
};

/// The planner's constants.
///
/// `alpha` says how quickly a used action becomes unlikely (4 in the paper). `seed` has 32 bits. With `never_twice`, an
/// action is not played twice in a row if there is another. `shortest` is the minimum length, in seconds, of a
/// remainder that is kept when a meta action is cut. `wait` is how many seconds late a request may start. `memory` is
/// the number of seconds after which a use no longer counts, 0 for never (as in the paper). `rest` is the least number
/// of seconds in the stance between two actions of a layer. A running plan is not changed for the next `lookahead`
/// seconds. `variety`, 0..4, multiplies the times of `planning.director`, which decide how rarely actions repeat and
/// stances change; 0 is as in the paper.
struct Settings {
    double alpha;
    int seed;
    bool never_twice;
    double shortest;
    double wait;
    double memory;
    double rest;
    double lookahead;
    double variety;

    explicit Settings(
        double alpha_ = 4.0,
        int seed_ = 1,
        bool never_twice_ = true,
        double shortest_ = 0.4,
        double wait_ = 4.0,
        double memory_ = 0.0,
        double rest_ = 0.0,
        double lookahead_ = 0.1,
        double variety_ = 1.0
    )
        : alpha(alpha_),
            seed(seed_),
            never_twice(never_twice_),
            shortest(shortest_),
            wait(wait_),
            memory(memory_),
            rest(rest_),
            lookahead(lookahead_),
            variety(variety_) {}
};

inline std::string Markov::tag(int state) const {
    return !this->tags.empty() ? lang::at(this->tags, state) : std::string("");
}

}  // namespace metagraph
