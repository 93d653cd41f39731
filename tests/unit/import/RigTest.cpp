// SPDX-License-Identifier: MIT
// The imported rig, posed by osgAnimation, compared with Assimp's own numbers: node matrices
// multiplied here, without any of our code in between.
#include "ExpectError.h"
#include "GltfBuilder.h"
#include "Paths.h"
#include "UpdateAt.h"

#include <osgSkin/GlmOsg>
#include <osgSkinImport/ImportMotion>
#include <osgSkinImport/ImportRig>
#include <osgSkinImport/ImportSkeleton>

#include <assimp/Importer.hpp>
#include <assimp/config.h>
#include <assimp/scene.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <osgAnimation/BasicAnimationManager>
#include <osgAnimation/Bone>
#include <osgAnimation/BoneMapVisitor>
#include <osgAnimation/Skeleton>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <map>
#include <string>

using namespace osgSkin;

namespace {

/// OSG's matrices are the transposes of Assimp's.
osg::Matrixd toOsg(const aiMatrix4x4& m) {
    osg::Matrixd result;
    for (unsigned row = 0; row < 4; ++row)
        for (unsigned column = 0; column < 4; ++column)
            result(int(column), int(row)) = double(m[row][column]);
    return result;
}

aiVector3D blend(const aiVector3D& a, const aiVector3D& b, double share) {
    return a + (b - a) * float(share);
}

aiQuaternion blend(aiQuaternion a, aiQuaternion b, double share) {
    aiQuaternion result;
    aiQuaternion::Interpolate(result, a.Normalize(), b.Normalize(), float(share));
    return result.Normalize();
}

/// A track's value between its keys, constant before the first and after the last.
template <typename Key>
auto valueAt(const Key* keys, unsigned count, double time) {
    unsigned k = 0;
    while (k + 1 < count && keys[k + 1].mTime <= time) ++k;
    if (k + 1 == count || time <= keys[k].mTime) return keys[k].mValue;
    const double share = (time - keys[k].mTime) / (keys[k + 1].mTime - keys[k].mTime);
    return blend(keys[k].mValue, keys[k + 1].mValue, share);
}

osg::Matrixd localAt(const aiNode& node, const aiAnimation* animation, double time) {
    if (animation != nullptr)
        for (unsigned c = 0; c < animation->mNumChannels; ++c) {
            const aiNodeAnim& track = *animation->mChannels[c];
            if (track.mNodeName != node.mName) continue;
            const aiVector3D t = valueAt(track.mPositionKeys, track.mNumPositionKeys, time);
            const aiQuaternion q = valueAt(track.mRotationKeys, track.mNumRotationKeys, time);
            const aiVector3D s = valueAt(track.mScalingKeys, track.mNumScalingKeys, time);
            return osg::Matrixd::scale(double(s.x), double(s.y), double(s.z)) *
                   osg::Matrixd::rotate(
                       osg::Quat(double(q.x), double(q.y), double(q.z), double(q.w))) *
                   osg::Matrixd::translate(double(t.x), double(t.y), double(t.z));
        }
    return toOsg(node.mTransformation);
}

using Places = std::map<std::string, osg::Matrixd>;

/// Follows mParent: the bones of Half-Life's models are listed as children of another node.
Places placesAt(const aiScene& scene, const aiAnimation* animation, double time) {
    Places result;
    const std::function<void(const aiNode&)> walk = [&](const aiNode& node) {
        osg::Matrixd place;
        for (const aiNode* at = &node; at != nullptr; at = at->mParent)
            place = place * localAt(*at, animation, time);
        result.emplace(node.mName.C_Str(), place);
        for (unsigned c = 0; c < node.mNumChildren; ++c) walk(*node.mChildren[c]);
    };
    walk(*scene.mRootNode);
    return result;
}

double firstKey(const aiAnimation& animation) {
    double first = INFINITY;
    for (unsigned c = 0; c < animation.mNumChannels; ++c) {
        const aiNodeAnim& track = *animation.mChannels[c];
        if (track.mNumPositionKeys > 0) first = std::min(first, track.mPositionKeys[0].mTime);
        if (track.mNumRotationKeys > 0) first = std::min(first, track.mRotationKeys[0].mTime);
        if (track.mNumScalingKeys > 0) first = std::min(first, track.mScalingKeys[0].mTime);
    }
    return first;
}

struct Player {
    explicit Player(const osgSkin::ImportedRig& rig)
        : manager(new osgAnimation::BasicAnimationManager), root(new osg::Group) {
        root->addChild(rig.skeleton);
        root->setUpdateCallback(manager);
        for (const auto& animation : rig.animations) manager->registerAnimation(animation);
        osgAnimation::BoneMapVisitor visitor;
        rig.skeleton->accept(visitor);
        bones = visitor.getBoneMap();
    }

