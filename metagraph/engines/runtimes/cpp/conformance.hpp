// Does this runtime do what Metagraph does? Runs conformance vectors: folders with vectors.json and the export it names.
#pragma once

#include <fstream>
#include <iterator>

#include "metagraph.hpp"
#include "single_rules.hpp"
#include "spoken_so_far.hpp"
#include "sympathy.hpp"

namespace metagraph {

/// How many cases were run, and what differs in which, in words.
struct Verdict {
    int cases = 0, passed = 0;
    List<std::string> failures;
};

namespace conformance {

inline constexpr int VERSION = 1; // of the vectors

inline std::optional<std::string> file(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    if (!in) return std::nullopt;
    return std::string(std::istreambuf_iterator<char>(in), {});
}

/// Return the first difference of plain data, "" where they are alike.
inline std::string difference(const Json& found, const Json& wanted, double tolerance, const std::string& where) {
    const std::string words = lang::text(where, " is ", json::text(found).substr(0, 300), ", should be ", json::text(wanted).substr(0, 300));
    if (found.is(Json::Kind::number) && wanted.is(Json::Kind::number)) {
        return std::abs(found.number - wanted.number) <= tolerance ? "" : words;
    }
    if (found.kind != wanted.kind || found.items.size() != wanted.items.size() || found.fields.size() != wanted.fields.size()) return words;
    if (found.text != wanted.text || found.flag != wanted.flag) return words;
    for (std::size_t n = 0; n < wanted.items.size(); n++) {
        const std::string told = difference(found.items[n], wanted.items[n], tolerance, lang::text(where, "[", n, "]"));
        if (!told.empty()) return told;
    }
    for (const auto& [name, value] : wanted.fields) {
        const Json* own = found.find(name);
        if (own == nullptr) return lang::text(where, " has no '", name, "'");
        const std::string told = difference(*own, value, tolerance, where + "." + name);
        if (!told.empty()) return told;
    }
    return "";
}

inline Json cue_data(const Cue& cue) {
    Json out = Json::object({
        {"action", cue.action->id}, {"start", cue.start}, {"end", cue.end}, {"entry", cue.entry}, {"blend_in", cue.blend_in},
        {"blend_out", cue.blend_out}, {"stance", cue.stance}, {"then", cue.then}, {"meta", cue.meta},
        {"hold_from", cue.hold_from}, {"hold_to", cue.hold_to}, {"hold", cue.hold},
    });
    if (cue.extent != 1) out.set("extent", cue.extent);
    if (cue.tempo != 1) out.set("tempo", cue.tempo);
    if (cue.repeats()) {
        out.set("cycle_from", cue.cycle_from);
        out.set("cycle_to", cue.cycle_to);
    }
    return out;
}

inline Json layer_data(const LayerPlan& layer) {
    Json metas = Json::list(), cues = Json::list(), rests = Json::list();
    for (const auto& m : layer.metas) metas.items.push_back(Json::list({m->key(), m->start, m->end, m->written}));
    for (const auto& cue : layer.cues) cues.items.push_back(cue_data(*cue));
    for (const auto& r : layer.rests) {
        rests.items.push_back(Json::list({r->stance, r->action->id, r->start, r->fade_start, r->fade}));
    }
    return Json::object({{"metas", metas}, {"cues", cues}, {"rests", rests}});
}

inline Json lane_data(const Lane& lane) {
    Json out = Json::list();
    for (int n = 0; n < lang::len(lane.times); n++) {
        Json row = Json::list({lang::at(lane.times, n)});
        for (const double value : lang::at(lane.rows, n)) row.items.push_back(value);
        out.items.push_back(row);
    }
    return out;
}

inline Json life_data(const Schedule& life) {
    Json targets = Json::list();
    for (const auto& t : life.targets) {
        const Spot& spot = *t->to;
        const Json to = spot.point.has_value() ? Json::list({spot.point->x, spot.point->y, spot.point->z}) : Json(spot.name);
        targets.items.push_back(Json::list({t->start, to, t->since, t->amount, t->strict, t->asked}));
    }
    Json out = Json::object({
        {"modes", lane_data(*life.modes)}, {"breaths", lane_data(*life.breaths)}, {"aversions", lane_data(*life.aversions)},
        {"saccades", lane_data(*life.saccades)}, {"blinks", lane_data(*life.blinks)}, {"targets", targets},
        {"swells", lane_data(*life.swells)}, {"emphases", lane_data(*life.emphases)},
    });
    const List<double> neutral = {0, 0, 1};
    const auto& moods = life.moods->rows;
    if (std::any_of(moods.begin(), moods.end(), [&](const auto& row) { return row != neutral; })) {
        out.set("moods", lane_data(*life.moods));
    }
    return out;
}

/// Times of equal reports may differ in the last digits.
inline Json sorted_reports(const List<Json>& rows) {
    List<std::string> keys;
    for (const Json& row : rows) {
        const std::string at = lang::fixed(row.items[3].number, 5);
        keys.push_back(json::text(Json::list({
            row.items[0], row.items[1], row.items[2], std::string(20 - std::min<std::size_t>(20, at.size()), ' ') + at, row.items[4],
        })));
    }
    return Json::list(lang::ordered(rows, keys));
}

/// The angle between two rotations, degrees.
inline double angle(const Quat& a, const Quat& b) {
    const Quat d = rotation::multiply(a.back(), b);
    return 360 / lang::PI * std::atan2(std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z), std::abs(d.w));
}

/// Compare a pose and morph targets with those of the vectors. tell: takes what differs.
template <class Tell>
void compare_pose(
    const Graph& graph, const List<Joined>& pose, const List<double>& morphs, const Json& wanted, const Json& tolerance, Tell tell
) {
    const std::string at = lang::text("pose at ", wanted.find("time")->number, " s", wanted.find("alive")->flag ? ", alive" : "");
    const List<Joined> globals = rotation::globals(graph.parents, pose);
    std::pair<double, int> metres{0, 0}, degrees{0, 0};
    for (int j = 0; j < lang::len(graph.joints); j++) {
        const List<Json>&q = lang::at(wanted.find("rotations")->items, j).items, &p = lang::at(wanted.find("positions")->items, j).items;
        const Vec away = lang::at(globals, j).translation - Vec{p[0].number, p[1].number, p[2].number};
        const double off = std::sqrt(rotation::dot(away, away));
        const double turned = angle(lang::at(pose, j).rotation, {q[0].number, q[1].number, q[2].number, q[3].number});
        if (!(off <= metres.first)) metres = {off, j};
        if (!(turned <= degrees.first)) degrees = {turned, j};
    }
    for (const auto& [unit, worst] : {std::pair<const char*, std::pair<double, int>>{"metres", metres}, {"degrees", degrees}}) {
        if (worst.first <= tolerance.find(unit)->number) continue;
        tell(lang::text(at, ": ", lang::at(graph.joints, worst.second), " is ", worst.first, " ", unit, " off"));
    }
    Set<std::string> names(graph.morphs.begin(), graph.morphs.end());
    for (const auto& field : wanted.find("morphs")->fields) names.insert(field.first);
    for (const std::string& name : names) {
        const int place = lang::index(graph.morphs, name);
        const double is = place < lang::len(morphs) ? lang::at(morphs, place) : 0;
        const Json* own = wanted.find("morphs")->find(name);
        const double should = own == nullptr ? 0 : own->number;
        if (!(std::abs(is - should) <= tolerance.find("weight")->number)) {
            tell(lang::text(at, ": morph target ", name, " is ", is, ", should be ", should));
        }
    }
}

/// Looks at what is said: after each step of a case, and later.
struct Watch {
    SpeechWatch speech;
    double seen = -1.0;
    List<std::string> said;
    Json rows = Json::list();

