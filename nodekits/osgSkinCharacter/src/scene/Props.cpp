// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/Props.h"

#include "report/NamingFile.h"

#include <osgSkinImport/ImportMotion>
#include <osgSkinRig/Motion>
#include <osgSkinRig/Prop>

namespace osgSkin {

void addProps(CharacterSource& source, const CharacterMotion& motion, osg::Group& parent,
              PropMeshes& meshes, const osgDB::Options* options) {
    for (std::size_t i = 0; i < source.props.size(); ++i) {
        const SkinFile::Prop& prop = source.props[i];
        if (prop.motion != motion.name()) continue;
        std::size_t skip = 0;
        for (const SkinFile::MotionEntry& entry : source.motions)
            if (entry.name == prop.motion) skip = entry.skipFrames;
        // Bones and props share one table of animation targets, so the name must not be a joint's.
        const std::string name = "prop:" + prop.motion + ":" + std::to_string(i);
        const ImportedMesh& mesh = meshes.of(prop.mesh);
        const Motion path = importMotion(prop.file, skip, {}, options);
        namingFile(prop.file, [&] {
            source.samples.add(prop.file, path.frames + skip, path.skeleton.joints.size(),
                               source.limits);
        });
        parent.addChild(makeProp(name, mesh.parts, path, motion.report, *motion.animation));
    }
}

} // namespace osgSkin
