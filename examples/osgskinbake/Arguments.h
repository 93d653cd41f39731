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

/// What the command line asks for.
struct Arguments {
    std::string character;
    std::string motion; ///< empty: the first one
    std::optional<FrameRange> frames;
    std::optional<double> rate;   ///< samples a second of a rigged model's clips
    osgSkin::LoadOptions options; ///< that go before what the file says
    std::vector<std::pair<std::string, float>> activations; ///< of inputs, by name
    std::string out;     ///< pattern of the frames' files; empty: no frames wanted
    std::string rest;    ///< file for the bind pose; empty: not wanted
    std::string binding; ///< JSON files; empty: not wanted
    std::string pose;
    std::string formats; ///< value of the option `formats`; empty: not given
    bool quiet = false;
};

/// Bad usage: the message for the user, and exit status 2.
struct UsageError {
    std::string message;
};

/// Reads the command line. Nothing where help was asked for and has been printed.
/// \throw UsageError
std::optional<Arguments> parseArguments(int argc, char** argv);

/// The file name of one frame: `pattern` with its %d (or %04d) replaced.
std::string frameName(const std::string& pattern, std::size_t frame);

/// True where `pattern` has a place for the frame's number.
bool hasNumber(const std::string& pattern);

} // namespace bake
