// The events of the life layers: drawn from the seed one by one, and then a function of time.
//
// Each event depends only on the previous one and on the requests meanwhile; its random draw depends on its number. So
// a schedule grows as a plan does: events that have begun stay, many short extensions give the same as one long one,
// and past events can be forgotten.
//
// Translated from metagraph/playback/life/schedule.py; change that, and translate anew.
#pragma once

#include "life.hpp"
#include "words.hpp"
#include "expressions.hpp"
#include "items.hpp"
#include "lane.hpp"
#include "track.hpp"
#include "voice.hpp"
#include "wanted.hpp"
#include "choice.hpp"
#include "mood.hpp"
#include "life.hpp"
#include "voice.hpp"
#include "language.hpp"

namespace metagraph {

struct Schedule;
struct LifeDraw;

namespace schedule {

inline constexpr double BLOCK = 8.0; // seconds drawn at a time, so that a running plan need not draw at every tick
// seconds of looks kept when the past is forgotten: longer than any turn of the head takes
inline constexpr double RECALL = 4.0;
// Blinks: on stressed syllables at least so many seconds after the last (Yang et al., section 7.3); of
// themselves after gaps that spread as people's do, log-normal, a few of them doubles.
inline constexpr double AFTER_BLINK = 1.0;
inline constexpr double BLINK_SPREAD = 0.7; // standard deviation of the gaps, times their mean
inline constexpr double DOUBLES = 0.06; // share of blinks that follow the one before at once
inline constexpr double DOUBLE = 0.4; // seconds after which they do
inline constexpr double HALVES = 0.12; // share of blinks by themselves that are incomplete
inline constexpr double HALF = 0.6; // how far these shut the eyes
// Saccades: fixations last 0.2 s and more; sizes fall off as in "Eyes Alive", small ones only: the eyes stay
// with what they look at.
inline constexpr double FIXATION = 0.2;
inline constexpr double SACCADE = 1.2; // degrees on average
inline constexpr double LARGEST_SACCADE = 4.0; // degrees
inline constexpr double UPRIGHT = 0.6; // how much of an offset goes up and down
// Aversions: at somewhat regular intervals, in a random direction, more often to the sides.
inline constexpr double AVERSION_GAP = 0.6;
inline constexpr double AVERSION_CHANCE = 0.8;
inline constexpr double BETWEEN_AVERSIONS = 0.6; // seconds at least
inline constexpr double SHORTEST_AVERSION = 0.25;
inline constexpr double BREATH = 0.85; // of the mean length and depth: the least
inline constexpr double BREATH_CHANCE = 0.3; // and what chance adds
// A character breathes in before it speaks: a breath begins so long before the first word, and the one before
// it is shortened or drawn out by so much of its length at most. Ours.
inline constexpr double BREATHES_IN = 0.55; // seconds
inline constexpr double STRETCH = 0.5;
inline Ref<Schedule> schedule(
    const Ref<Life>& life,
    const Ref<Track>& track,
    const Ref<Voices>& voices,
    std::uint32_t seed,
    double end,
    const Ref<Schedule>& before,
    double now
);
inline std::string _change(
    const Ref<Schedule>& before,
    const Ref<Life>& life,
    const Ref<Track>& track,
    const Ref<Voices>& voices,
    std::uint32_t seed
);
inline Ref<LifeDraw> _draw(
    const Ref<Life>& life,
    const Ref<Track>& track,
    const Ref<Voices>& voices,
    std::uint32_t seed,
    double cut,
    double drawn,
    const Ref<Schedule>& before
);

}  // namespace schedule

/// Everything that the life layers do by themselves from 0 to `end` seconds, in lanes. The columns of a lane's rows are
/// listed here.
///
/// modes: index in MODES. moods: valence, arousal, intensity. targets: what the gaze looks at. breaths: length s,
/// depth. aversions: end s, right-to-left and upward part of the offset (of life's angle). saccades: offset to the left
/// and up, degrees. blinks: 0 spontaneous, 1 on a stressed syllable, 2 requested, 3 spontaneous and incomplete. swells,
/// emphases: of the face (`expressions`). drawn: seconds up to which the lanes are filled; the rest is what they were
/// drawn from.
struct Schedule {
    double end;
    double drawn;
    Ref<Lane> modes;
    Ref<Lane> moods;
    List<Ref<GazeTarget>> targets;
    Ref<Lane> breaths;
    Ref<Lane> aversions;
    Ref<Lane> saccades;
    Ref<Lane> blinks;
    Ref<Lane> swells;
    Ref<Lane> emphases;
    Ref<Life> life;
    Ref<Track> track;
    Ref<Voices> voices;
    std::uint32_t seed;

