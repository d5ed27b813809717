// Performing what is asked while it comes in: working asks into a running plan, forgetting what is over, and answering.
#pragma once

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

/// Return the asks a request may have been made by: that of its own id, and those of which it would be a part.
inline List<std::string> owners(std::string id) {
    List<std::string> out = {id};
    for (;;) {
        const std::size_t dot = id.rfind('.');
        const bool part = dot != std::string::npos && dot + 1 < id.size()
            && id.find_first_not_of("0123456789", dot + 1) == std::string::npos;
        if (!part) return out;
        id.resize(dot);
        out.push_back(id);
    }
}

inline Answer answer(const std::string& id, const Plan& plan) {
    auto of = [&id](const std::string& made) { return lang::contains(owners(made), id); };
    Answer out;
    out.id = id;
    auto plays = [&out](double start, double end, const std::string& what) {
        out.at = std::min(out.at.value_or(start), start);
        out.until = std::max(out.until.value_or(end), end);
        out.what.push_back(what);
    };
    List<double> waiting;
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
    static const List<std::string> kinds = {"look", "speech", "mode", "place", "blink", "stay"};
    for (const auto& item : plan.track->items()) {
        if (item->kind != Item::stay && of(item->id)) plays(item->start, item->end, lang::at(kinds, item->kind));
    }
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
/// What begins before now + lookahead stays as it was, but at the very beginning, when nothing has been shown. Asks need
/// ids; of two with one id the later counts. What cannot be understood is in the plan's reports.
inline Ref<const Plan> hear(
    const Graph& graph, const Plan& plan, double now, const List<Json>& asks, double end, const PlanOptions& options = {}
) {
    const double fixed = now > 0 ? now + graph.project->settings->lookahead : 0;
    const Meaning meant = understand::understand(graph, asks, fixed);
    Set<std::string> gone = meant.withdrawn, before;
    for (const auto& request : meant.requests) gone.insert(request->id);
    for (const auto& item : meant.items) gone.insert(item->id);
    for (const auto& report : meant.refused) gone.insert(report->request);
    for (const auto& request : plan.requests) before.insert(request->id);
    for (const auto& item : plan.track->items()) before.insert(item->id);
    const bool every = meant.withdrawn.count("") > 0;
    Set<std::string> withdrawn;
    for (const std::string& id : before) {
        const List<std::string> owners = hearing::owners(id);
        const bool own = std::any_of(owners.begin(), owners.end(), [&gone](const auto& owner) { return gone.count(owner) > 0; });
        if (every || own) withdrawn.insert(id);
    }
    // Only a layer that stays somewhere, or is to, needs to be told that it need not.
    Set<std::string> staying, touched;
    Items items;
    for (const auto& stay : lang::together(plan.track->stays(), meant.items)) {
        if (stay->kind == Item::stay && stay->on) staying.insert(stay->layer);
    }
    for (const auto& item : meant.items) {
        if (item->kind != Item::stay || staying.count(item->layer) > 0) items.push_back(item);
    }
    for (const auto& request : meant.requests) touched.insert(request->layer);
    for (const auto& request : plan.requests) {
        if (withdrawn.count(request->id) > 0) touched.insert(request->layer);
    }
    auto changed = [&](const Item& item) { return gone.count(item.id) > 0 || withdrawn.count(item.id) > 0; };
    auto speaks = [](const Item& item) { return item.kind == Item::mode_from || item.kind == Item::speech; };
    bool turns = false; // who talks moves otherwise than who listens
    for (const auto& stay : lang::together(plan.track->stays(), items)) {
        if (stay->kind == Item::stay && changed(*stay)) touched.insert(stay->layer);
    }
    for (const auto& item : items) turns = turns || speaks(*item);
    for (const auto& item : plan.track->items()) turns = turns || (speaks(*item) && withdrawn.count(item->id) > 0);
    Set<std::string> leave;
    for (const std::string& layer : graph::LAYERS) {
        if (turns && !graph.layer(layer).markov->modes.empty()) touched.insert(layer);
        // Without any asks everything is planned on; with some, what they have to do with.
        if (!asks.empty() && now > 0 && end == plan.end && touched.count(layer) == 0) leave.insert(layer);
    }
    Plan with = plan;
    Items going_on;
    Set<std::string> begun, ended = withdrawn; // begun: of which more is said
    for (const auto& item : items) {
        going_on.push_back(track::goes_on(*plan.track, item, fixed));
        if (going_on.back() == item) continue;
        begun.insert(item->id);
        ended.erase(item->id);
    }
    with.track = track::plus(track::without(track::without(plan.track, ended, fixed), begun, -INFINITY), going_on);
    const Ref<const Plan> after = planner::extend(graph, with, fixed, meant.requests, end, options, withdrawn, leave);
    if (meant.refused.empty()) return after;
    auto out = lang::made<Plan>(*after);
    lang::extend(out->reports, meant.refused);
    return out;
}

/// Return a running plan without what ended before `seconds`; what is planned on from it stays as it would have been. Poses
/// before `seconds` are lost.
inline Ref<const Plan> since(const Graph& graph, const Plan& plan, double seconds) {
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
    out->track = track::since(plan.track, seconds);
    out->life = schedule::since(graph.life, plan.life, seconds);
    return out;
}

/// Say what a plan does about an ask: when it will play, or why it will not.
inline Answer answer(const Plan& plan, const std::string& id) { return hearing::answer(id, plan); }

}  // namespace metagraph
