// Performing what is asked while it comes in: working asks into a running plan, forgetting what is over, and answering.
#pragma once

#include "hearing.hpp"
#include "planner.hpp"
#include "understand.hpp"

namespace metagraph {

/// What becomes of a request: `state` planned, late, refused or done; `at` and `until`, when it plays, none where that is
/// not known or never; `what` plays; `why` not as asked.
struct Answer {
    std::string id, state = "refused";
    std::optional<double> at, until;
    List<std::string> what;
    std::string why;
};

namespace hearing {

inline Answer answer(const std::string& id, const Plan& plan) {
    auto of = [&id](const std::string& made) { return lang::contains(hearing::owners(made), id); };
    Answer out;
    out.id = id;
    List<double> waiting;
    auto plays = [&out, &waiting](double start, double end, const std::string& what) {
        if (utterances::is_paused(start)) {
            waiting.push_back(start);
            return;
        }
        out.at = std::min(out.at.value_or(start), start);
        out.until = std::max(out.until.value_or(end), end);
        out.what.push_back(what);
    };
    List<std::string> served; // keys of those whose action serves this request, too
    for (const auto& report : plan.reports) {
        if (!report->by.empty() && of(report->request)) served.push_back(report->by);
    }
    for (const auto& [_, layer] : plan.layers) {
        for (const auto& cue : layer->cues) {
            if (of(cue->meta.substr(0, cue->meta.find('+')))) plays(cue->start, cue->end, cue->action->name);
            if (lang::contains(served, cue->meta)) plays(cue->start, cue->end, cue->action->name);
        }
        for (const auto& meta : layer->metas) {
            if (meta->start >= plan.end && of(meta->request->id)) waiting.push_back(meta->start);
        }
    }
    for (const auto& x : plan.track->looks) if (of(x->id)) plays(x->start, x->end, "look");
    for (const auto& x : plan.track->speeches) if (of(x->id) && plan.track->last_speech(x->id) == x) plays(x->start, x->end, "speech");
    for (const auto& x : plan.track->modes) if (of(x->id)) plays(x->start, meaning::FOREVER, "mode");
    for (const auto& x : plan.track->places) if (of(x->id)) plays(x->start, meaning::FOREVER, "place");
    for (const auto& x : plan.track->blinks) if (of(x->id)) plays(x->start, x->start, "blink");
    for (const auto& x : plan.track->moods) if (of(x->id)) plays(x->start, x->end, "mood");
    List<std::string> why;
    bool late = false, there = false, all_played = true, told = false;
    for (const auto& report : plan.reports) {
        if (!of(report->request)) continue;
        told = true;
        if (!lang::contains(why, report->message)) why.push_back(report->message);
        late = late || report->outcome == "late" || report->outcome == "queued" || report->outcome == "resumed";
        there = there || report->outcome == "already-there";
        all_played = all_played && report->played;
    }
    out.why = lang::joined(why, "; ");
    if (!out.what.empty()) {
        out.state = late ? "late" : "planned";
    } else if (there) {
        out.state = "done";
    } else if (!waiting.empty() && utterances::is_paused(waiting[0])) {
        out.state = "planned";
        out.why = "it is paused";
    } else if (!waiting.empty() && all_played) {
        out.state = told ? "late" : "planned";
        out.at = waiting[0];
        if (out.why.empty()) out.why = "chosen when its time is nearer";
    } else if (out.why.empty()) {
        out.why = "nothing came of it";
    }
    return out;
}

inline Ref<LayerPlan> since_layer(const LayerPlan& plan, double seconds) {
    auto out = lang::made<LayerPlan>(plan);
    int gone = 0;
    while (gone < lang::len(plan.cues) && lang::at(plan.cues, gone)->end < seconds) gone++;
    out->cues = lang::part(plan.cues, gone);
    if (gone > 0) {
        out->past = lang::made<Past>(*plan.past);
        for (const auto& cue : lang::part(plan.cues, 0, gone)) {
            remembering::remember(cue, out->past->uses, out->past->recent, out->past->ended);
            out->past->free = cue->end;
            out->past->stance = cue->then;
        }
    }
    Set<std::string> played;
    for (const auto& cue : out->cues) played.insert(cue->meta);
    out->metas.clear();
    for (const auto& meta : plan.metas) {
        if (meta->end >= seconds || played.count(meta->key()) > 0) out->metas.push_back(meta);
    }
    int under = 0; // the last rest that has taken over by then
    for (int n = 0; n < lang::len(plan.rests); n++) {
        const Rest& rest = *lang::at(plan.rests, n);
        if (rest.fade_start + rest.fade <= seconds) under = n;
    }
    out->rests = lang::part(plan.rests, under);
    return out;
}

}  // namespace hearing

/// Return the plan with asks worked in that became known at `now`, and the horizon moved to `end`.
///
/// What begins before now + lookahead stays as it was, but at the very beginning, when nothing has been shown; voices
/// begin and stop sooner. Asks need ids; of two with one id the later counts. What cannot be understood is in the plan's reports.
inline Ref<const Plan> hear(
    const Graph& graph, const Plan& plan, double now, const List<Json>& asks, double end, const PlanOptions& options = {}
) {
    const double fixed = now > 0 ? now + graph.project->settings->lookahead : 0;
    const double soon = utterances::find_soon(now, graph.project->settings->lookahead);
    const Ref<Meaning> meaning = understand::understand(graph, asks, fixed, soon);
    const Meaning& meant = *meaning;
    List<std::string> turning;
    for (const std::string& layer : graph::LAYERS) {
        if (!graph.layer(layer).markov->modes.empty()) turning.push_back(layer);
    }
    const Ref<Heard> heard = hearing::heard(plan.requests, plan.track, meaning, now, fixed, soon, turning);
    Set<std::string> leave;
    for (const std::string& layer : graph::LAYERS) {
        // Without any asks everything is planned on; with some, what they have to do with.
        if (!asks.empty() && now > 0 && end == plan.end && heard->touched.count(layer) == 0) leave.insert(layer);
    }
    Plan with = plan;
    with.track = heard->track;
    const Ref<const Plan> after = planner::extend(graph, with, fixed, heard->fresh, end, options, heard->withdrawn, leave, heard->stopped);
    if (meant.refused.empty()) return after;
    auto out = lang::made<Plan>(*after);
    lang::extend(out->reports, meant.refused);
    return out;
}

/// Return a running plan without what ended before `seconds`; what is planned on from it stays as it would have been. Poses
/// before `seconds` are lost.
inline Ref<const Plan> since(const Plan& plan, double seconds) {
    auto out = lang::made<Plan>(plan);
    Set<std::string> known;
    for (const std::string& layer : graph::LAYERS) {
        out->layers[layer] = hearing::since_layer(*plan.layers.at(layer), seconds);
        for (const auto& meta : out->layers.at(layer)->metas) known.insert(meta->request->id);
    }
    out->reports.clear();
    for (const auto& report : plan.reports) {
        if (report->at >= seconds) out->reports.push_back(report);
    }
    out->requests.clear();
    for (const auto& request : plan.requests) {
        if (request->start >= seconds || known.count(request->id) > 0) out->requests.push_back(request);
    }
    out->track = plan.track->since(seconds);
    out->life = plan.life->since(seconds);
    return out;
}

/// Say what a plan does about an ask: when it will play, or why it will not.
inline Answer answer(const Plan& plan, const std::string& id) { return hearing::answer(id, plan); }

}  // namespace metagraph
