// SPDX-License-Identifier: GPL-3.0-or-later
#include <osgSkinBind/RigidSplit>

#include <osgSkin/Error>

#include <map>

namespace osgSkin {
namespace {

std::vector<bool> findJoints(const Binding& binding, const std::vector<std::string>& names) {
    std::map<std::string, std::size_t> jointOf;
    for (std::size_t j = 0; j < binding.joints.size(); ++j)
        jointOf.emplace(binding.joints[j].name, j);
    std::vector<bool> result(binding.joints.size(), false);
    for (const std::string& name : names) {
        const auto joint = jointOf.find(name);
        if (joint == jointOf.end())
            throw Error("rigid parts: \"" + name +
                        "\" is not a joint of the binding, expected one of its joints");
        result[joint->second] = true;
    }
    return result;
}

/// The rigid joint that the vertex moves with, or kSkin: its influences must be that joint and all
/// joints above it, each with both ratios 1, and no other.
std::uint32_t rigidJointOf(const Binding& binding, const std::vector<bool>& rigid,
                           std::size_t vertex) {
    const std::uint32_t first = binding.firstInfluence[vertex];
    const std::uint32_t end = binding.firstInfluence[vertex + 1];
    for (std::uint32_t i = first; i < end; ++i)
        if (binding.influences[i].bend != 1.0f || binding.influences[i].twist != 1.0f)
            return RigidSplit::kSkin;
    // Parents come before children: the last is the lowest, and its chain must be all there is.
    const std::uint32_t lowest = binding.influences[end - 1].joint;
    std::uint32_t depth = 0;
    for (int j = static_cast<int>(lowest); j >= 0;
         j = binding.joints[static_cast<std::size_t>(j)].parent) {
        // They are in the joints' order, as those of the chain are.
        if (depth == end - first ||
            static_cast<int>(binding.influences[end - 1 - depth].joint) != j)
            return RigidSplit::kSkin;
        ++depth;
    }
    return rigid[lowest] && depth == end - first ? lowest : RigidSplit::kSkin;
}

} // namespace

RigidSplit splitRigid(const SkinMesh& mesh, const Binding& binding,
                      const std::vector<std::string>& rigid) {
    if (mesh.positions.size() != binding.vertexCount())
        throw Error("rigid parts: the mesh has " + std::to_string(mesh.positions.size()) +
                    " vertices, expected the binding's " + std::to_string(binding.vertexCount()));
    mesh.validate();
    binding.validate();
    const std::vector<bool> isRigid = findJoints(binding, rigid);

    std::vector<std::uint32_t> jointOf(binding.vertexCount());
    for (std::size_t v = 0; v < jointOf.size(); ++v) jointOf[v] = rigidJointOf(binding, isRigid, v);

    RigidSplit split;
    std::size_t corner = 0;
    for (const std::uint32_t size : mesh.faceSizes) {
        std::uint32_t joint = jointOf[mesh.faceVertices[corner]];
        for (std::uint32_t k = 1; k < size; ++k)
            if (jointOf[mesh.faceVertices[corner + k]] != joint) joint = RigidSplit::kSkin;
        split.faceJoint.push_back(joint);
        corner += size;
    }
    return split;
}

} // namespace osgSkin
