// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapes/LimitSteps.h"

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>

namespace osgSkin {
namespace {

constexpr double kFastest = 1.5; ///< times a rigid body's step

/// Skin nearer to the axis counts as this far off it, in radii of the limb: it hardly moves.
constexpr double kAtAxis = 0.1;

/// How far a vertex' limit reaches to its neighbours, in radii.
constexpr double kFade = 0.7;

/// Bends that are looked at: so many axes, each as far as a joint can turn, degrees.
constexpr int kAxes = 8, kMostBend = 176, kBendStep = 4;

using Weights = std::array<double, CorrectiveJoint::kMostModes>;

/// A vertex on its way through the bends.
struct Moving {
    const ShapedJoint::Vertex* vertex;
    const glm::dvec3* vectors; ///< its modes'
    double share = 1.0;        ///< that it keeps of them
};

/// The largest share, 0 to 1, of `shape` that `plain` and it together are at most `most` long by.
double shareWithin(const glm::dvec3& plain, const glm::dvec3& shape, double most) {
    const double square = glm::dot(shape, shape);
    if (!(square > 0.0)) return 1.0;
    const double along = glm::dot(plain, shape);
    const double room = most * most - glm::dot(plain, plain);
    if (!(room > 0.0)) return 0.0;
    return std::clamp((std::sqrt(along * along + square * room) - along) / square, 0.0, 1.0);
}

class Steps {
public:
    Steps(const ShapedJoint& joint, const CorrectiveJoint& functions)
        : _joint(joint), _functions(functions) {}

    /// Limits all vertices' shares in a step of one degree, from `degrees` on, about one axis.
    void look(double degrees, double direction, std::vector<Moving>& vertices) const {
        const glm::dvec2 way(std::cos(direction), std::sin(direction));
        const Bend first = bendAt(degrees, way), second = bendAt(degrees + 1.0, way);
        const glm::dvec3 axis = _joint.bendAt(way * 0.5).bendAxis;
        const double chord = 2.0 * std::sin(glm::radians(0.5));
        for (Moving& moving : vertices) {
            const ShapedJoint::Vertex& vertex = *moving.vertex;
            const glm::dquat from = _joint.turnOf(vertex, first.bend),
                             to = _joint.turnOf(vertex, second.bend);
            const double radius =
                std::max(glm::length(glm::cross(axis, vertex.from)), kAtAxis * _joint.radius);
            const glm::dvec3 plain = to * vertex.from - from * vertex.from;
            const glm::dvec3 shape =
                to * offset(moving, second.weights) - from * offset(moving, first.weights);
            moving.share =
                std::min(moving.share, shareWithin(plain, shape, kFastest * chord * radius));
        }
    }

private:
    struct Bend {
        BendTwist bend;
        Weights weights;
    };

    Bend bendAt(double degrees, const glm::dvec2& way) const {
        const glm::dvec2 xy = std::sin(glm::radians(0.5 * degrees)) * way;
        Bend result{_joint.bendAt(xy), {}};
        _functions.weights(xy, result.weights.data());
        return result;
    }

    glm::dvec3 offset(const Moving& moving, const Weights& weights) const {
        glm::dvec3 sum(0.0);
        for (std::size_t k = 0; k < _functions.modes; ++k) sum += weights[k] * moving.vectors[k];
        return sum;
    }

    const ShapedJoint& _joint;
    const CorrectiveJoint& _functions;
};

/// Where neighbours of vertices with less than a whole share may have no more than a little more.
std::vector<double> faded(const std::vector<Moving>& vertices, double radius) {
    std::vector<double> shares;
    shares.reserve(vertices.size());
    for (const Moving& moving : vertices) shares.push_back(moving.share);
    for (const Moving& moving : vertices) {
        if (moving.share >= 1.0) continue;
        for (std::size_t i = 0; i < vertices.size(); ++i) {
            const double away = glm::distance(vertices[i].vertex->from, moving.vertex->from);
            shares[i] = std::min(shares[i], moving.share + away / (kFade * radius));
        }
    }
    return shares;
}

} // namespace

void limitSteps(const ShapedJoint& joint, FittedShapes& shapes) {
    const std::size_t modes = shapes.functions.modes;
    if (modes == 0) return;
    std::unordered_map<std::uint32_t, const ShapedJoint::Vertex*> known;
    for (const ShapedJoint::Vertex& vertex : joint.vertices) known[vertex.index] = &vertex;
    std::vector<Moving> vertices;
    for (std::size_t v = 0; v < shapes.vertices.size(); ++v)
        vertices.push_back({known.at(shapes.vertices[v]), &shapes.vectors[v * modes]});
    const Steps steps(joint, shapes.functions);
    for (int i = 0; i < kAxes; ++i)
        for (int degrees = -kMostBend; degrees < kMostBend; degrees += kBendStep)
            steps.look(degrees, glm::pi<double>() * i / kAxes, vertices);
    const std::vector<double> shares = faded(vertices, joint.radius);
    for (std::size_t v = 0; v < shares.size(); ++v)
        for (std::size_t k = 0; k < modes; ++k) shapes.vectors[v * modes + k] *= shares[v];
}

} // namespace osgSkin
