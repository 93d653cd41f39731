// SPDX-License-Identifier: MIT
#include "arms/BodySurface.h"

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <string>
#include <utility>

namespace osgSkin {

SkinPoints SkinPoints::spread(std::size_t most) const {
    if (size() <= most) return *this;
    // Fine meshes are thinned first: the loop below takes time proportional to points times
    // samples.
    const std::size_t step = std::max<std::size_t>(1, size() / 20000);
    SkinPoints result;
    std::vector<double> distances(size(), std::numeric_limits<double>::infinity());
    std::size_t next = 0;
    while (result.size() < most) {
        result.add(places[next], normals[next], joints[next]);
        const glm::dvec3 last = places[next];
        double largest = 0.0;
        for (std::size_t i = 0; i < size(); i += step) {
            const glm::dvec3 d = places[i] - last;
            distances[i] = std::min(distances[i], glm::dot(d, d));
            if (distances[i] <= largest) continue;
            largest = distances[i];
            next = i;
        }
        if (largest <= 0.0) break; // only duplicates are left
    }
    return result;
}

SkinPoints SkinPoints::averaged(std::size_t most) const {
    SkinPoints result = spread(most);
    const SkinPoints samples = result;
    std::vector<glm::dvec3> placeSums(samples.size(), glm::dvec3(0.0)), normalSums = placeSums;
    std::vector<double> counts(samples.size(), 0.0);
    for (std::size_t i = 0; i < size(); ++i) {
        double least = std::numeric_limits<double>::infinity();
        std::size_t nearest = 0;
        for (std::size_t k = 0; k < samples.size(); ++k) {
            const glm::dvec3 d = samples.places[k] - places[i];
            const double square = glm::dot(d, d);
            if (samples.joints[k] != joints[i] || !(square < least)) continue;
            least = square;
            nearest = k;
        }
        if (!(least < std::numeric_limits<double>::infinity())) continue;
        placeSums[nearest] += places[i];
        normalSums[nearest] += normals[i];
        counts[nearest] += 1.0;
    }
    for (std::size_t k = 0; k < samples.size(); ++k) {
        const double length = glm::length(normalSums[k]);
        if (!(length > 0.0)) continue;
        result.places[k] = placeSums[k] / counts[k];
        result.normals[k] = normalSums[k] / length;
    }
    return result;
}

namespace {

/// The mean distance between neighbouring points.
double spacing(const std::vector<glm::dvec3>& places) {
    double sum = 0.0;
    for (std::size_t i = 0; i < places.size(); ++i) {
        double nearest = std::numeric_limits<double>::infinity();
        for (std::size_t k = 0; k < places.size(); ++k)
            if (k != i) nearest = std::min(nearest, glm::distance(places[i], places[k]));
        if (places.size() > 1) sum += nearest;
    }
    return sum / double(places.size());
}

} // namespace

BodySurface::BodySurface(SkinPoints points)
    : _points(std::move(points)), _places(_points.places), _normals(_points.normals) {
    const double length = spacing(_places);
    _softening = std::max(length * length, std::numeric_limits<double>::min());
}

void BodySurface::pose(const PosedJoints& joints) {
    _centre = glm::dvec3(0.0);
    for (std::size_t i = 0; i < _points.size(); ++i) {
        const std::size_t joint = _points.joints[i];
        _places[i] = joints.place(_points.places[i], joint);
        _normals[i] = joints.rotations[joint] * _points.normals[i];
        _centre += _places[i];
    }
    _centre /= double(_points.size());
    double square = 0.0;
    for (const glm::dvec3& place : _places) {
        const glm::dvec3 d = place - _centre;
        square = std::max(square, glm::dot(d, d));
    }
    _radius = std::sqrt(square);
}

bool BodySurface::isNear(const glm::dvec3& place, double margin) const {
    const glm::dvec3 d = place - _centre;
    const double reach = _radius + margin;
    return glm::dot(d, d) < reach * reach;
}

BodySurface::Depth BodySurface::depth(const glm::dvec3& place) const {
    double weights = 0.0, depth = 0.0;
    glm::dvec3 out(0.0);
    for (std::size_t i = 0; i < _places.size(); ++i) {
        const glm::dvec3 d = _places[i] - place;
        // Weights fall with the eighth power of the distance, so that the far side of the body does
        // not count.
        double weight = 1.0 / (glm::dot(d, d) + _softening);
        weight *= weight;
        weight *= weight;
        weights += weight;
        depth += weight * glm::dot(_normals[i], d);
        out += weight * _normals[i];
    }
    // If the weights underflow, no point is near.
    if (!(weights > 0.0)) return {};
    depth /= weights;
    out /= weights;
    return {depth * glm::dot(out, out), out};
}

namespace {

enum Piece { Trunk, Head, LeftThigh, RightThigh, LeftArm, RightArm, Other, kPieces };

constexpr std::array<std::size_t, Other> kMaxPoints{320, 120, 120, 120, 80, 80};
constexpr std::size_t kRimPoints = 8; ///< points that close a cut

bool endsWith(const std::string& text, const std::string& end) {
    return text.size() >= end.size() &&
           text.compare(text.size() - end.size(), end.size(), end) == 0;
}

Piece pieceOf(const std::string& role) {
    const bool left = role.compare(0, 4, "Left") == 0;
    if (role == "Hips" || role == "Spine" || role == "Neck" || endsWith(role, "Collar") ||
        endsWith(role, "HipJoint"))
        return Trunk;
    if (role == "Head") return Head;
    if (endsWith(role, "UpperLeg")) return left ? LeftThigh : RightThigh;
    if (endsWith(role, "LowerArm")) return left ? LeftArm : RightArm;
    return Other;
}

bool isArm(Piece piece) {
    return piece == LeftArm || piece == RightArm;
}

std::vector<Piece> piecesOf(const RestSkeleton& rest, const JointRoles& roles) {
    const std::size_t count = rest.joints.size();
    std::vector<bool> leadsOn(count, false); // to a joint with a role
    std::vector<bool> isLeaf(count, true);
    for (std::size_t j = count; j-- > 1;) {
        const auto parent = static_cast<std::size_t>(rest.joints[j].parent);
        isLeaf[parent] = false;
        if (leadsOn[j] || !roles.roles[j].empty()) leadsOn[parent] = true;
    }
    std::vector<Piece> result(count, Other);
    for (std::size_t j = 0; j < count; ++j) {
        const int parent = rest.joints[j].parent;
        const Piece above = parent < 0 ? Other : result[static_cast<std::size_t>(parent)];
        const bool isHelper = roles.roles[j].empty() && (leadsOn[j] || isLeaf[j]);
        if (isArm(above) || isHelper)
            result[j] = above;
        else if (!roles.roles[j].empty())
            result[j] = pieceOf(roles.roles[j]);
    }
    return result;
}

std::vector<glm::dvec3> vertexNormals(const SkinMesh& mesh, const std::vector<std::uint32_t>& t) {
    std::vector<glm::dvec3> normals(mesh.positions.size(), glm::dvec3(0.0));
    for (std::size_t i = 0; i + 2 < t.size(); i += 3) {
        const glm::dvec3& a = mesh.positions[t[i]];
        const glm::dvec3 n = glm::cross(mesh.positions[t[i + 1]] - a, mesh.positions[t[i + 2]] - a);
        for (std::size_t k = 0; k < 3; ++k) normals[t[i + k]] += n;
    }
    return normals;
}

/// A cut between two pieces: the midpoints of the edges between them.
struct Cut {
    std::vector<glm::dvec3> middles;
    glm::dvec3 out{0.0};
    std::map<std::uint32_t, std::size_t> joints; ///< number of these edges that begin at each joint
};

/// Closes a cut with a few points on a disc.
void close(const Cut& cut, SkinPoints& points) {
    const double length = glm::length(cut.out);
    if (!(length > 0.0)) return;
    const glm::dvec3 normal = cut.out / length;
    glm::dvec3 centre(0.0);
    for (const glm::dvec3& middle : cut.middles) centre += middle / double(cut.middles.size());
    const auto most =
        std::max_element(cut.joints.begin(), cut.joints.end(),
                         [](const auto& a, const auto& b) { return a.second < b.second; });
    points.add(centre, normal, most->first);
    const std::size_t count = std::min(kRimPoints, cut.middles.size());
    for (std::size_t i = 0; i < count; ++i) {
        const glm::dvec3& rim = cut.middles[i * cut.middles.size() / count];
        points.add(0.5 * (centre + rim), normal, most->first);
    }
}

/// Assigns a skin's vertices and cuts to pieces.
struct SortedSkin {
    std::array<SkinPoints, kPieces> points;
    std::array<std::map<Piece, Cut>, kPieces> cuts; ///< [piece], by the neighbouring piece

