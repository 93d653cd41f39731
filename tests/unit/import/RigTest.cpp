// SPDX-License-Identifier: MIT
//
// The imported rig, posed by osgAnimation, compared with Assimp's own numbers: node matrices
// multiplied here, without any of our code in between.
//
// Skeletons, clips and props with unusable numbers are refused before anything plays them.
//
// Objects without a skin that clips animate by their own nodes, with no joint above.
#include "ExpectError.h"
#include "Figure.h"
#include "GltfBuilder.h"
#include "Notices.h"
#include "Paths.h"
#include "UpdateAt.h"

#include <osgSkinImport/ImportMesh>
#include <osgSkinImport/ImportMotion>
#include <osgSkinImport/ImportRig>
#include <osgSkinImport/ImportSkeleton>
#include <osgSkinRig/ClipPlayer>
#include <osgSkinRig/MakeAnimation>
#include <osgSkinRig/Motion>
#include <osgSkinRig/Prop>
#include <osgSkinRig/Retarget>
#include <osgSkinRig/SampledClip>

#include <assimp/Importer.hpp>
#include <assimp/config.h>
#include <assimp/scene.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <osg/MatrixTransform>
#include <osgAnimation/BasicAnimationManager>
#include <osgAnimation/Bone>
#include <osgAnimation/BoneMapVisitor>
#include <osgAnimation/RigGeometry>
#include <osgAnimation/Skeleton>
#include <osgDB/WriteFile>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <limits>
#include <map>
#include <string>
#include <vector>

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
    std::map<std::string, osg::Vec3d> bound; // body vertices are ordered by mesh, in node order
    std::size_t first = 0;
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
                    const glm::dvec3 rest = rig.body.mesh.positions[first + v];
                    const osg::Vec3d a = osg::Vec3d(double(p.x), double(p.y), double(p.z)) * theirs;
                    const osg::Vec3d b2 = osg::Vec3d(rest.x, rest.y, rest.z) * ours;
                    ASSERT_LT((a - b2).length(), tolerance)
                        << bone.mName.C_Str() << " vertex " << v;
                }
            }
            first += mesh.mNumVertices;
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

