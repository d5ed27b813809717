// Reading the export's GLB: joint nodes and animations, as far as a runtime needs them.
#pragma once

#include <cstring>
#include <unordered_map>

#include "meshopt.hpp"
#include "node.hpp"
#include "rotation.hpp"

namespace metagraph {

/// What one channel of an animation moves: its key times, seconds, and values, `width` of them a key.
struct GlbTrack {
    int node = -1;
    std::string path;
    List<float> times, values;
    int width = 0;
    bool steps = false;
};

/// A parsed GLB. What is wrong is told to the trouble, by the file's name.
class Glb {
public:
    Glb(const std::uint8_t* data, std::size_t size, std::string name, Trouble& trouble)
        : data_(data), size_(size), name_(std::move(name)), trouble_(trouble) {
        read();
    }

    List<std::string> nodes, animations; // their names

    std::size_t size() const { return size_; }

    /// A node's own translation or rotation.
    Joined own(int node) const {
        const Node one = at("nodes", node);
        Joined out;
        if (!one.maybe("rotation").empty()) {
            const List<double> q = one["rotation"].numbers(4);
            out.rotation = {q[0], q[1], q[2], q[3]};
        }
        if (!one.maybe("translation").empty()) {
            const List<double> t = one["translation"].numbers(3);
            out.translation = {t[0], t[1], t[2]};
        }
        return out;
    }

    List<GlbTrack> tracks(int animation) const {
        List<GlbTrack> out;
        const Node one = at("animations", animation);
        const List<Node> samplers = one["samplers"].items();
        for (const Node& channel : one["channels"].items()) {
            const std::size_t place = static_cast<std::size_t>(channel["sampler"].count());
            if (place >= samplers.size()) {
                channel.wrong("has no sampler");
                continue;
            }
            const Node& sampler = samplers[place];
            const Node target = channel["target"];
            GlbTrack track;
            const Node interpolation = sampler.maybe("interpolation");
            const std::string way = interpolation.empty() ? "LINEAR" : interpolation.text();
            if (way == "CUBICSPLINE") sampler.wrong("is cubic; Metagraph writes linear animations");
            track.node = target.maybe("node").empty() ? -1 : target["node"].count();
            track.path = target["path"].text();
            track.steps = way == "STEP";
            track.times = numbers(sampler["input"].count());
            track.values = numbers(sampler["output"].count());
            if (track.times.empty() || track.values.size() % track.times.size() != 0) {
                sampler.wrong("has no values for its keys");
                continue;
            }
            track.width = static_cast<int>(track.values.size() / track.times.size());
            if ((track.path == "rotation" && track.width != 4) || (track.path == "translation" && track.width != 3)) {
                sampler.wrong("has values of another width than its path");
                continue;
            }
            out.push_back(std::move(track));
        }
        return out;
    }

    /// The names of a mesh node's morph targets.
    List<std::string> morph_names(int node) const {
        const Node mesh = at("nodes", node).maybe("mesh");
        if (mesh.empty()) return {};
        const Node names = at("meshes", mesh.count()).maybe("extras").maybe("targetNames");
        return names.empty() ? List<std::string>{} : names.texts();
    }

private:
    const std::uint8_t* data_;
    std::size_t size_;
    std::string name_;
    Trouble& trouble_;
    Json document_;
    std::size_t binary_ = 0, binary_size_ = 0;
    mutable std::unordered_map<int, List<std::uint8_t>> unpacked_; // views

    void tell(const std::string& what) const { trouble_.tell(name_, what, "Export it again, and copy both files."); }

    std::uint64_t word(std::size_t place) const {
        std::uint64_t out = 0;
        for (std::size_t n = 0; n < 4; n++) out |= static_cast<std::uint64_t>(data_[place + n]) << (8 * n);
        return out;
    }

