// SPDX-License-Identifier: MIT
#pragma once

#include <string>

/// Writes the characters that recipes show, made of the thrower in `data`, into `folder`:
///
/// | file | contents |
/// |---|---|
/// | `walker.skin`, `walk.bvh`, `wave.bvh` | the thrower's body with two clips that loop |
/// | `coarse.skin`, `coarse.obj` | the same with a fifth of the triangles |
/// | `face.osgb` | a standing figure with the morph targets "smile" and "blink" |
/// | `pedestrian.skin` and its files | the pedestrian of `data` |
/// | `rig.osgt` | an osgAnimation::RigGeometry with weights, and its clip |
///
/// \throw std::exception where a file cannot be read or written
void writeSamples(const std::string& data, const std::string& folder);

/// A character with fewer triangles and the same joints: that of writeSamples() for the samples, or
/// one beside it that is made of a model or a `.skin` file.
///
/// \param file of a character
/// \return its file
/// \throw std::exception where there is none
std::string coarserOf(const std::string& file);
