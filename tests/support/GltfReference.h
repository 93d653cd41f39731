// SPDX-License-Identifier: MIT
// glTF 2 from its specification alone: linear blending of a file, without Assimp and without our
// importer.
#pragma once

#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace test {

/// Reads files with embedded buffers (.glb, or base64 in the text). Interpolation, matrices, skins
/// and morph targets follow the specification; weights of targets are interpolated linearly.
class GltfReference {
public:
    explicit GltfReference(const std::string& file) {
        std::ifstream in(file, std::ios::binary);
        const std::string all{std::istreambuf_iterator<char>(in), {}};
        std::string text = all;
        if (all.compare(0, 4, "glTF") == 0) {
            const auto size = number<std::uint32_t>(all, 12);
            text = all.substr(20, size);
            if (28 + size <= all.size()) _binary = all.substr(28 + size);
        }
        json = nlohmann::json::parse(text);
        for (const nlohmann::json& buffer : json["buffers"]) {
            const std::string uri = buffer.value("uri", "");
            _buffers.push_back(uri.empty() ? _binary : decoded(uri.substr(uri.find(',') + 1)));
        }
    }

    nlohmann::json json;

    std::vector<double> accessor(std::size_t index) const {
        const nlohmann::json& a = json["accessors"].at(index);
        const std::string type = a["type"];
        const std::size_t width = type == "SCALAR" ? 1
                                  : type == "MAT4" ? 16
                                                   : static_cast<std::size_t>(type[3] - '0');
        const std::size_t count = a["count"];
        std::vector<double> result(width * count, 0.0);
        if (a.contains("bufferView")) result = numbers(a, a["componentType"], width, count);
        if (!a.contains("sparse")) return result;
        const nlohmann::json& sparse = a["sparse"];
        const std::size_t changed = sparse["count"];
        const std::vector<double> at =
            numbers(sparse["indices"], sparse["indices"]["componentType"], 1, changed);
        const std::vector<double> values =
            numbers(sparse["values"], a["componentType"], width, changed);
        for (std::size_t i = 0; i < changed; ++i)
            std::copy_n(&values[width * i], width, &result[width * std::size_t(at[i])]);
        return result;
    }

    double firstKey(std::size_t animation) const {
        double first = INFINITY;
        for (const nlohmann::json& channel :
             json["animations"].at(std::size_t(animation))["channels"])
            first = std::min(first, accessor(samplerOf(animation, channel)["input"])[0]);
        return first;
    }

    /// From each node to the scene, at a time in seconds of an animation; without an animation, the
    /// nodes' own transforms.
    std::vector<glm::dmat4> nodesAt(int animation, double seconds) const {
        std::vector<Local> locals;
        for (const nlohmann::json& node : json["nodes"]) locals.push_back(localOf(node));
        if (animation >= 0)
            for (const nlohmann::json& channel :
                 json["animations"].at(std::size_t(animation))["channels"])
                apply(std::size_t(animation), channel, seconds, locals);
        std::vector<glm::dmat4> world(locals.size(), glm::dmat4(1.0));
        for (const std::size_t root : roots()) place(root, glm::dmat4(1.0), locals, world);
        return world;
    }

    /// All vertices, by primitive, in depth-first node order.
    std::vector<glm::dvec3> verticesAt(int animation, double seconds) {
        const std::vector<glm::dmat4> world = nodesAt(animation, seconds);
        if (_pieces.empty()) findPieces();
        std::vector<glm::dvec3> result;
        for (const Piece& piece : _pieces) {
            const std::vector<double> weights = weightsAt(piece.node, animation, seconds);
            std::vector<glm::dmat4> skinning;
            for (std::size_t j = 0; j < piece.joints.size(); ++j)
                skinning.push_back(world[piece.joints[j]] * piece.inverseBind[j]);
            for (std::size_t v = 0; v < piece.positions.size(); ++v) {
                glm::dmat4 matrix = piece.joints.empty() ? world[piece.node] : glm::dmat4(0.0);
                double sum = 0.0;
                if (!piece.joints.empty()) {
                    for (const auto& [joint, weight] : piece.weights[v]) sum += weight;
                    for (const auto& [joint, weight] : piece.weights[v])
                        matrix += skinning[joint] * (weight / sum);
                }
                glm::dvec3 position = piece.positions[v];
                for (std::size_t t = 0; t < weights.size(); ++t)
                    position += weights[t] * piece.targets[t][v];
                result.emplace_back(matrix * glm::dvec4(position, 1.0));
            }
        }
        return result;
    }

