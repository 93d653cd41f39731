// SPDX-License-Identifier: MIT
#include <osgSkinRig/SkinMesh>

#include <osgSkin/Error>
#include <osgSkin/GlmTypes>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace osgSkin {
namespace {

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
    /// How many more corners may be tested for lying in an ear, over all polygons. Only files made
    /// for the purpose take more, which would be minutes; the rest of their polygons become fans.
    std::size_t _looks = 50'000'000;
};

/// Share of a polygon that a fan's triangle may fold back over it, for nearly flat polygons.
constexpr double kFold = 1e-6;

/// How far corners of a flat polygon may lie off its plane, relative to its extent.
constexpr double kBent = 1e-4;

bool PolygonCutter::fanFits(const std::uint32_t* corners, std::uint32_t size) {
    // Scaled to size 1, so that products of lengths neither overflow nor vanish.
    const glm::dvec3& origin = _positions[corners[0]];
    double extent = 0.0;
    for (std::uint32_t k = 1; k < size; ++k) {
        const glm::dvec3 distance = glm::abs(_positions[corners[k]] - origin);
        extent = std::max({extent, distance.x, distance.y, distance.z});
    }
    const double scale = extent > 0.0 ? 1.0 / extent : 1.0;
    const auto area = [&](std::uint32_t k) {
        return glm::cross((_positions[corners[k - 1]] - origin) * scale,
                          (_positions[corners[k]] - origin) * scale);
    };
    _normal = glm::dvec3(0.0);
    for (std::uint32_t k = 2; k < size; ++k) _normal += area(k);
    const double least = -kFold * glm::dot(_normal, _normal);
    for (std::uint32_t k = 2; k < size; ++k)
        if (glm::dot(area(k), _normal) < least) return false;
    return true;
}

void PolygonCutter::project(const std::uint32_t* corners, std::uint32_t size) {
    const glm::dvec3& origin = _positions[corners[0]];
    const auto offset = [&](std::uint32_t k) { return _positions[corners[k]] - origin; };
    _flat.clear();
    // A bent polygon is projected along its normal, so that its orientation does not matter.
    const double length = glm::length(_normal);
    const glm::dvec3 normal = length > 0.0 ? _normal / length : glm::dvec3(0.0);
    glm::dvec3 across(0.0);
    double off = 0.0, extent = 0.0;
    for (std::uint32_t k = 1; k < size; ++k) {
        const double height = glm::dot(offset(k), normal);
        const glm::dvec3 level = offset(k) - normal * height;
        off = std::max(off, std::abs(height));
        extent = std::max(extent, glm::length(offset(k)));
        if (glm::length(level) > glm::length(across)) across = level;
    }
    if (off > kBent * extent && across != glm::dvec3(0.0)) {
        across = glm::normalize(across);
        const glm::dvec3 up = glm::cross(normal, across);
        for (std::uint32_t k = 0; k < size; ++k)
            _flat.emplace_back(glm::dot(offset(k), across), glm::dot(offset(k), up));
        return;
    }
    // A flat polygon is projected along the axis nearest to the normal, which rounds nothing, and
    // so that it runs counter-clockwise.
    int axis = 0;
    for (int k = 1; k < 3; ++k)
        if (std::abs(_normal[k]) > std::abs(_normal[axis])) axis = k;
    const int right = (axis + 1) % 3, up = (axis + 2) % 3;
    const double side = _normal[axis] < 0.0 ? -1.0 : 1.0;
    for (std::uint32_t k = 0; k < size; ++k)
        _flat.emplace_back(side * offset(k)[right], offset(k)[up]);
}

/// Positive where three corners turn left.
double PolygonCutter::turn(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
    const glm::dvec2 first = _flat[b] - _flat[a], second = _flat[c] - _flat[a];
    return first.x * second.y - first.y * second.x;
}

