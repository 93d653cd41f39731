// SPDX-License-Identifier: MIT
// A callback's bases are virtual: the wrapper's default cast does not compile for it.
#undef OBJECT_CAST
#define OBJECT_CAST dynamic_cast

#include "RegisterWrapper.h"

#include <osgSkin/UpdateDeformableSkin>

#include <osgDB/InputStream>
#include <osgDB/OutputStream>

namespace {

/// Text files leave out what is false, which was the default of the class when the first of them
/// were written. It is true now, so reading sets the value of a file that leaves it out.
class UnwrapTwistSerializer
    : public osgDB::PropByValSerializer<osgSkin::UpdateDeformableSkin, bool> {
public:
    UnwrapTwistSerializer()
        : PropByValSerializer("UnwrapTwist", false, &osgSkin::UpdateDeformableSkin::getUnwrapTwist,
                              &osgSkin::UpdateDeformableSkin::setUnwrapTwist) {}

    bool read(osgDB::InputStream& in, osg::Object& object) override {
        OBJECT_CAST<osgSkin::UpdateDeformableSkin&>(object).setUnwrapTwist(_defaultValue);
        return PropByValSerializer::read(in, object);
    }
};

} // namespace

// The bones are found again by their names.
REGISTER_OSGSKIN_WRAPPER(osgSkin_UpdateDeformableSkin, new osgSkin::UpdateDeformableSkin,
                         osgSkin::UpdateDeformableSkin,
                         "osg::Object osg::Callback osgSkin::UpdateDeformableSkin") {
    wrapper->addSerializer(new UnwrapTwistSerializer, osgDB::BaseSerializer::RW_BOOL);
}
