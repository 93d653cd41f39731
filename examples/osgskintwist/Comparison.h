// SPDX-License-Identifier: MIT
#pragma once

#include "Cylinder.h"
#include "PeerSkin.h"
#include "TwistPose.h"

#include <osgSkin/DeformableSkin>

#include <osgAnimation/Skeleton>
#include <osgAnimation/StackedQuaternionElement>
#include <osgUtil/UpdateVisitor>

#include <array>
#include <vector>

namespace twist {

enum class Method { Ours, Linear, DualQuaternion };
constexpr std::array<Method, 3> kMethods{Method::Ours, Method::Linear, Method::DualQuaternion};
const char* nameOf(Method method);

/// One cylinder over two bones, skinned in three ways.
///
/// Ours is bound with osgSkin's defaults. The peers get
/// smooth weights (paper, eq. 5) over one radius to either side of the joint.
class Comparison {
public:
    Comparison();

    /// Poses all three. Ours follows its skeleton, so it is drawn so after the next update
    /// traversal.
    void setPose(const TwistPose& pose);

    /// What to draw: a skeleton with its skin, or a geometry.
    osg::Node* node(Method method) const;

    /// The cylinder's vertices in the current pose, in the order of cylinder().mesh.
    std::vector<glm::dvec3> positions(Method method);

    const Cylinder& cylinder() const { return _cylinder; }

private:
    Cylinder _cylinder;
    osg::ref_ptr<osgAnimation::Skeleton> _skeleton;
    osg::ref_ptr<osgAnimation::StackedQuaternionElement> _turn; ///< of the upper bone
    osg::ref_ptr<osgSkin::DeformableSkin> _skin;
    std::vector<std::uint32_t> _skinSource; ///< the mesh's vertex for each of the skin's
    osg::ref_ptr<osgUtil::UpdateVisitor> _update;
    PeerSkin _linear;
    PeerSkin _dualQuaternion;
};

} // namespace twist
