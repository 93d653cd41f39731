// SPDX-License-Identifier: MIT
#include "CappingCost.h"

#include <osgSkinBind/Bind>

namespace quality {
namespace {

void compareFigures(const std::string& name, double capped, double uncapped, CappingCost& cost) {
    if (!(uncapped > 0.0) || capped / uncapped - 1.0 <= cost.share) return;
    cost.share = capped / uncapped - 1.0;
    cost.figure = name;
}

} // namespace

CappingCost measureCapping(const Subject& subject, const std::vector<NamedPose>& poses,
                           const PoseFigures& capped, const std::vector<WristTwist>& wrist) {
    CappingCost cost;
    if (!subject.options) return cost; // by weights
    Subject free = subject;
    osgSkin::BindOptions options = *subject.options;
    options.maxPartialInfluences = osgSkin::SkinModel::kMaxPartialInfluences;
    free.binding = osgSkin::bind(free.mesh, free.rig, options);
    free.model = modelOf(free);
    const PoseFigures uncapped = measureOurs(free, poses);
    compareFigures("edge strain RMS", capped.strain, uncapped.strain, cost);
    compareFigures("99.9 % edge", capped.percentile999, uncapped.percentile999, cost);
    compareFigures("longest edge", capped.longest, uncapped.longest, cost);
    compareFigures("volume error", capped.volumeError, uncapped.volumeError, cost);
    const std::vector<WristTwist> freeWrist = measureWristTwists(free);
    for (std::size_t i = 0; i < wrist.size(); ++i)
        compareFigures("wrist strain", wrist[i].strain[Method::Ours],
                       freeWrist[i].strain[Method::Ours], cost);
    return cost;
}

} // namespace quality
