// SPDX-License-Identifier: MIT
// Callbacks have virtual bases, for which the wrapper's default cast does not compile.
#undef OBJECT_CAST
#define OBJECT_CAST dynamic_cast

#include "RegisterWrapper.h"

#include <osgSkin/UpdatePlayedSkeleton>

#include <osgDB/InputStream>
#include <osgDB/OutputStream>

namespace {

using osgSkin::UpdatePlayedSkeleton;

/// Poses the bones before they are saved, which comes after a node's callbacks: they may not have
/// followed.
class BonesFollowSerializer : public osgDB::PropByValSerializer<UpdatePlayedSkeleton, bool> {
public:
    BonesFollowSerializer()
        : PropByValSerializer("BonesFollow", false, &UpdatePlayedSkeleton::getBonesFollow,
                              &UpdatePlayedSkeleton::setBonesFollow) {}

    bool write(osgDB::OutputStream& out, const osg::Object& object) override {
        const_cast<UpdatePlayedSkeleton&>(OBJECT_CAST<const UpdatePlayedSkeleton&>(object))
            .poseBones();
        return PropByValSerializer::write(out, object);
    }
};

} // namespace

REGISTER_OSGSKIN_WRAPPER(osgSkin_UpdatePlayedSkeleton, new osgSkin::UpdatePlayedSkeleton,
                         osgSkin::UpdatePlayedSkeleton,
                         "osg::Object osg::Callback osg::NodeCallback "
                         "osgAnimation::UpdateSkeleton osgSkin::UpdatePlayedSkeleton") {
    wrapper->addSerializer(new BonesFollowSerializer, osgDB::BaseSerializer::RW_BOOL);
}

namespace osgSkin {
/// The names of nested classes in files.
using CullPlayedSkeleton = UpdatePlayedSkeleton::CullPlayedSkeleton;
using PlayedSkeletonBound = UpdatePlayedSkeleton::PlayedSkeletonBound;
} // namespace osgSkin

REGISTER_OSGSKIN_WRAPPER(osgSkin_CullPlayedSkeleton, new osgSkin::CullPlayedSkeleton,
                         osgSkin::CullPlayedSkeleton,
                         "osg::Object osg::Callback osg::NodeCallback "
                         "osgSkin::CullPlayedSkeleton") {}

REGISTER_OSGSKIN_WRAPPER(osgSkin_PlayedSkeletonBound, new osgSkin::PlayedSkeletonBound,
                         osgSkin::PlayedSkeletonBound,
                         "osg::Object osg::ComputeBoundingSphereCallback "
                         "osgSkin::PlayedSkeletonBound") {}
