// SPDX-License-Identifier: MIT
#include <osgSkinImport/ReadScene>

#include "osg/GuardedReads.h"
#include "text/FileText.h"

#include <osgSkin/Error>

#include <osgDB/Registry>

namespace osgSkin {

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
    // A pseudo-loader's name is no file, and has a reason of its own.
    if (reason.empty() || read.notFound()) requireReadable(path, ReadLimits::of(options));
    failFile(path,
             reason.empty() ? "no reader of Assimp or OpenSceneGraph knows this file" : reason);
}

} // namespace osgSkin
