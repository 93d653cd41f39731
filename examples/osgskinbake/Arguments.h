// SPDX-License-Identifier: MIT
#pragma once

#include "CommandLine.h"
#include "FrameRange.h"

#include <osgSkinCharacter/LoadOptions>
#include <osgSkinMotion/MakeWalker>

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace bake {

/// The parsed command line.
struct Arguments {
    std::string character;
    std::string motion; ///< if empty, the first one
    std::optional<example::FrameRange> frames;
    std::optional<double> rate;   ///< samples per second of a rigged model's clips
    osgSkin::LoadOptions options; ///< override the character file's
    std::vector<std::pair<std::string, float>> activations; ///< of inputs, by name
    std::vector<std::pair<std::string, float>> morphs;      ///< weights of morph targets, by name
    std::string out;                      ///< file name pattern of the frames; empty for no frames
    std::string rest;                     ///< file for the bind pose; empty for none
    std::string binding;                  ///< JSON file for the binding; empty for none
    std::string pose;                     ///< JSON file for the poses; empty for none
    std::string rigged;                   ///< file with a skeleton; empty for none
    std::size_t helpers = 8, weights = 4; ///< of `rigged`, see LinearSkinOptions
    std::string walker;                   ///< .osgb file for a walker; empty for none
    osgSkin::WalkerOptions walkerOptions;
    std::string formats; ///< value of the option `formats`; empty if not given
    bool list = false;   ///< only list joints, clips, morph targets and muscles
    bool quiet = false;
};

using example::UsageError;

/// Defines the arguments in `line` and reads them.
/// \throw UsageError for bad usage
Arguments parseArguments(example::CommandLine& line, int argc, const char* const* argv);

/// The file name of one frame: `pattern` with its %d (or %04d) replaced.
std::string frameName(const std::string& pattern, std::size_t frame);

/// True if `pattern` has a placeholder for the frame number.
bool hasNumber(const std::string& pattern);

} // namespace bake
