// Small events of the face: drawn with the other life layers, shown by `shown_face`, `answer` and `settle`.
//
// What is known and followed here: speakers raise their brows on stressed words (Cave et al. 1996), from about 60 ms
// before the accent (Flecha-Garcia 2010), and where they ask (Ekman 1979); greeting, people flash their brows for about
// a third of a second (Eibl-Eibesfeldt 1972); felt smiles come and go in 2/3 to 4 s and raise the cheeks (Ekman and
// Friesen 1982), posed ones may stay. So the face of a mood rises and falls back to a part of it, instead of being
// constant. How much, how often and for which tags is ours.
//
// If `Life.expressions` is 0, or at full stillness, the face of a mood is constant and nothing else is added.
//
// Translated from metagraph/playback/life/expressions.py; change that, and translate anew.
#pragma once

#include "items.hpp"
#include "lane.hpp"
#include "track.hpp"
#include "voice.hpp"
#include "choice.hpp"
#include "mood.hpp"
#include "life.hpp"
#include "voice.hpp"
#include "language.hpp"

namespace metagraph {

struct FaceShown;

namespace expressions {

// Swells: how the face of a mood comes up; rows: length s, amount, 1 where the mode was listening.
inline constexpr double SWELL_GAP = 3.5; // seconds between two, on average
inline constexpr double SHORTEST_SWELL = 0.9;
inline constexpr double LONGEST_SWELL = 4.0;
inline constexpr double SWELL_RISES = 0.35; // of its length
inline constexpr double KEPT = 0.75; // of a mood's face between swells
inline constexpr double WARMTH = 0.35; // of a smile that a listener's swell is
// Emphases: brows raised in speech, and where somebody reacts to something; rows: length s, amount, rise s.
inline constexpr double EARLY = 0.06; // seconds a raise begins before its syllable
inline constexpr double RAISE = 0.35; // seconds it takes at least
inline constexpr double RAISE_CHANCE = 0.3; // and what chance adds
inline constexpr double RAISE_RISES = 0.12;
// seconds before the end of a question that its brows begin to rise, but in its second half
inline constexpr double ASKING = 0.8;
inline constexpr double ASKING_ON = 0.5; // seconds they take to sink after it
inline constexpr double ASKING_LIFTS = 0.8; // of a full raise
inline constexpr double REACTING = 1.2; // seconds they take where a reaction begins
inline constexpr double LONGEST_EMPHASIS = 1.5; // seconds
// Cues: what those with certain tags show.
inline constexpr double CUE_RISES = 0.25; // seconds
inline constexpr double CUE_LASTS = 1.8;
inline constexpr double CUE_FALLS = 0.6;
inline constexpr double FLASH_FROM = 0.1; // seconds after a greeting begins
inline constexpr double FLASH_RISES = 0.08;
inline constexpr double FLASH_LASTS = 0.4;
inline const std::string GREETING = "greeting";
// Of smile, frown, brow_down, brow_up, brows.
inline const Map<std::string, List<double>> SHOWN = Map<std::string, List<double>>{
    {"greeting", List<double>{0.6, 0.0, 0.0, 0.0, 0.1}},
    {"positive", List<double>{0.3, 0.0, 0.0, 0.0, 0.15}},
    {"agree", List<double>{0.1, 0.0, 0.0, 0.0, 0.1}},
    {"negative", List<double>{0.0, 0.2, 0.35, 0.0, 0.0}},
    {"surprise", List<double>{0.0, 0.0, 0.0, 0.0, 0.9}},
    {"question", List<double>{0.0, 0.0, 0.0, 0.0, 0.6}},
    {"unsure", List<double>{0.0, 0.3, 0.0, 0.2, 0.5}},
    {"thinking", List<double>{0.0, 0.1, 0.35, 0.0, 0.0}}
};
inline const List<std::string> MARKS = List<std::string>{"?", "？", "؟"}; // at the end of questions
inline constexpr double DUCHENNE = 0.2; // the smile from which on cheeks rise
inline Ref<Lane> swells_on(
    const Ref<Track>& track,
    std::uint32_t seed,
    double cut,
    double drawn,
    const Ref<Lane>& before
);
inline Ref<Lane> emphases_on(
    const Ref<Life>& life,
    const Ref<Track>& track,
    const Ref<Voices>& voices,
    std::uint32_t seed,
    double cut,
    double drawn,
    const Ref<Lane>& before
);
inline bool asks(const Ref<Speech>& speech);
inline void shown_face(
    const Ref<FaceShown>& face,
    const Ref<Life>& life,
    const Ref<Lane>& swells,
    const Ref<Lane>& emphases,
    const Ref<Bearing>& bears,
    double seconds
);
inline void answer(
    const Ref<FaceShown>& face,
    const Ref<Life>& life,
    const List<std::string>& tags,
    double start,
    double end,
    double seconds
);
inline void settle(const Ref<FaceShown>& face);

}  // namespace expressions

/// The weights of a face's channels, without lids and lips. brow_up raises only the inner ends of the brows, brows the
/// whole of them. The same object is filled again for each time (`shown_face`, `answer`, `settle`).
struct FaceShown {
    double smile;
    double frown;
    double brow_down;
    double brow_up;
    double brows;
    double cheeks;

