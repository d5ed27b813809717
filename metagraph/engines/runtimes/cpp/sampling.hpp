// From a meta plan to specific actions: candidates, the three temporal cases, the draw (Borer et al., section 6.2).
//
// Translated from metagraph/playback/planning/sampling.py; change that, and translate anew.
#pragma once

#include "model.hpp"
#include "repeating.hpp"
#include "track.hpp"
#include "wanted.hpp"
#include "meta_plan.hpp"
#include "bounds.hpp"
#include "choice.hpp"
#include "cue_shapes.hpp"
#include "director.hpp"
#include "markov.hpp"
#include "mood.hpp"
#include "prominence.hpp"
#include "remembering.hpp"
#include "vigour.hpp"
#include "phase_times.hpp"
#include "phases.hpp"
#include "project.hpp"
#include "language.hpp"

namespace metagraph {

struct SamplingStep;
struct Performer;

namespace sampling {

inline constexpr double ON_TIME = 0.1; // seconds by which a request may begin later and still be on time
// seconds of crossfade when a long rest changes from one loop of its stance to another
inline constexpr double LOOP_FADE = 0.6;
inline Ref<Performer> performer_after(
    const Ref<Project>& project,
    const Ref<MetaGraph>& graph,
    std::uint32_t seed,
    const std::string& begin,
    const Ref<Past>& past,
    const List<Ref<Cue>>& cues,
    const Ref<Moods>& moods,
    const Ref<Track>& track
);

}  // namespace sampling

/// One action of a chain: the candidates for it and, for a transition on the way, the stance it leads to.
struct SamplingStep {
    List<Ref<Action>> candidates;
    std::string hop;

    explicit SamplingStep(List<Ref<Action>> candidates_, std::string hop_ = "")
        : candidates(std::move(candidates_)), hop(std::move(hop_)) {}
};

/// One layer being planned, cue after cue. It changes while planning, and never leaves the planner.
///
/// uses: how often each action was used. recent: the last draws of each `node`. ended: when each action ended. begun:
/// keys of meta actions whose chain of transitions already plays. served: keys of those that the action of another one
/// serves, too. moods: the mood over time. candidates: the actions of each `node` that may be drawn, for the nodes
/// needed so far. prominences: of actions, as far as needed. acted: when the last action ended. track: what lasts.
/// model: the one that wrote what was not requested, None if there is none. beats: seconds after which a gesture that
/// hardly shows may be done again.
struct Performer {
    Ref<Project> project;
    Ref<MetaGraph> graph;
    std::uint32_t seed;
    std::string stance;
    Ref<Moods> moods;
    Ref<Track> track;
    double free;
    double acted;
    Map<std::string, int> uses;
    Map<std::string, List<std::string>> recent;
    Map<std::string, double> ended;
    List<Ref<Cue>> cues;
    List<Ref<Rest>> rests;
    List<Ref<Report>> reports;
    Set<std::string> begun;
    Set<std::string> served;
    Map<std::string, List<Ref<Action>>> candidates;
    Map<std::string, double> prominences;
    Ref<Markov> model;
    double beats;

    Performer(
        Ref<Project> project_,
        Ref<MetaGraph> graph_,
        std::uint32_t seed_,
        std::string stance_,
        Ref<Moods> moods_,
        Ref<Track> track_,
        double free_ = 0.0,
        double acted_ = 0.0,
        Map<std::string, int> uses_ = Map<std::string, int>{},
        Map<std::string, List<std::string>> recent_ = Map<std::string, List<std::string>>{},
        Map<std::string, double> ended_ = Map<std::string, double>{},
        List<Ref<Cue>> cues_ = List<Ref<Cue>>{},
        List<Ref<Rest>> rests_ = List<Ref<Rest>>{},
        List<Ref<Report>> reports_ = List<Ref<Report>>{},
        Set<std::string> begun_ = Set<std::string>{},
        Set<std::string> served_ = Set<std::string>{},
        Map<std::string, List<Ref<Action>>> candidates_ = Map<std::string, List<Ref<Action>>>{},
        Map<std::string, double> prominences_ = Map<std::string, double>{},
        Ref<Markov> model_ = nullptr,
        double beats_ = director::LEAST_BEATS
    )
        : project(std::move(project_)),
            graph(std::move(graph_)),
            seed(seed_),
            stance(std::move(stance_)),
            moods(std::move(moods_)),
            track(std::move(track_)),
            free(free_),
            acted(acted_),
            uses(std::move(uses_)),
            recent(std::move(recent_)),
            ended(std::move(ended_)),
            cues(std::move(cues_)),
            rests(std::move(rests_)),
            reports(std::move(reports_)),
            begun(std::move(begun_)),
            served(std::move(served_)),
            candidates(std::move(candidates_)),
            prominences(std::move(prominences_)),
            model(std::move(model_)),
            beats(beats_) {}

    /// Note that a cue is played.
    void note(const Ref<Cue>& cue, const std::string& then);

    /// The earliest time at which the next action may begin.
    double ready();

    /// Lay the first loop down; return whether the layer can perform at all.
    bool begin(const std::string& stance);

    /// Realise in order those meta actions of a conflict-free meta plan that start before `end`.
    void perform(const List<Ref<MetaAction>>& metas, double end);

    void _realise(const Ref<Bound>& bound, double now);

    /// Return whether what a model wrote is performed at a time: not out of a stance that a request holds, and as often
    /// as mode and mood say. Anything may begin a long thought, or end it.
    bool _performs(const Ref<MetaAction>& meta, double now);

    /// Return whether what a model wrote begins at a time, which may be later than it was written for: not soon after
    /// an interruption, and nothing that would end a thought.
    bool _may_begin(const Ref<MetaAction>& meta, double now);

    /// Return whether the arms rest at a time: after a burst of one who talks, else after any act. In a thought acts
    /// are rare anyway.
    bool _lulls(double now);

    /// Return whether the arms take or keep the stance in which the character thinks.
    bool _muses(double now);

    /// Return whether a thought of the character has ended just now.
    bool _has_mused(double now);

    /// Return the stance that the arms go to whatever a model wrote: the one in which the character thinks, and from
    /// there home as soon as the thought is over; "" for none.
    std::string _leads(double now);

    /// Return the candidates that come least late, if that is not too late; among them those that leave the following
    /// requests the most time and serve the most of them.
    List<Ref<Action>> _timely(const Ref<Bound>& bound, const List<Ref<Action>>& fitting, double now);

    /// Return the reason why a request comes late.
    std::string _cause(const Ref<MetaRequest>& request, double now);

    /// Return the latest time at which a requested action has to begin to be on time; never in the past.
    double _latest(const Ref<MetaRequest>& request);

