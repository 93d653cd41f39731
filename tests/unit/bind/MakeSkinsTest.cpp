// SPDX-License-Identifier: GPL-3.0-or-later
#include "RigScene.h"
#include "Shapes.h"

#include <osgSkin/Error>
#include <osgSkin/GlmOsg>
#include <osgSkinBind/AttachSkin>
#include <osgSkinBind/Bind>
#include <osgSkinBind/MakeSkins>

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

using namespace osgSkin;
using namespace rigs;

namespace {

/// A cylinder over three bones, the last one rigid, in two parts: its lower and its upper half.
struct PartedBody {
    SkinMesh mesh = shapes::cylinder();
    Binding binding;
    RigidSplit split;
    std::vector<MeshPart> parts;

    PartedBody() {
        RestSkeleton skeleton = shapes::chainAlongY({0.6, 3.0, 5.5}, 6.5);
        for (std::size_t j = 0; j < 3; ++j) skeleton.joints[j].name = "bone" + std::to_string(j);
        BindOptions options;
        options.rigid = std::vector<std::string>{"bone2"};
        binding = bind(mesh, skeleton, options);
        split = splitRigid(mesh, binding, {"bone2"});
        parts = {makePart(0.0, 3.0), makePart(3.0, 100.0)};
    }

    /// The faces whose first corner is between these heights.
    MeshPart makePart(double low, double high) const {
        MeshPart part;
        const osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array,
                                           normals =
                                               new osg::Vec3Array(osg::Array::BIND_PER_VERTEX);
        for (const glm::dvec3& p : mesh.positions) {
            vertices->push_back(osg::Vec3(toOsg(p)));
            normals->push_back(osg::Vec3(0, 1, 0));
        }
        part.sourceVertex.resize(mesh.positions.size());
        std::iota(part.sourceVertex.begin(), part.sourceVertex.end(), 0u);
        const osg::ref_ptr<osg::DrawElementsUInt> elements =
            new osg::DrawElementsUInt(GL_TRIANGLES);
        std::size_t corner = 0;
        for (std::uint32_t f = 0; f < mesh.faceSizes.size(); ++f) {
            const std::uint32_t* corners = &mesh.faceVertices[corner];
            corner += mesh.faceSizes[f];
            const double height = mesh.positions[corners[0]].y;
            if (height < low || height >= high) continue;
            for (std::uint32_t k = 2; k < mesh.faceSizes[f]; ++k) {
                for (const std::uint32_t c : {corners[0], corners[k - 1], corners[k]})
                    elements->push_back(c);
                part.sourceFace.push_back(f);
            }
        }
        part.geometry = new osg::Geometry;
        part.geometry->setVertexArray(vertices);
        part.geometry->setNormalArray(normals);
        part.geometry->addPrimitiveSet(elements);
        return part;
    }
};

std::size_t triangles(const PartedBody& body) {
    return body.parts[0].sourceFace.size() + body.parts[1].sourceFace.size();
}

} // namespace

TEST(MakeSkins, KeepsEveryFaceWithoutASkeleton) {
    const PartedBody body;
    const SkinParts made = makeSkins(body.mesh, body.parts, body.binding, body.split);
    ASSERT_EQ(made.skins.size(), 2u);
    ASSERT_EQ(made.rigids.size(), 1u) << "the lower half has no rigid face";
    EXPECT_EQ(made.rigids[0].joint, "bone2");
    std::size_t faces = made.rigids[0].part.sourceFace.size();
    for (const SkinParts::Skin& skin : made.skins) {
        faces += skin.part.sourceFace.size();
        EXPECT_EQ(skin.drawable->getNumParents(), 0u);
        EXPECT_NE(skin.drawable->getUpdateCallback(), nullptr);
        const auto& model = *skin.drawable->getModel();
        ASSERT_EQ(model.vertexCount(), skin.part.sourceVertex.size());
        for (std::uint32_t v = 0; v < model.vertexCount(); ++v) {
            EXPECT_EQ(model.order()[v], v) << "not in the order of the deformation";
            EXPECT_EQ(model.positions()[v],
                      glm::vec3(body.mesh.positions[skin.part.sourceVertex[v]]));
        }
    }
    EXPECT_EQ(faces, triangles(body));
}

