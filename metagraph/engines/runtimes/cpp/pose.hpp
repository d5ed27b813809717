// The one evaluator: what pose a plan gives at a time. Layers add their offsets from the base pose (Borer et al., section 5):
// a joint's rotation is `base * body^w * arms^w * head^w`, its translation a sum; then the body answers its arms, and the other
// life layers are added.
#pragma once

#include "contacts.hpp"
#include "enliven.hpp"
#include "plan.hpp"
#include "weight.hpp"

namespace metagraph {

namespace pose {

/// The clip seconds a cue shows at a time: its tempo, but for its hold; again and again what it repeats.
inline double clip_seconds(const Ref<Cue>& cue, double time) {
    if (cue->repeats()) return cue_times::cue_seconds(cue, time);
    const double elapsed = time - cue->start;
    if (cue->hold <= 0) return cue->entry + elapsed * cue->tempo;
    const double held = std::clamp(elapsed - (cue->hold_from - cue->entry) / cue->tempo, 0.0, cue->hold);
    return cue->entry + (elapsed - held) * cue->tempo + held * ((cue->hold_to - cue->hold_from) / cue->hold);
}

/// How much of a cue shows at a time within it: rising over its blend in, falling over its blend out.
inline double cue_weight(const Cue& cue, double time) {
    const double rise = cue.blend_in > 0 ? rotation::ease((time - cue.start) / cue.blend_in) : 1;
    const double fall = cue.blend_out > 0 ? rotation::ease((cue.end - time) / cue.blend_out) : 1;
    return rise * fall;
}

}  // namespace pose

/// Plays one plan after the other. It remembers where it was, so that asking for one time after another costs next to no
/// search; any times in any order give the same. Players may work on threads of their own; each is for one at a time.
class Player {
public:
    explicit Player(Ref<const Graph> graph, Ref<const Plan> plan = nullptr)
        : graph_(std::move(graph)), pose_(graph_->joints.size()), shown_(pose_.size()), stance_(pose_.size()),
          other_(pose_.size()), spare_(pose_.size()), life_(graph_->body.has_value() ? lang::made<Enlivener>(*graph_) : nullptr) {
        set_plan(plan == nullptr ? lang::made<Plan>() : std::move(plan));
    }

    const Graph& graph() const { return *graph_; }

    void set_plan(Ref<const Plan> plan) {
        if (plan_ == plan) return;
        const bool same = plan_ != nullptr && plan_->life == plan->life;
        plan_ = std::move(plan);
        sways_ = Map<int, List<double>>();
        for (std::size_t n = 0; n < 3; n++) layers_[n].plan = plan_->layers.at(graph::LAYERS[n]).get();
        if (same || life_ == nullptr) return;
        const bool looks = !graph_->body->lookers.empty() && !plan_->life->targets.empty();
        gaze_ = looks ? lang::made<Gaze>(*graph_, plan_->life) : nullptr;
    }

    /// The pose at a time, local, of the graph's joints; the next one overwrites it. alive: with the life layers, as far as
    /// the export has them on. Times before 0 and after the plan's end rest in the first and last stance. Actions whose clip
    /// is missing show their stance.
    const List<Joined>& pose(double time, bool alive = true) {
        compose(time);
        if (alive) weigh(time);
        if (alive && lives()) {
            life_->find(pose_, *plan_->life, *plan_->track, gaze_.get(), time);
            life_->apply(pose_);
        }
        if (graph_->contact_rig != nullptr) contacts::touch(graph_->contact_rig, goals(time), pose_);
        return pose_;
    }

