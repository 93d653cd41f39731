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

/// A value that a BVH file has for a joint in each frame.
struct BvhChannel {
    bool isRotation = false; ///< degrees about the axis; otherwise the position along it
    int axis = 0;            ///< 0 to 2: x, y, z
};

/// A joint of the HIERARCHY.
struct BvhJoint {
    std::string name;
    int parent = -1;                   ///< -1 for the root
    glm::dvec3 offset{0.0};            ///< from the parent joint, in the zero pose
    std::optional<glm::dvec3> endSite; ///< the first End Site's offset from this joint
    std::vector<BvhChannel> channels;  ///< in file order, in which rotations multiply
    std::size_t firstChannel = 0;      ///< index of the joint's first value in a frame

    /// Whether the joint has position channels, which replace its offset.
    bool hasPosition() const;
};

/// The content of a BVH file, unconverted: in the file's own unit, and degrees.
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
/// Keywords may have any case, names may contain blanks, and a frame may be wrapped over several
/// lines. A joint has up to three rotations, or three positions with three rotations or none, in
/// any order. Frames beyond the declared number are ignored, with a notice.
///
/// \param path of the file
/// \param limits on its size
/// \throw osgSkin::Error "PATH: line N: what was found, what was expected".
BvhFile readBvh(const std::string& path, const ReadLimits& limits);

} // namespace osgSkin

#endif
