// SPDX-License-Identifier: MIT
#ifndef OSGSKINCHARACTER_OPTIONS_SKINFILE_H
#define OSGSKINCHARACTER_OPTIONS_SKINFILE_H

#include <osgSkinBind/BindOptions>
#include <osgSkinBind/FitSkeleton>
#include <osgSkinCharacter/LoadOptions>
#include <osgSkinImport/ReadLimits>
#include <osgSkinMotion/SpringSettings>
#include <osgSkinRig/Retarget>

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace osgSkin {

/// The content of a `.skin` file, checked. Its paths are absolute or relative to the working
/// directory.
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
        RetargetOptions::Up up = RetargetOptions::Up::Unknown;
    };

    /// An object (a ball) that moves along its own path during the motion called `motion`.
    struct Prop {
        std::string mesh;
        std::string motion;
        std::string file; ///< a BVH file of one joint, in the space of that motion's file
    };

    /// Joints that swing, with all joints below them.
    struct Spring {
        std::vector<std::string> joints;
        SpringSettings::Joint like; ///< its gravity is along -Y, or -Z where that is down
        std::string centre;
        std::vector<SpringSettings::Collider> colliders; ///< relative to their joints
    };

    std::string file; ///< the .skin file itself
    std::string mesh;
    std::string skeleton;          ///< the mesh's file where the description names none
    std::optional<FitOptions> fit; ///< instead of a skeleton file
    std::vector<MotionEntry> motions;
    std::vector<Prop> props;
    std::vector<Spring> springs;
    LoadOptions options; ///< the members that are options, see optionTable()
    BindOptions bind;    ///< only joints, names and own muscles; the names serve retargeting, too
    std::string weights; ///< file of painted weights; empty: the mesh's own
    RetargetOptions::Up up = RetargetOptions::Up::Unknown; ///< unknown: the files have Y up

    /// Reads and checks a file.
    /// \throw Error with file, JSON path and what was expected
    static SkinFile read(const std::string& file, const ReadLimits& limits);
};

} // namespace osgSkin

#endif
