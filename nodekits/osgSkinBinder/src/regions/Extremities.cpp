// SPDX-License-Identifier: GPL-3.0-or-later
#include "regions/Regions.h"

#include "joints/BodyAxes.h"
#include "mesh/Parallel.h"

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

namespace osgSkin {
namespace {

/// How far a section may lean from the joint's plane, in degrees.
constexpr double kMaxLean = 25.0;
constexpr int kLeans = 5;
constexpr int kDirections = 12;

/// The section below a chin and behind a skull leans forward by this angle, in degrees, and by up
/// to `kMaxHeadLean` more or less.
constexpr double kHeadLean = 30.0;
constexpr double kMaxHeadLean = 25.0;

/// How far below its joint a head may end, in lengths of the head; the jaw hangs below the joint.
constexpr double kMaxDrop = 0.6;
constexpr int kDrops = 12;

/// A section of a neck is narrow if it is at most this many times as long as the narrowest.
constexpr double kNarrow = 1.15;

/// A head, hand or foot has at most this many times as many vertices as the rest of the skin.
constexpr double kMaxShare = 2.0;

using Edge = std::pair<std::uint32_t, std::uint32_t>; // lower index first

struct Plane {
    glm::dvec3 point, normal;

    double height(const glm::dvec3& p) const { return glm::dot(p - point, normal); }
};

/// A loop in which a plane cuts the skin.
struct Section {
    Plane plane;
    std::vector<Edge> edges; ///< edges of the mesh that the plane crosses
    double length = std::numeric_limits<double>::infinity();
};

class SectionFinder {
public:
    /// \param centre of the joint
    /// \param farthest distance from it of points to come
    SectionFinder(const WeldedMesh& mesh, const glm::dvec3& centre, double farthest)
        : _mesh(mesh), _heights(mesh.vertexCount()), _farthest(farthest) {
        for (const auto& t : mesh.triangles) {
            const glm::dvec3 &a = mesh.positions[t[0]], &b = mesh.positions[t[1]],
                             &c = mesh.positions[t[2]];
            const double nearest = std::min(
                {glm::distance(a, centre), glm::distance(b, centre), glm::distance(c, centre)});
            const double longest =
                std::max({glm::distance(a, b), glm::distance(b, c), glm::distance(c, a)});
            _triangles.push_back({nearest - longest, longest, t});
        }
    }

    /// The shortest closed loop around the plane's point, if there is one.
    /// \param most longer ones need not be found, now and later
    std::optional<Section> find(const Plane& plane, double most) {
        if (most < kShorter * _most) {
            _most = most;
            // A loop around a point goes no farther away from it than half its length.
            const double reach = 0.5 * most + _farthest;
            _triangles.erase(std::remove_if(_triangles.begin(), _triangles.end(),
                                            [&](const Triangle& t) { return t.away > reach; }),
                             _triangles.end());
        }
        std::map<Edge, std::vector<Edge>> next; // a triangle joins two crossed edges
        for (const auto& [away, longest, t] : _triangles) {
            if (std::abs(plane.height(_mesh.positions[t[0]])) > 1.001 * longest) continue;
            for (const std::uint32_t v : t) _heights[v] = plane.height(_mesh.positions[v]);
            const bool above[3] = {_heights[t[0]] > 0.0, _heights[t[1]] > 0.0,
                                   _heights[t[2]] > 0.0};
            if (above[0] == above[1] && above[1] == above[2]) continue;
            std::vector<Edge> crossed;
            for (std::size_t k = 0; k < 3; ++k)
                if (above[k] != above[(k + 1) % 3])
                    crossed.push_back(std::minmax(t[k], t[(k + 1) % 3]));
            next[crossed[0]].push_back(crossed[1]);
            next[crossed[1]].push_back(crossed[0]);
        }
        std::optional<Section> shortest;
        while (!next.empty()) {
            std::vector<Edge> loop = takeLoop(next);
            const double length = lengthAround(loop, plane);
            if (length > 0.0 && (!shortest || length < shortest->length))
                shortest = Section{plane, std::move(loop), length};
        }
        return shortest;
    }

