// SPDX-License-Identifier: MIT
// Reasons why plain data is invalid: skeletons, motions, meshes, bindings.
#include "Tube.h"

#include <osgSkin/Error>
#include <osgSkinMotion/Prop>
#include <osgSkinRig/RestSkeleton>
#include <osgSkinRig/Retarget>
#include <osgSkinRig/SkinMesh>

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace {

/// The message of the Error that validate() throws; empty if none.
template <typename T>
std::string complaint(const T& value) {
    try {
        value.validate();
        return "";
    } catch (const osgSkin::Error& error) {
        return error.what();
    }
}

} // namespace

TEST(RestSkeleton, DefaultIsInvalid) {
    EXPECT_NE(complaint(osgSkin::RestSkeleton()), "");
}

TEST(RestSkeleton, ErrorsNameTheJoint) {
    struct Case {
        const char* name;
        std::vector<osgSkin::RestJoint> joints;
        const char* names;
    };
    const Case cases[] = {
        {"first has a parent", {{"a", 0, {}, {}}}, "\"a\""},
        {"two roots", {{"a", -1, {}, {}}, {"b", -1, {}, {}}}, "\"b\""},
        {"cycle", {{"a", -1, {}, {}}, {"b", 2, {}, {}}, {"c", 1, {}, {}}}, "\"b\""},
        {"own parent", {{"a", -1, {}, {}}, {"b", 1, {}, {}}}, "\"b\""},
        {"one name twice", {{"a", -1, {}, {}}, {"a", 0, {}, {}}}, "joint 1 \"a\""},
        {"not finite", {{"a", -1, {}, {}}, {"b", 0, {0, std::nan(""), 0}, {}}}, "\"b\""},
    };
    for (const Case& c : cases)
        EXPECT_NE(complaint(osgSkin::RestSkeleton{c.joints}).find(c.names), std::string::npos)
            << c.name << ": " << complaint(osgSkin::RestSkeleton{c.joints});
    EXPECT_EQ(complaint(osgSkin::RestSkeleton{{{"a", -1, {}, {}}, {"b", 0, {}, {}}}}), "");
}

TEST(RestSkeleton, FindsJointsAndChildren) {
    const osgSkin::RestSkeleton skeleton{
        {{"a", -1, {}, {}}, {"b", 0, {}, {}}, {"c", 1, {}, {}}, {"d", 0, {}, {}}}};
    EXPECT_EQ(skeleton.find("c"), 2);
    EXPECT_EQ(skeleton.find("x"), -1);
    EXPECT_EQ(skeleton.children(0), (std::vector<int>{1, 3}));
    EXPECT_TRUE(skeleton.isInSubtree(2, 1));
    EXPECT_TRUE(skeleton.isInSubtree(2, 2));
    EXPECT_FALSE(skeleton.isInSubtree(3, 1));
}

TEST(Motion, RejectsIncompleteOrInvalidData) {
    osgSkin::Motion good;
    good.name = "wave";
    good.skeleton.add("a", -1, glm::dvec3(0, 1, 0));
    good.skeleton.add("b", 0, glm::dvec3(0, 2, 0));
    good.frameTime = 0.1;
    const std::vector<glm::dquat> still(2, glm::dquat(1, 0, 0, 0));
    for (int f = 0; f < 3; ++f) good.addFrame(glm::dvec3(0, 1, 0), still);
    ASSERT_EQ(complaint(good), "");
    struct Case {
        const char* name;
        void (*spoil)(osgSkin::Motion&);
        const char* names;
    };
    const Case cases[] = {
        {"skeleton", [](osgSkin::Motion& m) { m.skeleton.joints[1].parent = 1; }, "\"b\""},
        {"no frame", [](osgSkin::Motion& m) { m.frames = 0; }, "no frame"},
        {"no time", [](osgSkin::Motion& m) { m.frameTime = 0.0; }, "frame time"},
        {"time", [](osgSkin::Motion& m) { m.frameTime = std::nan(""); }, "frame time"},
        {"endless", [](osgSkin::Motion& m) { m.frameTime = HUGE_VAL; }, "frame time"},
        {"more frames", [](osgSkin::Motion& m) { m.frames = 4; }, "do not fit 4"},
        {"fewer roots", [](osgSkin::Motion& m) { m.rootPositions.pop_back(); }, "do not fit"},
        {"fewer turns", [](osgSkin::Motion& m) { m.rotations.pop_back(); }, "do not fit"},
        {"root", [](osgSkin::Motion& m) { m.rootPositions[2].x = std::nan(""); },
         "frame 2: the root"},
        {"far", [](osgSkin::Motion& m) { m.rootPositions[1].y = 1e300; }, "frame 1: the root"},
        {"turn", [](osgSkin::Motion& m) { m.rotations[3].w = std::nan(""); },
         "frame 1: joint \"b\""},
        {"longer", [](osgSkin::Motion& m) { m.rotations[4].w = 2.0; }, "frame 2: joint \"a\""},
    };
    for (const Case& c : cases) {
        osgSkin::Motion motion = good;
        c.spoil(motion);
        EXPECT_NE(complaint(motion).find(c.names), std::string::npos)
            << c.name << ": " << complaint(motion);
        osgSkin::RetargetReport report;
        EXPECT_THROW(osgSkin::retarget(motion, good.skeleton, {}, &report), osgSkin::Error);
        const osg::ref_ptr<osgAnimation::Animation> animation = new osgAnimation::Animation;
        EXPECT_THROW(osgSkin::makeProp("ball", {}, motion, report, *animation), osgSkin::Error);
        EXPECT_TRUE(animation->getChannels().empty());
    }
}

