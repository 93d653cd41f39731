// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Group>
#include <osg/Node>
#include <osg/ref_ptr>

namespace example {

/// A floor at z = 0, `size` units to each side, with lines `spacing` units apart.
osg::ref_ptr<osg::Node> makeFloor(float size, float spacing = 1.0f);

/// `figure`, a light, and the shadow on z = 0. The shadow draws the same node again, so skins are
/// deformed once and drawn twice.
osg::ref_ptr<osg::Group> withShadow(osg::Node* figure);

} // namespace example
