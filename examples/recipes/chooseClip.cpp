// SPDX-License-Identifier: MIT
#include <osgSkinCharacter/LoadCharacter>

#include <iostream>
#include <stdexcept>

/// Lists a character's clips, and plays the last one in place of the first.
osg::ref_ptr<osg::Node> chooseClip(const std::string& file) {
    osgSkin::Character character = osgSkin::loadCharacter(file);
    for (const osgSkin::CharacterMotion& motion : character.motions)
        std::cout << motion.name() << ", " << motion.duration() << " s\n";
    if (character.motions.empty()) throw std::runtime_error(file + ": has no clips");
    character.play(character.motions.back().name());
    return character.root;
}
