// SPDX-License-Identifier: MIT
#include <osgSkinMotion/Springs>

#include "bones/BoneCallbacks.h"
#include "springs/SpringChains.h"

#include <osgSkin/BoneReader>
#include <osgSkin/Error>
#include <osgSkin/ExpectedNames>
#include <osgSkin/GlmOsg>
#include <osgSkinMotion/RotateBone>

#include <osg/FrameStamp>
#include <osg/NodeVisitor>

#include <algorithm>
#include <cmath>
#include <map>

namespace osgSkin {
namespace {

using osgAnimation::Bone;

/// The factor by which a matrix scales; 0 where it is singular or not finite.
double scaleOf(const osg::Matrixd& matrix) {
    const glm::dmat3 m(toGlm(matrix));
    const double scale = std::cbrt(std::abs(glm::determinant(m)));
    return std::isfinite(scale) ? scale : 0.0;
}

int depthOf(const Bone& bone) {
    int depth = 0;
    for (const Bone* at = bone.getBoneParent(); at != nullptr; at = at->getBoneParent()) ++depth;
    return depth;
}

} // namespace

/// The springs of one skeleton. Does not keep bones alive, which own it.
class Springs::Swing {
public:
    Swing(osgAnimation::Skeleton& skeleton, const SpringSettings& settings,
          const osg::Matrixd& toWorld);

    /// Whether all bones are still there.
    bool fits(const osgAnimation::Skeleton& skeleton) const;

    /// Gives bones without a callback the pose that they had before they swung.
    void restore();

    /// \param place from the skeleton to the world
    void move(const osg::Matrixd& place, double seconds);

private:
    struct SwungBone {
        osg::observer_ptr<Bone> bone;
        osg::Vec3d tip;           ///< in the bone's frame
        osg::Matrixd base, swung; ///< the bone's matrix before and after
    };
    struct Hit {
        osg::observer_ptr<Bone> bone;
        osg::Vec3d start, end; ///< in the bone's frame
        double radius;         ///< metres
    };
    /// Joints whose motion is in one space.
    struct Group {
        osg::observer_ptr<Bone> centre;
        bool hasCentre = false;
        std::vector<SwungBone> bones;
        std::vector<Hit> hits;
        std::vector<SpringChains::Joint> joints;
        SpringChains chains;
        SpringChains::Frame frame;
    };

    void move(Group& group, const osg::Matrixd& place, double seconds) const;

