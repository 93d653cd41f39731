// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkin/Binding>
#include <osgSkin/Export>
#include <osgSkin/SkinModel>

namespace osgSkin {

/// The binding that a model was made from, for the model's own vertices.
///
/// Ratios are exact. A vertex's region is the last joint that it follows by half or more, since
/// models have no regions. Correctives that are 0, and gradients that SkinModel::create() drops,
/// are left out.
OSGSKIN_EXPORT Binding bindingOf(const SkinModel& model);

} // namespace osgSkin
