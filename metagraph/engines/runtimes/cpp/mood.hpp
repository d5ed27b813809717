// How a mood shows: which actions become likelier, how large and fast they are played, and what it makes of breath,
// blinks, gaze, posture and face.
//
// A mood is a point in Russell's circumplex (1980): valence, how pleasant, and arousal, how excited, both -1..1; with
// it, an intensity, 0..2; 1 is normal. Neutral (0, 0, 1) changes nothing, to the last digit: every factor is 1 and
// every offset is 0.
//
// What is known and followed here: arousal goes with the speed, acceleration and jerk of movements (Pollick et al.
// 2001, of arms that knock and drink); elated joy and hot anger are expansive and full of movement, sadness and boredom
// neither (Wallbott 1998); the sad walk slowly, with small movements and bowed heads (Roether et al. 2009). Anger and
// fear lie close together here, at 99 and 116 degrees; people tell them apart by power (Fontaine et al. 2007). So here,
// mild unpleasant excitement is anger and strong unpleasant excitement is fear: the body draws back (Coulson 2004),
// with the shoulders up and the arms close. Faces follow the prototypes of FACS (Ekman and Friesen 1978): fear
// 1+2+4+5+20, anger 4+5+7+23, joy 6+12, sadness 1+4+15. The amounts (the numbers below) are ours, chosen so that every
// clip still looks natural.
//
// Translated from metagraph/playback/planning/mood.py; change that, and translate anew.
#pragma once

#include "choice.hpp"
#include "language.hpp"

namespace metagraph {

struct Mood;
struct MoodFrom;
struct Moods;
struct LifeMood;
struct Bearing;

namespace mood {

inline constexpr double FADE = 1.5; // seconds in which posture and face go from one mood to the next
inline constexpr double LEAST_EXTENT = 0.6;
inline constexpr double MOST_EXTENT = 1.25;
inline constexpr double LEAST_TEMPO = 0.75;
inline constexpr double MOST_TEMPO = 1.25;
inline constexpr double CLOSE = 0.5; // an action that is tagged with a mood no farther away than this was made for it
inline const std::string PLEASANT = "positive"; // tags
inline const std::string UNPLEASANT = "negative";
inline constexpr double ANGRY_FROM = 0.02; // unpleasantness from which an excited mood is angry
inline constexpr double ANGRY_WIDE = 0.1; // and by how much more it is altogether
inline constexpr double FEAR_FROM = 0.15; // the same of fear
inline constexpr double FEAR_WIDE = 0.18;
inline const std::string HELD = "contact"; // tag of actions that touch something: smaller or larger they would miss it
// Named moods: valence, arousal. Directions are Russell's (1980, table of 28 words, by circular scaling): calm
// 316.2, content 323, happy 7.8, excited 48.6, tense 92.8, angry 99, afraid 116, sad 207.5, bored 242 and
// tired 267.7 degrees, at 0.8 from the middle, which is ours. "warm" is ours.
inline const Map<std::string, std::tuple<double, double>> MOODS = Map<std::string, std::tuple<double, double>>{
    {"neutral", std::tuple<double, double>{0.0, 0.0}},
    {"calm", std::tuple<double, double>{0.58, -0.55}},
    {"content", std::tuple<double, double>{0.64, -0.48}},
    {"warm", std::tuple<double, double>{0.6, 0.1}},
    {"happy", std::tuple<double, double>{0.79, 0.11}},
    {"excited", std::tuple<double, double>{0.53, 0.6}},
    {"tense", std::tuple<double, double>{-0.04, 0.8}},
    {"angry", std::tuple<double, double>{-0.13, 0.79}},
    {"afraid", std::tuple<double, double>{-0.35, 0.72}},
    {"sad", std::tuple<double, double>{-0.71, -0.37}},
    {"bored", std::tuple<double, double>{-0.38, -0.71}},
    {"tired", std::tuple<double, double>{-0.03, -0.8}}
};
inline Ref<Mood> changed(
    const Ref<Mood>& mood,
    const std::optional<double>& valence,
    const std::optional<double>& arousal,
    const std::optional<double>& intensity
);
inline Ref<Mood> mood_at(const Ref<Moods>& moods, double seconds);
inline List<Ref<MoodFrom>> lasting(const List<Ref<MoodFrom>>& told, double seconds);
inline bool _replaces(const Ref<MoodFrom>& later, const Ref<MoodFrom>& one, double seconds);
inline List<double> mood_edges(const Ref<Moods>& moods, double start, double end);
inline double faded(double x);
inline Ref<Mood> shown(const List<double>& starts, const List<List<double>>& values, double seconds);
inline double within(double x, double low, double high);
inline double leaning(double x, double most);
inline double liveliness(const Ref<Mood>& mood);
inline double fear(const Ref<Mood>& mood);
inline double anger(const Ref<Mood>& mood);
inline double extent(const Ref<Mood>& mood);
inline double tempo(const Ref<Mood>& mood);
inline double drag(double seconds, double speed);
inline double turn_extent(double factor, double real);
inline bool made_for(const Ref<Mood>& mood, const List<std::string>& tags);
inline double distance(const Ref<Mood>& mood, const std::string& name);
inline double favour(const Ref<Mood>& mood, const List<std::string>& tags, double vigour);
inline bool stirs(const Ref<Mood>& mood, std::uint32_t seed, const std::string& key);
inline Ref<LifeMood> life_of(const Ref<Mood>& mood);
inline Ref<Bearing> bearing(const Ref<Mood>& mood);
inline double shut_in(double blink, double lids);

}  // namespace mood

/// valence, arousal: -1..1. intensity: 0..2, 1 is normal.
struct Mood {
    double valence;
    double arousal;
    double intensity;