    /// Whether a vertex follows a single joint, [vertex] as in verticesAt().
    std::vector<bool> wholeWeights() {
        if (_pieces.empty()) findPieces();
        std::vector<bool> result;
        for (const Piece& piece : _pieces)
            for (std::size_t v = 0; v < piece.positions.size(); ++v) {
                double most = piece.joints.empty() ? 1.0 : 0.0, sum = most;
                if (!piece.joints.empty())
                    for (const auto& [joint, weight] : piece.weights[v]) {
                        most = std::max(most, weight);
                        sum += weight;
                    }
                result.push_back(most > 0.999 * sum);
            }
        return result;
    }

private:
    struct Local {
        glm::dvec3 t{0.0};
        glm::dquat r{1.0, 0.0, 0.0, 0.0};
        glm::dvec3 s{1.0};
        glm::dmat4 matrix{1.0};
        bool isMatrix = false;
    };
    struct Piece {
        std::size_t node = 0;
        std::vector<glm::dvec3> positions;
        std::vector<std::vector<glm::dvec3>> targets; ///< offsets
        std::vector<std::size_t> joints;              ///< nodes; empty without a skin
        std::vector<glm::dmat4> inverseBind;
        std::vector<std::vector<std::pair<std::size_t, double>>> weights;
    };

    template <typename Number>
    static Number number(const std::string& bytes, std::size_t at) {
        Number value{};
        std::memcpy(&value, bytes.data() + at, sizeof value);
        return value;
    }

    static double component(const std::string& b, std::size_t at, int kind, bool normalized) {
        switch (kind) {
        case 5120:
            return normalized ? std::max(number<std::int8_t>(b, at) / 127.0, -1.0)
                              : number<std::int8_t>(b, at);
        case 5121:
            return number<std::uint8_t>(b, at) / (normalized ? 255.0 : 1.0);
        case 5122:
            return normalized ? std::max(number<std::int16_t>(b, at) / 32767.0, -1.0)
                              : number<std::int16_t>(b, at);
        case 5123:
            return number<std::uint16_t>(b, at) / (normalized ? 65535.0 : 1.0);
        case 5125:
            return number<std::uint32_t>(b, at);
        default:
            return double(number<float>(b, at));
        }
    }

    /// The numbers of an accessor, or of a part of a sparse one.
    std::vector<double> numbers(const nlohmann::json& a, int kind, std::size_t width,
                                std::size_t count) const {
        const nlohmann::json& view = json["bufferViews"].at(a["bufferView"].get<std::size_t>());
        const std::string& bytes = _buffers.at(view["buffer"].get<std::size_t>());
        const std::size_t size = kind < 5122 ? 1 : kind < 5124 ? 2 : 4;
        const std::size_t stride = view.value("byteStride", width * size);
        const std::size_t begin =
            view.value("byteOffset", std::size_t(0)) + a.value("byteOffset", std::size_t(0));
        std::vector<double> result;
        for (std::size_t i = 0; i < count; ++i)
            for (std::size_t k = 0; k < width; ++k)
                result.push_back(component(bytes, begin + i * stride + k * size, kind,
                                           a.value("normalized", false)));
        return result;
    }

    std::vector<glm::dvec3> vectors(std::size_t index) const {
        const std::vector<double> n = accessor(index);
        std::vector<glm::dvec3> result;
        for (std::size_t i = 0; i < n.size(); i += 3) result.emplace_back(n[i], n[i + 1], n[i + 2]);
        return result;
    }