    explicit Schedule(
        double end_ = 0.0,
        double drawn_ = 0.0,
        Ref<Lane> modes_ = lang::made<Lane>(List<double>{}, List<List<double>>{}, 0, 1),
        Ref<Lane> moods_ = lang::made<Lane>(List<double>{}, List<List<double>>{}, 0, 3),
        List<Ref<GazeTarget>> targets_ = List<Ref<GazeTarget>>{},
        Ref<Lane> breaths_ = lang::made<Lane>(List<double>{}, List<List<double>>{}, 0, 2),
        Ref<Lane> aversions_ = lang::made<Lane>(List<double>{}, List<List<double>>{}, 0, 3),
        Ref<Lane> saccades_ = lang::made<Lane>(List<double>{}, List<List<double>>{}, 0, 2),
        Ref<Lane> blinks_ = lang::made<Lane>(List<double>{}, List<List<double>>{}, 0, 1),
        Ref<Lane> swells_ = lang::made<Lane>(List<double>{}, List<List<double>>{}, 0, 3),
        Ref<Lane> emphases_ = lang::made<Lane>(List<double>{}, List<List<double>>{}, 0, 3),
        Ref<Life> life_ = nullptr,
        Ref<Track> track_ = nullptr,
        Ref<Voices> voices_ = nullptr,
        std::uint32_t seed_ = 0
    )
        : end(end_),
            drawn(drawn_),
            modes(std::move(modes_)),
            moods(std::move(moods_)),
            targets(std::move(targets_)),
            breaths(std::move(breaths_)),
            aversions(std::move(aversions_)),
            saccades(std::move(saccades_)),
            blinks(std::move(blinks_)),
            swells(std::move(swells_)),
            emphases(std::move(emphases_)),
            life(std::move(life_)),
            track(std::move(track_)),
            voices(std::move(voices_)),
            seed(seed_) {}

    /// Return the schedule without events that ended before `seconds`; later draws do not change.
    Ref<Schedule> since(double seconds) const;
};

/// One extension: lanes filled from `cut` to `drawn` seconds. edges: when modes, moods or strict looks change; manners:
/// the factors of the amounts from each edge on; strict: 1 if the look is strict from there on, else 0. phrases: when
/// the character begins to speak.
struct LifeDraw {
    Ref<Life> life;
    Ref<Track> track;
    Ref<Voices> voices;
    std::uint32_t seed;
    double cut;
    double drawn;
    double calm;
    Ref<Lane> modes;
    Ref<Lane> moods;
    List<Ref<GazeTarget>> targets;
    List<double> edges;
    List<Ref<Manner>> manners;
    List<int> strict;
    List<double> phrases;

    LifeDraw(
        Ref<Life> life_,
        Ref<Track> track_,
        Ref<Voices> voices_,
        std::uint32_t seed_,
        double cut_,
        double drawn_,
        double calm_,
        Ref<Lane> modes_,
        Ref<Lane> moods_,
        List<Ref<GazeTarget>> targets_,
        List<double> edges_ = List<double>{},
        List<Ref<Manner>> manners_ = List<Ref<Manner>>{},
        List<int> strict_ = List<int>{},
        List<double> phrases_ = List<double>{}
    )
        : life(std::move(life_)),
            track(std::move(track_)),
            voices(std::move(voices_)),
            seed(seed_),
            cut(cut_),
            drawn(drawn_),
            calm(calm_),
            modes(std::move(modes_)),
            moods(std::move(moods_)),
            targets(std::move(targets_)),
            edges(std::move(edges_)),
            manners(std::move(manners_)),
            strict(std::move(strict_)),
            phrases(std::move(phrases_)) {}

    /// Combine modes, moods and strict looks into one list of segments.
    void begin(double cut);

    /// Return the key of an event's random numbers, for `chance_of`.
    std::uint32_t key(const std::string& what, int number);

