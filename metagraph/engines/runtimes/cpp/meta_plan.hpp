// Requests, meta actions and plans: what the planner takes and returns. All are values; times are seconds.
//
// Translated from metagraph/playback/plan.py; change that, and translate anew.
#pragma once

#include "model.hpp"
#include "language.hpp"

namespace metagraph {

struct MetaRequest;
struct Cursor;
struct MetaAction;
struct Cue;
struct Rest;
struct Report;
struct Past;
struct LayerPlan;

namespace meta_plan {

inline constexpr int ASKED = 1; // default priority of a request
inline constexpr int WRITTEN = 0; // priority of what the Markov model writes
// told by temporal replanning, once
inline const Set<std::string> TEMPORAL = Set<std::string>{"late", "cut", "resumed", "past"};

}  // namespace meta_plan

/// A request of an agent or animator, at any level of abstraction.
///
/// id: unique; it keys the random draws. start: seconds. duration: how long the activity should last, None for one
/// action. action: id of a specific action. tags: all of them must be on the action. limb: which arm. stance: id of the
/// stance to go to (kind "transition"). priority: higher wins. resume: whether the remainder plays afterwards if a more
/// important request cuts it. stroke: when a gesture's stroke should come; `start` is then the earliest it may begin.
/// hold: seconds that its hold should last, None for its length in the clip. prepare: whether its preparation plays.
/// among: ids of the only actions it may be; empty for any. late: by how many seconds its stroke may come late, or its
/// start if it has no stroke; 0 for on time or not at all, None for as late as the settings allow. valence, arousal,
/// intensity: the mood it is played in, as in `mood.Mood`; None for the mood at that time.
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
    std::optional<double> late;
    std::optional<double> valence;
    std::optional<double> arousal;
    std::optional<double> intensity;

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
        List<std::string> among_ = List<std::string>{},
        std::optional<double> late_ = std::nullopt,
        std::optional<double> valence_ = std::nullopt,
        std::optional<double> arousal_ = std::nullopt,
        std::optional<double> intensity_ = std::nullopt
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
            among(std::move(among_)),
            late(late_),
            valence(valence_),
            arousal(arousal_),
            intensity(intensity_) {}
};

/// Where writing continues: before meta action `number`, after state number `state` (-1: none yet), which ended at
/// `time` seconds.
struct Cursor {
    int number;
    int state;
    double time;

    explicit Cursor(int number_ = 0, int state_ = -1, double time_ = 0.0)
        : number(number_), state(state_), time(time_) {}
};

/// A request placed in time: `start`..`end` is the window it may use. written: whether the Markov model wrote it,
/// instead of a request. part: 0 for the request itself, n for its n-th remainder after a cut.
struct MetaAction {
    Ref<MetaRequest> request;
    double start;
    double end;
    int part;
    bool written;

    MetaAction(Ref<MetaRequest> request_, double start_, double end_, int part_ = 0, bool written_ = false)
        : request(std::move(request_)), start(start_), end(end_), part(part_), written(written_) {}

    /// Its importance: its request's priority. What a model wrote gives way to all requests.
    double rank() const;

    /// The key of this meta action's random draws.
    std::string key() const;
};

/// One action in the plan. It plays its clip from `entry` on during `start`..`end`, at `tempo` times its own speed but
/// for its hold.
///
/// hold_from, hold_to: clip seconds of the hold, which takes `hold` seconds; 0, 0, 0 if it is not stretched. blend_in,
/// blend_out: seconds, fitting inside the cue. stance: before it; then: the stance it leaves the layer in. meta: key of
/// the meta action it realises. extent: how large it is played, a factor of its turns away from the stance. cycle_from,
/// cycle_to: clip seconds between which it repeats; 0, 0 if it plays once.
struct Cue {
    Ref<Action> action;
    double start;
    double end;
    double entry;
    double blend_in;
    double blend_out;
    std::string stance;
    std::string then;
    std::string meta;
    double hold_from;
    double hold_to;
    double hold;
    double extent;
    double tempo;
    double cycle_from;
    double cycle_to;