    void read() {
        if (data_ == nullptr || size_ < 20 || word(0) != 0x46546C67 || word(4) != 2) {
            return tell("is not a binary glTF 2.0 file (GLB)");
        }
        const std::uint64_t whole = word(8), json = word(12);
        if (whole > size_ || 20 + json > size_) {
            return tell(lang::text("is cut off: ", size_, " of ", whole, " bytes are there"));
        }
        if (word(16) != 0x4E4F534A) return tell("does not begin with its JSON");
        const std::string text(reinterpret_cast<const char*>(data_) + 20, static_cast<std::size_t>(json));
        json::Parser parser(text);
        document_ = parser.parse();
        if (!parser.wrong.empty()) return tell(parser.wrong);
        const std::size_t behind = 20 + static_cast<std::size_t>(json);
        if (behind + 8 <= size_ && word(behind + 4) == 0x004E4942) {
            binary_ = behind + 8;
            binary_size_ = std::min(static_cast<std::size_t>(word(behind)), size_ - binary_);
        }
        const Node root = node(document_, "");
        const Node needed = root.maybe("extensionsRequired");
        if (!needed.empty()) {
            for (const std::string& extension : needed.texts()) {
                if (extension != "KHR_mesh_quantization" && extension != "EXT_meshopt_compression") tell("needs the extension " + extension);
            }
        }
        nodes = names("nodes");
        animations = names("animations");
    }

    Node node(const Json& value, const std::string& place) const { return Node(value, name_ + place, trouble_); }

    List<std::string> names(const std::string& kind) const {
        List<std::string> out;
        const Node every = node(document_, "").maybe(kind);
        if (every.empty()) return out;
        for (const Node& one : every.items()) {
            const Node name = one.maybe("name");
            out.push_back(name.empty() ? "" : name.text());
        }
        return out;
    }

    /// One of a list of the document.
    Node at(const std::string& kind, int place) const {
        static const Json none = Json::object();
        const Json* every = document_.find(kind);
        const std::string where = lang::text(".", kind, "[", place, "]");
        if (every == nullptr || place < 0 || place >= lang::len(every->items)) {
            tell(lang::text("has no ", kind, " ", place));
            return node(none, where);
        }
        return node(lang::at(every->items, place), where);
    }

    /// An accessor's values as numbers, those of normalised integers from -1 to 1.
    List<float> numbers(int accessor) const {
        const Node of = at("accessors", accessor);
        const int place = of["bufferView"].count();
        const Node view = at("bufferViews", place);
        const Node packed = view.maybe("extensions").empty() ? Node(view.maybe("extensions")) : view["extensions"].maybe("EXT_meshopt_compression");
        static const List<std::string> kinds = {"SCALAR", "VEC2", "VEC3", "VEC4"};
        const std::size_t width = static_cast<std::size_t>(lang::index(kinds, of["type"].one_of(kinds))) + 1;
        const int type = of["componentType"].count();
        const std::size_t size = type == 5126 ? 4 : type == 5122 || type == 5123 ? 2 : type == 5120 || type == 5121 ? 1 : 0;
        const std::size_t count = static_cast<std::size_t>(of["count"].count());
        auto whole = [](const Node& number, std::size_t usual) {
            return number.empty() ? usual : static_cast<std::size_t>(number.count());
        };
        const std::size_t stride = whole(view.maybe("byteStride"), size * width);
        const List<std::uint8_t>* own = packed.empty() ? nullptr : &unpacked(place, packed);
        const std::uint8_t* from = own != nullptr ? own->data() : data_ + binary_;
        const std::size_t begin = (own != nullptr ? 0 : whole(view.maybe("byteOffset"), 0)) + whole(of.maybe("byteOffset"), 0);
        if (size == 0 || !of.maybe("sparse").empty()) of.wrong("is of a kind that is not read here");
        const std::size_t needed = count == 0 ? 0 : (count - 1) * stride + size * width;
        if (size == 0 || trouble_.found() || begin + needed > (own != nullptr ? own->size() : binary_size_)) {
            of.wrong("lies outside the file's data; the file is cut off or damaged");
            return {};
        }
        const Node normal = of.maybe("normalized");
        const bool normalized = !normal.empty() && normal.flag();
        List<float> out(count * width);
        for (std::size_t n = 0; n < out.size(); n++) {
            out[n] = component(from + begin + n / width * stride + n % width * size, type, normalized);
        }
        return out;
    }

