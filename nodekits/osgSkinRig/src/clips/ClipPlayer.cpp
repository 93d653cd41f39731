// SPDX-License-Identifier: MIT
#include <osgSkinRig/ClipPlayer>

#include "clips/BakedClip.h"
#include "clips/ClipBones.h"
#include "clips/JointMaps.h"

#include <osgSkin/GlmOsg>
#include <osgSkin/PoseBounds>

#include <osg/FrameStamp>
#include <osg/NodeVisitor>
#include <osg/Notify>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace osgSkin {
namespace {

double finite(double number) {
    return std::isfinite(number) ? number : 0.0;
}

osg::Matrixd toMatrix(const JointMap& map) {
    osg::Matrixd result = osg::Matrixd::rotate(toOsg(map.rotation));
    if (map.scale != 1.0) result = osg::Matrixd::scale(map.scale, map.scale, map.scale) * result;
    result.setTrans(toOsg(map.offset));
    return result;
}

/// Baked bounds do not include activations.
bool isActivated(const DeformableSkin& skin) {
    const std::size_t inputs = skin.getModel() ? skin.getModel()->inputs().size() : 0;
    for (std::size_t i = 0; i < inputs; ++i)
        if (skin.getPose().input(i) != 0.0f) return true;
    return false;
}

/// The same angle from -pi to pi.
double wrapped(double angle) {
    return std::remainder(angle, 2.0 * osg::PI);
}

int parentJoint(const SampledClip& clip, int joint) {
    return joint < 0 ? -1 : clip.joints()[static_cast<std::size_t>(joint)].parent;
}

double perSecond(double fade) {
    return fade > 0.0 ? 1.0 / fade : std::numeric_limits<double>::infinity();
}

} // namespace

/// Sets a bone's matrices, after the bone's own callback and before those that were added to it.
class ClipPlayer::PlacedBone : public osg::NodeCallback {
public:
    osg::Matrixd inParent, inSkeleton;

    void operator()(osg::Node* node, osg::NodeVisitor* nv) override {
        auto& bone = static_cast<osgAnimation::Bone&>(*node);
        bone.setMatrix(inParent);
        bone.setMatrixInSkeletonSpace(inSkeleton);
        traverse(node, nv);
    }
};

ClipPlayer::ClipPlayer() = default;
ClipPlayer::~ClipPlayer() = default;

ClipPlayer::ClipPlayer(const ClipPlayer& other, const osg::CopyOp& copyop)
    : osg::Object(other, copyop), osg::Callback(other, copyop), osg::NodeCallback(other, copyop),
      _layers(other._layers), _weight(other._weight), _interpolated(other._interpolated),
      _root(other._root), _up(other._up) {
    OSG_WARN << "osgSkin: a copy of a ClipPlayer poses nothing, expected ClipCharacter to make one"
             << std::endl;
}

void ClipPlayer::setLayer(std::size_t index, const Layer& layer) {
    if (index >= _layers.size()) return;
    _layers[index] = layer;
    _layers[index].time = finite(layer.time);
    _layers[index].speed = finite(layer.speed);
}

void ClipPlayer::setWeight(double weight) {
    if (!std::isfinite(weight)) return;
    _weight = std::clamp(weight, 0.0, 1.0);
    _fade = 0.0;
}

/// Changes what is played so that twists continue from the present pose.
template <typename Change>
void ClipPlayer::change(const Change& change) {
    const bool continues = _posed && _layers[0].clip && knowsJoints();
    change();
    if (!continues) return;
    findJoints();
    for (std::size_t i = 0; i < _layers.size(); ++i) _posedTimes[i] = _layers[i].time;
}

/// The present pose of both layers as a clip of one sample.
osg::ref_ptr<const SampledClip> ClipPlayer::frozen() {
    if (!knowsJoints()) findJoints();
    const SampledClip& base = *_layers[_base].clip;
    const osg::ref_ptr<SampledClip> result = new SampledClip;
    result->_name = base.name();
    result->_joints = base.joints();
    result->_root = base.rootJoint();
    sampleLayers(result->_samples);
    return result;
}

