// SPDX-License-Identifier: GPL-3.0-or-later
#include <osgSkinBind/AttachSkin>

#include <osgSkin/Error>
#include <osgSkin/GlmOsg>
#include <osgSkin/UpdateDeformableSkin>
#include <osgSkinBind/Bind>

#include "scene/PartSubset.h"

#include <osgAnimation/BoneMapVisitor>

#include <set>

namespace osgSkin {
namespace {

/// Checks that a part is one of this mesh and binding, so that nothing below reads past an end.
void check(const MeshPart& part, const Binding& binding, const RigidSplit& split) {
    if (!part.geometry) throw Error("attach skin: a mesh part has no geometry");
    const std::string place = "attach skin: mesh part \"" + part.geometry->getName() + "\"";
    const auto* vertices = dynamic_cast<const osg::Vec3Array*>(part.geometry->getVertexArray());
    const auto* normals = dynamic_cast<const osg::Vec3Array*>(part.geometry->getNormalArray());
    if (!vertices || !normals || vertices->size() != part.sourceVertex.size() ||
        normals->size() != vertices->size())
        throw Error(place + " needs a vertex, a normal and a source vertex each");
    for (const std::uint32_t v : part.sourceVertex)
        if (v >= binding.vertexCount()) throw Error(place + " names a vertex that is not bound");
    for (const std::uint32_t f : part.sourceFace)
        if (f >= split.faceJoint.size()) throw Error(place + " names a face that is not there");
}

MeshPart facesOf(const MeshPart& part, const RigidSplit& split, std::uint32_t joint) {
    std::vector<bool> keep;
    keep.reserve(part.sourceFace.size());
    for (const std::uint32_t face : part.sourceFace) keep.push_back(split.faceJoint[face] == joint);
    return partSubset(part, keep);
}

/// The part's vertices come to lie in the deformation's order, so that it writes them straight.
AttachedSkin::Skin makeSkin(const MeshPart& unordered, const Binding& binding) {
    const MeshPart part =
        reorderedPart(unordered, SkinModel::bestOrder(binding, unordered.sourceVertex));
    const auto& vertices = static_cast<const osg::Vec3Array&>(*part.geometry->getVertexArray());
    const auto& normals = static_cast<const osg::Vec3Array&>(*part.geometry->getNormalArray());
    const glm::vec3* positions = asGlm(vertices.asVector().data());
    const glm::vec3* directions = asGlm(normals.asVector().data());
    const osg::ref_ptr<DeformableSkin> skin = new DeformableSkin;
    skin->setName(part.geometry->getName());
    skin->setSkin(part.geometry,
                  SkinModel::create(binding, {positions, positions + vertices.size()},
                                    {directions, directions + normals.size()}, part.sourceVertex));
    skin->setUpdateCallback(new UpdateDeformableSkin);
    return {skin, part};
}

} // namespace

AttachedSkin attachSkin(osgAnimation::Skeleton& skeleton, const SkinMesh& mesh,
                        const std::vector<MeshPart>& parts, const Binding& binding,
                        const RigidSplit& split) {
    if (binding.vertexCount() != mesh.positions.size() ||
        split.faceJoint.size() != mesh.faceSizes.size())
        throw Error("attach skin: the binding is not one of this mesh");
    osgAnimation::BoneMapVisitor visitor;
    skeleton.accept(visitor);
    const std::set<std::uint32_t> joints(split.faceJoint.begin(), split.faceJoint.end());

    AttachedSkin result;
    for (const MeshPart& part : parts) {
        check(part, binding, split);
        for (const std::uint32_t joint : joints) {
            MeshPart piece = facesOf(part, split, joint);
            if (piece.sourceFace.empty()) continue;
            if (joint == RigidSplit::kSkin) {
                result.skins.push_back(makeSkin(piece, binding));
                skeleton.addChild(result.skins.back().drawable);
                continue;
            }
            const auto bone = visitor.getBoneMap().find(binding.joints[joint].name);
            if (bone == visitor.getBoneMap().end())
                throw Error("attach skin: the skeleton has no bone \"" +
                            binding.joints[joint].name + "\", which a rigid part needs");
            result.rigids.push_back(
                {new RigidPart(piece.geometry, *bone->second), bone->second, piece});
        }
    }
    return result;
}

AttachedSkin attachSkin(osgAnimation::Skeleton& skeleton, const SkinMesh& mesh,
                        const std::vector<MeshPart>& parts, const Binding& binding) {
    RestSkeleton joints;
    for (const BoundJoint& joint : binding.joints)
        joints.joints.push_back({joint.name, joint.parent, joint.centre, {}});
    return attachSkin(skeleton, mesh, parts, binding,
                      splitRigid(mesh, binding, automaticRigidJoints(joints)));
}

} // namespace osgSkin
