// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_RIGPART_H
#define OSGSKINBIND_RIGPART_H

#include <osgSkin/MeshPart>
#include <osgSkin/SkinMesh>
#include <osgSkinBind/BindWeights>

#include <osg/Matrixd>
#include <osgAnimation/RigGeometry>

namespace osgSkin {

/// The rigs of one skeleton as one body.
struct RigBody {
    SkinMesh mesh; ///< skeleton space
    std::vector<MeshPart> parts;
    VertexWeights weights;

    /// Adds a rig as the next part.
    /// \param place from the rig's own space to skeleton space
    /// \throw osgSkin::Error with the reason why it cannot be converted; nothing is added then
    void add(const osgAnimation::RigGeometry& rig, const osg::Matrixd& place,
             const RestSkeleton& skeleton);
};

} // namespace osgSkin

#endif
