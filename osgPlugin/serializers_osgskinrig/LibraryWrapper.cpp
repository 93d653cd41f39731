// SPDX-License-Identifier: MIT
// For programs that link the wrappers statically, by USE_SERIALIZER_WRAPPER_LIBRARY(osgSkinRig).
#include "KitCheck.h"
#include "RegisterWrapper.h"
#include "osgSkinBuild.h"
#include "osgSkinRigBuild.h"

#include <osgDB/Registry>

USE_SERIALIZER_WRAPPER(osgSkinRig_Constraints)
USE_SERIALIZER_WRAPPER(osgSkinRig_Gaits)
USE_SERIALIZER_WRAPPER(osgSkinRig_Springs)
USE_SERIALIZER_WRAPPER(osgSkinRig_Walker)

extern "C" void wrapper_serializer_library_osgSkinRig(void) {}

#ifndef OSGSKIN_STATIC
bool mayUseKits() {
    return plugin::mayUse("osgdb_serializers_osgskinrig",
                          {OSGSKIN_KIT_BUILD(osgSkin), OSGSKIN_KIT_BUILD(osgSkinRig)});
}
#endif
