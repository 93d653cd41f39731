// SPDX-License-Identifier: MIT
#include "clips/ClipBones.h"

#include <osgSkin/Error>
#include <osgSkin/GlmTypes>

#include <osg/NodeVisitor>

#include <cmath>

namespace osgSkin {

void requireFits(const Clip& clip, const RestSkeleton& rig) {
    rig.validate();
    const std::string label = "clip \"" + clip.name + "\": ";
    if (clip.joints != rig.joints.size())
        throw Error(label + "made for " + std::to_string(clip.joints) + " joints, expected " +
                    std::to_string(rig.joints.size()));
    if (clip.frames == 0) throw Error(label + "no frame, expected at least one");
    if (!(clip.frameTime > 0.0) || !std::isfinite(clip.frameTime * double(clip.frames)))
        throw Error(label + "expected a positive frame time");
    if (clip.rotations.size() != clip.frames * clip.joints ||
        clip.rootPositions.size() != clip.frames)
        throw Error(label + "its arrays do not fit " + std::to_string(clip.frames) + " frames");
    for (const auto& [joint, positions] : clip.moves)
        if (joint == 0 || joint >= clip.joints || positions.size() != clip.frames)
            throw Error(label + "its moves do not fit its joints and " +
                        std::to_string(clip.frames) + " frames");
    for (const auto& [morph, weights] : clip.morphs)
        if (weights.size() != clip.frames)
            throw Error(label + "expected a weight of \"" + morph + "\" for each of " +
                        std::to_string(clip.frames) + " frames");
}

void requireUsable(const Clip& clip, const RestSkeleton& rig) {
    requireFits(clip, rig);
    const auto at = [&](std::size_t f) {
        return "clip \"" + clip.name + "\": frame " + std::to_string(f) + ": ";
    };
    for (std::size_t f = 0; f < clip.frames; ++f)
        if (!isInRange(clip.rootPositions[f]))
            throw Error(at(f) + "the root's position is not finite, or beyond -1e18 to 1e18");
    for (std::size_t i = 0; i < clip.rotations.size(); ++i) {
        const glm::dquat& q = clip.rotations[i];
        if (!(std::abs(glm::dot(q, q) - 1.0) <= 2e-3)) // for NaN, too
            throw Error(at(i / clip.joints) + "joint \"" + rig.joints[i % clip.joints].name +
                        "\" has a rotation that is not unit");
    }
}

namespace {

constexpr double kSameScale = 1e-4;

/// False for a second element of a kind, or one in the wrong order.
bool take(HoldingElements& found, osgAnimation::StackedTransformElement* element) {
    if (found.matrix) return false;
    const bool first = !found.translate && !found.rotate && !found.scale;
    if (auto* matrix = dynamic_cast<osgAnimation::StackedMatrixElement*>(element))
        return first && (found.matrix = matrix);
    if (auto* translate = dynamic_cast<osgAnimation::StackedTranslateElement*>(element))
        return first && (found.translate = translate);
    if (auto* rotate = dynamic_cast<osgAnimation::StackedQuaternionElement*>(element))
        return !found.rotate && !found.scale && (found.rotate = rotate);
    if (auto* scale = dynamic_cast<osgAnimation::StackedScaleElement*>(element))
        return !found.scale && (found.scale = scale);
    return false;
}

} // namespace

bool HoldingElements::find(osgAnimation::UpdateBone& update) {
    for (const auto& element : update.getStackedTransforms())
        if (!take(*this, element.get())) return false;
    return matrix || (translate && rotate);
}

namespace {

class BonesInOrder : public osg::NodeVisitor {
public:
    BonesInOrder() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) {}

    void apply(osg::Transform& node) override {
        if (getNodePath().size() > 1 && dynamic_cast<osgAnimation::Skeleton*>(&node)) return;
        if (auto* bone = dynamic_cast<osgAnimation::Bone*>(&node)) bones.emplace_back(bone);
        traverse(node);
    }

    std::vector<osg::ref_ptr<osgAnimation::Bone>> bones;
};

} // namespace

std::vector<osg::ref_ptr<osgAnimation::Bone>> bonesInOrder(osgAnimation::Skeleton& skeleton) {
    BonesInOrder found;
    skeleton.accept(found);
    return found.bones;
}

osgAnimation::UpdateBone* updateOf(osgAnimation::Bone& bone) {
    for (osg::Callback* callback = bone.getUpdateCallback(); callback != nullptr;
         callback = callback->getNestedCallback())
        if (auto* update = dynamic_cast<osgAnimation::UpdateBone*>(callback)) return update;
    return nullptr;
}

bool isScaled(const osg::Vec3d& scale) {
    return (scale - osg::Vec3d(1.0, 1.0, 1.0)).length() > kSameScale;
}

bool writeToUpdateCallback(osgAnimation::Bone& bone, const osg::Matrixd& local) {
    osgAnimation::UpdateBone* update = updateOf(bone);
    if (!update) return true;
    HoldingElements held;
    if (!held.find(*update)) return false;
    if (held.matrix) {
        held.matrix->setMatrix(local);
        return true;
    }
    osg::Vec3d translation, scale;
    osg::Quat rotation, scaleAxes;
    local.decompose(translation, rotation, scale, scaleAxes);
    if (!held.scale && isScaled(scale)) return false;
    held.translate->setTranslate(translation);
    held.rotate->setQuaternion(rotation);
    if (held.scale) held.scale->setScale(scale);
    return true;
}

} // namespace osgSkin
