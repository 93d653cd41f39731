// SPDX-License-Identifier: GPL-3.0-or-later
#include "ratios/BendFields.h"

#include "mesh/SkinSmoother.h"
#include "ratios/SmoothBend.h"

#include <algorithm>

namespace osgSkin {
namespace {

/// Width, in limb radii, that makes a field with boundaries of its own continuous across regions.
constexpr double kBoundedWidth = 0.25;
/// That little is cut off again, so that the ratios are exact close beyond the boundaries.
constexpr double kBoundedCutOff = 0.02;

bool hasBoundaries(const PlannedJoint& joint) {
    return joint.options.bendUpper || joint.options.bendLower;
}

/// The bend field between the boundaries that the author set, one of which may be missing.
std::vector<double> boundedField(const BinaryField& binary, const SkinSmoother& smoother,
                                 std::size_t joint, double radius, double smoothing) {
    const PlannedJoint& planned = binary.joints[joint];
    const double reach = smoothing * radius / std::max(planned.boneLength, 1e-9 * binary.mesh.size);
    const double upper = planned.options.bendUpper.value_or(
        std::min(-reach, planned.options.bendLower.value_or(reach) - reach));
    const double lower = planned.options.bendLower.value_or(std::max(reach, upper + reach));
    std::vector<double> field = binary.bounded(joint, upper, lower);
    smoother.smooth(field, kBoundedWidth * radius);
    stretch(field, kBoundedCutOff);
    return field;
}

/// Lowers a field to another: a finger moves nothing that its hand leaves behind.
void lower(std::vector<double>& field, const std::vector<double>& most) {
    for (std::size_t v = 0; v < field.size(); ++v) field[v] = std::min(field[v], most[v]);
}

} // namespace

JointFields bendFields(const BinaryField& binary, const std::vector<double>& radii,
                       const BindOptions& options, const std::function<void(std::size_t)>& begin) {
    const std::vector<PlannedJoint>& joints = binary.joints;
    const double widest = options.smoothing * *std::max_element(radii.begin(), radii.end());
    const SkinSmoother smoother(binary.mesh, widest);
    JointFields fields(joints.size(), binary.mesh.vertexCount());
    fields.set(0, std::vector<double>(binary.mesh.vertexCount(), 1.0));
    for (std::size_t j = 1; j < joints.size(); ++j) {
        if (!joints[j].holdsRegion) continue;
        begin(j);
        std::vector<double> field =
            hasBoundaries(joints[j])
                ? boundedField(binary, smoother, j, radii[j], options.smoothing)
                : smoothBend(binary, smoother, j, radii, options);
        if (joints[j].digit && joints[regionAbove(joints, j)].extremity)
            lower(field, fields.values(regionAbove(joints, j)));
        fields.set(j, field);
    }
    raiseParents(joints, fields);
    return fields;
}

} // namespace osgSkin
