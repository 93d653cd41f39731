// SPDX-License-Identifier: MIT
#include <osgSkinImport/ReadScene>

#include "files/FileFormat.h"
#include "files/FileText.h"
#include "mesh/FinishMesh.h"
#include "mesh/Images.h"
#include "mesh/MeshFiles.h"
#include "osg/CheckScene.h"

#include <osgSkin/Error>
#include <osgSkinImport/FindNamedFile>
#include <osgSkinImport/ReadLimits>

#include <osg/MatrixTransform>
#include <osg/Node>
#include <osg/ref_ptr>
#include <osgDB/Callbacks>
#include <osgDB/FileNameUtils>
#include <osgDB/FileUtils>
#include <osgDB/Options>
#include <osgDB/Registry>

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>

namespace osgSkin {

namespace {

bool isRotated(const osgDB::Options* options) {
    if (options == nullptr) return true;
    const auto words = optionValues(options->getOptionString());
    return std::none_of(words.begin(), words.end(),
                        [](const auto& word) { return word.first == "noRotation"; });
}

/// Reads an OBJ or PLY mesh like OSG's readers: OBJ with Y up unless the options contain
/// `noRotation`. Refuses the library's other formats, which are not scenes.
osg::ref_ptr<osg::Node> readMeshScene(const std::string& path, const osgDB::Options* options) {
    const FileFormat::Reader reader = formatOf(path).reader;
    const bool isObj = reader == FileFormat::Obj;
    if (!isObj && reader != FileFormat::Ply)
        failFile(path, "not a scene format; use .osgt, .osgb, .osgx, .obj, .ply or .skin");
    CornerMesh read = isObj ? readObjMesh(path, options) : readPlyMesh(path, options);
    checkMaterials(read, path, ReadLimits::of(options));
    const ImportedMesh mesh = finishMesh(std::move(read), path, ReadLimits::of(options));
    const osg::ref_ptr<osg::MatrixTransform> scene = new osg::MatrixTransform;
    if (isObj && isRotated(options))
        scene->setMatrix(osg::Matrix(1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1));
    for (const MeshPart& part : mesh.parts) scene->addChild(part.geometry);
    return scene;
}

/// The maximum number of nested reads: names of pseudo-loaders contain other names, and each takes
/// stack space.
constexpr std::size_t kMaxNestedReads = 16;

class Deeper {
public:
    explicit Deeper(std::size_t& depth) : _depth(depth) { ++_depth; }
    ~Deeper() { --_depth; }
    Deeper(const Deeper&) = delete;
    Deeper& operator=(const Deeper&) = delete;

private:
    std::size_t& _depth;
};

/// Guards OSG's readers for one file and all files that it names, scenes and images alike. Opens
/// regular files only, checks scenes after reading them, and never lets OSG read formats that this
/// library has a reader for, even inside a pseudo-loader's name. Passes other files, by the path of
/// the checked file, to the application's callback, or else to OSG.
class GuardedReads : public osgDB::ReadFileCallback {
public:
    using Result = osgDB::ReaderWriter::ReadResult;

    /// \param options of the application; may be null
    explicit GuardedReads(const osgDB::Options* options)
        : _limits(ReadLimits::of(options)), _imageReader(options) {
        if (options != nullptr) _next = options->getReadFileCallback();
        if (!_next) _next = osgDB::Registry::instance()->getReadFileCallback();
        _isOsgNext = !_next;
        if (!_next) _next = new osgDB::ReadFileCallback;
    }

    /// Why the first refused file was refused, because a reader in between may drop the reason;
    /// empty if none was.
    const std::string& reason() const { return _reason; }

    Result openArchive(const std::string& name, osgDB::ReaderWriter::ArchiveStatus, unsigned,
                       const osgDB::Options*) override {
        return guarded(name, [&]() -> Result { failFile(name, "archives are not read"); });
    }

    Result readNode(const std::string& name, const osgDB::Options* options) override {
        return readModel(name, options,
                         [&](const std::string& file) { return _next->readNode(file, options); });
    }

    Result readObject(const std::string& name, const osgDB::Options* options) override {
        return readModel(name, options,
                         [&](const std::string& file) { return _next->readObject(file, options); });
    }

