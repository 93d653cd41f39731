// SPDX-License-Identifier: MIT
#include "source/CharacterSource.h"

#include "source/ApplyOptions.h"

#include <osgSkinImport/ImportConstraints>
#include <osgSkinImport/ImportRig>
#include <osgSkinImport/ImportSprings>

#include <utility>

namespace osgSkin {

CharacterSource readRig(const std::string& file, const LoadOptions& options, LoadStages& stages) {
    stages.begin("model", LoadStages::kModel);
    ImportedRig rig = importRig(file, options.readOptions.get());
    CharacterSource source;
    source.limits = ReadLimits::of(options.readOptions.get());
    source.file = source.meshFile = file;
    source.body = std::move(rig.body);
    source.rest = std::move(rig.rest);
    source.springs = importSprings(file, options.readOptions.get());
    source.constraints = importConstraints(file, options.readOptions.get());
    source.toWorld = rig.toWorld;
    source.statedUnit = rig.metresPerUnit;
    source.skeleton = rig.skeleton;
    source.animations = rig.animations;
    applyOptions(source, options);
    source.files = {file};
    for (const SkinFile::MotionEntry& motion : source.motions) source.files.push_back(motion.file);
    stages.plan(LoadStages::kModel + source.laterSize());
    return source;
}

} // namespace osgSkin
