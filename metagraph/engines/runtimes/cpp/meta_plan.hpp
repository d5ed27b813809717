// Requests, meta actions and plans: what the planner takes and gives. All values; times are seconds.
//
// Translated from metagraph/playback/plan.py; change that, and translate anew.
#pragma once

#include "language.hpp"

namespace metagraph {

struct MetaRequest;
struct Cursor;
struct MetaAction;
struct Report;

namespace meta_plan {

inline constexpr int ASKED = 1; // default priority of a request
inline constexpr int WRITTEN = 0; // priority of what the Markov model writes

}  // namespace meta_plan

/// What an agent or animator asks for, at any level of abstraction.
///
/// id: unique; it keys the random draws. start: seconds. duration: how long the activity is wanted, None for one
/// action. action: id of a specific action. tags: all of them must be on the action. limb: which arm. stance: id of the
/// stance to go to (kind "transition"). priority: higher wins. resume: whether, when something more important cuts it,
/// its remainder goes on afterwards. stroke: when a gesture's stroke should come; `start` is then the earliest it may
/// begin. hold: seconds its hold should last, None for as long as it was made. prepare: whether its preparation plays.
/// among: ids of the only actions it may be, any where empty.
struct MetaRequest {
    std::string id;
    std::string layer;
    std::string kind;
    double start;
    std::optional<double> duration;
    std::optional<std::string> action;
    List<std::string> tags;
    std::optional<std::string> limb;
    std::optional<std::string> stance;
    int priority;
    bool resume;
    std::optional<double> stroke;
    std::optional<double> hold;
    bool prepare;
    List<std::string> among;

    MetaRequest(
        std::string id_,
        std::string layer_,
        std::string kind_,
        double start_,
        std::optional<double> duration_ = std::nullopt,
        std::optional<std::string> action_ = std::nullopt,
        List<std::string> tags_ = List<std::string>{},
        std::optional<std::string> limb_ = std::nullopt,
        std::optional<std::string> stance_ = std::nullopt,
        int priority_ = meta_plan::ASKED,
        bool resume_ = false,
        std::optional<double> stroke_ = std::nullopt,
        std::optional<double> hold_ = std::nullopt,
        bool prepare_ = true,
        List<std::string> among_ = List<std::string>{}
    )
        : id(std::move(id_)),
            layer(std::move(layer_)),
            kind(std::move(kind_)),
            start(start_),
            duration(duration_),
            action(std::move(action_)),
            tags(std::move(tags_)),
            limb(std::move(limb_)),
            stance(std::move(stance_)),
            priority(priority_),
            resume(resume_),
            stroke(stroke_),
            hold(hold_),
            prepare(prepare_),
            among(std::move(among_)) {}
};

/// Where writing stands: before meta action `number`, in state number `state` (-1: none yet), which ended at `time`
/// seconds.
struct Cursor {
    int number;
    int state;
    double time;

    explicit Cursor(int number_ = 0, int state_ = -1, double time_ = 0.0)
        : number(number_), state(state_), time(time_) {}
};

/// A request placed in time: `start`..`end` is the window it may use. written: by the Markov model, not asked for.
/// part: 0 for the request itself, n for its n-th remainder after a cut.
struct MetaAction {
    Ref<MetaRequest> request;
    double start;
    double end;
    int part;
    bool written;

    MetaAction(Ref<MetaRequest> request_, double start_, double end_, int part_ = 0, bool written_ = false)
        : request(std::move(request_)), start(start_), end(end_), part(part_), written(written_) {}

    /// How important it is: its request's priority; what a model wrote gives way to all that is asked for.
    double rank() const {
        return written ? -INFINITY : static_cast<double>(request->priority);
    }

    /// What keys this meta action's random draws.
    std::string key() const {
        return part == 0 ? request->id : lang::text(request->id, "+", part);
    }
};

/// What became of a meta action that was not simply played as asked. played: whether something of it still plays.
struct Report {
    std::string request;
    std::string outcome;
    std::string message;
    std::string layer;
    double at;
    bool played;
    bool written;

    Report(
        std::string request_,
        std::string outcome_,
        std::string message_,
        std::string layer_,
        double at_,
        bool played_ = false,
        bool written_ = false
    )
        : request(std::move(request_)),
            outcome(std::move(outcome_)),
            message(std::move(message_)),
            layer(std::move(layer_)),
            at(at_),
            played(played_),
            written(written_) {}
};

}  // namespace metagraph
