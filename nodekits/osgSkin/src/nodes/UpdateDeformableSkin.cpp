// SPDX-License-Identifier: MIT
#include <osgSkin/UpdateDeformableSkin>

#include <osgSkin/Error>
#include <osgSkin/UpdatePlayedSkeleton>

#include <osg/FrameStamp>
#include <osg/NodeVisitor>
#include <osg/Notify>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace osgSkin {
namespace {

osgAnimation::Skeleton* nearestSkeleton(const osg::NodePath& path) {
    for (auto node = path.rbegin(); node != path.rend(); ++node)
        if (auto* skeleton = dynamic_cast<osgAnimation::Skeleton*>(*node)) return skeleton;
    return nullptr;
}

bool standsUnderAnother(const osg::Drawable& skin, const osgAnimation::Skeleton& skeleton) {
    const osg::NodePathList paths = skin.getParentalNodePaths();
    return std::any_of(paths.begin(), paths.end(), [&](const osg::NodePath& path) {
        const osgAnimation::Skeleton* nearest = nearestSkeleton(path);
        return nearest && nearest != &skeleton;
    });
}

/// The size of a joint that is scaled to nothing, as to hide a hand.
constexpr double kShrunk = 1e-4;

/// Skinning matrices without those of joints that are scaled to nothing, which cannot be inverted:
/// such a joint moves with its parent, but very small.
std::vector<glm::dmat4> shrunk(const SkinModel& model, std::vector<glm::dmat4> skinning) {
    std::vector<bool> isShrunk(skinning.size(), false);
    for (std::size_t j = 1; j < skinning.size(); ++j) {
        const BoundJoint& joint = model.joints()[j];
        const auto parent = static_cast<std::size_t>(joint.parent);
        const glm::dmat4& own = skinning[j];
        double size = 0.0;
        for (int axis = 0; axis < 3; ++axis)
            size = std::max(size, glm::length(glm::dvec3(own[axis])));
        if (!(size < kShrunk)) continue;
        isShrunk[j] = true;
        const glm::dvec3 centre(own * glm::dvec4(joint.centre, 1.0));
        skinning[j] = skinning[parent];
        if (isShrunk[parent]) continue;
        for (int axis = 0; axis < 3; ++axis) skinning[j][axis] *= kShrunk;
        const glm::dvec3 now(skinning[j] * glm::dvec4(joint.centre, 1.0));
        skinning[j][3] += glm::dvec4(centre - now, 0.0);
    }
    return skinning;
}

} // namespace

UpdateDeformableSkin::UpdateDeformableSkin(const UpdateDeformableSkin& other,
                                           const osg::CopyOp& copyop)
    // Bones are not copied: the copy finds those of its own skeleton.
    : osg::Object(other, copyop), osg::Callback(other, copyop), osg::DrawableUpdateCallback(other,
                                                                                            copyop),
      _unwrapTwist(other._unwrapTwist) {}

void UpdateDeformableSkin::noticeSeek(const osg::NodeVisitor& nv) {
    if (!nv.getFrameStamp()) return;
    const double time = nv.getFrameStamp()->getSimulationTime();
    if (std::abs(time - _time) > kSeekSeconds) startTwistAfresh();
    _time = time;
}

void UpdateDeformableSkin::update(osg::NodeVisitor* nv, osg::Drawable* drawable) {
    auto* skin = dynamic_cast<DeformableSkin*>(drawable);
    osgAnimation::Skeleton* skeleton = nv ? nearestSkeleton(nv->getNodePath()) : nullptr;
    if (skin && skeleton) {
        const bool another = _reader.skeleton() && _reader.skeleton() != skeleton;
        if (another && !_toldSeveral && standsUnderAnother(*skin, *skeleton)) {
            OSG_WARN << onOneLine("osgSkin: skin \"" + skin->getName() +
                                  "\" is below several skeletons and follows only one of them, "
                                  "expected a copy of the skin under each")
                     << std::endl;
            _toldSeveral = true;
        }
        noticeSeek(*nv);
        if (poseAs(_twist, *skin, *skeleton))
            _twist = _unwrapTwist ? Pose::Twist::Continued : Pose::Twist::Shortest;
    } else if (skin && nv && !_toldNoSkeleton) {
        OSG_WARN << onOneLine("osgSkin: skin \"" + skin->getName() +
                              "\" is below no osgAnimation::Skeleton, expected one above it; the "
                              "skin keeps its pose")
                 << std::endl;
        _toldNoSkeleton = true;
    }
    traverse(drawable, nv); // nested callbacks
}

