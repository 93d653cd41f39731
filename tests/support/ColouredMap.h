// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Image>
#include <osg/Vec3>
#include <osgDB/WriteFile>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>

namespace test {

/// Writes a picture of 4 x 4 pixels to the tests' folder, for a texture.
/// \param name ends with .bmp
/// \param quarters colours, 0 to 1, from the lower left: lower left, lower right, upper left and
///        upper right
/// \return the colours as the picture has them
inline std::array<osg::Vec3, 4> writeMap(const std::string& name,
                                         std::array<osg::Vec3, 4> quarters) {
    const osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(4, 4, 1, GL_RGB, GL_UNSIGNED_BYTE);
    for (unsigned y = 0; y < 4; ++y)
        for (unsigned x = 0; x < 4; ++x)
            for (unsigned i = 0; i < 3; ++i) {
                float& colour = quarters[2 * (y / 2) + x / 2][i];
                image->data(x, y)[i] = static_cast<unsigned char>(std::lround(colour * 255.0f));
                colour = float(image->data(x, y)[i]) / 255.0f;
            }
    EXPECT_TRUE(osgDB::writeImageFile(*image, testing::TempDir() + name)) << name;
    return quarters;
}

/// A unit normal as the colour of a normal map.
inline osg::Vec3 asColour(osg::Vec3 normal) {
    normal.normalize();
    return normal * 0.5f + osg::Vec3(0.5f, 0.5f, 0.5f);
}

} // namespace test
