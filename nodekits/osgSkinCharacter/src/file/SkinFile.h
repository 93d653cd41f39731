// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <osgSkinBind/BindOptions>
#include <osgSkinBind/FitSkeleton>
#include <osgSkinImport/ReadLimits>

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace osgSkin {

/// What a `.skin` file says, checked, with its paths made absolute or relative to the caller.
struct SkinFile {
    /// The newest format that this code reads.
    static constexpr std::size_t kVersion = 1;

    /// A motion file to be retargeted.
    struct MotionEntry {
        std::string file;
        std::string clip; ///< of the file's motions, by name or number; empty: the first
        std::string name;
        std::size_t skipFrames = 0;
        std::map<std::string, std::string> joints; ///< rig joint -> motion joint
    };

    /// Something that is not skin (a ball) with a path of its own during the motion called
    /// `motion`.
    struct Prop {
        std::string mesh;
        std::string motion;
        std::string file; ///< a BVH file of one joint, in the space of that motion's file
    };

    std::string file; ///< the .skin file itself
    std::string mesh;
    std::string skeleton;          ///< the mesh's own file where the description names none
    std::optional<FitOptions> fit; ///< instead of a skeleton file
    std::vector<MotionEntry> motions;
    std::vector<Prop> props;
    BindOptions bind;            ///< its `names` serve retargeting, too
    bool paintedWeights = false; ///< the binding comes from painted weights
    std::string weights;         ///< their file; empty: the mesh's own
    bool clearHands = false;     ///< hands are kept out of the body, see clearHands()
    bool zUp = false;            ///< the character's files have Z up, not Y

    /// Reads and checks a file.
    /// \throw Error with file, JSON path and what was expected
    static SkinFile read(const std::string& file, const ReadLimits& limits);
};

} // namespace osgSkin
