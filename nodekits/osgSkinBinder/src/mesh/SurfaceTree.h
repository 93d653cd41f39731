// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBINDER_MESH_SURFACETREE_H
#define OSGSKINBINDER_MESH_SURFACETREE_H

#include <glm/vec3.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

namespace osgSkin {

/// Sums angles. Arc tangents are slow, so small angles, given by their tangents, are multiplied as
/// complex numbers first.
class AngleSum {
public:
    /// Adds atan2(sine, cosine).
    void add(double sine, double cosine) {
        if (!(std::abs(sine) < kSmall * cosine)) {
            _sum += std::atan2(sine, cosine);
            return;
        }
        const double tangent = sine / cosine, imaginary = _imaginary + _real * tangent;
        _real -= _imaginary * tangent;
        _imaginary = imaginary;
        if (++_count == kMaxCount) flush();
    }

    /// A corner of a triangle relative to the point that sees it, and its distance.
    struct Corner {
        glm::dvec3 from;
        double distance;
    };
    /// Adds half of a triangle's signed solid angle (van Oosterom & Strackee 1983).
    void addHalfSolidAngle(const Corner& a, const Corner& b, const Corner& c);

    double value() {
        flush();
        return _sum;
    }

private:
    static constexpr double kSmall = 0.3;
    static constexpr int kMaxCount = 10; ///< less than half a turn together

    void flush() {
        _sum += std::atan2(_imaginary, _real);
        _real = 1.0;
        _imaginary = 0.0;
        _count = 0;
    }

    double _sum = 0.0, _real = 1.0, _imaginary = 0.0;
    int _count = 0;
};

/// Generalised winding numbers (Jacobson, Kavan & Sorkine-Hornung 2013) of many points: groups of
/// far triangles count as one dipole (Barill et al. 2018). Surfaces may be open or have several
/// shells. Thread-safe: const after construction.
class WindingTree {
public:
    WindingTree(const std::vector<glm::dvec3>& positions,
                const std::vector<std::array<std::uint32_t, 3>>& triangles);

    /// How often the surface winds around the point: 1 or -1 within a closed one.
    double at(const glm::dvec3& point) const;

    /// True if |winding| is above one half.
    bool inside(const glm::dvec3& point) const;

private:
    struct Node {
        glm::dvec3 centre{0.0};           ///< area-weighted
        glm::dvec3 dipole{0.0};           ///< sum of the triangles' area vectors
        double reach = 0.0;               ///< largest distance of a corner from the centre
        std::uint32_t begin = 0, end = 0; ///< range in _corners
        std::uint32_t child = 0;          ///< first of two neighbours; 0 for a leaf
    };
    using Corners = std::array<glm::dvec3, 3>;

    void split(std::uint32_t node);
    void measure(Node& node) const;
    /// Adds half the solid angle of near triangles to `halves` and returns that of far ones.
    double sum(std::uint32_t node, const glm::dvec3& point, AngleSum& halves) const;

    std::vector<Corners> _corners;
    std::vector<Node> _nodes;
};

/// Closest points of triangles. Thread-safe: const after construction.
class SurfaceTree {
public:
    struct Nearest {
        std::uint32_t triangle = 0;
        glm::dvec3 position{0.0};
        glm::dvec3 shares{0.0}; ///< barycentric: at least 0, sum 1
    };

    /// Leaves out triangles without area.
    SurfaceTree(const std::vector<glm::dvec3>& positions,
                const std::vector<std::array<std::uint32_t, 3>>& triangles);
    ~SurfaceTree();

    bool empty() const;

    /// \pre not empty()
    Nearest nearest(const glm::dvec3& point) const;
    double distance(const glm::dvec3& point) const;

    /// Distance to the box around the triangles: at most that to the surface.
    /// \pre not empty()
    double distanceToBox(const glm::dvec3& point) const;

private:
    struct Tree;
    std::unique_ptr<const Tree> _tree;
};

} // namespace osgSkin

#endif