    osg::ref_ptr<osgAnimation::BasicAnimationManager> manager;
    osg::ref_ptr<osg::Group> root;
    osgAnimation::BoneMap bones;
};

/// Expects bones at the positions of Assimp's nodes, and bound skin at the positions that Assimp's
/// bones give.
void expectPose(const osgSkin::ImportedRig& rig, Player& player, const aiScene& scene,
                const Places& places, double tolerance) {
    for (const osgSkin::RestJoint& joint : rig.rest.joints) {
        const osg::Matrixd& expected = places.at(joint.name);
        const osg::Matrixd found = player.bones.at(joint.name)->getMatrixInSkeletonSpace();
        for (int row = 0; row < 3; ++row)
            for (int column = 0; column < 3; ++column)
                ASSERT_NEAR(found(row, column), expected(row, column),
                            1e-5 * (1.0 + std::abs(expected(row, column))))
                    << joint.name;
        ASSERT_LT((found.getTrans() - expected.getTrans()).length(), tolerance) << joint.name;
    }
    const std::function<void(const aiNode&)> walk = [&](const aiNode& node) {
        for (unsigned m = 0; m < node.mNumMeshes; ++m) {
            const aiMesh& mesh = *scene.mMeshes[node.mMeshes[m]];
            for (unsigned b = 0; b < mesh.mNumBones; ++b) {
                const aiBone& bone = *mesh.mBones[b];
                const auto found = player.bones.find(bone.mName.C_Str());
                if (found == player.bones.end()) continue;
                const osg::Matrixd theirs =
                    toOsg(bone.mOffsetMatrix) * places.at(bone.mName.C_Str());
                const osg::Matrixd ours = found->second->getInvBindMatrixInSkeletonSpace() *
                                          found->second->getMatrixInSkeletonSpace();
                for (unsigned w = 0; w < bone.mNumWeights; w += 1 + bone.mNumWeights / 20) {
                    const unsigned v = bone.mWeights[w].mVertexId;
                    const aiVector3D p = mesh.mVertices[v];
                    const osg::Vec3d a = osg::Vec3d(double(p.x), double(p.y), double(p.z)) * theirs;
                    double nearest = INFINITY; // vertices that are equal are joined
                    for (const BoneWeights& weights : rig.body.weights) {
                        if (weights.bone != bone.mName.C_Str()) continue;
                        for (const BoneWeights::Entry& entry : weights.entries) {
                            const osg::Vec3d rest =
                                osgSkin::toOsg(rig.body.mesh.positions[entry.vertex]);
                            nearest = std::min(nearest, (rest * ours - a).length());
                        }
                    }
                    ASSERT_LT(nearest, tolerance) << bone.mName.C_Str() << " vertex " << v;
                }
            }
        }
        for (unsigned c = 0; c < node.mNumChildren; ++c) walk(*node.mChildren[c]);
    };
    walk(*scene.mRootNode);
}

struct Case {
    const char* name;
    const char* file; ///< of tests/data, or absolute
    std::size_t clips;
};

std::ostream& operator<<(std::ostream& out, const Case& c) {
    return out << c.name;
}

#define MODELS "/usr/share/assimp/models/"
const Case kCases[] = {
    {"gltf", "rig/tube.gltf", 2},
    {"gltf_posed", "rig/posed.gltf", 2},
    {"md5", "rig/strip.md5mesh", 0},
    {"collada", MODELS "Collada/box_nested_animation.dae", 1},
    {"fbx", MODELS "FBX/animation_with_skeleton.fbx", 1},
    {"fbx_huesitos", MODELS "FBX/huesitos.fbx", 1},
    {"mdl_man", MODELS "MDL/MDL (HL1)/man.mdl", 6},
    {"x", MODELS "X/Testwuson.X", 3},
    {"gltf_simple_skin", MODELS "glTF2/simple_skin/simple_skin.gltf", 1},
};

class RigRoundTrip : public testing::TestWithParam<Case> {};

} // namespace

