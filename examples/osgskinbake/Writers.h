// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <osgSkin/Binding>
#include <osgSkin/Pose>

#include <nlohmann/json.hpp>

#include <string>

namespace bake {

/// Joints in the product's order, and each vertex's region and ratios.
nlohmann::json bindingJson(const osgSkin::Binding& binding);

/// The joints' transforms D_j of one frame.
nlohmann::json poseJson(std::size_t frame, const osgSkin::Binding& binding,
                        const osgSkin::Pose& pose);

/// \throw osgSkin::Error where it cannot be written
void writeJson(const std::string& file, const nlohmann::json& json);

} // namespace bake
