// SPDX-License-Identifier: GPL-3.0-or-later
#include "load/RetargetMotions.h"

#include "report/NamingFile.h"
#include "report/TakeNote.h"

#include <osgSkin/Error>
#include <osgSkinImport/ImportMotion>
#include <osgSkinRig/JointRoles>
#include <osgSkinRig/MakeAnimation>
#include <osgSkinRig/Retarget>

#include <filesystem>

namespace osgSkin {
namespace {

/// A clip has a rotation of every joint of the rig in every frame, whatever the motion has.
void checkSize(const std::string& file, std::size_t frames, const CharacterSource& source) {
    std::error_code failure;
    const auto bytes = static_cast<std::size_t>(std::filesystem::file_size(file, failure));
    const std::size_t joints = source.rest.joints.size();
    const std::size_t most = source.limits.samplesOf(failure ? 0 : bytes);
    if (frames > most / joints)
        throw Error(std::to_string(frames) + " frames for " + std::to_string(joints) +
                    " joints, expected at most " + std::to_string(most) +
                    " rotations (option maxSamples)");
}

} // namespace

std::vector<CharacterMotion> retargetMotions(CharacterSource& source, const Binding& binding,
                                             const osgDB::Options* readOptions,
                                             LoadStages& stages) {
    std::vector<CharacterMotion> motions;
    for (const SkinFile::MotionEntry& entry : source.motions) {
        stages.begin("motion " + entry.name, LoadStages::kMotion);
        CharacterMotion& made = motions.emplace_back();
        namingFile(entry.file, [&] {
            Motion motion = importMotion(entry.file, entry.skipFrames, entry.clip, readOptions);
            checkSize(entry.file, motion.frames, source);
            motion.name = entry.name;
            RetargetOptions options;
            options.joints = entry.joints;
            options.names = source.bind.names;
            made.clip = retarget(motion, source.rest, options, &made.report);
            if (source.clearHands)
                made.cleared = clearHands(made.clip, source.rest,
                                          recogniseJoints(source.rest, source.bind.names),
                                          source.body.mesh, binding);
            made.animation = makeAnimation(made.clip, source.rest);
        });
        OSG_INFO << entry.file << ":\n" << made.report.text();
        if (source.clearHands) OSG_INFO << entry.file << ": " << made.cleared.text() << "\n";
        for (const std::string& note : made.report.notes)
            takeNote(source.notes, entry.file + ": " + note);
    }
    return motions;
}

} // namespace osgSkin
