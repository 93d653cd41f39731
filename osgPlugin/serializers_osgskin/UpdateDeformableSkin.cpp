// SPDX-License-Identifier: MIT
// Callbacks have virtual bases, for which the wrapper's default cast does not compile.
#undef OBJECT_CAST
#define OBJECT_CAST dynamic_cast

#include "RegisterWrapper.h"

#include <osgSkin/UpdateDeformableSkin>

#include <osgDB/InputStream>
#include <osgDB/OutputStream>

namespace {

/// Text files omit the value false, which used to be the default of the class. The default is now
/// true, so reading sets false if a file omits the value.
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

// The bones are not saved: they are found by name.
REGISTER_OSGSKIN_WRAPPER(osgSkin_UpdateDeformableSkin, new osgSkin::UpdateDeformableSkin,
                         osgSkin::UpdateDeformableSkin,
                         "osg::Object osg::Callback osgSkin::UpdateDeformableSkin") {
    wrapper->addSerializer(new UnwrapTwistSerializer, osgDB::BaseSerializer::RW_BOOL);
}
