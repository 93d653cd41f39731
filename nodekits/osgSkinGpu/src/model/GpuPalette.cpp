// SPDX-License-Identifier: MIT
#include <osgSkinGpu/GpuPalette>

#include <osgSkin/DeformJob>
#include <osgSkin/GlmTypes>

#include <cstdint>
#include <vector>

namespace osgSkin {
namespace {

/// x -> offset + scale * rotation * x, of rest space.
struct SkinningMap {
    glm::dquat rotation{1.0, 0.0, 0.0, 0.0};
    glm::dvec3 offset{0.0};
    double scale = 1.0;
};

osg::Vec4 vec4(const glm::dvec3& v, double w) {
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z),
            static_cast<float>(w)};
}

void writeJoints(const GpuModel& model, const Pose& pose, osg::Vec4* texels) {
    static thread_local std::vector<SkinningMap> maps;
    const std::vector<BoundJoint>& joints = model.model().joints();
    maps.resize(joints.size());
    for (std::size_t j = 0; j < joints.size(); ++j) {
        const JointTransform own = pose.transform(j);
        const int parent = joints[j].parent;
        const SkinningMap above =
            parent < 0 ? SkinningMap{} : maps[static_cast<std::size_t>(parent)];
        SkinningMap& map = maps[j];
        map.rotation = glm::normalize(above.rotation * own.rotation);
        map.offset = above.offset + above.scale * (above.rotation * own.offset);
        map.scale = above.scale * own.scale;
        const glm::dvec3 place = map.offset + map.scale * (map.rotation * joints[j].centre);
        const bool isMoved = own.scale != 1.0 || glm::length(own.translation) > model.smallMove();
        *texels++ = vec4({map.rotation.x, map.rotation.y, map.rotation.z}, map.rotation.w);
        *texels++ = vec4(place, map.scale);
        *texels++ = vec4(own.split.bendAngle * own.split.bendAxis, own.split.twistAngle);
        *texels++ = isMoved ? vec4(own.translation, own.scale - 1.0) : osg::Vec4(0, 0, 0, 0);
    }
}

void writeWeights(const GpuModel& model, const Pose& pose, osg::Vec4* texels) {
    const std::vector<CorrectiveJoint>& joints = model.correctiveJoints();
    for (std::uint32_t j = 0; j < joints.size(); ++j) {
        glm::vec2 weights[CorrectiveJoint::kMaxModes];
        correctiveWeights(model.model(), pose, j, weights);
        for (unsigned int k = 0; k < joints[j].modes; ++k) {
            osg::Vec4& texel = texels[k / 2];
            texel[2 * (k % 2)] = weights[k].x;
            texel[2 * (k % 2) + 1] = weights[k].y;
        }
        texels += (joints[j].modes + 1) / 2;
    }
}

} // namespace

bool writePalette(const GpuModel& model, const Pose& pose, osg::Vec4* texels) {
    const std::size_t joints = model.model().joints().size();
    if (pose.size() != joints) return false;
    writeJoints(model, pose, texels);
    writeWeights(model, pose, texels + 4 * joints);
    return true;
}

} // namespace osgSkin
