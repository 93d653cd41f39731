// SPDX-License-Identifier: MIT
// Any bytes as a file of one format, for every reader of that format. Errors are
// osgSkin::Error; any other exception ends the run.
#include "Attempt.h"
#include "GlbParts.h"
#include "InputFile.h"

#include <osgSkinImport/ImportMesh>
#include <osgSkinImport/ImportMotion>
#include <osgSkinImport/ImportRig>
#include <osgSkinImport/ImportSkeleton>

#include <osg/Notify>

/// The extension of the files that a target reads (FuzzFormat.cpp).
const char* fuzzExtension();

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    osg::setNotifyLevel(osg::ALWAYS);
    const std::string extension = fuzzExtension();
    std::string glb;
    if (extension == "glb") {
        glb = fuzz::GlbParts::file(data, size);
        data = reinterpret_cast<const std::uint8_t*>(glb.data());
        size = glb.size();
    }
    const std::string path = fuzz::save("input." + extension, data, size);
    fuzz::attempt([&] { osgSkin::importMesh(path); });
    fuzz::attempt([&] { osgSkin::importSkeleton(path); });
    fuzz::attempt([&] { osgSkin::importMotion(path); });
    if (osgSkin::isReadByAssimp(path)) fuzz::attempt([&] { osgSkin::importRig(path); });
    return 0;
}
