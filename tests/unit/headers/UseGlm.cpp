// SPDX-License-Identifier: MIT
// Compiled with an application's GLM_FORCE_*, see CMakeLists.txt; never linked.
#include <osgSkin/Binding>

glm::dvec3 centreOf(const osgSkin::BoundJoint& joint) {
    return joint.centre;
}
