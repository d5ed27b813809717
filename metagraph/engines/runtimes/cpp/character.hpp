// One character of a game: takes requests as they come, plans ahead, and is posed every frame.
#pragma once

#include "describe.hpp"
#include "hear.hpp"
#include "pose.hpp"
#include "speech_watch.hpp"
#include "spoken_so_far.hpp"
#include "streamed_voice.hpp"

namespace metagraph {

/// What began or ended: kind "begin" or "end"; layer, "speech" for what is said; action, its name, of what is said the
/// line's id, else the text; meta, the request's id, "auto/..." for what the models wrote; reason, where all that is said
/// under an id is over: finished, interrupted or replaced, else "".
struct Happening {
    std::string kind;
    double at = 0.0;
    std::string layer, action, meta, reason;
};

/// What of something said was spoken, and the last word of it.
struct Spoken {
    std::string text, last_word;
};

/// seed: 32 bits, the export's where none is given; characters of one graph want different ones. idle: whether the models
/// fill the time nobody asks for. stances: layer -> id of the stance it begins in. ahead: seconds planned in advance. recent:
/// seconds that are remembered.
struct CharacterOptions {
    std::optional<std::uint32_t> seed;
    bool idle = true;
    Map<std::string, std::string> stances;
    double ahead = 20.0, recent = 30.0;
};

class Character {
public:
    explicit Character(Ref<const Graph> graph, const CharacterOptions& options = {})
        : graph_(std::move(graph)), options_{options.stances, options.idle}, ahead_(options.ahead), recent_(options.recent),
          plan_(hear(*graph_, Plan(options.seed.value_or(graph_->seed)), 0, {}, options.ahead, options_)),
          player_(graph_, plan_) {}

    const Graph& graph() const { return *graph_; }
    const Plan& plan() const { return *plan_; }
    double now() const { return now_; }

    /// What may be asked for.
    Json describe() const { return metagraph::describe(*graph_); }

    /// Ask for something; it is taken up at the next update. Returns the request's id, under which `answer` tells what became
    /// of it; one is made where there is none. What cannot be read is refused. request: JSON with `do`; `after`, seconds from
    /// now, wins over `at`.
    std::string ask(const std::string& request) {
        json::Parser parser(request);
        const Json data = parser.parse();
        return parser.wrong.empty() ? ask(data) : refuse(made_id(), parser.wrong);
    }
    std::string ask(const char* request) { return ask(std::string(request)); }
    std::string ask(const Json& request) {
        const Json* own = request.find("id");
        const bool named = own != nullptr && own->is(Json::Kind::text) && !own->text.empty();
        const std::string made = made_id(), id = named ? own->text : made;
        if (!request.is(Json::Kind::object)) return refuse(id, "a request should be an object");
        Json data = request;
        data.set("id", id);
        const Json* after = request.find("after");
        if (after != nullptr) {
            if (!after->is(Json::Kind::number) || after->number < 0) return refuse(id, "after: should be a number of seconds from now");
            auto gone = [](const auto& field) { return field.first == "after"; };
            data.fields.erase(std::remove_if(data.fields.begin(), data.fields.end(), gone), data.fields.end());
            data.set("at", now_ + after->number);
        }
        const Ask read = asks::read(data);
        if (!read.why.empty()) return refuse(id, read.why);
        forget_answer(id);
        asked_.insert(id);
        queue_.push_back(data);
        return id;
    }

    /// Set a parameter of the project: a number, a flag, a text, a list of texts or of three numbers, nothing for a trigger. Returns the
    /// id of the request that this makes. A number outside of its range becomes the nearest inside, and what is set to the value that it
    /// has makes no request again. What cannot be set is refused.
    std::string set_parameter(const std::string& name, const Json& given = Json()) {
        std::string wrong;
        const std::optional<Json> request = values_.take(graph_->parameters, name, given, wrong);
        if (!wrong.empty()) return refuse(made_id(), wrong);
        if (!request.has_value()) return values_.made.at(name);
        const std::string id = ask(*request);
        values_.made[name] = id;
        return id;
    }

    /// The value that a parameter was set to, else its first one; nothing for a trigger, and where there is none of that name.
    Json get_parameter(const std::string& name) const { return values_.get(graph_->parameters, name); }

    /// Say a line of the export, or any text.
    std::string say_line(const std::string& line) { return ask(Json::object({{"do", "say"}, {"line", line}})); }
    std::string say(const std::string& text) { return ask(Json::object({{"do", "say"}, {"text", text}})); }

