// Extend the plan of one layer: the later part of the plan is turned back into its meta actions, merged with new
// requests, placed and performed again (Borer et al., section 6).
//
// Translated from metagraph/playback/planning/layer_planning.py; change that, and translate anew.
#pragma once

#include "model.hpp"
#include "track.hpp"
#include "meta_plan.hpp"
#include "cue_shapes.hpp"
#include "layer_state.hpp"
#include "leaving.hpp"
#include "markov.hpp"
#include "mood.hpp"
#include "replan.hpp"
#include "sampling.hpp"
#include "project.hpp"
#include "language.hpp"

namespace metagraph {

struct LayerDraft;

namespace layer_planning {

inline constexpr double WINDOW = 1.0; // seconds a request may use when it does not say how long
inline Ref<LayerDraft> draft(
    const Ref<Project>& project,
    const Ref<MetaGraph>& graph,
    const Ref<Markov>& chain,
    const Set<std::string>& kinds,
    const Ref<LayerPlan>& old,
    const List<Ref<Report>>& told,
    std::uint32_t seed,
    double now,
    const List<Ref<MetaRequest>>& fresh,
    const Set<std::string>& replaced,
    const Set<std::string>& stopped,
    double end,
    const std::optional<std::string>& stance,
    const Ref<Moods>& moods,
    const Ref<Track>& track
);
inline bool _leaves(
    const Ref<MetaAction>& running,
    const Set<std::string>& stopped,
    const Ref<Track>& track,
    double now
);
inline Set<std::string> _begun(const Ref<LayerPlan>& old, int kept);
inline Ref<MetaRequest> in_time(const Ref<MetaRequest>& request, const Ref<Moods>& moods);
inline Ref<MetaAction> meta_of(const Ref<MetaRequest>& request);
inline std::string _begin(
    const Ref<MetaGraph>& graph,
    const Ref<LayerPlan>& old,
    const std::optional<std::string>& stance
);

}  // namespace layer_planning

/// A layer placed in time, not yet performed.
///
/// able: whether the layer can perform at all. done: meta actions that were performed before. placed: those to perform,
/// in order; those that a model wrote are performed as the mode says. reports: the reports so far.
struct LayerDraft {
    std::string layer;
    Ref<LayerState> state;
    bool able;
    List<Ref<MetaAction>> done;
    List<Ref<MetaAction>> placed;
    List<Ref<Report>> reports;
    Ref<Past> past;
    Ref<Cursor> cursor;
    List<Ref<MetaAction>> written;

    LayerDraft(
        std::string layer_,
        Ref<LayerState> state_,
        bool able_,
        List<Ref<MetaAction>> done_,
        List<Ref<MetaAction>> placed_,
        List<Ref<Report>> reports_,
        Ref<Past> past_,
        Ref<Cursor> cursor_,
        List<Ref<MetaAction>> written_
    )
        : layer(std::move(layer_)),
            state(std::move(state_)),
            able(able_),
            done(std::move(done_)),
            placed(std::move(placed_)),
            reports(std::move(reports_)),
            past(std::move(past_)),
            cursor(std::move(cursor_)),
            written(std::move(written_)) {}

