// SPDX-License-Identifier: MIT
// Callbacks have virtual bases, for which the wrapper's default cast does not compile.
#undef OBJECT_CAST
#define OBJECT_CAST dynamic_cast

#include "RegisterWrapper.h"

#include <osgSkin/AutoPlayManager>

#include <osgDB/InputStream>
#include <osgDB/OutputStream>

REGISTER_OSGSKIN_WRAPPER(osgSkin_AutoPlayManager, new osgSkin::AutoPlayManager,
                         osgSkin::AutoPlayManager,
                         "osg::Object osg::Callback osg::NodeCallback "
                         "osgAnimation::AnimationManagerBase osgAnimation::BasicAnimationManager "
                         "osgSkin::AutoPlayManager") {}
