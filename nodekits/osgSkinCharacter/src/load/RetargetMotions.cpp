// SPDX-License-Identifier: GPL-3.0-or-later
#include "load/RetargetMotions.h"

#include "report/NamingFile.h"
#include "report/TakeNote.h"

#include <osgSkinImport/ImportMotion>
#include <osgSkinRig/MakeAnimation>
#include <osgSkinRig/Retarget>

namespace osgSkin {

std::vector<CharacterMotion> retargetMotions(CharacterSource& source, LoadStages& stages) {
    std::vector<CharacterMotion> motions;
    for (const SkinFile::MotionEntry& entry : source.motions) {
        stages.begin("motion " + entry.name, LoadStages::kMotion);
        CharacterMotion& made = motions.emplace_back();
        namingFile(entry.file, [&] {
            Motion motion = importMotion(entry.file, entry.skipFrames, entry.clip);
            motion.name = entry.name;
            RetargetOptions options;
            options.joints = entry.joints;
            options.names = source.bind.names;
            made.clip = retarget(motion, source.rest, options, &made.report);
            made.animation = makeAnimation(made.clip, source.rest);
        });
        OSG_INFO << entry.file << ":\n" << made.report.text();
        for (const std::string& note : made.report.notes)
            takeNote(source.notes, entry.file + ": " + note);
    }
    return motions;
}

} // namespace osgSkin
