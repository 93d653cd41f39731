// SPDX-License-Identifier: MIT
#include <osgSkinGpu/GpuPalette>

#include <osgSkin/GlmTypes>

#include <algorithm>
#include <cmath>
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

/// As DeformJob has them: correctives that are rounding errors do nothing.
void writeWeights(const GpuModel& model, const Pose& pose, osg::Vec4* texels) {
    for (const CorrectiveJoint& joint : model.correctiveJoints()) {
        double beta[CorrectiveJoint::kMostModes];
        if (joint.basis == CorrectiveJoint::Basis::Input) {
            joint.weights({double(pose.input(joint.joint)), 0.0}, beta);
        } else {
            const BendTwist bend = pose.transform(joint.joint).split;
            joint.weights(joint.coordinates(bend.bendAxis, bend.bendAngle,
                                            model.model().joints()[joint.joint].twistAxis),
                          beta);
        }
        const bool isSomething = std::any_of(beta, beta + joint.modes, [&](double weight) {
            return std::abs(weight) > model.smallMove();
        });
        for (std::size_t k = 0; k < joint.modes; ++k) {
            const double unit = isSomething ? beta[k] / Correctives::kUnit : 0.0;
            const double normals = joint.normalScales.empty() ? 0.0 : unit * joint.normalScales[k];
            osg::Vec4& texel = texels[k / 2];
            texel[k % 2 == 0 ? 0 : 2] = static_cast<float>(unit);
            texel[k % 2 == 0 ? 1 : 3] = static_cast<float>(normals);
        }
        texels += (joint.modes + 1) / 2;
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
