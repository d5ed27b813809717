// The meaning of asks: requests of the layers, and lasting items (Borer et al., section 6 and figure 5).
//
// Translated from metagraph/playback/planning/meaning.py; change that, and translate anew.
#pragma once

#include "model.hpp"
#include "repeating.hpp"
#include "alphabet.hpp"
#include "graphemes.hpp"
#include "items.hpp"
#include "line_timing.hpp"
#include "spots.hpp"
#include "track.hpp"
#include "meta_plan.hpp"
#include "finding.hpp"
#include "mood.hpp"
#include "phases.hpp"
#include "project.hpp"
#include "spots.hpp"
#include "language.hpp"

namespace metagraph {

struct PlainAsk;
struct SaidLine;
struct AskedBlock;
struct SteeringAsk;
struct Meaning;

namespace meaning {

inline constexpr double FOREVER = 1000000000.0; // seconds; a look that lasts until the next
inline void understood(const Ref<Meaning>& whole, const Ref<PlainAsk>& ask, double now, double soon);

}  // namespace meaning

/// An ask with the fields of all kinds of asks; `do` says which of them count. line: id; said: that line, None if there
/// is none. text: the words, or a block of BML. timing: the times of its words and shapes.
struct PlainAsk {
    std::string do_;
    std::string id;
    std::optional<double> at;
    int priority;
    std::optional<std::string> layer;
    List<std::string> tags;
    std::optional<std::string> limb;
    std::optional<double> duration;
    std::optional<double> stroke;
    std::optional<double> hold;
    std::optional<double> late;
    std::optional<double> valence;
    std::optional<double> arousal;
    std::optional<double> intensity;
    bool prepare;
    bool resume;
    bool stay;
    std::string action;
    std::string stance;
    Ref<Spot> to;
    double amount;
    bool strict;
    std::optional<std::string> line;
    Ref<SaidLine> said;
    std::string text;
    bool gestures;
    Ref<LineTiming> timing;
    std::optional<std::string> mode;
    std::string name;
    List<double> point;
    std::string what;
    bool more;

    explicit PlainAsk(
        std::string do_,
        std::string id_ = "",
        std::optional<double> at_ = std::nullopt,
        int priority_ = meta_plan::ASKED,
        std::optional<std::string> layer_ = std::nullopt,
        List<std::string> tags_ = List<std::string>{},
        std::optional<std::string> limb_ = std::nullopt,
        std::optional<double> duration_ = std::nullopt,
        std::optional<double> stroke_ = std::nullopt,
        std::optional<double> hold_ = std::nullopt,
        std::optional<double> late_ = std::nullopt,
        std::optional<double> valence_ = std::nullopt,
        std::optional<double> arousal_ = std::nullopt,
        std::optional<double> intensity_ = std::nullopt,
        bool prepare_ = true,
        bool resume_ = false,
        bool stay_ = false,
        std::string action_ = "",
        std::string stance_ = "",
        Ref<Spot> to_ = nullptr,
        double amount_ = 1.0,
        bool strict_ = false,
        std::optional<std::string> line_ = std::nullopt,
        Ref<SaidLine> said_ = nullptr,
        std::string text_ = "",
        bool gestures_ = true,
        Ref<LineTiming> timing_ = nullptr,
        std::optional<std::string> mode_ = std::nullopt,
        std::string name_ = "",
        List<double> point_ = List<double>{},
        std::string what_ = "",
        bool more_ = false
    )
        : do_(std::move(do_)),
            id(std::move(id_)),
            at(at_),
            priority(priority_),
            layer(std::move(layer_)),
            tags(std::move(tags_)),
            limb(std::move(limb_)),
            duration(duration_),
            stroke(stroke_),
            hold(hold_),
            late(late_),
            valence(valence_),
            arousal(arousal_),
            intensity(intensity_),
            prepare(prepare_),
            resume(resume_),
            stay(stay_),
            action(std::move(action_)),
            stance(std::move(stance_)),
            to(std::move(to_)),
            amount(amount_),
            strict(strict_),
            line(std::move(line_)),
            said(std::move(said_)),
            text(std::move(text_)),
            gestures(gestures_),
            timing(std::move(timing_)),
            mode(std::move(mode_)),
            name(std::move(name_)),
            point(std::move(point_)),
            what(std::move(what_)),
            more(more_) {}
};

/// A line of dialogue. seconds: its length, None if unknown. asks: its own requests, in seconds from its start.
/// valence, arousal, intensity: of the mood it is said in.
struct SaidLine {
    std::string text;
    std::optional<double> seconds;
    List<Ref<PlainAsk>> asks;
    std::optional<double> valence;
    std::optional<double> arousal;
    std::optional<double> intensity;

