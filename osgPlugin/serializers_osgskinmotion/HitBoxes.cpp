// SPDX-License-Identifier: MIT
#include "AttachmentFile.h"
#include "FileVersion.h"
#include "RegisterWrapper.h"

#include <osgSkinMotion/HitBoxes>

#include <memory>

namespace osgSkinMotion {
using osgSkin::HitBoxes; // osgDB knows classes by their libraries
} // namespace osgSkinMotion

namespace osgSkin {

/// All numbers are doubles.
template <typename Archive>
void AttachmentFile::pass(Archive& archive, HitBoxes& hits) {
    std::vector<HitBoxes::Limb> limbs = hits.limbs();
    archive(hits._toFigure);
    archive.list(limbs, "limbs", 14, [&](HitBoxes::Limb& limb) {
        archive(limb.joint, limb.parent, limb.centre, limb.hinge, limb.straight, limb.bent);
        archive.list(limb.shapes, "shapes", 39, [&](HitBoxes::Shape& shape) {
            archive.choice(shape.kind, 2, "a shape");
            archive(shape.frame, shape.half);
        });
    });
    if constexpr (Archive::kReads) {
        for (std::size_t i = 0; i < limbs.size(); ++i)
            if (limbs[i].parent < -1 || limbs[i].parent >= static_cast<int>(i))
                archive.fail("the parent of a limb does not come before it");
        if (!hits._toRest.invert(hits._toFigure)) archive.fail("its matrix is singular");
        hits._motions.assign(limbs.size(), osg::Matrixd());
        hits._limbs = std::make_shared<std::vector<HitBoxes::Limb>>(std::move(limbs));
    }
}

} // namespace osgSkin

REGISTER_OSGSKIN_WRAPPER(osgSkinMotion_HitBoxes, new osgSkin::HitBoxes, osgSkinMotion::HitBoxes,
                         "osg::Object osg::Callback osg::NodeCallback osgSkinMotion::HitBoxes") {
    addFileVersion(*wrapper);
    addBlock<osgSkin::HitBoxes, osgSkin::AttachmentFile>(*wrapper, "Limbs", "hit boxes");
}
