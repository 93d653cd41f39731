// SPDX-License-Identifier: MIT
// For programs that link the wrappers statically, by USE_SERIALIZER_WRAPPER_LIBRARY(osgSkin).
#include "KitCheck.h"
#include "RegisterWrapper.h"
#include "osgSkinBuild.h"

#include <osgDB/Registry>

USE_SERIALIZER_WRAPPER(osgSkin_AutoPlayManager)
USE_SERIALIZER_WRAPPER(osgSkin_CharacterGroup)
USE_SERIALIZER_WRAPPER(osgSkin_CullPlayedSkeleton)
USE_SERIALIZER_WRAPPER(osgSkin_DeformableSkin)
USE_SERIALIZER_WRAPPER(osgSkin_MorphTargets)
USE_SERIALIZER_WRAPPER(osgSkin_PlayedSkeletonBound)
USE_SERIALIZER_WRAPPER(osgSkin_RigidPart)
USE_SERIALIZER_WRAPPER(osgSkin_SkinModel)
USE_SERIALIZER_WRAPPER(osgSkin_UpdateDeformableSkin)
USE_SERIALIZER_WRAPPER(osgSkin_UpdateMorphs)
USE_SERIALIZER_WRAPPER(osgSkin_UpdatePlayedSkeleton)

extern "C" void wrapper_serializer_library_osgSkin(void) {}

#ifndef OSGSKIN_STATIC
bool mayUseKits() {
    return plugin::mayUse("osgdb_serializers_osgskin", {OSGSKIN_KIT_BUILD(osgSkin)});
}
#endif
