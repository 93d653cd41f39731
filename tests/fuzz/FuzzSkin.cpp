// SPDX-License-Identifier: MIT
// Any bytes as a `.skin` file beside a small body, skeleton, motion and weights, up to the
// character.
#include "Attempt.h"
#include "InputFile.h"

#include <osgSkinCharacter/LoadCharacter>

#include <osg/Notify>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const bool isReady = [] {
        osg::setNotifyLevel(osg::ALWAYS);
        setenv("XDG_CACHE_HOME", fuzz::folder().c_str(), 1);
        for (const char* part : {"body.obj", "rig.bvh", "move.bvh", "weights.json"})
            std::filesystem::copy_file(std::string(OSGSKIN_TEST_DATA "/character/") + part,
                                       fuzz::folder() + "/" + part);
        return true;
    }();
    (void)isReady;
    osgSkin::LoadOptions options;
    fuzz::attempt([&] { osgSkin::loadCharacter(fuzz::save("input.skin", data, size), options); });
    return 0;
}
