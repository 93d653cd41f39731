// SPDX-License-Identifier: MIT
#include "SavedPose.h"

#include <glm/gtc/type_ptr.hpp>
#include <glm/mat3x3.hpp>

#include <cmath>
#include <sstream>

namespace {

constexpr double kLargestScale = 1e9;   ///< the smallest is its inverse, like in Pose::set()
constexpr double kLargestNumber = 1e18; ///< its square still fits a float

} // namespace

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
