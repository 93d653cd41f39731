// SPDX-License-Identifier: GPL-3.0-or-later
#include "Writers.h"

#include <osgSkin/Error>

#include <fstream>

namespace bake {
namespace {

nlohmann::json array(const glm::dvec3& v) {
    return {v.x, v.y, v.z};
}

[[noreturn]] void failToWrite(const std::string& file) {
    throw osgSkin::Error(file + ": cannot be written, expected a writable file");
}

} // namespace

nlohmann::json bindingJson(const osgSkin::Binding& binding) {
    nlohmann::json joints = nlohmann::json::array();
    for (const osgSkin::BoundJoint& joint : binding.joints) {
        const nlohmann::json parent =
            joint.parent < 0
                ? nlohmann::json()
                : nlohmann::json(binding.joints[static_cast<std::size_t>(joint.parent)].name);
        joints.push_back({{"name", joint.name},
                          {"parent", parent},
                          {"centre", array(joint.centre)},
                          {"boneAxis", array(joint.boneAxis)},
                          {"twistAxis", array(joint.twistAxis)}});
    }
    nlohmann::json vertices = nlohmann::json::array();
    for (std::size_t v = 0; v < binding.vertexCount(); ++v) {
        nlohmann::json ratios = nlohmann::json::array();
        for (std::uint32_t i = binding.firstInfluence[v]; i < binding.firstInfluence[v + 1]; ++i) {
            const osgSkin::Influence& influence = binding.influences[i];
            ratios.push_back({binding.joints[influence.joint].name,
                              static_cast<double>(influence.bend),
                              static_cast<double>(influence.twist)});
        }
        vertices.push_back(
            {{"region", binding.joints[binding.regions[v]].name}, {"ratios", std::move(ratios)}});
    }
    return {{"joints", std::move(joints)}, {"vertices", std::move(vertices)}};
}

nlohmann::json poseJson(std::size_t frame, const osgSkin::Binding& binding,
                        const osgSkin::Pose& pose) {
    nlohmann::json joints = nlohmann::json::object();
    for (std::size_t j = 0; j < binding.joints.size(); ++j) {
        const osgSkin::JointTransform& transform = pose.transform(j);
        const glm::dquat& q = transform.rotation;
        joints[binding.joints[j].name] = {{"rotation", {q.w, q.x, q.y, q.z}},
                                          {"translation", array(transform.translation)}};
    }
    return {{"frame", frame}, {"joints", std::move(joints)}};
}

void writeJson(const std::string& file, const nlohmann::json& json) {
    std::ofstream out(file, std::ios::binary);
    out << json << '\n';
    if (!out.flush()) failToWrite(file);
}

} // namespace bake