    /// Say a line whose sound comes in while it is said: with each call its next samples, -1..1. The lips do what is heard in
    /// them. An id is one line's; returns it, as `ask` does. rate: samples a second, 8000 to 48000.
    std::string say_sound(const std::string& id, const List<double>& samples, double rate) {
        if (!(rate >= 8000 && rate <= 48000)) return refuse(id, "rate: should be a number from 8000 to 48000");
        auto waits = [&id](const Json& one) { return one.find("id")->text == id && one.find("do")->text == "say"; };
        const auto waiting = std::find_if(queue_.begin(), queue_.end(), waits); // of the same update
        auto same = [&id](const auto& one) { return one.first == id; };
        auto place = std::find_if(sounds_.begin(), sounds_.end(), same);
        const auto begun = plan_->track->last_speech(id);
        const bool goes_on = place != sounds_.end() && place->second.rate == rate && (begun || waiting != queue_.end());
        StreamedVoice voice = goes_on ? place->second : StreamedVoice(rate);
        if (begun) voice.follow(utterances::find_soon(now_, graph_->project->settings->lookahead) - items::find_line_start(begun));
        if (place != sounds_.end()) sounds_.erase(place);
        if (sounds_.size() == SOUNDS) sounds_.erase(sounds_.begin());
        const double from = voice.seconds;
        Json visemes = Json::list({});
        if (waiting != queue_.end()) {
            const Json* told = waiting->find("visemes");
            if (told != nullptr) visemes = *told;
            queue_.erase(waiting);
        }
        const List<Ref<VisemeMark>> marks = voice.hear(samples);
        for (const Ref<VisemeMark>& mark : marks) visemes.items.push_back(Json::list({mark->at, mark->viseme, mark->weight}));
        if (marks.empty()) visemes.items.push_back(Json::list({from, voice.shape, voice.weight})); // what goes on
        sounds_.push_back({id, voice});
        return ask(Json::object({{"do", "say"}, {"id", id}, {"visemes", visemes}, {"set", "oculus"}}));
    }

    /// Look at a named point, or at one in metres of the character's space, until the next look.
    std::string look(const std::string& name) { return ask(Json::object({{"do", "look"}, {"to", name}})); }
    std::string look(const Vec& at) { return ask(Json::object({{"do", "look"}, {"to", Json::list({at.x, at.y, at.z})}})); }

    /// Take a request back; all of them where no id is given.
    std::string withdraw(const std::string& id = "") { return ask(Json::object({{"do", "withdraw"}, {"what", id}})); }

    /// Move on to `now` seconds of the character's own time, which begins at 0, never goes backwards, and leaps an hour at
    /// most. Plans what is needed; when nothing was asked and the horizon is far enough, that is nothing.
    void update(double now) {
        if (std::isfinite(now) && now > now_) now_ = std::min(now, now_ + LEAP);
        plan_on();
        player_.set_plan(plan_);
        listen();
    }

    /// What becomes of a request.
    Answer answer(const std::string& id) const {
        for (auto one = settled_.rbegin(); one != settled_.rend(); ++one) {
            if (one->id == id) return *one;
        }
        Answer out;
        out.id = id;
        out.why = "nothing was asked for as '" + id + "'";
        if (asked_.count(id) == 0) return out;
        for (const Json& waiting : queue_) {
            if (waiting.find("id")->text != id) continue;
            out.state = "planned";
            out.why = "taken up at the next update";
            return out;
        }
        return metagraph::answer(*plan_, id);
    }

    /// What of something said was spoken until now, up to the word that was begun, and that word; "" where nothing was.
    Spoken spoken(const std::string& id) const {
        const auto [text, last_word] = spoken_so_far::spoken_until(voice::alphabet(), plan_->track->speeches, id, now_);
        return {text, last_word};
    }

    /// Break off something said because the partner speaks, hold it, go on with it, or say that no more of it comes; all of
    /// it where no id is given.
    std::string interrupt(const std::string& id = "") { return ask(Json::object({{"do", "interrupt"}, {"what", id}})); }
    std::string pause(const std::string& id = "") { return ask(Json::object({{"do", "pause"}, {"what", id}})); }
    std::string resume(const std::string& id = "") { return ask(Json::object({{"do", "resume"}, {"what", id}})); }
    std::string finish_saying(const std::string& id = "") { return ask(Json::object({{"do", "finish"}, {"what", id}})); }

    /// What began and ended since this was last asked for, in order of time, of more than 1000 the latest.
    List<Happening> events() { return std::exchange(happened_, {}); }

    /// The pose at the updated time, local, of the graph's joints; the next one overwrites it. alive: with the life layers.
    const List<Joined>& pose(bool alive = true) { return player_.pose(now_, alive); }

