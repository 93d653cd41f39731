// SPDX-License-Identifier: MIT
#include <osgSkinMotion/SpringBones>

#include "bones/BoneCallbacks.h"
#include "bones/Figure.h"
#include "springs/SpringChains.h"
#include "springs/SpringMemory.h"

#include <osgSkin/BoneReader>
#include <osgSkin/Error>
#include <osgSkin/ExpectedNames>
#include <osgSkin/GlmOsg>
#include <osgSkinMotion/RotateBone>

#include <osg/FrameStamp>
#include <osg/NodeVisitor>
#include <osg/Notify>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace osgSkin {
namespace {

using osgAnimation::Bone;

/// The factor by which a matrix scales; 0 where it is singular or not finite.
double scaleOf(const osg::Matrixd& matrix) {
    const glm::dmat3 m(toGlm(matrix));
    const double scale = std::cbrt(std::abs(glm::determinant(m)));
    return std::isfinite(scale) ? scale : 0.0;
}

constexpr std::size_t kMaxPairs = 50'000; ///< of joints and colliders; a step looks at all

/// The chains' different colliders that have a bone, for a bounded number of joints.
class UsedColliders {
public:
    template <typename Find>
    UsedColliders(const SpringSettings& settings, const Find& find)
        : _ofChain(settings.chains.size()) {
        for (const SpringSettings::Collider& collider : settings.colliders)
            _bones.push_back(find(collider.joint));
        std::vector<std::size_t> lastChain(_bones.size(), _ofChain.size());
        for (std::size_t c = 0; c < _ofChain.size(); ++c)
            for (const std::size_t index : settings.chains[c].colliders)
                if (index < _bones.size() && _bones[index] &&
                    std::exchange(lastChain[index], c) != c)
                    _ofChain[c].push_back(index);
    }

    Bone& bone(std::size_t collider) const { return *_bones[collider]; }

    /// Those of one joint more of a chain, in order.
    std::vector<std::size_t> forJoint(std::size_t chain) {
        std::vector<std::size_t> result = _ofChain[chain];
        if (result.size() > kMaxPairs - _pairs) {
            _unused += result.size() - (kMaxPairs - _pairs);
            result.resize(kMaxPairs - _pairs);
        }
        _pairs += result.size();
        return result;
    }

    void warn() const {
        if (_unused > 0)
            OSG_WARN << "osgSkin: springs: " << _unused << " pairs of joints and colliders beyond "
                     << kMaxPairs << " are left out" << std::endl;
    }

private:
    std::vector<Bone*> _bones; ///< [collider]
    std::vector<std::vector<std::size_t>> _ofChain;
    std::size_t _pairs = 0, _unused = 0;
};

int depthOf(const Bone& bone) {
    int depth = 0;
    for (const Bone* at = bone.getBoneParent(); at != nullptr; at = at->getBoneParent()) ++depth;
    return depth;
}

struct Entry {
    int depth;
    osgAnimation::Bone* bone;
    const SpringSettings::Joint* joint;
    const SpringSettings::Chain* chain;
};

/// The chains' joints that the skeleton has, those nearer to the root first.
template <typename Find>
std::vector<Entry> fromTheRoot(const SpringSettings& settings, const Find& find) {
    std::vector<Entry> entries;
    for (const SpringSettings::Chain& chain : settings.chains)
        for (const SpringSettings::Joint& joint : chain.joints)
            if (osgAnimation::Bone* const bone = find(joint.name))
                entries.push_back({depthOf(*bone), bone, &joint, &chain});
    std::stable_sort(entries.begin(), entries.end(),
                     [](const Entry& a, const Entry& b) { return a.depth < b.depth; });
    return entries;
}

using GroupJoint = std::pair<std::size_t, int>; ///< a group, and a joint of it

/// The nearest of a group's joints above a bone; -1: none.
int parentIn(const std::map<const osgAnimation::Bone*, GroupJoint>& joints,
             const osgAnimation::Bone& bone, std::size_t group) {
    for (const osgAnimation::Bone* above = bone.getBoneParent(); above != nullptr;
         above = above->getBoneParent())
        if (const auto known = joints.find(above);
            known != joints.end() && known->second.first == group)
            return known->second.second;
    return -1;
}

} // namespace

