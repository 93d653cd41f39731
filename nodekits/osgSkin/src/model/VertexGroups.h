// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkin/Binding>

#include <cstdint>
#include <vector>

namespace osgSkin {

/// A skin's vertices, checked against their binding and grouped for the deformation: what
/// SkinModel::create() makes a model of.
///
/// The vertices of a group follow the same joints wholly and the same in part: they have one
/// signature. Small groups join others, whose further joints their vertices follow by ratios of 0
/// or 1, where that costs less than vectors with empty lanes. A group is deformed as a whole, so
/// its vertices are written side by side best.
class VertexGroups {
public:
    struct Joint {
        std::uint32_t index; ///< in Binding::joints
        bool partial;        ///< Influence::isPartial() of some; else followed wholly by all
    };
    struct Group {
        std::vector<Joint> joints;     ///< that its vertices follow, in productOrder()
        std::uint32_t firstVertex = 0; ///< in order()
        std::uint32_t vertexCount = 0;
    };

    /// Checks and groups the vertices.
    ///
    /// \param binding must outlive this
    /// \param source for each vertex, the vertex of `binding` whose ratios it takes
    /// \throw osgSkin::Error where the binding is not valid, a source is not one of its vertices,
    ///        or a vertex follows more than SkinModel::kMaxPartialInfluences joints in part
    VertexGroups(const Binding& binding, std::vector<std::uint32_t> source);

    const Binding& binding() const { return *_binding; }
    /// For each vertex, the vertex of the binding.
    const std::vector<std::uint32_t>& source() const { return _source; }

    /// Sorted by signature, so that groups side by side begin with the same joints.
    const std::vector<Group>& groups() const { return _groups; }

    /// The vertices, group by group, within a group those of the same joints' correctives together,
    /// and otherwise as they came: the order in which the
    /// deformation writes them. Geometry in any other order costs a scatter a frame.
    const std::vector<std::uint32_t>& order() const { return _order; }

    /// Numbers the vertices as order() has them: what was vertex order()[i] is vertex i then, and
    /// order() the identity.
    void reorder();

private:
    const Binding* _binding;
    std::vector<std::uint32_t> _source;
    std::vector<Group> _groups;
    std::vector<std::uint32_t> _order;
};

/// What a bound vertex has of a joint; null where that is nothing.
///
/// \param binding valid
/// \param vertex of the binding
/// \param joint of the binding
const Influence* influenceOf(const Binding& binding, std::uint32_t vertex, std::uint32_t joint);

} // namespace osgSkin