TEST(MakeSkins, RejectsMismatchedInput) {
    const PartedBody body;
    EXPECT_THROW(makeSkins(shapes::cylinder(2.0), body.parts, body.binding, body.split), Error);
    RigidSplit shorter = body.split;
    shorter.faceJoint.pop_back();
    EXPECT_THROW(makeSkins(body.mesh, body.parts, body.binding, shorter), Error);
    RigidSplit strange = body.split;
    strange.faceJoint.back() = 3;
    EXPECT_THROW(makeSkins(body.mesh, body.parts, body.binding, strange), Error);
    std::vector<MeshPart> parts = body.parts;
    parts[1].sourceVertex.pop_back();
    EXPECT_THROW(makeSkins(body.mesh, parts, body.binding, body.split), Error);
    parts[1].geometry = nullptr;
    EXPECT_THROW(makeSkins(body.mesh, parts, body.binding, body.split), Error);
    parts[1] = body.parts[1];
    parts[1].morphs = {{"smile", 0.0f, {1000000}, {glm::vec3(1.0f)}, {}, {}}};
    EXPECT_THROW(makeSkins(body.mesh, parts, body.binding, body.split), Error);
    parts[1].morphs = {{"smile", 0.0f, {1, 2}, {glm::vec3(1.0f)}, {}, {}}};
    EXPECT_THROW(makeSkins(body.mesh, parts, body.binding, body.split), Error);
    Binding broken = body.binding;
    broken.influences[2].joint = 9;
    EXPECT_THROW(makeSkins(body.mesh, body.parts, broken, body.split), Error);
}

TEST(MakeSkins, RejectsPartsWithIndicesOutOfRange) {
    const PartedBody body;
    const auto refuses = [&](void (*spoil)(MeshPart&, osg::DrawElementsUInt&)) {
        std::vector<MeshPart> parts = {body.makePart(0.0, 100.0)};
        spoil(parts[0],
              static_cast<osg::DrawElementsUInt&>(*parts[0].geometry->getPrimitiveSet(0)));
        EXPECT_THROW(makeSkins(body.mesh, parts, body.binding, body.split), Error);
    };
    refuses([](MeshPart&, osg::DrawElementsUInt& elements) { elements[4] = 1000000; });
    refuses([](MeshPart&, osg::DrawElementsUInt& elements) { elements.pop_back(); });
    refuses([](MeshPart&, osg::DrawElementsUInt& elements) { elements.resize(9); });
    refuses(
        [](MeshPart&, osg::DrawElementsUInt& elements) { elements.setMode(GL_TRIANGLE_STRIP); });
    refuses([](MeshPart& part, osg::DrawElementsUInt&) { part.sourceFace.resize(3); });
    refuses([](MeshPart& part, osg::DrawElementsUInt&) { part.geometry->setNormalArray(nullptr); });
    refuses([](MeshPart& part, osg::DrawElementsUInt&) { part.geometry->setVertexArray(nullptr); });
}

namespace {

/// Parts whose target "odd" moves every other vertex of the mesh by its index.
PartedBody morphingBody() {
    PartedBody body;
    for (MeshPart& part : body.parts) {
        MorphTarget& odd = part.morphs.emplace_back();
        odd.name = "odd";
        odd.initial = 0.5f;
        for (std::uint32_t v = 1; v < part.sourceVertex.size(); v += 2) {
            odd.vertices.push_back(v);
            odd.positions.emplace_back(float(v), 0.0f, 0.0f);
            odd.normals.emplace_back(0.0f, 0.0f, float(v));
        }
    }
    return body;
}

void expectOdd(const MorphTarget& odd, const std::vector<std::uint32_t>& source) {
    EXPECT_EQ(odd.name, "odd");
    EXPECT_EQ(odd.initial, 0.5f);
    EXPECT_EQ(odd.vertices.size(),
              std::size_t(std::count_if(source.begin(), source.end(),
                                        [](std::uint32_t v) { return v % 2 == 1; })));
    for (std::size_t i = 0; i < odd.vertices.size(); ++i) {
        const auto vertex = float(source.at(odd.vertices[i]));
        EXPECT_EQ(odd.positions[i], glm::vec3(vertex, 0.0f, 0.0f));
        EXPECT_EQ(odd.normals[i], glm::vec3(0.0f, 0.0f, vertex));
    }
}

} // namespace

