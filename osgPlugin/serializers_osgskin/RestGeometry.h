// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Geometry>

#include <string>

/// Why the rest geometry of a skin with this many vertices cannot be drawn or picked safely: a face
/// that names a vertex which is not there, an array that is too short. Empty: it can be.
std::string whatIsWrongWith(const osg::Geometry& geometry, std::size_t vertexCount);
