// SPDX-License-Identifier: MIT
#include <osgSkinCharacter/LoadCharacter>

/// Loads a character, whose first motion plays.
osg::ref_ptr<osg::Node> loadAndPlay(const std::string& file) {
    const osgSkin::Character character = osgSkin::loadCharacter(file);
    return character.root;
}
