// The life layers at a time: what they add to the pose the layers have composed. Turns are multiplied on the right of a
// joint's rotation, shifts are added to its translation.
//
//     breath(t) = depth e(min(x / 0.4, (1 - x) / 0.6)),  x: how far the breath has gone, e(x) = 3 x^2 - 2 x^3
//     blink(t)  = e(min(x / close, (close + open - x) / open)),  x: seconds since the blink began
//     lid       = follow x pitch of the eye + blink x (1 - how far it is shut already)
#pragma once

#include "expressions.hpp"
#include "lips.hpp"
#include "solve.hpp"

namespace metagraph {

/// What the life layers make of one body: `find` works a time out, `apply` and `morphs` use what it found.
class Enlivener {
public:
    explicit Enlivener(const Graph& graph)
        : graph_(graph), body_(*graph.body), solver_(*graph.body), added_(graph.morphs.size()) {
        turned_ = body_.chain;
        for (const Shoulder& shoulder : body_.shoulders) turned_.push_back(shoulder.joint);
        for (const Eye& eye : body_.eyes) {
            if (eye.joint >= 0) turned_.push_back(eye.joint);
        }
        lang::extend(turned_, body_.face.joints);
        results_.resize(turned_.size());
    }

    /// Work out what happens at a time on a composed pose, which is only read. gaze: none for a body without a head.
    void find(const List<Joined>& pose, const Schedule& schedule, const Track& track, Gaze* gaze, double time) {
        const Life& life = *graph_.life;
        full_ = breath(*schedule.breaths, time);
        const Ref<Mood> felt = mood::shown(schedule.moods->times, schedule.moods->rows, time);
        bears_ = felt->neutral() ? Bearing() : *mood::bearing(felt);
        for (std::size_t n = 0; n < body_.chain.size(); n++) {
            solver_.chain[n] = lang::at(pose, body_.chain[n]);
            const Quat& breath = body_.breath[n];
            const double half = 0.5 * (full_ * breath.w + bears_.droop * body_.bowed[n] + bears_.thrust * body_.thrust[n]);
            if (half == 0) continue;
            const double s = std::sin(half);
            const Quat turn{s * breath.x, s * breath.y, s * breath.z, std::cos(half)};
            solver_.chain[n].rotation = rotation::multiply(solver_.chain[n].rotation, turn);
        }
        if (gaze != nullptr) {
            gaze->at(time);
            solver_.look(*gaze, life.gaze, 1 - life.stillness, life.head_share);
        } else {
            solver_.rest();
        }
        lids(pose, mood::shut_in(blink(*schedule.blinks, time), bears_.lids));
        const lips::Shown said = life.lips > 0 ? lips::at(graph_, track, time) : lips::Shown{};
        for (std::size_t k = 0; k < said.size(); k++) channels_[life::FIRST_SHAPE + k] = said[k] * life.lips;
    }

    /// Add what was found to a composed pose.
    void apply(List<Joined>& pose) {
        // First all from the pose as it was, then written: a joint may be in it twice, and then the last counts.
        const std::size_t chained = body_.chain.size();
        for (std::size_t n = 0; n < turned_.size(); n++) {
            results_[n] = n < chained ? solver_.chain[n].rotation : lang::at(pose, turned_[n]).rotation;
        }
        for (std::size_t n = 0; n < body_.lookers.size(); n++) {
            turn(static_cast<std::size_t>(body_.lookers[n].place), solver_.turns[n]);
        }
        std::size_t place = chained;
        for (const Shoulder& shoulder : body_.shoulders) {
            turn(place++, shoulder.turn * (full_ + bears_.lift) + shoulder.tense * bears_.tension + shoulder.closed * bears_.closed);
        }
        for (std::size_t n = 0; n < 2; n++) {
            const Eye& eye = body_.eyes[n];
            const double left = solver_.eyes[2 * n], up = solver_.eyes[2 * n + 1];
            if (eye.joint >= 0) turn(place++, eye.turn_left * left + eye.turn_up * up);
        }
        face(pose, place);
        for (std::size_t n = 0; n < turned_.size(); n++) lang::at(pose, turned_[n]).rotation = results_[n];
    }

