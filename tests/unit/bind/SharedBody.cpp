// SPDX-License-Identifier: GPL-3.0-or-later
#include "SharedBody.h"

#include <nlohmann/json.hpp>

#include <fstream>
#include <sstream>

namespace shared {

std::filesystem::path makehuman() {
    return std::filesystem::path(OSGSKIN_SHARED_DATA) / "makehuman";
}

osgSkin::SkinMesh readObj(const std::filesystem::path& file) {
    osgSkin::SkinMesh mesh;
    std::ifstream in(file);
    std::string line;
    while (std::getline(in, line)) {
        std::istringstream words(line);
        std::string kind, corner;
        words >> kind;
        if (kind == "v") {
            glm::dvec3& p = mesh.positions.emplace_back();
            words >> p.x >> p.y >> p.z;
        } else if (kind == "f") {
            mesh.faceSizes.push_back(0);
            while (words >> corner) {
                mesh.faceVertices.push_back(static_cast<std::uint32_t>(std::stoul(corner)) - 1);
                ++mesh.faceSizes.back();
            }
        }
    }
    return mesh;
}

osgSkin::RestSkeleton readJoints(const std::filesystem::path& file) {
    osgSkin::RestSkeleton skeleton;
    const auto vector = [](const nlohmann::json& v) { return glm::dvec3(v[0], v[1], v[2]); };
    const auto document = nlohmann::json::parse(std::ifstream(file));
    for (const nlohmann::json& bone : document.at("bones")) {
        const nlohmann::json& parent = bone.at("parent");
        skeleton.joints.push_back({bone.at("name"), parent.is_null() ? -1 : skeleton.find(parent),
                                   vector(bone.at("head")), vector(bone.at("tail"))});
    }
    return skeleton;
}

std::vector<std::vector<double>> readWeights(const std::filesystem::path& file,
                                             const osgSkin::RestSkeleton& skeleton,
                                             std::size_t vertices) {
    std::vector<std::vector<double>> weights(vertices,
                                             std::vector<double>(skeleton.joints.size(), 0.0));
    const auto document = nlohmann::json::parse(std::ifstream(file));
    for (const auto& [bone, pairs] : document.at("weights").items()) {
        const int joint = skeleton.find(bone);
        if (joint < 0) continue;
        for (const nlohmann::json& pair : pairs)
            weights[pair[0].get<std::size_t>()][static_cast<std::size_t>(joint)] +=
                pair[1].get<double>();
    }
    return weights;
}

} // namespace shared
