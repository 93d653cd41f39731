// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBINDER_FIT_PLACEDJOINTS_H
#define OSGSKINBINDER_FIT_PLACEDJOINTS_H

#include "bind/FittedTree.h"

#include <glm/vec3.hpp>

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace osgSkin {

/// The beginning of joint names: "Left" for side 0 (x > 0), "Right" for side 1.
const std::string& sidePrefix(std::size_t side);

/// The name of the other side's joint; for joints of the trunk the name itself.
std::string mirroredName(const std::string& name);

/// The joints placed so far, in the body's frame. Landmarks are never overwritten.
class PlacedJoints {
public:
    struct Entry {
        glm::dvec3 centre{0.0};
        std::string how;               ///< as in FitReport::Joint
        std::optional<glm::dvec3> tip; ///< end of the bone; for the last joints only
        bool isLandmark = false;
        bool pushed = false; ///< moved inside the skin
    };

    void addLandmark(const std::string& name, const glm::dvec3& centre,
                     const std::string& how = "landmark");

    /// Places a joint unless it has a landmark.
    /// \return its centre
    glm::dvec3 place(const std::string& name, const glm::dvec3& centre, const std::string& how);

    /// \pre the joint has been placed
    void setTip(const std::string& name, const glm::dvec3& tip) { _entries.at(name).tip = tip; }

    bool has(const std::string& name) const { return _entries.count(name) > 0; }
    const glm::dvec3& at(const std::string& name) const { return _entries.at(name).centre; }
    std::map<std::string, Entry>& entries() { return _entries; }

private:
    std::map<std::string, Entry> _entries;
};

/// Mirrors landmarks of joints whose other side has none.
void mirrorLandmarks(PlacedJoints& placed);

/// Makes left and right joints mirror images, except landmarks.
void symmetrise(PlacedJoints& placed);

} // namespace osgSkin

#endif