    const osgAnimation::Skeleton* _skeleton;
    double _metresPerUnit;
    std::vector<Group> _groups; ///< those of bones nearer to the root first
};

Springs::Swing::Swing(osgAnimation::Skeleton& skeleton, const SpringSettings& settings,
                      const osg::Matrixd& toWorld)
    : _skeleton(&skeleton), _metresPerUnit(scaleOf(toWorld)) {
    const osgAnimation::BoneMap bones = bonesOf(skeleton);
    const auto find = [&](const std::string& name) -> Bone* {
        const auto found = bones.find(name);
        if (name.empty() || found == bones.end()) return nullptr;
        Bone* const bone = found->second;
        return scaleOf(bone->getInvBindMatrixInSkeletonSpace()) > 0.0 ? bone : nullptr;
    };
    struct Entry {
        int depth;
        Bone* bone;
        const SpringSettings::Joint* joint;
        const SpringSettings::Chain* chain;
    };
    std::vector<Entry> entries;
    for (const SpringSettings::Chain& chain : settings.chains)
        for (const SpringSettings::Joint& joint : chain.joints)
            if (Bone* const bone = find(joint.name))
                entries.push_back({depthOf(*bone), bone, &joint, &chain});
    std::stable_sort(entries.begin(), entries.end(),
                     [](const Entry& a, const Entry& b) { return a.depth < b.depth; });
    std::map<std::string, std::size_t> groups;                 // by centre
    std::map<const Bone*, std::pair<std::size_t, int>> places; // group, joint
    std::vector<std::map<std::size_t, std::size_t>> hits;      // by collider, [group]
    const glm::dquat turn = _metresPerUnit > 0.0 ? axesOf(toWorld) : glm::dquat(1, 0, 0, 0);
    for (const Entry& entry : entries) {
        const std::size_t g = groups.emplace(entry.chain->centre, _groups.size()).first->second;
        if (g == _groups.size()) {
            _groups.emplace_back();
            hits.emplace_back();
            _groups[g].centre = find(entry.chain->centre);
            _groups[g].hasCentre = _groups[g].centre.valid();
        }
        Group& group = _groups[g];
        const auto place = std::pair(g, static_cast<int>(group.joints.size()));
        if (!places.emplace(entry.bone, place).second) continue; // a joint of two chains
        const SpringSettings::Joint& from = *entry.joint;
        SpringChains::Joint joint;
        joint.stiffness = from.stiffness;
        joint.drag = from.drag;
        joint.radius = from.radius * _metresPerUnit;
        joint.gravity = turn * from.gravity;
        for (const Bone* above = entry.bone->getBoneParent(); above != nullptr && joint.parent < 0;
             above = above->getBoneParent())
            if (const auto known = places.find(above);
                known != places.end() && known->second.first == g)
                joint.parent = known->second.second;
        for (const std::size_t index : entry.chain->colliders) {
            if (index >= settings.colliders.size()) continue;
            const SpringSettings::Collider& collider = settings.colliders[index];
            Bone* const bone = find(collider.joint);
            if (!bone) continue;
            const auto [hit, isNew] = hits[g].emplace(index, group.hits.size());
            const osg::Matrixd toBone = bone->getInvBindMatrixInSkeletonSpace();
            if (isNew)
                group.hits.push_back({bone, toOsg(collider.start) * toBone,
                                      toOsg(collider.end) * toBone,
                                      collider.radius * _metresPerUnit});
            joint.colliders.push_back(hit->second);
        }
        group.joints.push_back(joint);
        SwungBone bone;
        bone.bone = entry.bone;
        bone.tip = toOsg(from.tip) * osg::Matrixd(entry.bone->getInvBindMatrixInSkeletonSpace());
        group.bones.push_back(bone);
    }
    for (Group& group : _groups) {
        group.frame.bones.resize(group.bones.size());
        group.frame.colliders.resize(group.hits.size());
        group.chains = SpringChains(std::move(group.joints));
    }
}

bool Springs::Swing::fits(const osgAnimation::Skeleton& skeleton) const {
    if (&skeleton != _skeleton) return false;
    for (const Group& group : _groups) {
        if (group.hasCentre && !group.centre.valid()) return false;
        for (const SwungBone& bone : group.bones)
            if (!bone.bone.valid()) return false;
        for (const Hit& hit : group.hits)
            if (!hit.bone.valid()) return false;
    }
    return true;
}

void Springs::Swing::restore() {
    for (Group& group : _groups)
        for (SwungBone& each : group.bones) {
            Bone& bone = *each.bone;
            const Bone* const parent = bone.getBoneParent();
            if (bone.getMatrix() != each.swung || each.swung == each.base) continue;
            bone.setMatrixInSkeletonSpace(parent ? each.base * parent->getMatrixInSkeletonSpace()
                                                 : each.base);
            rotateBone(bone, osg::Quat());
        }
}

void Springs::Swing::move(const osg::Matrixd& place, double seconds) {
    restore();
    for (Group& group : _groups) move(group, place, seconds);
}

void Springs::Swing::move(Group& group, const osg::Matrixd& place, double seconds) const {
    const osg::Matrixd toSpace =
        group.hasCentre && scaleOf(group.centre->getMatrixInSkeletonSpace()) > 0.0
            ? osg::Matrixd::inverse(group.centre->getMatrixInSkeletonSpace())
            : place;
    const double scale = scaleOf(toSpace);
    if (scale == 0.0 || scaleOf(place) == 0.0 || _metresPerUnit == 0.0) return;
    const double metres = _metresPerUnit / scale;
    const osg::Matrixd toMetres = toSpace * osg::Matrixd::scale(metres, metres, metres);
    SpringChains::Frame& frame = group.frame;
    frame.fromWorld = axesOf(toSpace) * glm::inverse(axesOf(place));
    for (std::size_t i = 0; i < group.bones.size(); ++i) {
        const osg::Matrixd at = group.bones[i].bone->getMatrixInSkeletonSpace() * toMetres;
        frame.bones[i] = {toGlm(at.getTrans()), toGlm(group.bones[i].tip * at), axesOf(at)};
    }
    for (std::size_t i = 0; i < group.hits.size(); ++i) {
        const Hit& hit = group.hits[i];
        const osg::Matrixd at = hit.bone->getMatrixInSkeletonSpace() * toMetres;
        frame.colliders[i] = {toGlm(hit.start * at), toGlm(hit.end * at), hit.radius};
    }
    if (!group.chains.move(frame, seconds)) return;
    const osg::Matrixd fromMetres = osg::Matrixd::inverse(toMetres);
    for (std::size_t i = 0; i < group.bones.size(); ++i) {
        SwungBone& each = group.bones[i];
        const osg::Matrixd& at = each.bone->getMatrixInSkeletonSpace();
        const glm::dvec3 from = toGlm(each.tip * at - at.getTrans());
        const glm::dvec3 to = toGlm(toOsg(group.chains.tips()[i]) * fromMetres - at.getTrans());
        each.base = each.bone->getMatrix();
        if (glm::length(from) > 0.0 && glm::length(to) > 0.0)
            rotateBone(*each.bone, toOsg(shortestRotation(from, to)));
        each.swung = each.bone->getMatrix();
    }
}

Springs::Springs() : _settings(std::make_shared<SpringSettings>()) {}

Springs::Springs(const SpringSettings& settings, const osg::Matrixd& toWorld) {
    set(settings, toWorld);
}

Springs::Springs(const Springs& other, const osg::CopyOp& copyop)
    : osg::Object(other, copyop), osg::Callback(other, copyop), osg::NodeCallback(other, copyop),
      _settings(other._settings), _toWorld(other._toWorld), _enabled(other._enabled) {}

Springs::~Springs() = default;

Springs* Springs::of(osgAnimation::Skeleton& skeleton) {
    return callbackOf<Springs>(skeleton);
}

bool Springs::addTo(osgAnimation::Skeleton& skeleton) {
    if (!addLast(*this, skeleton)) return false;
    reset();
    return true;
}

void Springs::set(const SpringSettings& settings, const osg::Matrixd& toWorld) {
    _settings = std::make_shared<SpringSettings>(settings);
    _toWorld = toWorld;
    reset();
}

void Springs::operator()(osg::Node* node, osg::NodeVisitor* nv) {
    traverse(node, nv);
    if (!nv || !nv->getFrameStamp()) return;
    static thread_local osg::NodePath path; // keeps its memory
    osgAnimation::Skeleton* const found = skeletonAbove(*nv, path);
    if (!found) return;
    osgAnimation::Skeleton& skeleton = *found;
    const double time = nv->getFrameStamp()->getSimulationTime();
    if (_swing && !_swing->fits(skeleton)) _swing = nullptr;
    if (!_enabled) {
        if (_swing) _swing->restore();
        return;
    }
    const double seconds = _swing ? time - _time : 0.0;
    if (!_swing) _swing = std::make_shared<Swing>(skeleton, *_settings, _toWorld);
    _swing->move(osg::computeLocalToWorld(path), seconds);
    _time = time;
}

SpringSettings::Chain springsBelow(const RestSkeleton& rest, const std::vector<std::string>& joints,
                                   const SpringSettings::Joint& like, double lastLength) {
    const std::map<std::string, int> known = rest.byName();
    std::vector<bool> swings(rest.joints.size(), false);
    std::vector<const RestJoint*> firstChild(rest.joints.size(), nullptr);
    for (const std::string& name : joints) {
        const auto found = known.find(name);
        if (found == known.end())
            throw Error("no joint is called \"" + name + '"' + expectedNames(name, known));
        swings[static_cast<std::size_t>(found->second)] = true;
    }
    for (std::size_t j = 0; j < rest.joints.size(); ++j) {
        if (rest.joints[j].parent < 0) continue;
        const auto parent = static_cast<std::size_t>(rest.joints[j].parent);
        swings[j] = swings[j] || swings[parent];
        if (!firstChild[parent]) firstChild[parent] = &rest.joints[j];
    }
    SpringSettings::Chain chain;
    for (std::size_t j = 0; j < rest.joints.size(); ++j) {
        const RestJoint& joint = rest.joints[j];
        if (!swings[j]) continue;
        SpringSettings::Joint swung = like;
        swung.name = joint.name;
        if (firstChild[j]) {
            swung.tip = firstChild[j]->centre;
        } else if (joint.tip) {
            swung.tip = *joint.tip;
        } else if (joint.parent >= 0) {
            const glm::dvec3 line =
                joint.centre - rest.joints[static_cast<std::size_t>(joint.parent)].centre;
            const double length = glm::length(line);
            if (!(length > 0.0)) continue;
            swung.tip = joint.centre + line * ((lastLength > 0.0 ? lastLength : length) / length);
        } else {
            continue;
        }
        chain.joints.push_back(swung);
    }
    return chain;
}

} // namespace osgSkin
