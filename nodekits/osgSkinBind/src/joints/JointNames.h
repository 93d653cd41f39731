// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_JOINTNAMES_H
#define OSGSKINBIND_JOINTNAMES_H

#include <string>

namespace osgSkin {

/// What a joint's name says about it. Prefixes ("mixamorig:", "Bip01 "), sides and case do not
/// count: "LeftHand", "mixamorig:LeftHand", "hand_l" and "wrist.L" are hands, "LeftHandIndex1" and
/// "HeadTop_End" are nothing of the kind.
bool isHeadName(const std::string& name);
bool isHandName(const std::string& name);
bool isFootName(const std::string& name);
bool isThumbName(const std::string& name);

} // namespace osgSkin

#endif
