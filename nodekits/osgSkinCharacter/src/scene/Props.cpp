// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/Props.h"

#include "options/LoadReport.h"

#include <osgSkin/Error>
#include <osgSkin/GlmTypes>
#include <osgSkinImport/ImportMotion>
#include <osgSkinRig/Motion>
#include <osgSkinRig/Prop>

#include <glm/common.hpp>
#include <glm/gtc/quaternion.hpp>

#include <osg/Notify>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace osgSkin {
namespace {

/// The time that a motion skips, in seconds: a prop loses it too, and so goes on beside its motion.
double skippedTime(const CharacterSource& source, const CharacterMotion& motion,
                   const SkinFile::Prop& prop) {
    for (const SkinFile::MotionEntry& entry : source.motions)
        if (entry.name == prop.motion) return double(entry.skipFrames) * motion.clip.frameTime;
    return 0.0;
}

/// What is left of a prop's path after some time. Its samples may be taken at another rate than the
/// motion's, so that it begins between two of them. A prop that never moves has one, which stays.
Motion after(const Motion& path, double seconds, const std::string& file) {
    if (seconds == 0.0 || path.frames == 1) return path;
    const double first = seconds / path.frameTime, last = double(path.frames - 1);
    if (first > last + 1e-6)
        throw Error(file + ": expected samples after the " + std::to_string(seconds) +
                    " s that its motion skips, found " + std::to_string(last * path.frameTime) +
                    " s");
    Motion rest = path;
    rest.frames = 0;
    rest.rotations.clear();
    rest.rootPositions.clear();
    for (double at = first; at <= last + 1e-6; at += 1.0) {
        const double whole = std::min(std::floor(at + 1e-6), last);
        const double part = at - whole < 1e-6 ? 0.0 : at - whole;
        const std::size_t from = static_cast<std::size_t>(whole);
        const std::size_t to = std::min(from + 1, path.frames - 1);
        std::vector<glm::dquat> rotations;
        for (std::size_t j = 0; j < path.skeleton.joints.size(); ++j)
            rotations.push_back(
                part == 0.0 ? path.rotation(from, j)
                            : glm::slerp(path.rotation(from, j), path.rotation(to, j), part));
        rest.addFrame(glm::mix(path.rootPositions[from], path.rootPositions[to], part), rotations);
    }
    return rest;
}

} // namespace

void addProps(CharacterSource& source, const CharacterMotion& motion, osg::Group& parent,
              PropMeshes& meshes, const osgDB::Options* options) {
    for (std::size_t i = 0; i < source.props.size(); ++i) {
        const SkinFile::Prop& prop = source.props[i];
        if (prop.motion != motion.name()) continue;
        // Bones and props share one table of animation targets, so the name must not be a joint's.
        const std::string name = "prop:" + prop.motion + ":" + std::to_string(i);
        const ImportedMesh& mesh = meshes.of(prop.mesh);
        const Motion whole = importMotion(prop.file, 0, {}, options);
        const Motion path = after(whole, skippedTime(source, motion, prop), prop.file);
        if (path.skeleton.joints.size() > 1)
            OSG_NOTICE << onOneLine(prop.file + ": has " +
                                    std::to_string(path.skeleton.joints.size()) +
                                    " joints, of which a prop follows the first alone")
                       << std::endl;
        namingFile(prop.file, [&] {
            source.samples.add(prop.file, whole.frames, path.skeleton.joints.size(), source.limits);
        });
        parent.addChild(makeProp(name, mesh.parts, path, motion.report, *motion.animation));
    }
}

} // namespace osgSkin
