// SPDX-License-Identifier: MIT
#include <osgSkinCharacter/ReadWeights>

#include "options/JsonReader.h"

#include <osgSkin/ExpectedNames>

#include <map>

namespace osgSkin {
namespace {

/// [vertex, weight]
void readPair(const JsonReader& reader, std::uint32_t joint, VertexWeights& weights) {
    const std::size_t size = reader.size();
    if (size != 2)
        reader.failWith("expected a vertex and its weight, found a list of " +
                        std::to_string(size));
    const std::vector<JsonReader> pair = reader.items();
    const std::size_t vertex = pair[0].count();
    if (vertex >= weights.size())
        pair[0].failWith("expected a vertex of the mesh, below " + std::to_string(weights.size()) +
                         ", found " + std::to_string(vertex));
    const double weight = pair[1].number();
    if (weight < 0.0) pair[1].failWith("expected a weight of 0 or more");
    // Each joint's weights are read together, so a repeated vertex is the last entry.
    if (!weights[vertex].empty() && weights[vertex].back().joint == joint)
        pair[0].failWith("vertex " + std::to_string(vertex) +
                         " is there twice, expected one weight for each");
    weights[vertex].push_back({joint, weight});
}

} // namespace

VertexWeights readWeights(const std::string& file, const RestSkeleton& skeleton,
                          std::size_t vertices, const ReadLimits& limits) {
    const nlohmann::json json = JsonReader::parseFile(file, limits);
    const JsonReader root(json, file);
    VertexWeights weights(vertices);
    const std::map<std::string, int> jointOf = skeleton.byName();
    root.require("weights", "each joint's list of vertices and weights")
        .forEachMember([&](const std::string& name, const JsonReader& pairs) {
            const auto joint = jointOf.find(name);
            if (joint == jointOf.end())
                pairs.failWith("not a joint of the skeleton" + expectedNames(name, jointOf));
            pairs.forEachItem([&](const JsonReader& pair) {
                readPair(pair, static_cast<std::uint32_t>(joint->second), weights);
            });
        });
    return weights;
}

} // namespace osgSkin
