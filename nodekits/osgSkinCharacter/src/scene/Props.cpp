// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/Props.h"

#include "report/NamingFile.h"

#include <osgSkin/Error>
#include <osgSkinImport/ImportMotion>
#include <osgSkinRig/Motion>
#include <osgSkinRig/Prop>

#include <osg/Notify>

#include <cmath>
#include <string>

namespace osgSkin {
namespace {

/// How many of its samples a prop loses, so that it goes on beside its motion: the motion's may be
/// taken at another rate.
std::size_t skippedOf(const CharacterSource& source, const CharacterMotion& motion,
                      const SkinFile::Prop& prop, const osgDB::Options* options) {
    std::size_t skip = 0;
    for (const SkinFile::MotionEntry& entry : source.motions)
        if (entry.name == prop.motion) skip = entry.skipFrames;
    if (skip == 0) return 0;
    const double rate = motion.clip.frameTime / importMotion(prop.file, 0, {}, options).frameTime;
    return static_cast<std::size_t>(std::llround(double(skip) * rate));
}

} // namespace

void addProps(CharacterSource& source, const CharacterMotion& motion, osg::Group& parent,
              PropMeshes& meshes, const osgDB::Options* options) {
    for (std::size_t i = 0; i < source.props.size(); ++i) {
        const SkinFile::Prop& prop = source.props[i];
        if (prop.motion != motion.name()) continue;
        const std::size_t skip = skippedOf(source, motion, prop, options);
        // Bones and props share one table of animation targets, so the name must not be a joint's.
        const std::string name = "prop:" + prop.motion + ":" + std::to_string(i);
        const ImportedMesh& mesh = meshes.of(prop.mesh);
        const Motion path = importMotion(prop.file, skip, {}, options);
        if (path.skeleton.joints.size() > 1)
            OSG_NOTICE << onOneLine(prop.file + ": has " +
                                    std::to_string(path.skeleton.joints.size()) +
                                    " joints, of which a prop follows the first alone")
                       << std::endl;
        namingFile(prop.file, [&] {
            source.samples.add(prop.file, path.frames + skip, path.skeleton.joints.size(),
                               source.limits);
        });
        parent.addChild(makeProp(name, mesh.parts, path, motion.report, *motion.animation));
    }
}

} // namespace osgSkin
