// SPDX-License-Identifier: MIT
#include "FileVersion.h"
#include "RegisterWrapper.h"

#include <osgSkin/CharacterGroup>

REGISTER_OSGSKIN_WRAPPER(osgSkin_CharacterGroup, new osgSkin::CharacterGroup,
                         osgSkin::CharacterGroup,
                         "osg::Object osg::Node osg::Group osgSkin::CharacterGroup") {
    addFileVersion(*wrapper);
}
