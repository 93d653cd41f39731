// SPDX-License-Identifier: MIT
// Callbacks have virtual bases, for which the wrapper's default cast does not compile.
#undef OBJECT_CAST
#define OBJECT_CAST dynamic_cast

#include "RegisterWrapper.h"

#include <osgSkin/UpdateDeformableSkin>

#include <osgDB/InputStream>
#include <osgDB/OutputStream>

// The bones are not saved: they are found by name.
REGISTER_OSGSKIN_WRAPPER(osgSkin_UpdateDeformableSkin, new osgSkin::UpdateDeformableSkin,
                         osgSkin::UpdateDeformableSkin,
                         "osg::Object osg::Callback osgSkin::UpdateDeformableSkin") {
    ADD_BOOL_SERIALIZER(UnwrapTwist, true);
}