    /// The connected skin beyond a section; empty if the section does not part the skin.
    std::vector<std::uint32_t> beyond(const Section& section) const {
        std::vector<bool> isReached(_mesh.vertexCount(), false);
        std::vector<std::uint32_t> reached, below;
        for (const Edge& edge : section.edges) {
            const bool isFirst = section.plane.height(_mesh.positions[edge.first]) > 0.0;
            reach(isFirst ? edge.first : edge.second, isReached, reached);
            below.push_back(isFirst ? edge.second : edge.first);
        }
        const auto isCut = [&section](std::uint32_t a, std::uint32_t b) {
            return std::binary_search(section.edges.begin(), section.edges.end(),
                                      Edge(std::minmax(a, b)));
        };
        for (std::size_t i = 0; i < reached.size(); ++i) {
            const std::uint32_t v = reached[i];
            for (const std::uint32_t next : _mesh.neighboursOf(v))
                if (!isReached[next] && !isCut(v, next)) reach(next, isReached, reached);
        }
        for (const std::uint32_t v : below)
            if (isReached[v]) return {};
        std::sort(reached.begin(), reached.end());
        return reached;
    }

private:
    /// Far triangles are dropped when sections become shorter by this factor.
    static constexpr double kShorter = 0.9;

    struct Triangle {
        double away;    ///< at most its distance from the centre
        double longest; ///< edge
        std::array<std::uint32_t, 3> corners;
    };

    static void reach(std::uint32_t v, std::vector<bool>& isReached,
                      std::vector<std::uint32_t>& reached) {
        if (isReached[v]) return;
        isReached[v] = true;
        reached.push_back(v);
    }

    /// Removes one loop from the crossed edges and returns it in order; empty if it is not closed.
    static std::vector<Edge> takeLoop(std::map<Edge, std::vector<Edge>>& next) {
        std::vector<Edge> loop;
        Edge edge = next.begin()->first;
        bool isClosed = true;
        while (true) {
            const auto found = next.find(edge);
            if (found == next.end()) break; // back at the first one
            const std::vector<Edge> ways = std::move(found->second);
            next.erase(found);
            loop.push_back(edge);
            if (ways.size() != 2) isClosed = false;
            const auto on = std::find_if(ways.begin(), ways.end(), [&next](const Edge& way) {
                return next.find(way) != next.end();
            });
            if (on == ways.end()) {
                const auto back = std::find(ways.begin(), ways.end(), loop.front());
                isClosed = isClosed && back != ways.end();
                break;
            }
            edge = *on;
        }
        return isClosed && loop.size() > 2 ? loop : std::vector<Edge>();
    }

    /// The loop's length if it encloses the plane's point and lies on the limb's outside, else 0
    /// (as for the inside of a throat).
    double lengthAround(const std::vector<Edge>& loop, const Plane& plane) const {
        double length = 0.0, angle = 0.0, outwards = 0.0;
        for (std::size_t i = 0; i < loop.size(); ++i) {
            const glm::dvec3 a = crossing(loop[i]), b = crossing(loop[(i + 1) % loop.size()]);
            length += glm::distance(a, b);
            const glm::dvec3 u = a - plane.point, v = b - plane.point;
            angle += std::atan2(glm::dot(glm::cross(u, v), plane.normal), glm::dot(u, v));
            outwards += glm::distance(a, b) * glm::dot(_mesh.normals[loop[i].first], u);
        }
        return std::abs(angle) > glm::pi<double>() && outwards > 0.0 ? length : 0.0;
    }

    glm::dvec3 crossing(const Edge& edge) const {
        const double a = _heights[edge.first], b = _heights[edge.second];
        return glm::mix(_mesh.positions[edge.first], _mesh.positions[edge.second], a / (a - b));
    }

