// SPDX-License-Identifier: MIT
#include "gltf/GltfMorphs.h"

#include "text/FileText.h"

#include <algorithm>
#include <set>
#include <string>
#include <vector>

namespace osgSkin {
namespace {

using nlohmann::json;

bool anyOf(const std::vector<double>& weights) {
    return std::any_of(weights.begin(), weights.end(), [](double w) { return w != 0.0; });
}

/// Takes what is moved from the numbers that are `left`, so that a small file does not take
/// minutes.
void applyTo(json& primitive, const std::vector<double>& weights, const GltfFile& file,
             GltfAccessors& accessors, double& left) {
    const json targets = primitive.at("targets");
    for (const char* attribute : {"POSITION", "NORMAL"}) {
        json& attributes = primitive.at("attributes");
        if (!attributes.contains(attribute)) continue;
        const auto own = attributes.at(attribute).get<std::size_t>();
        if (!accessors.hasValues(own)) continue; // compressed
        std::vector<double> values = accessors.values(own);
        for (std::size_t t = 0; t < std::min(weights.size(), targets.size()); ++t) {
            if (weights[t] == 0.0 || !targets[t].contains(attribute)) continue;
            left -= double(values.size());
            if (left < 0.0)
                failFile(file.path, "malformed glTF: expected morph targets of less vertices "
                                    "(option maxSamples)");
            const std::vector<double> moves =
                accessors.values(targets[t].at(attribute).get<std::size_t>());
            for (std::size_t i = 0; i < std::min(values.size(), moves.size()); ++i)
                values[i] += weights[t] * moves[i];
        }
        attributes[attribute] = accessors.add("VEC3", values);
    }
}

/// The meshes whose weights clips move.
std::size_t countMoved(const json& root) {
    std::set<std::size_t> nodes;
    if (root.contains("animations"))
        for (const json& animation : root.at("animations"))
            for (const json& channel : animation.at("channels")) {
                const json& target = channel.at("target");
                if (target.value("path", "") == "weights" && target.contains("node"))
                    nodes.insert(target.at("node").get<std::size_t>());
            }
    return nodes.size();
}

} // namespace

void applyMorphs(GltfFile& file, GltfAccessors& accessors) {
    if (const std::size_t moved = countMoved(file.json))
        tellOf(file.path, "clips change the shape of " + std::to_string(moved) +
                              (moved == 1 ? " mesh" : " meshes") +
                              " by morph targets, which are left as they are at rest");
    if (!file.json.contains("meshes")) return;
    double left = 64.0 * double(file.limits.samplesOf(file.size)); // for a second or so
    for (json& mesh : file.json.at("meshes")) {
        const std::vector<double> weights = mesh.value("weights", std::vector<double>{});
        for (json& primitive : mesh.at("primitives")) {
            if (!primitive.contains("targets")) continue;
            if (anyOf(weights)) applyTo(primitive, weights, file, accessors, left);
            primitive.erase("targets");
        }
        mesh.erase("weights");
    }
}

} // namespace osgSkin
