// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_CHECKDEFORMED_H
#define OSGSKINIMPORT_CHECKDEFORMED_H 1

#include <osg/Geometry>

#include <string>

namespace osgSkin {

/// Why osgAnimation would read or write beyond what a rig or a morph has, as it moves its vertices;
/// empty where it would not, and of other geometries.
std::string whyNotDeformed(const osg::Geometry& geometry);

} // namespace osgSkin

#endif