    /// Write the weight of each of the graph's morph targets at a time, 0..1.
    void morphs(double time, List<double>& out, bool alive = true) {
        out.assign(graph_->morphs.size(), 0.0);
        if (out.empty()) return;
        List<const Cue*> cues;
        for (Layer& layer : layers_) {
            const Ref<Cue> cue = cue_at(layer, time);
            const double weight = cue == nullptr ? 0 : pose::cue_weight(*cue, time);
            if (cue != nullptr) {
                cues.push_back(cue.get());
                add_morphs(*cue->action, pose::clip_seconds(cue, time), weight, out);
            }
            if (layer.plan->rests.empty()) continue;
            const Rest& rest = *lang::at(layer.plan->rests, rest_at(layer, time));
            const auto [seconds, other, old] = loop_seconds(*rest.action, time - rest.start);
            add_morphs(*rest.action, seconds, (1 - weight) * (1 - old), out);
            add_morphs(*rest.action, other, (1 - weight) * old, out);
        }
        if (alive && lives() && !graph_->body->face.morphs.empty()) {
            compose(time); // eyes made of morph targets hold while the head moves
            weigh(time);
            life_->find(pose_, *plan_->life, *plan_->track, gaze_.get(), time);
            life_->morphs(out, *plan_->life, cues, time);
        }
        for (double& weight : out) weight = std::clamp(weight, 0.0, 1.0);
    }

private:
    /// A layer of the plan, and the cue and rest that were found last.
    struct Layer {
        const LayerPlan* plan = nullptr;
        int cue = 0, rest = 0;
    };

    Ref<const Graph> graph_;
    Ref<const Plan> plan_;
    // room for working in
    List<Joined> pose_, shown_, stance_, other_, spare_;
    Ref<Enlivener> life_;
    Ref<Gaze> gaze_;
    std::array<Layer, 3> layers_;
    Map<int, List<double>> sways_; // what the arms do at the times that are looked at

    bool lives() const { return graph_->life->on && life_ != nullptr && plan_->life->end > 0; }

    /// Where contacts of all layers want the hands at a time.
    List<Ref<HandGoal>> goals(double time) {
        List<Ref<HandGoal>> out;
        if (!graph_->contact_rig->contacts) return out;
        for (std::size_t n = 0; n < 3; n++) {
            const LayerGraph& own = graph_->layer(graph::LAYERS[n]);
            const Ref<LayerPlan>& plan = plan_->layers.at(graph::LAYERS[n]);
            if (own.strength <= 0) continue;
            const auto [cue, place] = playing(n, time);
            for (auto& goal : contact_goals::layer_goals(graph_->contact_rig, graph_->project, plan, cue, place, time, own.strength)) {
                out.push_back(std::move(goal));
            }
        }
        return out;
    }

    /// The cue with motion that plays in a layer, or none, and the place of the rest in force, -1 for none.
    std::tuple<Ref<Cue>, int> playing(std::size_t n, double time) {
        const Ref<LayerPlan>& plan = plan_->layers.at(graph::LAYERS[n]);
        const bool plays = cue_at(layers_[n], time) != nullptr;
        Ref<Cue> cue = plays ? lang::at(plan->cues, layers_[n].cue - 1) : nullptr;
        if (cue != nullptr && placed(*cue->action).offsets == nullptr) cue = nullptr;
        return {cue, plan->rests.empty() ? -1 : rest_at(layers_[n], time)};
    }

    /// Let the feet of the composed pose stay planted, and its body answer its arms.
    void weigh(double time) {
        const Life& life = *graph_->life;
        const double calm = 1 - life.stillness;
        if (graph_->weight_rig == nullptr || !life.on || plan_->life->end <= 0) return;
        const List<double> drive = drive_at(time);
        List<Ref<FootGoal>> feet;
        if (life.planted_feet > 0) {
            const std::size_t n = graph_->feet_layer == "body" ? 0 : graph_->feet_layer == "arms" ? 1 : 2; // of LAYERS
            const auto [cue, place] = playing(n, time);
            feet = planted_feet::foot_goals(
                graph_->project, graph_->foot_tracks, graph_->weight_rig->height, plan_->layers.at(graph::LAYERS[n]), cue, place, time
            );
        }
        if (feet.empty() && !weight_solve::moves_body(drive)) return;
        weight::answer(
            graph_->weight_rig, feet, drive, life.planted_feet, life.follow_through * calm, life.shoulder_lift * calm, pose_
        );
    }

