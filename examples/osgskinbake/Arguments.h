// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <osgSkinCharacter/LoadOptions>

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace bake {

/// Samples first, first + step, ... up to and including last.
struct FrameRange {
    std::size_t first = 0;
    std::size_t last = 0;
    std::size_t step = 1;
};

/// The parsed command line.
struct Arguments {
    std::string character;
    std::string motion; ///< if empty, the first one
    std::optional<FrameRange> frames;
    std::optional<double> rate;   ///< samples per second of a rigged model's clips
    osgSkin::LoadOptions options; ///< override the character file's
    std::vector<std::pair<std::string, float>> activations; ///< of inputs, by name
    std::vector<std::pair<std::string, float>> morphs;      ///< weights of morph targets, by name
    std::string out;     ///< file name pattern of the frames; empty for no frames
    std::string rest;    ///< file for the bind pose; empty for none
    std::string binding; ///< JSON file for the binding; empty for none
    std::string pose;    ///< JSON file for the poses; empty for none
    std::string formats; ///< value of the option `formats`; empty if not given
    bool quiet = false;
};

/// Bad usage: the program prints the message and exits with 2.
struct UsageError {
    std::string message;
};

/// Reads the command line. Returns nothing if the user asked for the help, after printing it.
/// \throw UsageError for bad usage
std::optional<Arguments> parseArguments(int argc, char** argv);

/// The file name of one frame: `pattern` with its %d (or %04d) replaced.
std::string frameName(const std::string& pattern, std::size_t frame);

/// True if `pattern` has a placeholder for the frame number.
bool hasNumber(const std::string& pattern);

} // namespace bake