TEST(MakeSkins, SplitsMorphTargets) {
    const PartedBody body = morphingBody();
    const SkinParts made = makeSkins(body.mesh, body.parts, body.binding, body.split);
    ASSERT_EQ(made.skins.size(), 2u);
    for (const SkinParts::Skin& skin : made.skins) {
        const osgSkin::MorphTargets* targets = skin.drawable->getMorphTargets();
        ASSERT_NE(targets, nullptr);
        ASSERT_EQ(targets->targets().size(), 1u);
        expectOdd(targets->targets()[0], skin.part.sourceVertex);
    }
    ASSERT_EQ(made.rigids.size(), 1u);
    ASSERT_EQ(made.rigids[0].part.morphs.size(), 1u);
    expectOdd(made.rigids[0].part.morphs[0], made.rigids[0].part.sourceVertex);
}

TEST(PlaceSkins, RigidPartsWithMorphTargetsCanMorph) {
    const PartedBody body = morphingBody();
    rigs::Scene scene;
    const AttachedSkin placed =
        placeSkins(*scene.skeleton, makeSkins(body.mesh, body.parts, body.binding, body.split));
    ASSERT_EQ(placed.rigids.size(), 1u);
    auto* skin = dynamic_cast<osgSkin::DeformableSkin*>(placed.rigids[0].node->getChild(0));
    ASSERT_NE(skin, nullptr);
    EXPECT_EQ(skin->getUpdateCallback(), nullptr);
    const std::vector<std::uint32_t>& source = placed.rigids[0].part.sourceVertex;
    for (const float weight : {0.5f, 0.75f}) {
        ASSERT_TRUE(skin->setMorph("odd", weight));
        const auto& drawn =
            dynamic_cast<const osg::Vec3Array&>(*skin->getDeformedGeometry()->getVertexArray());
        ASSERT_EQ(drawn.size(), source.size());
        for (std::size_t v = 0; v < source.size(); ++v) {
            glm::dvec3 expected = body.mesh.positions[source[v]];
            if (source[v] % 2 == 1) expected.x += (double(weight) - 0.5) * source[v];
            EXPECT_LT((osg::Vec3d(drawn[v]) - toOsg(expected)).length(), 1e-4) << source[v];
        }
    }
}

TEST(PlaceSkins, AddsSkinsToTheSkeletonAndRigidPartsToBones) {
    const PartedBody body;
    rigs::Scene scene;
    const unsigned int before = scene.skeleton->getNumChildren();
    const SkinParts made = makeSkins(body.mesh, body.parts, body.binding, body.split);
    const AttachedSkin placed = placeSkins(*scene.skeleton, made);
    ASSERT_EQ(placed.skins.size(), 2u);
    EXPECT_EQ(scene.skeleton->getNumChildren(), before + 2);
    for (unsigned int i = 0; i < 2; ++i)
        EXPECT_EQ(scene.skeleton->getChild(before + i), placed.skins[i].drawable.get());
    ASSERT_EQ(placed.rigids.size(), 1u);
    EXPECT_EQ(placed.rigids[0].bone, scene.bones[2]);
    EXPECT_TRUE(scene.bones[2]->containsNode(placed.rigids[0].node));
}

/// Such as a rider's, with bones of the same names.
TEST(PlaceSkins, IgnoresNestedSkeletons) {
    const PartedBody body;
    rigs::Scene scene, rider;
    scene.bones[2]->addChild(rider.skeleton);
    const AttachedSkin placed =
        placeSkins(*scene.skeleton, makeSkins(body.mesh, body.parts, body.binding, body.split));
    ASSERT_EQ(placed.rigids.size(), 1u);
    EXPECT_EQ(placed.rigids[0].bone, scene.bones[2]);
}

TEST(PlaceSkins, MissingBoneThrowsAndAddsNothing) {
    const PartedBody body;
    const SkinParts made = makeSkins(body.mesh, body.parts, body.binding, body.split);
    const osg::ref_ptr<osgAnimation::Skeleton> skeleton = new osgAnimation::Skeleton;
    EXPECT_THROW(placeSkins(*skeleton, made), Error);
    EXPECT_EQ(skeleton->getNumChildren(), 0u);
    EXPECT_EQ(made.skins[0].drawable->getNumParents(), 0u);
}
