// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Geometry>

#include <cstddef>
#include <string>

namespace osgSkin {

/// As brokenPrimitive() says.
std::string findBroken(const osg::Geometry& geometry, std::size_t vertices);

/// What of a geometry's arrays has fewer elements than its binding asks for; empty: nothing.
std::string findShort(const osg::Geometry& geometry, std::size_t vertices);

} // namespace osgSkin
