// SPDX-License-Identifier: MIT
#include <osgSkinImport/ReadScene>

#include "osg/GuardedReads.h"
#include "text/FileText.h"
#include "text/SafeNames.h"

#include <osgSkin/Error>

#include <osgDB/FileNameUtils>
#include <osgDB/FileUtils>
#include <osgDB/Registry>

namespace osgSkin {

osg::ref_ptr<osg::Node> readScene(const std::string& path, const osgDB::Options* options) {
    if (osgDB::containsServerAddress(path))
        failFile(path, "cannot open: an address, expected a file");
    requireOnlyRead(path);
    const ReadLimits limits = ReadLimits::of(options);
    // A pseudo-loader's name is no file; what stands before its extensions is.
    const std::string found = osgDB::findDataFile(path, options);
    if (!found.empty()) requireReadable(found, limits);
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
    // A pseudo-loader's name is no file, and has a reason of its own.
    if (reason.empty() || read.notFound()) requireReadable(path, limits);
    failFile(path,
             reason.empty() ? "no reader of Assimp or OpenSceneGraph knows this file" : reason);
}

} // namespace osgSkin
