// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Geometry>
#include <osgAnimation/RigGeometry>

namespace test {

/// An osgAnimation rig: an upright quad, 1 wide and 2 high, without normals. Its vertices are, in
/// order, top, bottom, bottom and top.
inline osg::ref_ptr<osgAnimation::RigGeometry>
makeQuadRig(const osgAnimation::VertexInfluenceMap& influences) {
    const osg::ref_ptr<osg::Geometry> quad =
        osg::createTexturedQuadGeometry(osg::Vec3(), osg::Vec3(1, 0, 0), osg::Vec3(0, 0, 2));
    quad->setColorArray(nullptr);
    quad->setNormalArray(nullptr);
    osg::ref_ptr<osgAnimation::RigGeometry> rig = new osgAnimation::RigGeometry;
    rig->setSourceGeometry(quad);
    rig->setInfluenceMap(new osgAnimation::VertexInfluenceMap(influences));
    return rig;
}

} // namespace test
