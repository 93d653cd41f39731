// SPDX-License-Identifier: MIT
#include "clips/ClipCheck.h"

#include <osgSkin/Error>
#include <osgSkin/GlmTypes>

#include <cmath>

namespace osgSkin {

void requireFits(const Clip& clip, const RestSkeleton& rig) {
    rig.validate();
    const std::string label = "clip \"" + clip.name + "\": ";
    if (clip.joints != rig.joints.size())
        throw Error(label + "made for " + std::to_string(clip.joints) + " joints, expected " +
                    std::to_string(rig.joints.size()));
    if (clip.frames == 0) throw Error(label + "no frame, expected at least one");
    if (!(clip.frameTime > 0.0) || !std::isfinite(clip.frameTime * double(clip.frames)))
        throw Error(label + "expected a positive frame time");
    if (clip.rotations.size() != clip.frames * clip.joints ||
        clip.rootPositions.size() != clip.frames)
        throw Error(label + "its arrays do not fit " + std::to_string(clip.frames) + " frames");
}

void requireUsable(const Clip& clip, const RestSkeleton& rig) {
    requireFits(clip, rig);
    const auto at = [&](std::size_t f) {
        return "clip \"" + clip.name + "\": frame " + std::to_string(f) + ": ";
    };
    for (std::size_t f = 0; f < clip.frames; ++f)
        if (!isInRange(clip.rootPositions[f]))
            throw Error(at(f) + "the root's position is not finite, or beyond -1e18 to 1e18");
    for (std::size_t i = 0; i < clip.rotations.size(); ++i) {
        const glm::dquat& q = clip.rotations[i];
        if (!(std::abs(glm::dot(q, q) - 1.0) <= 2e-3)) // for NaN, too
            throw Error(at(i / clip.joints) + "joint \"" + rig.joints[i % clip.joints].name +
                        "\" has a rotation that is not unit");
    }
}

} // namespace osgSkin
