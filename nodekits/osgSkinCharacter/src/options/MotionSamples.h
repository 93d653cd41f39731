// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <osgSkinImport/ReadLimits>

#include <cstddef>
#include <set>
#include <string>

namespace osgSkin {

/// How many rotations the motions of a character have, of its props too: a short file that is named
/// often takes as much memory as a long one.
class MotionSamples {
public:
    /// Counts a motion that was read.
    ///
    /// \param file that it is from; whose size counts once, whatever way a path goes to it
    /// \param frames of the motion, those too that were skipped
    /// \param joints that it has, or that it is made for
    /// \param limits of the character
    /// \throw osgSkin::Error where all motions together are more than ReadLimits::samplesOf() of
    ///        their files
    void add(const std::string& file, std::size_t frames, std::size_t joints,
             const ReadLimits& limits);

private:
    std::set<std::string> _files;
    std::size_t _bytes = 0;   ///< of them
    std::size_t _samples = 0; ///< so far, within the limit
};

} // namespace osgSkin
