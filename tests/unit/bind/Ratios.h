// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <osgSkin/Binding>

#include <cstddef>
#include <string>

/// The ratios of a joint at a vertex; both 0 if it is not listed.
inline osgSkin::Influence ratiosOf(const osgSkin::Binding& binding, std::size_t vertex,
                                   std::size_t joint) {
    for (std::uint32_t i = binding.firstInfluence[vertex]; i < binding.firstInfluence[vertex + 1];
         ++i)
        if (binding.influences[i].joint == joint) return binding.influences[i];
    return {static_cast<std::uint32_t>(joint), 0.0f, 0.0f};
}

/// Index of the joint `name`.
inline std::size_t jointCalled(const osgSkin::Binding& binding, const std::string& name) {
    std::size_t j = 0;
    while (j < binding.joints.size() && binding.joints[j].name != name) ++j;
    return j;
}

/// Joints of the vertex with a ratio strictly between 0 and 1, without those that bend it as the
/// next one does.
inline std::size_t partialJoints(const osgSkin::Binding& binding, std::size_t vertex) {
    std::size_t count = 0;
    for (std::uint32_t i = binding.firstInfluence[vertex]; i < binding.firstInfluence[vertex + 1];
         ++i) {
        const osgSkin::Influence& influence = binding.influences[i];
        const bool isLast = i + 1 == binding.firstInfluence[vertex + 1];
        const bool beginsLimb = !isLast && influence.bend == binding.influences[i + 1].bend &&
                                influence.twist != binding.influences[i + 1].twist;
        if (influence.isFractional() && !beginsLimb) ++count;
    }
    return count;
}

/// Expects the invariants of every binding at every vertex: it validates, no joint's ratio exceeds
/// its parent's, and no more joints are partial than were asked for.
void expectSound(const osgSkin::Binding& binding, std::size_t maxPartial = 4);
