// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <osgSkin/Binding>
#include <osgSkinRig/Clip>
#include <osgSkinRig/RestSkeleton>
#include <osgSkinRig/SkinMesh>

#include <osg/BoundingSphere>
#include <osg/Matrix>

namespace osgSkin {

/// A sphere that holds the whole character over the whole clip, in the space of `toWorld`: the
/// joints' paths, widened by how far skin lies from its joint.
osg::BoundingSphere clipBounds(const Clip& clip, const RestSkeleton& rig, const Binding& binding,
                               const SkinMesh& mesh, const osg::Matrix& toWorld);

} // namespace osgSkin
