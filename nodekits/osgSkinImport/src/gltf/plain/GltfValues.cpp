// SPDX-License-Identifier: MIT
#include "gltf/plain/GltfValues.h"

#include "text/FileText.h"

#include <osgSkin/GlmTypes>

#include <array>
#include <cmath>
#include <cstddef>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace osgSkin {
namespace {

using nlohmann::json;

constexpr double kRounding = -1e-3; ///< the least weight that exporters make of 0

class ValueChecker {
public:
    ValueChecker(const GltfFile& file, GltfAccessors& accessors)
        : _file(file), _accessors(accessors) {}

    void run() {
        if (!_file.json.contains("meshes")) return;
        const json& meshes = _file.json.at("meshes");
        const std::vector<std::size_t> joints = jointsOf(meshes.size());
        for (std::size_t m = 0; m < meshes.size(); ++m) {
            const json& primitives = meshes[m].at("primitives");
            for (std::size_t p = 0; p < primitives.size(); ++p) {
                _where = "meshes[" + std::to_string(m) + "].primitives[" + std::to_string(p) + "].";
                const json& attributes = primitives[p].at("attributes");
                if (primitives[p].contains("indices"))
                    checkIndices(primitives[p].at("indices").get<std::size_t>(),
                                 attributes.at("POSITION").get<std::size_t>());
                for (const char* set : {"0", "1", "2", "3"})
                    if (joints[m] > 0 && attributes.contains(std::string("JOINTS_") + set))
                        checkWeights(attributes, set, joints[m]);
            }
        }
    }

private:
    /// How many joints each mesh may follow; 0 where it is shown without a skin.
    std::vector<std::size_t> jointsOf(std::size_t meshes) const {
        std::vector<std::size_t> result(meshes, 0);
        if (!_file.json.contains("nodes")) return result;
        for (const json& node : _file.json.at("nodes"))
            if (node.contains("mesh") && node.contains("skin"))
                result[node.at("mesh").get<std::size_t>()] =
                    _file.json.at("skins")
                        .at(node.at("skin").get<std::size_t>())
                        .at("joints")
                        .size();
        return result;
    }

    [[noreturn]] void fail(std::size_t accessor, const std::string& member,
                           const std::string& message) const {
        failFile(_file.path, "malformed glTF: accessors[" + std::to_string(accessor) + "], " +
                                 _where + member + ": " + message);
    }

    void checkIndices(std::size_t accessor, std::size_t positions) {
        const std::size_t vertices = _accessors.count(positions);
        if (!_accessors.hasValues(accessor) || !_indices.emplace(accessor, vertices).second) return;
        const std::vector<double> indices = _accessors.stored(accessor);
        for (std::size_t i = 0; i < indices.size(); ++i)
            if (indices[i] >= double(vertices))
                fail(accessor, "indices",
                     "number " + std::to_string(i) + " is " + wholeOf(indices[i]) +
                         ", expected a vertex below " + std::to_string(vertices));
    }

    void checkWeights(const json& attributes, const std::string& set, std::size_t joints) {
        const auto names = attributes.at("JOINTS_" + set).get<std::size_t>();
        const auto parts = attributes.at("WEIGHTS_" + set).get<std::size_t>();
        if (!_accessors.hasValues(names) || !_accessors.hasValues(parts) ||
            !_weights.insert({names, parts, joints}).second)
            return;
        const std::vector<double> followed = _accessors.stored(names);
        const std::vector<double> weights = _accessors.values(parts);
        for (std::size_t i = 0; i < weights.size(); ++i) {
            if (!(std::isfinite(weights[i]) && weights[i] >= kRounding))
                fail(parts, "WEIGHTS_" + set,
                     vertexOf(i) + " has the weight " + std::to_string(weights[i]) +
                         ", expected a number of 0 or more");
            if (weights[i] > 0.0 && followed[i] >= double(joints))
                fail(names, "JOINTS_" + set,
                     vertexOf(i) + " follows joint " + wholeOf(followed[i]) +
                         ", expected one of the " + std::to_string(joints) + " that the skin has");
        }
    }

    static std::string vertexOf(std::size_t number) {
        return "vertex " + std::to_string(number / 4);
    }

    static std::string wholeOf(double number) {
        return std::to_string(static_cast<std::size_t>(number));
    }

    const GltfFile& _file;
    GltfAccessors& _accessors;
    std::string _where;
    std::set<std::pair<std::size_t, std::size_t>> _indices; ///< known ones, and their vertices
    std::set<std::array<std::size_t, 3>> _weights; ///< known joints, weights, and the skin's joints
};

} // namespace

void requireCoordinates(const GltfFile& file, std::size_t accessor, const std::string& where,
                        const std::vector<double>& values) {
    for (std::size_t i = 0; i < values.size(); ++i)
        if (!(std::abs(values[i]) <= kLargestCoordinate)) // nor NaN
            failFile(file.path, "malformed glTF: accessors[" + std::to_string(accessor) + "], " +
                                    where + ": number " + std::to_string(i) + " is " +
                                    std::to_string(values[i]) + ", expected -1e18 to 1e18");
}

void checkValues(const GltfFile& file, GltfAccessors& accessors) {
    ValueChecker(file, accessors).run();
}

} // namespace osgSkin
