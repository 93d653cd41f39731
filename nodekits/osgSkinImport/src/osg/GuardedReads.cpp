// SPDX-License-Identifier: MIT
#include "osg/GuardedReads.h"

#include "saved/ReadSaved.h"
#include "text/FileText.h"
#include "text/SafeNames.h"

#include <osgSkin/Error>

#include <osgDB/FileNameUtils>
#include <osgDB/FileUtils>
#include <osgDB/Registry>

#include <algorithm>

namespace osgSkin {
namespace {

constexpr std::size_t kDeepestFile = 8;

} // namespace

GuardedReads::GuardedReads(const osgDB::Options* options)
    : _limits(ReadLimits::of(options)), _pictures(options) {
    if (options != nullptr) _next = options->getReadFileCallback();
    if (!_next) _next = osgDB::Registry::instance()->getReadFileCallback();
    if (!_next) _next = new osgDB::ReadFileCallback;
}

template <typename Read>
GuardedReads::Result GuardedReads::guarded(const std::string& name, const osgDB::Options* options,
                                           Read read) {
    try {
        if (osgDB::containsServerAddress(name))
            failFile(name, "cannot open: an address, expected a file");
        requireOnlyRead(name);
        // A pseudo-loader's name is no file; what stands before its extensions is.
        const std::string found = osgDB::findDataFile(name, options);
        if (!found.empty()) requireReadable(found, _limits);
        return read(found);
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

GuardedReads::Result GuardedReads::readNode(const std::string& name,
                                            const osgDB::Options* options) {
    return guarded(name, options, [&](const std::string& found) {
        _limits.checkFormat(name);
        return isSaved(name) && !found.empty() ? readSavedFile(found, options)
                                               : _next->readNode(name, options);
    });
}

GuardedReads::Result GuardedReads::readObject(const std::string& name,
                                              const osgDB::Options* options) {
    return guarded(name, options, [&](const std::string& found) {
        _limits.checkFormat(name);
        return isSaved(name) && !found.empty() ? readSavedFile(found, options)
                                               : _next->readObject(name, options);
    });
}

GuardedReads::Result GuardedReads::readImage(const std::string& name,
                                             const osgDB::Options* options) {
    return guarded(name, options, [&](const std::string& found) {
        if (isSaved(name)) failFile(name, "a saved scene, expected a picture");
        if (found.empty()) return _next->readImage(name, options);
        Result result;
        const osg::ref_ptr<osg::Image> image =
            _pictures.shared().once(found, {}, [&]() -> osg::ref_ptr<osg::Image> {
                _pictures.takeFile(found);
                result = _next->readImage(name, options);
                return result.getImage();
            });
        return image ? Result(image.get()) : result;
    });
}

GuardedReads::Result GuardedReads::readHeightField(const std::string& name,
                                                   const osgDB::Options* options) {
    return guarded(name, options, [&](const std::string&) {
        if (isSaved(name)) failFile(name, "a saved scene, expected a height field");
        return _next->readHeightField(name, options);
    });
}

GuardedReads::Result GuardedReads::readShader(const std::string& name,
                                              const osgDB::Options* options) {
    return guarded(name, options, [&](const std::string&) {
        if (isSaved(name)) failFile(name, "a saved scene, expected a shader");
        return _next->readShader(name, options);
    });
}

GuardedReads::Result GuardedReads::readScript(const std::string& name,
                                              const osgDB::Options* options) {
    return guarded(name, options, [&](const std::string&) {
        if (isSaved(name)) failFile(name, "a saved scene, expected a script");
        return _next->readScript(name, options);
    });
}

} // namespace osgSkin
