// SPDX-License-Identifier: GPL-3.0-or-later
#include "source/CharacterSource.h"

#include "options/SkinFile.h"
#include "source/ApplyOptions.h"
#include "source/LoadReport.h"

#include <osgSkinImport/ImportSkeleton>
#include <osgSkinImport/ShareImages>

#include <osg/Math>

namespace osgSkin {
namespace {

/// OSG's world has Z up; most characters' files have Y up and face +Z, so they come to face -Y,
/// towards osgviewer's camera.
osg::Matrixd toWorldOf(const SkinFile& file) {
    return file.up == RetargetOptions::Up::Z ? osg::Matrixd()
                                             : osg::Matrixd::rotate(osg::PI_2, osg::Vec3d(1, 0, 0));
}

void fitRest(CharacterSource& source, FitOptions fit, const Progress& progress) {
    fit.progress = progress;
    source.rest = withFileContext(
        source.meshFile, [&] { return fitSkeleton(source.body.mesh, fit, &source.fitReport); });
    OSG_INFO << source.file << ":\n" << source.fitReport.text();
    for (const std::string& note : source.fitReport.notes)
        warn(source.notes, source.file + ": fitted skeleton: " + note);
}

/// Reads the skeleton that a `.skin` file names, or the mesh file's own.
RestSkeleton namedSkeleton(const SkinFile& skin, const osgDB::Options* options) {
    try {
        return importSkeleton(skin.skeleton, options);
    } catch (const Error& error) {
        if (skin.skeleton != skin.mesh) throw;
        throw Error(std::string(error.what()) +
                    "; set \"skeleton\" to a file, or to { \"fit\": true } to fit one to the body");
    }
}

std::vector<std::string> filesOf(const SkinFile& skin, const CharacterSource& source) {
    std::vector<std::string> files{skin.file, skin.mesh};
    for (const std::string& file : {skin.skeleton, source.weightsFile})
        if (!file.empty()) files.push_back(file);
    for (const SkinFile::MotionEntry& motion : source.motions) files.push_back(motion.file);
    for (const SkinFile::Prop& prop : source.props)
        files.insert(files.end(), {prop.mesh, prop.file});
    return files;
}

} // namespace

CharacterSource readSkinFile(const std::string& file, const LoadOptions& options,
                             LoadStages& stages) {
    const ReadLimits limits = ReadLimits::of(options.readOptions.get());
    const SkinFile skin = SkinFile::read(file, limits);
    CharacterSource source;
    source.limits = limits;
    source.file = file;
    source.meshFile = skin.mesh;
    source.toWorld = toWorldOf(skin);
    source.bind = skin.bind;
    source.options = skin.options;
    source.weightsFile = skin.weights;
    source.motions = skin.motions;
    source.yIsUp = skin.up == RetargetOptions::Up::Y;
    source.props = skin.props;
    source.meshOptions = shareImages(options.readOptions.get());
    applyOptions(source, options);
    source.files = filesOf(skin, source);

    stages.begin("mesh", LoadStages::kMesh);
    source.body =
        withFileContext(file, [&] { return importMesh(skin.mesh, source.meshOptions.get()); });
    if (source.painted == CharacterSource::Painted::WhereGood && source.body.weights.empty())
        source.painted = CharacterSource::Painted::No;
    stages.plan(LoadStages::kMesh + (skin.fit ? LoadStages::kFit : LoadStages::kSkeleton) +
                source.laterSize());
    if (skin.fit) {
        fitRest(source, *skin.fit, stages.begin("skeleton", LoadStages::kFit));
    } else {
        stages.begin("skeleton", LoadStages::kSkeleton);
        source.rest =
            withFileContext(file, [&] { return namedSkeleton(skin, options.readOptions.get()); });
    }
    const osgDB::Options* read = options.readOptions.get();
    source.statedUnit = importUnit(skin.mesh, read);
    if (source.statedUnit == 0.0 && !skin.fit) source.statedUnit = importUnit(skin.skeleton, read);
    return source;
}

} // namespace osgSkin
