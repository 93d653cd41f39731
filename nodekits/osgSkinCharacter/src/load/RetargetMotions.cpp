// SPDX-License-Identifier: GPL-3.0-or-later
#include "load/RetargetMotions.h"

#include "options/LoadReport.h"

#include <osgSkinImport/ImportMotion>
#include <osgSkinRig/JointRoles>
#include <osgSkinRig/MakeAnimation>
#include <osgSkinRig/Retarget>

#include <algorithm>

namespace osgSkin {
namespace {

/// A clip has a rotation of every joint of the rig in every frame, whatever the motion has.
void checkSize(CharacterSource& source, const SkinFile::MotionEntry& entry, const Motion& motion) {
    const std::size_t joints = std::max(source.rest.joints.size(), motion.skeleton.joints.size());
    source.samples.add(entry.file, motion.frames + entry.skipFrames, joints, source.limits);
}

} // namespace

std::vector<CharacterMotion>
retargetMotions(CharacterSource& source, const osgDB::Options* readOptions, LoadStages& stages) {
    std::vector<CharacterMotion> motions;
    for (const SkinFile::MotionEntry& entry : source.motions) {
        stages.begin("motion " + entry.name, LoadStages::kMotion);
        CharacterMotion& made = motions.emplace_back();
        namingFile(entry.file, [&] {
            Motion motion = importMotion(entry.file, entry.skipFrames, entry.clip, readOptions);
            checkSize(source, entry, motion);
            motion.name = entry.name;
            RetargetOptions options;
            options.joints = entry.joints;
            options.names = source.bind.names;
            made.clip = retarget(motion, source.rest, options, &made.report);
        });
        OSG_INFO << entry.file << ":\n" << made.report.text();
        for (const std::string& note : made.report.notes)
            takeNote(source.notes, entry.file + ": " + note);
    }
    return motions;
}

void animateMotions(const CharacterSource& source, const Binding& binding,
                    std::vector<CharacterMotion>& motions) {
    const bool clears = source.options.clearHands.value_or(false);
    for (std::size_t m = 0; m < motions.size(); ++m) {
        CharacterMotion& motion = motions[m];
        const std::string& file = source.motions[m].file;
        namingFile(file, [&] {
            if (clears)
                motion.cleared = clearHands(motion.clip, source.rest,
                                            recogniseJoints(source.rest, source.bind.names),
                                            source.body.mesh, binding);
            motion.animation = makeAnimation(motion.clip, source.rest);
        });
        if (clears) OSG_INFO << file << ": " << motion.cleared.text() << "\n";
    }
}

} // namespace osgSkin
