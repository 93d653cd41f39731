// SPDX-License-Identifier: GPL-3.0-or-later
#include "Writers.h"

#include "Bytes.h"

#include <algorithm>
#include <vector>

namespace bake {
namespace {

nlohmann::json array(const glm::dvec3& v) {
    return {v.x, v.y, v.z};
}

const char* nameOf(osgSkin::CorrectiveJoint::Basis basis) {
    switch (basis) {
    case osgSkin::CorrectiveJoint::Basis::Hinge:
        return "hinge";
    case osgSkin::CorrectiveJoint::Basis::TurnedHinge:
        return "turned_hinge";
    case osgSkin::CorrectiveJoint::Basis::Ball:
        return "ball";
    case osgSkin::CorrectiveJoint::Basis::Round:
        return "round";
    case osgSkin::CorrectiveJoint::Basis::Input:
        break;
    }
    return "input";
}

/// The scalar functions of each joint that has correctives.
nlohmann::json functionsJson(const osgSkin::Binding& binding) {
    nlohmann::json list = nlohmann::json::array();
    for (const osgSkin::CorrectiveJoint& joint : binding.correctives.joints) {
        const std::size_t count = joint.functionCount();
        nlohmann::json rows = nlohmann::json::array();
        for (std::size_t k = 0; k < joint.modes; ++k) {
            const auto row = joint.coefficients.begin() + std::ptrdiff_t(k * count);
            rows.push_back(std::vector<double>(row, row + std::ptrdiff_t(count)));
        }
        nlohmann::json functions{{"basis", nameOf(joint.basis)},
                                 {"low", {joint.low.x, joint.low.y}},
                                 {"high", {joint.high.x, joint.high.y}},
                                 {"coefficients", std::move(rows)}};
        if (joint.basis == osgSkin::CorrectiveJoint::Basis::Input) {
            functions["input"] = binding.correctives.inputs[joint.joint];
        } else {
            functions["joint"] = binding.joints[joint.joint].name;
            functions["axis"] = array(joint.axis);
            functions["knots"] = joint.knots;
        }
        list.push_back(std::move(functions));
    }
    return list;
}

/// A vertex's vectors, one for each mode of each joint that corrects it.
nlohmann::json vectorsJson(const osgSkin::Binding& binding, std::size_t vertex) {
    const osgSkin::Correctives& from = binding.correctives;
    nlohmann::json list = nlohmann::json::array();
    for (std::uint32_t i = from.firstEntry[vertex]; i < from.firstEntry[vertex + 1]; ++i) {
        const osgSkin::CorrectiveJoint& joint = from.joints[from.entries[i].joint];
        const std::int16_t* share = &from.shares[from.entries[i].firstShare];
        nlohmann::json vectors = nlohmann::json::array();
        for (std::size_t k = 0; k < joint.modes; ++k, share += 3)
            vectors.push_back(array(glm::dvec3(share[0], share[1], share[2]) /
                                    double(osgSkin::Correctives::kUnit)));
        list.push_back({from.entries[i].joint, std::move(vectors)});
    }
    return list;
}

} // namespace

nlohmann::json bindingJson(const osgSkin::Binding& binding) {
    nlohmann::json joints = nlohmann::json::array();
    const std::vector<std::uint32_t> order = osgSkin::productOrder(binding.joints);
    const std::vector<std::uint32_t> places = osgSkin::productPlaces(order);
    for (const std::uint32_t j : order) {
        const osgSkin::BoundJoint& joint = binding.joints[j];
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
        std::vector<osgSkin::Influence> influences(
            binding.influences.begin() + binding.firstInfluence[v],
            binding.influences.begin() + binding.firstInfluence[v + 1]);
        std::sort(influences.begin(), influences.end(),
                  [&](const auto& a, const auto& b) { return places[a.joint] < places[b.joint]; });
        for (const osgSkin::Influence& influence : influences) {
            ratios.push_back({binding.joints[influence.joint].name,
                              static_cast<double>(influence.bend),
                              static_cast<double>(influence.twist)});
        }
        vertices.push_back(
            {{"region", binding.joints[binding.regions[v]].name}, {"ratios", std::move(ratios)}});
        if (!binding.correctives.empty()) vertices.back()["correctives"] = vectorsJson(binding, v);
    }
    nlohmann::json result = {{"joints", std::move(joints)}, {"vertices", std::move(vertices)}};
    if (!binding.correctives.empty()) result["correctives"] = functionsJson(binding);
    return result;
}

nlohmann::json poseJson(std::size_t frame, const osgSkin::Binding& binding,
                        const osgSkin::Pose& pose) {
    nlohmann::json joints = nlohmann::json::object();
    for (std::size_t j = 0; j < binding.joints.size(); ++j) {
        const osgSkin::JointTransform& transform = pose.transform(j);
        const glm::dquat& q = transform.rotation;
        joints[binding.joints[j].name] = {{"rotation", {q.w, q.x, q.y, q.z}},
                                          {"translation", array(transform.translation)}};
        if (transform.scale != 1.0) joints[binding.joints[j].name]["scale"] = transform.scale;
    }
    nlohmann::json result{{"frame", frame}, {"joints", std::move(joints)}};
    const std::vector<std::string>& inputs = binding.correctives.inputs;
    for (std::size_t i = 0; i < inputs.size(); ++i)
        result["inputs"][inputs[i]] = double(pose.input(i));
    return result;
}

void writeJson(const std::string& file, const nlohmann::json& json) {
    // Joints' names may be in no UTF-8, which JSON is.
    writeBytes(file, json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + '\n');
}

} // namespace bake
