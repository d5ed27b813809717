// Single rules, asked with numbers and texts alone: what vectors ask beside plans and poses, so that each rule of
// geometry, of the mouth, of moods and of times meets both sides of its boundaries.
//
// Translated from metagraph/engines/single_rules.py; change that, and translate anew.
#pragma once

#include "words.hpp"
#include "contact_solve.hpp"
#include "contact_spans.hpp"
#include "feet_solve.hpp"
#include "plain_vectors.hpp"
#include "weight_solve.hpp"
#include "alphabet.hpp"
#include "graphemes.hpp"
#include "line_timing.hpp"
#include "mouth.hpp"
#include "choice.hpp"
#include "director.hpp"
#include "mood.hpp"
#include "cue_times.hpp"
#include "follow_through.hpp"
#include "planted_feet.hpp"
#include "language.hpp"

namespace metagraph {

struct RuleInput;

namespace single_rules {

inline constexpr double OPEN = 1000000000.0; // in the place of an end that is not known
inline List<double> answer_rule(
    const Ref<Alphabet>& alphabet,
    std::uint32_t seed,
    const std::string& rule,
    const List<double>& numbers,
    const List<std::string>& texts
);
inline std::tuple<double, double, double> _vector(const Ref<RuleInput>& given);
inline std::tuple<double, double, double, double> _turn(const Ref<RuleInput>& given);
inline int _count(const Ref<RuleInput>& given);
inline void _put(List<double>& out, const std::tuple<double, double, double>& v);
inline void _put_turn(List<double>& out, const std::tuple<double, double, double, double>& q);
inline Ref<ContactRig> _rig(const Ref<RuleInput>& given, const Ref<ContactPose>& pose);
inline Ref<WeightRig> _weight_rig(const Ref<RuleInput>& given, const Ref<ContactRig>& body);
inline List<double> _posed(const Ref<ContactPose>& pose);
inline List<double> _geometry(const std::string& rule, const Ref<RuleInput>& given);
inline Ref<FootGoal> _foot(const Ref<RuleInput>& given);
inline List<Ref<FootGoal>> _feet(const Ref<RuleInput>& given);
inline void _put_feet(List<double>& out, const List<Ref<FootGoal>>& feet);
inline List<List<double>> _rows(const Ref<RuleInput>& given, int count, int width);
inline Ref<ContactSpan> _span(const Ref<RuleInput>& given);
inline List<double> _places(const std::string& rule, const Ref<RuleInput>& given);
inline void _put_spelled(List<double>& out, const Ref<Spelled>& found);
inline List<double> _mouth(const Ref<Alphabet>& alphabet, const std::string& rule, const Ref<RuleInput>& given);
inline Ref<LineTiming> _line(const Ref<RuleInput>& given);
inline void _put_line(const Ref<Alphabet>& alphabet, List<double>& out, const Ref<LineTiming>& line);
inline double _yes(bool which);
inline List<double> _timing(const Ref<Alphabet>& alphabet, const std::string& rule, const Ref<RuleInput>& given);
inline Ref<Mood> _mood_of(const Ref<RuleInput>& given);
inline List<Ref<MoodFrom>> _told(const Ref<RuleInput>& given);
inline void _put_mood(List<double>& out, const Ref<Mood>& mood);
inline List<double> _mood(std::uint32_t seed, const std::string& rule, const Ref<RuleInput>& given);
inline List<double> _times(std::uint32_t seed, const std::string& rule, const Ref<RuleInput>& given);

}  // namespace single_rules

/// What a rule is asked with: numbers and texts, which are taken one after the other.
struct RuleInput {
    List<double> numbers;
    List<std::string> texts;
    int at;
    int told;

    RuleInput(List<double> numbers_, List<std::string> texts_, int at_ = 0, int told_ = 0)
        : numbers(std::move(numbers_)), texts(std::move(texts_)), at(at_), told(told_) {}

    /// Take the next number.
    double number();