bool PolygonCutter::isEar(std::uint32_t corner) {
    const std::uint32_t before = _previous[corner], after = _next[corner];
    if (_looks == 0) return true;
    --_looks;
    if (!(turn(before, corner, after) > 0.0)) return false;
    for (std::uint32_t k = _next[after]; k != before; k = _next[k]) {
        if (_looks == 0) return true;
        --_looks;
        // Holes are connected to the outline by a pair of edges, whose corners occur twice.
        if (_flat[k] == _flat[before] || _flat[k] == _flat[corner] || _flat[k] == _flat[after])
            continue;
        if (turn(before, corner, k) >= 0.0 && turn(corner, after, k) >= 0.0 &&
            turn(after, before, k) >= 0.0)
            return false;
    }
    return true;
}

void PolygonCutter::clipEars(std::uint32_t size, std::vector<std::uint32_t>& out) {
    _next.resize(size);
    _previous.resize(size);
    for (std::uint32_t k = 0; k < size; ++k) {
        _next[k] = (k + 1) % size;
        _previous[k] = (k + size - 1) % size;
    }
    std::uint32_t corner = 1, passed = 0;
    for (std::uint32_t left = size; left >= 3;) {
        // A polygon without an ear intersects itself: any corner will do.
        if (passed < left && !isEar(corner)) {
            corner = _next[corner];
            ++passed;
            continue;
        }
        const std::uint32_t before = _previous[corner], after = _next[corner];
        out.insert(out.end(), {before, corner, after});
        _next[before] = after;
        _previous[after] = before;
        corner = _next[after];
        passed = 0;
        --left;
    }
}

void PolygonCutter::cut(const std::uint32_t* corners, std::uint32_t size,
                        std::vector<std::uint32_t>& out) {
    if (size > 3 && _looks > 0 && !fanFits(corners, size)) {
        project(corners, size);
        clipEars(size, out);
        return;
    }
    for (std::uint32_t k = 2; k < size; ++k) out.insert(out.end(), {0, k - 1, k});
}

} // namespace

void SkinMesh::validate() const {
    if (positions.empty()) throw Error("mesh: no vertex, expected at least 3");
    if (faceSizes.empty()) throw Error("mesh: no face, expected at least one");
    for (std::size_t v = 0; v < positions.size(); ++v) {
        if (isInRange(positions[v])) continue;
        throw Error("mesh: vertex " + std::to_string(v) + " has a coordinate " +
                    (isFinite(positions[v]) ? "beyond -1e18 to 1e18" : "that is not finite"));
    }
    std::size_t corner = 0;
    for (std::size_t f = 0; f < faceSizes.size(); ++f) {
        const std::string place = "mesh: face " + std::to_string(f);
        if (faceSizes[f] < 3)
            throw Error(place + " has " + std::to_string(faceSizes[f]) +
                        " corners, expected 3 or more");
        if (faceSizes[f] > faceVertices.size() - corner)
            throw Error(place + " has more corners than the mesh lists");
        for (std::uint32_t k = 0; k < faceSizes[f]; ++k, ++corner)
            if (faceVertices[corner] >= positions.size())
                throw Error(place + " names vertex " + std::to_string(faceVertices[corner]) +
                            ", expected less than " + std::to_string(positions.size()));
    }
    if (corner != faceVertices.size()) throw Error("mesh: corners beyond the last face");
}

std::vector<std::uint32_t> SkinMesh::triangleCorners() const {
    std::vector<std::uint32_t> result;
    result.reserve(3 * faceVertices.size());
    PolygonCutter cutter(positions);
    std::size_t corner = 0;
    for (const std::uint32_t size : faceSizes) {
        const std::size_t begin = result.size();
        cutter.cut(&faceVertices[corner], size, result);
        for (std::size_t k = begin; k < result.size(); ++k)
            result[k] += static_cast<std::uint32_t>(corner);
        corner += size;
    }
    return result;
}

std::vector<std::uint32_t> SkinMesh::triangles() const {
    std::vector<std::uint32_t> result = triangleCorners();
    for (std::uint32_t& corner : result) corner = faceVertices[corner];
    return result;
}

double SkinMesh::size() const {
    if (positions.empty()) return 0.0;
    glm::dvec3 low = positions.front();
    glm::dvec3 high = low;
    for (const glm::dvec3& p : positions) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    const glm::dvec3 extent = high - low;
    return std::max({extent.x, extent.y, extent.z});
}

} // namespace osgSkin