    /// The weights of the morph targets of a node's mesh.
    std::vector<double> weightsAt(std::size_t node, int animation, double seconds) const {
        const nlohmann::json& mesh =
            json["meshes"].at(json["nodes"][node]["mesh"].get<std::size_t>());
        const std::size_t count =
            mesh["primitives"][0].value("targets", nlohmann::json::array()).size();
        std::vector<double> result = mesh.value("weights", std::vector<double>(count, 0.0));
        for (const nlohmann::json& channel :
             animation < 0 ? nlohmann::json::array()
                           : json["animations"].at(std::size_t(animation))["channels"]) {
            const nlohmann::json& target = channel["target"];
            if (target["path"] != "weights" || target["node"] != node) continue;
            const nlohmann::json& sampler = samplerOf(std::size_t(animation), channel);
            const std::vector<double> times = accessor(sampler["input"]);
            const std::vector<double> values = accessor(sampler["output"]);
            const double time = std::clamp(seconds, times.front(), times.back());
            std::size_t k = 0;
            while (k + 2 < times.size() && times[k + 1] <= time) ++k;
            const std::size_t next = std::min(k + 1, times.size() - 1);
            const double u = next > k ? (time - times[k]) / (times[next] - times[k]) : 0.0;
            for (std::size_t t = 0; t < count; ++t)
                result[t] = (1.0 - u) * values[k * count + t] + u * values[next * count + t];
        }
        return result;
    }

    static std::string decoded(const std::string& text) {
        static const std::string letters =
            "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
        std::string result;
        unsigned bits = 0, count = 0;
        for (const char letter : text) {
            if (letter == '=') break;
            bits = bits << 6 | unsigned(letters.find(letter));
            if ((count += 6) >= 8) result.push_back(char(bits >> (count -= 8) & 255u));
        }
        return result;
    }

    static glm::dmat4 matrixOf(const std::vector<double>& numbers, std::size_t first) {
        glm::dmat4 result;
        for (int c = 0; c < 4; ++c)
            for (int r = 0; r < 4; ++r) result[c][r] = numbers[first + std::size_t(4 * c + r)];
        return result;
    }

    static Local localOf(const nlohmann::json& node) {
        Local local;
        if (node.contains("matrix")) {
            local.matrix = matrixOf(node["matrix"].get<std::vector<double>>(), 0);
            local.isMatrix = true;
        }
        if (node.contains("translation"))
            for (int k = 0; k < 3; ++k) local.t[k] = node["translation"][std::size_t(k)];
        if (node.contains("scale"))
            for (int k = 0; k < 3; ++k) local.s[k] = node["scale"][std::size_t(k)];
        if (node.contains("rotation")) {
            const auto q = node["rotation"].get<std::vector<double>>();
            local.r = glm::normalize(glm::dquat(q[3], q[0], q[1], q[2]));
        }
        return local;
    }

    const nlohmann::json& samplerOf(std::size_t animation, const nlohmann::json& channel) const {
        return json["animations"][animation]["samplers"].at(channel["sampler"].get<std::size_t>());
    }

    void apply(std::size_t animation, const nlohmann::json& channel, double seconds,
               std::vector<Local>& locals) const {
        if (!channel["target"].contains("node") || channel["target"]["path"] == "weights") return;
        const nlohmann::json& sampler = samplerOf(animation, channel);
        const std::vector<double> times = accessor(sampler["input"]);
        const std::vector<double> values = accessor(sampler["output"]);
        const std::string path = channel["target"]["path"];
        const std::string how = sampler.value("interpolation", "LINEAR");
        const std::size_t width = path == "rotation" ? 4 : 3;
        const double time = std::clamp(seconds, times.front(), times.back());
        std::size_t k = 0;
        while (k + 2 < times.size() && times[k + 1] <= time) ++k;
        const bool single = times.size() == 1;
        const double d = single ? 1.0 : times[k + 1] - times[k], u = (time - times[k]) / d;
        const auto at = [&](std::size_t key, std::size_t part, std::size_t i) {
            return values[(how == "CUBICSPLINE" ? (3 * key + part) * width : key * width) + i];
        };
        double v[4] = {0.0, 0.0, 0.0, 0.0};
        for (std::size_t i = 0; i < width; ++i) {
            if (single)
                v[i] = at(0, 1, i);
            else if (how == "STEP")
                v[i] = at(u >= 1.0 ? k + 1 : k, 0, i);
            else if (how == "CUBICSPLINE")
                v[i] = (2 * u * u * u - 3 * u * u + 1) * at(k, 1, i) +
                       d * (u * u * u - 2 * u * u + u) * at(k, 2, i) +
                       (3 * u * u - 2 * u * u * u) * at(k + 1, 1, i) +
                       d * (u * u * u - u * u) * at(k + 1, 0, i);
            else
                v[i] = (1 - u) * at(k, 0, i) + u * at(k + 1, 0, i);
        }
        Local& local = locals[channel["target"]["node"].get<std::size_t>()];
        if (path == "translation") local.t = {v[0], v[1], v[2]};
        if (path == "scale") local.s = {v[0], v[1], v[2]};
        if (path != "rotation") return;
        local.r = glm::normalize(glm::dquat(v[3], v[0], v[1], v[2]));
        if (how != "LINEAR" || single) return;
        const glm::dquat a(at(k, 0, 3), at(k, 0, 0), at(k, 0, 1), at(k, 0, 2));
        const glm::dquat b(at(k + 1, 0, 3), at(k + 1, 0, 0), at(k + 1, 0, 1), at(k + 1, 0, 2));
        local.r = glm::normalize(glm::slerp(glm::normalize(a), glm::normalize(b), u));
    }

