// SPDX-License-Identifier: MIT
// Figures without a skin, made of rigid parts that joints carry.
#include "scene/SourceScene.h"

#include <algorithm>
#include <memory>
#include <set>
#include <string>
#include <utility>

namespace osgSkin {
namespace {

/// The nodes that the file calls joints, and those that animations move.
std::set<std::string> jointsOf(const SourceScene& scene) {
    std::set<std::string> result = scene.joints;
    for (const auto& animation : scene.animations)
        for (const SourceTrack& track : animation->tracks)
            if (!track.positions.empty() || !track.rotations.empty() || !track.scales.empty())
                result.insert(track.node);
    return result;
}

/// A copy of a mesh that follows one bone.
std::shared_ptr<const SourceMesh> boundTo(const std::string& joint, const glm::dmat4& toJoint,
                                          const SourceMesh& mesh) {
    SourceBone bone{joint, toJoint, {}};
    for (std::size_t v = 0; v < mesh.positions.size(); ++v)
        bone.weights.push_back({static_cast<std::uint32_t>(v), 1.0f});
    auto result = std::make_shared<SourceMesh>(mesh);
    result->bones.push_back(std::move(bone));
    return result;
}

} // namespace

void bindRigidParts(SourceScene& scene) {
    if (std::any_of(scene.meshes.begin(), scene.meshes.end(),
                    [](const auto& mesh) { return !mesh->bones.empty(); }))
        return;
    const std::set<std::string> joints = jointsOf(scene);
    for (SourceNode& node : scene.nodes) {
        glm::dmat4 toJoint(1.0);
        const SourceNode* joint = &node;
        while (joint != nullptr && joints.count(joint->name) == 0) {
            toJoint = joint->matrix * toJoint;
            joint = joint->parent < 0 ? nullptr
                                      : &scene.nodes[static_cast<std::size_t>(joint->parent)];
        }
        if (joint == nullptr) continue;
        for (std::size_t& mesh : node.meshes) {
            scene.meshes.push_back(boundTo(joint->name, toJoint, *scene.meshes[mesh]));
            mesh = scene.meshes.size() - 1;
        }
    }
}

} // namespace osgSkin