TEST(SkinMesh, ErrorsNameTheVertexOrFace) {
    const std::vector<glm::dvec3> points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    struct Case {
        const char* name;
        osgSkin::SkinMesh mesh;
        const char* names;
    };
    const Case cases[] = {
        {"empty", {}, "no vertex"},
        {"no face", {points, {}, {}}, "no face"},
        {"not finite", {{{0, 0, 0}, {1, std::nan(""), 0}, {0, 1, 0}}, {3}, {0, 1, 2}}, "vertex 1"},
        {"two corners", {points, {2}, {0, 1}}, "face 0"},
        {"index beyond", {points, {3, 3}, {0, 1, 2, 0, 1, 3}}, "face 1"},
        {"corners missing", {points, {3, 3}, {0, 1, 2, 0}}, "face 1"},
        {"corners left over", {points, {3}, {0, 1, 2, 0}}, "beyond"},
        {"huge face", {points, {0xffffffffu}, {0, 1, 2}}, "face 0"},
    };
    for (const Case& c : cases)
        EXPECT_NE(complaint(c.mesh).find(c.names), std::string::npos)
            << c.name << ": " << complaint(c.mesh);
    EXPECT_EQ(complaint(osgSkin::SkinMesh{points, {3}, {0, 1, 2}}), "");
}

TEST(SkinMesh, TriangulatesPolygonsAsFans) {
    const osgSkin::SkinMesh mesh{std::vector<glm::dvec3>(5), {3, 4}, {0, 1, 2, 1, 2, 3, 4}};
    EXPECT_EQ(mesh.triangles(), (std::vector<std::uint32_t>{0, 1, 2, 1, 2, 3, 1, 3, 4}));
}

TEST(Binding, ErrorsNameTheJointOrVertex) {
    const osgSkin::Binding good = test::Tube(3, 3).binding;
    ASSERT_EQ(complaint(good), "");
    EXPECT_NE(complaint(osgSkin::Binding()), "");
    struct Case {
        const char* name;
        void (*spoil)(osgSkin::Binding&);
        const char* names;
    };
    const Case cases[] = {
        {"parent after child", [](osgSkin::Binding& b) { b.joints[1].parent = 2; }, "\"middle\""},
        {"axis", [](osgSkin::Binding& b) { b.joints[2].twistAxis *= 2.0; }, "\"end\""},
        {"region", [](osgSkin::Binding& b) { b.regions[4] = 9; }, "vertex 4"},
        {"ratio", [](osgSkin::Binding& b) { b.influences.back().twist = 1.5f; }, "vertex 8"},
        {"order", [](osgSkin::Binding& b) { b.influences.back().joint = 0; }, "vertex 8"},
        {"root", [](osgSkin::Binding& b) { b.influences[0].bend = 0.5f; }, "vertex 0"},
        {"offsets", [](osgSkin::Binding& b) { b.firstInfluence.back() = 3; }, "offsets"},
    };
    for (const Case& c : cases) {
        osgSkin::Binding binding = good;
        c.spoil(binding);
        EXPECT_NE(complaint(binding).find(c.names), std::string::npos)
            << c.name << ": " << complaint(binding);
    }
}
