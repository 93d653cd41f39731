// SPDX-License-Identifier: GPL-3.0-or-later
#include <osgSkinBind/MakeSkins>

#include "scene/PartSubset.h"

#include <osgSkin/Error>
#include <osgSkin/GlmOsg>
#include <osgSkin/UpdateDeformableSkin>

#include <set>

namespace osgSkin {
namespace {

/// Checks that a part is one of this mesh and binding, so that nothing below reads past an end.
void check(const MeshPart& part, const Binding& binding, const RigidSplit& split) {
    if (!part.geometry) throw Error("attach skin: a mesh part has no geometry");
    const std::string where = "attach skin: mesh part \"" + part.geometry->getName() + "\"";
    const auto* vertices = dynamic_cast<const osg::Vec3Array*>(part.geometry->getVertexArray());
    const auto* normals = dynamic_cast<const osg::Vec3Array*>(part.geometry->getNormalArray());
    if (!vertices || !normals || vertices->size() != part.sourceVertex.size() ||
        normals->size() != vertices->size())
        throw Error(where + " needs a vertex, a normal and a source vertex each");
    const std::string broken = brokenPrimitive(*part.geometry, vertices->size());
    if (!broken.empty()) throw Error(where + " has " + broken);
    std::size_t triangles = 0;
    for (const osg::ref_ptr<osg::PrimitiveSet>& set : part.geometry->getPrimitiveSetList()) {
        if (set->getMode() != GL_TRIANGLES) throw Error(where + " has more than triangles");
        triangles += set->getNumIndices() / 3;
    }
    if (triangles != part.sourceFace.size())
        throw Error(where + " has " + std::to_string(triangles) +
                    " triangles, and source faces of " + std::to_string(part.sourceFace.size()));
    for (const std::uint32_t v : part.sourceVertex)
        if (v >= binding.vertexCount()) throw Error(where + " names a vertex that is not bound");
    for (const std::uint32_t f : part.sourceFace)
        if (f >= split.faceJoint.size()) throw Error(where + " names a face that is not there");
}

MeshPart facesOf(const MeshPart& part, const RigidSplit& split, std::uint32_t joint) {
    std::vector<bool> keep;
    keep.reserve(part.sourceFace.size());
    for (const std::uint32_t face : part.sourceFace) keep.push_back(split.faceJoint[face] == joint);
    return partSubset(part, keep);
}

/// The part's vertices come to lie in the deformation's order, so that it writes them straight.
SkinParts::Skin makeSkin(const MeshPart& unordered, const Binding& binding) {
    const auto& vertices =
        static_cast<const osg::Vec3Array&>(*unordered.geometry->getVertexArray());
    const auto& normals = static_cast<const osg::Vec3Array&>(*unordered.geometry->getNormalArray());
    const glm::vec3* positions = asGlm(vertices.asVector().data());
    const glm::vec3* directions = asGlm(normals.asVector().data());
    const auto [model, order] = SkinModel::createInBestOrder(
        binding, {positions, positions + vertices.size()},
        {directions, directions + normals.size()}, unordered.sourceVertex);
    const MeshPart part = reorderedPart(unordered, order);
    const osg::ref_ptr<DeformableSkin> skin = new DeformableSkin;
    skin->setName(part.geometry->getName());
    skin->setSkin(part.geometry, model);
    skin->setUpdateCallback(new UpdateDeformableSkin);
    return {skin, part};
}

} // namespace

SkinParts makeSkins(const SkinMesh& mesh, const std::vector<MeshPart>& parts,
                    const Binding& binding, const RigidSplit& split) {
    binding.validate();
    if (binding.vertexCount() != mesh.positions.size() ||
        split.faceJoint.size() != mesh.faceSizes.size())
        throw Error("attach skin: the binding is not one of this mesh");
    const std::set<std::uint32_t> joints(split.faceJoint.begin(), split.faceJoint.end());
    SkinParts result;
    for (const MeshPart& part : parts) {
        check(part, binding, split);
        for (const std::uint32_t joint : joints) {
            if (joint != RigidSplit::kSkin && joint >= binding.joints.size())
                throw Error("attach skin: a rigid face names a joint that is not there");
            const MeshPart piece = facesOf(part, split, joint);
            if (piece.sourceFace.empty()) continue;
            if (joint == RigidSplit::kSkin)
                result.skins.push_back(makeSkin(piece, binding));
            else
                result.rigids.push_back({binding.joints[joint].name, piece});
        }
    }
    return result;
}

} // namespace osgSkin
