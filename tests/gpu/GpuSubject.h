// SPDX-License-Identifier: MIT
#pragma once

#include "GpuStage.h"

#include <osg/Group>

#include <string>
#include <vector>

namespace test {

/// A scene with skins that move with the simulation time.
struct GpuSubject {
    /// \param name tube (random rotations, correctives, tangents, moved and scaled joints), small
    /// or large (the same, 1e-4 and 1e4 times the size), morphs (the tube with morph targets),
    /// thrower, climber (the thrower's body in a
    /// motion recorded on another body), body (MakeHuman's with shapes, in the same motion),
    /// painted (a rig with painted weights), or a file
    explicit GpuSubject(const std::string& name);

    double timeOf(int pose) const { return seconds * pose / poses; }

    std::string reason; ///< why the subject is unavailable
    osg::ref_ptr<osg::Group> scene = new osg::Group;
    std::vector<osg::ref_ptr<osgSkin::DeformableSkin>> skins;
    int poses = 4;        ///< OSGSKIN_GPU_POSES
    double seconds = 1.6; ///< over which the poses are spread; OSGSKIN_GPU_SECONDS
};

/// The skins below a node.
std::vector<osg::ref_ptr<osgSkin::DeformableSkin>> skinsIn(osg::Node& scene);

/// The largest differences of vertices.
struct Difference {
    double positions = 0.0;     ///< of the extent of the posed skin
    double normals = 0.0;       ///< radians
    double tangents = 0.0;      ///< the same; and of the handedness
    double computedError = 0.0; ///< of the shaders' normals, from the reference, radians
    double deformedError = 0.0; ///< of the CPU's normals, the same

    void take(const Difference& other);
};

/// Differences between the shaders' results and the CPU's.
Difference difference(const osgSkin::DeformableSkin& skin, const GpuStage::Posed& computed);

} // namespace test
