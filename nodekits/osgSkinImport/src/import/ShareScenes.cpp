// SPDX-License-Identifier: MIT
#include <osgSkinImport/ShareScenes>

#include "assimp/AssimpScene.h"
#include "files/FileFormat.h"
#include "files/FileText.h"
#include "files/SharedByOptions.h"
#include "gltf/ReadGltf.h"
#include "import/ShareScenes.h"

#include <osgSkinImport/ReadLimits>

#include <osg/Object>

#include <filesystem>
#include <map>
#include <system_error>

namespace osgSkin {
namespace {

using Scene = std::shared_ptr<const SourceScene>;

/// The scenes that osgDB options share.
class SharedScenes : public osg::Object {
public:
    SharedScenes() = default;
    SharedScenes(const SharedScenes& other, const osg::CopyOp& copy)
        : osg::Object(other, copy), files(other.files) {}
    META_Object(osgSkin, SharedScenes)

    std::map<std::string, Scene> files; ///< by canonical path

protected:
    ~SharedScenes() override = default;
};

Scene readFile(const std::string& path, const ReadLimits& limits) {
    const FileFormat format = formatOf(path);
    // Asked for a file that it has no reader for, Assimp tries all of its readers, and some read
    // out of bounds.
    if (format.reader != FileFormat::Gltf && format.reader != FileFormat::Assimp)
        refuse(path, limits,
               format.extension.empty()
                   ? "the file's name has no extension, expected that of its format"
                   : inQuotes("." + format.extension) +
                         " files are not read as rigs or motions, expected .bvh, .fbx, .glb or "
                         "another that Assimp reads" +
                         adviceForCapture(format.extension));
    SourceScene scene =
        format.reader == FileFormat::Gltf ? readGltf(path, limits) : readAssimpScene(path, limits);
    separateNames(scene, path);
    dropCoarseLevels(scene, path);
    takeClipScales(scene);
    addMissingBones(scene, path);
    attachLooseJoints(scene, path, limits);
    bindFreeMeshes(scene, path);
    return std::make_shared<const SourceScene>(std::move(scene));
}

} // namespace

void refuse(const std::string& path, const ReadLimits& limits, const std::string& message) {
    requireReadable(path, limits);
    failFile(path, message);
}

Scene readSourceScene(const std::string& path, const osgDB::Options* options) {
    const ReadLimits limits = ReadLimits::of(options);
    SharedScenes* const shared = sharedBy<SharedScenes>(options);
    if (shared == nullptr) return readFile(path, limits);
    std::error_code failure;
    const std::string file = std::filesystem::weakly_canonical(path, failure).string();
    Scene& known = shared->files[failure ? path : file];
    if (known == nullptr) known = readFile(path, limits);
    return known;
}

osg::ref_ptr<osgDB::Options> shareScenes(const osgDB::Options* options) {
    return share<SharedScenes>(options);
}

} // namespace osgSkin
