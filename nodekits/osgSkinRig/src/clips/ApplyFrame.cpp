// SPDX-License-Identifier: MIT
#include <osgSkinRig/ApplyFrame>

#include "bones/HoldInCallback.h"
#include "clips/ClipCheck.h"
#include "clips/ClipOnBones.h"

#include <osgSkin/Error>

#include <osg/Notify>

#include <string>

namespace osgSkin {

void applyFrame(const Clip& clip, const RestSkeleton& rig, std::size_t frame,
                osgAnimation::Skeleton& skeleton) {
    requireFits(clip, rig);
    if (frame >= clip.frames)
        throw Error("clip \"" + clip.name + "\": no frame " + std::to_string(frame) +
                    ", expected less than " + std::to_string(clip.frames));
    const ClipOnBones bones(clip, rig, skeleton);
    const std::vector<ClipOnBones::Matrices> posed = bones.frame(frame);
    std::string notHeld;
    for (std::size_t j = 0; j < posed.size(); ++j) {
        osgAnimation::Bone* bone = bones.bone(j);
        if (!bone) continue;
        bone->setMatrix(posed[j].local);
        bone->setMatrixInSkeletonSpace(posed[j].inSkeleton);
        if (!holdInCallback(*bone, posed[j].local) && notHeld.empty()) notHeld = bone->getName();
    }
    if (!notHeld.empty())
        OSG_WARN << onOneLine("osgSkin: applyFrame(): bone \"" + notHeld + "\" of skeleton \"" +
                              skeleton.getName() +
                              "\" goes back to its own pose at the next update: expected an update "
                              "callback of one translation and one rotation, or of one matrix")
                 << std::endl;
}

} // namespace osgSkin
