// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkinGpu/GpuCrowd>

#include <osg/Group>

#include <vector>

namespace recipes {

/// Adds a crowd of a loaded character to a scene: a thousand members that walk, run and jump.
/// osgSkinGpu's README shows the lines between the marks, and a test runs them.
///
/// \param loaded with clips of these names
/// \return call its setTime() in each update
inline osg::ref_ptr<osgSkin::GpuCrowd> makeCrowd(osg::Node& loaded, osg::Group& scene) {
    // [readme]
    const auto character = osgSkin::CrowdCharacter::create(loaded);
    const osg::ref_ptr<osgSkin::GpuCrowd> crowd = new osgSkin::GpuCrowd(character);
    std::vector<osgSkin::CrowdInstance> members(1000);
    for (std::size_t i = 0; i < members.size(); ++i) {
        members[i].position = osg::Vec3d(double(i % 32), double(i / 32), 0.0);
        members[i].clip = character->clip(i % 3 == 0 ? "walk" : i % 3 == 1 ? "run" : "jump");
        members[i].phase = 0.1 * double(i);
    }
    crowd->setInstances(members);
    scene.addChild(crowd);
    // [readme]
    return crowd;
}

} // namespace recipes