TEST_P(RigRoundTrip, BonesMatchAssimp) {
    const Case& c = GetParam();
    const std::string path = c.file[0] == '/' ? c.file : testData(c.file);
    OSGSKIN_NEEDS(path);
    if (path.find(".gltf") != std::string::npos && !isAssimp52())
        GTEST_SKIP() << "needs Assimp 5.2, which keeps the order of vertices";
    const osgSkin::ImportedRig rig = osgSkin::importRig(path);
    Assimp::Importer importer;
    importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);
    importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_PRESERVE_PIVOTS, false);
    const aiScene* scene = importer.ReadFile(path, 0);
    ASSERT_NE(scene, nullptr);
    ASSERT_EQ(rig.animations.size(), c.clips);
    double size = rig.body.mesh.size();
    for (const osgSkin::RestJoint& joint : rig.rest.joints)
        size = std::max(size, glm::length(joint.centre));
    const double tolerance = 1e-5 * size;

    Player player(rig);
    expectPose(rig, player, *scene, placesAt(*scene, nullptr, 0.0), tolerance);
    if (HasFatalFailure()) return;
    test::updateAt(*player.root, 0.0);
    expectPose(rig, player, *scene, placesAt(*scene, nullptr, 0.0), tolerance);
    if (HasFatalFailure()) return;

    double start = 0.0;
    for (std::size_t a = 0; a < rig.animations.size(); ++a) {
        SCOPED_TRACE(rig.animations[a]->getName());
        const aiAnimation& animation = *scene->mAnimations[a];
        const double rate = animation.mTicksPerSecond > 0.0 ? animation.mTicksPerSecond : 25.0;
        player.manager->playAnimation(rig.animations[a]);
        const double zero = firstKey(animation);
        const double duration = rig.animations[a]->getDuration();
        for (double share = 0.0; share < 0.99; share += 0.07) { // the loop's end equals its start
            const double seconds = share * duration;
            test::updateAt(*player.root, start + seconds);
            expectPose(rig, player, *scene, placesAt(*scene, &animation, zero + seconds * rate),
                       tolerance);
            if (HasFatalFailure()) return;
        }
        player.manager->stopAnimation(rig.animations[a]);
        start += 1000.0;
        test::updateAt(*player.root, start); // the next one starts here
    }
}

INSTANTIATE_TEST_SUITE_P(Files, RigRoundTrip, testing::ValuesIn(kCases),
                         [](const auto& tested) { return std::string(tested.param.name); });

TEST(ImportRig, BindPoseDiffersFromNodePose) {
    const osgSkin::ImportedRig rig = osgSkin::importRig(testData("rig/posed.gltf"));
    ASSERT_EQ(rig.rest.joints.size(), 2u);
    EXPECT_NEAR(rig.rest.joints[1].centre.z, 1.0, 1e-6);
    EXPECT_EQ(rig.metresPerUnit, 1.0);
    const osg::Vec3d up = osg::Matrixd::transform3x3(osg::Vec3d(0, 1, 0), rig.toWorld);
    EXPECT_LT((up - osg::Vec3d(0, 0, 1)).length(), 1e-12);
    ASSERT_EQ(rig.body.parts.size(), 1u);
    EXPECT_NE(rig.body.parts[0].geometry->getStateSet(), nullptr);
    EXPECT_EQ(rig.animations[0]->getName(), "wave");
    EXPECT_NEAR(rig.animations[0]->getDuration(), 1.0, 1e-6);
}

