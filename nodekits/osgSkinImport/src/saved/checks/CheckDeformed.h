// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_CHECKDEFORMED_H
#define OSGSKINIMPORT_CHECKDEFORMED_H 1

#include <osg/Drawable>
#include <osg/Geometry>

#include <string>

namespace osgSkin {

/// Why osgAnimation would read or write beyond what a rig or a morph has, as it moves its vertices;
/// empty where it would not, and of other geometries.
std::string whyNotDeformed(const osg::Geometry& geometry);

/// Whether a drawable asks for the box of a rig and is none, which osgAnimation throws at.
bool hasBoxOfARig(const osg::Drawable& drawable);

} // namespace osgSkin

#endif
