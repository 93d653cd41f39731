// SPDX-License-Identifier: MIT
#include "BindFigures.h"

#include <osgSkinBind/Bind>

#include <algorithm>

namespace quality {
namespace {

/// For each joint the one that its region counts as.
std::vector<std::size_t> shownJoints(const osgSkin::RestSkeleton& rig) {
    const std::vector<std::string> rigid = osgSkin::automaticRigidJoints(rig);
    std::vector<std::size_t> shown(rig.joints.size(), 0);
    for (std::size_t j = 1; j < shown.size(); ++j) {
        const std::size_t above = shown[static_cast<std::size_t>(rig.joints[j].parent)];
        const bool inRigid = std::count(rigid.begin(), rigid.end(), rig.joints[above].name) > 0;
        const bool noLength = rig.joints[j].centre == rig.joints[above].centre;
        shown[j] = inRigid || noLength ? above : j;
    }
    return shown;
}

double farRegions(const Subject& subject) {
    const std::vector<std::size_t> shown = shownJoints(subject.rig);
    const auto parent = [&](std::size_t j) {
        return j == 0 ? j : shown[static_cast<std::size_t>(subject.rig.joints[j].parent)];
    };
    std::size_t far = 0;
    for (std::size_t v = 0; v < subject.rest.size(); ++v) {
        const std::size_t painted = shown[subject.dominantJoint(v)];
        const std::size_t ours = shown[subject.binding.regions[v]];
        if (ours != painted && parent(ours) != painted && parent(painted) != ours) ++far;
    }
    return static_cast<double>(far) / static_cast<double>(subject.rest.size());
}

} // namespace

BindFigures measureBinding(const Subject& subject) {
    BindFigures figures;
    figures.farRegions = farRegions(subject);
    const osgSkin::Binding& binding = subject.binding;
    std::size_t sum = 0;
    for (std::size_t v = 0; v < binding.vertexCount(); ++v) {
        const auto begin = binding.influences.begin() + binding.firstInfluence[v];
        const auto end = binding.influences.begin() + binding.firstInfluence[v + 1];
        const auto count = static_cast<std::size_t>(std::count_if(
            begin, end, [](const osgSkin::Influence& influence) { return influence.isPartial(); }));
        figures.mostInfluences = std::max(figures.mostInfluences, count);
        sum += count;
    }
    const auto vertices = static_cast<double>(binding.vertexCount());
    figures.meanInfluences = static_cast<double>(sum) / vertices;
    figures.cappedShare = static_cast<double>(subject.report.cappedVertices) / vertices;
    figures.seconds = subject.report.seconds;
    return figures;
}

} // namespace quality