void ClipPlayer::play(const Layer& layer, double fade) {
    if (!layer.clip) return;
    change([&] {
        const bool isFaded = _layers[0].clip && fade > 0.0;
        if (isFaded && _layers[1].clip && _weight > 0.0)
            _layers[0] = _weight < 1.0 ? Layer{frozen()} : _layers[1];
        setLayer(isFaded ? 1 : 0, layer);
        if (!isFaded) _layers[1] = {};
        _weight = 0.0;
        _fade = isFaded ? perSecond(fade) : 0.0;
    });
}

bool ClipPlayer::playOn(const std::string& joint, const Layer& layer, double fade) {
    if (!layer.clip || layer.clip->find(joint) < 0) return false;
    change([&] {
        _part.layer = layer;
        _part.layer.time = finite(layer.time);
        _part.layer.speed = finite(layer.speed);
        _part.joint = joint;
        _part.fade = perSecond(fade);
        if (!(fade > 0.0)) _part.weight = 1.0;
        _found[0] = nullptr;
    });
    return true;
}

void ClipPlayer::stopOn(double fade) {
    _part.fade = -perSecond(fade);
    if (!(fade > 0.0)) _part = {};
}

void ClipPlayer::advanceFades(double seconds) {
    const double passed = std::abs(seconds);
    if (_fade > 0.0 && passed > 0.0) _weight = std::min(1.0, _weight + _fade * passed);
    if (_fade > 0.0 && _weight == 1.0)
        change([&] {
            _layers[0] = _layers[1];
            _layers[1] = {};
            _weight = _fade = 0.0;
        });
    if (!_part.layer.clip) return;
    _part.layer.time = finite(_part.layer.time + _part.layer.speed * seconds);
    if (passed > 0.0) _part.weight = std::clamp(_part.weight + _part.fade * passed, 0.0, 1.0);
    if (_part.fade < 0.0 && _part.weight == 0.0) _part = {};
}

void ClipPlayer::setRoot(Root root, const osg::Vec3d& up) {
    _root = root;
    osg::Vec3d unit = up;
    if (std::isfinite(unit.normalize()) && unit.valid()) _up = unit;
    _motion = {};
}

osg::Vec3d ClipPlayer::takeRootMotion() {
    const osg::Vec3d result = _root == Root::Extracted ? _motion.shift : osg::Vec3d();
    _motion = {};
    return result;
}

osg::Matrixd ClipPlayer::takeRootMatrix(const osg::Matrixd& toWorld) {
    osg::Matrixd result = osg::Matrixd::rotate(osg::Quat(_motion.angle, _up));
    result.setTrans(_motion.shift);
    _motion = {};
    return osg::Matrixd::inverse(toWorld) * result * toWorld;
}

void ClipPlayer::addSkin(DeformableSkin* skin) {
    if (!skin) return;
    _skins.push_back({skin, nullptr, {}, {}, false});
    _found[0] = nullptr;
}

void ClipPlayer::addRigid(osg::MatrixTransform* transform, const std::string& joint,
                          const osg::Matrixd& toParent) {
    if (!transform) return;
    _rigids.push_back({transform, joint, toParent, -1});
    _found[0] = nullptr;
}

void ClipPlayer::addBones(osgAnimation::Skeleton* skeleton) {
    if (!skeleton) return;
    std::map<const osgAnimation::Bone*, int> indices;
    for (const osg::ref_ptr<osgAnimation::Bone>& bone : bonesInOrder(*skeleton)) {
        const osg::ref_ptr<PlacedBone> placed = new PlacedBone;
        placed->inParent = bone->getMatrix();
        placed->inSkeleton = bone->getMatrixInSkeletonSpace();
        if (osg::Callback* own = updateOf(*bone)) {
            placed->setNestedCallback(own->getNestedCallback());
            own->setNestedCallback(placed);
        } else {
            placed->setNestedCallback(bone->getUpdateCallback());
            bone->setUpdateCallback(placed);
        }
        const auto parent = indices.find(bone->getBoneParent());
        indices[bone] = static_cast<int>(_bones.size());
        _bones.push_back({placed, bone->getName(), parent == indices.end() ? -1 : parent->second,
                          -1, osg::Matrixd::inverse(bone->getInvBindMatrixInSkeletonSpace())});
    }
    _found[0] = nullptr;
}