    std::vector<std::size_t> roots() const {
        const std::size_t scene = json.value("scene", std::size_t(0));
        return json["scenes"].at(scene)["nodes"].get<std::vector<std::size_t>>();
    }

    void place(std::size_t node, const glm::dmat4& above, const std::vector<Local>& locals,
               std::vector<glm::dmat4>& world) const {
        const Local& local = locals[node];
        glm::dmat4 own = local.matrix;
        if (!local.isMatrix) {
            own = glm::mat4_cast(local.r);
            for (int c = 0; c < 3; ++c) own[c] *= local.s[c];
            own[3] = glm::dvec4(local.t, 1.0);
        }
        world[node] = above * own;
        for (const nlohmann::json& child : json["nodes"][node].value("children", nlohmann::json()))
            place(child.get<std::size_t>(), world[node], locals, world);
    }

    void findPieces() {
        for (const std::size_t root : roots()) addPieces(root);
    }

    void addPieces(std::size_t index) {
        const nlohmann::json& node = json["nodes"][index];
        if (node.contains("mesh"))
            for (const nlohmann::json& primitive :
                 json["meshes"].at(node["mesh"].get<std::size_t>())["primitives"])
                addPiece(index, primitive);
        for (const nlohmann::json& child : node.value("children", nlohmann::json()))
            addPieces(child.get<std::size_t>());
    }

    void addPiece(std::size_t index, const nlohmann::json& primitive) {
        const nlohmann::json &node = json["nodes"][index], &attributes = primitive["attributes"];
        Piece piece;
        piece.node = index;
        piece.positions = vectors(attributes["POSITION"]);
        for (const nlohmann::json& target : primitive.value("targets", nlohmann::json::array()))
            piece.targets.push_back(vectors(target["POSITION"]));
        if (node.contains("skin")) {
            const nlohmann::json& skin = json["skins"].at(node["skin"].get<std::size_t>());
            piece.joints = skin["joints"].get<std::vector<std::size_t>>();
            piece.inverseBind.assign(piece.joints.size(), glm::dmat4(1.0));
            if (skin.contains("inverseBindMatrices")) {
                const std::vector<double> m = accessor(skin["inverseBindMatrices"]);
                for (std::size_t j = 0; j < piece.joints.size(); ++j)
                    piece.inverseBind[j] = matrixOf(m, 16 * j);
            }
            piece.weights.resize(piece.positions.size());
            for (int set = 0; attributes.contains("JOINTS_" + std::to_string(set)); ++set) {
                const std::vector<double> j = accessor(attributes["JOINTS_" + std::to_string(set)]);
                const std::vector<double> w =
                    accessor(attributes["WEIGHTS_" + std::to_string(set)]);
                for (std::size_t i = 0; i < j.size(); ++i)
                    if (w[i] > 0.0) piece.weights[i / 4].emplace_back(std::size_t(j[i]), w[i]);
            }
        }
        _pieces.push_back(piece);
    }

    std::string _binary;
    std::vector<std::string> _buffers;
    std::vector<Piece> _pieces;
};

} // namespace test