    /// What of the arms moves the body at a time, nothing where it does not answer them.
    List<double> drive_at(double time) {
        const Life& life = *graph_->life;
        if (life.stillness >= 1 || (life.follow_through <= 0 && life.shoulder_lift <= 0)) return {};
        if (graph_->weight_rig->strength <= 0 || plan_->layers.at(graph::LAYERS[1])->cues.empty()) return {};
        const int last = follow_through::knot_before(time);
        List<List<double>> sways;
        for (int n = last - follow_through::KNOTS + 1; n <= last; n++) sways.push_back(sway(n));
        return follow_through::driven(sways, time);
    }

    List<double> sway(int number) {
        const auto found = sways_.find(number);
        if (found != nullptr) return *found;
        const double time = follow_through::knot_time(number);
        const auto [cue, place] = playing(1, time);
        const auto [body_cue, body_place] = playing(0, time);
        const List<double> out = follow_through::arm_sway(
            graph_->project, graph_->arm_tracks, graph_->weight_rig->body->hands, plan_->layers.at(graph::LAYERS[1]), cue, place,
            plan_->layers.at(graph::LAYERS[0]), body_cue, body_place, time
        );
        if (sways_.size() >= weight::KEPT) sways_ = Map<int, List<double>>();
        sways_[number] = out;
        return out;
    }

    /// Clip seconds of a loop, those of its seam's other side, and how much of that shows. Its last seconds fade into its
    /// first, and its period is that much shorter. Before its beginning a loop runs as if it had gone on for ever; one with a
    /// seam waits in its first pose, so that it starts without a jump.
    std::tuple<double, double, double> loop_seconds(const Action& action, double elapsed) const {
        const Phases& phases = *graph_->project->phases.at(action.id);
        const double length = phases.end - phases.start, seam = std::min(action.timing->blend_in, length / 2), period = length - seam;
        if (period <= 0) return {phases.start, phases.start, 0};
        const double phase = lang::modulo(seam > 0 ? std::max(elapsed, 0.0) : elapsed, period);
        const double old = seam > 0 && elapsed >= period ? 1 - rotation::ease(phase / seam) : 0;
        return {phases.start + phase, phases.start + std::min(period + phase, length), old};
    }

    /// Leave the composed pose at a time in `pose_`, without the life layers.
    void compose(double time) {
        pose_ = graph_->base;
        for (std::size_t n = 0; n < 3; n++) {
            if (layers_[n].plan->rests.empty()) continue;
            const LayerGraph& own = graph_->layer(graph::LAYERS[n]);
            const List<Joined>& added = layer(layers_[n], time, own.reach.size());
            for (std::size_t i = 0; i < own.reach.size(); i++) {
                Joined& joint = lang::at(pose_, own.reach[i]);
                const double weight = own.weights[i];
                const Quat turn = weight == 1 ? added[i].rotation : rotation::power(added[i].rotation, weight);
                joint.rotation = rotation::multiply(joint.rotation, turn);
                joint.translation += added[i].translation * weight;
            }
        }
        for (Joined& joint : pose_) joint.rotation = rotation::normalized(joint.rotation);
    }

    /// Return a layer's offsets at a time, on the joints it reaches.
    const List<Joined>& layer(Layer& layer, double time, std::size_t count) {
        const Ref<Cue> cue = cue_at(layer, time);
        if (cue == nullptr || placed(*cue->action).offsets == nullptr) return stance(layer, time, count);
        const PlacedAction& action = placed(*cue->action);
        show(cue, time, count);
        const bool entering = time < cue->start + cue->blend_in;
        const bool blending = entering || time >= cue->end - cue->blend_out;
        if (!blending && action.partly.empty() && cue->extent == 1) return shown_;
        stance(layer, time, count);
        if (blending && cue->repeats()) {  // at its ends it moves
            mix(stance_, shown_, pose::cue_weight(*cue, time), count, shown_);
        } else if (blending) {
            sample(action, entering ? cue->entry : pose::clip_seconds(cue, cue->end), other_, count);
            blend(pose::cue_weight(*cue, time), count);
        }
        if (cue->extent != 1) extend(cue->extent, graph_->layer(action.layer).reach);
        for (const auto& [place, weight] : action.partly) {
            Joined& joint = lang::at(shown_, place);
            const Joined& rest = lang::at(stance_, place);
            joint.rotation = rotation::nlerp(rest.rotation, joint.rotation, weight);
            joint.translation = rest.translation + (joint.translation - rest.translation) * weight;
        }
        return shown_;
    }

