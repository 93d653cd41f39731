// SPDX-License-Identifier: MIT
// Weights of skinned meshes, in their bind pose.
#include "ExpectError.h"
#include "Paths.h"

#include <osgSkinImport/ImportMesh>
#include <osgSkinImport/ImportSkeleton>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <osg/MatrixTransform>
#include <osgAnimation/Bone>
#include <osgAnimation/RigGeometry>
#include <osgAnimation/Skeleton>
#include <osgDB/WriteFile>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

using namespace osgSkin;

namespace {

using Weights = std::map<std::string, std::map<std::uint32_t, double>>;

Weights weightsOf(const ImportedMesh& mesh) {
    Weights result;
    for (const BoneWeights& bone : mesh.weights) {
        EXPECT_EQ(result.count(bone.bone), 0u) << "two lists for " << bone.bone;
        for (const BoneWeights::Entry& entry : bone.entries)
            result[bone.bone][entry.vertex] += entry.weight;
    }
    return result;
}

double at(const Weights& weights, const std::string& bone, std::uint32_t vertex) {
    const auto list = weights.find(bone);
    if (list == weights.end()) return 0.0;
    const auto entry = list->second.find(vertex);
    return entry == list->second.end() ? 0.0 : entry->second;
}

void expectNear(const glm::dvec3& a, const glm::dvec3& b) {
    EXPECT_LT(glm::distance(a, b), 1e-6)
        << a.x << " " << a.y << " " << a.z << ", expected " << b.x << " " << b.y << " " << b.z;
}

/// A quad with two bones under a skeleton with an offset, as an osgAnimation scene.
osg::ref_ptr<osg::Group> makeRig(unsigned strayVertex) {
    const osg::ref_ptr<osg::Geometry> quad = new osg::Geometry;
    const osg::ref_ptr<osg::Vec3Array> corners = new osg::Vec3Array;
    for (const osg::Vec3& corner :
         {osg::Vec3(0, 0, 0), osg::Vec3(1, 0, 0), osg::Vec3(1, 0, 2), osg::Vec3(0, 0, 2)})
        corners->push_back(corner);
    quad->setVertexArray(corners);
    quad->addPrimitiveSet(new osg::DrawArrays(GL_QUADS, 0, 4));
    const osg::ref_ptr<osgAnimation::RigGeometry> rig = new osgAnimation::RigGeometry;
    rig->setSourceGeometry(quad);
    const osg::ref_ptr<osgAnimation::VertexInfluenceMap> map = new osgAnimation::VertexInfluenceMap;
    (*map)["low"].assign({{0, 1.0f}, {1, 1.0f}, {2, 0.25f}});
    (*map)["high"].assign({{2, 0.75f}, {strayVertex, 1.0f}});
    rig->setInfluenceMap(map);

    const osg::ref_ptr<osgAnimation::Skeleton> skeleton = new osgAnimation::Skeleton;
    skeleton->setMatrix(osg::Matrix::translate(5, 0, 0));
    const osg::ref_ptr<osgAnimation::Bone> low = new osgAnimation::Bone("low");
    const osg::ref_ptr<osgAnimation::Bone> high = new osgAnimation::Bone("high");
    low->setMatrix(osg::Matrix::rotate(0.4, osg::Vec3(0, 1, 0))); // posed differently from its bind
                                                                  // pose
    high->setInvBindMatrixInSkeletonSpace(osg::Matrix::translate(0, 0, -1));
    low->addChild(high);
    skeleton->addChild(low);
    skeleton->addChild(rig);
    osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(skeleton);
    return root;
}

std::string written(osg::Node& scene, const std::string& name) {
    std::string path = testing::TempDir() + name;
    EXPECT_TRUE(osgDB::writeNodeFile(scene, path));
    return path;
}

} // namespace

