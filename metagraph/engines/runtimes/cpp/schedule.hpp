// When the life layers do what: drawn from the seed, event by event, then pure in time.
//
// Each event depends only on the one before it and on what is asked meanwhile, and its chance on its number. So a schedule
// grows as a plan does: what has begun stays, tick by tick gives what one call gives, and what lies behind can be forgotten.
#pragma once

#include "choice.hpp"
#include "lane.hpp"
#include "wanted.hpp"

namespace metagraph {

/// Everything that happens of itself from 0 to `end` seconds, in lanes; a lane's values stand in the order given here.
///
/// modes: place among the modes. targets: what is looked at. breaths: length s, depth. aversions: end s, right-to-left and
/// upward part of the offset (of life's angle). saccades: offset to the left and up, degrees. blinks: 0 of itself, 1 on a
/// stressed syllable, 2 asked for. drawn: seconds up to which the lanes are filled, -1 before they ever were; track: what
/// they were drawn from.
struct Schedule {
    double end = 0.0, drawn = -1.0;
    Ref<const Lane> modes = lang::made<Lane>();
    List<Ref<const GazeTarget>> targets;
    Ref<const Lane> breaths = modes, aversions = modes, saccades = modes, blinks = modes;
    Ref<const Track> track;
};

namespace schedule {

inline constexpr double BLOCK = 8; // seconds drawn at a time, so that a running plan need not draw at every tick
inline constexpr double RECALL = 4; // seconds of looks kept when the past is forgotten: longer than any turn of the head takes
inline constexpr double AFTER_BLINK = 1; // seconds a stressed syllable's blink comes after the last, at least
inline constexpr double BLINK_GAPS[] = {0.57, 0.845}; // of the mean gap: the shortest, and what chance adds to it
inline constexpr double FIXATION = 0.2; // seconds the eyes rest at least
inline constexpr double SACCADE = 1.2, LARGEST_SACCADE = 4, UPRIGHT = 0.6; // degrees on average, at most; of that, up and down
inline constexpr double AVERSION_GAPS[] = {0.6, 0.8};
inline constexpr double BETWEEN_AVERSIONS = 0.6; // seconds at least
inline constexpr double SHORTEST_AVERSION = 0.25;
inline constexpr double BREATHS[] = {0.85, 0.3}; // of the mean length and depth: the least, and what chance adds

/// How many targets begin before a time, or with `after` no later.
inline int begun_by(const List<Ref<const GazeTarget>>& targets, double time, bool after = true) {
    int out = 0;
    while (out < lang::len(targets)) {
        const double start = lang::at(targets, out)->start;
        if (start > time || (!after && start == time)) break;
        out++;
    }
    return out;
}

/// The schedule without what ended before `seconds`; what is drawn on from it stays as it would have been.
inline Ref<const Schedule> since(const Life& life, const Ref<const Schedule>& before, double seconds) {
    auto out = lang::made<Schedule>(*before);
    double needed = INFINITY;
    bool idle = false;
    // Gaps run in modes' time from the event before, so the modes since then are needed.
    auto kept = [&](Ref<const Lane>& lane, double rate) {
        lane = lane::since(lane, seconds);
        if (lane->empty()) idle = idle || before->drawn < 0 || rate > 0;
        else needed = std::min(needed, lane->starts.front());
    };
    kept(out->breaths, life.breath_rate);
    kept(out->aversions, life.aversion_rate);
    kept(out->saccades, life.saccade_rate);
    kept(out->blinks, life.blinks);
    needed = idle ? 0 : needed == INFINITY ? seconds : needed;
    out->targets = lang::part(before->targets, std::max(0, begun_by(before->targets, std::min(needed, seconds - RECALL)) - 1));
    out->modes = lane::since(before->modes, needed, 0);
    return out;
}

/// One extension: lanes filled from `cut` to `drawn`.
class Draw {
public:
    Ref<const Lane> modes;
    List<Ref<const GazeTarget>> targets;

