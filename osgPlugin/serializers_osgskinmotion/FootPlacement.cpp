// SPDX-License-Identifier: MIT
#include "AttachmentFile.h"
#include "FileVersion.h"
#include "RegisterWrapper.h"
#include "ground/LegsOnGround.h"

#include <osgSkinMotion/FootPlacement>

#include <osg/Notify>

#include <cmath>
#include <memory>

namespace osgSkinMotion {
using osgSkin::FootPlacement; // osgDB knows classes by their libraries
} // namespace osgSkinMotion

namespace osgSkin {

/// The bones; whether the feet have stood on a ground, and then their present steps.
template <typename Archive>
void AttachmentFile::pass(Archive& archive, FootPlacement& feet) {
    archive(feet._topName, feet._toLevel, feet._floor, feet._leg, feet._weight, feet._toWorld);
    for (FootPlacement::Leg& leg : feet._legs) {
        for (std::string& name : leg.names) archive(name);
        archive(leg.heel, leg.ball, leg.tip, leg.knees);
    }
    for (const double number : {feet._floor, feet._leg, feet._weight})
        if (!std::isfinite(number)) archive.fail("a number is not finite");
    if constexpr (!Archive::kReads)
        if (feet._ground)
            OSG_NOTICE << "osgSkin: the ground of a FootPlacement is not saved; set it again by "
                          "setGround()"
                       << std::endl;
    bool stands = feet._onGround != nullptr;
    archive(stands);
    if (!stands) return;
    if constexpr (Archive::kReads) {
        feet._onGround = std::make_unique<LegsOnGround>(feet._floor, feet._leg);
        feet._isRead = true;
    }
    LegsOnGround& legs = *feet._onGround;
    for (LegsOnGround::Foot& foot : legs._feet) {
        archive(foot.isPlanted, foot.from.point, foot.from.normal, foot.next.point,
                foot.next.normal, foot.lifted, foot.shift, foot.way, foot.share, foot.clear,
                foot.error, foot.errorSpeed, foot.normal, foot.speed, foot.brake, foot.stood,
                foot.slides, foot.ankle);
        for (glm::dvec3& point : foot.sole) archive(point);
        archive(foot.turns.thigh, foot.turns.shin, foot.turns.foot);
    }
    archive(legs._newest, legs._lift, legs._liftSpeed, legs._isPlaced);
    if (legs._newest > 1) archive.fail("it has no such foot");
}

} // namespace osgSkin

REGISTER_OSGSKIN_WRAPPER(
    osgSkinMotion_FootPlacement, new osgSkin::FootPlacement, osgSkinMotion::FootPlacement,
    "osg::Object osg::Callback osg::NodeCallback osgSkinMotion::FootPlacement") {
    addFileVersion(*wrapper);
    addBlock<osgSkin::FootPlacement, osgSkin::AttachmentFile>(*wrapper, "Feet", "feet");
}
