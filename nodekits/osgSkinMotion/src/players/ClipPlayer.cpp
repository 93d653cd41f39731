// SPDX-License-Identifier: MIT
#include <osgSkinMotion/ClipPlayer>

#include "bones/Figure.h"
#include "clips/BakedClip.h"
#include "clips/ClipBones.h"
#include "clips/JointMaps.h"
#include "players/ClipLayers.h"
#include "players/FigureClips.h"
#include "players/PlacedBone.h"

#include <osgSkin/Error>
#include <osgSkin/GlmOsg>
#include <osgSkin/PoseBounds>

#include <osg/FrameStamp>
#include <osg/NodeVisitor>
#include <osg/Notify>
#include <osgAnimation/AnimationManagerBase>

#include <algorithm>
#include <cmath>
#include <map>

namespace osgSkin {
namespace {

/// Baked bounds do not include activations.
bool isActivated(const DeformableSkin& skin) {
    const std::size_t inputs = skin.getModel() ? skin.getModel()->inputs().size() : 0;
    for (std::size_t i = 0; i < inputs; ++i)
        if (skin.getPose().input(i) != 0.0f) return true;
    return false;
}

std::vector<osg::ref_ptr<osgAnimation::Bone>> bonesBelowRoot(osg::Node& root) {
    osgAnimation::Skeleton* const skeleton = skeletonBelow(root);
    return skeleton ? bonesInOrder(*skeleton) : std::vector<osg::ref_ptr<osgAnimation::Bone>>();
}

PlacedBone* placedOf(osgAnimation::Bone& bone) {
    for (osg::Callback* c = bone.getUpdateCallback(); c; c = c->getNestedCallback())
        if (auto* placed = dynamic_cast<PlacedBone*>(c)) return placed;
    return nullptr;
}

int parentJoint(const SampledClip& clip, int joint) {
    return joint < 0 ? -1 : clip.joints()[static_cast<std::size_t>(joint)].parent;
}

} // namespace

void PlacedBone::operator()(osg::Node* node, osg::NodeVisitor* nv) {
    if (auto* bone = isSet ? dynamic_cast<osgAnimation::Bone*>(node) : nullptr) {
        bone->setMatrix(inParent);
        bone->setMatrixInSkeletonSpace(inSkeleton);
    }
    traverse(node, nv);
}

ClipPlayer::ClipPlayer() : _layers(new ClipLayers) {}
ClipPlayer::~ClipPlayer() = default;

ClipPlayer::ClipPlayer(const ClipPlayer& other, const osg::CopyOp& copyop)
    : osg::Object(other, copyop), osg::Callback(other, copyop), Attachment(other, copyop),
      _layers(new ClipLayers(*other._layers)), _isAttached(other._isAttached),
      _toWorld(other._toWorld), _clips(other._clips) {
    if (_isAttached) return;
    OSG_WARN << "osgSkin: a copy of a ClipPlayer poses nothing, expected ClipCharacter to make one"
             << std::endl;
}

osg::ref_ptr<ClipPlayer> ClipPlayer::create(osg::Node& root) {
    const osg::ref_ptr<ClipPlayer> result = new ClipPlayer;
    result->setFigure(root, findFigure(root, "clip player"));
    return result;
}

void ClipPlayer::setFigure(osg::Node& root, const Figure& figure) {
    topBoneOf(figure); // throws where there is none
    _root = &root;
    _toWorld = figure.toWorld;
    // The scene's Z in rest space.
    setRoot(Root::Moving, osg::Matrixd::transform3x3(_toWorld, osg::Vec3d(0.0, 0.0, 1.0)));
}

bool ClipPlayer::replaces(const Attachment& other) const {
    return dynamic_cast<const ClipPlayer*>(&other) != nullptr;
}

void ClipPlayer::onAttach(osg::Node& root) {
    std::vector<osg::ref_ptr<osg::Callback>> managers = takeManagers(root);
    for (auto manager = managers.rbegin(); manager != managers.rend(); ++manager) {
        (*manager)->setNestedCallback(getNestedCallback());
        setNestedCallback(*manager);
    }
    _isAttached = true;
    findBones(root);
}

void ClipPlayer::onDetach(osg::Node& root) {
    _isAttached = false;
    _bones.clear();
    const std::vector<osg::ref_ptr<osgAnimation::Bone>> bones = bonesBelowRoot(root);
    for (const osg::ref_ptr<osgAnimation::Bone>& bone : bones)
        if (PlacedBone* placed = placedOf(*bone)) bone->removeUpdateCallback(placed);
}

osg::ref_ptr<const SampledClip> ClipPlayer::clip(const std::string& name) {
    osg::ref_ptr<const SampledClip>& sampled = _clips[name];
    if (sampled) return sampled;
    osg::ref_ptr<osg::Node> root;
    if (!_root.lock(root))
        throw Error("clip player: it is attached to no character, which would have \"" + name +
                    '"');
    const Figure figure = findFigure(*root, "clip player");
    return sampled = sampleNamed(name, animationsOf(*root), *figure.skeleton, figure.label);
}

void ClipPlayer::setLayer(std::size_t index, const Layer& layer) {
    const auto isKnown = [&](const std::string& joint) {
        if (layer.clip->find(joint) >= 0) return true;
        for (std::size_t i = 0; i < kMaxLayers; ++i) // a clip may lack some that others move
            if (getLayer(i).clip && getLayer(i).clip->find(joint) >= 0) return true;
        return false;
    };
    if (!layer.clip || std::all_of(layer.joints.begin(), layer.joints.end(), isKnown))
        return _layers->set(index, layer); // allocates nothing
    Layer named = layer;
    for (std::string& joint : named.joints)
        if (!isKnown(joint)) joint = jointsBelow(*layer.clip, joint).front();
    _layers->set(index, named);
}

const ClipPlayer::Layer& ClipPlayer::getLayer(std::size_t index) const {
    return _layers->get(index);
}

void ClipPlayer::seek(std::size_t index, double time) {
    _layers->seek(index, time);
}

void ClipPlayer::setPhase(double phase) {
    if (std::isfinite(phase)) _layers->setPhase(phase);
}

void ClipPlayer::setSpeed(std::size_t index, double speed) {
    _layers->setSpeed(index, speed);
}

void ClipPlayer::fade(std::size_t index, double weight, double seconds, Easing easing) {
    _layers->fade(index, weight, seconds, easing);
}

void ClipPlayer::play(const Layer& layer, double fade, Easing easing) {
    if (layer.clip) _layers->play(layer, fade, easing, posedJoints());
}

bool ClipPlayer::playOn(const std::string& joint, const Layer& layer, double fade, Easing easing) {
    if (!layer.clip) return false;
    Layer part = layer;
    part.joints = jointsBelow(*layer.clip, joint);
    _layers->playOn(part, fade, easing);
    return true;
}

void ClipPlayer::stopOn(double fade, Easing easing) {
    _layers->stopOn(fade, easing);
}

void ClipPlayer::addEvent(const SampledClip* clip, double time, const std::string& name,
                          const Event& event) {
    _layers->addEvent(clip, time, name, event);
}

void ClipPlayer::onEvent(const std::string& name, const Event& event) {
    _layers->onEvent(name, event);
}

void ClipPlayer::addFootEvents(
    const SampledClip* clip,
    const std::function<void(ClipPlayer& player, std::size_t foot)>& event) {
    if (!clip || !event) return;
    for (const FootContacts::Contact& contact : clip->footContacts().all)
        addEvent(
            clip, contact.begin, contact.foot == 0 ? "LeftFoot" : "RightFoot",
            [event, foot = contact.foot](ClipPlayer& player, std::size_t) { event(player, foot); });
}

void ClipPlayer::removeEvents(const SampledClip* clip) {
    _layers->removeEvents(clip);
}

void ClipPlayer::setInterpolated(bool interpolated) {
    _layers->setInterpolated(interpolated);
}

bool ClipPlayer::getInterpolated() const {
    return _layers->isInterpolated();
}

void ClipPlayer::setRoot(Root root) {
    setRoot(root, _layers->up());
}

void ClipPlayer::setRoot(Root root, const osg::Vec3d& up) {
    _layers->setRoot(root, up);
}

ClipPlayer::Root ClipPlayer::getRoot() const {
    return _layers->root();
}

osg::Vec3d ClipPlayer::takeRootMotion() {
    const osg::Vec3d shift = _layers->takeMotion().shift;
    return getRoot() == Root::ExtractedWithTurn ? osg::Vec3d() : shift;
}

osg::Matrixd ClipPlayer::takeRootMatrix() {
    const ClipLayers::GroundMove move = _layers->takeMotion();
    osg::Matrixd result = osg::Matrixd::rotate(osg::Quat(move.angle, _layers->up()));
    result.setTrans(move.shift);
    return osg::Matrixd::inverse(_toWorld) * result * _toWorld;
}

void ClipPlayer::addSkin(DeformableSkin* skin) {
    if (!skin) return;
    _skins.push_back({skin, nullptr, {}, {}, false});
    _found = nullptr;
}

void ClipPlayer::addRigid(osg::MatrixTransform* transform, const std::string& joint,
                          const osg::Matrixd& toParent) {
    if (!transform) return;
    _rigids.push_back({transform, joint, toParent, -1});
    _found = nullptr;
}

void ClipPlayer::findBones(osg::Node& root) {
    _root = &root;
    _bones.clear();
    _found = nullptr;
    std::map<const osgAnimation::Bone*, int> indices;
    for (const osg::ref_ptr<osgAnimation::Bone>& bone : bonesBelowRoot(root)) {
        osg::ref_ptr<PlacedBone> placed = placedOf(*bone);
        if (!placed) {
            placed = new PlacedBone;
            osgAnimation::UpdateBone* const own = updateOf(*bone);
            placed->setNestedCallback(own ? own->getNestedCallback() : bone->getUpdateCallback());
            if (own)
                own->setNestedCallback(placed);
            else
                bone->setUpdateCallback(placed);
        }
        placed->inParent = bone->getMatrix();
        placed->inSkeleton = bone->getMatrixInSkeletonSpace();
        placed->isSet = true;
        const auto parent = indices.find(bone->getBoneParent());
        indices[bone] = static_cast<int>(_bones.size());
        _bones.push_back({placed, bone->getName(), parent == indices.end() ? -1 : parent->second,
                          -1, osg::Matrixd::inverse(bone->getInvBindMatrixInSkeletonSpace())});
    }
}

void ClipPlayer::advance(double seconds) {
    if (!std::isfinite(seconds)) return;
    _layers->advance(seconds);
    _layers->callEvents(*this);
}

bool ClipPlayer::knowsJoints(const SampledClip& clip) const {
    return _found.get() == &clip && std::all_of(_skins.begin(), _skins.end(), [](const Skin& skin) {
               return skin.model.get() == skin.skin->getModel();
           });
}

void ClipPlayer::findJoints(const SampledClip& clip) {
    _found = &clip;
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
        if (!baked && bounds) return skin.skin->setPose(of.data(), joints.size(), *bounds);
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

const BakedClip* ClipPlayer::findBaked(const Layer* layer) const {
    if (_baked.empty() || !layer || getRoot() != Root::Moving || posedJoints()) return nullptr;
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

bool ClipPlayer::pose() {
    const bool isContinued = _posed && _layers->isContinued();
    _posed = poseAs(isContinued ? Pose::Twist::Continued : Pose::Twist::Shortest);
    _layers->markPosed();
    return _posed;
}

bool ClipPlayer::poseAs(Pose::Twist twist) {
    const SampledClip* clip = _layers->prepare();
    if (!clip) return false;
    const Layer* alone = _layers->alone();
    const BakedClip* baked = findBaked(alone);
    SampledClip::Interval at;
    if (baked) {
        at = alone->clip->intervalAt(alone->time, alone->loop);
        if ((!getInterpolated() || at.share == 0.0) && poseBaked(*baked, at.from)) return true;
    }
    if (!knowsJoints(*clip)) findJoints(*clip);
    static thread_local std::vector<JointSample> samples;
    static thread_local std::vector<JointMap> own, whole;
    _layers->sample(samples, posedJoints());
    const std::vector<SampledClip::Joint>& joints = clip->joints();
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
        const osg::BoundingBox* bounds = baked ? &baked->skins[i].boundsAt(at) : knownBounds(i);
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
    if (!_isAttached || !node || !nv) {
        pose();
        traverse(node, nv);
        return;
    }
    if (_root != node) findBones(*node); // of a copy, or of a scene that was read
    pose();
    osg::Callback* next = getNestedCallback();
    while (dynamic_cast<osgAnimation::AnimationManagerBase*>(next)) // they pause
        next = next->getNestedCallback();
    if (next)
        next->run(node, nv);
    else
        nv->traverse(*node);
}

} // namespace osgSkin