ClipPlayer::GroundMove ClipPlayer::then(const GroundMove& first, const GroundMove& next) const {
    return {first.angle + next.angle, first.shift + osg::Quat(first.angle, _up) * next.shift};
}

ClipPlayer::GroundMove ClipPlayer::reversed(const GroundMove& move) const {
    return {-move.angle, osg::Quat(-move.angle, _up) * -move.shift};
}

ClipPlayer::GroundMove ClipPlayer::power(GroundMove move, double times) const {
    if (times < 0.0) return power(reversed(move), -times);
    GroundMove result;
    for (; times >= 1.0; times = std::floor(0.5 * times)) {
        if (std::fmod(times, 2.0) == 1.0) result = then(result, move);
        move = then(move, move);
    }
    return result;
}

double ClipPlayer::headingOf(const JointSample& root) const {
    if (_root != Root::ExtractedWithTurn) return 0.0;
    const glm::dquat& q = root.rotation; // its part about `up`, before which the rest bends
    return 2.0 * std::atan2(q.x * _up.x() + q.y * _up.y() + q.z * _up.z(), q.w);
}

/// From the first sample to another, about the root's position in the first sample.
ClipPlayer::GroundMove ClipPlayer::rootMove(const SampledClip& clip,
                                            const JointSample& root) const {
    const JointSample& first = clip.sample(0)[clip.rootJoint()];
    return {headingOf(root) - headingOf(first),
            alongGround(toOsg(root.translation - first.translation))};
}

/// The move from the first sample to a layer's time within its loop.
///
/// \param loops set to the number of loops before
ClipPlayer::GroundMove ClipPlayer::rootAt(const Layer& layer, double& loops) const {
    const SampledClip& clip = *layer.clip;
    const SampledClip::Place at = clip.place(layer.time, layer.loop);
    const auto rootOf = [&](std::size_t sample) { return clip.sample(sample)[clip.rootJoint()]; };
    loops = 0.0;
    if (layer.loop)
        loops = std::round((layer.time / clip.step() - static_cast<double>(at.from) - at.share) /
                           static_cast<double>(clip.sampleCount()));
    if (at.from <= at.to)
        return rootMove(clip, SampleBlend(at.share)(rootOf(at.from), rootOf(at.to)));
    GroundMove step = seamStep(clip);
    step.angle *= at.share;
    step.shift *= at.share;
    return then(rootMove(clip, rootOf(at.from)), step);
}

/// The step from the last sample back to the first: the mean of its neighbours.
ClipPlayer::GroundMove ClipPlayer::seamStep(const SampledClip& clip) const {
    const std::size_t last = clip.sampleCount() - 1;
    if (last == 0) return {};
    const auto moveAt = [&](std::size_t i) {
        return rootMove(clip, clip.sample(i)[clip.rootJoint()]);
    };
    const GroundMove before = then(reversed(moveAt(last - 1)), moveAt(last)), after = moveAt(1);
    return {0.5 * (wrapped(before.angle) + wrapped(after.angle)),
            (before.shift + after.shift) * 0.5};
}

/// The move of a layer's root in a time that passes; advances the layer.
ClipPlayer::GroundMove ClipPlayer::rootStep(Layer& layer, double seconds) const {
    double before = 0.0, after = 0.0;
    const GroundMove from = rootAt(layer, before);
    layer.time = finite(layer.time + layer.speed * seconds);
    GroundMove to = rootAt(layer, after);
    if (before != after) {
        const SampledClip& clip = *layer.clip;
        const JointSample& last = clip.sample(clip.sampleCount() - 1)[clip.rootJoint()];
        to = then(power(then(rootMove(clip, last), seamStep(clip)), after - before), to);
    }
    return then(reversed(from), to);
}

void ClipPlayer::advance(double seconds) {
    if (!std::isfinite(seconds)) return;
    const bool extracts = _root == Root::Extracted || _root == Root::ExtractedWithTurn;
    GroundMove move;
    osg::Vec3d pivot;
    for (std::size_t i = 0; i < _layers.size(); ++i) {
        Layer& layer = _layers[i];
        if (!extracts || !layer.clip) {
            layer.time = finite(layer.time + layer.speed * seconds);
            continue;
        }
        const double share = i == 1 ? _weight : _layers[1].clip ? 1.0 - _weight : 1.0;
        const GroundMove own = rootStep(layer, seconds);
        move.angle += share * wrapped(own.angle);
        move.shift += own.shift * share;
        const std::size_t root = layer.clip->rootJoint();
        pivot += alongGround(toOsg(layer.clip->joints()[root].centre +
                                   layer.clip->sample(0)[root].translation)) *
                 share;
    }
    advanceFades(seconds);
    if (!extracts) return;
    move.shift += pivot - osg::Quat(move.angle, _up) * pivot;
    _motion = then(_motion, move);
}

