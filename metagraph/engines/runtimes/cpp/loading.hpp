// Reading an export: its JSON and its GLB.
#pragma once

#include "asks.hpp"
#include "clip.hpp"
#include "contacts.hpp"
#include "layer_planning.hpp"
#include "weight.hpp"

namespace metagraph {

/// A graph, or why there is none: which file, where in it, what is wrong, and what to do about it.
struct Loaded {
    Ref<const Graph> graph;
    std::string error;
};

namespace loading {

inline constexpr int FORMAT = 1; // the newest version of the export that is read here
inline constexpr double LARGEST = 1e8; // rotations of a clip

inline void read_joints(Graph& out, const Node& root) {
    std::unordered_map<std::string, int> places;
    for (const Node& one : root["joints"].items()) {
        const std::string name = one["name"].text();
        const auto parent = one["parent"].text_or_null();
        if (parent.has_value() && places.count(*parent) == 0) one.wrong("its parent '" + *parent + "' should stand before it");
        out.parents.push_back(parent.has_value() && places.count(*parent) > 0 ? places[*parent] : -1);
        places[name] = lang::len(out.joints);
        out.joints.push_back(name);
        out.parts.push_back(one["part"].text());
        out.sides.push_back(one["side"].text());
        const Node scales = one.maybe("scales");
        const std::string how = scales.empty() ? "both" : scales.text();
        out.larger.push_back(how == "both");
        out.smaller.push_back(how != "neither");
    }
    const List<Node> rotations = root["base"]["rotations"].items(), translations = root["base"]["translations"].items();
    if (rotations.size() != out.joints.size() || translations.size() != out.joints.size() || out.joints.empty()) {
        return root["base"].wrong(lang::text("should have a row for each of ", out.joints.size(), " joints"));
    }
    for (std::size_t j = 0; j < out.joints.size(); j++) {
        out.base.push_back({body::quaternion(rotations[j]), body::vector(translations[j])});
    }
}

inline Ref<Settings> read_settings(Graph& out, const Node& json) {
    if (json["blend"].text() != "3x^2-2x^3") json["blend"].wrong("is a curve that this runtime does not know", "Update the runtime.");
    out.seed = static_cast<std::uint32_t>(json["seed"].within(0, 4294967295.0));
    // What the planner has as constants, other makers' exports may have otherwise.
    auto constant = [&json, &out](const char* name, double value) {
        const double told = json.maybe(name).within_or(0, 1e9, value);
        if (std::abs(told - value) > 1e-9) out.problems.push_back(lang::text("planner.", name, " is ", told, "; it plays with ", value));
    };
    constant("window", layer_planning::WINDOW);
    constant("loop_fade", sampling::LOOP_FADE);
    constant("hurry", cue_shapes::HURRY);
    constant("least_blend", phase_times::LEAST_BLEND);
    return lang::made<Settings>(
        json["alpha"].within(0, 1e15), static_cast<int>(out.seed), json["never_twice"].flag(), json["shortest"].within(0, 1e9),
        json["wait"].within(0, 1e9), json.maybe("memory").within_or(0, 600, 0), json.maybe("rest").within_or(0, 600, 0),
        json.maybe("lookahead").within_or(0, 10, 0.1), json.maybe("variety").within_or(0, 4, 0)
    );
}

inline Ref<Markov> read_markov(const std::string& layer, const Node& json) {
    List<std::tuple<std::string, std::string>> states;
    for (const Node& state : json["states"].items()) {
        const List<Node> both = state.items();
        if (both.size() != 2) {
            state.wrong("should be a limb and a kind");
            continue;
        }
        states.emplace_back(both[0].one_of(graph::LIMBS), both[1].one_of(graph::KINDS));
    }
    List<List<double>> matrix, modes;
    for (const Node& row : json["matrix"].items()) {
        matrix.push_back(row.numbers(lang::len(states)));
        for (const Node& one : row.items()) one.within(0, 1e15);
    }
    List<std::tuple<double, double>> lengths;
    if (!json.maybe("lengths").empty()) {
        for (const Node& one : json["lengths"].items()) {
            const List<double> pair = one.numbers(2);
            if (!(pair[0] > 0)) one.wrong("should be lengths above 0");
            lengths.emplace_back(pair[0], pair[1]);
        }
    }
    if (!json.maybe("modes").empty()) {
        for (const Node& one : json["modes"].items()) modes.push_back(one.numbers(3));
    }
    const List<std::string> tags = json.maybe("tags").empty() ? List<std::string>{} : json["tags"].texts();
    const bool whole = matrix.size() == states.size() && (tags.empty() || tags.size() == states.size())
        && (lengths.empty() || lengths.size() == states.size());
    if (!whole) json.wrong("should have a row of everything for each state");
    if (!modes.empty() && (modes.size() < 3 || modes.size() > words::MODES.size())) json.wrong("should have shares for each mode");
    return lang::made<Markov>(
        layer, states, matrix, json["gap"].within(1e-3, 1e9), json["positive"].number(), json["negative"].number(), tags,
        lengths, modes
    );
}

/// How long clips are, by id.
using Lengths = Map<std::string, double>;

/// Return how far joints move that an action moves in part.
inline List<std::tuple<std::string, double>> read_joint_weights(const Node& json) {
    List<std::tuple<std::string, double>> out;
    if (json.empty()) return out;
    for (const auto& [joint, weight] : json.fields()) out.emplace_back(joint, weight.within(0, 1));
    return out;
}

/// Return an action, and when it plays and its phases.
inline std::pair<Ref<PlacedAction>, Ref<Phases>> read_action(const std::string& layer, const Node& json, const Lengths& clips) {
    const std::string clip = json["clip"].text();
    if (clips.find(clip) == nullptr) json["clip"].wrong("is no clip of the export");
    const double length = clips.find(clip) == nullptr ? 0 : clips.at(clip);
    const double start = std::min(json["start"].within(0, 1e9), length);
    const double end = std::max(start, json["whole_end"].flag() ? length : std::min(json["end"].within(0, 1e9), length));
    const auto stroke = json["stroke"].number_or_null();
    const auto earliest = json["earliest_exit"].number_or_null();
    const Node spacing = json.maybe("spacing"), touching = json.maybe("contacts");
    Action action(
        json["id"].text(), clip, json["kind"].one_of(graph::KINDS), layer, json["stance"].text(), json["name"].text(),
        json["end_stance"].text_or_null(),
        lang::made<Timing>(
            start, end, json["blend_in"].within(0, 1e9), json["blend_out"].within(0, 1e9), json["loop"].flag(), earliest, stroke,
            std::nullopt, std::nullopt, std::nullopt, json.maybe("repeat").within_or(0, 1e9, 0)
        ),
        json["limb"].one_of(graph::LIMBS), json["joints"].texts(), json["tags"].texts(), json["likelihood"].within(0, 1e15),
        json.maybe("cooldown").within_or(0, 1e9, 0),
        spacing.empty() ? std::nullopt : std::optional<int>(spacing.count(0, 1000)),
        touching.empty() ? List<Ref<ContactSpan>>{} : contacts::read(touching), read_joint_weights(json.maybe("joint_weights")),
        "", "", json.maybe("prominence").within_or(0, 1, 0)
    );
    // Where none are told, all of them are at the stroke, and that is halfway unless it was set.
    const double told = std::clamp(stroke.value_or((start + end) / 2), start, end);
    List<double> phases(4, told);
    const Node own = json.maybe("phases");
    if (!own.empty() && own.items().size() == 4) phases = own.numbers(4);
    return {
        lang::made<PlacedAction>(std::move(action)),
        lang::made<Phases>(start, phases[0], phases[1], phases[2], phases[3], end),
    };
}

/// Places in a layer's reach of joints that an action does not move wholly, and how far it does, 0..1: 0 the other arm, and all that
/// it does not name.
inline List<std::pair<int, double>> partly(const Graph& graph, const LayerGraph& layer, const Action& action) {
    const std::string other = action.limb == "left" ? "right" : action.limb == "right" ? "left" : "";
    List<std::pair<int, double>> out;
    for (int n = 0; n < lang::len(layer.reach); n++) {
        const int joint = lang::at(layer.reach, n);
        const bool arm = lang::at(graph.parts, joint) == "arms" && lang::at(graph.sides, joint) == other;
        const bool masked = !action.joints.empty() && !lang::contains(action.joints, lang::at(graph.joints, joint));
        double weight = arm || masked ? 0 : 1;
        for (const auto& [name, told] : action.joint_weights) {
            if (weight > 0 && name == lang::at(graph.joints, joint)) weight = told;
        }
        if (weight < 1) out.emplace_back(n, weight);
    }
    return out;
}

/// Return a layer, with its actions, their phases added to `phases`.
inline Ref<LayerGraph> read_layer(
    const Graph& graph, const std::string& layer, const Node& json, const Lengths& clips, Map<std::string, Ref<Phases>>& phases,
    Map<std::string, double>& vigours
) {
    auto out = lang::made<LayerGraph>();
    List<Ref<Stance>> stances;
    Set<std::string> ids;
    for (const Node& one : json["stances"].items()) {
        const std::string id = one["id"].text();
        if (!ids.insert(id).second) one["id"].wrong("is used twice");
        stances.push_back(lang::made<Stance>(id, layer, one["name"].text()));
    }
    for (std::size_t j = 0; j < graph.joints.size(); j++) {
        const Node weight = json["weights"].maybe(graph.parts[j]);
        const double own = weight.empty() ? 0 : weight.within(0, 100);
        if (own <= 0) continue;
        out->reach.push_back(static_cast<int>(j));
        out->weights.push_back(own);
    }
    const Node arms = json["weights"].maybe("arms");
    out->strength = arms.empty() ? 0.0 : std::min(1.0, arms.within(0, 100));
    List<Ref<Action>> actions;
    for (const Node& one : json["actions"].items()) {
        auto [action, own] = read_action(layer, one, clips);
        if (phases.find(action->id) != nullptr) one["id"].wrong("is used twice");
        phases[action->id] = own;
        vigours[action->id] = one.maybe("vigour").within_or(-1, 1, 0);
        action->partly = partly(graph, *out, *action);
        out->kinds.insert(action->kind);
        actions.push_back(action);
    }
    out->markov = read_markov(layer, json["markov"]);
    out->graph = lang::made<MetaGraph>(layer, stances, actions, json["start"].text_or_null());
    return out;
}

/// Read the clips, and give actions what they show.
inline void read_clips(Graph& out, const Node& root, const Glb& file) {
    List<int> nodes;
    List<Joined> rest;
    const List<Node> joints = root["joints"].items();
    bool any = false;
    for (std::size_t j = 0; j < out.joints.size(); j++) {
        const int node = lang::index(file.nodes, out.joints[j]);
        const bool is = node < lang::len(file.nodes);
        any = any || is;
        nodes.push_back(is ? node : -1);
        rest.push_back(is ? file.own(node) : Joined{body::quaternion(joints[j]["rotation"]), body::vector(joints[j]["translation"])});
        if (!is) out.problems.push_back("the GLB has no joint '" + out.joints[j] + "'; it stays as in the rest pose");
    }
    if (!any) return root["glb"].wrong("has none of the export's joints; it is another's", "Export it again, and copy both files.");
    const Node length = root.maybe("glb_bytes");
    if (!length.empty() && static_cast<double>(file.size()) != length.number()) {
        out.problems.push_back(lang::text(
            "'", root["glb"].text(), "' is not the GLB that this JSON was written with (", file.size(), " bytes, not ", length.number(),
            "): export again, and copy both files"
        ));
    }
    for (const Node& one : root["clips"].items()) {
        const std::string id = one["id"].text(), name = one["name"].text();
        const int wanted = one["animation"].count();
        const bool there = wanted < lang::len(file.animations) && lang::at(file.animations, wanted) == name;
        const int place = there ? wanted : lang::index(file.animations, name);
        if (place >= lang::len(file.animations)) {
            out.problems.push_back("the GLB has no animation '" + name + "'; its actions show their stance");
            continue;
        }
        const ReadClip clip = clip::read(file, place, one["frames"].count(1), one["fps"].number(), nodes, rest, out.morphs);
        for (const auto& [_, layer] : out.layers) {
            Ref<Offsets> offsets;
            for (const auto& [_id, action] : layer->graph->actions) {
                if (action->clip != id) continue;
                if (offsets == nullptr) offsets = clip::offsets(clip, layer->reach, out.base);
                auto& placed = static_cast<PlacedAction&>(*action);
                placed.motion = clip.motion;
                placed.offsets = offsets;
            }
        }
    }
}

inline void read_speech(Graph& out, const Node& root) {
    const Node lines = root.maybe("lines"), voices = root.maybe("voices"), points = root.maybe("points");
    if (!points.empty()) {
        for (const auto& [name, point] : points.fields()) out.points[name] = body::vector(point);
    }
    if (!lines.empty()) {
        for (const auto& [id, json] : lines.fields()) {
            Line line;
            const Node text = json.maybe("text"), asks = json.maybe("asks");
            line.text = text.empty() ? "" : text.text();
            line.duration = json.maybe("duration").number_or_null();
            const Node mood = json.maybe("mood"), intensity = json.maybe("intensity");
            const std::string wrong = mood.empty() ? "" : asks::feeling(mood.value());
            if (!wrong.empty()) mood.wrong(wrong);
            line.mood = mood.value();
            if (!intensity.empty()) line.intensity = intensity.within(0, 2);
            if (!asks.empty()) {
                for (const Node& ask : asks.items()) line.asks.push_back(ask.value());
            }
            out.lines[id] = std::move(line);
        }
    }
    const Node parameters = root.maybe("parameters");
    if (!parameters.empty()) {
        for (const auto& [name, json] : parameters.fields()) out.parameters[name] = parameters::read(json);
    }
    if (!voices.empty()) {
        for (const auto& [id, json] : voices.fields()) out.voices->known[id] = voice::read(json);
    }
}

inline Ref<const Graph> read(const Node& root, const std::uint8_t* glb, std::size_t size, Trouble& trouble) {
    auto out = lang::made<Graph>();
    const int version = root["metagraph"].count();
    if (version > FORMAT) {
        root["metagraph"].wrong(lang::text("is ", version, ", and this runtime knows ", FORMAT), "Update the runtime.");
        return nullptr;
    }
    if (root["randomness"]["hash"].text() != "fnv1a32-mix") {
        root["randomness"].wrong("draws by another hash than this runtime's", "Update the runtime.");
    }
    out->name = root["name"].text();
    read_joints(*out, root);
    const Ref<Settings> settings = read_settings(*out, root["planner"]);
    Lengths clips;
    for (const Node& one : root["clips"].items()) {
        const double fps = one["fps"].within(1e-3, 1e6);
        const int frames = one["frames"].count(1);
        if (static_cast<double>(frames) * lang::len(out->joints) > LARGEST) one["frames"].wrong("is out of range");
        clips[one["id"].text()] = (frames - 1) / fps;
    }
    if (trouble.found()) return nullptr;
    Map<std::string, Ref<Phases>> phases;
    Map<std::string, double> vigours;
    const Node layers = root["layers"];
    for (const std::string& layer : graph::LAYERS) {
        out->layers[layer] = read_layer(*out, layer, layers[layer], clips, phases, vigours);
    }
    out->project = lang::made<Project>(settings, phases, vigours);
    out->life = life::read(root.maybe("life"));
    read_speech(*out, root);
    if (trouble.found()) return nullptr;
    const Glb file(glb, size, root["glb"].text(), trouble);
    if (trouble.found()) return nullptr;
    read_clips(*out, root, file);
    if (!root.maybe("rig").empty()) out->body = body::read(root["rig"], lang::len(out->joints), out->morphs);
    if (!root.maybe("contact_rig").empty()) out->contact_rig = contacts::read_rig(root["contact_rig"], out->joints);
    if (!root.maybe("weight_rig").empty()) out->weight_rig = weight::read_rig(root["weight_rig"], lang::len(out->joints));
    out->arm_tracks = weight::read_tracks(*out, root["clips"]);
    if (out->weight_rig != nullptr) {
        const Node legs = root["weight_rig"].maybe("feet_layer");
        if (!legs.empty() && (legs.text() == "arms" || legs.text() == "head")) out->feet_layer = legs.text();
    }
    out->foot_tracks = weight::read_feet(*out, root["clips"]);
    return trouble.found() ? nullptr : out;
}

}  // namespace loading

/// Return the graph of an export. A clip that the GLB lacks is no error: `problems` lists it, and its actions show their
/// stance. json: the export's text. glb: the bytes of its GLB. file: what to call the JSON in errors.
inline Loaded load(const std::string& json, const std::uint8_t* glb, std::size_t size, const std::string& file = "the export") {
    Trouble trouble;
    json::Parser parser(json);
    const Json document = parser.parse();
    if (!parser.wrong.empty()) {
        trouble.tell(file, parser.wrong, "Export it again.");
        return {nullptr, trouble.words};
    }
    const Ref<const Graph> graph = loading::read(Node(document, file, trouble), glb, size, trouble);
    return {graph, trouble.words};
}

}  // namespace metagraph
