// SPDX-License-Identifier: MIT
#include "gltf/GltfNames.h"

#include "text/FileText.h"
#include "text/UniqueName.h"

#include <algorithm>
#include <numeric>
#include <vector>

namespace osgSkin {
namespace {

using nlohmann::json;

/// Whose name goes before: joints, then what moves, then nodes without a mesh.
std::vector<int> ranksOf(const json& gltf, std::size_t nodes) {
    const json none = json::array();
    std::vector<int> ranks(nodes, 2);
    for (std::size_t n = 0; n < nodes; ++n)
        if (gltf.at("nodes").at(n).contains("mesh")) ranks[n] = 3;
    for (const json& animation : gltf.value("animations", none))
        for (const json& channel : animation.value("channels", none)) {
            const json& target = channel.at("target");
            if (target.contains("node")) {
                int& rank = ranks.at(target.at("node").get<std::size_t>());
                rank = std::min(rank, 1);
            }
        }
    for (const json& skin : gltf.value("skins", none))
        for (const json& joint : skin.at("joints")) ranks.at(joint.get<std::size_t>()) = 0;
    return ranks;
}

std::string givenName(const json& node, std::size_t index) {
    const std::string name = node.value("name", std::string());
    return name.empty() ? "nodes[" + std::to_string(index) + "]" : name; // as Assimp has it
}

} // namespace

void nameNodes(GltfFile& file) {
    const auto found = file.json.find("nodes");
    if (found == file.json.end()) return;
    json& nodes = *found;
    const std::vector<int> ranks = ranksOf(file.json, nodes.size());
    std::vector<std::size_t> order(nodes.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return ranks[a] < ranks[b]; });
    UniqueNames taken;
    std::vector<std::size_t> twins;
    for (const std::size_t n : order) {
        const std::string name = givenName(nodes[n], n);
        if (taken.take(name))
            nodes[n]["name"] = name;
        else
            twins.push_back(n);
    }
    std::vector<std::string> renamed;
    for (const std::size_t n : twins) {
        nodes[n]["name"] = taken.unique(givenName(nodes[n], n));
        if (ranks[n] == 0) renamed.push_back(nodes[n]["name"].get<std::string>());
    }
    if (!renamed.empty())
        tellOf(file.path, "joints are called alike; " + std::to_string(renamed.size()) +
                              " got a name of their own, as \"" + renamed.front() + '"');
    if (!file.json.contains("scenes")) return;
    for (json& scene : file.json.at("scenes")) {
        if (scene.value("nodes", json::array()).size() < 2) continue;
        nodes.push_back({{"name", taken.unique("scene")}, {"children", scene.at("nodes")}});
        scene["nodes"] = json::array({nodes.size() - 1});
    }
}

} // namespace osgSkin