    explicit SaidLine(
        std::string text_ = "",
        std::optional<double> seconds_ = std::nullopt,
        List<Ref<PlainAsk>> asks_ = List<Ref<PlainAsk>>{},
        std::optional<double> valence_ = std::nullopt,
        std::optional<double> arousal_ = std::nullopt,
        std::optional<double> intensity_ = std::nullopt
    )
        : text(std::move(text_)),
            seconds(seconds_),
            asks(std::move(asks_)),
            valence(valence_),
            arousal(arousal_),
            intensity(intensity_) {}
};

/// A requested block of BML: its behaviours become asks `<id>.1`, `<id>.2`, ...
struct AskedBlock {
    std::string id;
    double at;
    int priority;
    std::string text;

    AskedBlock(std::string id_, double at_, int priority_, std::string text_)
        : id(std::move(id_)), at(at_), priority(priority_), text(std::move(text_)) {}
};

/// An ask that steers speech. do: "interrupt", "pause", "resume" or "finish". what: the id of the speech, "" for all
/// speech.
struct SteeringAsk {
    std::string do_;
    std::string id;
    std::string what;
    int priority;

    SteeringAsk(std::string do_, std::string id_, std::string what_, int priority_)
        : do_(std::move(do_)), id(std::move(id_)), what(std::move(what_)), priority(priority_) {}
};

/// The meaning of asks, so far. graphs: of the layers, in their order. withdrawn: ids taken back; "" stands for all.
/// steered: the asks that steer speech, in order. unknown: the kind of thing that an ask names and that does not exist:
/// "action", "stance" or "line". Speeches may overlap. fixed: the earliest second at which a gesture of a line can
/// begin; the line itself may begin earlier.
struct Meaning {
    Ref<Project> project;
    List<Ref<MetaGraph>> graphs;
    Ref<Alphabet> alphabet;
    List<Ref<MetaRequest>> requests;
    List<Ref<LookAt>> looks;
    List<Ref<Speech>> speeches;
    List<Ref<ModeFrom>> modes;
    List<Ref<PlaceFrom>> places;
    List<Ref<BlinkAt>> blinks;
    List<Ref<StayFrom>> stays;
    List<Ref<MoodFrom>> moods;
    List<Ref<AskedBlock>> blocks;
    Set<std::string> withdrawn;
    List<Ref<SteeringAsk>> steered;
    List<Ref<Report>> refused;
    std::string unknown;
    double fixed;

    Meaning(
        Ref<Project> project_,
        List<Ref<MetaGraph>> graphs_,
        Ref<Alphabet> alphabet_,
        List<Ref<MetaRequest>> requests_ = List<Ref<MetaRequest>>{},
        List<Ref<LookAt>> looks_ = List<Ref<LookAt>>{},
        List<Ref<Speech>> speeches_ = List<Ref<Speech>>{},
        List<Ref<ModeFrom>> modes_ = List<Ref<ModeFrom>>{},
        List<Ref<PlaceFrom>> places_ = List<Ref<PlaceFrom>>{},
        List<Ref<BlinkAt>> blinks_ = List<Ref<BlinkAt>>{},
        List<Ref<StayFrom>> stays_ = List<Ref<StayFrom>>{},
        List<Ref<MoodFrom>> moods_ = List<Ref<MoodFrom>>{},
        List<Ref<AskedBlock>> blocks_ = List<Ref<AskedBlock>>{},
        Set<std::string> withdrawn_ = Set<std::string>{},
        List<Ref<SteeringAsk>> steered_ = List<Ref<SteeringAsk>>{},
        List<Ref<Report>> refused_ = List<Ref<Report>>{},
        std::string unknown_ = "",
        double fixed_ = 0.0
    )
        : project(std::move(project_)),
            graphs(std::move(graphs_)),
            alphabet(std::move(alphabet_)),
            requests(std::move(requests_)),
            looks(std::move(looks_)),
            speeches(std::move(speeches_)),
            modes(std::move(modes_)),
            places(std::move(places_)),
            blinks(std::move(blinks_)),
            stays(std::move(stays_)),
            moods(std::move(moods_)),
            blocks(std::move(blocks_)),
            withdrawn(std::move(withdrawn_)),
            steered(std::move(steered_)),
            refused(std::move(refused_)),
            unknown(std::move(unknown_)),
            fixed(fixed_) {}