    Draw(
        const Life& life, const Map<std::string, Ref<Voice>>& voices, const Track& track, std::uint32_t seed, double cut,
        double drawn, const Schedule& before
    )
        : life_(life), voices_(voices), track_(track), seed_(seed), cut_(cut), drawn_(drawn), calm_(1 - life.stillness) {
        modes = lane::until(before.modes, cut);
        const int last = modes->empty() ? -1 : static_cast<int>(modes->values.back()[0]);
        List<double> starts;
        List<List<double>> values;
        for (const auto& [at, mode] : wanted::modes_between(track, cut, drawn)) {
            if (starts.empty() && at == cut && mode == last) continue;
            starts.push_back(at);
            values.push_back({static_cast<double>(mode)});
        }
        modes = lane::plus(modes, starts, values);
        targets = lang::part(before.targets, 0, begun_by(before.targets, cut, false));
        for (const auto& target : wanted::targets_between(track, cut, drawn)) {
            if (targets.empty() || !target->like(*targets.back())) targets.push_back(target);
        }
    }

    /// Lay modes and strict looks out in one row of segments.
    void begin(double cut) {
        cut_ = cut;
        Set<double> edges(modes->starts.begin(), modes->starts.end());
        for (std::size_t n = 0; n < targets.size(); n++) {
            if (n == 0 || targets[n]->strict != targets[n - 1]->strict) edges.insert(targets[n]->start);
        }
        for (const double edge : edges) {
            const int mode = std::max(0, lang::bisect_right(modes->starts, edge) - 1);
            edges_.push_back(edge);
            manners_.push_back(lang::at(life_.manners, static_cast<int>(lang::at(modes->values, mode)[0])));
            strict_.push_back(lang::at(targets, std::max(0, begun_by(targets, edge) - 1))->strict);
        }
    }

    /// Each breath follows the one before; the first began before time 0, so that not everybody breathes alike.
    Ref<const Lane> breaths(const Ref<const Lane>& lane) const {
        List<double> starts;
        List<List<double>> values;
        std::optional<double> at;
        if (!lane->empty()) at = lane->starts.back() + lane->values.back()[0];
        for (int n = lane->next();;) {
            if (at.has_value()) at = std::max(*at, cut_);
            const Manner& ways = manner(at.value_or(0));
            const double rate = life_.breath_rate * ways.breath_rate / 60;
            if (rate <= 0) { // no breath until another mode begins
                const int later = lang::bisect_right(edges_, at.value_or(0));
                if (life_.breath_rate <= 0 || later == lang::len(edges_)) break;
                at = lang::at(edges_, later);
                continue;
            }
            double length = (BREATHS[0] + BREATHS[1] * chance({"breath", lang::text(n), "length"})) / rate;
            length *= 1 + 2 * life_.stillness; // slower, too, but never halting
            const double depth = ways.breathing * (BREATHS[0] + BREATHS[1] * chance({"breath", lang::text(n), "depth"}));
            if (!at.has_value()) at = -length * chance({"breath", "first"});
            if (*at >= drawn_) break;
            starts.push_back(*at);
            values.push_back({length, depth});
            at = *at + length;
            n++;
        }
        return lane::plus(lane, starts, values);
    }

    Ref<const Lane> saccades(const Ref<const Lane>& lane) const {
        if (life_.saccade_rate <= 0 || calm_ <= 0) return lane;
        const double mean = std::max(60 / life_.saccade_rate, FIXATION + 0.01);
        return one_by_one(lane, lane->empty() ? 0 : lane->starts.back(), [&](const std::string& n, double last) {
            const double need = FIXATION + (mean - FIXATION) * std::min(4.0, -std::log(chance({"saccade", n, "gap"})));
            const double at = std::max(cut_, after(last, need, [&](const Manner& ways, bool) { return ways.saccade_rate * calm_; }));
            double size = std::min(LARGEST_SACCADE, -SACCADE * std::log(chance({"saccade", n, "size"})));
            size *= at < INFINITY ? manner(at).saccades : 0;
            return Event{at, way("saccade", n, size), at};
        });
    }