TEST_P(RigRoundTrip, BonesAgreeWithAssimpsNodes) {
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

TEST(ImportRig, KeepsTheBindPoseApartFromTheNodesPose) {
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
TEST(ImportRig, DoesNotAskAssimpForRigsInMeshes) {
    const std::string file = testing::TempDir() + "rigless_faces.obj";
    std::ofstream(file) << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 4/4 1/1 2/2\n";
    expectError([&] { osgSkin::importRig(file); }, "no mesh with bones");
    expectError([&] { osgSkin::importSkeleton(file); }, "no skeleton");
    expectError([&] { osgSkin::importMotion(file); }, "no animation");
}

/// Figures made of boxes have a mesh for each part, which hangs on the node that moves it.
TEST(ImportRig, RigidPartsFollowTheNodesThatCarryThem) {
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

TEST(ImportRig, RefusesWhatIsNotRigged) {
    expectError([] { osgSkin::importRig(testData("rig/unskinned.gltf")); }, "no mesh with bones");
    expectError([] { osgSkin::importRig(testData("mesh/quads.obj")); }, "no mesh with bones");
    expectError([] { osgSkin::importSkeleton(testData("mesh/quads.obj")); }, "no skeleton");
    expectError([] { osgSkin::importMotion(testData("mesh/quads.obj")); }, "no animation");
    expectError([] { osgSkin::importRig(testData("rig/nowhere.glb")); }, "nowhere.glb");
    expectError([] { osgSkin::importRig(testData("mesh/unknown.format")); },
                "are not read for this");
}

namespace {

using osgSkin::Clip;
using osgSkin::RestSkeleton;

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

Clip stillClip(const RestSkeleton& rig) {
    Clip clip;
    clip.name = "still";
    clip.frameTime = 0.1;
    clip.frames = 3;
    clip.joints = rig.joints.size();
    clip.rotations.assign(clip.frames * clip.joints, glm::dquat(1, 0, 0, 0));
    clip.rootPositions.assign(clip.frames, rig.joints[0].centre);
    return clip;
}

} // namespace

TEST(RigTrust, SkeletonsHaveFiniteTipsAndUnitAxes) {
    const RestSkeleton rig = makeFigure(30.0);
    rig.validate();
    const auto refuses = [&](const glm::dvec3& tip, const glm::dquat& frame, const char* why) {
        RestSkeleton spoilt = rig;
        spoilt.joints[2].tip = tip;
        spoilt.joints[4].frame = frame;
        expectError([&] { spoilt.validate(); }, why);
        expectError([&] { osgSkin::retarget(standStill(rig, 2), spoilt); }, why);
    };
    const glm::dquat none(1, 0, 0, 0);
    refuses({0, kNaN, 0}, none, "has a tip that is not finite");
    refuses({0, 0, -2e18}, none, "has a tip that is not finite");
    refuses({0, 18, 0}, {kNaN, 0, 0, 0}, "has axes whose rotation is not unit");
    refuses({0, 18, 0}, {0, 0, 0, 0}, "has axes whose rotation is not unit");
    refuses({0, 18, 0}, {2, 0, 0, 0}, "has axes whose rotation is not unit");
}

TEST(RigTrust, ClipsHaveUnitRotationsAndFinitePlaces) {
    const RestSkeleton rig = makeFigure(30.0);
    const auto refuses = [&](void (*spoil)(Clip&), const char* why) {
        Clip clip = stillClip(rig);
        spoil(clip);
        expectError([&] { osgSkin::makeAnimation(clip, rig); }, why);
        expectError([&] { osgSkin::SampledClip::create(clip, rig); }, why);
    };
    refuses(
        [](Clip& clip) {
            clip.rotations[13] = {0, 0, 0, 0};
        },
        "frame 1: joint \"Head\" has a rotation that is not unit");
    refuses([](Clip& clip) { clip.rotations[0].x = kNaN; }, "frame 0: joint \"Hips\"");
    refuses([](Clip& clip) { clip.rootPositions[2].y = kInf; }, "frame 2: the root's position");
    refuses([](Clip& clip) { clip.frameTime = kInf; }, "expected a positive frame time");
    refuses([](Clip& clip) { clip.frameTime = 1e308; }, "expected a positive frame time");
    EXPECT_EQ(osgSkin::SampledClip::create(stillClip(rig), rig)->sampleCount(), 3u);
}

TEST(RigTrust, PropsStayInRange) {
    const osgSkin::Motion way = standStill(RestSkeleton{{{"ball", -1, {1, 0, 0}, {}}}}, 2);
    const osg::ref_ptr<osgAnimation::Animation> animation = new osgAnimation::Animation;
    osgSkin::RetargetReport report;
    report.scale = 1e30;
    expectError([&] { osgSkin::makeProp("ball", {}, way, report, *animation); },
                "prop \"ball\": a place in the figure's space is not finite");
    EXPECT_TRUE(animation->getChannels().empty());
}

TEST(RigTrust, PlayersTakeNoDirectionThatIsNone) {
    RestSkeleton rig;
    rig.add("root", -1, glm::dvec3(0.0));
    Clip clip = stillClip(rig);
    for (std::size_t f = 0; f < clip.frames; ++f) clip.rootPositions[f] = {double(f), double(f), 0};
    const osg::ref_ptr<osgSkin::ClipPlayer> player = new osgSkin::ClipPlayer;
    const osg::ref_ptr<osg::MatrixTransform> shown = new osg::MatrixTransform;
    player->addRigid(shown, "root", osg::Matrixd());
    player->setLayer(0, {osgSkin::SampledClip::create(clip, rig), 0.1});
    player->setRoot(osgSkin::ClipPlayer::Root::InPlace, osg::Vec3d(kNaN, 0, 0));
    EXPECT_TRUE(player->pose());
    EXPECT_EQ(shown->getMatrix().getTrans(), osg::Vec3d(0, 1, 0)) << "up along y, as by default";
}

TEST(RigTrust, AMotionOfNoTimeIsRetargeted) {
    const RestSkeleton rig = makeFigure(30.0);
    osgSkin::Motion motion = standStill(rig, 5);
    motion.frameTime = 1e-300;
    osgSkin::RetargetReport report;
    EXPECT_EQ(osgSkin::retarget(motion, rig, {}, &report).frames, 5u);
}

namespace {

using test::GltfColumn;

/// A column with a separate box inside it that a clip moves up, or keeps at its position.
std::string saveBox(const std::string& path, const std::vector<double>& values) {
    GltfColumn column;
    column.bend();
    const nlohmann::json own = column.json["meshes"][0]["primitives"][0];
    column.json["meshes"].push_back(
        {{"name", "box"},
         {"primitives",
          {{{"attributes", {{"POSITION", own["attributes"]["POSITION"]}}},
            {"indices", own["indices"]}}}}});
    const std::size_t shown =
        column.node({{"name", "box"}, {"mesh", 1}, {"scale", {0.5, 0.5, 0.5}}});
    const std::size_t lift = column.node({{"name", "lift"},
                                          {"children", {shown}},
                                          {"translation", {0, 1, 0}},
                                          {"rotation", GltfColumn::turn(30)}});
    column.json["scenes"][0]["nodes"].push_back(lift);
    column.animate("bend", lift, path, {0.0, 1.0}, values);
    return column.save("moved_apart.gltf");
}

/// The warnings about a file.
std::string toldOf(const std::string& file) {
    const test::Notices notices;
    EXPECT_EQ(osgSkin::importRig(file).body.mesh.positions.size(), 48u);
    return notices.text();
}

} // namespace

TEST(AnimatedAttachments, ThingsThatStandStillAreToldOf) {
    const std::string told =
        "1 things that clips move beside the skeleton stand still, \"box\" among them";
    EXPECT_NE(toldOf(saveBox("translation", {0, 1, 0, 0, 2, 0})).find(told), std::string::npos);
    EXPECT_NE(toldOf(saveBox("rotation", GltfColumn::turns({30, 40}))).find(told),
              std::string::npos);
    EXPECT_NE(toldOf(saveBox("scale", {1, 1, 1, 1, 2, 1})).find(told), std::string::npos);
    EXPECT_EQ(toldOf(saveBox("translation", {0, 1, 0, 0, 1, 0})), "");
    EXPECT_EQ(toldOf(saveBox("rotation", GltfColumn::turns({30, 390}))), "");
    EXPECT_EQ(toldOf(saveBox("scale", {1, 1, 1, 1, 1, 1})), "");
}

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

TEST(MeshWeights, GltfSkinStandsInItsBindPoseUnderItsArmature) {
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
    EXPECT_EQ(shared, 2u) << "Assimp gives each triangle vertices of its own";
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

TEST(MeshWeights, RigGeometryThatNamesNoVertexIsRefused) {
    const std::string path = written(*makeRig(4), "stray_rig.osgt");
    expectError([&] { importMesh(path); }, "vertex 4, expected a vertex below 4");
}

TEST(MeshWeights, OsgSceneWithoutSkeletonIsRefused) {
    const osg::ref_ptr<osg::Group> empty = new osg::Group;
    empty->addChild(new osg::MatrixTransform);
    const std::string path = written(*empty, "no_skeleton.osgt");
    expectError([&] { importSkeleton(path); }, "no skeleton");
}

TEST(MeshWeights, OsgSkeletonIsTheOneWithBones) {
    const osg::ref_ptr<osg::Group> scene = new osg::Group;
    scene->addChild(new osgAnimation::Skeleton);
    const osg::ref_ptr<osgAnimation::Skeleton> skeleton = new osgAnimation::Skeleton;
    skeleton->addChild(new osgAnimation::Bone("spine"));
    scene->addChild(skeleton);
    const RestSkeleton read = importSkeleton(written(*scene, "second_skeleton.osgt"));
    ASSERT_EQ(read.joints.size(), 1u);
    EXPECT_EQ(read.joints[0].name, "spine");
}