    explicit Mood(double valence_ = 0.0, double arousal_ = 0.0, double intensity_ = 1.0)
        : valence(valence_), arousal(arousal_), intensity(intensity_) {}

    /// Whether it changes nothing.
    bool neutral() const;

    /// Whether it is the same.
    bool like(const Ref<Mood>& other) const;
};

/// A mood that holds from `start` until `end`; a field that it leaves out stays as it is without it. If two hold at
/// once, the one that began later counts. When it is over, the other counts again.
struct MoodFrom {
    std::string id;
    double start;
    std::optional<double> valence;
    std::optional<double> arousal;
    std::optional<double> intensity;
    double end;

    MoodFrom(
        std::string id_,
        double start_,
        std::optional<double> valence_ = std::nullopt,
        std::optional<double> arousal_ = std::nullopt,
        std::optional<double> intensity_ = std::nullopt,
        double end_ = INFINITY
    )
        : id(std::move(id_)), start(start_), valence(valence_), arousal(arousal_), intensity(intensity_), end(end_) {}
};

/// The mood over time. base: the mood where no other holds; told: the others, by start.
struct Moods {
    Ref<Mood> base;
    List<Ref<MoodFrom>> told;

    explicit Moods(Ref<Mood> base_ = lang::made<Mood>(), List<Ref<MoodFrom>> told_ = List<Ref<MoodFrom>>{})
        : base(std::move(base_)), told(std::move(told_)) {}
};

/// The factors by which a mood changes the amounts and rates of the life layers, as those of a manner.
struct LifeMood {
    double breathing;
    double breath_rate;
    double aversion_rate;
    double saccade_rate;
    double blinks;

    LifeMood(double breathing_, double breath_rate_, double aversion_rate_, double saccade_rate_, double blinks_)
        : breathing(breathing_),
            breath_rate(breath_rate_),
            aversion_rate(aversion_rate_),
            saccade_rate(saccade_rate_),
            blinks(blinks_) {}
};

/// Posture and face of a mood. droop: -0.4 upright .. 1 bowed. lift: of the shoulders, in breaths. lids: how far they
/// hang, 0..1, or are open wide, below 0. smile, frown, brow_down, brow_up, brows: weights of the face, 0..1. thrust:
/// how far the body leans forward, 0..1, or draws back, below 0. tension: of shoulders, arms and hands, 0..1. closed:
/// how close the arms are kept, 0..1.
struct Bearing {
    double droop;
    double lift;
    double lids;
    double smile;
    double frown;
    double brow_down;
    double brow_up;
    double thrust;
    double tension;
    double brows;
    double closed;

