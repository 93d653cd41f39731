// SPDX-License-Identifier: MIT
#include <osgSkinBind/NonUniformScale>

#include <osg/NodeVisitor>
#include <osgAnimation/Bone>
#include <osgAnimation/Channel>
#include <osgAnimation/StackedScaleElement>
#include <osgAnimation/UpdateBone>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <unordered_map>

namespace osgSkin {
namespace {

constexpr double kUniform = 0.05; ///< largest relative difference of the scale along two axes

osg::Vec3d axis(const osg::Matrixd& m, int row) {
    return {m(row, 0), m(row, 1), m(row, 2)};
}

/// Whether a matrix scales uniformly; it may mirror.
bool isSimilarity(const osg::Matrixd& m) {
    const double size = axis(m, 0).length2();
    for (int i = 0; i < 3; ++i) {
        if (std::abs(axis(m, i).length2() - size) > 2.0 * kUniform * size) return false;
        if (std::abs(axis(m, i) * axis(m, (i + 1) % 3)) > 2.0 * kUniform * size) return false;
    }
    return true;
}

bool isMirrored(const osg::Matrixd& m) {
    return !((axis(m, 0) ^ axis(m, 1)) * axis(m, 2) > 0.0);
}

bool isUniform(const osg::Matrixd& m) {
    return isSimilarity(m) && !isMirrored(m);
}

/// The bones and their matrices as their update callbacks will set them.
class BoneMatrices : public osg::NodeVisitor {
public:
    BoneMatrices() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) {}

    struct Entry {
        osgAnimation::Bone* bone;
        int parent;             ///< its entry; -1: none
        osg::Matrixd matrix;    ///< to skeleton space
        osg::Matrixd local;     ///< to the parent's space
        osg::Matrixd above;     ///< from the parent's space to skeleton space
        osg::Matrixd bindAbove; ///< the bind matrix of the bone above, to skeleton space
    };
    std::vector<Entry> bones;

    void apply(osg::Transform& node) override {
        if (_depth > 0 && dynamic_cast<osgAnimation::Skeleton*>(&node) != nullptr) return;
        const osg::Matrixd matrix = _matrix, bind = _bind;
        const int parent = _parent;
        if (auto* bone = dynamic_cast<osgAnimation::Bone*>(&node)) {
            const osg::Matrixd local = localOf(*bone);
            _matrix.preMult(local);
            bones.push_back({bone, parent, _matrix, local, matrix, _bind});
            _parent = static_cast<int>(bones.size()) - 1;
            _bind = osg::Matrixd::inverse(bone->getInvBindMatrixInSkeletonSpace());
        } else if (_depth > 0) {
            node.computeLocalToWorldMatrix(_matrix, this);
        }
        ++_depth;
        traverse(node);
        --_depth;
        _matrix = matrix;
        _bind = bind;
        _parent = parent;
    }

private:
    static osg::Matrixd localOf(osgAnimation::Bone& bone) {
        auto* update = dynamic_cast<osgAnimation::UpdateBone*>(bone.getUpdateCallback());
        if (update == nullptr || update->getStackedTransforms().empty()) return bone.getMatrix();
        osg::Matrixd local;
        for (const auto& element : update->getStackedTransforms())
            if (element) element->applyToMatrix(local);
        return local;
    }

