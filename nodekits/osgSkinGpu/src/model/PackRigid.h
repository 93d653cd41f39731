// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkin/Binding>

#include <osg/Array>
#include <osg/ref_ptr>

#include <vector>

namespace osgSkin {

/// The texels of a GpuModel all of whose vertices follow one joint wholly.
///
/// \param joints of the palettes that it will be drawn with
/// \param joint an index of them
/// \param positions rest space
/// \param normals as many
osg::ref_ptr<osg::Vec4uiArray> packRigid(const std::vector<BoundJoint>& joints, unsigned int joint,
                                         const osg::Vec3Array& positions,
                                         const osg::Vec3Array& normals);

} // namespace osgSkin