    void look(const Plan& plan, double now, const List<Json>& asks) {
        auto maybe = [](const std::optional<double>& seconds) {
            return seconds.has_value() && *seconds <= 1e8 ? Json(*seconds) : Json();
        };
        const List<Ref<Speech>>& speeches = plan.track->speeches;
        Json events = Json::list(), spoken = Json::list(), answers = Json::list();
        List<std::string> ids;
        for (const Json& ask : asks) {
            const std::string& id = ask.find("id")->text;
            if (ask.find("do")->text == "say" && !lang::contains(said, id)) said.push_back(id);
            if (!lang::contains(ids, id)) ids.push_back(id);
        }
        for (const std::string& id : ids) {
            const Answer told = hearing::answer(id, plan);
            answers.items.push_back(Json::list({id, told.state, maybe(told.at), maybe(told.until), Json::texts(told.what)}));
        }
        for (const std::string& id : said) {
            const auto [text, last] = spoken_so_far::spoken_until(voice::alphabet(), speeches, id, now);
            if (!text.empty()) spoken.items.push_back(Json::list({id, text, last}));
        }
        for (const auto& e : speech.watch(speeches, seen, now)) {
            events.items.push_back(Json::list({e->kind, e->at, e->id, e->said, e->reason}));
        }
        rows.items.push_back(Json::object({
            {"now", now}, {"events", events}, {"spoken", spoken},
            {"silent", Json::texts(utterances::find_forgotten(plan.track, now))}, {"answers", answers},
        }));
        seen = now;
    }
};

/// Return the plan that a case's steps make. watch: what looks on, where the case wants that.
inline Ref<const Plan> planned(const Graph& graph, const Json& one, Watch* watch = nullptr) {
    const Json* watched = watch == nullptr ? nullptr : one.find("watched");
    PlanOptions options;
    options.idle = one.find("idle")->flag;
    for (const auto& [layer, stance] : one.find("stances")->fields) options.stances[layer] = stance.text;
    Ref<const Plan> plan = lang::made<Plan>(static_cast<std::uint32_t>(one.find("seed")->number));
    for (const Json& step : one.find("steps")->items) {
        plan = hear(graph, *plan, step.find("now")->number, step.find("asks")->items, step.find("end")->number, options);
        if (watched != nullptr) watch->look(*plan, step.find("now")->number, step.find("asks")->items);
        if (!step.find("forget")->empty()) plan = since(*plan, step.find("forget")->number);
    }
    for (std::size_t n = one.find("steps")->items.size(); watched != nullptr && n < watched->items.size(); n++) {
        watch->look(*plan, watched->items[n].find("now")->number, {});
    }
    return plan;
}

template <class Tell>
void run_case(const Ref<const Graph>& graph, const Json& one, const Json& tolerance, Tell tell) {
    Watch watch;
    const Ref<const Plan> plan = planned(*graph, one, &watch);
    const double seconds = tolerance.find("seconds")->number;
    auto same = [&](const std::string& where, const Json& found, const Json& wanted) {
        const std::string told = difference(found, wanted, seconds, where);
        if (!told.empty()) tell(told);
    };
    if (one.find("watched") != nullptr) same("watched", watch.rows, *one.find("watched"));
    const Json& wanted = *one.find("plan");
    for (const std::string& layer : graph::LAYERS) {
        same(layer, layer_data(*plan->layers.at(layer)), *wanted.find("layers")->find(layer));
    }
    List<Json> reports;
    for (const auto& r : plan->reports) reports.push_back(Json::list({r->request, r->outcome, r->layer, r->at, r->played}));
    same("reports", sorted_reports(reports), sorted_reports(wanted.find("reports")->items));
    same("life", life_data(*plan->life), *one.find("life"));
    Player player(graph, plan);
    List<double> morphs;
    for (const Json& pose : one.find("poses")->items) {
        const double time = pose.find("time")->number;
        const bool alive = pose.find("alive")->flag;
        player.morphs(time, morphs, alive);
        compare_pose(*graph, player.pose(time, alive), morphs, pose, tolerance, tell);
    }
}

/// What comes of a text: its sentences, words and gestures.
inline Json talk_of(const Json& row) {
    const Ref<Alphabet>& alphabet = voice::alphabet();
    const std::string& text = row.find("text")->text;
    Json sentences = Json::list(), words = Json::list(), asks = Json::list();
    List<std::string> letters = alphabet->letters(text);
    while (const int end = word_gestures::sentence_end(alphabet, letters, true)) {
        sentences.items.push_back(lang::joined(lang::part(letters, 0, end), ""));
        letters = lang::part(letters, end);
    }
    List<Ref<ToldWord>> told;
    for (const Json& one : row.find("told")->items) told.push_back(lang::made<ToldWord>(one.items[0].number, one.items[1].number));
    std::optional<double> seconds;
    if (!row.find("seconds")->empty()) seconds = row.find("seconds")->number;
    const List<Ref<TextWord>> found = word_gestures::words_of(alphabet, text, told, seconds);
    for (const auto& w : found) words.items.push_back(Json::list({w->text, w->plain, w->start, w->end, w->mark}));
    const auto [lexicon, small] = Talk::lexicon_of(row.find("language")->text);
    Set<std::string> arms;
    for (const Json& tag : row.find("arms")->items) arms.insert(tag.text);
    const auto made = word_gestures::proposed_for(
        found, arms, row.find("head")->flag, lexicon, small, static_cast<std::uint32_t>(row.find("seed")->number)
    );
    for (const auto& ask : word_gestures::gesture_asks(made, row.find("at")->number)) {
        asks.items.push_back(Json::list({ask->do_, ask->layer, Json::texts(ask->tags), ask->at, Json::maybe(ask->stroke), ask->late}));
    }
    return Json::object({{"sentences", sentences}, {"words", words}, {"asks", asks}});
}

/// What a single rule answers.
inline Json answer_of(const Json& row) {
    List<double> numbers;
    for (const Json& x : row.items[2].items) numbers.push_back(x.number);
    List<std::string> texts;
    for (const Json& x : row.items[3].items) texts.push_back(x.text);
    Json out = Json::list();
    const auto seed = static_cast<std::uint32_t>(row.items[1].number);
    for (const double x : single_rules::answer_rule(voice::alphabet(), seed, row.items[0].text, numbers, texts)) out.items.push_back(x);
    return out;
}

/// What is taken up of another's moods, and whose laughs are joined in.
inline Json sympathies_of(const Json& row) {
    auto told = [&row](const char* name) {
        List<Ref<MoodFrom>> out;
        for (const Json& one : row.find(name)->items) {
            const List<Json>& x = one.items;
            out.push_back(lang::made<MoodFrom>("told", x[0].number, x[1].number, x[2].number, std::nullopt, x[3].number));
        }
        return out;
    };
    auto data = [](const List<Ref<MoodFrom>>& moods) {
        Json out = Json::list();
        for (const auto& m : moods) out.items.push_back(Json::list({m->id, m->start, *m->valence, *m->arousal, m->end}));
        return out;
    };
    const List<Json>& base = row.find("base")->items;
    const auto own = lang::made<Moods>(lang::made<Mood>(base[0].number, base[1].number, base[2].number), told("own"));
    const auto others = lang::made<Moods>(lang::made<Mood>(), told("others"));
    List<Ref<Laugh>> laughs;
    for (const Json& one : row.find("laughs")->items) laughs.push_back(lang::made<Laugh>(one.items[0].number, one.items[1].number));
    const double share = row.find("share")->number;
    const auto seed = static_cast<std::uint32_t>(row.find("seed")->number);
    const std::string& who = row.find("who")->text;
    return Json::list({
        data(sympathy::moods_taken_up(own, others, row.find("end")->number, share, seed, who)),
        data(sympathy::laughs_along(own, laughs, share, seed, who)),
    });
}

/// What becomes of setting parameters one after another: the request, what is wrong, and the values of all then.
inline Json settings_of(const Graph& graph, const Json& rows) {
    ParameterValues values;
    Json out = Json::list();
    for (const Json& row : rows.items) {
        std::string wrong;
        const std::optional<Json> request = values.take(graph.parameters, row.find("name")->text, *row.find("value"), wrong);
        Json now = Json::object();
        for (const auto& [name, one] : graph.parameters) now.set(name, values.get(graph.parameters, name));
        out.items.push_back(Json::list({request.value_or(Json()), wrong, now}));
    }
    return out;
}

/// Run the vectors of a folder.
inline Verdict run(const std::string& folder) {
    Verdict out;
    auto failed = [&](const std::string& name, const std::string& what) {
        out.failures.push_back(lang::text(folder, ": ", name, ": ", what));
        return out;
    };
    const auto text = file(folder + "/vectors.json");
    if (!text.has_value()) return failed("vectors.json", "is not there. Give folders that `metagraph export --vectors` wrote.");
    json::Parser parser(*text);
    const Json vectors = parser.parse();
    if (!parser.wrong.empty()) return failed("vectors.json", parser.wrong);
    const Json* version = vectors.find("vectors");
    if (version == nullptr || version->number != VERSION) {
        return failed("vectors.json", lang::text("is of another version than ", VERSION, "; update the runtime."));
    }
    const std::string name = vectors.find("export")->text, json = file(folder + "/" + name).value_or("");
    json::Parser export_parser(json);
    const Json document = export_parser.parse();
    const Json* word = document.find("glb");
    const std::string glb = word == nullptr ? "" : file(folder + "/" + word->text).value_or("");
    const Loaded loaded = load(json, reinterpret_cast<const std::uint8_t*>(glb.data()), glb.size(), name);
    if (loaded.graph == nullptr) return failed("loading", loaded.error);
    const Json& tolerance = *vectors.find("tolerance");
    auto done = [&](std::size_t before) {
        out.cases++;
        out.passed += out.failures.size() == before;
    };
    std::size_t before = out.failures.size();
    for (const Json& row : vectors.find("hashes")->items) {
        List<std::string> words;
        for (const Json& one : row.items[1].items) words.push_back(one.text);
        const std::uint32_t hash = choice::key32(static_cast<std::uint32_t>(row.items[0].number), words);
        if (hash != static_cast<std::uint32_t>(row.items[2].number)) failed("hashes", json::text(row.items[1]) + " differs");
    }
    done(before);
    if (vectors.find("described") != nullptr) {
        before = out.failures.size();
        const std::string told = difference(
            describe(*loaded.graph), *vectors.find("described"), tolerance.find("seconds")->number, "described"
        );
        if (!told.empty()) failed("described", told);
        done(before);
    }
    if (vectors.find("heard") != nullptr) {
        before = out.failures.size();
        for (const Json& sound : vectors.find("heard")->items) {
            StreamedVoice voice(sound.find("rate")->number);
            Json found = Json::list({}), seconds = Json::list({});
            for (std::size_t n = 0; n < sound.find("pieces")->items.size(); n++) {
                const Json& piece = sound.find("pieces")->items[n];
                voice.follow(sound.find("said")->items[n].number);
                List<double> samples;
                for (const Json& sample : piece.items) samples.push_back(sample.number / 128.0);
                Json marks = Json::list({});
                for (const Ref<VisemeMark>& mark : voice.hear(samples)) {
                    marks.items.push_back(Json::list({mark->at, mark->viseme, mark->weight}));
                }
                found.items.push_back(marks);
                seconds.items.push_back(voice.seconds);
            }
            const Json wanted = Json::list({*sound.find("marks"), *sound.find("seconds")});
            const std::string told = difference(Json::list({found, seconds}), wanted, tolerance.find("seconds")->number, "heard");
            if (!told.empty()) failed("heard", told);
        }
        done(before);
    }
    if (vectors.find("talked") != nullptr) {
        before = out.failures.size();
        for (const Json& row : vectors.find("talked")->items) {
            const Json wanted = Json::object({
                {"sentences", *row.find("sentences")}, {"words", *row.find("words")}, {"asks", *row.find("asks")},
            });
            const std::string told = difference(talk_of(row), wanted, tolerance.find("seconds")->number, "talked");
            if (!told.empty()) failed("talked", told);
        }
        done(before);
    }
    if (vectors.find("sympathies") != nullptr) {
        before = out.failures.size();
        for (const Json& row : vectors.find("sympathies")->items) {
            const Json wanted = Json::list({*row.find("taken"), *row.find("along")});
            const std::string told = difference(sympathies_of(row), wanted, tolerance.find("seconds")->number, "sympathies");
            if (!told.empty()) failed("sympathies", told);
        }
        done(before);
    }
    if (const Json* rules = vectors.find("rules")) {
        before = out.failures.size();
        for (const Json& row : rules->items) {
            const std::string where = "rules, " + row.items[0].text;
            const std::string told = difference(answer_of(row), row.items[4], tolerance.find("seconds")->number, where);
            if (!told.empty()) failed("rules", told);
        }
        done(before);
    }
    if (const Json* settings = vectors.find("settings")) {
        before = out.failures.size();
        Json wanted = Json::list();
        for (const Json& row : settings->items) {
            wanted.items.push_back(Json::list({*row.find("request"), *row.find("wrong"), *row.find("now")}));
        }
        const std::string told = difference(settings_of(*loaded.graph, *settings), wanted, tolerance.find("seconds")->number, "settings");
        if (!told.empty()) failed("settings", told);
        done(before);
    }
    for (const Json& one : vectors.find("cases")->items) {
        before = out.failures.size();
        const std::string& own = one.find("name")->text;
        run_case(loaded.graph, one, tolerance, [&](const std::string& what) { failed(own, what); });
        done(before);
    }
    return out;
}

}  // namespace conformance
}  // namespace metagraph
