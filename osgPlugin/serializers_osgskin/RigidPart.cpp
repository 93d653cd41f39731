// SPDX-License-Identifier: MIT
#include <osgSkin/RigidPart>

#include <osgDB/InputStream>
#include <osgDB/ObjectWrapper>
#include <osgDB/OutputStream>

// Its matrix and children are osg::MatrixTransform's.
REGISTER_OBJECT_WRAPPER(osgSkin_RigidPart, new osgSkin::RigidPart, osgSkin::RigidPart,
                        "osg::Object osg::Node osg::Group osg::Transform osg::MatrixTransform "
                        "osgSkin::RigidPart") {}
