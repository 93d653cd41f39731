// SPDX-License-Identifier: MIT
// For programs that link the wrappers statically, by USE_SERIALIZER_WRAPPER_LIBRARY(osgSkinMotion).
#include "KitCheck.h"
#include "RegisterWrapper.h"
#include "osgSkinBuild.h"
#include "osgSkinMotionBuild.h"
#include "osgSkinRigBuild.h"

#include <osgDB/Registry>

USE_SERIALIZER_WRAPPER(osgSkinMotion_ClipPlayer)
USE_SERIALIZER_WRAPPER(osgSkinMotion_Constraints)
USE_SERIALIZER_WRAPPER(osgSkinMotion_FaceControls)
USE_SERIALIZER_WRAPPER(osgSkinMotion_FootPlacement)
USE_SERIALIZER_WRAPPER(osgSkinMotion_Gaits)
USE_SERIALIZER_WRAPPER(osgSkinMotion_HitBoxes)
USE_SERIALIZER_WRAPPER(osgSkinMotion_LivePlayer)
USE_SERIALIZER_WRAPPER(osgSkinMotion_PlacedBone)
USE_SERIALIZER_WRAPPER(osgSkinMotion_SpringBones)
USE_SERIALIZER_WRAPPER(osgSkinMotion_Walker)

extern "C" void wrapper_serializer_library_osgSkinMotion(void) {}

#ifndef OSGSKIN_STATIC
bool mayUseKits() {
    return plugin::mayUse("osgdb_serializers_osgskinmotion",
                          {OSGSKIN_KIT_BUILD(osgSkin), OSGSKIN_KIT_BUILD(osgSkinRig),
                           OSGSKIN_KIT_BUILD(osgSkinMotion)});
}
#endif
