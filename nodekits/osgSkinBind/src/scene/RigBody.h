// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_RIGBODY_H
#define OSGSKINBIND_RIGBODY_H

#include <osgSkinBind/BindWeights>
#include <osgSkinRig/MeshPart>
#include <osgSkinRig/SkinMesh>

#include <osg/Matrixd>
#include <osgAnimation/RigGeometry>

namespace osgSkin {

/// The rigs of one skeleton as one body.
struct RigBody {
    SkinMesh mesh; ///< skeleton space
    std::vector<MeshPart> parts;
    VertexWeights weights;

    /// Adds a rig as the next part.
    ///
    /// \param rig is only read
    /// \param toSkeleton from the rig's own space to skeleton space
    /// \param skeleton whose joints the rig's bones are, by name
    /// \throw osgSkin::Error with the reason why it cannot be converted; nothing is added then
    void add(const osgAnimation::RigGeometry& rig, const osg::Matrixd& toSkeleton,
             const RestSkeleton& skeleton);
};

} // namespace osgSkin

#endif
