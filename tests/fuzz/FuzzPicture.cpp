// SPDX-License-Identifier: MIT
// Any bytes as a picture that a mesh is drawn with, by OpenSceneGraph's reader of the format that
// the first byte chooses.
#include "InputFile.h"

#include <osgSkinImport/ImportMesh>

#include <osg/Notify>

#include <iterator>
#include <string>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const char* const kFormats[] = {"png", "jpg", "gif", "tga", "bmp",
                                           "dds", "tif", "rgb", "ppm"};
    if (size == 0) return 0;
    osg::setNotifyLevel(osg::ALWAYS);
    const std::string name = std::string("picture.") + kFormats[data[0] % std::size(kFormats)];
    fuzz::save(name, data + 1, size - 1);
    const auto saveText = [](const std::string& file, const std::string& text) {
        return fuzz::save(file, reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
    };
    saveText("picture.mtl", "newmtl skin\nKd 1 1 1\nmap_Kd " + name + "\n");
    osgSkin::importMesh(saveText("picture.obj",
                                 "mtllib picture.mtl\nusemtl skin\nv 0 0 0\nv 1 0 0\n"
                                 "v 0 1 0\nvt 0 0\nf 1/1 2/1 3/1\n"));
    return 0;
}
