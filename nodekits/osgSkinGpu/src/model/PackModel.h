// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkin/Correctives>
#include <osgSkin/SkinModel>

#include <osg/Array>
#include <osg/ref_ptr>

namespace osgSkin {

/// The texels of a GpuModel, laid out as that says.
///
/// \param model with vertices or without
/// \param correctives the model's
osg::ref_ptr<osg::Vec4uiArray> packModel(const SkinModel& model, const Correctives& correctives);

/// The texel of a palette, at which the weights of each of the correctives' joints begin; then
/// that behind the last.
std::vector<unsigned int> weightTexels(const SkinModel& model,
                                       const std::vector<CorrectiveJoint>& joints);

} // namespace osgSkin
