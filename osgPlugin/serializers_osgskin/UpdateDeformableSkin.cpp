// SPDX-License-Identifier: MIT
// A callback's bases are virtual: the wrapper's default cast does not compile for it.
#undef OBJECT_CAST
#define OBJECT_CAST dynamic_cast

#include "RegisterWrapper.h"

#include <osgSkin/UpdateDeformableSkin>

#include <osgDB/InputStream>
#include <osgDB/OutputStream>

// The bones are found again by their names.
REGISTER_OSGSKIN_WRAPPER(osgSkin_UpdateDeformableSkin, new osgSkin::UpdateDeformableSkin,
                         osgSkin::UpdateDeformableSkin,
                         "osg::Object osg::Callback osgSkin::UpdateDeformableSkin") {
    ADD_BOOL_SERIALIZER(UnwrapTwist, false);
}
