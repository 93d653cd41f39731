// SPDX-License-Identifier: MIT
#include "SceneFile.h"

#include "Bytes.h"

#include <osgSkin/Error>

#include <osgDB/FileNameUtils>
#include <osgDB/Options>
#include <osgDB/Registry>

#include <sstream>

namespace bake {

bool isSceneFile(const std::string& file) {
    const std::string extension = osgDB::getLowerCaseFileExtension(file);
    return extension == "osgb" || extension == "osgt" || extension == "osgx";
}

void writeScene(const std::string& file, const osg::Node& scene) {
    const osg::ref_ptr<osgDB::Options> options =
        new osgDB::Options("WriteImageHint=IncludeData Compressor=zlib");
    const std::string extension = osgDB::getLowerCaseFileExtension(file);
    if (extension == "osgt") options->setPluginStringData("fileType", "Ascii");
    if (extension == "osgx") options->setPluginStringData("fileType", "XML");
    osgDB::ReaderWriter* const writer =
        osgDB::Registry::instance()->getReaderWriterForExtension(extension);
    std::ostringstream bytes;
    if (!writer || !writer->writeNode(scene, bytes, options).success())
        throw osgSkin::Error(file + ": OpenSceneGraph could not write the scene");
    writeBytes(file, bytes.str());
}

} // namespace bake
