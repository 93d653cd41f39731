// SPDX-License-Identifier: MIT
#ifndef OSGSKINBIND_RATIOS_JOINTRATIOS_H
#define OSGSKINBIND_RATIOS_JOINTRATIOS_H

#include "joints/JointPlan.h"
#include "mesh/WeldedMesh.h"

#include <osgSkin/Binding>
#include <osgSkinBind/Export>

#include <algorithm>
#include <vector>

namespace osgSkin {

/// A binding's ratios by welded vertex; copies of a vertex have the same ratios.
class JointRatios {
public:
    JointRatios(const WeldedMesh& mesh, const Binding& binding)
        : _binding(binding), _copyOf(mesh.vertexCount(), 0) {
        for (std::uint32_t v = 0; v < mesh.weldedOf.size(); ++v) _copyOf[mesh.weldedOf[v]] = v;
    }

    /// The last of the copies of a welded vertex.
    std::uint32_t copyOf(std::uint32_t welded) const { return _copyOf[welded]; }

    /// Zeros if the vertex does not follow the joint.
    Influence of(std::uint32_t welded, std::uint32_t joint) const {
        const std::uint32_t v = _copyOf[welded];
        const auto begin = _binding.influences.begin() + _binding.firstInfluence[v];
        const auto end = _binding.influences.begin() + _binding.firstInfluence[v + 1];
        const auto found = std::lower_bound(
            begin, end, joint, [](const Influence& i, std::uint32_t j) { return i.joint < j; });
        return found != end && found->joint == joint ? *found : Influence{joint, 0.0f, 0.0f};
    }

    /// The largest bend ratio at the vertex of joints that move a rigid part.
    double rigid(std::uint32_t welded, const std::vector<PlannedJoint>& joints) const {
        const std::uint32_t v = _copyOf[welded];
        double most = 0.0;
        for (std::uint32_t i = _binding.firstInfluence[v]; i < _binding.firstInfluence[v + 1]; ++i)
            if (joints[_binding.influences[i].joint].rigid >= 0)
                most = std::max(most, static_cast<double>(_binding.influences[i].bend));
        return most;
    }

    double bend(std::uint32_t welded, std::uint32_t joint) const {
        return static_cast<double>(of(welded, joint).bend);
    }

private:
    const Binding& _binding;
    std::vector<std::uint32_t> _copyOf; ///< for each welded vertex, one of the mesh as given
};

/// The gradients along the skin of partial influences' ratios: the area-weighted mean of the
/// gradients in the triangles around a vertex, where ratios are linear. 0 for influences that are
/// not partial, and at vertices without triangles.
/// \param binding of the mesh that `mesh` was welded from
/// \return one for each of the binding's influences
OSGSKINBIND_EXPORT std::vector<RatioGradient> ratioGradients(const WeldedMesh& mesh,
                                                             const Binding& binding);

} // namespace osgSkin

#endif
