// SPDX-License-Identifier: GPL-3.0-or-later
#include "Writers.h"

#include <osgSkin/Error>

#include <cinttypes>
#include <cstdio>
#include <fstream>
#include <memory>

namespace bake {
namespace {

nlohmann::json array(const glm::dvec3& v) {
    return {v.x, v.y, v.z};
}

[[noreturn]] void failToWrite(const std::string& file) {
    throw osgSkin::Error(file + ": cannot be written, expected a writable file");
}

} // namespace

void writeObj(const std::string& file, const osgSkin::SkinMesh& mesh, const PosedMesh& posed) {
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> out(std::fopen(file.c_str(), "wb"),
                                                              std::fclose);
    if (!out) failToWrite(file);
    for (const glm::dvec3& p : posed.positions)
        std::fprintf(out.get(), "v %.9g %.9g %.9g\n", p.x, p.y, p.z);
    for (const glm::dvec3& n : posed.normals)
        std::fprintf(out.get(), "vn %.5f %.5f %.5f\n", n.x, n.y, n.z);
    std::size_t corner = 0;
    for (const std::uint32_t size : mesh.faceSizes) {
        std::fputc('f', out.get());
        for (std::uint32_t k = 0; k < size; ++k, ++corner) {
            const std::uint32_t v = mesh.faceVertices[corner] + 1;
            std::fprintf(out.get(), " %" PRIu32 "//%" PRIu32, v, v);
        }
        std::fputc('\n', out.get());
    }
    if (std::ferror(out.get()) || std::fflush(out.get()) != 0) failToWrite(file);
}

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
        const osgSkin::Pose::Turn& turn = pose.turn(j);
        const glm::dquat& q = turn.rotation;
        joints[binding.joints[j].name] = {{"rotation", {q.w, q.x, q.y, q.z}},
                                          {"translation", array(turn.translation)}};
    }
    return {{"frame", frame}, {"joints", std::move(joints)}};
}

void writeJson(const std::string& file, const nlohmann::json& json) {
    std::ofstream out(file, std::ios::binary);
    out << json << '\n';
    if (!out.flush()) failToWrite(file);
}

} // namespace bake
