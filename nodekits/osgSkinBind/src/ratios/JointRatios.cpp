// SPDX-License-Identifier: MIT
#include "ratios/JointRatios.h"

#include <glm/geometric.hpp>

#include <algorithm>

namespace osgSkin {
namespace {

/// If the area vectors of a vertex's triangles almost cancel out, gradients would become very long.
/// The length of the sum is taken as at least this share of the total area.
constexpr double kMinSpan = 0.25;

/// Sums over the triangles around a vertex.
struct Around {
    glm::dvec3 areas{0.0}; ///< twice the area, along the normal
    double area = 0.0;     ///< twice the area
};

/// For an influence, the sum over the triangles around a vertex of area times normal x gradient.
struct Sum {
    glm::dvec3 bend{0.0}, twist{0.0};
};

/// The partial influences of welded vertices, numbered.
class PartialInfluences {
public:
    PartialInfluences(const WeldedMesh& mesh, const Binding& binding, const JointRatios& ratios) {
        for (std::uint32_t welded = 0; welded < mesh.vertexCount(); ++welded) {
            const std::uint32_t copy = ratios.copyOf(welded);
            _first.push_back(_joints.size());
            for (std::uint32_t i = binding.firstInfluence[copy];
                 i < binding.firstInfluence[copy + 1]; ++i)
                if (binding.influences[i].isPartial())
                    _joints.push_back(binding.influences[i].joint);
        }
        _first.push_back(_joints.size());
    }
    std::size_t count() const { return _joints.size(); }
    std::size_t first(std::uint32_t welded) const { return _first[welded]; }
    std::uint32_t joint(std::size_t number) const { return _joints[number]; }

private:
    std::vector<std::size_t> _first;    ///< size: welded vertices + 1; into `_joints`
    std::vector<std::uint32_t> _joints; ///< of each partial influence
};

} // namespace

std::vector<RatioGradient> ratioGradients(const WeldedMesh& mesh, const Binding& binding) {
    const JointRatios ratios(mesh, binding);
    const PartialInfluences partials(mesh, binding, ratios);
    std::vector<Around> around(mesh.vertexCount());
    std::vector<Sum> sums(partials.count());
    for (const std::array<std::uint32_t, 3>& t : mesh.triangles) {
        const glm::dvec3& a = mesh.positions[t[0]];
        const glm::dvec3& b = mesh.positions[t[1]];
        const glm::dvec3& c = mesh.positions[t[2]];
        const glm::dvec3 area = glm::cross(b - a, c - a);
        const std::array<glm::dvec3, 3> opposite = {c - b, a - c, b - a};
        for (const std::uint32_t corner : t) {
            around[corner].areas += area;
            around[corner].area += glm::length(area);
            for (std::size_t i = partials.first(corner); i < partials.first(corner + 1); ++i) {
                // The normal x gradient is minus this over twice the area.
                for (std::size_t k = 0; k < 3; ++k) {
                    const Influence at = ratios.of(t[k], partials.joint(i));
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
        const double span = std::max(length, kMinSpan * skin.area);
        std::size_t next = partials.first(welded);
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
