// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkin/Error>
#include <osgSkinCharacter/LoadCharacter>
#include <osgSkinCharacter/OptionString>

#include <string>

namespace test {

/// A plug-in's option string as loadCharacter() takes it.
inline osgSkin::LoadOptions loadOptions(const std::string& text) {
    const osg::ref_ptr<osgDB::Options> options = new osgDB::Options(text);
    return osgSkin::toLoadOptions(options);
}

/// What the error says of a file that cannot be loaded; "read" where it can.
inline std::string whyRefused(const std::string& file, const osgSkin::LoadOptions& options = {}) {
    try {
        osgSkin::loadCharacter(file, options);
    } catch (const osgSkin::Error& error) {
        return error.what();
    }
    return "read";
}

} // namespace test
