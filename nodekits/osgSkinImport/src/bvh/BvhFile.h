// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_BVH_BVHFILE_H
#define OSGSKINIMPORT_BVH_BVHFILE_H

#include <osgSkinImport/ReadLimits>

#include <glm/vec3.hpp>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace osgSkin {

/// One number that a BVH file gives for a joint in each frame.
struct BvhChannel {
    bool isRotation = false; ///< degrees about the axis; else the position along it
    int axis = 0;            ///< 0 to 2: x, y, z
};

/// A joint as the HIERARCHY declares it.
struct BvhJoint {
    std::string name;
    int parent = -1;                   ///< -1 for the root
    glm::dvec3 offset{0.0};            ///< from the parent joint, in the zero pose
    std::optional<glm::dvec3> endSite; ///< the first End Site's offset from this joint
    std::vector<BvhChannel> channels;  ///< in the file's order: rotations multiply so
    std::size_t firstChannel = 0;      ///< of the joint's, among a frame's values

    /// Whether the file gives the joint's position, which then takes the place of its offset.
    bool hasPosition() const;
};

/// A BVH file's content, word for word: the file's own unit, degrees.
struct BvhFile {
    std::vector<BvhJoint> joints; ///< in file order: parents before their children
    std::size_t channels = 0;     ///< of all joints together
    double frameTime = 0.0;       ///< seconds, positive
    std::size_t frames = 0;       ///< may be 0
    std::vector<double> values;   ///< [frame * channels + channel]

    /// The values of a frame.
    const double* frame(std::size_t index) const { return values.data() + index * channels; }
};

/// Reads a BVH file.
///
/// Keywords may have any case, names may have blanks in them, and a frame may be wrapped over
/// several lines. A joint has up to three rotations, or three positions with three rotations or
/// none, in any order. Frames beyond the declared number are ignored, with a notice.
///
/// \throw osgSkin::Error "PATH: line N: what was found, what was expected".
BvhFile readBvh(const std::string& path, const ReadLimits& limits);

} // namespace osgSkin

#endif
