// SPDX-License-Identifier: MIT
#include "RegisterWrapper.h"

#include <osgSkin/RigidPart>
#include <osgSkin/ShareEqualData>

#include <osgDB/InputStream>
#include <osgDB/OutputStream>

#include <osg/Geometry>

namespace {

/// Loads of one file share the arrays of its rigid parts.
class ShareArrays : public osgDB::FinishedObjectReadCallback {
public:
    void objectRead(osgDB::InputStream&, osg::Object& object) override {
        auto& part = static_cast<osgSkin::RigidPart&>(object);
        for (unsigned int i = 0; i < part.getNumChildren(); ++i)
            if (osg::Geometry* geometry = part.getChild(i)->asGeometry())
                osgSkin::shareEqualArrays(*geometry);
    }
};

} // namespace

// osg::MatrixTransform saves the matrix and the children.
REGISTER_OSGSKIN_WRAPPER(osgSkin_RigidPart, new osgSkin::RigidPart, osgSkin::RigidPart,
                         "osg::Object osg::Node osg::Group osg::Transform osg::MatrixTransform "
                         "osgSkin::RigidPart") {
    wrapper->addFinishedObjectReadCallback(new ShareArrays);
}