    Ref<const Lane> aversions(const Ref<const Lane>& lane) const {
        if (life_.aversion_rate <= 0 || life_.aversion_length <= 0 || life_.aversion_angle <= 0 || calm_ <= 0) return lane;
        auto speed = [&](const Manner& ways, bool strict) {
            const double rate = life_.aversion_rate * ways.aversion_rate;
            if (strict || rate <= 0) return 0.0;
            return calm_ / std::max(BETWEEN_AVERSIONS, 60 / rate - life_.aversion_length * ways.aversion_length);
        };
        return one_by_one(lane, lane->empty() ? 0 : lane->values.back()[0], [&](const std::string& n, double last) {
            const double need = AVERSION_GAPS[0] + AVERSION_GAPS[1] * chance({"aversion", n, "gap"});
            const double at = std::max({cut_, last + BETWEEN_AVERSIONS, after(last, need, speed)});
            const Manner& ways = at < INFINITY ? manner(at) : life_.manners.front();
            const double length = life_.aversion_length * ways.aversion_length * (0.6 + 0.8 * chance({"aversion", n, "length"}));
            const double end = at + std::max(SHORTEST_AVERSION, length);
            const double size = ways.aversion_angle * (0.7 + 0.6 * chance({"aversion", n, "size"}));
            return Event{at, lang::together(List<double>{end}, way("aversion", n, size)), end};
        });
    }

    Ref<const Lane> blinks(const Ref<const Lane>& lane) const {
        const double shut = life_.blink_close + life_.blink_open;
        const double mean = life_.blinks > 0 && calm_ > 0 ? 60 / life_.blinks : INFINITY;
        double last = lane->empty() ? -0.5 * std::min(mean, 10.0) * chance({"blink", "first"}) : lane->starts.back();
        const List<std::pair<double, bool>> stressed = accents(std::max(0.0, std::min(cut_, last)));
        // A stressed syllable may bring a blink: the first of a speech always, the others some time after the last blink.
        auto suits = [&](const std::pair<double, bool>& one) {
            return one.first >= cut_ && one.first >= last + (one.second ? shut + 0.1 : AFTER_BLINK / calm_);
        };
        List<double> asked;
        for (const auto& blink : track_.blinks()) asked.push_back(blink->start);
        List<double> starts;
        List<List<double>> values;
        std::size_t place = 0;
        for (int n = lane->next();; n++) {
            const double need = mean * (BLINK_GAPS[0] + BLINK_GAPS[1] * chance({"blink", lang::text(n), "gap"}));
            double own = INFINITY;
            if (need < INFINITY) {
                own = std::max(cut_, after(last, need, [&](const Manner& ways, bool) { return ways.blinks * calm_; }));
            }
            while (place < stressed.size() && !suits(stressed[place])) place++;
            const double accent = place < stressed.size() ? stressed[place].first : INFINITY;
            const int wish = lang::bisect_left(asked, std::max(cut_, last + shut));
            const double wanted = wish < lang::len(asked) ? lang::at(asked, wish) : INFINITY;
            const double at = std::min({own, accent, wanted});
            if (at >= drawn_) return lane::plus(lane, starts, values);
            starts.push_back(at);
            values.push_back({at == wanted ? 2.0 : at == accent ? 1.0 : 0.0});
            last = at;
        }
    }

private:
    /// An event: when, what, and where the next gap begins.
    struct Event {
        double at;
        List<double> value;
        double next;
    };

    const Life& life_;
    const Map<std::string, Ref<Voice>>& voices_;
    const Track& track_;
    std::uint32_t seed_;
    double cut_, drawn_, calm_;
    List<double> edges_;
    List<Manner> manners_;
    List<char> strict_;

    double chance(const List<std::string>& words) const { return choice::uniform(seed_, words); }

    int place_at(double seconds) const { return std::max(0, lang::bisect_right(edges_, seconds) - 1); }
    const Manner& manner(double seconds) const { return lang::at(manners_, place_at(seconds)); }