    explicit FaceShown(
        double smile_ = 0.0,
        double frown_ = 0.0,
        double brow_down_ = 0.0,
        double brow_up_ = 0.0,
        double brows_ = 0.0,
        double cheeks_ = 0.0
    )
        : smile(smile_), frown(frown_), brow_down(brow_down_), brow_up(brow_up_), brows(brows_), cheeks(cheeks_) {}
};

namespace expressions {

/// Return the lane of swells filled from `cut` to `drawn` seconds.
inline Ref<Lane> swells_on(
    const Ref<Track>& track,
    std::uint32_t seed,
    double cut,
    double drawn,
    const Ref<Lane>& before
) {
    List<double> times;
    List<List<double>> rows;
    int number = before->next();
    double over = lang::len(before->times) > 0
        ? lang::at(before->times, -1) + lang::at(lang::at(before->rows, -1), 0)
        : 0.0;
    while (true) {
        int key = choice::keyed(seed, List<std::string>{"swell", lang::text(number)});
        double gap = expressions::SWELL_GAP * (0.3 + 1.4 * choice::chance_of(key, "gap"));
        double at = std::max(cut, over + gap);
        if (at >= drawn) {
            return before->plus(times, rows);
        }
        double length = expressions::SHORTEST_SWELL;
        length += (expressions::LONGEST_SWELL - expressions::SHORTEST_SWELL) * choice::chance_of(key, "length");
        double amount = 0.6 + 0.4 * choice::chance_of(key, "amount");
        times.push_back(at);
        rows.push_back(List<double>{length, amount, track->told_mode(at) == "listening" ? 1.0 : 0.0});
        over = at + length;
        number += 1;
    }
}

/// Return the lane of emphases filled from `cut` to `drawn` seconds: on the share of stressed syllables that
/// `accent_brows` says, at the end of questions, and where a reaction begins.
inline Ref<Lane> emphases_on(
    const Ref<Life>& life,
    const Ref<Track>& track,
    const Ref<Voices>& voices,
    std::uint32_t seed,
    double cut,
    double drawn,
    const Ref<Lane>& before
) {
    List<List<double>> found;
    double chance{};
    for (const auto& speech : track->speeches) {
        if (speech->end <= cut || speech->start >= drawn) {
            continue;
        }
        double at{};
        for (int n = 0; n < lang::len(voice::stressed(voices, speech)); n++) {
            const auto& peak = lang::at(voice::stressed(voices, speech), n);
            double begin = items::find_line_start(speech);
            at = std::max(speech->start, begin + peak - expressions::EARLY);
            if (at >= speech->end || begin + peak < speech->start) {
                continue;
            }
            if (choice::uniform(seed, List<std::string>{speech->id, "brows", lang::text(n)}) >= life->accent_brows) {
                continue;
            }
            chance = choice::uniform(seed, List<std::string>{speech->id, "raise", lang::text(n)});
            found.push_back(List<double>{
                at,
                expressions::RAISE + expressions::RAISE_CHANCE * chance,
                0.5 + 0.5 * chance,
                expressions::RAISE_RISES
            });
        }
        if (expressions::asks(speech)) {
            double length = items::measure_line(speech);
            double lead = std::min(expressions::ASKING, 0.5 * length);
            at = std::max(speech->start, items::find_line_start(speech) + length - lead);
            if (at < speech->end) {
                found.push_back(List<double>{at, lead + expressions::ASKING_ON, expressions::ASKING_LIFTS, lead});
            }
        }
    }
    for (const auto& change : track->modes) {
        if (change->mode == "reacting" && life->accent_brows > 0) {
            chance = choice::uniform(seed, List<std::string>{change->id, "raise"});
            found.push_back(List<double>{
                change->start,
                expressions::REACTING,
                0.6 + 0.4 * chance,
                expressions::RAISE_RISES
            });
        }
    }
    List<double> times;
    List<List<double>> rows;
    List<std::tuple<double, double>> keys;
    for (const auto& x : found) {
        keys.push_back(std::tuple<double, double>{lang::at(x, 0), lang::at(x, 3)});
    }
    for (const auto& event : lang::ordered(found, keys)) {
        if (cut <= lang::at(event, 0) && lang::at(event, 0) < drawn) {
            times.push_back(lang::at(event, 0));
            rows.push_back(lang::part(event, 1));
        }
    }
    return before->plus(times, rows);
}

/// Return whether a speech is a question, by its last sign.
inline bool asks(const Ref<Speech>& speech) {
    std::string text = lang::stripped(speech->text);
    bool holds = text != "";
    if (holds) {
        bool is_any = false;
        for (const auto& mark : expressions::MARKS) {
            if (std::get<2>(lang::parted_last(text, mark)) == "") {
                is_any = true;
                break;
            }
        }
        holds = is_any;
    }
    return holds;
}

/// Fill in the face at a time, from the mood and the drawn events.
inline void shown_face(
    const Ref<FaceShown>& face,
    const Ref<Life>& life,
    const Ref<Lane>& swells,
    const Ref<Lane>& emphases,
    const Ref<Bearing>& bears,
    double seconds
) {
    double calm = 1 - life->stillness;
    double swell = 0.0;
    double warm = 0.0;
    int n = lang::bisect_right(swells->times, seconds) - 1;
    double length{};
    double amount{};
    double gone{};
    double rise{};
    if (n >= 0) {
        length = lang::at(lang::at(swells->rows, n), 0);
        amount = lang::at(lang::at(swells->rows, n), 1);
        double listens = lang::at(lang::at(swells->rows, n), 2);
        gone = seconds - lang::at(swells->times, n);
        rise = expressions::SWELL_RISES * length;
        swell = amount * mood::faded(std::min(gone / rise, (length - gone) / (length - rise)));
        warm = listens * swell;
    }
    double share = 1 - calm * std::min(1.0, life->expressions) * (1 - expressions::KEPT) * (1 - swell);
    double much = calm * life->expressions;
    double brows = 0.0;
    n = lang::bisect_right(emphases->times, seconds) - 1;
    while (n >= 0 && seconds - lang::at(emphases->times, n) < expressions::LONGEST_EMPHASIS) {
        length = lang::at(lang::at(emphases->rows, n), 0);
        amount = lang::at(lang::at(emphases->rows, n), 1);
        rise = lang::at(lang::at(emphases->rows, n), 2);
        gone = seconds - lang::at(emphases->times, n);
        brows = std::max(brows, amount * mood::faded(std::min(gone / rise, (length - gone) / (length - rise))));
        n -= 1;
    }
    face->smile = share * bears->smile + much * expressions::WARMTH * warm * (1 - bears->frown);
    face->frown = share * bears->frown;
    face->brow_down = share * bears->brow_down;
    face->brow_up = share * bears->brow_up;
    face->brows = share * bears->brows + much * brows;
}

/// Add what a cue with these tags, from `start` to `end`, shows on a face at a time.
inline void answer(
    const Ref<FaceShown>& face,
    const Ref<Life>& life,
    const List<std::string>& tags,
    double start,
    double end,
    double seconds
) {
    double much = (1 - life->stillness) * life->expressions;
    if (much <= 0 || seconds <= start || seconds >= std::min(end, start + expressions::CUE_LASTS)) {
        return;
    }
    double gone = seconds - start;
    double shows = much
        * mood::faded(
            std::min(
                gone / expressions::CUE_RISES,
                (std::min(end, start + expressions::CUE_LASTS) - seconds) / expressions::CUE_FALLS
            )
        );
    for (const auto& tag : tags) {
        if (lang::contains(expressions::SHOWN, tag)) {
            List<double> of = expressions::SHOWN.at(tag);
            face->smile += shows * lang::at(of, 0);
            face->frown += shows * lang::at(of, 1);
            face->brow_down += shows * lang::at(of, 2);
            face->brow_up += shows * lang::at(of, 3);
            face->brows += shows * lang::at(of, 4);
        }
        if (tag == expressions::GREETING) {
            double flash = gone - expressions::FLASH_FROM;
            double left = expressions::FLASH_LASTS - flash;
            face->brows += much
                * mood::faded(
                    std::min(
                        flash / expressions::FLASH_RISES,
                        left / (expressions::FLASH_LASTS - expressions::FLASH_RISES)
                    )
                );
        }
    }
}

/// Clamp all weights to 0..1, and raise the cheeks with a smile.
inline void settle(const Ref<FaceShown>& face) {
    face->smile = mood::within(face->smile, 0.0, 1.0);
    face->frown = mood::within(face->frown, 0.0, 1.0);
    face->brow_down = mood::within(face->brow_down, 0.0, 1.0);
    face->brow_up = mood::within(face->brow_up, 0.0, 1.0);
    face->brows = mood::within(face->brows, 0.0, 1.0);
    face->cheeks = mood::within((face->smile - expressions::DUCHENNE) / (1 - expressions::DUCHENNE), 0.0, 1.0);
}

}  // namespace expressions

}  // namespace metagraph