bool UpdateDeformableSkin::pose(DeformableSkin& skin, osgAnimation::Skeleton& skeleton) {
    return poseAs(Pose::Twist::Shortest, skin, skeleton);
}

namespace {

/// Those of the joints without a bone that vertices follow. A root joint above several bones
/// (readSkeleton()) stays at rest; osgUtil::Optimizer removes bones that carry nothing.
std::vector<std::string> missedBones(const SkinModel& model,
                                     const std::vector<std::string>& withoutBone) {
    std::set<std::string> followed;
    for (const SkinModel::Link& link : model.links())
        followed.insert(model.joints()[link.joint].name);
    std::vector<std::string> result;
    for (const std::string& joint : withoutBone)
        if (joint != model.joints().front().name && followed.count(joint) != 0)
            result.push_back(joint);
    return result;
}

} // namespace

void UpdateDeformableSkin::findBones(DeformableSkin& skin, osgAnimation::Skeleton& skeleton) {
    const SkinModel* model = skin.getModel();
    _reader = BoneReader(model->joints(), skeleton, &skin);
    _model = model;
    _placesRevision = 0;
    const std::vector<std::string> missing = missedBones(*model, _reader.missing());
    if (missing.empty() || _toldMissing) return;
    _toldMissing = true;
    const std::string rest = missing.size() == 1
                                 ? "; the joint moves with its parent"
                                 : " and " + std::to_string(missing.size() - 1) +
                                       " more; these joints move with their parents";
    OSG_WARN << onOneLine("osgSkin: skin \"" + skin.getName() + "\": skeleton \"" +
                          skeleton.getName() + "\" has no bone \"" + missing.front() + "\"" + rest)
             << std::endl;
}

/// The joints' skinning matrices from those of the bones.
const std::vector<glm::dmat4>&
UpdateDeformableSkin::readPlayed(const UpdatePlayedSkeleton& played) {
    const std::vector<glm::dmat4>& bones = played.skinning();
    const std::size_t joints = _model->joints().size();
    if (_placesRevision != played.revision()) {
        _placesRevision = played.revision();
        std::vector<int> places;
        bool isSame = joints == bones.size();
        for (std::size_t j = 0; j < joints; ++j) {
            places.push_back(played.find(_reader.boneOf(j)));
            isSame = isSame && places.back() == static_cast<int>(j);
        }
        _places = isSame ? nullptr : std::make_unique<const std::vector<int>>(std::move(places));
    }
    if (!_places) return bones;
    static thread_local std::vector<glm::dmat4> skinning;
    skinning.resize(joints);
    for (std::size_t j = 0; j < joints; ++j) {
        const int place = (*_places)[j];
        skinning[j] = place < 0 ? glm::dmat4(1.0) : bones[static_cast<std::size_t>(place)];
    }
    return skinning;
}

bool UpdateDeformableSkin::poseAs(Pose::Twist twist, DeformableSkin& skin,
                                  osgAnimation::Skeleton& skeleton) {
    const SkinModel* model = skin.getModel();
    if (!model) return false;
    const UpdatePlayedSkeleton* played = UpdatePlayedSkeleton::of(skeleton);
    if (played && !played->skipsBones()) played = nullptr;
    // Places that are known are those of bones that have not changed.
    if (_reader.skeleton() != &skeleton || _model.get() != model ||
        (!(played && _placesRevision == played->revision()) && _reader.isOutdated(&skin))) {
        findBones(skin, skeleton);
        twist = Pose::Twist::Shortest;
    }
    const std::vector<glm::dmat4>& skinning = played ? readPlayed(*played) : _reader.read();
    if (!skin.setPose(skinning.data(), skinning.size(), twist) &&
        !skin.setPose(shrunk(*model, skinning).data(), skinning.size(), twist)) {
        if (!_warned)
            OSG_WARN << onOneLine("osgSkin: skin \"" + skin.getName() + "\": skeleton \"" +
                                  skeleton.getName() +
                                  "\" has a bone whose matrix is singular, not finite or out of "
                                  "range; the last pose stays")
                     << std::endl;
        _warned = true;
        return false;
    }
    return true;
}

} // namespace osgSkin
