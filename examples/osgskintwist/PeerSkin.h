// SPDX-License-Identifier: MIT
#pragma once

#include "SkinWeights.h"

#include <osgSkinRig/MeshPart>

#include <osg/Geometry>
#include <osg/ref_ptr>

#include <functional>
#include <vector>

namespace twist {

/// A mesh part skinned by one of osgSkin's peers, deformed when its pose is set.
class PeerSkin {
public:
    /// One matrix per vertex of the mesh (see LinearBlend.h and DualQuaternionBlend.h).
    using Blend = std::function<std::vector<glm::dmat4>(const compare::SkinWeights&,
                                                        const std::vector<glm::dmat4>&)>;

    /// \param weights of the mesh's vertices, not of the part's copies of them
    PeerSkin(const osgSkin::MeshPart& part, std::vector<glm::dvec3> rest,
             compare::SkinWeights weights, Blend blend);

    /// \param skinning one matrix per joint of the weights
    void setPose(const std::vector<glm::dmat4>& skinning);

    /// The mesh's vertices in the current pose.
    const std::vector<glm::dvec3>& positions() const { return _positions; }
    osg::Geometry* geometry() const { return _geometry.get(); }

private:
    osgSkin::MeshPart _part;
    std::vector<glm::dvec3> _rest;
    compare::SkinWeights _weights;
    Blend _blend;
    std::vector<glm::dvec3> _positions;
    osg::ref_ptr<osg::Geometry> _geometry;
};

} // namespace twist