/// Assimp's OBJ reader leaks the faces that end at a missing vertex.
TEST(ImportRig, RejectsMeshFormatsWithoutAssimp) {
    const std::string file = testing::TempDir() + "rigless_faces.obj";
    std::ofstream(file) << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 4/4 1/1 2/2\n";
    expectError([&] { osgSkin::importRig(file); }, "no mesh with bones");
    expectError([&] { osgSkin::importSkeleton(file); }, "no skeleton");
    expectError([&] { osgSkin::importMotion(file); }, "no animation");
}

/// Figures made of boxes have a mesh for each part, which hangs on the node that moves it.
TEST(ImportRig, RigidPartsFollowTheirNodes) {
    test::GltfColumn column;
    column.json.erase("skins");
    column.json["nodes"][column.meshNode].erase("skin");
    column.attributes().erase("JOINTS_0");
    column.attributes().erase("WEIGHTS_0");
    const std::size_t part = column.node({{"mesh", 0}, {"translation", {0, 2, 0}}});
    column.json["nodes"][column.joints[1]]["children"] = {column.joints[2], part};
    column.json["scenes"][0]["nodes"] = {column.joints[0]};
    const auto save = [&](const std::string& file) {
        column.json.erase("buffers"); // of an earlier file
        return column.save(file);
    };
    const auto check = [&](const std::string& file, std::size_t clips) {
        const ImportedRig rig = osgSkin::importRig(save(file));
        EXPECT_EQ(rig.animations.size(), clips);
        ASSERT_EQ(rig.body.weights.size(), 1u);
        EXPECT_EQ(rig.body.weights[0].bone, "middle");
        EXPECT_EQ(rig.body.weights[0].entries.size(), rig.body.mesh.positions.size());
        EXPECT_NEAR(rig.body.mesh.positions[0].y, 1.0 + 2.0 + column.places[1], 1e-6);
    };
    expectError([&] { osgSkin::importRig(save("still_parts.gltf")); }, "no mesh with bones");
    column.bend();
    check("moved_parts.gltf", 1);
    column.json.erase("animations");
    column.json["extensions"]["VRMC_vrm"]["humanoid"]["humanBones"] = {
        {"chest", {{"node", column.joints[1]}}}};
    check("human_parts.vrm", 0);
    column.json["extensions"] = {
        {"VRM", {{"humanoid", {{"humanBones", {{{"bone", "chest"}, {"node", 1}}}}}}}}};
    check("human_parts0.vrm", 0);

    // Meshes that no joint carries follow the root.
    const std::size_t stand = column.node({{"mesh", 0}});
    column.json["scenes"][0]["nodes"] = {column.joints[0], stand};
    const ImportedRig rig = osgSkin::importRig(save("standing_part.vrm"));
    ASSERT_EQ(rig.body.weights.size(), 2u);
    EXPECT_EQ(rig.body.weights[0].entries.size(), rig.body.weights[1].entries.size());
    EXPECT_EQ(rig.rest.joints[0].name, rig.body.weights[1].bone);
}

TEST(ImportRig, RejectsFilesWithoutRig) {
    expectError([] { osgSkin::importRig(testData("rig/unskinned.gltf")); }, "no mesh with bones");
    expectError([] { osgSkin::importRig(testData("mesh/quads.obj")); }, "no mesh with bones");
    expectError([] { osgSkin::importSkeleton(testData("mesh/quads.obj")); }, "no skeleton");
    expectError([] { osgSkin::importMotion(testData("mesh/quads.obj")); }, "no animation");
    expectError([] { osgSkin::importRig(testData("rig/nowhere.glb")); }, "nowhere.glb");
    expectError([] { osgSkin::importRig(testData("mesh/unknown.format")); },
                "are not read as rigs or motions");
    for (const char* name : {"run.asf", "run.amc", "run.c3d", "run.trc"}) {
        const std::string path = testing::TempDir() + name;
        std::ofstream(path) << "recorded";
        expectError([&] { osgSkin::importMotion(path); }, "Blender do");
    }
}