    SortedSkin(const std::vector<Piece>& pieces, const SkinMesh& mesh, const Binding& binding) {
        const std::vector<std::uint32_t> corners = mesh.triangles();
        const std::vector<glm::dvec3> normals = vertexNormals(mesh, corners);
        for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
            const double length = glm::length(normals[v]);
            if (!(length > 0.0)) continue;
            const std::uint32_t joint = binding.regions[v];
            points[pieces[joint]].add(mesh.positions[v], normals[v] / length, joint);
        }
        for (std::size_t i = 0; i < corners.size(); ++i) {
            const std::uint32_t from = corners[i], to = corners[i % 3 == 2 ? i - 2 : i + 1];
            addEdge(pieces, mesh, binding, from, to);
            addEdge(pieces, mesh, binding, to, from);
        }
    }

    void addEdge(const std::vector<Piece>& pieces, const SkinMesh& mesh, const Binding& binding,
                 std::uint32_t from, std::uint32_t to) {
        const Piece piece = pieces[binding.regions[from]], other = pieces[binding.regions[to]];
        if (piece == other) return;
        Cut& cut = cuts[piece][other];
        cut.middles.push_back(0.5 * (mesh.positions[from] + mesh.positions[to]));
        cut.out += mesh.positions[to] - mesh.positions[from];
        ++cut.joints[binding.regions[from]];
    }
};

double distanceToSegment(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b) {
    const glm::dvec3 along = b - a;
    const double square = glm::dot(along, along);
    const double s = square > 0.0 ? std::clamp(glm::dot(p - a, along) / square, 0.0, 1.0) : 0.0;
    return glm::distance(p, a + s * along);
}

/// The arm of one side, without held things: points farther from the forearm than its length.
void addArm(const RestSkeleton& rest, const JointRoles& roles, const std::string& side,
            const SkinPoints& skin, std::vector<ArmPiece>& arms) {
    const int upper = roles.joint(side + "UpperArm"), lower = roles.joint(side + "LowerArm");
    const int hand = roles.joint(side + "Hand");
    if (upper <= 0 || lower < 0 || hand < 0 || !rest.isInSubtree(lower, upper)) return;
    const glm::dvec3& elbow = rest.joints[static_cast<std::size_t>(lower)].centre;
    const glm::dvec3& wrist = rest.joints[static_cast<std::size_t>(hand)].centre;
    const double forearm = glm::distance(elbow, wrist);
    SkinPoints own;
    for (std::size_t i = 0; i < skin.size(); ++i)
        if (distanceToSegment(skin.places[i], elbow, wrist) < forearm)
            own.add(skin.places[i], skin.normals[i], skin.joints[i]);
    const auto shoulder = static_cast<std::size_t>(upper);
    const double length = glm::distance(rest.joints[shoulder].centre, elbow) + forearm;
    if (own.size() == 0 || !(length > 0.0)) return;
    arms.push_back({shoulder, length, own.spread(kMaxPoints[LeftArm])});
}

} // namespace

BodyPieces findBodyPieces(const RestSkeleton& rest, const JointRoles& roles, const SkinMesh& mesh,
                          const Binding& binding) {
    BodyPieces result;
    if (!roles.known()) return result;
    const SortedSkin sorted(piecesOf(rest, roles), mesh, binding);
    for (const Piece piece : {Trunk, Head, LeftThigh, RightThigh}) {
        SkinPoints points = sorted.points[piece].averaged(kMaxPoints[piece]);
        if (points.size() == 0) continue;
        for (const auto& [other, cut] : sorted.cuts[piece]) close(cut, points);
        result.surfaces.emplace_back(std::move(points));
    }
    addArm(rest, roles, "Left", sorted.points[LeftArm], result.arms);
    addArm(rest, roles, "Right", sorted.points[RightArm], result.arms);
    return result;
}

} // namespace osgSkin
