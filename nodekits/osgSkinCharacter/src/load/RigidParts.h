// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "source/CharacterSource.h"

#include <osgSkinCharacter/CharacterMotion>

#include <vector>

namespace osgSkin {

/// Sets the joints of rigid parts where nobody has named them: heads, hands and feet whose fingers,
/// toes and the like no motion moves. Without any motion they are left to automaticRigidJoints(). A
/// note names the rigid parts that could bend.
///
/// \param source its BindOptions::rigid is set where there are motions
/// \param motions retargeted to its skeleton
void setRigidParts(CharacterSource& source, const std::vector<CharacterMotion>& motions);

} // namespace osgSkin