    /// Add the morph target weights of what was found, by their places in the graph's `morphs`. cues: those that play then.
    void morphs(List<double>& out, const Schedule& schedule, const List<const Cue*>& cues, double time) {
        double values[19 + life::SHAPES];
        values[0] = std::max((shut_[0] + shut_[1]) / 2, channels_[life::BLINK]);
        for (std::size_t side = 0; side < 2; side++) {
            const double left = solver_.eyes[2 * side] / MORPH_LOOK, up = solver_.eyes[2 * side + 1] / MORPH_LOOK;
            double* own = values + 1 + 6 * side;
            own[0] = shut_[side];
            own[1] = -MORPH_WIDE * shut_[side];
            own[2] = left;
            own[3] = -left;
            own[4] = up;
            own[5] = -up;
        }
        for (std::size_t k = 0; k < life::SHAPES; k++) values[13 + k] = channels_[life::BLINK + 1 + k];
        double* feels = values + 13 + life::SHAPES;
        expressions::shown_face(face_, graph_.life, schedule.swells, schedule.emphases, lang::made<Bearing>(bears_), time);
        for (const Cue* cue : cues) expressions::answer(face_, graph_.life, cue->action->tags, cue->start, cue->end, time);
        expressions::settle(face_);
        const double shown[] = {face_->smile, face_->frown, face_->brow_down, face_->brow_up, face_->brows, face_->cheeks};
        std::copy(std::begin(shown), std::end(shown), feels);
        std::fill(added_.begin(), added_.end(), 0.0);
        for (const MorphShare& share : body_.face.morphs) {
            if (values[share.value] > 1e-4) lang::at(added_, share.target) += values[share.value] * share.weight;
        }
        // As far as clips leave them room.
        for (std::size_t n = 0; n < added_.size(); n++) {
            out[n] += std::min(1.0, added_[n]) * (1.0 - std::clamp(out[n], 0.0, 1.0));
        }
    }

private:
    static constexpr double INHALE = 0.4; // of a breath
    static constexpr double MORPH_LOOK = 30 * solve::RADIANS; // the turn of an eye that a morph target of a look stands for
    // how far morph targets shut for an eye that looks down a radian
    static constexpr double MORPH_FOLLOWS[] = {0.6 / (40 * solve::RADIANS), 0.6 / (40 * solve::RADIANS), 0, 0};
    static constexpr double MORPH_WIDE = 0.6; // of a target that opens wide, for a lid as far open as it would be shut

    const Graph& graph_;
    const Body& body_;
    Solver solver_;
    List<int> turned_; // the chain, then shoulders, eyes that are joints, the face's
    List<Quat> results_;
    std::array<double, life::CHANNELS> channels_{};
    std::array<double, life::LIDS> shut_{};
    double full_ = 0; // how full the chest is
    Bearing bears_;
    Ref<FaceShown> face_ = lang::made<FaceShown>(0, 0, 0, 0, 0, 0);
    List<double> added_;

    /// Return how full the chest is, 0 at rest, about 1 at the top of a breath.
    double breath(const Lane& lane, double time) const {
        const int n = lang::bisect_right(lane.times, time) - 1;
        if (n < 0) return 0;
        const List<double>& value = lang::at(lane.rows, n);
        const double gone = (time - lang::at(lane.times, n)) / value[0];
        const double full = rotation::ease(std::min(gone / INHALE, (1 - gone) / (1 - INHALE)));
        return graph_.life->breathing * (1 - graph_.life->stillness) * value[1] * full;
    }

    /// Return how far a blink has shut the eyes, 0..1.
    double blink(const Lane& lane, double time) const {
        const double close = graph_.life->blink_close, whole = close + graph_.life->blink_open;
        double out = 0;
        // A slow one may still be opening when the next begins.
        for (int n = lang::bisect_right(lane.times, time) - 1; n >= 0 && time - lang::at(lane.times, n) < whole; n--) {
            const double gone = time - lang::at(lane.times, n);
            const double far = lang::at(lane.rows, n)[0] == 3 ? schedule::HALF : 1; // some are incomplete
            const double shut = rotation::ease(std::min(gone / close, (whole - gone) / graph_.life->blink_open));
            out = std::max(out, far * shut);
        }
        return out;
    }

    void lids(const List<Joined>& pose, double blink) {
        const Face& face = body_.face;
        const bool joints = std::any_of(face.lids.begin(), face.lids.end(), [](int joint) { return joint >= 0; });
        for (std::size_t n = 0; n < life::LIDS; n++) {
            const std::size_t side = n % 2;
            const Eye& eye = body_.eyes[side];
            double down = -solver_.eyes[2 * side + 1];
            if (eye.joint >= 0) down += solve::part_along(lang::at(pose, eye.joint).rotation, eye.down);
            const int lid = face.lids[n];
            const double already = lid >= 0 ? solve::part_along(lang::at(pose, lid).rotation, face.shut_by[n]) : 0;
            const double follows = joints ? face.follows[n] : MORPH_FOLLOWS[n];
            shut_[n] = solve::lid(down, graph_.life->lids * follows, already, blink);
            channels_[n] = shut_[n] - already;
        }
        channels_[life::BLINK] = blink;
    }

    /// Turn the face's joints and shift them: sums over channels.
    void face(List<Joined>& pose, std::size_t first) {
        for (std::size_t f = 0; f < body_.face.joints.size(); f++) {
            Vec by, to;
            for (std::size_t c = 0; c < channels_.size(); c++) {
                if (channels_[c] == 0) continue;
                by += body_.face.turns[c][f] * channels_[c];
                to += body_.face.shifts[c][f] * channels_[c];
            }
            turn(first + f, by);
            lang::at(pose, body_.face.joints[f]).translation += to;
        }
    }

    /// Turn a result by a rotation vector.
    void turn(std::size_t place, const Vec& by) {
        if (by == Vec{}) return;
        results_[place] = rotation::multiply(results_[place], rotation::from_vector(by));
    }
};

}  // namespace metagraph