    /// Show what a cue plays of its clip, without its blends. Where it repeats, it goes on from where the cycle before it ended.
    void show(const Ref<Cue>& cue, double time, std::size_t count) {
        const PlacedAction& action = placed(*cue->action);
        sample(action, pose::clip_seconds(cue, time), shown_, count);
        const double left = cue_times::seam_left(cue, time);
        if (left <= 0) return;
        sample(action, cue->cycle_from, other_, count);
        sample(action, cue->cycle_to, spare_, count);
        lead(other_, spare_, left, count);
    }

    /// Blend what is shown in from, or out to, its stance; the clip's pose at that edge is `other_`. Where that is near the
    /// stance, lead the clip: add what the stance differs from it. A crossfade would hold the clip back and then hurry it. Where a
    /// joint has far to turn, crossfade: led, it would do its whole movement around a pose that the clip never has.
    void blend(double weight, std::size_t count) {
        double alike = 1;
        for (std::size_t i = 0; i < count; i++) {
            const Quat& a = other_[i].rotation;
            const Quat& b = stance_[i].rotation;
            alike = std::min(alike, std::abs(a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w));
        }
        // Led while no joint is farther from the stance than the first, crossfaded where one is farther than the second: cosines
        // of half that turn.
        const double LEAD_WITHIN = 0.966, FADE_BEYOND = 0.866;
        const double faded = rotation::ease((LEAD_WITHIN - alike) / (LEAD_WITHIN - FADE_BEYOND));
        if (faded > 0) mix(stance_, shown_, weight, count, spare_);
        lead(other_, stance_, 1 - weight, count);
        if (faded > 0) mix(shown_, spare_, faded, count, shown_);
    }

    /// Add to what is shown a part of the way from a pose to another.
    void lead(const List<Joined>& from, const List<Joined>& to, double weight, std::size_t count) {
        for (std::size_t i = 0; i < count; i++) {
            const Quat away = rotation::multiply(from[i].rotation.back(), to[i].rotation);
            shown_[i].rotation = rotation::multiply(shown_[i].rotation, rotation::nlerp(Quat{}, away, weight));
            shown_[i].translation += (to[i].translation - from[i].translation) * weight;
        }
    }

    /// Play what is shown larger or smaller round the stance.
    void extend(double extent, const List<int>& reach) {
        const List<char>& takes_part = extent > 1 ? graph_->larger : graph_->smaller;
        for (std::size_t i = 0; i < reach.size(); i++) {
            if (lang::at(takes_part, reach[i]) == 0) continue;
            const Joined& rest = stance_[i];
            const Quat away = rotation::multiply(rest.rotation.back(), shown_[i].rotation);
            shown_[i].rotation = rotation::multiply(rest.rotation, rotation::power(away, mood::turn_extent(extent, away.w)));
            shown_[i].translation = rest.translation + (shown_[i].translation - rest.translation) * extent;
        }
    }

    /// Return the offsets of the stance that lies under the cues.
    const List<Joined>& stance(Layer& layer, double time, std::size_t count) {
        const int place = rest_at(layer, time);
        const Rest& rest = *lang::at(layer.plan->rests, place);
        loop(rest, time, stance_, other_, count);
        if (place == 0 || rest.fade_start + rest.fade <= time) return stance_;
        loop(*lang::at(layer.plan->rests, place - 1), time, other_, spare_, count);
        mix(other_, stance_, rotation::ease((time - rest.fade_start) / rest.fade), count, stance_);
        return stance_;
    }

    /// Write the offsets of a loop, its end faded into its beginning.
    void loop(const Rest& rest, double time, List<Joined>& out, List<Joined>& room, std::size_t count) {
        const PlacedAction& action = placed(*rest.action);
        if (action.offsets == nullptr) {
            std::fill(out.begin(), out.begin() + static_cast<std::ptrdiff_t>(count), Joined{});
            return;
        }
        const auto [seconds, other, old] = loop_seconds(action, time - rest.start);
        sample(action, seconds, out, count);
        if (old == 0) return;
        sample(action, other, room, count);
        mix(out, room, old, count, out);
    }