    /// The weights of the graph's morph targets, 0..1, in the order of its `morphs`; likewise.
    const List<double>& morphs(bool alive = true) {
        player_.morphs(now_, weights_, alive);
        return weights_;
    }

private:
    static constexpr double SLACK = 2; // seconds the horizon may fall behind before it is moved on
    static constexpr double FORGETTING = 15; // seconds between forgetting what is over
    static constexpr double LEAP = 3600; // seconds an update may move on: all that lies between is planned
    static constexpr std::size_t SOUNDS = 16; // lines whose sound is remembered
    static constexpr std::size_t REMEMBERED = 1000; // answers kept after that, and happenings nobody asked for

    Ref<const Graph> graph_;
    PlanOptions options_;
    double ahead_, recent_, now_ = 0.0;
    Ref<const Plan> plan_;
    Player player_;
    List<Json> queue_;
    Set<std::string> asked_; // ids that the plan can tell of
    List<std::pair<std::string, StreamedVoice>> sounds_; // of lines that are heard, the oldest first
    List<Answer> settled_; // of those it has forgotten or never heard of
    ParameterValues values_;
    List<double> weights_;
    List<Happening> happened_;
    int count_ = 0;
    SpeechWatch speech_;
    double seen_ = -INFINITY, forgot_ = 0.0; // when the update before was, and the last forgetting

    std::string made_id() { return lang::text("#", ++count_); }

    std::string refuse(const std::string& id, const std::string& why) {
        Answer out;
        out.id = id;
        out.why = why;
        finish(out);
        return id;
    }

    void forget_answer(const std::string& id) {
        auto same = [&id](const Answer& answer) { return answer.id == id; };
        settled_.erase(std::remove_if(settled_.begin(), settled_.end(), same), settled_.end());
    }

    /// Keep an answer that will not change any more.
    void finish(const Answer& answer) {
        asked_.erase(answer.id);
        forget_answer(answer.id);
        settled_.push_back(answer);
        if (settled_.size() > REMEMBERED) settled_.erase(settled_.begin());
    }

    void plan_on() {
        for (const std::string& what : utterances::find_forgotten(plan_->track, now_)) {
            queue_.push_back(Json::object({{"do", "finish"}, {"id", what + ".0"}, {"what", what}}));
        }
        const bool enough = plan_->end >= now_ + ahead_ - std::min(SLACK, ahead_ / 2);
        if (!queue_.empty() || !enough) {
            plan_ = hear(*graph_, *plan_, now_, queue_, enough ? plan_->end : now_ + ahead_, options_);
            for (const Json& ask : std::exchange(queue_, {})) {
                if (!lang::contains(List<std::string>{"withdraw", "interrupt", "pause", "resume", "finish"}, ask.find("do")->text)) continue;
                Answer done;
                done.id = ask.find("id")->text;
                done.state = "done";
                finish(done);
            }
        }
        if (seen_ - forgot_ < FORGETTING) return;
        forgot_ = seen_; // what has begun and ended since then is still to be told
        forget(seen_ - recent_);
    }

    /// Forget what is over, and settle the answers of what was asked for then.
    void forget(double over) {
        const Ref<const Plan> left = since(*plan_, over);
        const Set<std::string> asked = asked_;
        for (const std::string& id : asked) {
            Answer known = metagraph::answer(*plan_, id);
            // What the plan no longer knows was played; so was a look without an end that another has replaced.
            if (known.until.has_value() && (*known.until < over || !metagraph::answer(*left, id).until.has_value())) {
                known.state = "done";
                finish(known);
            } else if (known.state == "refused" || known.state == "done") {
                finish(known);
            }
        }
        plan_ = left;
    }

    /// Note what has begun or ended since the update before.
    void listen() {
        for (const std::string& layer : graph::LAYERS) {
            for (const auto& cue : plan_->layers.at(layer)->cues) {
                if (cue->start > now_) break;
                // what goes on after a cut is the same request
                note(cue->start, cue->end, layer, cue->action->name, cue->meta.substr(0, cue->meta.find('+')));
            }
        }
        for (const auto& event : speech_.watch(plan_->track->speeches, seen_, now_)) {
            happened_.push_back({event->kind, event->at, "speech", event->said, event->id, event->reason});
        }
        seen_ = now_;
        auto earlier = [](const Happening& a, const Happening& b) { return a.at < b.at; };
        std::stable_sort(happened_.begin(), happened_.end(), earlier);
        if (happened_.size() > REMEMBERED) {
            happened_.erase(happened_.begin(), happened_.end() - static_cast<std::ptrdiff_t>(REMEMBERED));
        }
    }

    void note(
        double start, double end, const std::string& layer, const std::string& action, const std::string& meta
    ) {
        if (start > seen_ && start <= now_) happened_.push_back({"begin", start, layer, action, meta, ""});
        if (end > seen_ && end <= now_) happened_.push_back({"end", end, layer, action, meta, ""});
    }
};

}  // namespace metagraph
