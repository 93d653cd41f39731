// SPDX-License-Identifier: GPL-3.0-or-later
#include <osgSkinCharacter/LoadCharacter>

#include "load/BindSource.h"
#include "load/ConvertScene.h"
#include "load/OpenFile.h"
#include "load/RetargetMotions.h"
#include "load/RigidParts.h"
#include "options/LoadReport.h"
#include "scene/BuildScene.h"
#include "source/ReadRig.h"
#include "source/ReadSkinFile.h"

#include <osgSkinGpu/GpuSkin>
#include <osgSkinImport/FindNamedFile>
#include <osgSkinImport/ImportRig>

#include <osgDB/FileNameUtils>

#include <utility>

namespace osgSkin {
namespace {

/// What is the same for a `.skin` file and a rigged model: everything after their files are read.
Character makeCharacter(CharacterSource source, const LoadOptions& options, LoadStages& stages) {
    Character character;
    character.motions = retargetMotions(source, options.readOptions.get(), stages);
    setRigidParts(source, character.motions);
    const Progress binding = stages.begin("binding", source.bindingSize());
    character.binding = bindSource(source, binding, character.bindReport);
    animateMotions(source, character.binding, character.motions);
    stages.begin("scene", source.sceneSize());
    character.file = source.file;
    character.meshFile = source.meshFile;
    character.files = std::move(source.files);
    character.body = std::move(source.body);
    character.rest = std::move(source.rest);
    character.bindOptions = source.bind;
    character.fitReport = std::move(source.fitReport);
    character.toWorld = source.toWorld;
    character.notes = std::move(source.notes);
    namingFile(source.file, [&] { buildScene(source, options, character); });
    stages.finish();
    return character;
}

Character loadFrom(const std::string& path, const LoadOptions& options) {
    const std::string found = findNamedFile(path, options.readOptions.get());
    const std::string& file = found.empty() ? path : found;
    const OpenFile open(file);
    LoadStages stages(options.progress);
    if (osgDB::getLowerCaseFileExtension(path) == "skin") {
        const std::string model = osgDB::getNameLessExtension(path);
        if (found.empty() && !osgDB::getFileExtension(model).empty())
            return loadFrom(model, options);
        return makeCharacter(readSkinFile(file, options, stages), options, stages);
    }
    if (isReadByAssimp(file)) return makeCharacter(readRig(file, options, stages), options, stages);
    return convertScene(file, options, stages);
}

} // namespace

Character loadCharacter(const std::string& path, const LoadOptions& options) {
    Character character = loadFrom(path, options);
    if (options.gpu && character.root) setGpu(*character.root, true);
    return character;
}

} // namespace osgSkin