    /// Return the earliest time at which the next action could begin after this one.
    double _over(const Ref<Action>& action, const Ref<MetaRequest>& request, double now);

    /// Return when an action that should play to its end is left early all the same: early enough for the first
    /// following request that can then be in time, late enough for its own stroke; infinity for never.
    double _until(const Ref<Action>& action, const Ref<CueShape>& shape, const Ref<Bound>& bound);

    /// Leave the running action early for the first request that can then be in time, or if it was `stopped`. An action
    /// that a model wrote, or that is less important, is left at once; others are left where their retraction begins.
    void make_way(const Ref<MetaAction>& running, const List<Ref<MetaAction>>& asked, double now, bool stopped);

    /// Leave the running action: it returns to its stance from where it is. A transition ends in the stance it leads
    /// to.
    void retract(double now);

    /// Return the time from which an action may be drawn again.
    double _cooled(const Ref<Action>& action);

    /// Return each action in turn: the transitions to get there, then the action itself; None if it is impossible or
    /// not needed, or if the model wrote it and every candidate played too recently.
    std::optional<List<Ref<SamplingStep>>> _steps(const Ref<MetaAction>& meta, double now);

    std::string _elsewhere(const Ref<MetaRequest>& request);

    /// Return the transitions hop by hop from the current stance to `goal`.
    std::optional<List<Ref<SamplingStep>>> _way(const Ref<MetaAction>& meta, const std::string& goal);

    /// Return the stances after the current one on the shortest way of transitions that can play, the goal last; empty
    /// if there is no way. Among equally short ways, the one whose transitions were placed first.
    List<std::string> _chain(const std::string& goal);

    /// Return whether an action leaves the layer in a stance that has a loop.
    bool _arrives(const Ref<Action>& action);

    bool _usable(const Ref<Action>& action);

    /// Return how an action would play for a request from `now` on, or as a step on the way to it.
    Ref<CueShape> _shape(const Ref<Action>& action, const Ref<MetaRequest>& request, double now, const Ref<Mood>& mood);

    /// Return the mood in which a request is played from `at` on, or at its stroke.
    Ref<Mood> _mood(const Ref<MetaRequest>& request, double at);

    /// Return the speed of an action in a mood, 1 if it was made for the mood.
    double _tempo(const Ref<Action>& action, const Ref<Mood>& mood);

    /// Return the extent of an action in a mood. Actions that move the feet, lead to another stance, touch something or
    /// were made for the mood keep their extent.
    double _extent(const Ref<Action>& action, const Ref<Mood>& mood);

    /// Draw with p_k ~ likelihood_k / max(c_k, 1), times the factors of mood and variety. Actions used too recently are
    /// left out as long as others are left.
    Ref<Action> _draw(const List<Ref<Action>>& candidates, const std::string& key, double now, const Ref<Mood>& mood);

    /// Return the factor by which variety changes an action's likelihood.
    double _variety(const Ref<Action>& action, double now);

    /// Return how much an action stands out.
    double _shows(const Ref<Action>& action);

    /// Return the actions that the character may do by itself; see `director`.
    List<Ref<Action>> _fresh(const Ref<MetaAction>& meta, const List<Ref<Action>>& candidates, double now);

    /// Return the candidates for a requested fidget in a conversation without those that stand out, if others are left
    /// and no tags are requested; else all.
    List<Ref<Action>> _modest(const Ref<MetaAction>& meta, const List<Ref<Action>>& candidates, double now);

    /// Return the transitions of the arms that may play for a gesture where all gestures of the stance have played too
    /// recently, and others of another stance have not.
    List<Ref<Action>> _moves_on(const Ref<MetaAction>& meta, double now);

    /// Return how many gestures of a stance have not played for long enough.
    int _count_fresh(const std::optional<std::string>& stance, double now);

    /// Return when the stance was last changed; minus infinity for never.
    double _moved();

    /// Return whether an act that stands out was done since a time.
    bool _shown(double since);

    /// Leave out actions that need more other actions before they play again. If nothing is left, all need one less,
    /// and so on.
    List<Ref<Action>> _spaced(const List<Ref<Action>>& candidates);

    /// Return c_k of section 6.2, alpha times the uses, over the settings' memory.
    double _count(const std::string& ident, double now);

    /// hops: whether it is a transition on the way to the requested action.
    Ref<Cue> _cue(
        const Ref<Action>& action,
        const Ref<CueShape>& shape,
        const Ref<Bound>& bound,
        bool hops,
        const std::string& stance,
        const Ref<Mood>& mood
    );

    void _keep(const Ref<Cue>& cue);

    /// Return one of a stance's loops, drawn by likelihood; None if it has none.
    Ref<Action> loop(const std::string& stance, const std::string& key);

    /// Change between the loops of a stance in long rests, at the end of a loop.
    void vary_rests(double end);

