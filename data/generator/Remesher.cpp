// SPDX-License-Identifier: GPL-3.0-or-later
#include "Remesher.h"

#include <CGAL/boost/graph/Euler_operations.h>

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <type_traits>
#include <utility>
#include <vector>

namespace mannequin {
namespace {

double angleAt(const glm::dvec3& apex, const glm::dvec3& a, const glm::dvec3& b) {
    const glm::dvec3 u = a - apex, v = b - apex;
    return std::atan2(glm::length(glm::cross(u, v)), glm::dot(u, v));
}

/// Maximum distance of an edge or face midpoint from the skin, in target edge lengths. Without this
/// limit, fingertips erode.
constexpr double kDeviation = 0.22;

/// A copy of the elements: the loops below change the mesh.
template <class Range>
auto listed(const Range& range) {
    return std::vector<std::decay_t<decltype(*range.begin())>>(range.begin(), range.end());
}

} // namespace

Remesher::Remesher(const ImplicitBody& body, const DetailMap& detail, SkinMesh& mesh)
    : _body(body), _detail(detail), _mesh(mesh),
      _normal(mesh.add_property_map<Vertex, glm::dvec3>("v:implicit normal").first),
      _curve(mesh.add_property_map<Vertex, std::size_t>("v:curve", 0).first) {
    for (const Vertex v : _mesh.vertices()) _normal[v] = _body.normal(at(v));
}

double Remesher::expectedVertices(double scale) const {
    double count = 0;
    for (const auto face : _mesh.faces()) {
        const Halfedge h = _mesh.halfedge(face);
        const glm::dvec3 a = at(_mesh.source(h)), b = at(_mesh.target(h)),
                         c = at(_mesh.target(_mesh.next(h)));
        const double length = _detail.edgeLength((a + b + c) / 3.0) * scale;
        // Equilateral triangles have half a vertex each.
        count += glm::length(glm::cross(b - a, c - a)) / 2 / (std::sqrt(3.0) / 2 * length * length);
    }
    return count;
}

void Remesher::run(double scale, int rounds) {
    _scale = scale;
    for (int i = 0; i < rounds; ++i) {
        splitLong();
        collapseShort();
        flipForValence();
        relax();
    }
    _mesh.collect_garbage();
}

void Remesher::polish(int rounds) {
    for (int i = 0; i < rounds; ++i) {
        flipForAngle();
        relax();
    }
    flipForAngle();
}

void Remesher::settle(Vertex v, const glm::dvec3& point) {
    const glm::dvec3 skin = _body.projected(point);
    _mesh.point(v) = toCgal(skin);
    _normal[v] = _body.normal(skin);
}

void Remesher::settleOn(const SkinCurve& curve, Vertex v, glm::dvec3 point) {
    constexpr double kStep = 1e-4;
    for (int i = 0; i < 6; ++i) { // alternates between the curve's side and the skin
        const glm::dvec3 normal = _body.normal(point);
        glm::dvec3 slope;
        for (int k = 0; k < 3; ++k) {
            glm::dvec3 step(0);
            step[k] = kStep;
            slope[k] = (curve.side(point + step) - curve.side(point - step)) / (2 * kStep);
        }
        slope -= normal * glm::dot(slope, normal);
        point -= slope * (curve.side(point) / std::max(glm::dot(slope, slope), 0.01));
        point = _body.projected(point);
    }
    settle(v, point);
}

bool Remesher::onSameCurve(Vertex a, Vertex b) const {
    return _curve[a] != 0 && _curve[a] == _curve[b];
}

void Remesher::follow(const SkinCurve& curve) {
    _curves.push_back(curve);
    for (const Edge e : listed(_mesh.edges())) {
        const Halfedge h = _mesh.halfedge(e);
        Vertex near = _mesh.source(h), far = _mesh.target(h);
        if (!curve.applies(at(near)) || !curve.applies(at(far))) continue;
        if (_curve[near] == _curves.size() || _curve[far] == _curves.size()) continue;
        const double a = curve.side(at(near)), b = curve.side(at(far));
        if (a * b >= 0) continue;
        if (std::abs(b) < std::abs(a)) std::swap(near, far);
        if (_curve[near] != 0) std::swap(near, far);
        if (_curve[near] != 0) continue;
        settleOn(curve, near, at(near));
        _curve[near] = _curves.size();
    }
    collapseSlivers();
    _mesh.collect_garbage();
}

/// Removes vertices that a curve came close to.
void Remesher::collapseSlivers() {
    constexpr double kShort = 0.6; // of the wanted length
    for (const Edge e : listed(_mesh.edges())) {
        if (_mesh.is_removed(e)) continue;
        const Halfedge h = _mesh.halfedge(e);
        const glm::dvec3 a = at(_mesh.source(h)), b = at(_mesh.target(h));
        if (glm::distance(a, b) > kShort * wanted((a + b) / 2.0)) continue;
        for (const Halfedge way : {h, _mesh.opposite(h)}) {
            const Vertex gone = _mesh.source(way), kept = _mesh.target(way);
            if (_curve[kept] == 0 || (_curve[gone] != 0 && _curve[gone] != _curve[kept])) continue;
            if (!mayCollapse(way)) continue;
            const Kernel::Point_3 place = _mesh.point(kept);
            const glm::dvec3 normal = _normal[kept];
            const std::size_t curve = _curve[kept];
            const Vertex left = CGAL::Euler::collapse_edge(e, _mesh);
            _mesh.point(left) = place;
            _normal[left] = normal;
            _curve[left] = curve;
            break;
        }
    }
}

bool Remesher::mustSplit(double length, const glm::dvec3& middle) const {
    const double goal = wanted(middle);
    return length > 4.0 / 3 * goal ||
           (length > 0.8 * goal && std::abs(_body.distance(middle)) > kDeviation * goal);
}

glm::dvec3 Remesher::faceNormal(Halfedge h) const {
    const glm::dvec3 a = at(_mesh.source(h));
    return glm::normalize(glm::cross(at(_mesh.target(h)) - a, at(_mesh.target(_mesh.next(h))) - a));
}

glm::dvec3 Remesher::lifted(glm::dvec3 point, const glm::dvec3& outward) const {
    const double length = glm::length(outward);
    if (length < 0.5) return point; // a sharp fold has no outward direction
    for (int i = 0; i < 12; ++i) point -= outward * (_body.distance(point) / length);
    return point;
}

void Remesher::splitLong() {
    for (const Edge e : listed(_mesh.edges())) {
        const Halfedge h = _mesh.halfedge(e);
        const glm::dvec3 a = at(_mesh.source(h)), b = at(_mesh.target(h)), middle = (a + b) / 2.0;
        if (!mustSplit(glm::distance(a, b), middle)) continue;
        const glm::dvec3 outward = faceNormal(h) + faceNormal(_mesh.opposite(h));
        const Halfedge in = CGAL::Euler::split_edge(h, _mesh); // ends in the new vertex
        settle(_mesh.target(in), lifted(middle, outward));
        CGAL::Euler::split_face(in, _mesh.next(_mesh.next(in)), _mesh);
        const Halfedge back = _mesh.prev(_mesh.opposite(in));
        CGAL::Euler::split_face(back, _mesh.next(_mesh.next(back)), _mesh);
    }
}

bool Remesher::facesOutward(Vertex a, Vertex b, Vertex c) const {
    const glm::dvec3 cross = glm::cross(at(b) - at(a), at(c) - at(a));
    const double length = glm::length(cross);
    if (length < 1e-12) return false;
    for (const Vertex v : {a, b, c})
        if (glm::dot(cross, _normal[v]) < 0.2 * length) return false;
    return true;
}

bool Remesher::strays(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) const {
    const glm::dvec3 middle = (a + b + c) / 3.0;
    return std::abs(_body.distance(middle)) > kDeviation * wanted(middle);
}

bool Remesher::mayCollapse(Halfedge h) const {
    if (!CGAL::Euler::does_satisfy_link_condition(_mesh.edge(h), _mesh)) return false;
    const Vertex gone = _mesh.source(h), kept = _mesh.target(h);
    const glm::dvec3 place = at(kept);
    for (const Halfedge spoke : CGAL::halfedges_around_source(gone, _mesh)) {
        const Vertex v = _mesh.target(spoke);
        if (v == kept) continue;
        if (glm::distance(at(v), place) > 4.0 / 3 * wanted((at(v) + place) / 2.0)) return false;
        const Vertex next = _mesh.target(_mesh.next(spoke));
        if (next == kept) continue;
        if (!facesOutward(kept, v, next)) return false;
        if (strays(place, at(v), at(next))) return false;
    }
    return true;
}

void Remesher::collapseShort() {
    for (const Edge e : listed(_mesh.edges())) {
        if (_mesh.is_removed(e)) continue;
        const Halfedge h = _mesh.halfedge(e);
        const glm::dvec3 a = at(_mesh.source(h)), b = at(_mesh.target(h));
        if (glm::distance(a, b) > 4.0 / 5 * wanted((a + b) / 2.0)) continue;
        for (const Halfedge way : {h, _mesh.opposite(h)}) {
            if (!mayCollapse(way)) continue;
            const Vertex kept = _mesh.target(way);
            const Kernel::Point_3 place = _mesh.point(kept);
            const glm::dvec3 normal = _normal[kept];
            const Vertex left = CGAL::Euler::collapse_edge(e, _mesh);
            _mesh.point(left) = place;
            _normal[left] = normal;
            break;
        }
    }
}

bool Remesher::mayFlip(Edge e) const {
    const Halfedge h = _mesh.halfedge(e), o = _mesh.opposite(h);
    const Vertex a = _mesh.source(h), b = _mesh.target(h);
    const Vertex c = _mesh.target(_mesh.next(h)), d = _mesh.target(_mesh.next(o));
    if (_mesh.halfedge(c, d).is_valid()) return false;
    return _mesh.degree(a) > 3 && _mesh.degree(b) > 3 && facesOutward(c, d, b) &&
           facesOutward(d, c, a) && !strays(at(c), at(d), at(b)) && !strays(at(d), at(c), at(a));
}

void Remesher::flipForValence() {
    const auto excess = [this](Vertex v, int change) {
        return std::abs(static_cast<int>(_mesh.degree(v)) + change - 6);
    };
    for (const Edge e : listed(_mesh.edges())) {
        const Halfedge h = _mesh.halfedge(e), o = _mesh.opposite(h);
        const Vertex a = _mesh.source(h), b = _mesh.target(h);
        const Vertex c = _mesh.target(_mesh.next(h)), d = _mesh.target(_mesh.next(o));
        const int before = excess(a, 0) + excess(b, 0) + excess(c, 0) + excess(d, 0);
        const int after = excess(a, -1) + excess(b, -1) + excess(c, 1) + excess(d, 1);
        if (after >= before || !mayFlip(e)) continue;
        if (std::min(smallestAngle(c, d, b), smallestAngle(d, c, a)) < 0.3) continue;
        CGAL::Euler::flip_edge(h, _mesh);
    }
}

double Remesher::smallestAngle(Vertex a, Vertex b, Vertex c) const {
    const glm::dvec3 pa = at(a), pb = at(b), pc = at(c);
    return std::min({angleAt(pa, pb, pc), angleAt(pb, pc, pa), angleAt(pc, pa, pb)});
}

void Remesher::flipForAngle() {
    for (const Edge e : listed(_mesh.edges())) {
        const Halfedge h = _mesh.halfedge(e), o = _mesh.opposite(h);
        const Vertex a = _mesh.source(h), b = _mesh.target(h);
        const Vertex c = _mesh.target(_mesh.next(h)), d = _mesh.target(_mesh.next(o));
        const double before = std::min(smallestAngle(a, b, c), smallestAngle(b, a, d));
        const double after = std::min(smallestAngle(c, d, b), smallestAngle(d, c, a));
        if (onSameCurve(a, b) || onSameCurve(c, d)) continue;
        if (after > before + 1e-3 && mayFlip(e)) CGAL::Euler::flip_edge(h, _mesh);
    }
}

bool Remesher::maySit(Vertex v) const {
    for (const Halfedge spoke : CGAL::halfedges_around_source(v, _mesh)) {
        const Vertex a = _mesh.target(spoke), b = _mesh.target(_mesh.next(spoke));
        if (!facesOutward(v, a, b) || strays(at(v), at(a), at(b))) return false;
    }
    return true;
}

void Remesher::relax() {
    for (const Vertex v : _mesh.vertices()) {
        const glm::dvec3 place = at(v);
        glm::dvec3 sum(0);
        double weights = 0;
        for (const Halfedge spoke : CGAL::halfedges_around_source(v, _mesh)) {
            const glm::dvec3 a = at(_mesh.target(spoke));
            const glm::dvec3 b = at(_mesh.target(_mesh.next(spoke)));
            const glm::dvec3 middle = (place + a + b) / 3.0;
            const double length = wanted(middle);
            const double weight = glm::length(glm::cross(a - place, b - place)) / (length * length);
            sum += middle * weight;
            weights += weight;
        }
        glm::dvec3 move = sum / weights - place;
        move -= _normal[v] * glm::dot(move, _normal[v]);
        const glm::dvec3 normal = _normal[v];
        if (_curve[v] == 0)
            settle(v, place + move);
        else
            settleOn(_curves[_curve[v] - 1], v, place + move);
        if (!maySit(v)) {
            _mesh.point(v) = toCgal(place);
            _normal[v] = normal;
        }
    }
}

} // namespace mannequin
