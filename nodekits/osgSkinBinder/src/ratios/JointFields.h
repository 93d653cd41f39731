// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBINDER_RATIOS_JOINTFIELDS_H
#define OSGSKINBINDER_RATIOS_JOINTFIELDS_H

#include "joints/JointRegions.h"
#include "ratios/PackInfluences.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace osgSkin {

/// For each joint a value at each welded vertex. Zeros, the great majority, take no memory.
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

    /// A joint's values other than 0, in the order of vertices.
    const std::vector<Entry>& entries(std::size_t joint) const { return _entries[joint]; }
    /// A joint's value at every vertex.
    std::vector<double> values(std::size_t joint) const;
    void set(std::size_t joint, const std::vector<double>& values);

private:
    std::vector<std::vector<Entry>> _entries; ///< of each joint
    std::size_t _vertices = 0;
};

/// Raises each joint's field to those of its children, so that no joint of a chain rotates skin
/// that its parent does not rotate. A joint without a region (of no length, or skipped) rotates
/// what its children rotate.
///
/// \param joints of planJoints(); joints below a rigid joint raise nothing
/// \param fields one for each joint
void raiseParents(const std::vector<PlannedJoint>& joints, JointFields& fields);

/// Raises values to at least those of a field.
void raise(std::vector<double>& values, const std::vector<JointFields::Entry>& field);

/// For each joint, its children that are not below a rigid joint.
std::vector<std::vector<std::uint32_t>> freeChildren(const std::vector<PlannedJoint>& joints);

/// The same values as joints' fields, vertex by vertex.
class VertexRatios {
public:
    /// \param bend of each joint
    /// \param twist of the same joints at the same vertices
    VertexRatios(const JointFields& bend, const JointFields& twist);

    /// The joints whose bend or twist is not 0 at the vertex, in their order.
    std::vector<JointRatio> of(std::uint32_t vertex) const;

private:
    std::vector<std::size_t> _first; ///< size: vertices + 1; offsets into `_ratios`
    std::vector<JointRatio> _ratios;
};

} // namespace osgSkin

#endif
