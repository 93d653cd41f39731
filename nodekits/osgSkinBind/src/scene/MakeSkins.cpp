// SPDX-License-Identifier: MIT
#include <osgSkinBind/MakeSkins>

#include <osgSkin/BoneReader>
#include <osgSkin/Error>
#include <osgSkin/ExpectedNames>
#include <osgSkin/GlmOsg>
#include <osgSkin/ShareEqualData>
#include <osgSkin/UpdateDeformableSkin>
#include <osgSkinBind/AttachSkin>
#include <osgSkinBind/RigidJoints>
#include <osgSkinBind/RigidSplit>
#include <osgSkinRig/MeshPart>
#include <osgSkinRig/MorphsByVertex>

#include <osg/TriangleIndexFunctor>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <map>
#include <numeric>
#include <set>
#include <utility>
#include <vector>

namespace osgSkin {
namespace {

std::vector<bool> findJoints(const Binding& binding, const std::vector<std::string>& names) {
    std::map<std::string, std::size_t> jointOf;
    for (std::size_t j = 0; j < binding.joints.size(); ++j)
        jointOf.emplace(binding.joints[j].name, j);
    std::vector<bool> result(binding.joints.size(), false);
    for (const std::string& name : names) {
        const auto joint = jointOf.find(name);
        if (joint == jointOf.end())
            throw Error("rigid parts: \"" + name + "\" is not a joint of the binding" +
                        expectedNames(name, jointOf));
        result[joint->second] = true;
    }
    return result;
}

/// The rigid joint that the vertex moves with, or kSkin. Such a vertex is influenced by that joint
/// and all joints above it, each with both ratios 1, and by no other.
std::uint32_t rigidJointOf(const Binding& binding, const std::vector<bool>& rigid,
                           std::size_t vertex) {
    const std::uint32_t first = binding.firstInfluence[vertex];
    const std::uint32_t end = binding.firstInfluence[vertex + 1];
    for (std::uint32_t i = first; i < end; ++i)
        if (binding.influences[i].bend != 1.0f || binding.influences[i].twist != 1.0f)
            return RigidSplit::kSkin;
    // Parents come before children, so the last influence is the lowest joint.
    const std::uint32_t lowest = binding.influences[end - 1].joint;
    std::uint32_t depth = 0;
    for (int j = static_cast<int>(lowest); j >= 0;
         j = binding.joints[static_cast<std::size_t>(j)].parent) {
        if (depth == end - first ||
            static_cast<int>(binding.influences[end - 1 - depth].joint) != j)
            return RigidSplit::kSkin;
        ++depth;
    }
    return rigid[lowest] && depth == end - first ? lowest : RigidSplit::kSkin;
}

constexpr std::uint32_t kUnused = 0xffffffffu;

struct CollectTriangles {
    std::vector<std::uint32_t> corners;
    void operator()(unsigned int a, unsigned int b, unsigned int c) {
        corners.insert(corners.end(), {a, b, c});
    }
};

/// A copy of the elements of a per-vertex array at `indices`.
osg::ref_ptr<osg::Array> gather(const osg::Array& source,
                                const std::vector<std::uint32_t>& indices) {
    osg::ref_ptr<osg::Array> result = static_cast<osg::Array*>(source.cloneType());
    result->setBinding(source.getBinding());
    result->setNormalize(source.getNormalize());
    result->resizeArray(static_cast<unsigned int>(indices.size()));
    if (indices.empty()) return result;
    auto* to = static_cast<char*>(const_cast<GLvoid*>(result->getDataPointer()));
    for (std::size_t i = 0; i < indices.size(); ++i)
        std::memcpy(to + i * source.getElementSize(), source.getDataPointer(indices[i]),
                    source.getElementSize());
    return result;
}

osg::Array* subset(osg::Array* source, std::size_t vertices,
                   const std::vector<std::uint32_t>& indices,
                   std::vector<osg::ref_ptr<osg::Array>>& keepAlive) {
    if (!source || source->getNumElements() != vertices) return source; // an overall binding
    keepAlive.push_back(gather(*source, indices));
    return keepAlive.back();
}

std::vector<std::uint32_t> corners(const osg::Geometry& geometry) {
    osg::TriangleIndexFunctor<CollectTriangles> triangles;
    geometry.accept(triangles);
    return std::move(triangles.corners);
}

/// The vertices `oldIndex` of the part with their per-vertex arrays, without triangles and morph
/// targets.
MeshPart vertexSubset(const MeshPart& part, const std::vector<std::uint32_t>& oldIndex) {
    const osg::Geometry& source = *part.geometry;
    const std::size_t vertices = part.sourceVertex.size();
    MeshPart result;
    result.geometry = new osg::Geometry;
    osg::Geometry& geometry = *result.geometry;
    geometry.setName(source.getName());
    geometry.setStateSet(const_cast<osg::StateSet*>(source.getStateSet()));
    geometry.setUseDisplayList(false);
    geometry.setUseVertexBufferObjects(true);

    std::vector<osg::ref_ptr<osg::Array>> arrays;
    const auto take = [&](const osg::Array* array) {
        return subset(const_cast<osg::Array*>(array), vertices, oldIndex, arrays);
    };
    geometry.setVertexArray(take(source.getVertexArray()));
    geometry.setNormalArray(take(source.getNormalArray()));
    geometry.setColorArray(take(source.getColorArray()));
    geometry.setSecondaryColorArray(take(source.getSecondaryColorArray()));
    for (unsigned int unit = 0; unit < source.getNumTexCoordArrays(); ++unit)
        geometry.setTexCoordArray(unit, take(source.getTexCoordArray(unit)));
    for (unsigned int i = 0; i < source.getNumVertexAttribArrays(); ++i)
        geometry.setVertexAttribArray(i, take(source.getVertexAttribArray(i)));
    for (const std::uint32_t v : oldIndex) result.sourceVertex.push_back(part.sourceVertex[v]);
    return result;
}

/// The triangles of a part for which `keep` is true (one entry a triangle), and the vertices that
/// they use, in the part's order. All per-vertex arrays are copied, the state set is shared; morph
/// targets are left out.
/// \param[out] oldIndex the vertices' indices in the part
MeshPart partSubset(const MeshPart& part, const std::vector<bool>& keep,
                    std::vector<std::uint32_t>& oldIndex) {
    const std::vector<std::uint32_t> old = corners(*part.geometry);
    std::vector<std::uint32_t> newIndex(part.sourceVertex.size(), kUnused);
    for (std::size_t c = 0; c < old.size(); ++c)
        if (keep[c / 3]) newIndex[old[c]] = 0;
    oldIndex.clear();
    for (std::uint32_t v = 0; v < newIndex.size(); ++v) {
        if (newIndex[v] == kUnused) continue;
        newIndex[v] = static_cast<std::uint32_t>(oldIndex.size());
        oldIndex.push_back(v);
    }

    MeshPart result = vertexSubset(part, oldIndex);
    const osg::ref_ptr<osg::DrawElementsUInt> elements = new osg::DrawElementsUInt(GL_TRIANGLES);
    for (std::size_t c = 0; c < old.size(); ++c) {
        if (!keep[c / 3]) continue;
        elements->push_back(newIndex[old[c]]);
        if (c % 3 == 0) result.sourceFace.push_back(part.sourceFace[c / 3]);
    }
    result.geometry->addPrimitiveSet(elements);
    return result;
}

/// Reorders the part's vertices: position i gets vertex order[i]. Triangles keep their order, morph
/// targets are left out.
MeshPart reorderedPart(const MeshPart& part, const std::vector<std::uint32_t>& order) {
    std::vector<std::uint32_t> newIndex(order.size());
    for (std::uint32_t v = 0; v < order.size(); ++v) newIndex[order[v]] = v;
    MeshPart result = vertexSubset(part, order);
    result.sourceFace = part.sourceFace;
    const osg::ref_ptr<osg::DrawElementsUInt> elements = new osg::DrawElementsUInt(GL_TRIANGLES);
    for (const std::uint32_t v : corners(*part.geometry)) elements->push_back(newIndex[v]);
    result.geometry->addPrimitiveSet(elements);
    return result;
}

/// Checks that a part belongs to this mesh and binding, so that no index is out of range below.
void check(const MeshPart& part, const Binding& binding, const RigidSplit& split) {
    if (!part.geometry) throw Error("attach skin: a mesh part has no geometry");
    const std::string where = "attach skin: mesh part \"" + part.geometry->getName() + "\"";
    const auto* vertices = dynamic_cast<const osg::Vec3Array*>(part.geometry->getVertexArray());
    const auto* normals = dynamic_cast<const osg::Vec3Array*>(part.geometry->getNormalArray());
    if (!vertices || !normals || vertices->size() != part.sourceVertex.size() ||
        normals->size() != vertices->size())
        throw Error(where + " needs as many normals and source vertices as vertices");
    const std::string broken = brokenPrimitive(*part.geometry, vertices->size());
    if (!broken.empty()) throw Error(where + " has " + broken);
    std::size_t triangles = 0;
    for (const osg::ref_ptr<osg::PrimitiveSet>& set : part.geometry->getPrimitiveSetList()) {
        if (set->getMode() != GL_TRIANGLES)
            throw Error(where + " has primitives other than triangles");
        triangles += set->getNumIndices() / 3;
    }
    if (triangles != part.sourceFace.size())
        throw Error(where + " has " + std::to_string(triangles) +
                    " triangles, but source faces for " + std::to_string(part.sourceFace.size()));
    for (const std::uint32_t v : part.sourceVertex)
        if (v >= binding.vertexCount()) throw Error(where + " names a vertex that is not bound");
    for (const std::uint32_t f : part.sourceFace)
        if (f >= split.faceJoint.size()) throw Error(where + " names a face that does not exist");
    for (const MorphTarget& target : part.morphs) {
        const std::size_t moved = target.vertices.size();
        const auto fits = [moved](const auto& offsets) {
            return offsets.empty() || offsets.size() == moved;
        };
        if (target.positions.size() != moved || !fits(target.normals) || !fits(target.tangents) ||
            std::any_of(target.vertices.begin(), target.vertices.end(),
                        [&](std::uint32_t v) { return v >= vertices->size(); }))
            throw Error(where + " has a morph target \"" + target.name +
                        "\" that does not fit its vertices");
    }
}

/// \param[out] oldIndex see partSubset()
MeshPart facesOf(const MeshPart& part, const RigidSplit& split, std::uint32_t joint,
                 std::vector<std::uint32_t>& oldIndex) {
    std::vector<bool> keep;
    keep.reserve(part.sourceFace.size());
    for (const std::uint32_t face : part.sourceFace) keep.push_back(split.faceJoint[face] == joint);
    return partSubset(part, keep, oldIndex);
}

/// Puts the part's vertices into the deformation's order, so that it writes them sequentially.
/// \param source for each vertex, the vertex of `binding` that it is a copy of
/// \param morphs of other vertices
/// \param oldIndex for each vertex, the one of `morphs`
SkinParts::Skin makeSkin(const MeshPart& unordered, const Binding& binding,
                         const std::vector<std::uint32_t>& source, const MorphsByVertex& morphs,
                         const std::vector<std::uint32_t>& oldIndex) {
    const auto& vertices =
        static_cast<const osg::Vec3Array&>(*unordered.geometry->getVertexArray());
    const auto& normals = static_cast<const osg::Vec3Array&>(*unordered.geometry->getNormalArray());
    const glm::vec3* positions = asGlm(vertices.asVector().data());
    const glm::vec3* directions = asGlm(normals.asVector().data());
    const auto [own, order] =
        SkinModel::createInBestOrder(binding, {positions, positions + vertices.size()},
                                     {directions, directions + normals.size()}, source);
    // Loads of one file share what does not change.
    const osg::ref_ptr<const SkinModel> model = shareEqualModel(own);
    const MeshPart part = reorderedPart(unordered, order);
    shareEqualArrays(*part.geometry);
    const osg::ref_ptr<DeformableSkin> skin = new DeformableSkin;
    skin->setName(part.geometry->getName());
    const auto* tangents = dynamic_cast<const osg::Vec4Array*>(
        part.geometry->getVertexAttribArray(MeshPart::kTangentAttribute));
    if (tangents && tangents->size() == order.size())
        skin->setTangentAttribute(MeshPart::kTangentAttribute);
    skin->setSkin(part.geometry, model);
    std::vector<std::uint32_t> morphed;
    morphed.reserve(order.size());
    for (const std::uint32_t v : order) morphed.push_back(oldIndex[v]);
    std::vector<MorphTarget> targets = morphs.ofCopies(morphed);
    if (!targets.empty())
        skin->setMorphTargets(MorphTargets::create(std::move(targets), order.size()));
    return {skin, part};
}

/// A skin for a rigid part with morph targets: it morphs, and stays in the rest pose below its
/// bone.
SkinParts::Skin makeStillSkin(const MeshPart& part, const std::string& joint) {
    const auto vertices = static_cast<std::uint32_t>(part.sourceVertex.size());
    const glm::dvec3 axis(0.0, 0.0, 1.0);
    Binding binding;
    binding.joints = {{joint, -1, glm::dvec3(0.0), axis, axis}};
    binding.regions.assign(vertices, 0);
    binding.influences.assign(vertices, {0, 1.0f, 1.0f});
    std::vector<std::uint32_t> all(vertices);
    std::iota(all.begin(), all.end(), 0u);
    binding.firstInfluence = all;
    binding.firstInfluence.push_back(vertices);
    return makeSkin(part, binding, all, MorphsByVertex(part.morphs), all);
}

} // namespace

RigidSplit splitRigid(const SkinMesh& mesh, const Binding& binding,
                      const std::vector<std::string>& rigid) {
    if (mesh.positions.size() != binding.vertexCount())
        throw Error("rigid parts: the mesh has " + std::to_string(mesh.positions.size()) +
                    " vertices, expected the binding's " + std::to_string(binding.vertexCount()));
    mesh.validate();
    binding.validate();
    const std::vector<bool> isRigid = findJoints(binding, rigid);

    std::vector<std::uint32_t> jointOf(binding.vertexCount());
    for (std::size_t v = 0; v < jointOf.size(); ++v) jointOf[v] = rigidJointOf(binding, isRigid, v);

    RigidSplit split;
    std::size_t corner = 0;
    for (const std::uint32_t size : mesh.faceSizes) {
        std::uint32_t joint = jointOf[mesh.faceVertices[corner]];
        for (std::uint32_t k = 1; k < size; ++k)
            if (jointOf[mesh.faceVertices[corner + k]] != joint) joint = RigidSplit::kSkin;
        split.faceJoint.push_back(joint);
        corner += size;
    }
    return split;
}

SkinParts makeSkins(const SkinMesh& mesh, const std::vector<MeshPart>& parts,
                    const Binding& binding, const RigidSplit& split) {
    binding.validate();
    if (binding.vertexCount() != mesh.positions.size() ||
        split.faceJoint.size() != mesh.faceSizes.size())
        throw Error("attach skin: the binding or the split belongs to another mesh");
    const std::set<std::uint32_t> joints(split.faceJoint.begin(), split.faceJoint.end());
    SkinParts result;
    for (const MeshPart& part : parts) {
        check(part, binding, split);
        const MorphsByVertex morphs(part.morphs);
        for (const std::uint32_t joint : joints) {
            if (joint != RigidSplit::kSkin && joint >= binding.joints.size())
                throw Error("attach skin: a rigid face names a joint that does not exist");
            std::vector<std::uint32_t> oldIndex;
            MeshPart piece = facesOf(part, split, joint, oldIndex);
            if (piece.sourceFace.empty()) continue;
            if (joint == RigidSplit::kSkin) {
                result.skins.push_back(
                    makeSkin(piece, binding, piece.sourceVertex, morphs, oldIndex));
                result.skins.back().drawable->setUpdateCallback(new UpdateDeformableSkin);
            } else {
                piece.morphs = morphs.ofCopies(oldIndex);
                result.rigids.push_back({binding.joints[joint].name, piece});
            }
        }
    }
    return result;
}

const osg::Geometry& AttachedSkin::Rigid::drawn() const {
    const auto* skin = dynamic_cast<const DeformableSkin*>(node->getChild(0));
    return skin ? *skin->getDeformedGeometry() : *part.geometry;
}

AttachedSkin placeSkins(osgAnimation::Skeleton& skeleton, const SkinParts& parts) {
    const osgAnimation::BoneMap named = bonesOf(skeleton);
    std::vector<osg::ref_ptr<osgAnimation::Bone>> bones;
    for (const SkinParts::Rigid& rigid : parts.rigids) {
        const auto bone = named.find(rigid.joint);
        if (bone == named.end())
            throw Error("attach skin: the skeleton has no bone \"" + rigid.joint +
                        "\", which a rigid part needs");
        bones.push_back(bone->second);
    }
    AttachedSkin result;
    result.skins = parts.skins;
    for (const SkinParts::Skin& skin : parts.skins) skeleton.addChild(skin.drawable);
    for (std::size_t i = 0; i < bones.size(); ++i) {
        const MeshPart& part = parts.rigids[i].part;
        if (part.morphs.empty()) {
            shareEqualArrays(*part.geometry);
            result.rigids.push_back({new RigidPart(part.geometry, *bones[i]), bones[i], part});
            continue;
        }
        const SkinParts::Skin still = makeStillSkin(part, parts.rigids[i].joint);
        result.rigids.push_back({new RigidPart(still.drawable, *bones[i]), bones[i], still.part});
    }
    return result;
}

AttachedSkin attachSkin(osgAnimation::Skeleton& skeleton, const SkinMesh& mesh,
                        const std::vector<MeshPart>& parts, const Binding& binding,
                        const RigidSplit& split) {
    return placeSkins(skeleton, makeSkins(mesh, parts, binding, split));
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
