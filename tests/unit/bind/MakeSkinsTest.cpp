// SPDX-License-Identifier: GPL-3.0-or-later
#include "RigScene.h"
#include "Shapes.h"

#include <osgSkin/Error>
#include <osgSkinBind/AttachSkin>
#include <osgSkinBind/Bind>
#include <osgSkinBind/MakeSkins>

#include <gtest/gtest.h>

#include <numeric>

using namespace osgSkin;

namespace {

/// A cylinder over three bones, the last of which is rigid, in two parts: its lower and its upper
/// half.
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

    /// The faces whose first corner is that high.
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

TEST(MakeSkins, NeedsNoSkeletonAndKeepsEveryFace) {
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

TEST(MakeSkins, RefusesWhatDoesNotFit) {
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
    Binding broken = body.binding;
    broken.influences[2].joint = 9;
    EXPECT_THROW(makeSkins(body.mesh, body.parts, broken, body.split), Error);
}

TEST(MakeSkins, RefusesPartsThatWouldBeReadBeyondTheirEnds) {
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

TEST(PlaceSkins, HangsSkinsUnderTheSkeletonAndRigidPartsUnderTheirBones) {
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

/// As a rider's, with bones of the same names.
TEST(PlaceSkins, LeavesASkeletonBelowAsItIs) {
    const PartedBody body;
    rigs::Scene scene, rider;
    scene.bones[2]->addChild(rider.skeleton);
    const AttachedSkin placed =
        placeSkins(*scene.skeleton, makeSkins(body.mesh, body.parts, body.binding, body.split));
    ASSERT_EQ(placed.rigids.size(), 1u);
    EXPECT_EQ(placed.rigids[0].bone, scene.bones[2]);
}

TEST(PlaceSkins, WithoutTheRigidPartsBonePlacesNothing) {
    const PartedBody body;
    const SkinParts made = makeSkins(body.mesh, body.parts, body.binding, body.split);
    const osg::ref_ptr<osgAnimation::Skeleton> skeleton = new osgAnimation::Skeleton;
    EXPECT_THROW(placeSkins(*skeleton, made), Error);
    EXPECT_EQ(skeleton->getNumChildren(), 0u);
    EXPECT_EQ(made.skins[0].drawable->getNumParents(), 0u);
}