    Result readImage(const std::string& name, const osgDB::Options* options) override {
        return readOther(name, options, [&](const std::string& file) {
            if (!isRegularFile(file)) return _next->readImage(file, options);
            Result result;
            const osg::ref_ptr<osg::Image> image = _imageReader.shared().once(file, {}, [&] {
                const osg::ref_ptr<osg::Image> read =
                    _imageReader.readFile(file, [&]() -> osg::ref_ptr<osg::Image> {
                        result = _next->readImage(file, options);
                        return result.getImage();
                    });
                if (read.valid()) read->setFileName(name); // for writers
                return read;
            });
            return image ? Result(image.get()) : result;
        });
    }

    Result readHeightField(const std::string& name, const osgDB::Options* options) override {
        return readOther(name, options, [&](const std::string& file) {
            return _next->readHeightField(file, options);
        });
    }

    Result readShader(const std::string& name, const osgDB::Options* options) override {
        return readOther(name, options,
                         [&](const std::string& file) { return _next->readShader(file, options); });
    }

    Result readScript(const std::string& name, const osgDB::Options* options) override {
        return readOther(name, options,
                         [&](const std::string& file) { return _next->readScript(file, options); });
    }

private:
    template <typename Read>
    Result guarded(const std::string& name, Read read) {
        const Deeper deeper(_depth);
        try {
            if (osgDB::containsServerAddress(name))
                failFile(name, "cannot open: network addresses are not read");
            requireOnlyRead(name);
            if (_depth > kMaxNestedReads)
                failFile(name, "files and pseudo-loaders are nested more than " +
                                   std::to_string(kMaxNestedReads) + " deep");
            return read();
        } catch (const Error& error) {
            if (_reason.empty()) _reason = error.what();
            return Result(error.what());
        }
    }

    template <typename Read>
    Result readModel(const std::string& name, const osgDB::Options* options, Read next) {
        return guarded(name, [&] {
            _limits.checkFormat(name);
            const std::string found = findNamedFile(name, options);
            if (found.empty()) {
                // OSG might find a different file in another folder.
                const bool isKnown = !_isOsgNext || isPseudoLoader(name);
                if (!isKnown || !osgDB::findDataFile(name, options).empty())
                    requireReadable(name, _limits);
                return next(name);
            }
            requireReadable(found, _limits);
            if (formatOf(found).hasOwnReader()) return Result(readMeshScene(found, options).get());
            Result result = next(found);
            if (!osgSceneFormat(found).empty() && result.getNode() != nullptr)
                checkScene(*result.getNode(), found);
            return result;
        });
    }

    template <typename Read>
    Result readOther(const std::string& name, const osgDB::Options* options, Read next) {
        return guarded(name, [&] {
            const std::string found = osgDB::findDataFile(name, options);
            if (found.empty()) return _isOsgNext ? Result(Result::FILE_NOT_FOUND) : next(name);
            requireReadable(found, _limits);
            return next(found);
        });
    }

    const ReadLimits _limits;
    ImageReader _imageReader;
    osg::ref_ptr<osgDB::ReadFileCallback> _next;
    bool _isOsgNext = false; ///< no application callback, which may accept other names
    std::string _reason;
    std::size_t _depth = 0; ///< number of nested reads
};

} // namespace

osg::ref_ptr<osg::Node> readScene(const std::string& path, const osgDB::Options* options) {
    const osg::ref_ptr<GuardedReads> guard = new GuardedReads(options);
    const osg::ref_ptr<osgDB::Options> guarded =
        options != nullptr ? options->cloneOptions() : new osgDB::Options;
    guarded->setReadFileCallback(guard.get());
    osgDB::ReaderWriter::ReadResult read =
        osgDB::Registry::instance()->readNode(path, guarded.get());
    const osg::ref_ptr<osg::Node> node = read.getNode();
    if (node) return node;
    if (!guard->reason().empty()) throw Error(guard->reason());
    const std::string& reason = read.message();
    // A pseudo-loader's name is not a file, and has its own reason.
    if (reason.empty() || read.notFound()) requireReadable(path, ReadLimits::of(options));
    const std::string extension = osgDB::getLowerCaseFileExtension(path);
    if (reason.empty() || reason.rfind("Could not find plugin", 0) == 0)
        failFile(path, "neither this build of Assimp nor OpenSceneGraph reads ." + extension +
                           " files; expected glTF, FBX or another format that they read" +
                           adviceForCapture(extension));
    failFile(path, reason);
}

} // namespace osgSkin