/// The springs of one skeleton. Does not keep bones alive, which own it.
class SpringBones::Swing {
public:
    Swing(osgAnimation::Skeleton& skeleton, const SpringSettings& settings,
          const osg::Matrixd& toWorld);

    /// Whether all bones are still there.
    bool fits(const osgAnimation::Skeleton& skeleton) const;

    /// Gives bones without a callback the pose that they had before they swung.
    void restore();

    /// \param place from the skeleton to the world
    void move(const osg::Matrixd& place, double seconds);

    SpringMemory remember() const;
    /// Goes on from there, if it is of the same bones.
    void recall(const SpringMemory& memory);

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

    /// \param rechecks how many are left of this frame's
    void move(Group& group, const osg::Matrixd& place, double seconds, std::size_t& rechecks) const;

    const osgAnimation::Skeleton* _skeleton;
    double _metresPerUnit;
    std::vector<Group> _groups; ///< those of bones nearer to the root first
};

SpringBones::Swing::Swing(osgAnimation::Skeleton& skeleton, const SpringSettings& settings,
                          const osg::Matrixd& toWorld)
    : _skeleton(&skeleton), _metresPerUnit(scaleOf(toWorld)) {
    const osgAnimation::BoneMap bones = bonesOf(skeleton);
    const auto find = [&](const std::string& name) -> Bone* {
        const auto found = bones.find(name);
        if (name.empty() || found == bones.end()) return nullptr;
        Bone* const bone = found->second;
        return scaleOf(bone->getInvBindMatrixInSkeletonSpace()) > 0.0 ? bone : nullptr;
    };
    std::map<std::string, std::size_t> groups; // by centre
    std::map<const Bone*, GroupJoint> places;
    std::vector<std::map<std::size_t, std::size_t>> hits; // by collider, [group]
    UsedColliders colliders(settings, find);
    const glm::dquat turn = _metresPerUnit > 0.0 ? axesOf(toWorld) : glm::dquat(1, 0, 0, 0);
    for (const Entry& entry : fromTheRoot(settings, find)) {
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
        joint.parent = parentIn(places, *entry.bone, g);
        const auto c = static_cast<std::size_t>(entry.chain - settings.chains.data());
        for (const std::size_t index : colliders.forJoint(c)) {
            const SpringSettings::Collider& collider = settings.colliders[index];
            Bone& bone = colliders.bone(index);
            const auto [hit, isNew] = hits[g].emplace(index, group.hits.size());
            const osg::Matrixd toBone = bone.getInvBindMatrixInSkeletonSpace();
            if (isNew)
                group.hits.push_back({&bone, toOsg(collider.start) * toBone,
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
    colliders.warn();
    for (Group& group : _groups) {
        group.frame.bones.resize(group.bones.size());
        group.frame.colliders.resize(group.hits.size());
        group.chains = SpringChains(std::move(group.joints));
    }
}

bool SpringBones::Swing::fits(const osgAnimation::Skeleton& skeleton) const {
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

void SpringBones::Swing::restore() {
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

void SpringBones::Swing::move(const osg::Matrixd& place, double seconds) {
    restore();
    std::size_t rechecks = SpringChains::kMaxRechecks;
    for (Group& group : _groups) move(group, place, seconds, rechecks);
}

void SpringBones::Swing::move(Group& group, const osg::Matrixd& place, double seconds,
                              std::size_t& rechecks) const {
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
    if (!group.chains.move(frame, seconds, rechecks)) return;
    rechecks -= group.chains.rechecks();
    const osg::Matrixd fromMetres = osg::Matrixd::inverse(toMetres);
    for (std::size_t i = 0; i < group.bones.size(); ++i) {
        SwungBone& each = group.bones[i];
        const osg::Matrixd& at = each.bone->getMatrixInSkeletonSpace();
        const glm::dvec3 from = toGlm(each.tip * at - at.getTrans());
        const glm::dvec3 to = toGlm(toOsg(group.chains.tips()[i]) * fromMetres - at.getTrans());
        each.base = each.bone->getMatrix();
        if (group.chains.swings(i) && glm::length(to) > 0.0)
            rotateBone(*each.bone, toOsg(shortestRotation(from, to)));
        each.swung = each.bone->getMatrix();
    }
}

SpringMemory SpringBones::Swing::remember() const {
    SpringMemory result;
    for (const Group& group : _groups) {
        if (!group.chains.isMoving()) return {};
        SpringMemory::Group& kept = result.groups.emplace_back();
        kept.colliders = group.chains.frame().colliders;
        for (std::size_t i = 0; i < group.bones.size(); ++i) {
            if (!group.bones[i].bone.valid()) return {};
            kept.bones.push_back({group.bones[i].bone->getName(), group.bones[i].base,
                                  group.chains.states()[i], group.chains.tips()[i],
                                  group.chains.frame().bones[i]});
        }
    }
    return result;
}

void SpringBones::Swing::recall(const SpringMemory& memory) {
    if (memory.groups.size() != _groups.size()) return;
    for (std::size_t g = 0; g < _groups.size(); ++g) {
        const SpringMemory::Group& from = memory.groups[g];
        Group& to = _groups[g];
        if (from.bones.size() != to.bones.size() || from.colliders.size() != to.hits.size()) return;
        std::vector<SpringChains::State> states;
        std::vector<glm::dvec3> tips;
        SpringChains::Frame frame;
        frame.colliders = from.colliders;
        for (std::size_t i = 0; i < to.bones.size(); ++i) {
            const SpringMemory::Bone& bone = from.bones[i];
            if (bone.name != to.bones[i].bone->getName() || !bone.base.valid()) return;
            states.push_back(bone.state);
            tips.push_back(bone.tip);
            frame.bones.push_back(bone.pose);
        }
        if (!to.chains.recall(states, tips, frame)) return;
        for (std::size_t i = 0; i < to.bones.size(); ++i) {
            to.bones[i].base = from.bones[i].base;
            to.bones[i].swung = to.bones[i].bone->getMatrix();
        }
    }
}

SpringBones::SpringBones() : _settings(std::make_shared<SpringSettings>()) {}

SpringBones::SpringBones(const SpringSettings& settings, const osg::Matrixd& toWorld) {
    set(settings, toWorld);
}

SpringBones::SpringBones(const SpringBones& other, const osg::CopyOp& copyop)
    : osg::Object(other, copyop), osg::Callback(other, copyop), Attachment(other, copyop),
      _settings(other._settings), _toWorld(other._toWorld), _enabled(other._enabled) {}

SpringBones::~SpringBones() = default;

osg::ref_ptr<SpringBones> SpringBones::create(osg::Node& root, const SpringSettings& settings) {
    const Figure figure = findFigure(root, "spring bones");
    FigureJoints joints(figure);
    SpringSettings named = settings;
    for (SpringSettings::Chain& chain : named.chains) {
        if (!chain.centre.empty()) joints.resolve(chain.centre);
        for (SpringSettings::Joint& joint : chain.joints) joints.resolve(joint.name);
    }
    for (SpringSettings::Collider& collider : named.colliders)
        if (!collider.joint.empty()) joints.resolve(collider.joint);
    return new SpringBones(named, figure.toWorld);
}

osg::Node& SpringBones::nodeFor(osg::Node& root) const {
    return topBoneOf(findFigure(root, "spring bones"));
}

void SpringBones::set(const SpringSettings& settings, const osg::Matrixd& toWorld) {
    _settings = std::make_shared<SpringSettings>(settings);
    _toWorld = toWorld;
    reset();
}

void SpringBones::reset() {
    _swing = nullptr;
    _memory = nullptr;
}

std::shared_ptr<SpringMemory> SpringBones::remember() const {
    return std::make_shared<SpringMemory>(_swing    ? _swing->remember()
                                          : _memory ? *_memory
                                                    : SpringMemory());
}

void SpringBones::operator()(osg::Node* node, osg::NodeVisitor* nv) {
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
    if (!_swing) {
        _swing = std::make_shared<Swing>(skeleton, *_settings, _toWorld);
        if (_memory) _swing->recall(*_memory);
        _memory = nullptr;
    }
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
