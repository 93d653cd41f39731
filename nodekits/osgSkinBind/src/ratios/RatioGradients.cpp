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

/// Ratios by welded vertex.
class WeldedRatios {
public:
    WeldedRatios(const WeldedMesh& mesh, const Binding& binding)
        : _binding(binding), _copyOf(mesh.vertexCount()) {
        for (std::uint32_t v = 0; v < mesh.weldedOf.size(); ++v) _copyOf[mesh.weldedOf[v]] = v;
    }
    std::uint32_t begin(std::uint32_t welded) const {
        return _binding.firstInfluence[_copyOf[welded]];
    }
    std::uint32_t end(std::uint32_t welded) const {
        return _binding.firstInfluence[_copyOf[welded] + 1];
    }
    Influence of(std::uint32_t welded, std::uint32_t joint) const {
        const auto first = _binding.influences.begin() + begin(welded);
        const auto last = _binding.influences.begin() + end(welded);
        const auto found = std::lower_bound(
            first, last, joint, [](const Influence& i, std::uint32_t j) { return i.joint < j; });
        return found != last && found->joint == joint ? *found : Influence{joint, 0.0f, 0.0f};
    }

private:
    const Binding& _binding;
    std::vector<std::uint32_t> _copyOf; ///< a vertex of the mesh as given
};

} // namespace

std::vector<RatioGradient> ratioGradients(const WeldedMesh& mesh, const Binding& binding) {
    const WeldedRatios ratios(mesh, binding);
    std::vector<Around> around(mesh.vertexCount());
    std::vector<Sum> sums(binding.influences.size()); // of each welded vertex's one copy
    for (const std::array<std::uint32_t, 3>& t : mesh.triangles) {
        const glm::dvec3& a = mesh.positions[t[0]];
        const glm::dvec3& b = mesh.positions[t[1]];
        const glm::dvec3& c = mesh.positions[t[2]];
        const glm::dvec3 area = glm::cross(b - a, c - a);
        const std::array<glm::dvec3, 3> opposite = {c - b, a - c, b - a};
        for (const std::uint32_t corner : t) {
            around[corner].areas += area;
            around[corner].area += glm::length(area);
            for (std::uint32_t i = ratios.begin(corner); i < ratios.end(corner); ++i) {
                if (!binding.influences[i].isPartial()) continue;
                // The normal times the gradient is minus this over twice the area.
                for (std::size_t k = 0; k < 3; ++k) {
                    const Influence at = ratios.of(t[k], binding.influences[i].joint);
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
        const std::uint32_t first = binding.firstInfluence[v], copy = ratios.begin(welded);
        for (std::uint32_t i = first; i < binding.firstInfluence[v + 1]; ++i) {
            const Sum& sum = sums[copy + (i - first)];
            result[i] = {glm::vec3(glm::cross(sum.bend, normal) / span),
                         glm::vec3(glm::cross(sum.twist, normal) / span)};
        }
    }
    return result;
}

} // namespace osgSkin
