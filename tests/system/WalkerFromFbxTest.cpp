// SPDX-License-Identifier: MIT
// The page of simulators, done with an FBX file: a painted figure with clips, as artists' programs
// and public collections have them.
#include "Command.h"
#include "FindNodes.h"

#include <RatioWeights.h>

#include <osgSkin/DeformableSkin>
#include <osgSkinCharacter/LoadCharacter>
#include <osgSkinMotion/Walker>

#include <assimp/Exporter.hpp>
#include <assimp/scene.h>
#include <osg/MatrixTransform>
#include <osgDB/ReadFile>
#include <osgUtil/UpdateVisitor>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

namespace {

aiVector3D toAssimp(const glm::dvec3& v) {
    return {ai_real(v.x), ai_real(v.y), ai_real(v.z)};
}

/// Deletes by Assimp's destructors, as arrays that new[] made.
template <typename T>
T** arrayOf(const std::vector<T*>& items) {
    T** const array = new T*[items.size()];
    std::copy(items.begin(), items.end(), array);
    return array;
}

/// Assimp's scene of a character: one mesh with weights, a node for each joint, and its clips.
struct PaintedScene {
    explicit PaintedScene(const osgSkin::Character& character) : from(character) {
        addMesh();
        addNodes();
        std::vector<aiAnimation*> clips;
        for (const osgSkin::CharacterMotion& motion : from.motions)
            clips.push_back(clipOf(motion.clip));
        scene.mNumAnimations = unsigned(clips.size());
        scene.mAnimations = arrayOf(clips);
        scene.mMetaData = new aiMetadata;
        scene.mMetaData->Add("UnitScaleFactor", 100.0 * from.metresPerUnit()); // centimetres
    }

    void addMesh() {
        const osgSkin::SkinMesh& body = from.body.mesh;
        aiMesh* const mesh = new aiMesh;
        mesh->mName = "body";
        mesh->mPrimitiveTypes = aiPrimitiveType_TRIANGLE;
        mesh->mNumVertices = unsigned(body.positions.size());
        mesh->mVertices = new aiVector3D[mesh->mNumVertices];
        mesh->mNormals = new aiVector3D[mesh->mNumVertices];
        for (std::size_t v = 0; v < body.positions.size(); ++v)
            mesh->mVertices[v] = toAssimp(body.positions[v]);
        const std::vector<std::uint32_t> corners = body.triangles();
        mesh->mNumFaces = unsigned(corners.size() / 3);
        mesh->mFaces = new aiFace[mesh->mNumFaces];
        for (std::size_t c = 0; c < corners.size(); c += 3) {
            aiFace& face = mesh->mFaces[c / 3];
            face.mNumIndices = 3;
            face.mIndices = new unsigned int[3]{corners[c], corners[c + 1], corners[c + 2]};
            const auto& p = body.positions;
            const glm::dvec3 area =
                glm::cross(p[corners[c + 1]] - p[corners[c]], p[corners[c + 2]] - p[corners[c]]);
            for (std::size_t k = c; k < c + 3; ++k) mesh->mNormals[corners[k]] += toAssimp(area);
        }
        for (unsigned int v = 0; v < mesh->mNumVertices; ++v) mesh->mNormals[v].NormalizeSafe();
        addWeights(*mesh);
        scene.mNumMeshes = 1;
        scene.mMeshes = arrayOf<aiMesh>({mesh});
        scene.mNumMaterials = 1;
        scene.mMaterials = arrayOf<aiMaterial>({new aiMaterial});
    }

