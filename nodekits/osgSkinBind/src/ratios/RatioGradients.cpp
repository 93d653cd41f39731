// SPDX-License-Identifier: GPL-3.0-or-later
#include "ratios/RatioGradients.h"

#include <glm/geometric.hpp>

#include <algorithm>

namespace osgSkin {
namespace {

/// Where a vertex's triangles almost cancel out they make no surface: gradients are kept as short
/// as if they did not by more than this.
constexpr double kLeastSpan = 0.25;

/// What the triangles around a vertex add up to.
struct Around {
    glm::dvec3 areas{0.0}; ///< twice their area, along their normals
    double area = 0.0;     ///< the same without direction
};

/// Sums over the triangles around a vertex, of an influence: area times normal x gradient.
struct Sum {
    glm::dvec3 bend{0.0}, twist{0.0};
};

/// Ratios by welded vertex. Where they are partial they have a number each.
class WeldedRatios {
public:
    WeldedRatios(const WeldedMesh& mesh, const Binding& binding)
        : _binding(binding), _copyOf(mesh.vertexCount()) {
        for (std::uint32_t v = 0; v < mesh.weldedOf.size(); ++v) _copyOf[mesh.weldedOf[v]] = v;
        for (const std::uint32_t copy : _copyOf) {
            _firstPartial.push_back(_partials.size());
            for (std::uint32_t i = binding.firstInfluence[copy];
                 i < binding.firstInfluence[copy + 1]; ++i)
                if (binding.influences[i].isPartial()) _partials.push_back(i);
        }
        _firstPartial.push_back(_partials.size());
    }
    std::size_t partialCount() const { return _partials.size(); }
    std::size_t firstPartial(std::uint32_t welded) const { return _firstPartial[welded]; }
    const Influence& partial(std::size_t number) const {
        return _binding.influences[_partials[number]];
    }
    Influence of(std::uint32_t welded, std::uint32_t joint) const {
        const std::uint32_t copy = _copyOf[welded];
        const auto first = _binding.influences.begin() + _binding.firstInfluence[copy];
        const auto last = _binding.influences.begin() + _binding.firstInfluence[copy + 1];
        const auto found = std::lower_bound(
            first, last, joint, [](const Influence& i, std::uint32_t j) { return i.joint < j; });
        return found != last && found->joint == joint ? *found : Influence{joint, 0.0f, 0.0f};
    }

private:
    const Binding& _binding;
    std::vector<std::uint32_t> _copyOf;     ///< a vertex of the mesh as given
    std::vector<std::size_t> _firstPartial; ///< size: welded vertices + 1; into `_partials`
    std::vector<std::uint32_t> _partials;   ///< in Binding::influences, of `_copyOf`
};

} // namespace

std::vector<RatioGradient> ratioGradients(const WeldedMesh& mesh, const Binding& binding) {
    const WeldedRatios ratios(mesh, binding);
    std::vector<Around> around(mesh.vertexCount());
    std::vector<Sum> sums(ratios.partialCount());
    for (const std::array<std::uint32_t, 3>& t : mesh.triangles) {
        const glm::dvec3& a = mesh.positions[t[0]];
        const glm::dvec3& b = mesh.positions[t[1]];
        const glm::dvec3& c = mesh.positions[t[2]];
        const glm::dvec3 area = glm::cross(b - a, c - a);
        const std::array<glm::dvec3, 3> opposite = {c - b, a - c, b - a};
        for (const std::uint32_t corner : t) {
            around[corner].areas += area;
            around[corner].area += glm::length(area);
            for (std::size_t i = ratios.firstPartial(corner); i < ratios.firstPartial(corner + 1);
                 ++i) {
                // The normal times the gradient is minus this over twice the area.
                for (std::size_t k = 0; k < 3; ++k) {
                    const Influence at = ratios.of(t[k], ratios.partial(i).joint);
                    sums[i].bend -= double(at.bend) * opposite[k];
                    sums[i].twist -= double(at.twist) * opposite[k];
                }
            }
        }
    }
    std::vector<RatioGradient> result(binding.influences.size());
    for (std::uint32_t v = 0; v < mesh.weldedOf.size(); ++v) {
        const std::uint32_t welded = mesh.weldedOf[v];
        const Around& skin = around[welded];
        const double length = glm::length(skin.areas);
        if (!(length > 0.0)) continue;
        const glm::dvec3 normal = skin.areas / length;
        const double span = std::max(length, kLeastSpan * skin.area);
        std::size_t next = ratios.firstPartial(welded);
        for (std::uint32_t i = binding.firstInfluence[v]; i < binding.firstInfluence[v + 1]; ++i) {
            if (!binding.influences[i].isPartial()) continue;
            const Sum& sum = sums[next++];
            result[i] = {glm::vec3(glm::cross(sum.bend, normal) / span),
                         glm::vec3(glm::cross(sum.twist, normal) / span)};
        }
    }
    return result;
}

} // namespace osgSkin
