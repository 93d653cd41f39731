// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_VERTEXRATIOS_H
#define OSGSKINBIND_VERTEXRATIOS_H

#include "fields/JointFields.h"
#include "fields/JointRatio.h"

#include <cstdint>
#include <vector>

namespace osgSkin {

/// Joints' fields, vertex by vertex.
class VertexRatios {
public:
    /// \param bend of each joint
    /// \param twist of the same joints at the same vertices
    VertexRatios(const JointFields& bend, const JointFields& twist);

    /// The joints of which one of both is not 0 at the vertex, in their order.
    std::vector<JointRatio> of(std::uint32_t vertex) const;

private:
    std::vector<std::size_t> _first; ///< size: vertices + 1; offsets into `_ratios`
    std::vector<JointRatio> _ratios;
};

} // namespace osgSkin

#endif