bool ClipPlayer::knowsJoints() const {
    return _found[0].get() == _layers[0].clip.get() && _found[1].get() == _layers[1].clip.get() &&
           _base == baseLayer() && std::all_of(_skins.begin(), _skins.end(), [](const Skin& skin) {
               return skin.model.get() == skin.skin->getModel();
           });
}

void ClipPlayer::compareClips() {
    _alike = true;
    _covers = false;
    if (!_layers[1].clip) return;
    const std::vector<SampledClip::Joint>& own = _layers[0].clip->joints();
    const std::vector<SampledClip::Joint>& others = _layers[1].clip->joints();
    _alike = std::equal(others.begin(), others.end(), own.begin(), own.end(),
                        [](const auto& a, const auto& b) { return a.name == b.name; });
    _covers =
        others.size() > own.size() && std::all_of(own.begin(), own.end(), [&](const auto& joint) {
            return _layers[1].clip->find(joint.name) >= 0;
        });
}

std::size_t ClipPlayer::baseLayer() const {
    if (!_layers[1].clip || _weight == 0.0 || _alike) return 0;
    return _weight == 1.0 || _covers ? 1 : 0;
}

void ClipPlayer::findJoints() {
    compareClips();
    _base = baseLayer();
    const SampledClip& clip = *_layers[_base].clip;
    _needsWhole = !_rigids.empty() || !_bones.empty();
    for (Skin& skin : _skins) {
        skin.model = skin.skin->getModel();
        skin.joints.clear();
        skin.direct = skin.same = true;
        if (!skin.skin->getModel()) continue;
        skin.pose = Pose(skin.model->joints(), skin.model->inputs().size());
        for (const BoundJoint& joint : skin.skin->getModel()->joints()) {
            const int found = clip.find(joint.name);
            const int above =
                joint.parent < 0 ? -1 : skin.joints[static_cast<std::size_t>(joint.parent)];
            if (found >= 0 && parentJoint(clip, found) != above) skin.direct = false;
            // A joint that the clip lacks moves with its parent, and its descendants with that.
            if (found < 0 && above >= 0) skin.direct = false;
            if (found != static_cast<int>(skin.joints.size())) skin.same = false;
            skin.joints.push_back(found >= 0 ? found : above);
        }
        _needsWhole = _needsWhole || !skin.direct;
    }
    for (Rigid& rigid : _rigids) rigid.joint = clip.find(rigid.name);
    for (Bone& bone : _bones) bone.joint = clip.find(bone.name);
    _part.joints.assign(clip.joints().size(), -1);
    std::vector<bool> isBelow(clip.joints().size());
    for (std::size_t j = 0; _part.layer.clip && j < isBelow.size(); ++j) {
        const SampledClip::Joint& joint = clip.joints()[j];
        isBelow[j] = joint.name == _part.joint ||
                     (joint.parent >= 0 && isBelow[static_cast<std::size_t>(joint.parent)]);
        if (isBelow[j]) _part.joints[j] = _part.layer.clip->find(joint.name);
    }
    _others.clear();
    if (const SampledClip* other = _layers[1 - _base].clip.get())
        for (const SampledClip::Joint& joint : clip.joints())
            _others.push_back(other->find(joint.name));
    for (std::size_t i = 0; i < _found.size(); ++i) _found[i] = _layers[i].clip.get();
}

