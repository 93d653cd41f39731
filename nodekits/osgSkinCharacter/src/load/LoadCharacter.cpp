// SPDX-License-Identifier: MIT
#include <osgSkinCharacter/LoadCharacter>

#include "load/LoadSteps.h"
#include "scene/BuildScene.h"
#include "source/CharacterSource.h"
#include "source/LoadReport.h"

#include <osgSkin/Error>
#include <osgSkin/GlmOsg>
#include <osgSkinGpu/GpuSkin>
#include <osgSkinImport/FindNamedFile>
#include <osgSkinImport/ImportRig>
#include <osgSkinImport/ShareScenes>

#include <osg/BoundingBox>
#include <osgDB/FileNameUtils>

#include <algorithm>
#include <filesystem>
#include <iomanip>
#include <locale>
#include <new>
#include <sstream>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

namespace osgSkin {
namespace {

constexpr std::size_t kMaxNested = 8;

/// A canonical name for a file.
std::string canonicalName(const std::string& file) {
    std::error_code failure;
    const std::filesystem::path path = std::filesystem::weakly_canonical(file, failure);
    return failure ? file : path.string();
}

/// Marks a character's file as being loaded. OSG's readers may load further characters as its
/// parts; this detects files that include themselves or each other.
class OpenFile {
public:
    /// \throw Error where this thread is already loading the file, or parts are nested too deeply
    explicit OpenFile(const std::string& file) {
        const std::string name = canonicalName(file);
        if (std::find(_files.begin(), _files.end(), name) != _files.end())
            throw Error(file + ": includes itself" +
                        (_files.size() > 1 ? " (via " + _files.back() + ")" : ""));
        if (_files.size() >= kMaxNested)
            throw Error(file + ": characters nested more than " + std::to_string(kMaxNested) +
                        " deep");
        _files.push_back(name);
    }
    ~OpenFile() { _files.pop_back(); }
    OpenFile(const OpenFile&) = delete;
    OpenFile& operator=(const OpenFile&) = delete;

private:
    static thread_local std::vector<std::string> _files; ///< from the outermost to the innermost
};

thread_local std::vector<std::string> OpenFile::_files;

constexpr double kMinHeight = 0.25, kMaxHeight = 5.0; ///< metres, of a body without a known unit
constexpr double kStatedRoom = 2.0; ///< times as far may one be off whose file states its unit

/// The steps that `.skin` files and rigged models share: everything after reading their files.
Character makeCharacter(CharacterSource source, const LoadOptions& options, LoadStages& stages) {
    Character character;
    character.motions = retargetMotions(source, options.readOptions.get(), stages);
    setRigidParts(source, character.motions);
    const Progress binding = stages.begin("binding", source.bindingSize());
    character.binding = bindSource(source, binding, character.bindReport);
    warnFlatSkeleton(source, character.binding);
    animateMotions(source, character.binding, character.motions);
    stages.begin("scene", source.sceneSize());
    character.file = source.file;
    character.meshFile = source.meshFile;
    character.files = std::move(source.files);
    character.body = std::move(source.body);
    character.rest = std::move(source.rest);
    character.bindOptions = source.bind;
    character.fitReport = std::move(source.fitReport);
    const double metres = unitOf(source.statedUnit, source.options, source.meshFile, source.notes);
    character.toWorld = osg::Matrixd::scale(metres, metres, metres) * source.toWorld;
    character.notes = std::move(source.notes);
    withFileContext(source.file, [&] { buildScene(source, options, character); });
    if (!source.options.unit) checkSize(character, source.statedUnit > 0.0);
    stages.finish();
    return character;
}

/// The same options for one load, which reads each file once.
LoadOptions withSharedScenes(const LoadOptions& options) {
    LoadOptions result = options;
    result.readOptions = shareScenes(options.readOptions.get());
    return result;
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
        const LoadOptions own = withSharedScenes(options);
        return makeCharacter(readSkinFile(file, own, stages), own, stages);
    }
    if (hasImporter(file)) {
        const LoadOptions own = withSharedScenes(options);
        return makeCharacter(readRig(file, own, stages), own, stages);
    }
    return convertScene(file, options, stages);
}

} // namespace

void checkSize(Character& character, bool unitIsStated) {
    // A figure without known joints may be a mouse or a giraffe.
    const bool isFigure = character.roles.known();
    const double room = unitIsStated ? kStatedRoom : 1.0;
    const double least = isFigure ? kMinHeight / room : 0.0;
    const double most = (isFigure ? kMaxHeight : 2.0 * kMaxHeight) * room;
    osg::BoundingBoxd body, joints;
    for (const glm::dvec3& position : character.body.mesh.positions)
        body.expandBy(toOsg(position) * character.toWorld);
    for (const RestJoint& joint : character.rest.joints)
        joints.expandBy(toOsg(joint.centre) * character.toWorld);
    const double tall = body.zMax() - body.zMin();
    // Gloves alone are small, but not their wearer.
    if (std::max(tall, joints.zMax() - joints.zMin()) >= least && tall <= most) return;
    std::ostringstream note;
    note.imbue(std::locale::classic());
    note << character.file << ": the body is " << std::setprecision(3) << tall << " m tall"
         << (unitIsStated ? " by the unit that its file states (glTF: metres)"
                          : ", as the files state no unit and metres are assumed")
         << "; set \"unit\" if they have another";
    warn(character.notes, note.str());
}

Character loadCharacter(const std::string& path, const LoadOptions& options) try {
    Character character = loadFrom(path, options);
    if (options.gpu && character.root) setGpu(*character.root, true);
    return character;
} catch (const std::bad_alloc&) {
    throw Error(path + ": out of memory");
}

} // namespace osgSkin
