// SPDX-License-Identifier: GPL-3.0-or-later
#include "load/Props.h"

#include <osgSkinImport/ImportMotion>
#include <osgSkinRig/Motion>
#include <osgSkinRig/Prop>

namespace osgSkin {
void addProps(const SkinFile& file, const Character::Motion& motion, osg::Group& parent,
              osgAnimation::Animation& animation, const osgDB::Options* options) {
    for (std::size_t i = 0; i < file.props.size(); ++i) {
        const SkinFile::Prop& prop = file.props[i];
        if (prop.motion != motion.clip.name) continue;
        std::size_t skip = 0;
        for (const SkinFile::Motion& entry : file.motions)
            if (entry.name == prop.motion) skip = entry.skipFrames;
        // Bones and props share one table of animation targets, so the name must not be a joint's.
        const std::string name = "prop:" + prop.motion + ":" + std::to_string(i);
        const ImportedMesh mesh = importMesh(prop.mesh, options);
        const osgSkin::Motion way = importMotion(prop.file, skip);
        parent.addChild(makeProp(name, mesh.parts, way, motion.report, animation));
    }
}

} // namespace osgSkin
