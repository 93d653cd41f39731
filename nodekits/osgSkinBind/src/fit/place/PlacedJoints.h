// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_FIT_PLACEDJOINTS_H
#define OSGSKINBIND_FIT_PLACEDJOINTS_H

#include "fit/place/FittedTree.h"

#include <glm/vec3.hpp>

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace osgSkin {

/// The joints placed so far, in the body's frame. What a landmark said is never overwritten.
class PlacedJoints {
public:
    struct Entry {
        glm::dvec3 centre{0.0};
        std::string how;               ///< as in FitReport::Joint
        std::optional<glm::dvec3> tip; ///< end of the bone; for the last joints only
        bool isLandmark = false;
        bool pushed = false; ///< moved inside the skin
    };

    /// Places a joint for good.
    void addLandmark(const std::string& name, const glm::dvec3& centre,
                     const std::string& how = "landmark");

    /// Places a joint unless a landmark did.
    ///
    /// \return where it is
    glm::dvec3 place(const std::string& name, const glm::dvec3& centre, const std::string& how);

    /// \pre the joint has been placed.
    void setTip(const std::string& name, const glm::dvec3& tip) { _entries.at(name).tip = tip; }

    bool has(const std::string& name) const { return _entries.count(name) > 0; }
    const glm::dvec3& at(const std::string& name) const { return _entries.at(name).centre; }
    std::map<std::string, Entry>& entries() { return _entries; }

private:
    std::map<std::string, Entry> _entries;
};

} // namespace osgSkin

#endif