    /// Return the cue playing at a time, none while the stance rests.
    static Ref<Cue> cue_at(Layer& layer, double time) {
        const auto& cues = layer.plan->cues;
        int& cue = layer.cue;
        cue = std::min(cue, lang::len(cues));
        while (cue > 0 && lang::at(cues, cue - 1)->start > time) cue--;
        while (cue < lang::len(cues) && lang::at(cues, cue)->start <= time) cue++;
        const Ref<Cue> found = cue > 0 ? lang::at(cues, cue - 1) : nullptr;
        return found != nullptr && time < found->end ? found : nullptr;
    }

    /// Return the place of the rest that a time is in, or that is taking over.
    static int rest_at(Layer& layer, double time) {
        const auto& rests = layer.plan->rests;
        int& rest = layer.rest;
        rest = std::min(rest, lang::len(rests) - 1);
        while (rest > 0 && lang::at(rests, rest)->fade_start > time) rest--;
        while (rest + 1 < lang::len(rests) && lang::at(rests, rest + 1)->fade_start <= time) rest++;
        return rest;
    }

    /// What an action shows: actions of a graph are all placed ones.
    static const PlacedAction& placed(const Action& action) { return static_cast<const PlacedAction&>(action); }

    /// Write a clip's offsets at clip seconds, straight lines between its frames.
    static void sample(const PlacedAction& action, double seconds, List<Joined>& out, std::size_t count) {
        const auto [low, high, part] = frame_of(*action.motion, seconds);
        const float* a = action.offsets->rotations.data() + low * count * 4;
        const float* b = action.offsets->rotations.data() + high * count * 4;
        for (std::size_t i = 0; i < count; i++, a += 4, b += 4) {
            // Neighbours are on the same side.
            out[i].rotation = rotation::normalized({
                a[0] + (static_cast<double>(b[0]) - a[0]) * part, a[1] + (static_cast<double>(b[1]) - a[1]) * part,
                a[2] + (static_cast<double>(b[2]) - a[2]) * part, a[3] + (static_cast<double>(b[3]) - a[3]) * part,
            });
            out[i].translation = {};
        }
        const List<int>& moved = action.offsets->moved;
        a = action.offsets->translations.data() + low * moved.size() * 3;
        b = action.offsets->translations.data() + high * moved.size() * 3;
        for (const int place : moved) {
            const Vec from{a[0], a[1], a[2]}, to{b[0], b[1], b[2]};
            lang::at(out, place).translation = from + (to - from) * part;
            a += 3;
            b += 3;
        }
    }

    /// Return the frames before and after clip seconds, and how far it is from one to the other.
    static std::tuple<std::size_t, std::size_t, double> frame_of(const Motion& motion, double seconds) {
        const double at = std::clamp(seconds * motion.fps, 0.0, static_cast<double>(motion.frames - 1));
        const int low = std::min(static_cast<int>(at), std::max(0, motion.frames - 2));
        return {static_cast<std::size_t>(low), static_cast<std::size_t>(std::min(low + 1, motion.frames - 1)), at - low};
    }

    /// Write a crossfade, `weight` of the second; may write into either.
    static void mix(const List<Joined>& a, const List<Joined>& b, double weight, std::size_t count, List<Joined>& out) {
        for (std::size_t i = 0; i < count; i++) {
            const Vec to = a[i].translation + (b[i].translation - a[i].translation) * weight;
            out[i].rotation = rotation::nlerp(a[i].rotation, b[i].rotation, weight);
            out[i].translation = to;
        }
    }

    static void add_morphs(const Action& action, double seconds, double share, List<double>& out) {
        const Ref<Motion>& motion = placed(action).motion;
        if (motion == nullptr || share <= 0) return;
        const auto [low, high, part] = frame_of(*motion, seconds);
        for (const MorphTrack& morph : motion->morphs) {
            lang::at(out, morph.place) += share * (morph.weights[low] * (1 - part) + morph.weights[high] * part);
        }
    }
};

}  // namespace metagraph