    explicit Bearing(
        double droop_ = 0.0,
        double lift_ = 0.0,
        double lids_ = 0.0,
        double smile_ = 0.0,
        double frown_ = 0.0,
        double brow_down_ = 0.0,
        double brow_up_ = 0.0,
        double thrust_ = 0.0,
        double tension_ = 0.0,
        double brows_ = 0.0,
        double closed_ = 0.0
    )
        : droop(droop_),
            lift(lift_),
            lids(lids_),
            smile(smile_),
            frown(frown_),
            brow_down(brow_down_),
            brow_up(brow_up_),
            thrust(thrust_),
            tension(tension_),
            brows(brows_),
            closed(closed_) {}
};

inline bool Mood::neutral() const {
    return this->valence == 0 && this->arousal == 0 && this->intensity == 1;
}

inline bool Mood::like(const Ref<Mood>& other) const {
    return this->valence == other->valence && this->arousal == other->arousal && this->intensity == other->intensity;
}

namespace mood {

/// Return a mood with the given fields changed, each limited to its range.
inline Ref<Mood> changed(
    const Ref<Mood>& mood,
    const std::optional<double>& valence,
    const std::optional<double>& arousal,
    const std::optional<double>& intensity
) {
    return lang::made<Mood>(
        !valence.has_value() ? mood->valence : mood::within(*valence, -1.0, 1.0),
        !arousal.has_value() ? mood->arousal : mood::within(*arousal, -1.0, 1.0),
        !intensity.has_value() ? mood->intensity : mood::within(*intensity, 0.0, 2.0)
    );
}

/// Return the mood that holds at a time; posture and face follow it slowly (`shown`).
inline Ref<Mood> mood_at(const Ref<Moods>& moods, double seconds) {
    Ref<Mood> out = moods->base;
    for (const auto& told : moods->told) {
        if (told->start > seconds) {
            break;
        }
        if (seconds < told->end) {
            out = mood::changed(out, told->valence, told->arousal, told->intensity);
        }
    }
    return out;
}

/// Return the moods that may still show at `seconds` or later: without those that are over and have faded, and without
/// those that a mood without an end has replaced.
inline List<Ref<MoodFrom>> lasting(const List<Ref<MoodFrom>>& told, double seconds) {
    List<Ref<MoodFrom>> out;
    for (int place = 0; place < lang::len(told); place++) {
        const auto& one = lang::at(told, place);
        if (one->end <= seconds - mood::FADE) {
            continue;
        }
        bool is_any = false;
        for (const auto& other : lang::part(told, place + 1)) {
            if (mood::_replaces(other, one, seconds)) {
                is_any = true;
                break;
            }
        }
        if (!is_any) {
            out.push_back(one);
        }
    }
    return out;
}

inline bool _replaces(const Ref<MoodFrom>& later, const Ref<MoodFrom>& one, double seconds) {
    return later->end == INFINITY
        && later->start <= seconds - mood::FADE
        && (!one->valence.has_value() || later->valence.has_value())
        && (!one->arousal.has_value() || later->arousal.has_value())
        && (!one->intensity.has_value() || later->intensity.has_value());
}

/// Return the times from `start` to before `end` at which the mood may change, ascending, `start` first.
inline List<double> mood_edges(const Ref<Moods>& moods, double start, double end) {
    List<double> edges = List<double>{start};
    for (const auto& told : moods->told) {
        for (const auto& edge : List<double>{told->start, told->end}) {
            if (start < edge && edge < end && !lang::contains(edges, edge)) {
                edges.push_back(edge);
            }
        }
    }
    return lang::in_order(edges);
}

/// Return how much of a change shows after `x` of its fade: 3x^2 - 2x^3 of x clamped to 0..1.
inline double faded(double x) {
    double y = mood::within(x, 0.0, 1.0);
    return y * y * (3 - 2 * y);
}

/// Return the mood that shows at a time, while it fades from the previous ones. starts: when each begins, ascending;
/// values: valence, arousal, intensity of each. Before the first it is the first.
inline Ref<Mood> shown(const List<double>& starts, const List<List<double>>& values, double seconds) {
    int place = lang::len(starts) - 1;
    while (place > 0 && lang::at(starts, place) > seconds) {
        place -= 1;
    }
    if (place < 0) {
        return lang::made<Mood>();
    }
    double valence = 0.0;
    double arousal = 0.0;
    double intensity = 0.0;
    double left = 1.0;
    while (left > 0) {
        double share = left;
        if (place > 0) {
            share = std::min(left, mood::faded((seconds - lang::at(starts, place)) / mood::FADE) - (1 - left));
        }
        valence += share * lang::at(lang::at(values, place), 0);
        arousal += share * lang::at(lang::at(values, place), 1);
        intensity += share * lang::at(lang::at(values, place), 2);
        left -= share;
        place -= 1;
    }
    return lang::made<Mood>(valence, arousal, intensity);
}

/// Return a number clamped to a range.
inline double within(double x, double low, double high) {
    return std::min(std::max(x, low), high);
}

/// Return 1 at 0, `most` at 1 and 1 / `most` at -1, and beyond as there; smooth and rising.
inline double leaning(double x, double most) {
    double y = mood::within(x, -1.0, 1.0) * (most - 1) / (most + 1);
    return (1 + y) / (1 - y);
}

/// Return how lively a mood is, -1..1: its arousal, plus some if it is pleasant, less if it is unpleasant and not
/// exciting.
inline double liveliness(const Ref<Mood>& mood) {
    double well = std::max(0.0, mood->valence);
    double ill = std::max(0.0, -mood->valence);
    double calm = 1 - std::max(0.0, mood->arousal);
    return mood::within(mood->arousal + 0.5 * well - 0.6 * ill * calm, -1.0, 1.0);
}

/// Return how afraid a mood is, 0..1.
inline double fear(const Ref<Mood>& mood) {
    double much = std::min(1.0, 1.25 * std::max(0.0, mood->arousal));
    return much * mood::faded((-mood->valence - mood::FEAR_FROM) / mood::FEAR_WIDE);
}

/// Return how angry a mood is, 0..1.
inline double anger(const Ref<Mood>& mood) {
    double much = std::min(1.0, 1.25 * std::max(0.0, mood->arousal));
    return much * mood::faded((-mood->valence - mood::ANGRY_FROM) / mood::ANGRY_WIDE) - mood::fear(mood);
}

/// Return how large gestures and fidgets of arms and head are played: a factor of their turns away from the stance.
inline double extent(const Ref<Mood>& mood) {
    double size = mood::within(mood::liveliness(mood) - 1.5 * mood::fear(mood), -1.0, 1.0);
    double by_mood = size > 0 ? 1 + 0.25 * size : 1 + 0.4 * size;
    double dial = mood->intensity - 1;
    double by_dial = dial > 0 ? 1 + 0.25 * dial : 1 + 0.4 * dial;
    return mood::within(by_mood * by_dial, mood::LEAST_EXTENT, mood::MOST_EXTENT);
}

/// Return how fast actions are played: a factor of their own speed.
inline double tempo(const Ref<Mood>& mood) {
    return mood::within(1 + 0.25 * mood::liveliness(mood), mood::LEAST_TEMPO, mood::MOST_TEMPO);
}

/// Return how much longer clip seconds take at a speed than at their own speed, exactly 0 at that speed.
inline double drag(double seconds, double speed) {
    return seconds * (lang::divided(1, speed) - 1);
}

/// Return how far a joint turns away from its stance, a factor, for that of a cue. real: the real part of the original
/// rotation, a unit quaternion. Rotations of nearly half a circle, whose short way changes sides, stay as they are.
inline double turn_extent(double factor, double real) {
    return 1 + (factor - 1) * mood::faded((std::abs(real) - 0.1) / 0.4);
}

/// Return whether an action was made for a mood: whether it has the tag of a mood that is near.
inline bool made_for(const Ref<Mood>& mood, const List<std::string>& tags) {
    bool is_any = false;
    for (const auto& tag : tags) {
        if (lang::contains(mood::MOODS, tag) && mood::distance(mood, tag) <= mood::CLOSE) {
            is_any = true;
            break;
        }
    }
    return is_any;
}

/// Return how far a mood is from a named one, 0..2.8.
inline double distance(const Ref<Mood>& mood, const std::string& name) {
    auto [valence, arousal] = mood::MOODS.at(name);
    double x = mood->valence - valence;
    double y = mood->arousal - arousal;
    return std::sqrt(x * x + y * y);
}

/// Return the factor of an action's likelihood. vigour: how energetic it is compared with others of its layer and kind,
/// -1..1. The factor is up to 4 for vigour, 4 for a tag of valence and 9 for a tag that names a mood, and the inverse
/// if they contradict the mood.
inline double favour(const Ref<Mood>& mood, const List<std::string>& tags, double vigour) {
    double out = mood::leaning(vigour * mood::within(mood::liveliness(mood) + (mood->intensity - 1), -1.0, 1.0), 4.0);
    if (lang::contains(tags, mood::PLEASANT)) {
        out *= mood::leaning(mood->valence, 4.0);
    }
    if (lang::contains(tags, mood::UNPLEASANT)) {
        out *= mood::leaning(-mood->valence, 4.0);
    }
    double strength = std::min(
        1.0,
        std::sqrt(mood->valence * mood->valence + mood->arousal * mood->arousal) / mood::CLOSE
    );
    for (const auto& tag : tags) {
        if (lang::contains(mood::MOODS, tag)) {
            out *= mood::leaning(strength * (1 - mood::distance(mood, tag) / mood::CLOSE), 9.0);
        }
    }
    return out;
}

/// Return whether something that a model wrote is performed in a mood: less of it in a less lively mood, down to 0.6.
inline bool stirs(const Ref<Mood>& mood, std::uint32_t seed, const std::string& key) {
    double lively = mood::liveliness(mood);
    return lively >= 0 || choice::uniform(seed, List<std::string>{key, "mood"}) < 1 + 0.4 * lively;
}

/// Return how a mood changes the life layers. With arousal, breath is quicker and deeper, and eyes dart and blink more.
/// In an unpleasant mood the character looks away more, in a pleasant one less. The amounts are ours.
inline Ref<LifeMood> life_of(const Ref<Mood>& mood) {
    double a = mood->arousal;
    double v = mood->valence;
    return lang::made<LifeMood>(
        1 + 0.25 * a,
        a > 0 ? 1 + 0.4 * a : 1 + 0.25 * a,
        v < 0 ? 1 - 0.4 * v : 1 - 0.25 * v,
        1 + 0.4 * a,
        a > 0 ? 1 + 0.4 * a : 1 + 0.25 * a
    );
}

/// Return posture and face of a mood, stronger with its intensity. The head bows with sadness (Roether et al. 2009);
/// shoulders rise, fists close and the body leans forward with arousal that is not joy; fear draws back (Coulson 2004);
/// the amounts are ours.
inline Ref<Bearing> bearing(const Ref<Mood>& mood) {
    double v = mood->valence;
    double a = mood->arousal;
    double i = mood->intensity;
    double up = std::max(0.0, a);
    double down = std::max(0.0, -a);
    double well = std::max(0.0, v);
    double ill = std::max(0.0, -v);
    double scared = mood::fear(mood);
    double cross = mood::anger(mood);
    return lang::made<Bearing>(
        mood::within(i * (-0.7 * v - 0.5 * a), -0.4, 1.0),
        mood::within(i * (2.0 * up * (1 - well) + 4.5 * scared - 1.5 * down - ill * (1 - up)), -2.0, 6.0),
        mood::within(i * (0.5 * down - 0.5 * scared - 0.15 * cross - 1.1 * up * well), -0.6, 0.5),
        mood::within(i * well * (1.2 + 0.3 * up - 0.6 * down), 0.0, 1.0),
        mood::within(i * (1.4 * ill * (1 - up) * (1 - 0.6 * down) + 0.35 * cross + 0.4 * scared), 0.0, 1.0),
        mood::within(i * (0.5 * up * std::max(0.0, 0.4 - v) + 0.8 * cross) * (1 - scared), 0.0, 1.0),
        mood::within(i * (2.0 * ill * (1 - up) * (1 - down) + 0.9 * scared), 0.0, 1.0),
        mood::within(i * (0.3 * up * std::max(0.0, 0.3 - v) + 0.9 * cross - 0.7 * scared), -1.0, 1.0),
        mood::within(i * 1.2 * up * std::max(0.0, 1.0 - 2.0 * well) * (1 - 0.8 * scared), 0.0, 1.0),
        mood::within(i * (0.6 * scared + 1.6 * up * well), 0.0, 1.0),
        mood::within(i * (0.5 * scared + 0.4 * ill * (1 - up)), 0.0, 1.0)
    );
}

/// Return how far lids are shut: as far as a blink shuts them or, if they hang farther, as far as they do; below 0
/// where they are open wide.
inline double shut_in(double blink, double lids) {
    return lids > 0 ? std::max(blink, lids) : blink + lids * (1 - blink);
}

}  // namespace mood

}  // namespace metagraph
