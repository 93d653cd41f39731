// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkin/Error>
#include <osgSkinCharacter/LoadCharacter>
#include <osgSkinCharacter/OptionString>

#include <string>

namespace test {

/// Parses a plug-in's option string into the options of loadCharacter().
inline osgSkin::LoadOptions loadOptions(const std::string& text) {
    const osg::ref_ptr<osgDB::Options> options = new osgDB::Options(text);
    return osgSkin::toLoadOptions(options);
}

/// The error message for a file that cannot be loaded, or "read".
inline std::string whyRefused(const std::string& file, const osgSkin::LoadOptions& options = {}) {
    try {
        osgSkin::loadCharacter(file, options);
    } catch (const osgSkin::Error& error) {
        return error.what();
    }
    return "read";
}

/// \param options as the plug-in's
inline std::string whyRefused(const std::string& file, const std::string& options) {
    return whyRefused(file, loadOptions(options));
}

} // namespace test
