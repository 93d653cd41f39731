// SPDX-License-Identifier: MIT
// Any bytes as a picture that a mesh is drawn with, by OpenSceneGraph's reader of the format that
// the first byte chooses.
#include "InputFile.h"

#include <osgSkinImport/ImportMesh>

#include <osg/Notify>

#include <zlib.h>

#include <iterator>
#include <string>
#include <vector>

namespace {

std::uint32_t big(const std::uint8_t* at) {
    return std::uint32_t(at[0]) << 24 | std::uint32_t(at[1]) << 16 | std::uint32_t(at[2]) << 8 |
           at[3];
}

/// With the right check sum behind each chunk: few inputs would get by the first one's.
void mendPng(std::vector<std::uint8_t>& png) {
    for (std::size_t at = 8; at + 12 <= png.size();) {
        const std::size_t length = big(&png[at]);
        if (length > png.size() - at - 12) return;
        const auto sum =
            static_cast<std::uint32_t>(crc32(0, &png[at + 4], static_cast<unsigned>(length) + 4));
        for (std::size_t i = 0; i < 4; ++i)
            png[at + 8 + length + i] = static_cast<std::uint8_t>(sum >> (24 - 8 * i));
        at += 12 + length;
    }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const char* const kFormats[] = {"png", "jpg", "gif", "tga", "bmp",
                                           "dds", "tif", "rgb", "ppm"};
    if (size == 0) return 0;
    osg::setNotifyLevel(osg::ALWAYS);
    const std::string name = std::string("picture.") + kFormats[data[0] % std::size(kFormats)];
    std::vector<std::uint8_t> bytes(data + 1, data + size);
    if (data[0] % std::size(kFormats) == 0) mendPng(bytes);
    fuzz::save(name, bytes.data(), bytes.size());
    const auto saveText = [](const std::string& file, const std::string& text) {
        return fuzz::save(file, reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
    };
    saveText("picture.mtl", "newmtl skin\nKd 1 1 1\nmap_Kd " + name + "\n");
    osgSkin::importMesh(saveText("picture.obj",
                                 "mtllib picture.mtl\nusemtl skin\nv 0 0 0\nv 1 0 0\n"
                                 "v 0 1 0\nvt 0 0\nf 1/1 2/1 3/1\n"));
    return 0;
}
