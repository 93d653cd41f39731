// SPDX-License-Identifier: MIT
#include "model/GpuMorphs.h"

#include <gtest/gtest.h>
#include <osg/Array>

#include <cstring>

namespace {

using osgSkin::GpuMorphs;
using osgSkin::MorphTarget;
using osgSkin::MorphTargets;

const osg::Vec4uiArray& texelsOf(const GpuMorphs& morphs) {
    return dynamic_cast<const osg::Vec4uiArray&>(*morphs.texture()->getBufferData());
}

glm::vec3 vectorOf(const osg::Vec4ui& texel) {
    glm::vec3 v;
    std::memcpy(&v, texel.ptr(), sizeof v);
    return v;
}

MorphTarget target(const char* name, std::vector<std::uint32_t> vertices, const glm::vec3& offset) {
    MorphTarget result;
    result.name = name;
    result.positions.assign(vertices.size(), offset);
    result.vertices = std::move(vertices);
    return result;
}

TEST(GpuMorphs, ListsTheOffsetsOfEachVertex) {
    MorphTarget open = target("open", {1, 2}, {0, 2, 0});
    open.normals = {{0, 0, 3}, {0, 0, 4}};
    const auto targets = MorphTargets::create({target("smile", {2}, {1, 0, 0}), open}, 4);
    const osg::ref_ptr<const GpuMorphs> morphs = GpuMorphs::of(*targets);
    const osg::Vec4uiArray& texels = texelsOf(*morphs);
    ASSERT_EQ(texels.size(), morphs->texelCount());
    EXPECT_EQ(texels[0][0], 2u);
    const unsigned int counts[] = {0, 1, 2, 0};
    for (unsigned int v = 0; v < 4; ++v) EXPECT_EQ(texels[1 + v][1], counts[v]) << v;
    const unsigned int last = texels[3][0]; // vertex 2: both, in the order of the targets
    EXPECT_EQ(vectorOf(texels[last]), glm::vec3(1, 0, 0));
    EXPECT_EQ(texels[last][3], 0u);
    EXPECT_EQ(vectorOf(texels[last + 1]), glm::vec3(0));
    EXPECT_EQ(vectorOf(texels[last + 2]), glm::vec3(0, 2, 0));
    EXPECT_EQ(texels[last + 2][3], 1u);
    EXPECT_EQ(vectorOf(texels[last + 3]), glm::vec3(0, 0, 4));
}

TEST(GpuMorphs, HasTangentsWhereATargetMovesThem) {
    MorphTarget one = target("open", {0}, {0, 2, 0});
    one.tangents = {{5, 0, 0}};
    const osg::ref_ptr<const GpuMorphs> morphs = GpuMorphs::of(*MorphTargets::create({one}, 1));
    const osg::Vec4uiArray& texels = texelsOf(*morphs);
    ASSERT_EQ(texels.size(), 5u);
    EXPECT_EQ(texels[0][0], 3u);
    EXPECT_EQ(vectorOf(texels[4]), glm::vec3(5, 0, 0));
}

TEST(GpuMorphs, IsSharedByAllWhoHaveTheTargets) {
    const auto targets = MorphTargets::create({target("smile", {0}, {1, 0, 0})}, 1);
    osg::ref_ptr<const GpuMorphs> first = GpuMorphs::of(*targets);
    EXPECT_EQ(GpuMorphs::of(*targets), first);
    first = nullptr;
    EXPECT_EQ(GpuMorphs::of(*targets)->texelCount(), 4u); // made again
}

} // namespace
