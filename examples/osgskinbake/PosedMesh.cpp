// SPDX-License-Identifier: MIT
#include "PosedMesh.h"

#include <osgSkin/Deform>
#include <osgSkin/GlmOsg>

#include <glm/geometric.hpp>

namespace bake {
namespace {

using osgSkin::toGlm;

/// Merges the drawn copies of each vertex.
class Collector {
public:
    explicit Collector(std::size_t vertices)
        : _mesh{std::vector<glm::dvec3>(vertices), std::vector<glm::dvec3>(vertices)},
          _seen(vertices, false) {}

    void add(std::size_t vertex, const glm::dvec3& position, const glm::dvec3& normal) {
        if (_seen[vertex])
            _mesh.seamGap =
                std::max(_mesh.seamGap, glm::length(position - _mesh.positions[vertex]));
        else
            _mesh.positions[vertex] = position;
        _mesh.normals[vertex] += normal;
        _seen[vertex] = true;
    }

    void add(const osg::Geometry& geometry, const std::vector<std::uint32_t>& source,
             const osg::Matrixd& matrix) {
        const auto& vertices = static_cast<const osg::Vec3Array&>(*geometry.getVertexArray());
        const auto& normals = static_cast<const osg::Vec3Array&>(*geometry.getNormalArray());
        for (std::size_t i = 0; i < source.size(); ++i)
            add(source[i], toGlm(osg::Vec3d(vertices[i]) * matrix),
                toGlm(osg::Matrixd::transform3x3(osg::Vec3d(normals[i]), matrix)));
    }

    /// Adds vertices that no face uses, in the current pose. They are part of the mesh but not
    /// drawn.
    void addUndrawn(const osgSkin::Character& character) {
        std::vector<std::uint32_t> source;
        std::vector<glm::vec3> rest;
        for (std::uint32_t v = 0; v < _seen.size(); ++v) {
            if (_seen[v]) continue;
            source.push_back(v);
            rest.emplace_back(character.body.mesh.positions[v]);
        }
        if (source.empty()) return;
        const std::vector<glm::vec3> up(source.size(), glm::vec3(0.0f, 1.0f, 0.0f));
        const auto model = osgSkin::SkinModel::create(character.binding, rest, up, source);
        const auto posed = osgSkin::deform(*model, currentPose(character)).positions;
        for (std::size_t i = 0; i < source.size(); ++i)
            add(source[i], glm::dvec3(posed[i]), glm::dvec3(0.0, 1.0, 0.0));
    }

    /// Adds vertices that no face uses, in the bind pose.
    void addUndrawn(const osgSkin::SkinMesh& mesh) {
        for (std::size_t v = 0; v < _seen.size(); ++v)
            if (!_seen[v]) add(v, mesh.positions[v], glm::dvec3(0.0, 1.0, 0.0));
    }

    PosedMesh finish() {
        for (glm::dvec3& normal : _mesh.normals) {
            const double length = glm::length(normal);
            normal = length > 0.0 ? normal / length : glm::dvec3(0.0, 1.0, 0.0);
        }
        return std::move(_mesh);
    }

private:
    PosedMesh _mesh;
    std::vector<bool> _seen;
};

} // namespace

void readPose(const osgSkin::Character& character, const osgSkin::BoneReader& reader,
              osgSkin::Pose& pose) {
    const std::vector<std::string>& inputs = character.binding.correctives.inputs;
    if (!character.skin.skins.empty())
        for (std::size_t i = 0; i < inputs.size(); ++i)
            pose.setInput(i, character.skin.skins.front().drawable->getActivation(inputs[i]));
    const std::vector<glm::dmat4>& skinning = reader.read();
    pose.set(skinning.data(), skinning.size(), osgSkin::Pose::Twist::Continued);
}

osgSkin::Pose currentPose(const osgSkin::Character& character) {
    const osgSkin::BoneReader reader(character.binding.joints, *character.skeleton);
    osgSkin::Pose pose(character.binding.joints, character.binding.correctives.inputs.size());
    readPose(character, reader, pose); // a new pose has no twists to continue
    return pose;
}

PosedMesh PosedMesh::read(const osgSkin::Character& character) {
    Collector collector(character.body.mesh.positions.size());
    for (const osgSkin::AttachedSkin::Skin& skin : character.skin.skins)
        collector.add(*skin.drawable->getDeformedGeometry(), skin.part.sourceVertex, {});
    for (const osgSkin::AttachedSkin::Rigid& rigid : character.skin.rigids)
        collector.add(rigid.drawn(), rigid.part.sourceVertex,
                      rigid.node->getMatrix() * rigid.bone->getMatrixInSkeletonSpace());
    collector.addUndrawn(character);
    return collector.finish();
}

PosedMesh PosedMesh::rest(const osgSkin::Character& character) {
    Collector collector(character.body.mesh.positions.size());
    for (const osgSkin::MeshPart& part : character.body.parts)
        collector.add(*part.geometry, part.sourceVertex, {});
    collector.addUndrawn(character.body.mesh);
    return collector.finish();
}

} // namespace bake