    const WeldedMesh& _mesh;
    std::vector<double> _heights; ///< of the vertices above the plane
    double _farthest;
    double _most = std::numeric_limits<double>::infinity();
    std::vector<Triangle> _triangles; ///< those that sections of length `_most` may have
};

/// Unit directions spread evenly over a cone around `axis`.
/// \param across a direction fixed to the body, so that sections do not depend on its orientation
std::vector<glm::dvec3> leaning(const glm::dvec3& axis, const glm::dvec3& across, double maxLean) {
    const glm::dvec3 aside = across - axis * glm::dot(across, axis);
    const double length = glm::length(aside);
    const glm::dvec3 u =
        length > 1e-3 * glm::length(across) ? aside / length : anyPerpendicular(axis);
    const glm::dvec3 v = glm::cross(axis, u);
    std::vector<glm::dvec3> result{axis};
    for (int i = 1; i <= kLeans; ++i)
        for (int k = 0; k < kDirections; ++k) {
            const double lean = glm::radians(maxLean * i / kLeans);
            const double around = 2.0 * glm::pi<double>() * k / kDirections;
            result.push_back(std::cos(lean) * axis +
                             std::sin(lean) * (std::cos(around) * u + std::sin(around) * v));
        }
    return result;
}

/// How far skin reaches beyond a joint along its bone.
double reachBeyond(const PlannedJoint& joint) {
    double reach = joint.boneLength;
    for (const glm::dvec3& sample : joint.samples)
        reach = std::max(reach, glm::distance(sample, joint.centre));
    return reach;
}

/// The shortest section around a point of a limb with one of these normals, if it is shorter than
/// `most`.
std::optional<Section> narrowestAt(SectionFinder& finder, const glm::dvec3& point,
                                   const std::vector<glm::dvec3>& normals,
                                   double most = std::numeric_limits<double>::infinity()) {
    std::optional<Section> narrowest;
    for (const glm::dvec3& normal : normals) {
        std::optional<Section> section = finder.find({point, normal}, kNarrow * most);
        if (!section || section->length >= most) continue;
        most = section->length;
        narrowest = std::move(section);
    }
    return narrowest;
}

/// The border of a head: starts where the neck is narrowest and moves up, with the same normal, as
/// long as the section stays narrow.
std::optional<Section> headBorder(SectionFinder& finder, const PlannedJoint& joint,
                                  const glm::dvec3& front, const glm::dvec3& across) {
    glm::dvec3 along = planeNormal(joint);
    const double length = glm::length(front);
    if (length > 0.0)
        along = glm::normalize(std::cos(glm::radians(kHeadLean)) * along +
                               std::sin(glm::radians(kHeadLean)) / length * front);
    const std::vector<glm::dvec3> normals =
        leaning(along, across, length > 0.0 ? kMaxHeadLean : 2.0 * kMaxHeadLean);
    const double maxDrop = kMaxDrop * reachBeyond(joint);
    const auto pointAt = [&](int drop) {
        return joint.centre - (maxDrop * drop / kDrops) * joint.comingFrom;
    };
    std::optional<Section> narrowest;
    int lowest = 0;
    for (int i = 0; i <= kDrops; ++i) {
        std::optional<Section> section =
            narrowest ? narrowestAt(finder, pointAt(i), normals, narrowest->length)
                      : narrowestAt(finder, pointAt(i), normals);
        if (!section) continue;
        narrowest = std::move(section);
        lowest = i;
    }
    if (!narrowest) return std::nullopt;
    Section border = *narrowest;
    for (int i = lowest; i-- > 0;) {
        const double most = kNarrow * narrowest->length;
        std::optional<Section> section = finder.find({pointAt(i), narrowest->plane.normal}, most);
        if (!section || section->length > most) break;
        border = std::move(*section);
    }
    return border;
}

/// \param front of the body, of any length; zero if unknown
std::vector<std::uint32_t> beyondJoint(const WeldedMesh& mesh,
                                       const std::vector<PlannedJoint>& joints,
                                       const PlannedJoint& joint, const glm::dvec3& front) {
    SectionFinder finder(mesh, joint.centre, kMaxDrop * reachBeyond(joint));
    const glm::dvec3 across =
        glm::length(front) > 0.0 ? front : joint.centre - joints.front().centre;
    std::optional<Section> border =
        joint.part == JointPart::Head
            ? headBorder(finder, joint, front, across)
            : narrowestAt(finder, joint.centre, leaning(planeNormal(joint), across, kMaxLean));
    if (!border) return {};
    std::sort(border->edges.begin(), border->edges.end());
    std::vector<std::uint32_t> beyond = finder.beyond(*border);
    const double rest = static_cast<double>(mesh.vertexCount() - beyond.size());
    if (static_cast<double>(beyond.size()) > kMaxShare * rest) beyond.clear();
    return beyond;
}

} // namespace

void findExtremities(const WeldedMesh& mesh, std::vector<PlannedJoint>& joints) {
    const glm::dvec3 front = facing(joints);
    parallelFor(joints.size(), [&](std::size_t j) {
        PlannedJoint& joint = joints[j];
        if (joint.isExtremity() && joint.holdsRegion() && joint.lengthAbove > 0.0)
            joint.beyond = beyondJoint(mesh, joints, joint, front);
    });
}

} // namespace osgSkin
