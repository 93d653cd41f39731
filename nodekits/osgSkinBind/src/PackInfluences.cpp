// SPDX-License-Identifier: GPL-3.0-or-later
#include "PackInfluences.h"

#include <algorithm>

namespace osgSkin {
namespace {

/// Ratios this close to 0 or 1 cost a frame's work for a movement that nobody sees.
constexpr double kNothing = 1e-4;

float ratio(double a) {
    if (a < kNothing) return 0.0f;
    return a > 1.0 - kNothing ? 1.0f : static_cast<float>(a);
}

float distanceToFull(float a) {
    return std::min(a, 1.0f - a);
}

/// How far from 0 or 1 the joint's ratios are.
float partialness(const Influence& i) {
    return std::max(distanceToFull(i.bend), distanceToFull(i.twist));
}

/// Rounds the influence; what follows it (0) or leads to it (1) is rounded along.
void roundOff(const std::vector<PlannedJoint>& joints, std::vector<Influence>& all,
              std::size_t joint) {
    const bool up = all[joint].bend + all[joint].twist > 1.0f;
    if (up) {
        for (int j = static_cast<int>(joint); j >= 0;
             j = joints[static_cast<std::size_t>(j)].parent)
            all[static_cast<std::size_t>(j)].bend = all[static_cast<std::size_t>(j)].twist = 1.0f;
        return;
    }
    all[joint].bend = all[joint].twist = 0.0f;
    for (std::size_t j = joint + 1; j < all.size(); ++j) {
        const Influence& parent = all[static_cast<std::size_t>(joints[j].parent)];
        if (parent.bend == 0.0f && parent.twist == 0.0f) all[j].bend = all[j].twist = 0.0f;
    }
}

} // namespace

bool isPartial(const Influence& influence) {
    return partialness(influence) > 0.0f;
}

bool packInfluences(const std::vector<PlannedJoint>& joints, const JointFields& bend,
                    const JointFields& twist, std::size_t vertex,
                    std::vector<Influence>& influences) {
    std::vector<Influence> all(joints.size());
    for (std::size_t j = 0; j < joints.size(); ++j)
        all[j] = {static_cast<std::uint32_t>(j), ratio(bend[j][vertex]), ratio(twist[j][vertex])};

    bool capped = false;
    while (static_cast<std::size_t>(std::count_if(all.begin(), all.end(), isPartial)) >
           kMaxPartialJoints) {
        capped = true;
        std::size_t least = all.size();
        for (std::size_t j = 0; j < all.size(); ++j)
            if (isPartial(all[j]) &&
                (least == all.size() || partialness(all[j]) < partialness(all[least])))
                least = j;
        roundOff(joints, all, least);
    }
    for (const Influence& influence : all)
        if (influence.bend > 0.0f || influence.twist > 0.0f) influences.push_back(influence);
    return capped;
}

} // namespace osgSkin
