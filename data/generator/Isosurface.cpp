// SPDX-License-Identifier: GPL-3.0-or-later
#include "Isosurface.h"

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

namespace mannequin {
namespace {

constexpr int kBlock = 8; // cells per block edge; blocks far from the skin are skipped

constexpr std::size_t kValues = (kBlock + 1UL) * (kBlock + 1UL) * (kBlock + 1UL);

/// Marching tetrahedra. A cube's corner is a bit mask with one bit per axis. Each order a, b, c of
/// the axes gives a tetrahedron 0, a, ab, abc: six per cube, which match those of its neighbours.
class Marcher {
public:
    Marcher(const ImplicitBody& body, double spacing) : _body(body), _spacing(spacing) {
        const glm::dvec3 extent = (body.upperCorner() - body.lowerCorner()) / spacing;
        _blocks = glm::ivec3(glm::ceil(extent / double(kBlock)));
    }

    SkinMesh run() {
        for (int z = 0; z < _blocks.z; ++z)
            for (int y = 0; y < _blocks.y; ++y)
                for (int x = 0; x < _blocks.x; ++x) marchBlock(glm::ivec3(x, y, z) * kBlock);
        return std::move(_mesh);
    }

private:
    struct Corner {
        glm::ivec3 cell;
        double value;
    };

    glm::dvec3 position(const glm::ivec3& cell) const {
        return _body.lowerCorner() + glm::dvec3(cell) * _spacing;
    }

    double& value(const glm::ivec3& offset) {
        const glm::uvec3 at(offset);
        constexpr std::size_t n = kBlock + 1;
        return _values[(at.z * n + at.y) * n + at.x];
    }

    void marchBlock(const glm::ivec3& first) {
        const double reach = std::sqrt(3.0) * kBlock * _spacing / 2;
        const glm::dvec3 middle = position(first) + glm::dvec3(kBlock * _spacing / 2);
        if (std::abs(_body.distance(middle)) > 2 * reach) return;
        for (int z = 0; z <= kBlock; ++z)
            for (int y = 0; y <= kBlock; ++y)
                for (int x = 0; x <= kBlock; ++x)
                    value({x, y, z}) = _body.distance(position(first + glm::ivec3(x, y, z)));
        for (int z = 0; z < kBlock; ++z)
            for (int y = 0; y < kBlock; ++y)
                for (int x = 0; x < kBlock; ++x) marchCube(first, {x, y, z});
    }

    void marchCube(const glm::ivec3& first, const glm::ivec3& offset) {
        static constexpr int kOrders[6][2] = {{1, 3}, {1, 5}, {2, 3}, {2, 6}, {4, 5}, {4, 6}};
        std::array<Corner, 8> corners;
        int inside = 0;
        for (int mask = 0; mask < 8; ++mask) {
            const glm::ivec3 at = offset + glm::ivec3(mask & 1, mask >> 1 & 1, mask >> 2 & 1);
            corners[static_cast<std::size_t>(mask)] = {first + at, value(at)};
            inside += value(at) < 0;
        }
        if (inside == 0 || inside == 8) return;
        for (const auto& order : kOrders)
            marchTetrahedron({corners[0], corners[static_cast<std::size_t>(order[0])],
                              corners[static_cast<std::size_t>(order[1])], corners[7]});
    }

    void marchTetrahedron(const std::array<Corner, 4>& corners) {
        std::vector<Corner> in, out;
        for (const Corner& corner : corners) (corner.value < 0 ? in : out).push_back(corner);
        if (in.empty() || out.empty()) return;
        const glm::dvec3 outward = position(out[0].cell) - position(in[0].cell);
        if (in.size() == 2) {
            const auto a = crossing(in[0], out[0]), b = crossing(in[0], out[1]),
                       c = crossing(in[1], out[1]), d = crossing(in[1], out[0]);
            addFace(a, b, c, outward);
            addFace(a, c, d, outward);
        } else if (in.size() == 1) {
            addFace(crossing(in[0], out[0]), crossing(in[0], out[1]), crossing(in[0], out[2]),
                    outward);
        } else {
            addFace(crossing(in[0], out[0]), crossing(in[1], out[0]), crossing(in[2], out[0]),
                    outward);
        }
    }

    SkinMesh::Vertex_index crossing(const Corner& a, const Corner& b) {
        const auto key = [this](const Corner& corner) {
            const glm::ivec3 size = _blocks * kBlock + 1;
            return static_cast<std::uint64_t>(corner.cell.z) *
                       static_cast<std::uint64_t>(size.x * size.y) +
                   static_cast<std::uint64_t>(corner.cell.y * size.x + corner.cell.x);
        };
        const auto [entry, isNew] = _vertices.try_emplace(key(a) << 32 | key(b));
        if (isNew) {
            // Stay away from the corners, where triangles would degenerate.
            const double part = std::clamp(a.value / (a.value - b.value), 0.02, 0.98);
            entry->second =
                _mesh.add_vertex(toCgal(glm::mix(position(a.cell), position(b.cell), part)));
        }
        return entry->second;
    }

    void addFace(SkinMesh::Vertex_index a, SkinMesh::Vertex_index b, SkinMesh::Vertex_index c,
                 const glm::dvec3& outward) {
        const glm::dvec3 pa = toGlm(_mesh.point(a)), pb = toGlm(_mesh.point(b)),
                         pc = toGlm(_mesh.point(c));
        if (glm::dot(glm::cross(pb - pa, pc - pa), outward) < 0) std::swap(b, c);
        _mesh.add_face(a, b, c);
    }

    const ImplicitBody& _body;
    double _spacing;
    glm::ivec3 _blocks{0};
    std::array<double, kValues> _values{};
    std::unordered_map<std::uint64_t, SkinMesh::Vertex_index> _vertices; // by grid edge
    SkinMesh _mesh;
};

} // namespace

SkinMesh isosurface(const ImplicitBody& body, double spacing) {
    return Marcher(body, spacing).run();
}

} // namespace mannequin
