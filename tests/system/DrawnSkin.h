// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkinCharacter/Character>

#include <osg/Array>
#include <osg/Matrixd>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace test {

/// Calls visit(source vertex, posed position) for every drawn copy of every vertex, of skins and of
/// rigid parts, in the skeleton's space.
template <typename Visit>
void forEachCopy(const osgSkin::Character& character, const Visit& visit) {
    for (const auto& skin : character.skin.skins) {
        const auto& vertices = static_cast<const osg::Vec3Array&>(
            *skin.drawable->getDeformedGeometry()->getVertexArray());
        for (std::size_t i = 0; i < vertices.size(); ++i)
            visit(skin.part.sourceVertex[i], osg::Vec3d(vertices[i]));
    }
    for (const auto& rigid : character.skin.rigids) {
        const auto& vertices = static_cast<const osg::Vec3Array&>(*rigid.drawn().getVertexArray());
        const osg::Matrixd matrix =
            rigid.node->getMatrix() * rigid.bone->getMatrixInSkeletonSpace();
        for (std::size_t i = 0; i < vertices.size(); ++i)
            visit(rigid.part.sourceVertex[i], osg::Vec3d(vertices[i]) * matrix);
    }
}

/// The positions of all drawn copies, in the skeleton's space.
inline std::vector<osg::Vec3d> drawnVertices(const osgSkin::Character& character) {
    std::vector<osg::Vec3d> result;
    forEachCopy(character, [&](std::uint32_t, const osg::Vec3d& p) { result.push_back(p); });
    return result;
}

} // namespace test