    void addWeights(aiMesh& mesh) const {
        const compare::SkinWeights painted = compare::weightsOf(from.binding);
        std::vector<std::vector<aiVertexWeight>> weights(from.rest.joints.size());
        for (std::uint32_t v = 0; v < painted.vertexCount(); ++v)
            for (std::uint32_t i = painted.first[v]; i < painted.first[v + 1]; ++i)
                weights[jointOf(painted.entries[i].joint)].emplace_back(
                    v, float(painted.entries[i].weight));
        std::vector<aiBone*> bones;
        for (std::size_t j = 0; j < weights.size(); ++j) {
            if (weights[j].empty()) continue;
            bones.push_back(new aiBone);
            bones.back()->mName = from.rest.joints[j].name;
            bones.back()->mNumWeights = unsigned(weights[j].size());
            bones.back()->mWeights = new aiVertexWeight[weights[j].size()];
            std::copy(weights[j].begin(), weights[j].end(), bones.back()->mWeights);
            aiMatrix4x4::Translation(-toAssimp(from.rest.joints[j].centre),
                                     bones.back()->mOffsetMatrix);
        }
        mesh.mNumBones = unsigned(bones.size());
        mesh.mBones = arrayOf(bones);
    }

    std::size_t jointOf(std::size_t bound) const {
        return std::size_t(from.rest.find(from.binding.joints[bound].name));
    }

    void addNodes() {
        std::vector<aiNode*> nodes;
        for (const osgSkin::RestJoint& joint : from.rest.joints) {
            nodes.push_back(new aiNode(joint.name));
            aiMatrix4x4::Translation(toAssimp(restOf(joint)), nodes.back()->mTransformation);
            if (joint.parent >= 0) nodes[std::size_t(joint.parent)]->addChildren(1, &nodes.back());
        }
        aiNode* mesh = new aiNode("body");
        mesh->mNumMeshes = 1;
        mesh->mMeshes = new unsigned int[1]{0};
        scene.mRootNode = new aiNode("scene");
        scene.mRootNode->addChildren(1, &mesh);
        scene.mRootNode->addChildren(1, nodes.data());
    }

    /// Relative to its parent.
    glm::dvec3 restOf(const osgSkin::RestJoint& joint) const {
        return joint.parent < 0 ? joint.centre
                                : joint.centre - from.rest.joints[std::size_t(joint.parent)].centre;
    }

    aiAnimation* clipOf(const osgSkin::Clip& clip) const {
        std::vector<aiNodeAnim*> channels;
        for (std::size_t j = 0; j < clip.joints; ++j) {
            aiNodeAnim* const channel = new aiNodeAnim;
            channel->mNodeName = from.rest.joints[j].name;
            channel->mNumPositionKeys = channel->mNumRotationKeys = unsigned(clip.frames);
            channel->mPositionKeys = new aiVectorKey[clip.frames];
            channel->mRotationKeys = new aiQuatKey[clip.frames];
            channel->mNumScalingKeys = 1;
            channel->mScalingKeys = new aiVectorKey[1]{{0.0, {1, 1, 1}}};
            for (std::size_t f = 0; f < clip.frames; ++f) {
                const double time = clip.frameTime * double(f);
                const glm::dvec3 at = j == 0 ? clip.rootPositions[f] : restOf(from.rest.joints[j]);
                const glm::dquat& q = clip.rotations[f * clip.joints + j];
                channel->mPositionKeys[f] = {time, toAssimp(at)};
                channel->mRotationKeys[f] = {
                    time, {ai_real(q.w), ai_real(q.x), ai_real(q.y), ai_real(q.z)}};
            }
            channels.push_back(channel);
        }
        aiAnimation* const result = new aiAnimation;
        result->mName = clip.name;
        result->mTicksPerSecond = 1.0; // its writer takes ticks for seconds
        result->mDuration = clip.frameTime * double(clip.frames - 1);
        result->mNumChannels = unsigned(channels.size());
        result->mChannels = arrayOf(channels);
        return result;
    }

