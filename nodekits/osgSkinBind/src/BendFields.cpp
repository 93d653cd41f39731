// SPDX-License-Identifier: GPL-3.0-or-later
#include "BendRegion.h"
#include "RatioFields.h"
#include "SkinSmoother.h"

#include <algorithm>

namespace osgSkin {
namespace {

/// A rigid part starts close behind its joint: its field is this much narrower.
constexpr double kRigidNarrowing = 0.6;

/// Width, in limb radii, that makes a field with boundaries of its own continuous across regions.
constexpr double kBoundedWidth = 0.25;

/// Stretches [cutOff, 1 - cutOff] to [0, 1]: beyond the bend region the ratios are exactly 0 and 1.
void stretch(std::vector<double>& field, double cutOff) {
    for (double& a : field) a = std::clamp((a - cutOff) / (1.0 - 2.0 * cutOff), 0.0, 1.0);
}

void raise(std::vector<double>& field, const std::vector<double>& other) {
    for (std::size_t v = 0; v < field.size(); ++v) field[v] = std::max(field[v], other[v]);
}

} // namespace

JointFields bendFields(const WeldedMesh& mesh, const RestSkeleton& skeleton,
                       const std::vector<PlannedJoint>& joints,
                       const std::vector<std::uint32_t>& regions, const BindOptions& options) {
    const SkinSmoother smoother(mesh);
    const BendRegion region{mesh, joints, regions};
    JointFields fields(joints.size(), std::vector<double>(mesh.vertexCount(), 0.0));
    fields[0].assign(mesh.vertexCount(), 1.0);
    for (std::size_t j = 1; j < joints.size(); ++j) {
        if (!joints[j].holdsRegion) continue;
        const double radius = region.limbRadius(j);
        const double width = options.smoothing * radius;
        const auto found = options.joints.find(skeleton.joints[j].name);
        const JointBindOptions own =
            found == options.joints.end() ? JointBindOptions() : found->second;
        if (own.bendUpper || own.bendLower) {
            const double byDefault = width / std::max(joints[j].boneLength, 1e-9 * mesh.size);
            fields[j] = region.boundedField(j, own.bendUpper.value_or(-byDefault),
                                            own.bendLower.value_or(byDefault));
            smoother.smooth(fields[j], kBoundedWidth * radius);
        } else {
            fields[j] = region.hardField(j);
            smoother.smooth(fields[j], joints[j].rigid >= 0 ? kRigidNarrowing * width : width);
        }
        stretch(fields[j], options.cutOff);
    }
    // Along a chain no joint turns skin that its parent leaves behind. A joint without a region (of
    // no length, or skipped) turns what its children turn.
    for (std::size_t j = joints.size(); j-- > 1;)
        if (!joints[j].belowRigid(static_cast<int>(j)))
            raise(fields[static_cast<std::size_t>(joints[j].parent)], fields[j]);
    return fields;
}

} // namespace osgSkin
