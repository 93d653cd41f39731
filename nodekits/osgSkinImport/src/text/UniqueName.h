// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_UNIQUENAME_H
#define OSGSKINIMPORT_UNIQUENAME_H 1

#include <set>
#include <string>

namespace osgSkin {

/// `wanted`, or with a counter behind it ("Torso.001") where that is taken; is taken from now on.
std::string uniqueName(const std::string& wanted, std::set<std::string>& taken);

} // namespace osgSkin

#endif
