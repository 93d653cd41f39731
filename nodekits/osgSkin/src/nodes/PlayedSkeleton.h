// SPDX-License-Identifier: MIT
#ifndef OSGSKIN_NODES_PLAYEDSKELETON_H
#define OSGSKIN_NODES_PLAYEDSKELETON_H 1

#include <osgSkin/RigidPart>
#include <osgSkin/UpdatePlayedSkeleton>

#include <osg/observer_ptr>
#include <osgAnimation/Channel>
#include <osgAnimation/StackedTransformElement>
#include <osgAnimation/UpdateBone>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace osgSkin {

inline bool isAffine(const osg::Matrixd& m) {
    return m(0, 3) == 0.0 && m(1, 3) == 0.0 && m(2, 3) == 0.0 && m(3, 3) == 1.0;
}

inline bool isBone(const osg::Node& node) {
    return dynamic_cast<const osgAnimation::Bone*>(&node) != nullptr;
}

/// An element of a bone's stack of transforms.
struct PlayedElement {
    enum Kind { kTranslate, kRotate, kScale, kMatrix, kUnknown };

    explicit PlayedElement(osgAnimation::StackedTransformElement* of);

    Kind kind = kUnknown;
    bool isStepped = false;
    std::size_t cursor = 0; ///< the first one of the two keys that were used last
    osgAnimation::StackedTransformElement* element;
    osgAnimation::Target* target; ///< the element's; null: no channel has been linked with it
    osg::ref_ptr<const osgAnimation::KeyframeContainer> keys; ///< of the clip; may be null
    std::uintptr_t lastKey = 0;                               ///< at `cursor`; may be gone
};

/// A bone and what is needed to detect changes.
struct PlayedBone {
    osgAnimation::Bone* bone;
    int parent;
    osgAnimation::UpdateBone* update; ///< null if its callback is not a plain UpdateBone
    osg::Callback* callback;
    osg::Callback* nested;
    unsigned int updatedChildren;
    std::size_t firstChild, childCount;
    std::size_t firstElement, elementCount;
    glm::dmat4 inverseBind;
};

struct PlayedPart {
    osg::ref_ptr<RigidPart> part;
    std::size_t bone;
    osg::Matrixd toSkeleton; ///< from the bone's node, in the last pose()
};

struct PlayedChild {
    osg::Node* node;
    unsigned int updatedChildren;
};

/// The skeleton as it was found, the clip's channels on it, and its pose.
struct UpdatePlayedSkeleton::Playing {
    void find(osgAnimation::Skeleton& skeleton);
    void findBones(osg::Group& parent, int parentBone);
    void link(osgAnimation::Animation& animation);
    bool isSame(const osgAnimation::Skeleton& skeleton);
    void updateChannels(const std::vector<osg::ref_ptr<osgAnimation::Channel>>& list) const {
        for (const osg::ref_ptr<osgAnimation::Channel>& channel : list) channel->reset();
        for (const osg::ref_ptr<osgAnimation::Channel>& channel : list)
            channel->update(time, clip->getWeight(), 0);
    }
    void poseBones(osg::Group& parent) const;
    std::ptrdiff_t prefetchKeys();
    void pose();

    osg::observer_ptr<osgAnimation::Skeleton> skeleton;
    std::vector<PlayedChild> top; ///< the skeleton's children
    std::vector<PlayedBone> bones;
    std::vector<osg::Node*> children;    ///< of all bones
    std::vector<PlayedElement> elements; ///< of all bones
    std::vector<PlayedPart> parts;
    bool isPlain = false;      ///< nothing is known that needs the bones
    bool isDrawnPlain = false; ///< bones have no state, mask or callback of their own
    bool isShared = false;     ///< the callback serves another skeleton, too

    osg::ref_ptr<osgAnimation::Animation> clip;
    std::size_t channelCount = 0;
    std::vector<osg::ref_ptr<osgAnimation::Channel>> driving; ///< bones
    std::vector<osg::ref_ptr<osgAnimation::Channel>> others;
    bool isLinked = false; ///< all channels of bones are known ones

    bool hasPlayed = false; ///< play() was called since the last update
    double time = 0.0;

    std::vector<glm::dmat4> inSkeleton;
    std::vector<glm::dmat4> skinning;
};

} // namespace osgSkin

#endif