    int _depth = 0, _parent = -1;
    osg::Matrixd _matrix, _bind;
};

/// Whether keys of a scale or matrix channel scale non-uniformly relative to `bind`, the bone's
/// matrix in the bind pose, relative to the bone above.
bool scalesNonUniformly(osgAnimation::Channel& channel, const osg::Matrixd& bind) {
    if (auto* matrices = dynamic_cast<osgAnimation::MatrixLinearChannel*>(&channel)) {
        const auto* keys = matrices->getOrCreateSampler()->getKeyframeContainerTyped();
        return keys != nullptr && std::any_of(keys->begin(), keys->end(), [&](const auto& key) {
                   return !isUniform(osg::Matrixd::inverse(bind) * osg::Matrixd(key.getValue()));
               });
    }
    if (channel.getName() != "scale") return false;
    const auto isNonUniform = [&](const osg::Vec3& scale) {
        osg::Matrixd own;
        for (int i = 0; i < 3; ++i) own(i, i) = double(scale[i]) / axis(bind, i).length();
        if (isMirrored(bind)) own(0, 0) = -own(0, 0);
        return !isUniform(own);
    };
    const auto any = [&](auto* typed) {
        if (typed == nullptr) return false;
        const auto* keys = typed->getOrCreateSampler()->getKeyframeContainerTyped();
        return keys != nullptr && std::any_of(keys->begin(), keys->end(), [&](const auto& key) {
                   return isNonUniform(key.getValue());
               });
    };
    return any(dynamic_cast<osgAnimation::Vec3LinearChannel*>(&channel)) ||
           any(dynamic_cast<osgAnimation::Vec3StepChannel*>(&channel));
}

/// Whether keys of a channel rotate a bone below a non-uniform scale, which shears the bone.
bool shears(osgAnimation::Channel& channel, const BoneMatrices::Entry& entry) {
    auto* turns = dynamic_cast<osgAnimation::QuatSphericalLinearChannel*>(&channel);
    if (turns == nullptr || isSimilarity(entry.above)) return false;
    osg::Vec3d scale;
    for (int i = 0; i < 3; ++i) scale[i] = axis(entry.local, i).length();
    if (isMirrored(entry.local)) scale[0] = -scale[0];
    const osg::Matrixd fromBind =
        entry.bone->getInvBindMatrixInSkeletonSpace() * osg::Matrixd::scale(scale);
    const auto* keys = turns->getOrCreateSampler()->getKeyframeContainerTyped();
    return keys != nullptr && std::any_of(keys->begin(), keys->end(), [&](const auto& key) {
               return !isUniform(fromBind * osg::Matrixd::rotate(key.getValue()) * entry.above);
           });
}

/// The bone above one that shears whose scale does it, or that bone itself.
std::string sheared(const std::vector<BoneMatrices::Entry>& bones,
                    const BoneMatrices::Entry& entry) {
    for (int above = entry.parent; above >= 0; above = bones[std::size_t(above)].parent)
        if (!isSimilarity(bones[std::size_t(above)].local))
            return bones[std::size_t(above)].bone->getName();
    return entry.bone->getName();
}

/// Whether a skin takes a joint's rotation, by name: not those of sockets and controls.
std::map<std::string, bool> usedJoints(const Binding& binding,
                                       const std::vector<SkinParts::Skin>& skins) {
    std::vector<bool> isUsed(binding.joints.size(), false);
    for (const SkinParts::Skin& skin : skins)
        for (const std::uint32_t v : skin.part.sourceVertex)
            for (auto i = binding.firstInfluence[v]; i < binding.firstInfluence[v + 1]; ++i)
                isUsed[binding.influences[i].joint] = true;
    std::map<std::string, bool> result;
    for (std::size_t j = 0; j < isUsed.size(); ++j) result[binding.joints[j].name] = isUsed[j];
    return result;
}

} // namespace

std::vector<std::string> findNonUniformScale(osgAnimation::Skeleton& skeleton,
                                             const osgAnimation::AnimationList& clips,
                                             const Binding& binding,
                                             const std::vector<SkinParts::Skin>& skins) {
    const std::map<std::string, bool> used = usedJoints(binding, skins);
    BoneMatrices found;
    skeleton.accept(found);
    std::unordered_map<std::string, std::vector<const BoneMatrices::Entry*>> named;
    for (const BoneMatrices::Entry& entry : found.bones)
        named[entry.bone->getName()].push_back(&entry);
    std::map<std::string, std::string> guilty; // bone -> its line
    for (const auto& clip : clips)
        for (const auto& channel : clip->getChannels()) {
            const auto bones = named.find(channel->getTargetName());
            const auto isUsed = used.find(channel->getTargetName());
            if (bones == named.end() || (isUsed != used.end() && !isUsed->second)) continue;
            for (const BoneMatrices::Entry* entry : bones->second) {
                const std::string& name = entry->bone->getName();
                const osg::Matrixd bind =
                    osg::Matrixd::inverse(entry->bone->getInvBindMatrixInSkeletonSpace()) *
                    osg::Matrixd::inverse(entry->bindAbove);
                const std::string line =
                    "bone \"" + name + "\" in the clip \"" + clip->getName() + "\"";
                if (scalesNonUniformly(*channel, bind)) {
                    guilty.emplace(name, line);
                } else if (shears(*channel, *entry)) {
                    const std::string cause = sheared(found.bones, *entry);
                    guilty.emplace(cause, cause == name ? line : '"' + cause + "\" above " + line);
                }
            }
        }
    std::vector<std::string> result;
    for (const BoneMatrices::Entry& entry : found.bones) {
        const std::string& name = entry.bone->getName();
        const auto line = guilty.find(name);
        const auto isUsed = used.find(name); // or else it is above the joints, and may mirror them
        const osg::Matrixd matrix = entry.bone->getInvBindMatrixInSkeletonSpace() * entry.matrix;
        if (line != guilty.end())
            result.push_back(line->second);
        else if (isUsed == used.end() ? !isSimilarity(matrix)
                                      : isUsed->second && !isUniform(matrix))
            result.push_back("bone \"" + name + "\" in the scene");
    }
    return result;
}

} // namespace osgSkin