/// The joints' transforms at a layer's time, without what the root does not move by.
void ClipPlayer::sampleLayer(const Layer& layer, std::vector<JointSample>& joints) const {
    joints.resize(layer.clip->joints().size());
    SampledClip::Place at = layer.clip->place(layer.time, layer.loop);
    if (!_interpolated) at.share = 0.0;
    const JointSample* from = layer.clip->sample(at.from);
    const JointSample* next = layer.clip->sample(at.to);
    const SampleBlend between(at.share);
    for (std::size_t j = 0; j < joints.size(); ++j) joints[j] = between(from[j], next[j]);
    if (_root == Root::Moving) return;
    JointSample& root = joints[layer.clip->rootJoint()];
    const GroundMove gone = rootMove(*layer.clip, root);
    root.translation -= toGlm(gone.shift);
    if (gone.angle != 0.0) root.rotation = glm::angleAxis(-gone.angle, toGlm(_up)) * root.rotation;
}

/// Both layers.
void ClipPlayer::sampleLayers(std::vector<JointSample>& joints) const {
    static thread_local std::vector<JointSample> others;
    sampleLayer(_layers[_base], joints);
    const double weight = _base == 0 ? _weight : 1.0 - _weight;
    if (!_layers[1].clip || weight == 0.0) return;
    sampleLayer(_layers[1 - _base], others);
    const SampleBlend weighted(weight);
    for (std::size_t j = 0; j < joints.size(); ++j)
        joints[j] =
            weighted(joints[j],
                     _others[j] < 0 ? JointSample() : others[static_cast<std::size_t>(_others[j])]);
}

void ClipPlayer::sampleJoints(std::vector<JointSample>& joints) const {
    static thread_local std::vector<JointSample> part;
    sampleLayers(joints);
    if (_part.weight == 0.0) return;
    sampleLayer(_part.layer, part);
    const SampleBlend weighted(_part.weight);
    for (std::size_t j = 0; j < joints.size(); ++j)
        if (_part.joints[j] >= 0)
            joints[j] = weighted(joints[j], part[static_cast<std::size_t>(_part.joints[j])]);
}

void ClipPlayer::poseBones(const std::vector<JointMap>& whole) const {
    for (const Bone& bone : _bones) {
        const Bone* parent =
            bone.parent < 0 ? nullptr : &_bones[static_cast<std::size_t>(bone.parent)];
        PlacedBone& placed = *bone.placed;
        if (bone.joint >= 0) {
            placed.inSkeleton = bone.bind * toMatrix(whole[static_cast<std::size_t>(bone.joint)]);
            placed.inParent = placed.inSkeleton;
            if (parent) placed.inParent.postMult(osg::Matrixd::inverse(parent->placed->inSkeleton));
        } else {
            placed.inSkeleton = placed.inParent;
            if (parent) placed.inSkeleton.postMult(parent->placed->inSkeleton);
        }
    }
}

bool ClipPlayer::poseSkin(Skin& skin, const std::vector<JointMap>& own,
                          const std::vector<JointMap>& whole, Pose::Twist twist, const Pose* baked,
                          const osg::BoundingBox* bounds) const {
    static thread_local std::vector<JointMap> maps;
    if (!skin.skin->getModel()) return false;
    const std::vector<BoundJoint>& joints = skin.skin->getModel()->joints();
    if (joints.size() != skin.joints.size()) return false;
    const auto set = [&](const std::vector<JointMap>& of) {
        if (!baked) return skin.skin->setPose(of.data(), joints.size(), twist);
        // Twists continue those of the sample, whatever was shown before.
        if (!skin.pose.setJoints(*baked) ||
            !skin.pose.set(of.data(), joints.size(), Pose::Twist::Continued))
            return false;
        if (bounds->valid()) return skin.skin->setPose(skin.pose, *bounds);
        return skin.skin->setPose(skin.pose,
                                  toOsg(computePoseBounds(*skin.skin->getModel(), skin.pose)));
    };
    if (skin.direct && skin.same) return set(own);
    maps.assign(joints.size(), JointMap());
    for (std::size_t j = 0; j < joints.size(); ++j) {
        const int found = skin.joints[j];
        if (found < 0) continue;
        const auto at = static_cast<std::size_t>(found);
        if (skin.direct) {
            maps[j] = own[at];
            continue;
        }
        const int above =
            joints[j].parent < 0 ? -1 : skin.joints[static_cast<std::size_t>(joints[j].parent)];
        if (above == found) continue;
        maps[j] =
            above < 0 ? whole[at] : inverse(whole[static_cast<std::size_t>(above)]) * whole[at];
    }
    return set(maps);
}

