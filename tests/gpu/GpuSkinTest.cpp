// SPDX-License-Identifier: MIT
// What compute shaders make of skins, beside what the processor does.
#include "GpuSubject.h"
#include "SlopedTube.h"
#include "TubeSkin.h"

#include <osgSkinGpu/GpuSkin>

#include <osgDB/ReadFile>

#include <gtest/gtest.h>

#include <cstdlib>
#include <sstream>

namespace {

using test::GpuStage;
using test::GpuSubject;

class GpuSkin : public testing::TestWithParam<std::string> {};

/// OSGSKIN_GPU_SUBJECTS names others, with commas between them.
std::vector<std::string> subjects() {
    const char* named = std::getenv("OSGSKIN_GPU_SUBJECTS");
    std::istringstream list(named ? named : "tube,small,large,thrower,climber");
    std::vector<std::string> names;
    for (std::string name; std::getline(list, name, ',');) names.push_back(name);
    return names;
}

} // namespace

TEST_P(GpuSkin, PositionsNormalsAndTangentsAreTheProcessors) {
    GpuSubject subject(GetParam());
    if (!subject.reason.empty()) GTEST_SKIP() << subject.reason;
    osgSkin::setGpu(*subject.scene, true);
    GpuStage stage(subject.scene);
    test::Difference most;
    for (int pose = 0; pose < subject.poses; ++pose) {
        const double time = subject.timeOf(pose);
        stage.draw(time);
        for (const auto& skin : subject.skins) {
            // Only by the comparisons so far, not to be drawn.
            EXPECT_EQ(skin->getDeformCount(), static_cast<unsigned int>(pose));
            most.take(test::difference(*skin, stage.computed(*skin)));
        }
    }
    EXPECT_LE(most.positions, 1e-6) << "of the extent";
    EXPECT_LE(most.computedError, 3e-6);
    EXPECT_LE(most.deformedError, 3e-6);
    EXPECT_LE(most.normals, 3e-6);
    EXPECT_LE(most.tangents, 3e-6);
    std::cout << GetParam() << ": positions " << most.positions << " of the extent, normals "
              << most.normals << " (from the reference " << most.computedError
              << ", the processor's " << most.deformedError << "), tangents " << most.tangents
              << std::endl;
}

/// Squares of what bones' limits of scale make of a direction's length are no floats.
TEST(GpuSkinScale, NormalsAreTheProcessorsWhateverTheScale) {
    const test::SlopedTube tube;
    for (const double scale : {0.99e9, 1.01e-9})
        for (const std::size_t scaled : {1u, 2u}) {
            SCOPED_TRACE(std::to_string(scale) + " of joint " + std::to_string(scaled));
            const osg::ref_ptr<osgSkin::DeformableSkin> skin = new osgSkin::DeformableSkin;
            skin->setSkin(test::makeGeometry(tube), tube.model());
            osgSkin::setGpu(*skin, true);
            const std::vector<osgSkin::JointMap> maps = tube.scaledMaps(scaled, scale);
            ASSERT_TRUE(skin->setPose(maps.data(), maps.size()));
            GpuStage stage(skin);
            stage.draw();
            const GpuStage::Posed posed = stage.computed(*skin);
            const auto& expected =
                static_cast<const osg::Vec3Array&>(*skin->getDeformedGeometry()->getNormalArray());
            for (std::size_t v = 0; v < posed.normals.size(); ++v)
                ASSERT_LE((posed.normals[v] - expected[v]).length(), 2e-3f) << v;
            skin->releaseGLObjects(nullptr);
        }
}

TEST(GpuSkinState, WhatIsDrawnUsesVertexArrayObjectsAsTheSkinDoes) {
    const osg::ref_ptr<osgSkin::DeformableSkin> skin = test::makeSkin();
    osgSkin::setGpu(*skin, true);
    GpuStage stage(skin);
    for (const bool used : {true, false, true}) {
        skin->setUseVertexArrayObject(used);
        test::bend(*skin, used ? 0.4 : 0.7);
        stage.draw();
        const osg::Geometry* drawn = skin->getDrawBackend()->cull(*skin, *stage.cullVisitor());
        ASSERT_TRUE(drawn);
        EXPECT_EQ(drawn->getUseVertexArrayObject(), used);
    }
    skin->releaseGLObjects(nullptr);
}

TEST(GpuOption, SwitchesTheReadersSkins) {
    const std::string file = std::string(OSGSKIN_DATA) + "/thrower.skin";
    for (const char* option : {"gpu=on", "gpu=off"}) {
        const osg::ref_ptr<osg::Node> scene =
            osgDB::readRefNodeFile(file, new osgDB::Options(option));
        ASSERT_TRUE(scene);
        ASSERT_FALSE(test::skinsIn(*scene).empty());
        for (const auto& skin : test::skinsIn(*scene)) {
            EXPECT_EQ(skin->getDrawBackend() != nullptr, std::string(option) == "gpu=on");
            const osg::ref_ptr<osgSkin::DeformableSkin> copy =
                osg::clone(skin.get(), osg::CopyOp::SHALLOW_COPY);
            EXPECT_EQ(copy->getDrawBackend() != nullptr, skin->getDrawBackend() != nullptr);
            EXPECT_TRUE(!copy->getDrawBackend() || copy->getDrawBackend() != skin->getDrawBackend());
        }
    }
    EXPECT_FALSE(osgDB::readRefNodeFile(file, new osgDB::Options("gpu=perhaps")));
}

TEST_P(GpuSkin, TheSameBitsTwice) {
    GpuSubject subject(GetParam());
    if (!subject.reason.empty()) GTEST_SKIP() << subject.reason;
    osgSkin::setGpu(*subject.scene, true);
    GpuStage::Posed before;
    for (int run = 0; run < 2; ++run) {
        GpuStage stage(subject.scene);
        stage.draw(subject.timeOf(1));
        const GpuStage::Posed posed = stage.computed(*subject.skins.front());
        if (run == 0) before = posed;
        EXPECT_EQ(posed.positions, before.positions);
        EXPECT_EQ(posed.normals, before.normals);
        EXPECT_EQ(posed.tangents, before.tangents);
        subject.scene->releaseGLObjects(nullptr);
    }
}

INSTANTIATE_TEST_SUITE_P(Subjects, GpuSkin, testing::ValuesIn(subjects()),
                         [](const auto& subject) { return subject.param; });
