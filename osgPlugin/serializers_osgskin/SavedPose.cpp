// SPDX-License-Identifier: MIT
#include "SavedPose.h"

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <glm/mat3x3.hpp>

#include <cmath>
#include <sstream>

namespace {

constexpr double kLargestScale = 1e6;   ///< its inverse is the smallest
constexpr double kLargestNumber = 1e18; ///< its square is a float still

} // namespace

std::vector<glm::dmat4> skinningOf(const osgSkin::DeformableSkin& skin) {
    const std::vector<osgSkin::BoundJoint>& joints = skin.getModel()->joints();
    std::vector<glm::dmat4> skinning;
    for (std::size_t j = 0; j < joints.size(); ++j) {
        const osgSkin::JointTransform joint = skin.getPose().transform(j);
        const glm::dmat4 own = glm::translate(glm::dmat4(1.0), joint.offset) *
                               glm::mat4_cast(joint.rotation) *
                               glm::scale(glm::dmat4(1.0), glm::dvec3(joint.scale));
        skinning.push_back(joints[j].parent < 0
                               ? own
                               : skinning[static_cast<std::size_t>(joints[j].parent)] * own);
    }
    return skinning;
}

std::string whatIsWrongWith(const glm::dmat4& skinning) {
    for (int i = 0; i < 16; ++i) {
        const double number = glm::value_ptr(skinning)[i];
        if (!std::isfinite(number)) return "that is not finite";
        if (std::abs(number) > kLargestNumber) return "with a number that is too large";
    }
    const double scale = std::cbrt(std::abs(glm::determinant(glm::dmat3(skinning))));
    if (!(scale > 0.0)) return "that is singular";
    if (scale >= 1.0 / kLargestScale && scale <= kLargestScale) return {};
    std::ostringstream text;
    text << "with a scale of " << scale << ", expected " << 1.0 / kLargestScale << " to "
         << kLargestScale;
    return text.str();
}