    /// A packed view's bytes; none where they cannot be read, which is told.
    const List<std::uint8_t>& unpacked(int view, const Node& packed) const {
        const auto known = unpacked_.find(view);
        if (known != unpacked_.end()) return known->second;
        const Node offset = packed.maybe("byteOffset"), filter = packed.maybe("filter");
        auto size = [&packed](const char* name) { return static_cast<std::size_t>(packed[name].count()); };
        const std::size_t begin = offset.empty() ? 0 : static_cast<std::size_t>(offset.count()), length = size("byteLength");
        std::string wrong = "lies outside the file's data; the file is cut off or damaged";
        List<std::uint8_t>& out = unpacked_[view];
        if (!trouble_.found() && begin + length <= binary_size_ && packed["mode"].text() == "ATTRIBUTES") {
            out = meshopt::attributes(data_ + binary_ + begin, length, size("count"), size("byteStride"), wrong);
            if (wrong.empty()) meshopt::unfilter(out, size("byteStride"), filter.empty() ? "NONE" : filter.text(), wrong);
        }
        if (!wrong.empty()) packed.wrong(wrong);
        return out;
    }

    static float component(const std::uint8_t* at, int type, bool normalized) {
        const std::uint32_t two = type == 5120 || type == 5121 ? 0 : at[0] | static_cast<std::uint32_t>(at[1]) << 8;
        auto signed_one = [normalized](double value, double most) {
            return static_cast<float>(normalized ? std::max(value / most, -1.0) : value);
        };
        switch (type) {
            case 5120: return signed_one(static_cast<std::int8_t>(at[0]), 127);
            case 5121: return static_cast<float>(at[0] / (normalized ? 255.0 : 1.0));
            case 5122: return signed_one(static_cast<std::int16_t>(two), 32767);
            case 5123: return static_cast<float>(two / (normalized ? 65535.0 : 1.0));
            default: break;
        }
        const std::uint32_t four = two | static_cast<std::uint32_t>(at[2]) << 16 | static_cast<std::uint32_t>(at[3]) << 24;
        float out = 0.0f;
        std::memcpy(&out, &four, sizeof out);
        return out;
    }
};

namespace glb {

/// Return a track's values at the frames n / fps [frames, width]: rotations by slerp, all else by straight lines, held
/// before the first key and after the last.
inline List<float> resample(const GlbTrack& track, int frames, double fps) {
    const std::size_t width = static_cast<std::size_t>(track.width), keys = track.times.size();
    List<float> out(static_cast<std::size_t>(frames) * width);
    std::size_t key = 0;
    for (std::size_t frame = 0; frame < static_cast<std::size_t>(frames); frame++) {
        const double time = static_cast<double>(frame) / fps;
        while (key + 1 < keys && track.times[key + 1] <= time) key++;
        const std::size_t next = std::min(key + 1, keys - 1);
        const double span = static_cast<double>(track.times[next]) - track.times[key];
        const double part = track.steps || span <= 0 ? 0 : std::clamp((time - track.times[key]) / span, 0.0, 1.0);
        const float* a = &track.values[key * width];
        const float* b = &track.values[next * width];
        float* o = &out[frame * width];
        if (track.path == "rotation") {
            const Quat q = rotation::normalized(rotation::slerp({a[0], a[1], a[2], a[3]}, {b[0], b[1], b[2], b[3]}, part));
            o[0] = static_cast<float>(q.x);
            o[1] = static_cast<float>(q.y);
            o[2] = static_cast<float>(q.z);
            o[3] = static_cast<float>(q.w);
        } else {
            for (std::size_t k = 0; k < width; k++) o[k] = static_cast<float>(a[k] * (1 - part) + b[k] * part);
        }
    }
    return out;
}

}  // namespace glb
}  // namespace metagraph
