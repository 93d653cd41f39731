// SPDX-License-Identifier: MIT
#ifndef OSGSKINRIG_NAMES_ROLETREE_H
#define OSGSKINRIG_NAMES_ROLETREE_H

#include "names/NameReading.h"

#include <osgSkinRig/JointNames>
#include <osgSkinRig/RestSkeleton>

#include <optional>
#include <string>
#include <vector>

namespace osgSkin {

/// Resolves roles by the tree: each role goes to one joint, the topmost, except spine and neck,
/// which are all joints on the line to the head. The hips carry both legs. An unnamed head is the
/// last of the spine's joints above the arms.
/// \param roles [joint] as in JointNames, empty for none
void settleRoles(const RestSkeleton& skeleton, std::vector<std::string>& roles);

/// The lowest common ancestor of two joints, which may be one of them; -1 for none.
int commonAncestor(const RestSkeleton& skeleton, int a, int b);

/// Finds roles by the skeleton's shape alone: two pairs of mirrored limbs, one above the other
/// along the legs, and a head above the upper pair.
///
/// The upper and lower bone of a limb are the two longest in a row. The toes decide which side is
/// left; without toes it is +x. Fingers get no role.
/// \param skeleton at rest; its names are not read
/// \return [joint] roles as in JointNames; empty where it is no standing person
std::vector<std::string> shapeRoles(const RestSkeleton& skeleton);

/// A skeleton's parsed names and the roles that follow from them (as in JointNames).
struct WordRoles {
    std::vector<std::optional<NameReading>> readings; ///< [joint]
    std::vector<std::string> roles;                   ///< [joint]; empty: no role
};

/// Finds roles by the words in the joints' names, whatever the naming scheme.
///
/// The prefix that most roles share is the body's; names with other prefixes belong to other
/// things. A word that skeletons use differently ("shoulder", "arm", "leg", "hip") gets the meaning
/// that the skeleton's other words leave. Of several joints with one role the topmost keeps it; the
/// joint that carries both legs is the hips, whatever its name.
/// \param skeleton its names and parents are read
WordRoles wordRoles(const RestSkeleton& skeleton);

/// The topmost joints of the figures of a skeleton that has several, side by side, whose names are
/// known. recogniseJoints() gives roles to the first one's joints.
/// \param extra see recogniseJoints()
/// \return empty for less than two figures
std::vector<int> topsOfFigures(const RestSkeleton& skeleton, const std::vector<JointNames>& extra);

} // namespace osgSkin

#endif
