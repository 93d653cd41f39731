// SPDX-License-Identifier: MIT
// Any bytes as an option string.
#include "Attempt.h"

#include <osgSkinCharacter/OptionString>
#include <osgSkinImport/ReadLimits>

#include <cstdint>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const osg::ref_ptr<osgDB::Options> options =
        new osgDB::Options(std::string(reinterpret_cast<const char*>(data), size));
    fuzz::attempt([&] { osgSkin::toLoadOptions(options); });
    fuzz::attempt([&] { osgSkin::ReadLimits::of(options); });
    return 0;
}
