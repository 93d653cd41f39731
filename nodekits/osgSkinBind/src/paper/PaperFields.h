// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_PAPERFIELDS_H
#define OSGSKINBIND_PAPERFIELDS_H

#include "fields/JointFields.h"
#include "limbs/BinaryField.h"

namespace osgSkin {

/// Ratios as printed (paper, section 3): eq. 5 between two boundary planes for each joint's bend
/// and for its twist, exactly 0 above and exactly 1 below.
///
/// A joint's planes count in its own region, in the one above and in the next one of its chain.
/// Skin of other regions follows the joint wholly where it belongs to the joint's subtree and not
/// at all elsewhere, so on a body the ratios jump where such a region meets the space between the
/// planes (armpit, crotch): BindOptions::Method::Smooth is there for that.
struct PaperFields {
    JointFields bend, twist;

    /// \param binary the skin, its joints and regions
    /// \param radii of limbRadii()
    PaperFields(const BinaryField& binary, const std::vector<double>& radii);
};

} // namespace osgSkin

#endif
