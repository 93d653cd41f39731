// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Group>
#include <osg/Node>
#include <osg/ref_ptr>

namespace example {

/// A floor at z = 0, `size` units to each side, with lines `spacing` units apart.
osg::ref_ptr<osg::Node> makeFloor(float size, float spacing = 1.0f);

/// `figure` with its shadow on z = 0 and a light that casts it: the same node seen twice, so a skin
/// in it is deformed once and drawn twice.
osg::ref_ptr<osg::Group> withShadow(osg::Node* figure);

} // namespace example
