// SPDX-License-Identifier: GPL-3.0-or-later
#include "source/ReadRig.h"

#include "source/ApplyOptions.h"

#include <osgSkinImport/ImportRig>

#include <osgDB/FileUtils>

#include <utility>

namespace osgSkin {

CharacterSource readRig(const std::string& file, const LoadOptions& options, LoadStages& stages) {
    const osgDB::Options* read = options.readOptions.get();
    const bool retargets = options.motion && !osgDB::findDataFile(*options.motion, read).empty();
    stages.plan(LoadStages::kModel + LoadStages::kBinding +
                (retargets ? LoadStages::kMotion : 0.0) + LoadStages::kScene);
    stages.begin("model", LoadStages::kModel);
    ImportedRig rig = importRig(file, read);
    CharacterSource source;
    source.file = source.meshFile = file;
    source.body = std::move(rig.body);
    source.rest = std::move(rig.rest);
    source.toWorld = rig.toWorld;
    source.painted = CharacterSource::Painted::WhereGood;
    source.skeleton = rig.skeleton;
    source.animations = rig.animations;
    applyOptions(source, options);
    return source;
}

} // namespace osgSkin