    /// Return the index of the segment that contains a time.
    int place_at(double seconds);

    /// Return whether the character is thinking at a time: then it looks up and aside, never down.
    bool thinks(double seconds);

    /// Return when `need` seconds have passed since `seconds` on a clock that runs at these rates, one for each
    /// segment; infinity if that is after the end.
    double after(double seconds, double need, const List<double>& rates);

    /// Draw breaths, each after the previous one. The first began before time 0, so that characters do not breathe in
    /// step.
    Ref<Lane> breaths(const Ref<Lane>& lane);

    /// Return the length of a breath that begins at `at`, so that the next one begins right before the character
    /// speaks.
    double to_phrase(double at, double length);

    /// Draw the small jumps of the eyes.
    Ref<Lane> saccades(const Ref<Lane>& lane);

    /// Draw short looks away.
    Ref<Lane> aversions(const Ref<Lane>& lane);

    /// Draw blinks: spontaneous ones, those on stressed syllables and requested ones, in the order in which they come.
    Ref<Lane> blinks(const Ref<Lane>& lane);

    /// Return the stressed syllables from `start` to the end that may bring blinks, and whether each is a speech's
    /// first.
    List<std::tuple<double, bool>> accents(double start);
};

inline Ref<Schedule> Schedule::since(double seconds) const {
    Ref<Lane> breaths = this->breaths->since(seconds);
    Ref<Lane> aversions = this->aversions->since(seconds);
    Ref<Lane> saccades = this->saccades->since(seconds);
    Ref<Lane> blinks = this->blinks->since(seconds);
    List<double> rates = List<double>{1.0, 1.0, 1.0, 1.0};
    if (this->life != nullptr) {
        rates = List<double>{
            this->life->breath_rate,
            this->life->aversion_rate,
            this->life->saccade_rate,
            this->life->blinks
        };
    }
    // Gaps run in modes' time from the event before, so the modes since then are needed.
    List<Ref<Lane>> lanes = List<Ref<Lane>>{breaths, aversions, saccades, blinks};
    List<double> firsts;
    for (const auto& kept : lanes) {
        if (lang::len(kept->times) > 0) {
            firsts.push_back(lang::at(kept->times, 0));
        }
    }
    double needed = lang::len(firsts) > 0 ? lang::min_of(firsts) : seconds;
    bool is_any = false;
    for (int n = 0; n < lang::len(lanes); n++) {
        const auto& kept = lang::at(lanes, n);
        const auto& rate = lang::at(rates, n);
        if (lang::len(kept->times) == 0 && rate > 0) {
            is_any = true;
            break;
        }
    }
    if (is_any) {
        needed = 0.0;
    }
    List<double> found;
    for (const auto& t : this->targets) {
        found.push_back(t->start);
    }
    int looked = lang::bisect_right(found, std::min(needed, seconds - schedule::RECALL)) - 1;
    return lang::made<Schedule>(
        this->end,
        this->drawn,
        this->modes->since(needed, 0),
        this->moods->since(std::min(needed, seconds - schedule::RECALL), 0),
        lang::part(this->targets, std::max(0, looked)),
        breaths,
        aversions,
        saccades,
        blinks,
        this->swells->since(seconds),
        this->emphases->since(seconds, 3),
        this->life,
        this->track,
        this->voices,
        this->seed
    );
}

inline void LifeDraw::begin(double cut) {
    this->cut = cut;
    List<double> talks;
    for (const auto& change : this->track->modes) {
        if (change->mode == "talking") {
            talks.push_back(change->start);
        }
    }
    List<double> found;
    for (const auto& speech : this->track->speeches) {
        found.push_back(speech->start);
    }
    this->phrases = lang::in_order(lang::together(found, talks));
    List<double> edges = this->modes->times;
    lang::extend(edges, this->moods->times);
    for (int n = 0; n < lang::len(this->targets); n++) {
        const auto& target = lang::at(this->targets, n);
        if (n == 0 || target->strict != lang::at(this->targets, n - 1)->strict) {
            edges.push_back(target->start);
        }
    }
    List<double> begun;
    for (const auto& t : this->targets) {
        begun.push_back(t->start);
    }
    for (const auto& edge : lang::in_order(edges)) {
        if (lang::len(this->edges) > 0 && lang::at(this->edges, -1) == edge) {
            continue;
        }
        int mode = std::max(0, lang::bisect_right(this->modes->times, edge) - 1);
        int look = std::max(0, lang::bisect_right(begun, edge) - 1);
        this->edges.push_back(edge);
        List<double> felt = lang::at(this->moods->rows, std::max(0, lang::bisect_right(this->moods->times, edge) - 1));
        Ref<Manner> ways = life::get_manner(
            this->life,
            lang::at(words::MODES, static_cast<int>(lang::at(lang::at(this->modes->rows, mode), 0)))
        );
        this->manners.push_back(wanted::ways_in(
            ways,
            lang::made<Mood>(lang::at(felt, 0), lang::at(felt, 1), lang::at(felt, 2))
        ));
        this->strict.push_back(lang::at(this->targets, look)->strict ? 1 : 0);
    }
}

inline std::uint32_t LifeDraw::key(const std::string& what, int number) {
    return choice::keyed(this->seed, List<std::string>{what, lang::text(number)});
}

inline int LifeDraw::place_at(double seconds) {
    return std::max(0, lang::bisect_right(this->edges, seconds) - 1);
}

inline bool LifeDraw::thinks(double seconds) {
    int mode = std::max(0, lang::bisect_right(this->modes->times, seconds) - 1);
    return lang::at(words::MODES, static_cast<int>(lang::at(lang::at(this->modes->rows, mode), 0))) == "thinking";
}

inline double LifeDraw::after(double seconds, double need, const List<double>& rates) {
    double at = seconds;
    double left = need;
    int place = this->place_at(at);
    while (at < this->drawn) {
        double end = place + 1 < lang::len(this->edges) ? lang::at(this->edges, place + 1) : this->drawn;
        double rate = lang::at(rates, place);
        if (rate > 0 && at + left / rate < end) {
            return at + left / rate;
        }
        left -= rate * std::max(0.0, end - at);
        at = end;
        place += 1;
    }
    return INFINITY;
}

inline Ref<Lane> LifeDraw::breaths(const Ref<Lane>& lane) {
    List<double> times;
    List<List<double>> rows;
    int number = lane->next();
    bool begun = lang::len(lane->times) > 0;
    double at = begun ? lang::at(lane->times, -1) + lang::at(lang::at(lane->rows, -1), 0) : 0.0;
    while (true) {
        if (begun) {
            at = std::max(at, this->cut);
        }
        Ref<Manner> ways = lang::at(this->manners, this->place_at(at));
        double rate = this->life->breath_rate * ways->breath_rate / 60.0;
        if (rate <= 0) { // no breath until another mode begins
            int later = lang::bisect_right(this->edges, at);
            if (this->life->breath_rate <= 0 || later == lang::len(this->edges)) {
                break;
            }
            at = lang::at(this->edges, later);
            begun = true;
            continue;
        }
        int key = this->key("breath", number);
        double length = (schedule::BREATH + schedule::BREATH_CHANCE * choice::chance_of(key, "length")) / rate;
        length *= 1.0 + 2.0 * this->life->stillness; // slower, too, but never halting
        length = begun ? this->to_phrase(at, length) : length;
        double depth = ways->breathing * (schedule::BREATH + schedule::BREATH_CHANCE * choice::chance_of(key, "depth"));
        if (!begun) {
            at = -length * choice::uniform(this->seed, List<std::string>{"breath", "first"});
            begun = true;
        }
        if (at >= this->drawn) {
            break;
        }
        times.push_back(at);
        rows.push_back(List<double>{length, depth});
        at += length;
        number += 1;
    }
    return lane->plus(times, rows);
}

inline double LifeDraw::to_phrase(double at, double length) {
    int place = lang::bisect_left(this->phrases, at + (1.0 - schedule::STRETCH) * length + schedule::BREATHES_IN);
    if (place == lang::len(this->phrases)) {
        return length;
    }
    double wanted = lang::at(this->phrases, place) - schedule::BREATHES_IN - at;
    return wanted <= (1.0 + schedule::STRETCH) * length ? wanted : length;
}

inline Ref<Lane> LifeDraw::saccades(const Ref<Lane>& lane) {
    if (this->life->saccade_rate <= 0 || this->calm <= 0) {
        return lane;
    }
    double mean = std::max(60.0 / this->life->saccade_rate, schedule::FIXATION + 0.01);
    List<double> rates;
    for (const auto& ways : this->manners) {
        rates.push_back(ways->saccade_rate * this->calm);
    }
    List<double> times;
    List<List<double>> rows;
    int number = lane->next();
    double last = lang::len(lane->times) > 0 ? lang::at(lane->times, -1) : 0.0;
    while (true) {
        int key = this->key("saccade", number);
        double need = schedule::FIXATION
            + (mean - schedule::FIXATION) * std::min(4.0, -std::log(choice::chance_of(key, "gap")));
        last = std::max(this->cut, this->after(last, need, rates));
        if (!(last < this->drawn)) {
            return lane->plus(times, rows);
        }
        double size = std::min(
            schedule::LARGEST_SACCADE,
            -schedule::SACCADE * std::log(choice::chance_of(key, "size"))
        );
        size *= lang::at(this->manners, this->place_at(last))->saccades;
        double turn = 2.0 * lang::PI * choice::chance_of(key, "way");
        times.push_back(last);
        rows.push_back(List<double>{size * std::sin(turn + lang::PI / 2.0), schedule::UPRIGHT * size * std::sin(turn)});
        number += 1;
    }
}

inline Ref<Lane> LifeDraw::aversions(const Ref<Lane>& lane) {
    Ref<Life> life = this->life;
    if (life->aversion_rate <= 0 || life->aversion_length <= 0 || life->aversion_angle <= 0 || this->calm <= 0) {
        return lane;
    }
    List<double> rates;
    for (int n = 0; n < lang::len(this->manners); n++) {
        const auto& ways = lang::at(this->manners, n);
        const auto& strict = lang::at(this->strict, n);
        double rate = life->aversion_rate * ways->aversion_rate;
        if (strict == 1 || rate <= 0) {
            rates.push_back(0.0);
        } else {
            double mean = std::max(
                schedule::BETWEEN_AVERSIONS,
                60.0 / rate - life->aversion_length * ways->aversion_length
            );
            rates.push_back(this->calm / mean);
        }
    }
    List<double> times;
    List<List<double>> rows;
    int number = lane->next();
    double last = lang::len(lane->rows) > 0 ? lang::at(lang::at(lane->rows, -1), 0) : 0.0;
    while (true) {
        int key = this->key("aversion", number);
        double need = schedule::AVERSION_GAP + schedule::AVERSION_CHANCE * choice::chance_of(key, "gap");
        double at = std::max(this->cut, std::max(last + schedule::BETWEEN_AVERSIONS, this->after(last, need, rates)));
        if (!(at < this->drawn)) {
            return lane->plus(times, rows);
        }
        Ref<Manner> own = lang::at(this->manners, this->place_at(at));
        double length = life->aversion_length * own->aversion_length;
        length *= 0.6 + 0.8 * choice::chance_of(key, "length");
        last = at + std::max(schedule::SHORTEST_AVERSION, length);
        double size = own->aversion_angle * (0.7 + 0.6 * choice::chance_of(key, "size"));
        double turn = 2.0 * lang::PI * choice::chance_of(key, "way");
        double up = schedule::UPRIGHT * size * std::sin(turn);
        times.push_back(at);
        rows.push_back(List<double>{
            last,
            size * std::sin(turn + lang::PI / 2.0),
            this->thinks(at) ? std::abs(up) : up
        });
        number += 1;
    }
}

inline Ref<Lane> LifeDraw::blinks(const Ref<Lane>& lane) {
    Ref<Life> life = this->life;
    double shut = life->blink_close + life->blink_open;
    double mean = (life->blinks > 0 && this->calm > 0) ? 60.0 / life->blinks : INFINITY;
    List<double> rates;
    for (const auto& ways : this->manners) {
        rates.push_back(ways->blinks * this->calm);
    }
    double last = -0.5 * std::min(mean, 10.0) * choice::uniform(this->seed, List<std::string>{"blink", "first"});
    if (lang::len(lane->times) > 0) {
        last = lang::at(lane->times, -1);
    }
    List<std::tuple<double, bool>> accents;
    if (this->calm > 0 && life->accent_blinks > 0) {
        accents = this->accents(std::max(0.0, std::min(this->cut, last)));
    }
    List<double> asked;
    for (const auto& b : this->track->blinks) {
        asked.push_back(b->start);
    }
    List<double> times;
    List<List<double>> rows;
    int number = lane->next();
    int place = 0;
    while (true) {
        double own = INFINITY;
        if (mean < INFINITY) {
            int key = this->key("blink", number);
            double drawn = choice::log_normal(
                mean,
                schedule::BLINK_SPREAD * mean,
                choice::chance_of(key, "gap"),
                choice::chance_of(key, "gap2")
            );
            double need = choice::chance_of(key, "double") < schedule::DOUBLES
                ? schedule::DOUBLE
                : std::max(schedule::DOUBLE, drawn);
            own = std::max(this->cut, this->after(last, need, rates));
        }
        // A stressed syllable may bring a blink: the first of a speech always, the others some time after
        // the last blink.
        while (place < lang::len(accents)) {
            auto [accent, first] = lang::at(accents, place);
            if (accent >= this->cut && accent >= last + (first ? shut + 0.1 : schedule::AFTER_BLINK / this->calm)) {
                break;
            }
            place += 1;
        }
        double heard = place < lang::len(accents) ? std::get<0>(lang::at(accents, place)) : INFINITY;
        int wish = lang::bisect_left(asked, std::max(this->cut, last + shut));
        double wanted = wish < lang::len(asked) ? lang::at(asked, wish) : INFINITY;
        double at = std::min(own, std::min(heard, wanted));
        if (at >= this->drawn) {
            return lane->plus(times, rows);
        }
        times.push_back(at);
        double kind = at == heard ? 1.0 : 0.0;
        if (at == own && at != heard && choice::chance_of(this->key("blink", number), "half") < schedule::HALVES) {
            kind = 3.0;
        }
        rows.push_back(List<double>{at == wanted ? 2.0 : kind});
        last = at;
        number += 1;
    }
}

inline List<std::tuple<double, bool>> LifeDraw::accents(double start) {
    List<std::tuple<double, bool>> out;
    for (const auto& speech : this->track->speeches) {
        if (speech->end <= start || speech->start >= this->drawn) {
            continue;
        }
        double end = std::min(speech->end, this->drawn);
        for (int n = 0; n < lang::len(voice::stressed(this->voices, speech)); n++) {
            const auto& peak = lang::at(voice::stressed(this->voices, speech), n);
            double at = items::find_line_start(speech) + peak;
            if (at < std::max(start, speech->start) || at >= end) {
                continue;
            }
            if (n == 0
                || choice::uniform(this->seed, List<std::string>{speech->id, "accent", lang::text(n)})
                    < this->life->accent_blinks) {
                out.push_back(std::tuple<double, bool>{at, n == 0});
            }
        }
    }
    return out;
}

namespace schedule {

/// Return the schedule to `end` seconds. Events of `before` that begin before `now` stay exactly as they were.
///
/// Its later events stay, too, if nothing that they were drawn from has changed.
inline Ref<Schedule> schedule(
    const Ref<Life>& life,
    const Ref<Track>& track,
    const Ref<Voices>& voices,
    std::uint32_t seed,
    double end,
    const Ref<Schedule>& before,
    double now
) {
    if (!life->on) {
        return lang::made<Schedule>(
            end,
            before->drawn,
            before->modes,
            before->moods,
            before->targets,
            before->breaths,
            before->aversions,
            before->saccades,
            before->blinks,
            before->swells,
            before->emphases,
            life,
            track,
            voices,
            seed
        );
    }
    double drawn = std::max(schedule::BLOCK, static_cast<int>(std::ceil(end / schedule::BLOCK)) * schedule::BLOCK);
    std::string change = schedule::_change(before, life, track, voices, seed);
    if (change == "" && drawn == before->drawn) {
        return lang::made<Schedule>(
            end,
            before->drawn,
            before->modes,
            before->moods,
            before->targets,
            before->breaths,
            before->aversions,
            before->saccades,
            before->blinks,
            before->swells,
            before->emphases,
            before->life,
            before->track,
            before->voices,
            before->seed
        );
    }
    double cut = std::max(0.0, std::min(before->drawn, change == "" ? drawn : now));
    double chance = change == "places" ? std::min(before->drawn, drawn) : cut;
    Ref<LifeDraw> draw = schedule::_draw(life, track, voices, seed, cut, drawn, before);
    Ref<Lane> breaths = before->breaths->until(chance);
    Ref<Lane> aversions = before->aversions->until(chance);
    Ref<Lane> saccades = before->saccades->until(chance);
    Ref<Lane> blinks = before->blinks->until(chance);
    Ref<Lane> swells = before->swells->until(chance);
    Ref<Lane> emphases = before->emphases->until(chance);
    if (chance < drawn) {
        draw->begin(chance);
        breaths = draw->breaths(breaths);
        aversions = draw->aversions(aversions);
        saccades = draw->saccades(saccades);
        blinks = draw->blinks(blinks);
        swells = expressions::swells_on(track, seed, chance, drawn, swells);
        emphases = expressions::emphases_on(life, track, voices, seed, chance, drawn, emphases);
    }
    return lang::made<Schedule>(
        end,
        drawn,
        draw->modes,
        draw->moods,
        draw->targets,
        breaths,
        aversions,
        saccades,
        blinks,
        swells,
        emphases,
        life,
        track,
        voices,
        seed
    );
}

/// Return "" if nothing that a schedule was drawn from has changed, "places" if only places have, else "all".
inline std::string _change(
    const Ref<Schedule>& before,
    const Ref<Life>& life,
    const Ref<Track>& track,
    const Ref<Voices>& voices,
    std::uint32_t seed
) {
    if (before->track == nullptr || before->seed != seed || !life::is_same_life(before->life, life)) {
        return "all";
    }
    if (!voice::are_same_voices(before->voices, voices)) {
        return "all";
    }
    if (before->track == track || before->track->like(track)) {
        return "";
    }
    return before->track->draws_like(track) ? std::string("places") : std::string("all");
}

/// Return the draw that extends a schedule from `cut` to `drawn` seconds, with modes and looks filled in.
inline Ref<LifeDraw> _draw(
    const Ref<Life>& life,
    const Ref<Track>& track,
    const Ref<Voices>& voices,
    std::uint32_t seed,
    double cut,
    double drawn,
    const Ref<Schedule>& before
) {
    Ref<Lane> modes = before->modes->until(cut);
    int last = lang::len(modes->rows) > 0 ? static_cast<int>(lang::at(lang::at(modes->rows, -1), 0)) : -1;
    List<double> times;
    List<List<double>> rows;
    for (const auto& [at, mode] : wanted::modes_between(track, cut, drawn)) {
        if (lang::len(times) > 0 || mode != last) {
            times.push_back(at);
            rows.push_back(List<double>{static_cast<double>(mode)});
        }
    }
    Ref<Lane> moods = before->moods->until(cut);
    List<double> felt;
    if (lang::len(moods->rows) > 0) {
        felt = lang::at(moods->rows, -1);
    }
    List<double> changes;
    List<List<double>> wanted;
    for (const auto& [at, mood] : wanted::moods_between(wanted::moods_of(life, track), cut, drawn)) {
        bool same = lang::len(felt) > 0
            && lang::at(felt, 0) == mood->valence
            && lang::at(felt, 1) == mood->arousal
            && lang::at(felt, 2) == mood->intensity;
        if (lang::len(changes) > 0 || !same) {
            changes.push_back(at);
            wanted.push_back(List<double>{mood->valence, mood->arousal, mood->intensity});
        }
    }
    List<double> found;
    for (const auto& t : before->targets) {
        found.push_back(t->start);
    }
    int begun = lang::bisect_left(found, cut);
    List<Ref<GazeTarget>> targets = lang::part(before->targets, 0, begun);
    for (const auto& target : wanted::targets_between(track, cut, drawn)) {
        if (lang::len(targets) == 0 || !target->like(lang::at(targets, -1))) {
            targets.push_back(target);
        }
    }
    return lang::made<LifeDraw>(
        life,
        track,
        voices,
        seed,
        cut,
        drawn,
        1.0 - life->stillness,
        modes->plus(times, rows),
        moods->plus(changes, wanted),
        targets
    );
}

}  // namespace schedule

}  // namespace metagraph
