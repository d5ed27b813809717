// The life layers' settings, and the words of faces.
#pragma once

#include "node.hpp"
#include "words.hpp"

namespace metagraph {

/// What a mode makes of the amounts: factors, 0 to 4.
struct Manner {
    double breathing = 1.0, breath_rate = 1.0, aversion_rate = 1.0, aversion_length = 1.0, aversion_angle = 1.0;
    double saccades = 1.0, saccade_rate = 1.0, blinks = 1.0;
};

/// The settings; docs/reference/export-rigs.md says what each means. manners: of each mode.
struct Life {
    bool on = true;
    double stillness = 0.0, breathing = 1.0, breath_rate = 14.0, gaze = 1.0, head_share = 0.6;
    double aversion_rate = 12.0, aversion_length = 0.93, aversion_angle = 14.0;
    double saccades = 1.0, saccade_rate = 60.0, lids = 1.0, blinks = 17.0, accent_blinks = 0.7;
    double blink_close = 0.07, blink_open = 0.1, lips = 1.0, lip_smoothing = 0.03, expressions = 1.0, accent_brows = 0.4;
    double valence = 0.0, arousal = 0.0, intensity = 1.0;
    double follow_through = 1.0, shoulder_lift = 1.0, planted_feet = 1.0;
    List<Ref<Manner>> manners = {
        lang::made<Manner>(Manner{1.0, 1.0, 1.1, 2.4, 1.4, 1.0, 0.85, 1.0}),
        lang::made<Manner>(Manner{1.0, 1.0, 1.0, 1.5, 1.1, 0.9, 1.0, 1.45}),
        lang::made<Manner>(Manner{1.15, 1.1, 1.35, 2.3, 1.3, 1.0, 1.0, 0.65}),
        lang::made<Manner>(Manner{0.8, 1.0, 1.1, 3.8, 1.3, 0.7, 0.6, 1.0}),
        lang::made<Manner>(Manner{1.2, 1.0, 0.2, 1.0, 0.6, 0.7, 1.0, 1.6}),
    };
};

namespace life {

inline constexpr int SHAPES = 15; // how many mouth shapes there are
inline constexpr int LIDS = 4; // upper left, upper right, lower left, lower right
inline constexpr int BLINK = LIDS; // place of the blink among the channels a face is worked by
inline constexpr int CHANNELS = LIDS + 1 + SHAPES; // lids, blink, an open jaw, every shape but silence
inline constexpr int FIRST_SHAPE = CHANNELS - (SHAPES - 1);

/// Return the settings with what an export says of them, where it says anything.
inline Ref<Life> read(const Node& json) {
    const auto made = lang::made<Life>();
    Life& out = *made;
    if (json.empty()) return made;
    const Node on = json.maybe("on");
    out.on = on.empty() || on.flag();
    auto dial = [&json](const char* name, double& value, double low, double high) {
        value = json.maybe(name).within_or(low, high, value);
    };
    dial("stillness", out.stillness, 0, 1);
    dial("breathing", out.breathing, 0, 2);
    dial("breath_rate", out.breath_rate, 0, 40);
    dial("gaze", out.gaze, 0, 1);
    dial("head_share", out.head_share, 0, 1);
    dial("aversion_rate", out.aversion_rate, 0, 40);
    dial("aversion_length", out.aversion_length, 0, 5);
    dial("aversion_angle", out.aversion_angle, 0, 40);
    dial("saccades", out.saccades, 0, 2);
    dial("saccade_rate", out.saccade_rate, 0, 180);
    dial("lids", out.lids, 0, 2);
    dial("blinks", out.blinks, 0, 60);
    dial("accent_blinks", out.accent_blinks, 0, 1);
    dial("blink_close", out.blink_close, 0.02, 1);
    dial("blink_open", out.blink_open, 0.02, 1);
    dial("lips", out.lips, 0, 2);
    dial("lip_smoothing", out.lip_smoothing, 0, 0.2);
    dial("expressions", out.expressions, 0, 2);
    dial("accent_brows", out.accent_brows, 0, 1);
    dial("valence", out.valence, -1, 1);
    dial("arousal", out.arousal, -1, 1);
    dial("intensity", out.intensity, 0, 2);
    dial("follow_through", out.follow_through, 0, 2);
    dial("shoulder_lift", out.shoulder_lift, 0, 2);
    dial("planted_feet", out.planted_feet, 0, 1);
    const Node modes = json.maybe("modes");
    if (modes.empty()) return made;
    for (int n = 0; n < lang::len(words::MODES); n++) {
        const Node own = modes.maybe(lang::at(words::MODES, n));
        if (own.empty()) continue;
        auto factor = [&own](const char* name) { return own.maybe(name).within_or(0, 4, 1); };
        lang::at(out.manners, n) = lang::made<Manner>(Manner{
            factor("breathing"), factor("breath_rate"), factor("aversion_rate"), factor("aversion_length"),
            factor("aversion_angle"), factor("saccades"), factor("saccade_rate"), factor("blinks"),
        });
    }
    return made;
}

/// What a mode makes of the amounts.
inline const Ref<Manner>& get_manner(const Ref<Life>& life, const std::string& mode) {
    return lang::at(life->manners, lang::index(words::MODES, mode));
}

/// Return what a mode makes of the amounts, each that a mood changes times a factor.
inline Ref<Manner> scaled(
    const Ref<Manner>& ways, double breathing, double breath_rate, double aversion_rate, double saccade_rate, double blinks
) {
    const auto out = lang::made<Manner>(*ways);
    out->breathing *= breathing;
    out->breath_rate *= breath_rate;
    out->aversion_rate *= aversion_rate;
    out->saccade_rate *= saccade_rate;
    out->blinks *= blinks;
    return out;
}

inline bool is_same_life(const Ref<Life>& one, const Ref<Life>& other) { return one == other; }

}  // namespace life
}  // namespace metagraph