const ClipPlayer::Layer* ClipPlayer::layerAlone() const {
    if (!_layers[1].clip || _weight == 0.0) return _layers.data();
    return _weight == 1.0 ? &_layers[1] : nullptr;
}

const BakedClip* ClipPlayer::findBaked() const {
    const Layer* layer = layerAlone();
    if (_baked.empty() || !layer || _root != Root::Moving || _part.weight > 0.0) return nullptr;
    const auto baked = std::find_if(_baked.begin(), _baked.end(),
                                    [&](const auto& b) { return b->clip == layer->clip; });
    if (baked == _baked.end() || (*baked)->skins.size() != _skins.size() ||
        (*baked)->rigids.size() != _rigids.size())
        return nullptr;
    for (std::size_t i = 0; i < _skins.size(); ++i) {
        const DeformableSkin& skin = *_skins[i].skin;
        if (skin.getModel() != (*baked)->skins[i].model || isActivated(skin)) return nullptr;
    }
    return baked->get();
}

bool ClipPlayer::poseBaked(const BakedClip& baked, std::size_t sample) const {
    bool good = true;
    for (std::size_t i = 0; i < _skins.size(); ++i) {
        const BakedClip::Skin& skin = baked.skins[i];
        good = _skins[i].skin->setPose(skin.poses[sample], skin.bounds[sample]) && good;
    }
    for (std::size_t i = 0; i < _rigids.size(); ++i)
        _rigids[i].transform->setMatrix(baked.rigids[i][sample]);
    return good;
}

bool ClipPlayer::isContinued() const {
    const auto isNear = [&](std::size_t i) {
        return std::abs(_layers[i].time - _posedTimes[i]) <= kSeekSeconds;
    };
    return _posed && knowsJoints() && isNear(0) && (!_layers[1].clip || isNear(1));
}

bool ClipPlayer::pose() {
    const bool good = poseAs(isContinued() ? Pose::Twist::Continued : Pose::Twist::Shortest);
    _posed = good;
    for (std::size_t i = 0; i < _layers.size(); ++i) _posedTimes[i] = _layers[i].time;
    return good;
}

bool ClipPlayer::poseAs(Pose::Twist twist) {
    if (!_layers[0].clip) return false;
    const BakedClip* baked = findBaked();
    SampledClip::Place at;
    if (baked) {
        const Layer& layer = *layerAlone();
        at = layer.clip->place(layer.time, layer.loop);
        if ((!_interpolated || at.share == 0.0) && poseBaked(*baked, at.from)) return true;
    }
    if (!knowsJoints()) findJoints();
    static thread_local std::vector<JointSample> samples;
    static thread_local std::vector<JointMap> own, whole;
    sampleJoints(samples);
    const std::vector<SampledClip::Joint>& joints = _layers[_base].clip->joints();
    own.resize(samples.size());
    whole.resize(samples.size());
    for (std::size_t j = 0; j < samples.size(); ++j) {
        own[j] = mapOf(samples[j], joints[j].centre);
        if (_needsWhole)
            whole[j] = joints[j].parent < 0
                           ? own[j]
                           : whole[static_cast<std::size_t>(joints[j].parent)] * own[j];
    }
    bool good = true;
    for (std::size_t i = 0; i < _skins.size(); ++i) {
        const osg::BoundingBox* bounds = baked ? &baked->skins[i].boundsAt(at) : nullptr;
        const Pose* from = baked ? &baked->skins[i].poses[at.from] : nullptr;
        good = poseSkin(_skins[i], own, whole, twist, from, bounds) && good;
    }
    for (const Rigid& rigid : _rigids)
        rigid.transform->setMatrix(rigid.joint < 0
                                       ? rigid.toParent
                                       : toMatrix(whole[static_cast<std::size_t>(rigid.joint)]) *
                                             rigid.toParent);
    poseBones(whole);
    return good;
}

void ClipPlayer::operator()(osg::Node* node, osg::NodeVisitor* nv) {
    if (nv && nv->getFrameStamp()) {
        const double now = nv->getFrameStamp()->getSimulationTime();
        if (_started) advance(now - _last);
        _last = now;
        _started = true;
    }
    pose();
    traverse(node, nv);
}

} // namespace osgSkin
