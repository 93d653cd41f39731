// SPDX-License-Identifier: MIT
// Images beside a mesh that refers to them.
#pragma once

#include "MeshParts.h"
#include "Notices.h"
#include "TextFile.h"

#include <osg/Image>
#include <osgDB/ReadFile>
#include <osgDB/WriteFile>

#include <gtest/gtest.h>

#include <string>

namespace test {

struct Drawn {
    osg::ref_ptr<const osg::Image> image; ///< null: the mesh has no image
    std::string notices;
};

/// The image and notices of a mesh whose material names a image.
inline Drawn drawnWith(const std::string& image, const std::string& options = {}) {
    saveText("image_" + image + ".mtl", "newmtl skin\nKd 1 1 1\nmap_Kd " + image + "\n");
    saveText("image_" + image + ".obj",
             "mtllib image_" + image +
                 ".mtl\nusemtl skin\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1/1 2/1 3/1\n");
    const Notices notices;
    const osg::ref_ptr<osgDB::Options> words = new osgDB::Options(options);
    const osgSkin::ImportedMesh mesh =
        osgSkin::importMesh(testing::TempDir() + "image_" + image + ".obj", words);
    return {imageOf(mesh.parts.at(0)), notices.text()};
}

inline void expectRefused(const std::string& name, const std::string& content,
                          const std::string& reason, const std::string& options = {}) {
    saveText(name, content);
    const Drawn drawn = drawnWith(name, options);
    EXPECT_FALSE(drawn.image.valid()) << name;
    EXPECT_NE(drawn.notices.find(name + "\" cannot be read; drawn without: "), std::string::npos)
        << drawn.notices;
    EXPECT_NE(drawn.notices.find(reason), std::string::npos) << drawn.notices;
}

/// A little-endian number of `count` bytes.
inline std::string little(std::uint32_t number, int count) {
    std::string result;
    for (int i = 0; i < count; ++i)
        result += i < 4 ? static_cast<char>(number >> 8 * i & 0xff) : '\0';
    return result;
}
inline std::string big(std::uint32_t number, int count) {
    const std::string result = little(number, count);
    return {result.rbegin(), result.rend()};
}

/// `text` with other bytes at a position.
inline std::string with(std::string text, std::size_t at, const std::string& bytes) {
    return text.replace(at, bytes.size(), bytes);
}

/// A image as OpenSceneGraph writes it.
inline std::string written(const std::string& extension, int width = 5, int height = 3) {
    const osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(width, height, 1, GL_RGB, GL_UNSIGNED_BYTE);
    for (unsigned i = 0; i < image->getTotalSizeInBytes(); ++i)
        image->data()[i] = static_cast<unsigned char>(40 + i);
    const std::string path = testing::TempDir() + "image_written." + extension;
    if (!osgDB::writeImageFile(*image, path)) return {};
    return fileText(path);
}

} // namespace test
