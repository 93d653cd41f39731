// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkin/RestSkeleton>

#include <map>
#include <string>
#include <vector>

namespace osgSkin {

/// For each rig joint, the index of the motion joint that drives it, or -1.
///
/// The caller's map comes first (an empty motion name leaves the joint at rest), then the joint of
/// equal name, then the built-in other names of the same joint.
/// \throw osgSkin::Error where the map names a joint that is not there, or no joint matches.
std::vector<int> mapJoints(const RestSkeleton& rig, const RestSkeleton& motion,
                           const std::map<std::string, std::string>& names);

/// Other names of the joint `name` in the dialects of motion capture files; empty where none are
/// known.
std::vector<std::string> aliasesOf(const std::string& name);

} // namespace osgSkin
