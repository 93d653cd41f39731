// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkin/Binding>
#include <osgSkinBind/Export>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace osgSkin {

/// The ratios, 0 to 1, by which a vertex follows a joint.
struct JointRatio {
    std::uint32_t joint;
    double bend, twist;
};

/// Adds one vertex's influences, in joint order, at most `mostPartial` of them fractional
/// (Influence::isFractional()).
///
/// Two joints with the same bend ratio and different twist ratios begin one limb, as CMU's hip
/// joints and thighs, and count once, as long as there are no more than
/// SkinModel::kMaxPartialInfluences. If there are more, all ratios are stretched by the amount that
/// rounds the surplus ones to 0 or 1. The result is as continuous over the skin as the fields are
/// (rounding only the surplus ones would tear it), and no joint's ratio exceeds its parent's.
///
/// \param ratios of the vertex, in joint order; missing ones are 0
/// \param mostPartial how many influences may be fractional
/// \param influences the new ones are appended
/// \return whether there were more
OSGSKINBIND_EXPORT bool packInfluences(const std::vector<JointRatio>& ratios,
                                       std::size_t mostPartial, std::vector<Influence>& influences);

} // namespace osgSkin
