// SPDX-License-Identifier: GPL-3.0-or-later
// Any bytes as a `.skin` file beside a small body, skeleton, motion and weights: the whole way to a
// character.
#include "InputFile.h"

#include <osgSkin/Error>
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
    // Minutes of solving are no hang: elastic shapes have tests of their own.
    options.shapes = osgSkin::BindOptions::Shapes::Fast;
    try {
        osgSkin::loadCharacter(fuzz::save("input.skin", data, size), options);
    } catch (const osgSkin::Error&) {
    }
    return 0;
}
