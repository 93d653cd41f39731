// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <vector>

/// Draws whole frames of 1920 x 1080 pixels without a display, and prints their median times; last,
/// the first frame of one character and of a crowd.
///
/// \param file of a character, with an animation
/// \param crowds numbers of members, of one GpuCrowd each; with and without correctives (of a .skin
///        file), seen by one camera and by four
/// \param maxTriangles of the crowds, which are drawn with it once more; 0: none
/// \param singles number of characters that are loaded one by one, each with its own skeleton, drawn
///        by the graphics card and by the processor, which uploads in both ways, and again with 52
///        morph targets on the largest skin of each; 0: none
/// \throw std::runtime_error where there is no context or the file cannot be read
void benchFrames(const std::string& file, const std::vector<std::size_t>& crowds,
                 std::size_t maxTriangles, std::size_t singles);
