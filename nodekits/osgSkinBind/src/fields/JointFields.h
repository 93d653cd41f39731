// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_JOINTFIELDS_H
#define OSGSKINBIND_JOINTFIELDS_H

#include "joints/JointPlan.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace osgSkin {

/// For each joint a value at each welded vertex. Those that are 0, most joints' at most vertices,
/// take no memory.
class JointFields {
public:
    struct Entry {
        std::uint32_t vertex;
        double value; ///< not 0
    };

    JointFields() = default;
    JointFields(std::size_t joints, std::size_t vertices) : _entries(joints), _vertices(vertices) {}

    std::size_t jointCount() const { return _entries.size(); }
    std::size_t vertexCount() const { return _vertices; }

    /// A joint's values that are not 0, in the order of vertices.
    const std::vector<Entry>& entries(std::size_t joint) const { return _entries[joint]; }
    /// A joint's value at every vertex.
    std::vector<double> values(std::size_t joint) const;
    void set(std::size_t joint, const std::vector<double>& values);

private:
    std::vector<std::vector<Entry>> _entries; ///< of each joint
    std::size_t _vertices = 0;
};

/// Raises each joint's field to that of its children, so that along a chain no joint rotates skin
/// that its parent leaves behind. A joint without a region (of no length, or skipped) rotates what
/// its children rotate.
///
/// \param joints of planJoints(); what is below a rigid joint raises nothing
/// \param fields one for each joint
void raiseParents(const std::vector<PlannedJoint>& joints, JointFields& fields);

/// Raises values to a field's where they are below it.
void raise(std::vector<double>& values, const std::vector<JointFields::Entry>& field);

/// For each joint those of its children that are not below a rigid joint.
std::vector<std::vector<std::uint32_t>> freeChildren(const std::vector<PlannedJoint>& joints);

} // namespace osgSkin

#endif
