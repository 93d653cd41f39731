// SPDX-License-Identifier: MIT
#include "clips/ClipCheck.h"

#include <osgSkin/Error>

namespace osgSkin {

void requireFits(const Clip& clip, const RestSkeleton& rig) {
    rig.validate();
    const std::string label = "clip \"" + clip.name + "\": ";
    if (clip.joints != rig.joints.size())
        throw Error(label + "made for " + std::to_string(clip.joints) + " joints, expected " +
                    std::to_string(rig.joints.size()));
    if (clip.frames == 0) throw Error(label + "no frame, expected at least one");
    if (!(clip.frameTime > 0.0)) throw Error(label + "expected a positive frame time");
    if (clip.rotations.size() != clip.frames * clip.joints ||
        clip.rootPositions.size() != clip.frames)
        throw Error(label + "its arrays do not fit " + std::to_string(clip.frames) + " frames");
}

} // namespace osgSkin
