// SPDX-License-Identifier: MIT
#include "PaintedWeights.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>

namespace bench {
namespace {

/// Sorts out what is not positive and makes the sum 1.
Weights::Vertex normalised(const std::map<std::uint32_t, double>& weights) {
    double sum = 0.0;
    for (const auto& [joint, weight] : weights) sum += std::max(0.0, weight);
    Weights::Vertex result;
    for (const auto& [joint, weight] : weights)
        if (weight > 0.0) result.emplace_back(joint, static_cast<float>(weight / sum));
    return result;
}

} // namespace

std::size_t Weights::groupCount() const {
    return std::set<Vertex>(vertices.begin(), vertices.end()).size();
}

Weights readPaintedWeights(const std::string& file, const std::vector<osgSkin::BoundJoint>& joints,
                           std::size_t vertices) {
    Weights result;
    std::ifstream in(file);
    if (!in) return result;
    result.name = std::filesystem::path(file).stem().string();
    std::map<std::string, std::uint32_t> index;
    for (std::uint32_t j = 0; j < joints.size(); ++j) index[joints[j].name] = j;
    std::vector<std::map<std::uint32_t, double>> painted(vertices);
    const nlohmann::json document = nlohmann::json::parse(in);
    for (const auto& [bone, pairs] : document.at("weights").items())
        if (const auto joint = index.find(bone); joint != index.end())
            for (const nlohmann::json& pair : pairs)
                painted.at(pair[0].get<std::size_t>())[joint->second] += pair[1].get<double>();
    for (auto& vertex : painted) {
        if (vertex.empty()) vertex[0] = 1.0;
        result.vertices.push_back(normalised(vertex));
    }
    return result;
}

Weights weightsFromRatios(const osgSkin::Binding& binding) {
    Weights result;
    result.name = "from our own ratios";
    for (std::size_t v = 0; v < binding.vertexCount(); ++v) {
        std::map<std::uint32_t, double> weights;
        for (std::uint32_t i = binding.firstInfluence[v]; i < binding.firstInfluence[v + 1]; ++i) {
            const osgSkin::Influence& influence = binding.influences[i];
            const auto share = static_cast<double>(influence.bend);
            weights[influence.joint] += share;
            // Joints that the vertex does not follow pass their child's share on.
            int parent = binding.joints[influence.joint].parent;
            while (parent > 0 && !weights.count(static_cast<std::uint32_t>(parent)))
                parent = binding.joints[static_cast<std::size_t>(parent)].parent;
            if (parent >= 0) weights[static_cast<std::uint32_t>(parent)] -= share;
        }
        result.vertices.push_back(normalised(weights));
    }
    return result;
}

Weights blend(const Weights& weights, const std::vector<Blend>& vertices) {
    Weights result;
    result.name = weights.name;
    result.vertices.reserve(vertices.size());
    for (const Blend& vertex : vertices) {
        if (vertex.share[0] == 1.0) {
            result.vertices.push_back(weights.vertices[vertex.corner[0]]);
            continue;
        }
        std::map<std::uint32_t, double> sum;
        for (std::size_t k = 0; k < 3; ++k)
            for (const auto& [joint, weight] : weights.vertices[vertex.corner[k]])
                sum[joint] += vertex.share[k] * static_cast<double>(weight);
        result.vertices.push_back(normalised(sum));
    }
    return result;
}

} // namespace bench
