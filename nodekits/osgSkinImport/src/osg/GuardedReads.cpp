// SPDX-License-Identifier: MIT
#include "osg/GuardedReads.h"

#include "osg/MeshScene.h"
#include "saved/ReadSaved.h"
#include "text/FileText.h"
#include "text/SafeNames.h"

#include <osgSkin/Error>
#include <osgSkinImport/FindNamedFile>

#include <osgDB/FileNameUtils>
#include <osgDB/FileUtils>
#include <osgDB/Registry>

#include <algorithm>
#include <iterator>

namespace osgSkin {
namespace {

constexpr std::size_t kDeepestFile = 8;
/// Pseudo-loaders' names hold others: each takes a part of the stack.
constexpr std::size_t kDeepestRead = 16;

/// Whether a name may be none of a file, but hold one, which its reader asks us for.
bool isPseudoLoader(const std::string& name) {
    static const char* const all[] = {"gles",  "osgjs", "osgshadow", "rot",
                                      "scale", "skin",  "trans"};
    const std::string extension = osgDB::getLowerCaseFileExtension(name);
    return std::find(std::begin(all), std::end(all), extension) != std::end(all);
}

class Deeper {
public:
    explicit Deeper(std::size_t& depth) : _depth(depth) { ++_depth; }
    ~Deeper() { --_depth; }
    Deeper(const Deeper&) = delete;
    Deeper& operator=(const Deeper&) = delete;

private:
    std::size_t& _depth;
};

} // namespace

GuardedReads::GuardedReads(const osgDB::Options* options)
    : _limits(ReadLimits::of(options)), _pictures(options) {
    if (options != nullptr) _next = options->getReadFileCallback();
    if (!_next) _next = osgDB::Registry::instance()->getReadFileCallback();
    _isOsgNext = !_next;
    if (!_next) _next = new osgDB::ReadFileCallback;
}

template <typename Read>
GuardedReads::Result GuardedReads::guarded(const std::string& name, Read read) {
    const Deeper deeper(_depth);
    try {
        if (osgDB::containsServerAddress(name))
            failFile(name, "cannot open: an address, expected a file");
        requireOnlyRead(name);
        if (_depth > kDeepestRead)
            failFile(name, "read for more than " + std::to_string(kDeepestRead) +
                               " others, expected fewer files and pseudo-loaders in each other");
        return read();
    } catch (const Error& error) {
        if (_reason.empty()) _reason = error.what();
        return Result(error.what());
    }
}

GuardedReads::Result GuardedReads::readSavedFile(const std::string& found,
                                                 const osgDB::Options* options) {
    if (std::find(_open.begin(), _open.end(), found) != _open.end() || _open.size() >= kDeepestFile)
        failFile(found, "is a part of itself, or of more than " + std::to_string(kDeepestFile) +
                            " other files");
    _open.push_back(found);
    try {
        const osg::ref_ptr<osg::Node> node = readSaved(found, options);
        _open.pop_back();
        return Result(node.get());
    } catch (const Error&) {
        _open.pop_back();
        throw;
    }
}

template <typename Read>
GuardedReads::Result GuardedReads::readModel(const std::string& name, const osgDB::Options* options,
                                             Read next) {
    return guarded(name, [&] {
        _limits.checkFormat(name);
        const std::string found = findNamedFile(name, options);
        if (found.empty()) {
            // OSG might take a file in another folder, which would be the wrong one.
            const bool isKnown = !_isOsgNext || isPseudoLoader(name);
            if (!isKnown || !osgDB::findDataFile(name, options).empty())
                requireReadable(name, _limits);
            return next(name);
        }
        requireReadable(found, _limits);
        if (isSaved(found)) return readSavedFile(found, options);
        return isOurFormat(found) ? Result(readMeshScene(found, options).get()) : next(found);
    });
}

template <typename Read>
GuardedReads::Result GuardedReads::readOther(const std::string& name, const osgDB::Options* options,
                                             const char* expected, Read next) {
    return guarded(name, [&] {
        if (isSaved(name)) failFile(name, std::string("a saved scene, expected ") + expected);
        const std::string found = osgDB::findDataFile(name, options);
        if (found.empty()) return _isOsgNext ? Result(Result::FILE_NOT_FOUND) : next(name);
        requireReadable(found, _limits);
        return next(found);
    });
}

GuardedReads::Result GuardedReads::openArchive(const std::string& name,
                                               osgDB::ReaderWriter::ArchiveStatus, unsigned,
                                               const osgDB::Options*) {
    return guarded(name, [&]() -> Result { failFile(name, "an archive, expected a file"); });
}

GuardedReads::Result GuardedReads::readNode(const std::string& name,
                                            const osgDB::Options* options) {
    return readModel(name, options,
                     [&](const std::string& file) { return _next->readNode(file, options); });
}

GuardedReads::Result GuardedReads::readObject(const std::string& name,
                                              const osgDB::Options* options) {
    return readModel(name, options,
                     [&](const std::string& file) { return _next->readObject(file, options); });
}

GuardedReads::Result GuardedReads::readImage(const std::string& name,
                                             const osgDB::Options* options) {
    return readOther(name, options, "a picture", [&](const std::string& file) {
        if (!isRegularFile(file)) return _next->readImage(file, options);
        Result result;
        const osg::ref_ptr<osg::Image> image =
            _pictures.shared().once(file, {}, [&]() -> osg::ref_ptr<osg::Image> {
                _pictures.takeFile(file);
                result = _next->readImage(file, options);
                if (result.validImage())
                    result.getImage()->setFileName(name); // for who saves it again
                return result.getImage();
            });
        return image ? Result(image.get()) : result;
    });
}

GuardedReads::Result GuardedReads::readHeightField(const std::string& name,
                                                   const osgDB::Options* options) {
    return readOther(name, options, "a height field", [&](const std::string& file) {
        return _next->readHeightField(file, options);
    });
}

GuardedReads::Result GuardedReads::readShader(const std::string& name,
                                              const osgDB::Options* options) {
    return readOther(name, options, "a shader",
                     [&](const std::string& file) { return _next->readShader(file, options); });
}

GuardedReads::Result GuardedReads::readScript(const std::string& name,
                                              const osgDB::Options* options) {
    return readOther(name, options, "a script",
                     [&](const std::string& file) { return _next->readScript(file, options); });
}

} // namespace osgSkin
