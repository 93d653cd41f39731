// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Geometry>
#include <osg/Vec3>

#include <vector>

namespace osgSkin {

/// Indices of the triangles that a geometry draws.
///
/// \param geometry with as many vertices as its array has
/// \throw osgSkin::Error where a primitive names another vertex, or ends within a triangle
std::vector<GLuint> trianglesOf(const osg::Geometry& geometry);

/// Fewer triangles between the same vertices.
///
/// \param positions of them; copies at one place move together
/// \param indices of triangles
/// \param most of the result's indices to aim at
/// \throw osgSkin::Error where this kit was built without meshoptimizer
std::vector<GLuint> simplified(const std::vector<osg::Vec3>& positions,
                               const std::vector<GLuint>& indices, std::size_t most);

} // namespace osgSkin
