// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <osgSkinBind/BindOptions>

#include <osgDB/Options>

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace osgSkin {

/// What a caller may ask of the plug-in beside a file: `-O "bind=smooth motion=run"`.
struct SkinOptions {
    enum class Bind {
        Default, ///< what the file says; for a rig its own weights where they are good
        Smooth,
        Paper,
        Weights
    };
    Bind bind = Bind::Default;
    std::optional<BindOptions::Shapes> shapes; ///< unset: what the file says; none for a rig
    std::optional<std::string> motion; ///< a clip's name or a motion file; "none": stay at rest
    std::optional<std::vector<std::string>> rigid; ///< joints; empty: none
    bool showRegions = false;

    /// Words of an option string that are none of ours are passed over: other readers see the same
    /// string. A value may stand in double quotes. \throw Error where one of ours has a wrong value
    static SkinOptions parse(const osgDB::Options* options);

    /// The words with what they mean, for a plug-in's list of options.
    static const std::vector<std::pair<const char*, const char*>>& list();
};

} // namespace osgSkin