    /// Return the track of lasting items.
    Ref<Track> track();

    /// Add the meaning of other asks.
    void take(const Ref<Meaning>& other);

    /// Report that an ask was not understood.
    void refuse(const std::string& ident, const std::string& why, const std::optional<std::string>& layer, double at);

    /// Return a layer's graph.
    Ref<MetaGraph> graph_of(const std::string& layer);

    /// Add the meaning of an ask; return why it has none, "" if it has one. ident, at, priority: its own, or as the
    /// line changed them that it belongs to. shift: the second at which that line begins, else 0.
    std::string add(const Ref<PlainAsk>& ask, const std::string& ident, double at, int priority, double shift);

    /// Nods are gestures with that tag; if there is none, the likeliest one with that name, whatever stance it needs.
    std::string head(const Ref<PlainAsk>& ask, const std::string& ident, double at, int priority);

    /// Say a line, with its own requests, or other words.
    std::string say(const Ref<PlainAsk>& ask, const std::string& ident, double at, int priority);
};

inline Ref<Track> Meaning::track() {
    return lang::made<Track>(
        this->looks,
        this->speeches,
        this->modes,
        this->places,
        this->blinks,
        this->stays,
        this->moods
    );
}

inline void Meaning::take(const Ref<Meaning>& other) {
    lang::extend(this->requests, other->requests);
    lang::extend(this->looks, other->looks);
    lang::extend(this->speeches, other->speeches);
    lang::extend(this->modes, other->modes);
    lang::extend(this->places, other->places);
    lang::extend(this->blinks, other->blinks);
    lang::extend(this->stays, other->stays);
    lang::extend(this->moods, other->moods);
    lang::extend(this->blocks, other->blocks);
    lang::extend(this->steered, other->steered);
    for (const auto& ident : other->withdrawn) {
        this->withdrawn.insert(ident);
    }
}

inline void Meaning::refuse(
    const std::string& ident,
    const std::string& why,
    const std::optional<std::string>& layer,
    double at
) {
    this->refused.push_back(lang::made<Report>(
        ident,
        "not-understood",
        why,
        !layer.has_value() ? std::string("arms") : *layer,
        at
    ));
}

inline Ref<MetaGraph> Meaning::graph_of(const std::string& layer) {
    Ref<MetaGraph> first;
    for (const auto& graph : this->graphs) {
        if (graph->layer == layer) {
            first = graph;
            break;
        }
    }
    return first;
}

inline std::string Meaning::add(
    const Ref<PlainAsk>& ask,
    const std::string& ident,
    double at,
    int priority,
    double shift
) {
    std::string where = !ask->layer.has_value() ? std::string("") : lang::text(" in the ", *ask->layer, " layer");
    std::optional<double> stroke = !ask->stroke.has_value()
        ? std::nullopt
        : std::optional<double>(*ask->stroke + shift);
    double start = at;
    if (ask->do_ == "gesture" || ask->do_ == "fidget") {
        std::string kind = ask->do_ == "gesture" ? std::string("gesture") : std::string("fidget");
        std::string layer = !ask->layer.has_value() ? std::string("arms") : *ask->layer;
        if (stroke.has_value()) {
            start = std::max(0.0, *stroke - phases::find_longest_lead(this->project, this->graph_of(layer), ask->tags));
        }
        Ref<MetaRequest> request = lang::made<MetaRequest>(
            ident,
            layer,
            kind,
            start,
            ask->duration,
            std::nullopt,
            ask->tags,
            ask->limb,
            std::nullopt,
            priority,
            ask->resume,
            stroke,
            ask->hold,
            ask->prepare,
            List<std::string>{},
            ask->late,
            ask->valence,
            ask->arousal,
            ask->intensity
        );
        this->requests.push_back(request);
    } else if (ask->do_ == "action") {
        Ref<Action> action = finding::action_called(this->graphs, ask->action, ask->layer);
        if (action == nullptr) {
            this->unknown = "action";
            return lang::text("there is no action '", ask->action, "'", where);
        }
        if (stroke.has_value()) {
            start = std::max(0.0, *stroke - phases::lead(this->project, action));
        }
        auto [begins, ends] = this->project->span(action);
        bool repeats = repeating::cycle_of(action->kind, action->timing, begins, ends) > 0;
        std::optional<double> duration = repeats ? ask->duration : std::nullopt;
        Ref<MetaRequest> request = lang::made<MetaRequest>(
            ident,
            action->layer,
            action->kind,
            start,
            duration,
            action->id,
            List<std::string>{},
            std::nullopt,
            std::nullopt,
            priority,
            false,
            stroke,
            ask->hold,
            ask->prepare,
            List<std::string>{},
            ask->late,
            ask->valence,
            ask->arousal,
            ask->intensity
        );
        this->requests.push_back(request);
    } else if (ask->do_ == "stance") {
        Ref<Stance> stance = finding::stance_called(this->graphs, ask->stance, ask->layer);
        if (stance == nullptr) {
            this->unknown = "stance";
            return lang::text("there is no stance '", ask->stance, "'", where);
        }
        this->requests.push_back(lang::made<MetaRequest>(
            ident,
            stance->layer,
            "transition",
            at,
            std::nullopt,
            std::nullopt,
            List<std::string>{},
            std::nullopt,
            stance->id,
            priority,
            false,
            std::nullopt,
            std::nullopt,
            true,
            List<std::string>{},
            ask->late
        ));
        this->stays.push_back(lang::made<StayFrom>(ident, at, stance->layer, ask->stay));
    } else if (ask->do_ == "change") {
        // Whichever arm was seen to move: stances are joined by few transitions, and mostly of both.
        std::string layer = !ask->layer.has_value() ? std::string("arms") : *ask->layer;
        this->requests.push_back(lang::made<MetaRequest>(
            ident,
            layer,
            "transition",
            at,
            std::nullopt,
            std::nullopt,
            List<std::string>{},
            std::nullopt,
            std::nullopt,
            priority,
            false,
            std::nullopt,
            std::nullopt,
            true,
            List<std::string>{},
            ask->late
        ));
    } else if (ask->do_ == "nod" || ask->do_ == "shake") {
        return this->head(ask, ident, at, priority);
    } else if (ask->do_ == "look") {
        double end = !ask->duration.has_value() ? meaning::FOREVER : at + *ask->duration;
        Ref<Spot> to = ask->to == nullptr ? spots::named("user") : ask->to;
        this->looks.push_back(lang::made<LookAt>(ident, at, end, to, ask->amount, ask->strict, priority));
    } else if (ask->do_ == "blink") {
        this->blinks.push_back(lang::made<BlinkAt>(ident, at));
    } else if (ask->do_ == "mood") {
        double until = !ask->duration.has_value() ? INFINITY : at + *ask->duration;
        this->moods.push_back(lang::made<MoodFrom>(ident, at, ask->valence, ask->arousal, ask->intensity, until));
    } else if (ask->do_ == "mode") {
        this->modes.push_back(lang::made<ModeFrom>(ident, at, ask->mode));
    } else if (ask->do_ == "place") {
        this->places.push_back(lang::made<PlaceFrom>(ident, at, ask->name, ask->point));
    } else if (ask->do_ == "withdraw") {
        this->withdrawn.insert(ask->what);
    } else if (ask->do_ == "interrupt" || ask->do_ == "pause" || ask->do_ == "resume" || ask->do_ == "finish") {
        this->steered.push_back(lang::made<SteeringAsk>(ask->do_, ident, ask->what, priority));
    } else if (ask->do_ == "say") {
        return this->say(ask, ident, at, priority);
    } else if (ask->do_ == "bml") {
        this->blocks.push_back(lang::made<AskedBlock>(ident, at, priority, ask->text));
    } else {
        return lang::text("nothing is known of '", ask->do_, "'");
    }
    return "";
}

inline std::string Meaning::head(const Ref<PlainAsk>& ask, const std::string& ident, double at, int priority) {
    List<Ref<Action>> gestures;
    for (const auto& x : lang::values(this->graph_of("head")->actions)) {
        bool holds = x->kind == "gesture";
        if (holds) {
            bool are_all = true;
            for (const auto& tag : ask->tags) {
                if (!lang::contains(x->tags, tag)) {
                    are_all = false;
                    break;
                }
            }
            holds = are_all;
        }
        if (holds) {
            gestures.push_back(x);
        }
    }
    List<std::string> tags;
    List<std::string> called;
    bool is_any = false;
    for (const auto& x : gestures) {
        if (lang::contains(x->tags, ask->do_)) {
            is_any = true;
            break;
        }
    }
    if (is_any) {
        tags = lang::together(List<std::string>{ask->do_}, ask->tags);
    } else {
        List<std::string> found;
        for (const auto& x : gestures) {
            if (lang::contains(lang::lowered(x->name), ask->do_)) {
                found.push_back(x->id);
            }
        }
        called = found;
        if (lang::len(called) == 0) {
            std::string told = lang::len(ask->tags) > 0
                ? lang::text(" with the tags ", lang::joined(ask->tags, ", "))
                : std::string("");
            return lang::text("the head layer has no gesture tagged or called '", ask->do_, "'", told);
        }
    }
    this->requests.push_back(lang::made<MetaRequest>(
        ident,
        "head",
        "gesture",
        at,
        std::nullopt,
        std::nullopt,
        tags,
        std::nullopt,
        std::nullopt,
        priority,
        false,
        std::nullopt,
        std::nullopt,
        true,
        called,
        ask->late,
        ask->valence,
        ask->arousal,
        ask->intensity
    ));
    return "";
}

inline std::string Meaning::say(const Ref<PlainAsk>& ask, const std::string& ident, double at, int priority) {
    Ref<SaidLine> line = ask->said;
    if (ask->line.has_value() && line == nullptr) {
        this->unknown = "line";
        return lang::text("there is no line '", *ask->line, "'");
    }
    std::string text = ask->text;
    if (text == "" && line != nullptr) {
        text = line->text;
    }
    if (text == "" && line == nullptr && ask->timing != nullptr) {
        text = line_timing::told_text(ask->timing);
    }
    if (line == nullptr && text == "" && ask->timing == nullptr) {
        return "say what: a line's id, text, or words with their times";
    }
    Ref<LineTiming> timing = ask->timing;
    if (timing == nullptr && line == nullptr && ask->more && ask->duration.has_value()) {
        timing = line_timing::pace_text(this->alphabet, text, *ask->duration);
    }
    double length{};
    if (timing != nullptr) {
        length = line_timing::timed_seconds(timing, ask->duration);
    } else if (ask->duration.has_value()) {
        length = std::max(*ask->duration, 0.0);
    } else if (line != nullptr && line->seconds.has_value()) {
        length = *line->seconds;
    } else {
        length = graphemes::read_aloud(this->alphabet, text);
    }
    this->speeches.push_back(lang::made<Speech>(
        ident,
        at,
        at + length,
        ask->line,
        text,
        priority,
        std::nullopt,
        timing,
        0.0,
        ask->more
    ));
    bool told = ask->valence.has_value() || line == nullptr;
    std::optional<double> valence = (told || line == nullptr) ? ask->valence : line->valence;
    std::optional<double> arousal = (told || line == nullptr) ? ask->arousal : line->arousal;
    std::optional<double> intensity = (!ask->intensity.has_value() && line != nullptr)
        ? line->intensity
        : ask->intensity;
    if (valence.has_value() || intensity.has_value()) {
        this->moods.push_back(lang::made<MoodFrom>(ident, at, valence, arousal, intensity, at + length));
    }
    if (line == nullptr || !ask->gestures) {
        return "";
    }
    for (int n = 0; n < lang::len(line->asks); n++) {
        const auto& inner = lang::at(line->asks, n);
        if (inner->do_ == "say") {
            return "a line would say another line; its asks may not";
        }
        double begins = !inner->at.has_value() ? at : at + *inner->at;
        if (!ask->at.has_value()) {
            begins = std::max(begins, this->fixed);
        }
        std::string why = this->add(
            inner,
            lang::text(ident, ".", n + 1),
            begins,
            std::max(inner->priority, priority),
            at
        );
        if (why != "") {
            return why;
        }
    }
    return "";
}

namespace meaning {

/// Add the meaning of an ask, or refuse all of it. now: when it begins if it does not say; soon: the same for speech.
inline void understood(const Ref<Meaning>& whole, const Ref<PlainAsk>& ask, double now, double soon) {
    Ref<Meaning> one = lang::made<Meaning>(
        whole->project,
        whole->graphs,
        whole->alphabet,
        List<Ref<MetaRequest>>{},
        List<Ref<LookAt>>{},
        List<Ref<Speech>>{},
        List<Ref<ModeFrom>>{},
        List<Ref<PlaceFrom>>{},
        List<Ref<BlinkAt>>{},
        List<Ref<StayFrom>>{},
        List<Ref<MoodFrom>>{},
        List<Ref<AskedBlock>>{},
        Set<std::string>{},
        List<Ref<SteeringAsk>>{},
        List<Ref<Report>>{},
        "",
        now
    );
    double at = !ask->at.has_value() ? ask->do_ == "say" ? soon : now : *ask->at;
    std::string why = one->add(ask, ask->id, at, ask->priority, 0.0);
    if (why == "") {
        whole->take(one);
    } else {
        whole->refuse(ask->id, why, ask->layer, at);
    }
}

}  // namespace meaning

}  // namespace metagraph