    /// Return when `need` has passed since `seconds`, for a clock that runs at `speed(manner, strict)`; infinity where not
    /// before the end.
    template <class Speed>
    double after(double seconds, double need, Speed speed) const {
        for (int place = place_at(seconds); seconds < drawn_; place++) {
            const double end = place + 1 < lang::len(edges_) ? lang::at(edges_, place + 1) : drawn_;
            const double rate = speed(lang::at(manners_, place), lang::at(strict_, place) != 0);
            if (rate > 0 && seconds + need / rate < end) return seconds + need / rate;
            need -= rate * std::max(0.0, end - seconds);
            seconds = end;
        }
        return INFINITY;
    }

    /// Return an offset of a size in a random direction, more often to the sides: to the left and up.
    List<double> way(const std::string& what, const std::string& n, double size) const {
        const double turn = 2 * lang::PI * chance({what, n, "way"});
        return {size * std::sin(turn + lang::PI / 2), UPRIGHT * size * std::sin(turn)};
    }

    /// Return the stressed syllables from `start` to the end that may bring blinks, and whether each is a speech's first.
    List<std::pair<double, bool>> accents(double start) const {
        List<std::pair<double, bool>> out;
        if (!(calm_ > 0 && life_.accent_blinks > 0)) return out;
        for (const auto& speech : track_.speeches()) {
            if (speech->end <= start || speech->start >= drawn_) continue;
            const Ref<Voice> voice = voice_of(voices_, *speech);
            for (int n = 0; n < lang::len(voice->accents); n++) {
                const double at = speech->start + lang::at(voice->accents, n);
                const bool inside = start <= at && at < std::min(speech->end, drawn_);
                if (inside && chance({speech->id, "accent", lang::text(n)}) < life_.accent_blinks) out.emplace_back(at, n == 0);
            }
        }
        return out;
    }

    /// Draw events until the end.
    template <class Next>
    Ref<const Lane> one_by_one(const Ref<const Lane>& lane, double last, Next next) const {
        List<double> starts;
        List<List<double>> values;
        for (int n = lane->next();; n++) {
            const Event event = next(lang::text(n), last);
            if (!(event.at < drawn_)) return lane::plus(lane, starts, values);
            starts.push_back(event.at);
            values.push_back(event.value);
            last = event.next;
        }
    }
};

/// Return the schedule to `end` seconds. What `before` holds that begins before `now` stays exactly as it was; what it holds
/// for later is kept, too, where nothing it was drawn from has changed.
inline Ref<const Schedule> extended(
    const Life& life, const Map<std::string, Ref<Voice>>& voices, const Ref<const Track>& track, std::uint32_t seed, double end,
    const Ref<const Schedule>& before, double now
) {
    auto out = lang::made<Schedule>(*before);
    out->end = end;
    out->track = track;
    if (!life.on) return out;
    out->drawn = std::max(BLOCK, std::ceil(end / BLOCK) * BLOCK);
    const bool known = before->drawn >= 0;
    auto alike = [&](Item::Kind kind) { return track::alike(*before->track, *track, kind); };
    const bool only_places = known && alike(Item::look) && alike(Item::speech) && alike(Item::mode_from) && alike(Item::blink);
    const bool same = only_places && alike(Item::place) && alike(Item::stay);
    if (same && out->drawn == before->drawn) return out;
    const double old = std::max(0.0, before->drawn);
    const double cut = std::max(0.0, std::min(old, same ? out->drawn : now));
    const double first = only_places && !same ? std::min(old, out->drawn) : cut;
    Draw draw(life, voices, *track, seed, cut, out->drawn, *before);
    out->breaths = lane::until(before->breaths, first);
    out->aversions = lane::until(before->aversions, first);
    out->saccades = lane::until(before->saccades, first);
    out->blinks = lane::until(before->blinks, first);
    if (first < out->drawn) {
        draw.begin(first);
        out->breaths = draw.breaths(out->breaths);
        out->aversions = draw.aversions(out->aversions);
        out->saccades = draw.saccades(out->saccades);
        out->blinks = draw.blinks(out->blinks);
    }
    out->modes = draw.modes;
    out->targets = draw.targets;
    return out;
}

}  // namespace schedule
}  // namespace metagraph