    /// Return the layer's plan with the given meta actions performed; `reports` is then complete.
    Ref<LayerPlan> performed(const List<Ref<MetaAction>>& metas, double end);
};

inline Ref<LayerPlan> LayerDraft::performed(const List<Ref<MetaAction>>& metas, double end) {
    List<Ref<Cue>> cues;
    List<Ref<Rest>> rests;
    if (this->able) {
        sampling::perform_metas(this->state, metas, end);
        sampling::vary_rests(this->state, end);
        cues = this->state->cues;
        rests = this->state->rests;
        lang::extend(this->reports, this->state->reports);
    }
    List<Ref<MetaAction>> every = lang::together(this->done, this->placed);
    return lang::made<LayerPlan>(this->layer, every, cues, rests, this->past, this->cursor, this->written);
}

namespace layer_planning {

/// Return a layer's plan cut at `now`, with the requests placed again.
///
/// chain: the model that writes when there are no requests, or None. kinds: the kinds of actions that the layer has.
/// told: reports of the plan so far. fresh: new requests, of all layers. replaced: ids of requests that are replaced or
/// withdrawn; stopped: those withdrawn, whose running action is left. stance: the stance in which the layer would
/// begin. moods: the mood over time. track: what lasts, such as the mode.
inline Ref<LayerDraft> draft(
    const Ref<Project>& project,
    const Ref<MetaGraph>& graph,
    const Ref<Markov>& chain,
    const Set<std::string>& kinds,
    const Ref<LayerPlan>& old,
    const List<Ref<Report>>& told,
    std::uint32_t seed,
    double now,
    const List<Ref<MetaRequest>>& fresh,
    const Set<std::string>& replaced,
    const Set<std::string>& stopped,
    double end,
    const std::optional<std::string>& stance,
    const Ref<Moods>& moods,
    const Ref<Track>& track
) {
    std::string layer = graph->layer;
    List<Ref<MetaAction>> asked;
    for (const auto& request : fresh) {
        if (request->layer == layer) {
            asked.push_back(layer_planning::meta_of(layer_planning::in_time(request, moods)));
        }
    }
    List<Ref<Cue>> kept;
    for (const auto& cue : old->cues) {
        if (cue->start < now) {
            kept.push_back(cue);
        }
    }
    Set<std::string> played;
    for (const auto& cue : kept) {
        played.insert(cue->meta);
    }
    Set<std::string> waiting;
    for (const auto& cue : lang::part(old->cues, lang::len(kept))) {
        waiting.insert(cue->meta);
    }
    // Who lies ahead may be called as what was played long ago: a request that is asked for again and again.
    Set<std::string> playing;
    for (const auto& cue : kept) {
        if (cue->end > now) {
            playing.insert(cue->meta);
        }
    }
    List<Ref<MetaAction>> written;
    Ref<Cursor> cursor = old->cursor;
    // What another's action has served since it began is played as that is.
    Set<std::string> served;
    for (const auto& report : told) {
        if (report->outcome == "shared" && lang::contains(played, report->by)) {
            served.insert(report->request);
        }
    }
    Set<std::string> again = lang::set_of(replaced);
    if (chain != nullptr) {
        List<Ref<MetaAction>> more{};
        std::tie(more, cursor) = markov::write(chain, seed, end, kinds, old->cursor);
        for (const auto& meta : lang::together(old->written, more)) {
            if (meta->start >= now) {
                written.push_back(meta);
                again.insert(meta->request->id);
            }
        }
    }
    List<Ref<MetaAction>> future;
    Map<std::string, List<double>> planned; // again: when those of a request start
    Set<std::string> judged; // those whose lateness is known once they are performed
    for (const auto& meta : old->metas) {
        if (lang::contains(again, meta->request->id) || lang::contains(served, meta->request->id)) {
            continue;
        }
        if (lang::contains(waiting, meta->key()) || (meta->start >= now && !lang::contains(playing, meta->key()))) {
            future.push_back(meta);
            if (meta->request->late.has_value()) {
                judged.insert(meta->request->id);
            }
            planned[meta->request->id] = lang::together(
                lang::get_or(planned, meta->request->id, List<double>{}),
                List<double>{meta->start}
            );
        }
    }
    // Reports about time still hold; those that are planned again report the rest.
    List<Ref<MetaAction>> done;
    for (const auto& meta2 : old->metas) {
        if (!lang::contains(again, meta2->request->id)
            && !lang::contains(lang::get_or(planned, meta2->request->id, List<double>{}), meta2->start)
            && (lang::contains(playing, meta2->key())
                || meta2->start < now
                || lang::contains(served, meta2->request->id))) {
            done.push_back(meta2);
        }
    }
    List<Ref<Report>> reports;
    for (const auto& report : told) {
        if (report->layer == layer
            && !lang::contains(again, report->request)
            && ((lang::contains(meta_plan::TEMPORAL, report->outcome) && !lang::contains(judged, report->request))
                || !lang::contains(lang::get_or(planned, report->request, List<double>{}), report->at))) {
            reports.push_back(report);
        }
    }
    std::string begin = layer_planning::_begin(graph, old, stance);
    Ref<LayerState> state = sampling::resume_layer(project, graph, seed, begin, old->past, kept, moods, track);
    state->model = chain;
    if (begin == "" || !sampling::begin_layer(state, begin)) {
        std::string why = lang::text("the ", layer, " layer has no stance with a loop to begin in");
        List<Ref<MetaAction>> waits = lang::together(future, asked);
        for (const auto& meta : waits) {
            if (!meta->written) {
                reports.push_back(lang::made<Report>(meta->request->id, "no-stance", why, layer, meta->start));
            }
        }
        return lang::made<LayerDraft>(layer, state, false, done, waits, reports, old->past, cursor, written);
    }
    state->begun = layer_planning::_begun(old, lang::len(kept));
    if (lang::len(kept) > 0 && lang::at(kept, -1)->end > now) {
        Ref<MetaAction> first;
        for (const auto& meta3 : old->metas) {
            if (meta3->key() == lang::at(kept, -1)->meta) {
                first = meta3;
                break;
            }
        }
        Ref<MetaAction> running = first;
        bool leaves = layer_planning::_leaves(running, stopped, track, now);
        leaving::make_way(state, running, asked, now, leaves);
    }
    if (lang::len(old->rests) > 0 && now > 0) {
        Set<double> begun;
        for (const auto& cue : state->cues) {
            begun.insert(cue->end - cue->blend_out);
        }
        List<Ref<Rest>> found;
        for (const auto& rest : old->rests) {
            if (rest->fade_start < now || lang::contains(begun, rest->start)) {
                found.push_back(rest);
            }
        }
        state->rests = found;
    }
    state->free = std::max(now - (state->ready() - state->free), state->free);
    List<Ref<Report>> delayed{};
    std::tie(asked, delayed) = replan::delay(asked, state->ready(), project->settings);
    double busy = -INFINITY; // what runs keeps the time it was wanted for, from the models
    for (const auto& meta : done) {
        if (!meta->written) {
            busy = std::max(busy, meta->end);
        }
    }
    auto [placed, moved] = replan::replan(lang::together(future, written, asked), project->settings, busy);
    List<Ref<Report>> every = lang::together(reports, delayed, moved);
    return lang::made<LayerDraft>(layer, state, true, done, placed, every, old->past, cursor, written);
}

/// Return whether the running action is left: it was stopped, or it is a gesture of the character's own and what it
/// said was broken off.
inline bool _leaves(
    const Ref<MetaAction>& running,
    const Set<std::string>& stopped,
    const Ref<Track>& track,
    double now
) {
    if (running == nullptr) {
        return false;
    }
    bool own = running->written && running->request->kind == "gesture";
    return lang::contains(stopped, running->request->id) || (own && track->hushed_at(now));
}

/// Return the key of the meta action whose chain of transitions plays where the first cues are kept; none if none does.
/// An earlier action may have had the same key, so that only the last cue can be of a chain.
inline Set<std::string> _begun(const Ref<LayerPlan>& old, int kept) {
    Set<std::string> out;
    if (0 < kept && kept < lang::len(old->cues)) {
        Ref<Cue> last = lang::at(old->cues, kept - 1);
        Ref<Cue> following = lang::at(old->cues, kept);
        if (last->meta == following->meta && following->start <= last->end) {
            out.insert(last->meta);
        }
    }
    return out;
}

/// Return a request that may begin earlier, by the extra time that its preparation takes in its mood.
inline Ref<MetaRequest> in_time(const Ref<MetaRequest>& request, const Ref<Moods>& moods) {
    if (!request->stroke.has_value()) {
        return request;
    }
    Ref<Mood> mood = mood::mood_at(moods, *request->stroke);
    double speed = mood::tempo(mood::changed(mood, request->valence, request->arousal, request->intensity));
    if (speed >= 1) {
        return request;
    }
    return lang::made<MetaRequest>(
        request->id,
        request->layer,
        request->kind,
        std::max(0.0, *request->stroke - (*request->stroke - request->start) / speed),
        request->duration,
        request->action,
        request->tags,
        request->limb,
        request->stance,
        request->priority,
        request->resume,
        request->stroke,
        request->hold,
        request->prepare,
        request->among,
        request->late,
        request->valence,
        request->arousal,
        request->intensity
    );
}

/// Return a request as a meta action with the window it may use; if its stroke is judged, with the moment of the
/// stroke.
inline Ref<MetaAction> meta_of(const Ref<MetaRequest>& request) {
    if (request->late.has_value() && request->stroke.has_value()) {
        return lang::made<MetaAction>(request, *request->stroke, *request->stroke + cue_shapes::FITS);
    }
    double length = !request->duration.has_value() ? layer_planning::WINDOW : std::max(0.0, *request->duration);
    if (request->stroke.has_value()) {
        length = std::max(length, *request->stroke - request->start + cue_shapes::FITS);
    }
    return lang::made<MetaAction>(request, request->start, request->start + length);
}

/// Return the stance in which a layer begins: that of the plan before, the given one, the graph's start, or the first
/// that has a loop; "" for none.
inline std::string _begin(
    const Ref<MetaGraph>& graph,
    const Ref<LayerPlan>& old,
    const std::optional<std::string>& stance
) {
    List<std::string> wishes = List<std::string>{old->past->stance};
    if (lang::len(old->rests) > 0) {
        wishes.push_back(lang::at(old->rests, 0)->stance);
    }
    if (stance.has_value()) {
        wishes.push_back(*stance);
    }
    if (graph->start.has_value()) {
        wishes.push_back(*graph->start);
    }
    lang::extend(wishes, lang::keys(graph->stances));
    for (const auto& wish : wishes) {
        if (lang::contains(graph->stances, wish) && lang::len(graph->of(wish, "stance")) > 0) {
            return wish;
        }
    }
    return "";
}

}  // namespace layer_planning

}  // namespace metagraph
