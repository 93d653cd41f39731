// SPDX-License-Identifier: MIT
#include <osgSkin/Deform>

#include <osgSkin/Error>

#include <cstdint>
#include <numeric>
#include <string>

namespace osgSkin {

DeformedVertices deform(const SkinModel& model, const Pose& pose, const DeformOptions& options) {
    const std::size_t count = model.vertexCount();
    DeformedVertices result;
    DeformJob job;
    job.model = &model;
    job.pose = &pose;
    job.morphed = options.morphed;
    result.positions.resize(count);
    job.positions = result.positions.data();
    job.positionCount = count;
    if (options.normals) {
        result.normals.resize(count);
        job.normals = result.normals.data();
        job.normalCount = count;
    }
    if (options.restTangents) {
        result.tangents.resize(count);
        job.restTangents = options.restTangents;
        job.tangents = result.tangents.data();
        job.tangentCount = count;
    }
    if (count == 0) return result; // no memory to write to
    job.validate();
    options.reference ? job.runReference() : job.run();
    return result;
}

DeformedVertices deform(const SkinModel& model, const std::vector<glm::dmat4>& skinning,
                        const DeformOptions& options) {
    Pose pose(model.joints(), model.inputs().size());
    if (!pose.set(skinning.data(), skinning.size()))
        throw Error("deform: cannot set a pose of " + std::to_string(pose.size()) +
                    " joints from " + std::to_string(skinning.size()) +
                    " skinning matrices; see Pose::set() for what they may be");
    return deform(model, pose, options);
}

std::vector<glm::dvec3> deform(const Binding& binding, const std::vector<glm::dvec3>& positions,
                               const std::vector<glm::dmat4>& skinning) {
    std::vector<std::uint32_t> source(positions.size());
    std::iota(source.begin(), source.end(), 0u);
    const std::vector<glm::vec3> unused(positions.size(), glm::vec3(0.0f, 1.0f, 0.0f));
    const auto model =
        SkinModel::create(binding, {positions.begin(), positions.end()}, unused, source);
    const DeformedVertices posed = deform(*model, skinning);
    return {posed.positions.begin(), posed.positions.end()};
}

} // namespace osgSkin
