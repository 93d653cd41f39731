// SPDX-License-Identifier: MIT
#ifndef OSGSKINRIG_CUTPOLYGON_H
#define OSGSKINRIG_CUTPOLYGON_H 1

#include <osgSkin/GlmTypes>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace osgSkin {

/// Cuts polygons into triangles: into a fan around the first corner where none of its triangles
/// lies outside, and by clipping ears where the polygon is concave.
class PolygonCutter {
public:
    explicit PolygonCutter(const std::vector<glm::dvec3>& positions) : _positions(positions) {}

    /// Appends corners, counted from the polygon's first: three for each of `size` - 2 triangles.
    /// \param corners vertices of the polygon
    void cut(const std::uint32_t* corners, std::uint32_t size, std::vector<std::uint32_t>& out);

private:
    bool fanFits(const std::uint32_t* corners, std::uint32_t size);
    void project(const std::uint32_t* corners, std::uint32_t size);
    double turn(std::uint32_t a, std::uint32_t b, std::uint32_t c) const;
    bool isEar(std::uint32_t corner);
    void clipEars(std::uint32_t size, std::vector<std::uint32_t>& out);

    const std::vector<glm::dvec3>& _positions;
    glm::dvec3 _normal{0.0};          ///< of the polygon, not unit
    std::vector<glm::dvec2> _flat;    ///< its corners, seen along the normal, counter-clockwise
    std::vector<std::uint32_t> _next; ///< corners that are left, in a ring
    std::vector<std::uint32_t> _previous;
    /// Corners that may still be looked at for whether an ear holds them, of all polygons: files
    /// that take more than seconds are made for it, and get fans.
    std::size_t _looks = 50'000'000;
};

} // namespace osgSkin

#endif
