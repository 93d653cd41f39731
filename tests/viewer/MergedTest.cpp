// SPDX-License-Identifier: MIT
// A character with merged rigid parts must look like one with rigid parts below its bones, deformed
// by the processor and by a graphics card (which Mesa's software renderer stands for).
#include "Pixels.h"
#include "Window.h"

#include <osg/BoundingSphere>
#include <osg/ref_ptr>
#include <osgDB/Options>
#include <osgDB/ReadFile>

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace {

/// Pictures of the thrower at a few times.
std::vector<osg::ref_ptr<osg::Image>> pictures(const std::string& options) {
    const osg::ref_ptr<osgDB::Options> read = new osgDB::Options("shapes=none " + options);
    const osg::ref_ptr<osg::Node> thrower =
        osgDB::readRefNodeFile(OSGSKIN_DATA "/thrower.skin", read);
    EXPECT_NE(thrower, nullptr);
    std::vector<osg::ref_ptr<osg::Image>> result;
    for (const double time : {0.4, 1.3}) {
        const osg::Vec3d centre(0.0, -0.5, 1.0); // fixed: bounds differ
        test::Windows windows(thrower, centre + osg::Vec3d(1.0, -2.5, 0.3), centre);
        for (int i = 0; i < 3; ++i) windows.frame(time);
        result.push_back(windows.pictures().front());
    }
    return result;
}

} // namespace

TEST(Merged, LooksLikeSeparateRigidParts) {
    const auto expected = pictures("");
    for (const char* options : {"rigid=merged", "rigid=merged gpu=on", "gpu=on"}) {
        const auto are = pictures(options);
        for (std::size_t i = 0; i < expected.size(); ++i) {
            EXPECT_GE(test::seenPixels(*expected[i]), 5000u);
            EXPECT_LE(test::unlikePixels(*are[i], *expected[i]), 10u) << options << ", " << i;
        }
    }
}
