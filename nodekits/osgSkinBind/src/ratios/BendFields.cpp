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
std::vector<double> boundedField(const BinaryField& hard, const SkinSmoother& smoother,
                                 std::size_t joint, double radius, double smoothing) {
    const PlannedJoint& planned = hard.joints[joint];
    const double reach = smoothing * radius / std::max(planned.boneLength, 1e-9 * hard.mesh.size);
    const double upper = planned.options.bendUpper.value_or(
        std::min(-reach, planned.options.bendLower.value_or(reach) - reach));
    const double lower = planned.options.bendLower.value_or(std::max(reach, upper + reach));
    std::vector<double> field = hard.bounded(joint, upper, lower);
    smoother.smooth(field, kBoundedWidth * radius);
    stretch(field, kBoundedCutOff);
    return field;
}

void raise(std::vector<double>& field, const std::vector<double>& other) {
    for (std::size_t v = 0; v < field.size(); ++v) field[v] = std::max(field[v], other[v]);
}

} // namespace

JointFields bendFields(const BinaryField& hard, const std::vector<double>& radii,
                       const BindOptions& options, const std::function<void(std::size_t)>& begin) {
    const std::vector<PlannedJoint>& joints = hard.joints;
    const double widest = options.smoothing * *std::max_element(radii.begin(), radii.end());
    const SkinSmoother smoother(hard.mesh, widest);
    JointFields fields(joints.size(), std::vector<double>(hard.mesh.vertexCount(), 0.0));
    fields[0].assign(hard.mesh.vertexCount(), 1.0);
    for (std::size_t j = 1; j < joints.size(); ++j) {
        if (!joints[j].holdsRegion) continue;
        begin(j);
        fields[j] = hasBoundaries(joints[j])
                        ? boundedField(hard, smoother, j, radii[j], options.smoothing)
                        : smoothBend(hard, smoother, j, radii, options);
    }
    // Along a chain no joint turns skin that its parent leaves behind. A joint without a region (of
    // no length, or skipped) turns what its children turn.
    for (std::size_t j = joints.size(); j-- > 1;)
        if (!joints[j].belowRigid(static_cast<int>(j)))
            raise(fields[static_cast<std::size_t>(joints[j].parent)], fields[j]);
    return fields;
}

} // namespace osgSkin
