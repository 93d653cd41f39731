// SPDX-License-Identifier: MIT
#include "RegisterWrapper.h"

#include <osgSkin/RigidPart>

#include <osgDB/InputStream>
#include <osgDB/OutputStream>

// osg::MatrixTransform saves the matrix and the children.
REGISTER_OSGSKIN_WRAPPER(osgSkin_RigidPart, new osgSkin::RigidPart, osgSkin::RigidPart,
                         "osg::Object osg::Node osg::Group osg::Transform osg::MatrixTransform "
                         "osgSkin::RigidPart") {}