    void _tell(
        const Ref<MetaAction>& meta,
        const std::string& outcome,
        const std::string& message,
        bool played = false,
        double late = 0.0,
        const std::string& by = ""
    );
};

inline void Performer::note(const Ref<Cue>& cue, const std::string& then) {
    this->cues.push_back(cue);
    this->free = cue->end;
    this->acted = cue->end;
    this->stance = then;
    remembering::remember(cue, this->uses, this->recent, this->ended);
}

inline double Performer::ready() {
    return this->free + (!this->ended.empty() ? this->project->settings->rest : 0.0);
}

inline bool Performer::begin(const std::string& stance) {
    Ref<Action> loop = this->loop(stance, lang::text("rest/", this->graph->layer));
    if (loop == nullptr) {
        return false;
    }
    this->rests.push_back(lang::made<Rest>(stance, loop, 0.0, 0.0, 0.0));
    return true;
}

inline void Performer::perform(const List<Ref<MetaAction>>& metas, double end) {
    List<Ref<MetaAction>> performed;
    for (const auto& m : metas) {
        if (!m->written || this->_performs(m, m->start)) {
            performed.push_back(m);
        }
    }
    for (const auto& bound : bounds::bounds(performed)) {
        Ref<MetaAction> meta = bound->meta;
        if (bounds::begins(meta) >= end) {
            continue;
        }
        if (lang::len(this->served) > 0 && lang::contains(this->served, meta->key())) {
            continue;
        }
        if (meta->request->late.has_value()) {
            this->_realise(bound, std::max(this->ready(), bounds::begins(meta)));
            continue;
        }
        double ready = this->ready();
        if (meta->start < ready && !lang::contains(this->begun, meta->key())) {
            std::string running = "the running action";
            if (lang::len(this->cues) > 0) {
                running = lang::text("'", lang::at(this->cues, -1)->action->name, "'");
            }
            double waits = ready - meta->start;
            if (meta->end <= ready + cue_shapes::FITS) {
                waits = ready - meta->request->start;
                // What is wanted for a certain time is over; what is wanted once may come late.
                bool wanted = meta->written || meta->request->duration.has_value();
                if (wanted || waits > this->project->settings->wait) {
                    std::string why = lang::text(
                        "wholly covered by ",
                        running,
                        ", which plays until ",
                        lang::fixed(this->free, 2),
                        " s"
                    );
                    this->_tell(meta, "covered", why);
                    continue;
                }
            }
            // What a model wrote is wanted at no certain time.
            if (!meta->written && waits > sampling::ON_TIME) {
                this->_tell(meta, "queued", lang::text("waits ", lang::fixed(waits, 2), " s for ", running), true);
            }
        }
        this->_realise(bound, std::max(ready, meta->start));
    }
}

inline void Performer::_realise(const Ref<Bound>& bound, double now) {
    Ref<MetaAction> meta = bound->meta;
    double limit = bound->limit;
    if (meta->written && !lang::contains(this->begun, meta->key()) && !this->_may_begin(meta, now)) {
        return;
    }
    std::optional<List<Ref<SamplingStep>>> steps = this->_steps(meta, now);
    if (!steps.has_value()) {
        return;
    }
    List<Ref<Cue>> cues;
    std::string stance = this->stance;
    for (const auto& step : *steps) {
        bool hops = step->hop != "";
        Ref<MetaRequest> asked = hops ? nullptr : cue_shapes::remaining(meta, now);
        Ref<Mood> mood = this->_mood(asked, now);
        List<Ref<Action>> fitting = step->candidates;
        if (limit < INFINITY) { // else all fit
            List<Ref<Action>> found;
            for (const auto& a : step->candidates) {
                if (cue_shapes::fits_before(this->_shape(a, asked, now, mood), limit)) {
                    found.push_back(a);
                }
            }
            fitting = found;
        }
        if (lang::len(fitting) == 0) {
            std::string before = meta->written ? std::string("") : std::string(" before something more important");
            this->_tell(
                meta,
                "no-room",
                lang::text("nothing fits into the ", lang::fixed(std::max(0.0, limit - now), 2), " s", before)
            );
            return;
        }
        if (!hops && !meta->request->action.has_value()) {
            List<Ref<Action>> warm;
            for (const auto& a : fitting) {
                if (a->cooldown <= 0
                    || this->_cooled(a) <= this->_shape(a, asked, now, mood)->start + cue_shapes::FITS) {
                    warm.push_back(a);
                }
            }
            if (lang::len(warm) == 0) {
                List<double> found2;
                for (const auto& a : fitting) {
                    found2.push_back(this->_cooled(a));
                }
                double soonest = lang::min_of(found2);
                this->_tell(
                    meta,
                    "cooling",
                    lang::text(
                        "all that fit are cooling down; the first may play again at ",
                        lang::fixed(soonest, 2),
                        " s"
                    )
                );
                return;
            }
            fitting = warm;
        }
        // On the way to a stance it counts when that begins.
        if (meta->request->late.has_value()
            && (!hops || (lang::len(cues) == 0 && lang::at(*steps, lang::len(*steps) - 1)->hop != ""))) {
            fitting = this->_timely(bound, fitting, now);
            if (lang::len(fitting) == 0) {
                return;
            }
        }
        Ref<Action> action = this->_draw(
            fitting,
            hops ? lang::text(meta->key(), "/", step->hop) : meta->key(),
            now,
            mood
        );
        Ref<CueShape> shape = this->_shape(action, asked, now, mood);
        Ref<Cue> cue = this->_cue(action, shape, bound, hops, stance, mood);
        cues.push_back(cue);
        now = cue->end;
        stance = cue->then;
    }
    for (const auto& one : cues) {
        this->_keep(one);
    }
}

inline bool Performer::_performs(const Ref<MetaAction>& meta, double now) {
    if (!mood::stirs(mood::mood_at(this->moods, now), this->seed, meta->request->id)) {
        return false;
    }
    if (meta->request->kind == "transition" && this->track->stays_at(this->graph->layer, now)) {
        return false;
    }
    if (this->model == nullptr || this->_muses(now) || this->_has_mused(now)) {
        return true;
    }
    return markov::performs(this->model, this->seed, meta, wanted::mode_at(this->track, now));
}

inline bool Performer::_may_begin(const Ref<MetaAction>& meta, double now) {
    if (this->track->hushed_at(now) || !this->_performs(meta, now)) {
        return false;
    }
    if (this->model == nullptr || this->_leads(now) != "") {
        return true;
    }
    if (this->_lulls(now)) {
        return false;
    }
    bool there = this->stance == director::musing(this->graph->stances);
    if (there && meta->request->kind == "transition" && this->_muses(now)) {
        return false;
    }
    return markov::performs(this->model, this->seed, meta, wanted::mode_at(this->track, now));
}

inline bool Performer::_lulls(double now) {
    double variety = this->project->settings->variety;
    if (this->graph->layer != "arms" || variety <= 0 || lang::len(this->cues) == 0 || this->_has_mused(now)) {
        return false;
    }
    Ref<Cue> last = lang::at(this->cues, -1);
    std::string mode = wanted::mode_at(this->track, now);
    if (now >= last->end + director::MOST_LULL || mode == "thinking") {
        return false;
    }
    bool talks = mode == "talking";
    if (talks && last->action->kind == "transition") { // it opens a burst
        return false;
    }
    return now < last->end + director::find_lull(this->seed, last->meta, talks, variety);
}

inline bool Performer::_muses(double now) {
    if (wanted::mode_at(this->track, now) != "thinking"
        || wanted::mode_at(this->track, now + director::MUSES) != "thinking") {
        return false;
    }
    if (this->graph->layer != "arms" || this->project->settings->variety <= 0) {
        return false;
    }
    return !this->track->stays_at("arms", now) && director::musing(this->graph->stances) != "";
}

inline bool Performer::_has_mused(double now) {
    if (this->graph->layer != "arms" || wanted::mode_at(this->track, now) == "thinking") {
        return false;
    }
    return this->project->settings->variety > 0 && wanted::mode_at(this->track, now - director::MUSED) == "thinking";
}

inline std::string Performer::_leads(double now) {
    if (this->graph->layer != "arms" || this->project->settings->variety <= 0) {
        return "";
    }
    std::string muses = director::musing(this->graph->stances);
    if (muses == "" || this->track->stays_at("arms", now)) {
        return "";
    }
    std::optional<std::string> home = this->graph->start;
    std::string goal = "";
    if (this->_muses(now)) {
        goal = muses;
    } else if (this->stance == muses && home.has_value() && wanted::mode_at(this->track, now) != "thinking") {
        double came = this->_moved();
        if (came >= 0 && wanted::mode_at(this->track, came) == "thinking") {
            goal = *home;
        }
    }
    if (goal == this->stance || goal == "" || lang::len(this->_chain(goal)) == 0) {
        return "";
    }
    return goal;
}

inline List<Ref<Action>> Performer::_timely(const Ref<Bound>& bound, const List<Ref<Action>>& fitting, double now) {
    Ref<MetaAction> meta = bound->meta;
    Ref<MetaRequest> request = meta->request;
    double allowed = cue_shapes::slack_of(request);
    Ref<Mood> mood = this->_mood(request, now);
    Map<std::string, double> late;
    for (const auto& a : fitting) {
        late[a->id] = cue_shapes::lateness(this->project, a, request, this->_shape(a, request, now, mood));
    }
    List<double> found;
    for (const auto& a : fitting) {
        found.push_back(late.at(a->id));
    }
    double least = lang::min_of(found);
    std::string waits{};
    if (least > allowed + cue_shapes::FITS) {
        waits = this->_cause(request, now);
        this->_tell(
            meta,
            "too-late",
            lang::text(
                "would come ",
                lang::fixed(least, 2),
                " s late, ",
                lang::fixed(allowed, 2),
                " s are allowed; it waits for ",
                waits
            ),
            false,
            least
        );
        return List<Ref<Action>>{};
    }
    if (least > cue_shapes::FITS) {
        waits = this->_cause(request, now);
        this->_tell(
            meta,
            "late",
            lang::text("comes ", lang::fixed(least, 2), " s late; it waits for ", waits),
            true,
            least
        );
    }
    List<Ref<Action>> timely;
    for (const auto& a : fitting) {
        if (late.at(a->id) <= std::max(least, 0.0) + cue_shapes::FITS) {
            timely.push_back(a);
        }
    }
    for (const auto& other : bound->after) {
        if (!cue_shapes::may_share(request, other->request)) {
            continue;
        }
        List<Ref<Action>> both;
        for (const auto& a : timely) {
            if (cue_shapes::meets(a, other->request)) {
                both.push_back(a);
            }
        }
        double behind = 0.0;
        if (request->stroke.has_value() && other->request->stroke.has_value()) {
            behind = std::max(0.0, *request->stroke + std::max(least, 0.0) - *other->request->stroke);
        }
        if (lang::len(both) > 0
            && other->request->late.has_value()
            && behind <= *other->request->late + cue_shapes::FITS) {
            timely = both;
            this->served.insert(other->key());
            std::string message = lang::text("shares the stroke of '", request->id, "'");
            this->_tell(other, "shared", message, true, behind, meta->key());
        }
    }
    List<Ref<MetaAction>> following;
    for (const auto& other2 : bound->after) {
        if (!lang::contains(this->served, other2->key())) {
            following.push_back(other2);
        }
    }
    for (const auto& other : following) {
        for (const auto& slack : List<double>{0.0, cue_shapes::slack_of(other->request)}) {
            double by = this->_latest(other->request) + slack;
            List<Ref<Action>> over;
            for (const auto& a : timely) {
                if (this->_over(a, request, now) <= by) {
                    over.push_back(a);
                }
            }
            if (lang::len(over) > 0) {
                return over;
            }
        }
    }
    return timely;
}

inline std::string Performer::_cause(const Ref<MetaRequest>& request, double now) {
    if (now <= request->start + cue_shapes::FITS) {
        return "its own preparation";
    }
    if (lang::len(this->cues) > 0
        && this->ready() >= now - cue_shapes::FITS
        && lang::at(this->cues, -1)->end >= this->free - cue_shapes::FITS) {
        return lang::text(
            "'",
            lang::at(this->cues, -1)->action->name,
            "', which plays until ",
            lang::fixed(this->free, 2),
            " s"
        );
    }
    return lang::len(this->cues) > 0 ? std::string("what comes before it") : std::string("the time it became known at");
}

inline double Performer::_latest(const Ref<MetaRequest>& request) {
    if (!request->stroke.has_value()) {
        return request->start;
    }
    double least = INFINITY;
    for (const auto& action : this->graph->of(this->stance, request->kind)) {
        bool fits = cue_shapes::meets(action, request);
        if (request->action.has_value()) {
            fits = action->id == *request->action;
        }
        if (fits && this->_usable(action)) {
            Ref<Phases> found = phases::find_phases(this->project, action);
            double lead = found->stroke - found->skip(action->timing->blend_in);
            double speed = this->_tempo(action, this->_mood(request, *request->stroke));
            least = std::min(least, lead + mood::drag(lead, speed));
        }
    }
    return *request->stroke - least;
}

inline double Performer::_over(const Ref<Action>& action, const Ref<MetaRequest>& request, double now) {
    Ref<CueShape> shape = this->_shape(action, request, now, this->_mood(request, now));
    return shape->start + cue_shapes::hurried(this->project, action, shape) + this->project->settings->rest
        - cue_shapes::FITS;
}

inline double Performer::_until(const Ref<Action>& action, const Ref<CueShape>& shape, const Ref<Bound>& bound) {
    if (lang::len(bound->after) == 0) {
        return INFINITY;
    }
    double rest = this->project->settings->rest;
    double soonest = shape->start + cue_shapes::hurried(this->project, action, shape);
    for (const auto& other : bound->after) {
        double in_time = this->_latest(other->request) + cue_shapes::slack_of(other->request);
        if (!lang::contains(this->served, other->key()) && soonest + rest <= in_time + cue_shapes::FITS) {
            return std::max(soonest, bounds::begins(other) - rest);
        }
    }
    return INFINITY;
}

inline void Performer::make_way(
    const Ref<MetaAction>& running,
    const List<Ref<MetaAction>>& asked,
    double now,
    bool stopped
) {
    if (stopped) {
        this->retract(now);
        return;
    }
    Ref<Cue> cue = lang::at(this->cues, -1);
    if (running == nullptr || cue->action->kind == "transition" || cue->end - cue->blend_out <= now) {
        return;
    }
    double at_once = now + std::max(cue->blend_out, cue_shapes::RETRACTION);
    double retracts = at_once;
    if (!running->written) {
        double once = cue->end - cue->start;
        if (cue->repeats()) {
            once = std::min(
                once,
                (cue->cycle_to - cue->entry) / cue->tempo + std::max(cue->blend_out, cue_shapes::RETRACTION)
            );
        }
        Ref<CueShape> shape = lang::made<CueShape>(
            cue->start,
            cue->entry,
            cue->end - cue->start,
            once,
            cue->hold_from,
            cue->hold_to,
            cue->hold,
            cue->tempo
        );
        retracts = std::max(at_once, cue->start + cue_shapes::hurried(this->project, cue->action, shape));
    }
    double rest = this->project->settings->rest;
    for (const auto& meta : asked) {
        Ref<MetaRequest> request = meta->request;
        double in_time = this->_latest(request) + cue_shapes::slack_of(request);
        double soonest = meta->rank() > running->rank() ? at_once : retracts;
        if (!request->late.has_value()
            || meta->rank() < running->rank()
            || in_time < soonest + rest - cue_shapes::FITS) {
            continue;
        }
        double end = std::max(soonest, bounds::begins(meta) - rest);
        if (end < cue->end) {
            double out = std::max(cue->blend_out, cue_shapes::RETRACTION);
            double into = std::min(cue->blend_in, std::max(0.0, end - out - cue->start));
            lang::at(this->cues, -1) = lang::made<Cue>(
                cue->action,
                cue->start,
                end,
                cue->entry,
                into,
                out,
                cue->stance,
                cue->then,
                cue->meta,
                cue->hold_from,
                cue->hold_to,
                cue->hold,
                cue->extent,
                cue->tempo,
                cue->cycle_from,
                cue->cycle_to
            );
            this->free = end;
            this->ended[cue->action->id] = end;
        }
        return;
    }
}

inline void Performer::retract(double now) {
    Ref<Cue> cue = lang::at(this->cues, -1);
    double end = now + cue_shapes::STOPPED;
    if (cue->action->kind == "transition" || cue->end - cue->blend_out <= now || cue->end <= end) {
        return;
    }
    lang::at(this->cues, -1) = lang::made<Cue>(
        cue->action,
        cue->start,
        end,
        cue->entry,
        cue->blend_in,
        cue_shapes::STOPPED,
        cue->stance,
        cue->then,
        cue->meta,
        cue->hold_from,
        cue->hold_to,
        cue->hold,
        cue->extent,
        cue->tempo,
        cue->cycle_from,
        cue->cycle_to
    );
    this->free = end;
    this->ended[cue->action->id] = end;
}

inline double Performer::_cooled(const Ref<Action>& action) {
    if (action->cooldown > 0 && lang::contains(this->ended, action->id)) {
        return this->ended.at(action->id) + action->cooldown;
    }
    return -INFINITY;
}

inline std::optional<List<Ref<SamplingStep>>> Performer::_steps(const Ref<MetaAction>& meta, double now) {
    Ref<MetaRequest> request = meta->request;
    Ref<MetaGraph> graph = this->graph;
    if (request->action.has_value()) {
        Ref<Action> action = lang::get(graph->actions, *request->action);
        if (action == nullptr || !lang::contains(graph->stances, action->stance)) {
            this->_tell(
                meta,
                "unknown-action",
                lang::text("there is no action '", *request->action, "' in the ", graph->layer, " layer")
            );
            return std::nullopt;
        }
        if (action->kind == "stance") {
            return this->_way(meta, action->stance);
        }
        if (!this->_arrives(action)) {
            this->_tell(meta, "no-stance", lang::text("'", action->name, "' ends in a stance that has no loop"));
            return std::nullopt;
        }
        if (action->stance == this->stance) {
            return List<Ref<SamplingStep>>{lang::made<SamplingStep>(List<Ref<Action>>{action})};
        }
        std::optional<List<Ref<SamplingStep>>> way = this->_way(meta, action->stance);
        return !way.has_value()
            ? std::nullopt
            : std::optional<List<Ref<SamplingStep>>>(lang::together(
                *way,
                List<Ref<SamplingStep>>{lang::made<SamplingStep>(List<Ref<Action>>{action})}
            ));
    }
    if (request->stance.has_value() && lang::contains(List<std::string>{"transition", "stance"}, request->kind)) {
        if (!lang::contains(graph->stances, *request->stance)) {
            this->_tell(
                meta,
                "no-stance",
                lang::text("there is no stance '", *request->stance, "' in the ", graph->layer, " layer")
            );
            return std::nullopt;
        }
        return this->_way(meta, *request->stance);
    }
    std::string leads = meta->written ? this->_leads(now) : std::string("");
    if (leads != "") {
        return this->_way(meta, leads);
    }
    std::string here = remembering::node(this->stance, request->kind);
    if (!lang::contains(this->candidates, here)) {
        List<Ref<Action>> found2;
        for (const auto& a : graph->of(this->stance, request->kind)) {
            if (this->_usable(a)) {
                found2.push_back(a);
            }
        }
        this->candidates[here] = found2;
    }
    List<Ref<Action>> every = this->candidates.at(here);
    if (lang::len(request->among) > 0) {
        List<Ref<Action>> found3;
        for (const auto& a : every) {
            if (lang::contains(request->among, a->id)) {
                found3.push_back(a);
            }
        }
        every = found3;
    }
    List<Ref<Action>> found = every;
    if (lang::len(request->tags) > 0) {
        List<Ref<Action>> found4;
        for (const auto& a : every) {
            bool are_all = true;
            for (const auto& tag : request->tags) {
                if (!lang::contains(a->tags, tag)) {
                    are_all = false;
                    break;
                }
            }
            if (are_all) {
                found4.push_back(a);
            }
        }
        found = found4;
    }
    List<Ref<Action>> exact = found;
    if (request->limb.has_value()) {
        List<Ref<Action>> found5;
        for (const auto& a : found) {
            if (a->limb == *request->limb) {
                found5.push_back(a);
            }
        }
        exact = found5;
    }
    bool directed = meta->written && this->project->settings->variety > 0;
    if (directed) { // the model's limb and tags are wishes, not orders
        every = this->_fresh(meta, every, now);
        Set<std::string> fresh;
        for (const auto& a : every) {
            fresh.insert(a->id);
        }
        List<Ref<Action>> found6;
        for (const auto& a : found) {
            if (lang::contains(fresh, a->id)) {
                found6.push_back(a);
            }
        }
        found = found6;
        List<Ref<Action>> found7;
        for (const auto& a : exact) {
            if (lang::contains(fresh, a->id)) {
                found7.push_back(a);
            }
        }
        exact = found7;
        if (lang::len(every) == 0) {
            List<Ref<Action>> moves = this->_moves_on(meta, now);
            return lang::len(moves) > 0
                ? std::optional<List<Ref<SamplingStep>>>(List<Ref<SamplingStep>>{lang::made<SamplingStep>(moves)})
                : std::nullopt;
        }
        if (lang::len(exact) == 0) {
            exact = lang::len(found) > 0 ? found : every;
        }
    } else if (meta->written) { // nor worth playing the same again
        List<std::string> again = lang::part(lang::get_or(this->recent, here, List<std::string>{}), -1);
        bool is_any = false;
        for (const auto& a : exact) {
            if (!lang::contains(again, a->id)) {
                is_any = true;
                break;
            }
        }
        if (!is_any) {
            bool is_any2 = false;
            for (const auto& a : found) {
                if (!lang::contains(again, a->id)) {
                    is_any2 = true;
                    break;
                }
            }
            exact = is_any2 ? found : every;
        }
    }
    exact = this->_modest(meta, exact, now);
    if (lang::len(exact) == 0) {
        std::string name = graph->stances.at(this->stance)->name;
        std::string asked = lang::joined(lang::together(request->tags, List<std::string>{request->kind}), " ");
        if (request->limb.has_value()) {
            asked = lang::text(*request->limb, " ", asked);
        }
        if (lang::len(found) > 0) { // whose limb is a wish, too
            this->_tell(
                meta,
                "other-limb",
                lang::text("stance '", name, "' has no ", asked, "; another will do"),
                true
            );
            return List<Ref<SamplingStep>>{lang::made<SamplingStep>(found)};
        }
        std::string hint = meta->written ? std::string("") : this->_elsewhere(request);
        this->_tell(meta, "no-candidate", lang::text("stance '", name, "' has no ", asked, hint));
        return std::nullopt;
    }
    return List<Ref<SamplingStep>>{lang::made<SamplingStep>(exact)};
}

inline std::string Performer::_elsewhere(const Ref<MetaRequest>& request) {
    for (const auto& action : lang::values(this->graph->actions)) {
        bool holds = action->kind == request->kind;
        if (holds) {
            bool are_all = true;
            for (const auto& tag : request->tags) {
                if (!lang::contains(action->tags, tag)) {
                    are_all = false;
                    break;
                }
            }
            holds = are_all;
        }
        if (holds) {
            holds = !request->limb.has_value() || *request->limb == action->limb;
        }
        bool fits = holds;
        if (fits && lang::contains(this->graph->stances, action->stance)) {
            return lang::text("; there is one in '", this->graph->stances.at(action->stance)->name, "'");
        }
    }
    return "";
}

inline std::optional<List<Ref<SamplingStep>>> Performer::_way(const Ref<MetaAction>& meta, const std::string& goal) {
    if (goal == this->stance) {
        std::string name = this->graph->stances.at(goal)->name;
        this->_tell(meta, "already-there", lang::text("the layer is in '", name, "' already"), true);
        return std::nullopt;
    }
    List<std::string> stances = this->_chain(goal);
    if (lang::len(stances) == 0) {
        std::string a = this->graph->stances.at(this->stance)->name;
        std::string b = this->graph->stances.at(goal)->name;
        this->_tell(meta, "no-way", lang::text("no chain of transitions leads from '", a, "' to '", b, "'"));
        return std::nullopt;
    }
    List<Ref<SamplingStep>> steps;
    std::string at = this->stance;
    for (const auto& following : stances) {
        List<Ref<Action>> hops;
        for (const auto& a2 : this->graph->of(at, "transition")) {
            if (a2->end_stance == following && this->_usable(a2)) {
                hops.push_back(a2);
            }
        }
        steps.push_back(lang::made<SamplingStep>(hops, following));
        at = following;
    }
    return steps;
}

inline List<std::string> Performer::_chain(const std::string& goal) {
    Map<std::string, std::string> before = Map<std::string, std::string>{{this->stance, ""}};
    List<std::string> queue = List<std::string>{this->stance};
    int at = 0; // what is before it was looked at
    while (at < lang::len(queue) && !lang::contains(before, goal)) {
        std::string stance = lang::at(queue, at);
        at += 1;
        for (const auto& action : this->graph->of(stance, "transition")) {
            std::optional<std::string> end = action->end_stance;
            if (!end.has_value() || lang::contains(before, *end) || !lang::contains(this->graph->stances, *end)) {
                continue;
            }
            if (this->_usable(action)) {
                before[*end] = stance;
                queue.push_back(*end);
            }
        }
    }
    List<std::string> way;
    if (!lang::contains(before, goal)) {
        return way;
    }
    std::string step = goal;
    while (step != this->stance) {
        way.push_back(step);
        step = before.at(step);
    }
    return lang::backwards(way);
}

inline bool Performer::_arrives(const Ref<Action>& action) {
    std::optional<std::string> end = action->end_stance;
    if (action->kind != "transition") {
        return true;
    }
    return end.has_value()
        && lang::contains(this->graph->stances, *end)
        && lang::len(this->graph->of(*end, "stance")) > 0;
}

inline bool Performer::_usable(const Ref<Action>& action) {
    return action->likelihood > 0 && this->_arrives(action);
}

inline Ref<CueShape> Performer::_shape(
    const Ref<Action>& action,
    const Ref<MetaRequest>& request,
    double now,
    const Ref<Mood>& mood
) {
    return cue_shapes::shape_of(this->project, action, request, now, this->_tempo(action, mood));
}

inline Ref<Mood> Performer::_mood(const Ref<MetaRequest>& request, double at) {
    if (request == nullptr) {
        return mood::mood_at(this->moods, at);
    }
    Ref<Mood> mood = mood::mood_at(this->moods, !request->stroke.has_value() ? at : *request->stroke);
    if (!request->valence.has_value() && !request->arousal.has_value() && !request->intensity.has_value()) {
        return mood;
    }
    return mood::changed(mood, request->valence, request->arousal, request->intensity);
}

inline double Performer::_tempo(const Ref<Action>& action, const Ref<Mood>& mood) {
    return (mood->neutral() || mood::made_for(mood, action->tags)) ? 1.0 : mood::tempo(mood);
}

inline double Performer::_extent(const Ref<Action>& action, const Ref<Mood>& mood) {
    if (this->graph->layer == "body" || action->kind == "transition" || mood->neutral()) {
        return 1.0;
    }
    return (lang::len(action->contacts) > 0
            || lang::contains(action->tags, mood::HELD)
            || mood::made_for(mood, action->tags))
        ? 1.0
        : mood::extent(mood);
}

inline Ref<Action> Performer::_draw(
    const List<Ref<Action>>& candidates,
    const std::string& key,
    double now,
    const Ref<Mood>& mood
) {
    List<Ref<Action>> left = this->_spaced(candidates);
    if (lang::len(left) == 1) {
        return lang::at(left, 0);
    }
    bool neutral = mood->neutral();
    Map<std::string, double> weights;
    for (const auto& a : left) {
        double favoured = neutral ? 1.0 : mood::favour(mood, a->tags, vigour::measure_vigour(this->project, a));
        double weight = a->likelihood / std::max(this->_count(a->id, now), 1.0) * favoured;
        weights[a->id] = weight * this->_variety(a, now);
    }
    bool is_any = false;
    for (const auto& w : lang::values(weights)) {
        if (w > 0) {
            is_any = true;
            break;
        }
    }
    if (!is_any) {
        return lang::at(left, 0);
    }
    std::string chosen = choice::pick(this->seed, key, "action", weights);
    Ref<Action> first;
    for (const auto& a2 : left) {
        if (a2->id == chosen) {
            first = a2;
            break;
        }
    }
    return first;
}

inline double Performer::_variety(const Ref<Action>& action, double now) {
    double variety = this->project->settings->variety;
    if (variety <= 0) {
        return 1.0;
    }
    if (action->kind == "transition") {
        bool talks = this->graph->layer == "arms" && wanted::mode_at(this->track, now) == "talking";
        return talks ? 1.0 + this->_count_fresh(action->end_stance, now) : 1.0;
    }
    if (!lang::contains(this->ended, action->id)) {
        return 1.0;
    }
    double shows = this->_shows(action);
    double needed = director::repeat_interval(action->kind, shows, this->beats) * variety;
    return director::freshness(now - this->ended.at(action->id), needed);
}

inline double Performer::_shows(const Ref<Action>& action) {
    if (!lang::contains(this->prominences, action->id)) {
        this->prominences[action->id] = prominence::measure_prominence(this->project, action);
    }
    return this->prominences.at(action->id);
}

inline List<Ref<Action>> Performer::_fresh(
    const Ref<MetaAction>& meta,
    const List<Ref<Action>>& candidates,
    double now
) {
    double variety = this->project->settings->variety;
    std::string layer = this->graph->layer;
    if (meta->request->kind == "transition") {
        if (now < this->_moved() + director::posture(layer) * variety) {
            return List<Ref<Action>>{};
        }
        if (layer == "arms" && now < this->acted + director::LEAST_LULL * variety) {
            return List<Ref<Action>>{};
        }
        if (layer != "head") {
            return candidates;
        }
        if (this->stance == this->graph->start) {
            bool leaves = choice::uniform(this->seed, List<std::string>{meta->key(), "leaves"}) < director::LEAVES_HOME;
            return leaves ? candidates : List<Ref<Action>>{};
        }
        List<Ref<Action>> home;
        for (const auto& a : candidates) {
            if (a->end_stance == this->graph->start) {
                home.push_back(a);
            }
        }
        bool returns = lang::len(home) > 0
            && choice::uniform(this->seed, List<std::string>{meta->key(), "home"}) < director::GOES_HOME;
        return returns ? home : candidates;
    }
    double share = now < this->acted + director::LONG_REST * variety ? variety : variety * director::SHORTER;
    bool reminded = this->_shown(now - director::APART * variety);
    bool converses = meta->request->kind == "fidget" && wanted::mode_at(this->track, now) != "idle";
    List<Ref<Action>> out;
    for (const auto& action : candidates) {
        double shows = this->_shows(action);
        if ((reminded || converses) && shows >= director::STANDS_OUT) {
            continue;
        }
        double needed = director::repeat_interval(action->kind, shows, this->beats) * share;
        if (!lang::contains(this->ended, action->id) || now >= this->ended.at(action->id) + needed) {
            out.push_back(action);
        }
    }
    return out;
}

inline List<Ref<Action>> Performer::_modest(
    const Ref<MetaAction>& meta,
    const List<Ref<Action>>& candidates,
    double now
) {
    Ref<MetaRequest> request = meta->request;
    List<Ref<Action>> every = candidates;
    if (request->kind != "fidget" || lang::len(request->tags) > 0 || this->project->settings->variety <= 0) {
        return every;
    }
    if (meta->written || wanted::mode_at(this->track, now) == "idle") {
        return every;
    }
    List<Ref<Action>> left;
    for (const auto& a : every) {
        if (this->_shows(a) < director::STANDS_OUT) {
            left.push_back(a);
        }
    }
    return lang::len(left) > 0 ? left : every;
}

inline List<Ref<Action>> Performer::_moves_on(const Ref<MetaAction>& meta, double now) {
    List<Ref<Action>> out;
    if (this->graph->layer != "arms" || meta->request->kind != "gesture" || this->track->stays_at("arms", now)) {
        return out;
    }
    double variety = this->project->settings->variety;
    if (now < this->_moved() + director::posture("arms") * variety
        || now < this->acted + director::LEAST_LULL * variety) {
        return out;
    }
    for (const auto& action : this->graph->of(this->stance, "transition")) {
        if (this->_usable(action) && this->_count_fresh(action->end_stance, now) > 0) {
            out.push_back(action);
        }
    }
    return out;
}

inline int Performer::_count_fresh(const std::optional<std::string>& stance, double now) {
    if (!stance.has_value()) {
        return 0;
    }
    double variety = this->project->settings->variety;
    int count = lang::len(this->graph->of(*stance, "gesture"));
    for (const auto& [ident, end] : this->ended) {
        Ref<Action> action = lang::get(this->graph->actions, ident);
        if (action == nullptr || action->kind != "gesture" || action->stance != *stance) {
            continue;
        }
        double shows = this->_shows(action);
        if (now < end + director::repeat_interval("gesture", shows, this->beats) * variety) {
            count -= 1;
        }
    }
    return count;
}

inline double Performer::_moved() {
    double latest = -INFINITY;
    for (const auto& [ident, end] : this->ended) {
        Ref<Action> action = lang::get(this->graph->actions, ident);
        if (action != nullptr && action->kind == "transition") {
            latest = std::max(latest, end);
        }
    }
    return latest;
}

inline bool Performer::_shown(double since) {
    for (const auto& [ident, end] : this->ended) {
        Ref<Action> action = lang::get(this->graph->actions, ident);
        if (action == nullptr || action->kind == "transition" || end < since) {
            continue;
        }
        if (this->_shows(action) >= director::STANDS_OUT) {
            return true;
        }
    }
    return false;
}

inline List<Ref<Action>> Performer::_spaced(const List<Ref<Action>>& candidates) {
    int default_ = this->project->settings->never_twice ? 1 : 0;
    Ref<Action> first = lang::at(candidates, 0);
    List<std::string> before = lang::get_or(this->recent, remembering::node(first->stance, first->kind), List<std::string>{});
    if (lang::len(candidates) < 2 || lang::len(before) == 0) {
        return candidates;
    }
    Map<std::string, int> needs;
    for (const auto& a : candidates) {
        needs[a->id] = !a->spacing.has_value() ? default_ : *a->spacing;
    }
    List<int> found;
    for (const auto& a : candidates) {
        found.push_back(needs.at(a->id));
    }
    for (int less = 0; less < lang::max_of(found) + 1; less++) {
        List<Ref<Action>> left;
        for (const auto& a : candidates) {
            if (remembering::rested(before, a->id, needs.at(a->id) - less)) {
                left.push_back(a);
            }
        }
        if (lang::len(left) > 0) {
            return left;
        }
    }
    return candidates;
}

inline double Performer::_count(const std::string& ident, double now) {
    double memory = this->project->settings->memory;
    double alpha = this->project->settings->alpha;
    if (memory <= 0) {
        return alpha * lang::get_or(this->uses, ident, 0);
    }
    int used = 0;
    for (const auto& cue : lang::backwards(this->cues)) {
        if (cue->start < now - memory) {
            break;
        }
        if (cue->action->id == ident) {
            used += 1;
        }
    }
    return alpha * used;
}

inline Ref<Cue> Performer::_cue(
    const Ref<Action>& action,
    const Ref<CueShape>& shape,
    const Ref<Bound>& bound,
    bool hops,
    const std::string& stance,
    const Ref<Mood>& mood
) {
    double length = shape->length;
    double into = std::max(0.0, action->timing->blend_in);
    double out = std::max(0.0, action->timing->blend_out);
    auto [begin, until] = this->project->span(action);
    double cycle = repeating::cycle_of(action->kind, action->timing, begin, until);
    if (action->timing->earliest_exit.has_value() || cycle > 0) {
        double wish = hops ? INFINITY : bound->wish;
        length = std::min(length, std::max(shape->shortest, std::min(bound->limit, wish) - shape->start));
    } else if (!hops) {
        length = std::min(length, this->_until(action, shape, bound) - shape->start);
        if (length < shape->length) {
            out = std::max(out, cue_shapes::RETRACTION);
        }
    }
    if (shape->entry > begin) {
        into = std::max(into, phase_times::LEAST_BLEND);
    }
    double squeeze = into + out > 0 ? std::min(1.0, length / (into + out)) : 1.0;
    std::string then = stance;
    if (action->kind == "transition" && action->end_stance.has_value()) {
        then = *action->end_stance;
    }
    double end = shape->start + length;
    return lang::made<Cue>(
        action,
        shape->start,
        end,
        shape->entry,
        into * squeeze,
        out * squeeze,
        stance,
        then,
        bound->meta->key(),
        shape->hold_from,
        shape->hold_to,
        shape->hold,
        this->_extent(action, mood),
        shape->tempo,
        cycle > 0 ? begin : 0.0,
        cycle > 0 ? begin + cycle : 0.0
    );
}

inline void Performer::_keep(const Ref<Cue>& cue) {
    this->note(cue, cue->then);
    Ref<Action> loop = this->loop(cue->then, cue->meta);
    if (loop != nullptr) {
        // The loop begins again under the action, so that the action's last pose meets the loop's first.
        // On joints that the action does not move, the change shows. It takes its time there, like a
        // transition.
        bool partial = cue->action->limb != "both"
            || lang::len(cue->action->joints) > 0
            || lang::len(cue->action->joint_weights) > 0;
        double begin = cue->start + cue->blend_in;
        double until = cue->end - cue->blend_out;
        double fade = std::max(0.0, until - begin);
        if (partial) {
            fade = cue->then != cue->stance
                ? cue->end - cue->start
                : std::min(sampling::LOOP_FADE, cue->end - cue->start);
            begin = std::max(cue->start, until - fade);
        }
        this->rests.push_back(lang::made<Rest>(cue->then, loop, until, begin, fade));
    }
}

inline Ref<Action> Performer::loop(const std::string& stance, const std::string& key) {
    List<Ref<Action>> loops = this->graph->of(stance, "stance");
    if (lang::len(loops) == 1) {
        return lang::at(loops, 0);
    }
    Map<std::string, double> weights;
    for (const auto& a : loops) {
        if (a->likelihood > 0) {
            weights[a->id] = a->likelihood;
        }
    }
    if (lang::len(weights) == 0) {
        return lang::len(loops) > 0 ? lang::at(loops, 0) : nullptr;
    }
    std::string chosen = choice::pick(this->seed, key, "loop", weights);
    Ref<Action> first;
    for (const auto& a : loops) {
        if (a->id == chosen) {
            first = a;
            break;
        }
    }
    return first;
}

inline void Performer::vary_rests(double end) {
    List<Ref<Rest>> out;
    for (int place = 0; place < lang::len(this->rests); place++) {
        const auto& rest = lang::at(this->rests, place);
        out.push_back(rest);
        List<Ref<Action>> loops = this->graph->of(rest->stance, "stance");
        if (lang::len(loops) < 2) {
            continue;
        }
        double until = place + 1 < lang::len(this->rests) ? lang::at(this->rests, place + 1)->fade_start : end;
        Ref<Rest> current = rest;
        double change = rest->start;
        while (true) {
            auto [start, stop] = this->project->span(current->action);
            change += std::max(1.0, stop - start - current->action->timing->blend_in);
            if (!(change <= until)) { // nor when it is no number
                break;
            }
            Ref<Action> loop = this->loop(rest->stance, lang::text(this->graph->layer, "/", lang::fixed(change, 3)));
            if (loop != nullptr && loop->id != current->action->id) {
                current = lang::made<Rest>(
                    rest->stance,
                    loop,
                    change,
                    change - sampling::LOOP_FADE,
                    sampling::LOOP_FADE
                );
                out.push_back(current);
            }
        }
    }
    this->rests = out;
}

inline void Performer::_tell(
    const Ref<MetaAction>& meta,
    const std::string& outcome,
    const std::string& message,
    bool played,
    double late,
    const std::string& by
) {
    std::string layer = this->graph->layer;
    this->reports.push_back(lang::made<Report>(
        meta->request->id,
        outcome,
        message,
        layer,
        meta->start,
        played,
        meta->written,
        late,
        by
    ));
}

namespace sampling {

/// Return the performer as it is after a past and the cues that played since.
inline Ref<Performer> performer_after(
    const Ref<Project>& project,
    const Ref<MetaGraph>& graph,
    std::uint32_t seed,
    const std::string& begin,
    const Ref<Past>& past,
    const List<Ref<Cue>>& cues,
    const Ref<Moods>& moods,
    const Ref<Track>& track
) {
    std::string stance = lang::contains(graph->stances, past->stance) ? past->stance : begin;
    Ref<Performer> out = lang::made<Performer>(
        project,
        graph,
        seed,
        stance,
        moods,
        track,
        past->free,
        past->free,
        past->uses,
        past->recent,
        past->ended
    );
    List<Ref<Action>> found;
    for (const auto& a : lang::values(graph->actions)) {
        if (a->kind == "gesture") {
            found.push_back(a);
        }
    }
    out->beats = director::beat_interval(graph->layer, lang::len(found));
    for (const auto& cue : cues) {
        out->note(cue, lang::contains(graph->stances, cue->then) ? cue->then : begin);
    }
    return out;
}

}  // namespace sampling

}  // namespace metagraph