    /// Take the next text.
    std::string text();
};

inline double RuleInput::number() {
    this->at += 1;
    return lang::at(this->numbers, this->at - 1);
}

inline std::string RuleInput::text() {
    this->told += 1;
    return lang::at(this->texts, this->told - 1);
}

namespace single_rules {

/// Return what a rule makes of numbers and texts; nothing for a rule that is not known.
inline List<double> answer_rule(
    const Ref<Alphabet>& alphabet,
    std::uint32_t seed,
    const std::string& rule,
    const List<double>& numbers,
    const List<std::string>& texts
) {
    Ref<RuleInput> given = lang::made<RuleInput>(numbers, texts);
    if (lang::contains(List<std::string>{"between", "apart", "unit", "contacts", "bring", "weight", "feet"}, rule)) {
        return single_rules::_geometry(rule, given);
    }
    if (lang::contains(List<std::string>{"way", "steps", "track", "driven", "span", "key"}, rule)) {
        return single_rules::_places(rule, given);
    }
    if (lang::contains(List<std::string>{"mouth", "soften", "accents", "spelled", "letters"}, rule)) {
        return single_rules::_mouth(alphabet, rule, given);
    }
    if (lang::contains(List<std::string>{"timing", "piece"}, rule)) {
        return single_rules::_timing(alphabet, rule, given);
    }
    if (lang::contains(List<std::string>{"mood", "moods", "shown", "lasting"}, rule)) {
        return single_rules::_mood(seed, rule, given);
    }
    return single_rules::_times(seed, rule, given);
}

inline std::tuple<double, double, double> _vector(const Ref<RuleInput>& given) {
    double x = given->number();
    double y = given->number();
    double z = given->number();
    return std::tuple<double, double, double>{x, y, z};
}

inline std::tuple<double, double, double, double> _turn(const Ref<RuleInput>& given) {
    double x = given->number();
    double y = given->number();
    double z = given->number();
    double w = given->number();
    return plain_vectors::unit_turn(std::tuple<double, double, double, double>{x, y, z, w});
}

inline int _count(const Ref<RuleInput>& given) {
    return static_cast<int>(std::floor(given->number() + 0.5));
}

inline void _put(List<double>& out, const std::tuple<double, double, double>& v) {
    auto [x, y, z] = v;
    lang::extend(out, List<double>{x, y, z});
}

inline void _put_turn(List<double>& out, const std::tuple<double, double, double, double>& q) {
    auto [x, y, z, w] = q;
    lang::extend(out, List<double>{x, y, z, w});
}

// --- limbs
/// Read a rig and a pose of it.
inline Ref<ContactRig> _rig(const Ref<RuleInput>& given, const Ref<ContactPose>& pose) {
    List<int> parents;
    List<int> joints;
    int size = single_rules::_count(given);
    for (int n = 0; n < size; n++) {
        joints.push_back(n);
        parents.push_back(single_rules::_count(given));
        pose->moved.push_back(single_rules::_vector(given));
        pose->local.push_back(single_rules::_turn(given));
    }
    List<Ref<ContactArm>> limbs;
    for (int _side = 0; _side < 2; _side++) {
        int upper = single_rules::_count(given);
        int lower = single_rules::_count(given);
        int hand = single_rules::_count(given);
        List<int> below;
        size = single_rules::_count(given);
        for (int _n = 0; _n < size; _n++) {
            below.push_back(single_rules::_count(given));
        }
        limbs.push_back(lang::made<ContactArm>(upper, lower, hand, below));
    }
    List<Ref<BodyCapsule>> capsules;
    size = single_rules::_count(given);
    for (int _n = 0; _n < size; _n++) {
        int joint = single_rules::_count(given);
        std::tuple<double, double, double> a = single_rules::_vector(given);
        int to = single_rules::_count(given);
        std::tuple<double, double, double> b = single_rules::_vector(given);
        double radius = given->number();
        int arm = single_rules::_count(given);
        capsules.push_back(lang::made<BodyCapsule>(joint, a, to, b, radius, arm, single_rules::_count(given)));
    }
    bool guard = given->number() > 0.0;
    Map<std::string, int> places;
    return lang::made<ContactRig>(
        joints,
        parents,
        places,
        limbs,
        List<std::string>{"left", "right"},
        capsules,
        true,
        guard
    );
}

inline Ref<WeightRig> _weight_rig(const Ref<RuleInput>& given, const Ref<ContactRig>& body) {
    List<Ref<WeightBend>> bends;
    int size = single_rules::_count(given);
    int place{};
    for (int _n = 0; _n < size; _n++) {
        place = single_rules::_count(given);
        std::tuple<double, double, double> left = single_rules::_vector(given);
        std::tuple<double, double, double> up = single_rules::_vector(given);
        std::tuple<double, double, double> ahead = single_rules::_vector(given);
        bends.push_back(lang::made<WeightBend>(place, left, up, ahead, given->number()));
    }
    List<Ref<WeightCollar>> collars;
    size = single_rules::_count(given);
    for (int _n = 0; _n < size; _n++) {
        place = single_rules::_count(given);
        int upper = single_rules::_count(given);
        std::tuple<double, double, double> axis = single_rules::_vector(given);
        collars.push_back(lang::made<WeightCollar>(place, upper, axis, single_rules::_count(given)));
    }
    List<std::tuple<double, double, double>> knees;
    List<std::tuple<double, double>> levers;
    for (int _side = 0; _side < 2; _side++) {
        knees.push_back(single_rules::_vector(given));
        double aside = given->number();
        levers.push_back(std::tuple<double, double>{aside, given->number()});
    }
    double height = given->number();
    return lang::made<WeightRig>(
        body,
        bends,
        collars,
        knees,
        levers,
        std::tuple<double, double, double>{0.0, 1.0, 0.0},
        height,
        given->number()
    );
}

inline List<double> _posed(const Ref<ContactPose>& pose) {
    List<double> out;
    for (int place = 0; place < lang::len(pose->local); place++) {
        single_rules::_put_turn(out, lang::at(pose->local, place));
        single_rules::_put(out, lang::at(pose->at, place));
    }
    return out;
}

inline List<double> _geometry(const std::string& rule, const Ref<RuleInput>& given) {
    List<double> out;
    if (rule == "between") {
        std::tuple<double, double, double> a = plain_vectors::unit(single_rules::_vector(given));
        single_rules::_put_turn(out, plain_vectors::between(a, plain_vectors::unit(single_rules::_vector(given))));
    } else if (rule == "unit") {
        single_rules::_put(out, plain_vectors::unit(single_rules::_vector(given)));
        single_rules::_put_turn(out, single_rules::_turn(given));
    } else if (rule == "apart") {
        List<std::tuple<double, double, double>> ends;
        for (int _n = 0; _n < 4; _n++) {
            ends.push_back(single_rules::_vector(given));
        }
        single_rules::_put_turn(out, contact_solve::apart(ends, 0, 2));
    } else {
        Ref<ContactPose> pose = lang::made<ContactPose>();
        Ref<ContactRig> rig = single_rules::_rig(given, pose);
        contact_solve::spread(rig, pose);
        bool moved = false;
        if (rule == "bring") {
            int side = single_rules::_count(given);
            std::tuple<double, double, double> goal = single_rules::_vector(given);
            std::tuple<double, double, double, double> turn = single_rules::_turn(given);
            contact_solve::bring(rig, pose, side, goal, turn, single_rules::_vector(given));
        } else if (rule == "contacts") {
            List<Ref<HandGoal>> goals;
            int size = single_rules::_count(given);
            for (int _n = 0; _n < size; _n++) {
                int arm = single_rules::_count(given);
                int to = single_rules::_count(given);
                std::tuple<double, double, double> at = single_rules::_vector(given);
                std::tuple<double, double, double, double> turn = single_rules::_turn(given);
                goals.push_back(lang::made<HandGoal>(arm, to, at, turn, given->number()));
            }
            moved = contact_solve::solve_contacts(rig, pose, goals);
            for (const auto& end : contact_solve::capsule_ends(rig, pose)) {
                single_rules::_put(out, end);
            }
        } else {
            Ref<WeightRig> body = single_rules::_weight_rig(given, rig);
            out.push_back(weight_solve::stands_by(body, pose));
            if (rule == "weight") {
                List<double> drive;
                for (int _n = 0; _n < 16; _n++) {
                    drive.push_back(given->number());
                }
                double follow = given->number();
                moved = weight_solve::answer_arms(body, pose, drive, follow, given->number());
            } else {
                for (int side = 0; side < 2; side++) {
                    std::tuple<double, double, double> foot = single_rules::_vector(given);
                    double reach = given->number();
                    out.push_back(weight_solve::hips_sink(body, pose, side, foot, reach, given->number()));
                }
                List<Ref<FootGoal>> feet;
                int size = single_rules::_count(given);
                for (int _n = 0; _n < size; _n++) {
                    feet.push_back(single_rules::_foot(given));
                }
                moved = feet_solve::plant_feet(body, pose, feet, given->number());
            }
        }
        out.push_back(moved ? 1.0 : 0.0);
        contact_solve::spread(rig, pose);
        lang::extend(out, single_rules::_posed(pose));
    }
    return out;
}

// --- where hands and feet are
inline Ref<FootGoal> _foot(const Ref<RuleInput>& given) {
    std::tuple<double, double, double> at = single_rules::_vector(given);
    std::tuple<double, double, double, double> turn = single_rules::_turn(given);
    double planted = given->number();
    return lang::made<FootGoal>(at, turn, planted, given->number());
}

inline List<Ref<FootGoal>> _feet(const Ref<RuleInput>& given) {
    List<Ref<FootGoal>> out;
    int size = single_rules::_count(given);
    for (int _n = 0; _n < size; _n++) {
        out.push_back(single_rules::_foot(given));
    }
    return out;
}

inline void _put_feet(List<double>& out, const List<Ref<FootGoal>>& feet) {
    for (const auto& foot : feet) {
        single_rules::_put(out, foot->at);
        single_rules::_put_turn(out, foot->turn);
        lang::extend(out, List<double>{foot->planted, foot->lift});
    }
}

inline List<List<double>> _rows(const Ref<RuleInput>& given, int count, int width) {
    List<List<double>> out;
    for (int _n = 0; _n < count; _n++) {
        List<double> row;
        for (int _k = 0; _k < width; _k++) {
            row.push_back(given->number());
        }
        out.push_back(row);
    }
    return out;
}

inline Ref<ContactSpan> _span(const Ref<RuleInput>& given) {
    double start = given->number();
    double end = given->number();
    double ease_in = given->number();
    double ease_out = given->number();
    List<Ref<ContactKey>> keys;
    int size = single_rules::_count(given);
    for (int _n = 0; _n < size; _n++) {
        double time = given->number();
        std::tuple<double, double, double> at = single_rules::_vector(given);
        keys.push_back(lang::made<ContactKey>(time, at, single_rules::_turn(given)));
    }
    return lang::made<ContactSpan>("left", "palm", "Chest", start, end, keys, ease_in, ease_out);
}

inline List<double> _places(const std::string& rule, const Ref<RuleInput>& given) {
    List<double> out;
    if (rule == "way") {
        Ref<FootGoal> one = single_rules::_foot(given);
        out.push_back(feet_solve::foot_way(one, single_rules::_foot(given)));
    } else if (rule == "steps") {
        double height = given->number();
        List<Ref<FootGoal>> before = single_rules::_feet(given);
        List<Ref<FootGoal>> after = single_rules::_feet(given);
        List<Ref<FootGoal>> first = single_rules::_feet(given);
        List<Ref<FootGoal>> last = single_rules::_feet(given);
        double passed = given->number();
        single_rules::_put_feet(
            out,
            planted_feet::stepped(height, before, after, first, last, passed, given->number())
        );
    } else if (rule == "track") {
        List<List<double>> rows = single_rules::_rows(given, single_rules::_count(given), 16);
        single_rules::_put_feet(out, planted_feet::foot_row(lang::made<FootTrack>(rows), given->number()));
    } else if (rule == "driven") {
        List<List<double>> sways = single_rules::_rows(given, 4, 8);
        lang::extend(out, follow_through::driven(sways, given->number()));
    } else if (rule == "span") {
        Ref<ContactSpan> span = single_rules::_span(given);
        double first_ = given->number();
        double last_ = given->number();
        int size = single_rules::_count(given);
        for (int _n = 0; _n < size; _n++) {
            out.push_back(contact_spans::contact_weight(span, given->number(), first_, last_));
        }
    } else {
        Ref<ContactSpan> span = single_rules::_span(given);
        int size = single_rules::_count(given);
        for (int _n = 0; _n < size; _n++) {
            Ref<ContactKey> key = contact_spans::contact_key(span, given->number());
            out.push_back(key->time);
            single_rules::_put(out, key->at);
            single_rules::_put_turn(out, key->turn);
        }
    }
    return out;
}

// --- the mouth
inline void _put_spelled(List<double>& out, const Ref<Spelled>& found) {
    for (const auto& piece : found->pieces) {
        lang::extend(out, List<double>{
            piece->start,
            piece->end,
            static_cast<double>(lang::index(words::VISEMES, piece->viseme)),
            piece->strength
        });
    }
    lang::extend(out, found->peaks);
    lang::extend(out, found->strengths);
}

inline List<double> _mouth(const Ref<Alphabet>& alphabet, const std::string& rule, const Ref<RuleInput>& given) {
    List<double> out;
    if (rule == "mouth") {
        List<Ref<MouthPiece>> pieces;
        int size = single_rules::_count(given);
        for (int _n = 0; _n < size; _n++) {
            double start = given->number();
            double end = given->number();
            double strength = given->number();
            pieces.push_back(lang::made<MouthPiece>(start, end, given->text(), strength));
        }
        for (const auto& row : mouth::mouth_track(pieces, given->number())) {
            lang::extend(out, row);
        }
    } else if (rule == "soften") {
        List<List<double>> rows = single_rules::_rows(given, 3, 14);
        lang::extend(out, lang::at(rows, 1));
        mouth::soften(out, lang::at(rows, 0), lang::at(rows, 1), lang::at(rows, 2));
    } else if (rule == "accents") {
        int count = single_rules::_count(given);
        List<List<double>> rows = single_rules::_rows(given, 2, count);
        lang::extend(out, mouth::accents_of(lang::at(rows, 0), lang::at(rows, 1)));
    } else if (rule == "letters") {
        int size = single_rules::_count(given);
        for (int _n = 0; _n < size; _n++) {
            out.push_back(graphemes::measure_letter(single_rules::_count(given)));
        }
    } else {
        std::string text = given->text();
        out.push_back(graphemes::read_aloud(alphabet, text));
        single_rules::_put_spelled(out, graphemes::spelled(alphabet, text, given->number()));
    }
    return out;
}

// --- the times of lines
inline Ref<LineTiming> _line(const Ref<RuleInput>& given) {
    List<Ref<SpokenWord>> words;
    int size = single_rules::_count(given);
    for (int _n = 0; _n < size; _n++) {
        double start = given->number();
        double end = given->number();
        words.push_back(lang::made<SpokenWord>(
            given->text(),
            start,
            end >= single_rules::OPEN ? std::nullopt : std::optional<double>(end)
        ));
    }
    List<Ref<VisemeMark>> marks;
    size = single_rules::_count(given);
    for (int _n = 0; _n < size; _n++) {
        double at = given->number();
        double weight = given->number();
        marks.push_back(lang::made<VisemeMark>(at, given->text(), weight));
    }
    return lang::made<LineTiming>(words, marks, given->number());
}

inline void _put_line(const Ref<Alphabet>& alphabet, List<double>& out, const Ref<LineTiming>& line) {
    for (const auto& word : line->words) {
        lang::extend(out, List<double>{
            word->start,
            !word->end.has_value() ? single_rules::OPEN : *word->end,
            static_cast<double>(lang::len(alphabet->letters(word->text)))
        });
    }
    for (const auto& mark : line->marks) {
        lang::extend(out, List<double>{mark->at, static_cast<double>(lang::len(mark->viseme)), mark->weight});
    }
    out.push_back(line->later);
}

inline double _yes(bool which) {
    return which ? 1.0 : 0.0;
}

inline List<double> _timing(const Ref<Alphabet>& alphabet, const std::string& rule, const Ref<RuleInput>& given) {
    List<double> out;
    if (rule == "timing") {
        std::string name = given->text();
        double duration = given->number();
        Ref<LineTiming> raw = single_rules::_line(given);
        std::string wrong = line_timing::wrong_in(
            raw->words,
            raw->marks,
            name,
            duration >= single_rules::OPEN ? std::nullopt : std::optional<double>(duration)
        );
        lang::extend(out, List<double>{
            static_cast<double>(lang::len(wrong)),
            static_cast<double>(lang::len(line_timing::set_of(raw->marks)))
        });
        single_rules::_put_line(alphabet, out, lang::made<LineTiming>(line_timing::join_letters(alphabet, raw->words)));
        Ref<LineTiming> paced = line_timing::pace_text(
            alphabet,
            given->text(),
            duration >= single_rules::OPEN ? std::nullopt : std::optional<double>(duration)
        );
        single_rules::_put_line(alphabet, out, paced);
        if (wrong != "") {
            return out;
        }
        Ref<LineTiming> line = line_timing::timing_of(alphabet, raw->words, raw->marks, name);
        single_rules::_put_line(alphabet, out, line);
        single_rules::_put_line(alphabet, out, line_timing::shifted(line, 0.5));
        out.push_back(line_timing::timed_seconds(
            line,
            duration >= single_rules::OPEN ? std::nullopt : std::optional<double>(duration)
        ));
        single_rules::_put_spelled(out, line_timing::timed_sounds(alphabet, line));
    } else {
        Ref<LineTiming> old = single_rules::_line(given);
        Ref<LineTiming> new_ = single_rules::_line(given);
        double said = given->number();
        out.push_back(single_rules::_yes(line_timing::alike_timings(old, new_)));
        out.push_back(single_rules::_yes(line_timing::alike_timings(old, nullptr)));
        out.push_back(single_rules::_yes(line_timing::alike_timings(nullptr, nullptr)));
        out.push_back(single_rules::_yes(line_timing::tells_on(old, new_)));
        out.push_back(single_rules::_yes(line_timing::restarts(old, new_, said)));
        double first = given->number();
        double last = given->number();
        out.push_back(single_rules::_yes(line_timing::comes_late(first, last, given->number(), said)));
        single_rules::_put_line(alphabet, out, line_timing::place_told(old, new_, said));
        single_rules::_put_line(alphabet, out, line_timing::extended(old, new_, said));
    }
    return out;
}

// --- moods
inline Ref<Mood> _mood_of(const Ref<RuleInput>& given) {
    double valence = given->number();
    double arousal = given->number();
    return lang::made<Mood>(valence, arousal, given->number());
}

/// Read moods; numbers above 8 stand for what is not told.
inline List<Ref<MoodFrom>> _told(const Ref<RuleInput>& given) {
    List<Ref<MoodFrom>> out;
    int size = single_rules::_count(given);
    for (int _n = 0; _n < size; _n++) {
        double start = given->number();
        double valence = given->number();
        double arousal = given->number();
        double intensity = given->number();
        double end = given->number();
        out.push_back(lang::made<MoodFrom>(
            "told",
            start,
            valence > 8 ? std::nullopt : std::optional<double>(valence),
            arousal > 8 ? std::nullopt : std::optional<double>(arousal),
            intensity > 8 ? std::nullopt : std::optional<double>(intensity),
            end >= single_rules::OPEN ? INFINITY : end
        ));
    }
    return out;
}

inline void _put_mood(List<double>& out, const Ref<Mood>& mood) {
    lang::extend(out, List<double>{mood->valence, mood->arousal, mood->intensity});
}

inline List<double> _mood(std::uint32_t seed, const std::string& rule, const Ref<RuleInput>& given) {
    List<double> out;
    if (rule == "mood") {
        Ref<Mood> mood = single_rules::_mood_of(given);
        List<std::string> tags = List<std::string>{given->text(), given->text()};
        Ref<LifeMood> life = mood::life_of(mood);
        Ref<Bearing> how = mood::bearing(mood);
        lang::extend(out, List<double>{
            mood::liveliness(mood),
            mood::fear(mood),
            mood::anger(mood),
            mood::extent(mood),
            mood::tempo(mood)
        });
        lang::extend(out, List<double>{
            life->breathing,
            life->breath_rate,
            life->aversion_rate,
            life->saccade_rate,
            life->blinks
        });
        lang::extend(out, List<double>{how->droop, how->lift, how->lids, how->smile, how->frown, how->brow_down});
        lang::extend(out, List<double>{how->brow_up, how->thrust, how->tension, how->brows, how->closed});
        out.push_back(mood::favour(mood, tags, given->number()));
        out.push_back(single_rules::_yes(mood::made_for(mood, tags)));
        out.push_back(mood::distance(mood, "happy"));
        for (int n = 0; n < 4; n++) {
            out.push_back(single_rules::_yes(mood::stirs(mood, seed, lang::text(lang::at(tags, 0), n))));
        }
        double valence = given->number();
        double arousal = given->number();
        single_rules::_put_mood(out, mood::changed(mood, valence, arousal, given->number()));
    } else if (rule == "moods") {
        Ref<Mood> base = single_rules::_mood_of(given);
        Ref<Moods> moods = lang::made<Moods>(base, single_rules::_told(given));
        double start = given->number();
        List<double> edges = mood::mood_edges(moods, start, given->number());
        lang::extend(out, edges);
        for (const auto& edge : edges) {
            single_rules::_put_mood(out, mood::mood_at(moods, edge));
        }
    } else if (rule == "shown") {
        int count = single_rules::_count(given);
        List<List<double>> starts = single_rules::_rows(given, 1, count);
        List<List<double>> values = single_rules::_rows(given, count, 3);
        single_rules::_put_mood(out, mood::shown(lang::at(starts, 0), values, given->number()));
    } else {
        List<Ref<MoodFrom>> told = single_rules::_told(given);
        for (const auto& one : mood::lasting(told, given->number())) {
            lang::extend(out, List<double>{one->start, one->end > single_rules::OPEN ? single_rules::OPEN : one->end});
        }
    }
    return out;
}

// --- times
inline List<double> _times(std::uint32_t seed, const std::string& rule, const Ref<RuleInput>& given) {
    List<double> out;
    if (rule == "lull") {
        std::string key = given->text();
        bool talks = given->number() > 0.0;
        out.push_back(director::find_lull(seed, key, talks, given->number()));
    } else if (rule == "intervals") {
        int count = single_rules::_count(given);
        double share = given->number();
        double beats = director::beat_interval("arms", count);
        lang::extend(out, List<double>{
            beats,
            director::beat_interval("head", count),
            director::posture("body"),
            director::posture("arms"),
            director::posture("head")
        });
        lang::extend(out, List<double>{
            director::repeat_interval("gesture", share, beats),
            director::repeat_interval("fidget", share, beats)
        });
        out.push_back(director::freshness(given->number(), beats));
    } else if (rule == "curves") {
        double x = given->number();
        lang::extend(out, List<double>{
            mood::faded(x),
            cue_times::ease(x),
            mood::leaning(x, 4.0),
            mood::turn_extent(1.25, x)
        });
        lang::extend(out, List<double>{
            mood::shut_in(0.25, x),
            mood::shut_in(0.75, x),
            mood::drag(2.0, 1.0 + 0.5 * x * x)
        });
        out.push_back(choice::log_normal(8.0, 14.0, 0.25 + 0.125 * x * x, 0.5));
    }
    return out;
}

}  // namespace single_rules

}  // namespace metagraph