TEST(MeshWeights, GltfSkinIsInItsBindPose) {
    // The second file's nodes rest in another pose than the bind pose.
    for (const char* file : {"rig/tube.gltf", "rig/posed.gltf"}) {
        SCOPED_TRACE(file);
        const ImportedMesh mesh = importMesh(testData(file));
        const Weights weights = weightsOf(mesh);
        ASSERT_EQ(mesh.mesh.positions.size(), 36u);
        EXPECT_EQ(weights.size(), 2u);
        for (std::uint32_t v = 0; v < 36; ++v) {
            // Half the size, and up is -Y rotated to Z; the mesh node's own position is not used.
            const double height = 0.5 * std::floor(v / 4.0);
            EXPECT_NEAR(mesh.mesh.positions[v].z, 0.5 * height, 1e-6);
            const double arm = std::clamp(height - 1.5, 0.0, 1.0);
            EXPECT_NEAR(at(weights, "arm", v), arm, 1e-6) << "vertex " << v;
            EXPECT_NEAR(at(weights, "base", v), 1.0 - arm, 1e-6) << "vertex " << v;
        }
        const RestSkeleton skeleton = importSkeleton(testData(file));
        ASSERT_EQ(skeleton.joints.size(), 2u);
        EXPECT_EQ(skeleton.joints[0].name, "base");
        expectNear(skeleton.joints[1].centre, {0, 0, 1});
    }
}

TEST(MeshWeights, Md5) {
    const ImportedMesh mesh = importMesh(testData("rig/strip.md5mesh"));
    const Weights weights = weightsOf(mesh);
    const RestSkeleton skeleton = importSkeleton(testData("rig/strip.md5mesh"));
    ASSERT_GE(skeleton.find("arm"), 0);
    expectNear(skeleton.joints[std::size_t(skeleton.find("arm"))].centre, {0, 0, -2});
    std::size_t shared = 0;
    for (std::uint32_t v = 0; v < mesh.mesh.positions.size(); ++v) {
        EXPECT_NEAR(at(weights, "base", v) + at(weights, "arm", v), 1.0, 1e-6);
        if (at(weights, "arm", v) == 0.75) {
            ++shared;
            expectNear(mesh.mesh.positions[v], {1, 0, -4});
        }
    }
    EXPECT_EQ(shared, 1u) << "triangles share vertices, of which Assimp makes one for each";
}

TEST(MeshWeights, NoneWithoutBones) {
    EXPECT_TRUE(importMesh(testData("rig/unskinned.gltf")).weights.empty());
    EXPECT_TRUE(importMesh(testData("mesh/quads.obj")).weights.empty());
}

TEST(MeshWeights, RigGeometryReadByOsg) {
    const std::string path = written(*makeRig(3), "rig.osgt");
    const ImportedMesh mesh = importMesh(path);
    ASSERT_EQ(mesh.mesh.positions.size(), 4u);
    expectNear(mesh.mesh.positions[2], {6, 0, 2});
    const Weights weights = weightsOf(mesh);
    EXPECT_EQ(at(weights, "low", 2), 0.25);
    EXPECT_EQ(at(weights, "high", 2), 0.75);
    EXPECT_EQ(at(weights, "high", 3), 1.0);
    const RestSkeleton skeleton = importSkeleton(path);
    ASSERT_EQ(skeleton.joints.size(), 2u);
    expectNear(skeleton.joints[0].centre, {5, 0, 0});
    expectNear(skeleton.joints[1].centre, {5, 0, 1});
    EXPECT_EQ(skeleton.joints[1].parent, 0);
}

TEST(MeshWeights, RejectsRigGeometryWithInvalidVertex) {
    const std::string path = written(*makeRig(4), "stray_rig.osgt");
    expectError([&] { importMesh(path); }, "vertex 4, expected a vertex below 4");
}

TEST(MeshWeights, RejectsOsgSceneWithoutSkeleton) {
    const osg::ref_ptr<osg::Group> empty = new osg::Group;
    empty->addChild(new osg::MatrixTransform);
    const std::string path = written(*empty, "no_skeleton.osgt");
    expectError([&] { importSkeleton(path); }, "no skeleton");
}

TEST(MeshWeights, UsesOsgSkeletonWithBones) {
    const osg::ref_ptr<osg::Group> scene = new osg::Group;
    scene->addChild(new osgAnimation::Skeleton);
    const osg::ref_ptr<osgAnimation::Skeleton> skeleton = new osgAnimation::Skeleton;
    skeleton->addChild(new osgAnimation::Bone("spine"));
    scene->addChild(skeleton);
    const RestSkeleton read = importSkeleton(written(*scene, "second_skeleton.osgt"));
    ASSERT_EQ(read.joints.size(), 1u);
    EXPECT_EQ(read.joints[0].name, "spine");
}
