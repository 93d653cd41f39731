// SPDX-License-Identifier: MIT
#include <osgSkin/UpdatePlayedSkeleton>

#include "nodes/PlayedSkeleton.h"

#include <osg/NodeVisitor>
#include <osgUtil/CullVisitor>

#include <algorithm>
#include <atomic>
#include <utility>

namespace osgSkin {
namespace {

using osgAnimation::Channel;
using osgAnimation::Skeleton;

/// Whether a channel has set the target since its last reset().
struct TargetState : osgAnimation::Target {
    static bool isSet(const osgAnimation::Target& target) {
        return target.*(&TargetState::_weight) > 0.0f ||
               target.*(&TargetState::_priorityWeight) > 0.0f;
    }
};

/// A matrix of a cull visitor's own, as it uses for transforms.
struct MatrixPool : osgUtil::CullVisitor {
    static osg::RefMatrix* take(osgUtil::CullVisitor& cv) {
        return (cv.*(&MatrixPool::createOrReuseMatrix))(*cv.getModelViewMatrix());
    }
};

} // namespace

UpdatePlayedSkeleton::UpdatePlayedSkeleton() = default;
UpdatePlayedSkeleton::~UpdatePlayedSkeleton() = default;

UpdatePlayedSkeleton::UpdatePlayedSkeleton(const UpdatePlayedSkeleton& other,
                                           const osg::CopyOp& copyop)
    : osg::Object(other, copyop), osg::Callback(other, copyop),
      osgAnimation::Skeleton::UpdateSkeleton(other, copyop), _bonesFollow(other._bonesFollow) {
    // OSG copies a node's callbacks before its children.
    const_cast<UpdatePlayedSkeleton&>(other).poseBones();
}

UpdatePlayedSkeleton* UpdatePlayedSkeleton::of(const osg::Node& skeleton) {
    for (const osg::Callback* c = skeleton.getUpdateCallback(); c; c = c->getNestedCallback())
        if (auto* found = dynamic_cast<const UpdatePlayedSkeleton*>(c))
            return const_cast<UpdatePlayedSkeleton*>(found);
    return nullptr;
}

bool UpdatePlayedSkeleton::play(osgAnimation::Animation& clip, double time) {
    Playing* const playing = _playing.get();
    if (!playing || playing->isShared) return false;
    if (playing->clip != &clip || playing->channelCount != clip.getChannels().size()) {
        if (_skipsBones) stopSkipping(); // the channels that lead there are about to be forgotten
        playing->link(clip);
    }
    if (!playing->isLinked) return false;
    playing->time = time;
    playing->hasPlayed = true;
    playing->updateChannels(playing->others);
    return true;
}

/// Makes channels' targets, bones and rigid parts as if the bones had followed.
void UpdatePlayedSkeleton::stopSkipping() {
    _skipsBones = false;
    Playing& playing = *_playing;
    for (const osg::ref_ptr<Channel>& channel : playing.driving)
        // Skips targets that another animation drives.
        if (!TargetState::isSet(*channel->getTarget())) channel->update(playing.time, 1.0f, 0);
    if (!playing.skeleton.valid()) return;
    playing.poseBones(*playing.skeleton);
    playing.skeleton->dirtyBound(); // see PlayedSkeletonBound
}

void UpdatePlayedSkeleton::poseBones() {
    if (_skipsBones) stopSkipping();
}

const std::vector<glm::dmat4>& UpdatePlayedSkeleton::skinning() const {
    static const std::vector<glm::dmat4> none;
    return _playing ? _playing->skinning : none;
}

int UpdatePlayedSkeleton::find(const osgAnimation::Bone* bone) const {
    if (_playing)
        for (std::size_t b = 0; b < _playing->bones.size(); ++b)
            if (_playing->bones[b].bone == bone) return static_cast<int>(b);
    return -1;
}

void UpdatePlayedSkeleton::operator()(osg::Node* node, osg::NodeVisitor* nv) {
    auto* skeleton = dynamic_cast<Skeleton*>(node);
    if (!skeleton || !nv || nv->getVisitorType() != osg::NodeVisitor::UPDATE_VISITOR)
        return UpdateSkeleton::operator()(node, nv);
    if (!_playing) _playing = std::make_unique<Playing>();
    Playing& playing = *_playing;
    const bool hasPlayed = std::exchange(playing.hasPlayed, false);
    if (!playing.isShared && !playing.isSame(*skeleton)) {
        if (_skipsBones) stopSkipping();
        playing.find(*skeleton);
        static std::atomic<unsigned int> revisions{0};
        _revision = ++revisions;
        if (playing.clip) playing.link(*playing.clip);
        if (!skeleton->getCullCallback()) skeleton->setCullCallback(new CullPlayedSkeleton);
        if (!skeleton->getComputeBoundingSphereCallback())
            skeleton->setComputeBoundingSphereCallback(new PlayedSkeletonBound);
    }
    const bool skips = hasPlayed && playing.isLinked && playing.isPlain && !playing.isShared &&
                       !_bonesFollow && !getNestedCallback();
    if (!skips) {
        if (_skipsBones) stopSkipping();
        if (hasPlayed) playing.updateChannels(playing.driving);
        return UpdateSkeleton::operator()(node, nv);
    }
    if (!_skipsBones)
        for (const osg::ref_ptr<Channel>& channel : playing.driving) channel->reset();
    _skipsBones = true;
    playing.pose();
    skeleton->dirtyBound();
    for (unsigned int i = 0; i < skeleton->getNumChildren(); ++i)
        if (!isBone(*skeleton->getChild(i))) skeleton->getChild(i)->accept(*nv);
}

bool UpdatePlayedSkeleton::mayDrawWithoutBones() const {
    return _skipsBones && _playing->isDrawnPlain;
}

void UpdatePlayedSkeleton::CullPlayedSkeleton::operator()(osg::Node* node, osg::NodeVisitor* nv) {
    osgUtil::CullVisitor* const cv = nv ? nv->asCullVisitor() : nullptr;
    osg::Group* const skeleton = node ? node->asGroup() : nullptr;
    const UpdatePlayedSkeleton* const played =
        cv && skeleton && !getNestedCallback() ? of(*node) : nullptr;
    if (!played || !played->mayDrawWithoutBones()) {
        traverse(node, nv);
        return;
    }
    for (unsigned int i = 0; i < skeleton->getNumChildren(); ++i)
        if (!isBone(*skeleton->getChild(i))) skeleton->getChild(i)->accept(*nv);
    for (const PlayedPart& part : played->_playing->parts) {
        osg::RefMatrix* const matrix = MatrixPool::take(*cv);
        matrix->preMult(part.toSkeleton);
        cv->pushModelViewMatrix(matrix, osg::Transform::RELATIVE_RF);
        part.part->accept(*nv);
        cv->popModelViewMatrix();
    }
}

// The bones' own bounds are not asked for, so they may stay marked as old while the skeleton's is
// new: stopSkipping() marks the latter, too.
osg::BoundingSphere
UpdatePlayedSkeleton::PlayedSkeletonBound::computeBound(const osg::Node& node) const {
    const auto* const skeleton = dynamic_cast<const Skeleton*>(&node);
    const UpdatePlayedSkeleton* const played = skeleton ? of(node) : nullptr;
    if (!played || !played->_skipsBones) return node.computeBound();
    osg::BoundingBox box;
    for (unsigned int i = 0; i < skeleton->getNumChildren(); ++i) {
        const osg::Node& child = *skeleton->getChild(i);
        if (isBone(child)) continue;
        const osg::Transform* const transform = child.asTransform();
        if (transform && transform->getReferenceFrame() != osg::Transform::RELATIVE_RF) continue;
        if (const osg::Drawable* drawable = child.asDrawable())
            box.expandBy(drawable->getBoundingBox());
        else
            box.expandBy(child.getBound());
    }
    for (const PlayedPart& part : played->_playing->parts) {
        osg::BoundingSphere sphere = part.part->getBound();
        if (!sphere.valid()) continue;
        osg::BoundingSphere moved(sphere.center() * part.toSkeleton, 0.0f);
        for (const osg::Vec3& axis : {osg::Vec3(1, 0, 0), osg::Vec3(0, 1, 0), osg::Vec3(0, 0, 1)})
            moved.radius() = std::max(
                moved.radius(),
                sphere.radius() * osg::Matrixd::transform3x3(axis, part.toSkeleton).length());
        box.expandBy(moved);
    }
    osg::BoundingSphere result;
    if (!box.valid()) return result;
    const osg::Matrixd& toParent = skeleton->getMatrix();
    result.set(box.center() * toParent, 0.0f);
    for (unsigned int corner = 0; corner < 8; ++corner)
        result.radius() =
            std::max(result.radius(), (box.corner(corner) * toParent - result.center()).length());
    return result;
}

} // namespace osgSkin