    const osgSkin::Character& from;
    aiScene scene;
};

/// How far the points of the soles that touch the floor slide while a walker is carried along, as a
/// share of its way.
double slideOf(osg::Node& walker, double speed) {
    constexpr double kStep = 1.0 / 60.0, kFloor = 0.01;
    const osg::ref_ptr<osg::MatrixTransform> place = new osg::MatrixTransform;
    place->addChild(&walker);
    const auto found = test::findNodes<osgSkin::DeformableSkin>(*place);
    const auto verticesOf = [&] {
        std::vector<osg::Vec3d> all;
        for (const auto& skin : found)
            for (const osg::Vec3& v : static_cast<const osg::Vec3Array&>(
                     *skin.node->getDeformedGeometry()->getVertexArray()))
                all.push_back(osg::Vec3d(v) * skin.toWorld);
        return all;
    };
    const std::vector<osg::Vec3d> standing = verticesOf();
    std::vector<osg::Vec3d> before;
    double way = 0.0, slide = 0.0;
    int touching = 0;
    osgUtil::UpdateVisitor update;
    const osg::ref_ptr<osg::FrameStamp> stamp = new osg::FrameStamp;
    update.setFrameStamp(stamp);
    for (int frame = 0; frame < 240; ++frame) {
        way = speed * kStep * frame;
        place->setMatrix(osg::Matrix::translate(way, 0.0, 0.0));
        stamp->setFrameNumber(unsigned(frame));
        stamp->setSimulationTime(kStep * frame);
        place->accept(update);
        std::vector<osg::Vec3d> now = verticesOf();
        for (osg::Vec3d& v : now) v.x() += way;
        for (const double side : {-1.0, 1.0}) {
            double least = std::numeric_limits<double>::infinity();
            for (std::size_t v = 0; v < before.size(); ++v)
                if (side * standing[v].y() > 0.0 && std::max(before[v].z(), now[v].z()) < kFloor)
                    least = std::min(
                        least, std::hypot(now[v].x() - before[v].x(), now[v].y() - before[v].y()));
            if (!std::isfinite(least)) continue;
            slide += least;
            ++touching;
        }
        before = now;
    }
    EXPECT_GT(touching, 100);
    return slide / way;
}

} // namespace

TEST(WalkerFromFbx, CommandsOfThePageMakeWalkersWhoseFeetStay) {
    const std::string folder = test::makeTestFolder();
    const osgSkin::Character pedestrian = osgSkin::loadCharacter(OSGSKIN_DATA "/pedestrian.skin");
    const std::string fbx = folder + "/walker.fbx", body = folder + "/body.fbx";
    PaintedScene painted(pedestrian);
    Assimp::Exporter exporter;
    ASSERT_EQ(exporter.Export(&painted.scene, "fbxa", fbx), AI_SUCCESS)
        << exporter.GetErrorString();
    painted.scene.mNumAnimations = 0;
    ASSERT_EQ(exporter.Export(&painted.scene, "fbxa", body), AI_SUCCESS);
    painted.scene.mNumAnimations = unsigned(pedestrian.motions.size());

    const test::CommandResult page = test::runCommand(
        "python3 '" OSGSKIN_SOURCE "/tests/system/tutorial.py' '" OSGSKIN_SOURCE
        "/examples/simulators/README.md' '" OSGSKIN_SOURCE "' '" OSGSKIN_BUILD "' page '" +
            fbx + "' '" + body + "'",
        folder);
    ASSERT_EQ(page.status, 0) << page.out << page.err;
    for (const char* name : {"walkman.osgb", "walker.osgb", "body.osgb"}) {
        for (const double speed : {1.4, 3.0}) {
            const std::string file = folder + "/page/clone/" + name;
            const osg::ref_ptr<osg::Node> walker = osgDB::readRefNodeFile(file);
            auto* const walking = dynamic_cast<osgSkin::Walker*>(walker.get());
            ASSERT_NE(walking, nullptr) << name;
            walking->setOwnPoseSize(0.0); // no camera looks at it
            const osg::BoundingSphere bound = walker->getBound();
            EXPECT_NEAR(bound.center().z(), 0.9, 0.05) << name; // upright, in metres
            EXPECT_LT(slideOf(*walker, speed), 0.02) << name << " at " << speed << " m/s";
        }
    }
}