    Cue(
        Ref<Action> action_,
        double start_,
        double end_,
        double entry_,
        double blend_in_,
        double blend_out_,
        std::string stance_,
        std::string then_,
        std::string meta_,
        double hold_from_ = 0.0,
        double hold_to_ = 0.0,
        double hold_ = 0.0,
        double extent_ = 1.0,
        double tempo_ = 1.0,
        double cycle_from_ = 0.0,
        double cycle_to_ = 0.0
    )
        : action(std::move(action_)),
            start(start_),
            end(end_),
            entry(entry_),
            blend_in(blend_in_),
            blend_out(blend_out_),
            stance(std::move(stance_)),
            then(std::move(then_)),
            meta(std::move(meta_)),
            hold_from(hold_from_),
            hold_to(hold_to_),
            hold(hold_),
            extent(extent_),
            tempo(tempo_),
            cycle_from(cycle_from_),
            cycle_to(cycle_to_) {}

    /// Whether it repeats a cycle.
    bool repeats() const;
};

/// The stance loop that lies under the cues from `start` on: loop seconds are `time - start`, wrapped.
///
/// fade_start, fade: when and for how many seconds it takes over from the loop before.
struct Rest {
    std::string stance;
    Ref<Action> action;
    double start;
    double fade_start;
    double fade;

    Rest(std::string stance_, Ref<Action> action_, double start_, double fade_start_, double fade_)
        : stance(std::move(stance_)), action(std::move(action_)), start(start_), fade_start(fade_start_), fade(fade_) {}
};

/// The result of a meta action that does not play exactly as requested. played: whether a part of it still plays. late:
/// by how many seconds it comes late, or would have come, if it said how late it may. by: key of the meta action whose
/// action serves it, too.
struct Report {
    std::string request;
    std::string outcome;
    std::string message;
    std::string layer;
    double at;
    bool played;
    bool written;
    double late;
    std::string by;

    Report(
        std::string request_,
        std::string outcome_,
        std::string message_,
        std::string layer_,
        double at_,
        bool played_ = false,
        bool written_ = false,
        double late_ = 0.0,
        std::string by_ = ""
    )
        : request(std::move(request_)),
            outcome(std::move(outcome_)),
            message(std::move(message_)),
            layer(std::move(layer_)),
            at(at_),
            played(played_),
            written(written_),
            late(late_),
            by(std::move(by_)) {}
};

/// What further planning needs from forgotten cues. free: when the last one ended; stance: in which stance. uses: how
/// often each action was used. recent: the actions used last, by `remembering.node`, the latest at the end. ended: when
/// each ended last.
struct Past {
    double free;
    std::string stance;
    Map<std::string, int> uses;
    Map<std::string, List<std::string>> recent;
    Map<std::string, double> ended;

    explicit Past(
        double free_ = 0.0,
        std::string stance_ = "",
        Map<std::string, int> uses_ = Map<std::string, int>{},
        Map<std::string, List<std::string>> recent_ = Map<std::string, List<std::string>>{},
        Map<std::string, double> ended_ = Map<std::string, double>{}
    )
        : free(free_),
            stance(std::move(stance_)),
            uses(std::move(uses_)),
            recent(std::move(recent_)),
            ended(std::move(ended_)) {}
};

/// cues never overlap and ascend; rests ascend by fade_start, the first covering everything before.
///
/// past: what came before the first cue, if that was forgotten. cursor: where the Markov model continues to write.
/// written: what it wrote for later, unchanged: each extension fits it in again, so that it does not matter when it was
/// written.
struct LayerPlan {
    std::string layer;
    List<Ref<MetaAction>> metas;
    List<Ref<Cue>> cues;
    List<Ref<Rest>> rests;
    Ref<Past> past;
    Ref<Cursor> cursor;
    List<Ref<MetaAction>> written;

    explicit LayerPlan(
        std::string layer_,
        List<Ref<MetaAction>> metas_ = List<Ref<MetaAction>>{},
        List<Ref<Cue>> cues_ = List<Ref<Cue>>{},
        List<Ref<Rest>> rests_ = List<Ref<Rest>>{},
        Ref<Past> past_ = lang::made<Past>(),
        Ref<Cursor> cursor_ = lang::made<Cursor>(),
        List<Ref<MetaAction>> written_ = List<Ref<MetaAction>>{}
    )
        : layer(std::move(layer_)),
            metas(std::move(metas_)),
            cues(std::move(cues_)),
            rests(std::move(rests_)),
            past(std::move(past_)),
            cursor(std::move(cursor_)),
            written(std::move(written_)) {}
};

inline double MetaAction::rank() const {
    return this->written ? -INFINITY : static_cast<double>(this->request->priority);
}

inline std::string MetaAction::key() const {
    return this->part == 0 ? this->request->id : lang::text(this->request->id, "+", this->part);
}

inline bool Cue::repeats() const {
    return this->cycle_to > this->cycle_from;
}

}  // namespace metagraph
