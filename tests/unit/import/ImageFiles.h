// SPDX-License-Identifier: MIT
// Pictures beside a mesh that refers to them.
#pragma once

#include "ExpectError.h"
#include "Notices.h"

#include <osgSkinImport/ImportMesh>

#include <osg/Geometry>
#include <osg/Image>
#include <osg/Texture2D>
#include <osgDB/ReadFile>
#include <osgDB/WriteFile>

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <string>

namespace test {

struct Drawn {
    osg::ref_ptr<const osg::Image> image; ///< null: the mesh has no picture
    std::string notices;
};

inline void savePicture(const std::string& name, const std::string& content) {
    std::ofstream(testing::TempDir() + name, std::ios::binary) << content;
}

/// The image and notices of a mesh whose material names a picture.
inline Drawn drawnWith(const std::string& picture, const std::string& options = {}) {
    savePicture("picture_" + picture + ".mtl", "newmtl skin\nKd 1 1 1\nmap_Kd " + picture + "\n");
    savePicture("picture_" + picture + ".obj",
                "mtllib picture_" + picture +
                    ".mtl\nusemtl skin\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1/1 2/1 3/1\n");
    const Notices notices;
    const osg::ref_ptr<osgDB::Options> words = new osgDB::Options(options);
    const osgSkin::ImportedMesh mesh =
        osgSkin::importMesh(testing::TempDir() + "picture_" + picture + ".obj", words);
    const auto* texture = dynamic_cast<const osg::Texture2D*>(
        mesh.parts.at(0).geometry->getStateSet()->getTextureAttribute(
            0, osg::StateAttribute::TEXTURE));
    return {texture != nullptr ? texture->getImage() : nullptr, notices.text()};
}

inline void expectRefused(const std::string& name, const std::string& content,
                          const std::string& reason, const std::string& options = {}) {
    savePicture(name, content);
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

/// A picture as OpenSceneGraph writes it.
inline std::string written(const std::string& extension, int width = 5, int height = 3) {
    const osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(width, height, 1, GL_RGB, GL_UNSIGNED_BYTE);
    for (unsigned i = 0; i < image->getTotalSizeInBytes(); ++i)
        image->data()[i] = static_cast<unsigned char>(40 + i);
    const std::string path = testing::TempDir() + "picture_written." + extension;
    if (!osgDB::writeImageFile(*image, path)) return {};
    std::ostringstream content;
    content << std::ifstream(path, std::ios::binary).rdbuf();
    return content.str();
}

} // namespace test
