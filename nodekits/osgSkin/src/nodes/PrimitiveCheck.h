// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Geometry>

#include <cstddef>
#include <string>

namespace osgSkin {

/// As brokenPrimitive() says.
std::string findBroken(const osg::Geometry& geometry, std::size_t vertices);

} // namespace osgSkin
