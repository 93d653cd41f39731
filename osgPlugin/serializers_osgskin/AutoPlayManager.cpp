// SPDX-License-Identifier: MIT
// Callbacks have virtual bases, for which the wrapper's default cast does not compile.
#undef OBJECT_CAST
#define OBJECT_CAST dynamic_cast

#include "BlockRows.h"
#include "FileVersion.h"
#include "RegisterWrapper.h"
#include "serialize/AnimationBlock.h"

#include <osgSkin/AutoPlayManager>

#include <osgDB/InputStream>
#include <osgDB/OutputStream>

#include <algorithm>
#include <cstdint>
#include <exception>
#include <string>
#include <vector>

namespace {

using osgAnimation::AnimationList;

/// The animations of a manager that are there.
AnimationList animationsOf(const osgSkin::AutoPlayManager& manager) {
    AnimationList all = manager.getAnimationList();
    all.erase(std::remove(all.begin(), all.end(), nullptr), all.end());
    return all;
}

bool checkClips(const osgSkin::AutoPlayManager& manager) {
    return !animationsOf(manager).empty();
}

/// A block with the animations that have a place in it, then the others, as osgAnimation saves
/// them: .osgx cannot have numbers behind an object.
bool writeClips(osgDB::OutputStream& os, const osgSkin::AutoPlayManager& manager) {
    const AnimationList all = animationsOf(manager);
    const std::vector<std::uint32_t> words = osgSkin::packAnimations(all);
    AnimationList packed;
    try {
        packed = osgSkin::unpackAnimations(words);
    } catch (const std::exception& error) { // such a file would be refused
        os.throwException(std::string("osgSkin: ") + error.what());
        return false;
    }
    os << os.BEGIN_BRACKET << std::endl;
    writeWords(os, words);
    for (std::size_t i = 0; i < all.size(); ++i)
        if (!packed[i]) os << all[i];
    os << os.END_BRACKET << std::endl;
    return true;
}

bool readClips(osgDB::InputStream& is, osgSkin::AutoPlayManager& manager) {
    is >> is.BEGIN_BRACKET;
    std::vector<std::uint32_t> words;
    if (!readWords(is, words)) return false;
    AnimationList all;
    try {
        all = osgSkin::unpackAnimations(words);
    } catch (const std::exception& error) {
        is.throwException(std::string("osgSkin: ") + error.what()); // refuses the whole file
        return false;
    }
    for (auto& animation : all)
        if (!animation) animation = is.readObjectOfType<osgAnimation::Animation>();
    is >> is.END_BRACKET;
    if (is.getException()) return false;
    all.erase(std::remove(all.begin(), all.end(), nullptr), all.end());
    manager.registerAnimations(all);
    return true;
}

} // namespace

REGISTER_OSGSKIN_WRAPPER(osgSkin_AutoPlayManager, new osgSkin::AutoPlayManager,
                         osgSkin::AutoPlayManager,
                         "osg::Object osg::Callback osg::NodeCallback osgSkin::AutoPlayManager") {
    addFileVersion(*wrapper);
    ADD_USER_SERIALIZER(Clips);
    ADD_BOOL_SERIALIZER(AutomaticLink, true);
}
