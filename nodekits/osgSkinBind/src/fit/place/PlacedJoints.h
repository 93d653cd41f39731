// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_FIT_JOINTSHEET_H
#define OSGSKINBIND_FIT_JOINTSHEET_H

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
        std::string how;
        std::optional<glm::dvec3> tip; ///< end of the bone; for the last joints only
        bool isLandmark = false;
        bool pushed = false;
    };

    void addLandmark(const std::string& name, const glm::dvec3& centre,
                     const std::string& how = "landmark");

    /// Places a joint unless a landmark did. Returns where it is.
    glm::dvec3 place(const std::string& name, const glm::dvec3& centre, const std::string& how);

    /// \pre the joint has been placed.
    void setTip(const std::string& name, const glm::dvec3& tip) { _entries.at(name).tip = tip; }

    bool has(const std::string& name) const { return _entries.count(name) > 0; }
    const glm::dvec3& at(const std::string& name) const { return _entries.at(name).centre; }
    std::map<std::string, Entry>& entries() { return _entries; }

private:
    std::map<std::string, Entry> _entries;
};

/// "Left" and "Right", as joint names begin; index 0 is the left side, x > 0.
inline const std::string& sidePrefix(std::size_t side) {
    static const std::string prefixes[] = {"Left", "Right"};
    return prefixes[side];
}

/// The other side's joint; the name itself for a joint of the trunk.
std::string mirroredName(const std::string& name);

/// Joint names with their parents' indices, in the order of a fitted skeleton.
struct FittedJoint {
    const char* name;
    int parent;
};
const std::vector<FittedJoint>& fittedTree();

} // namespace osgSkin

#endif
