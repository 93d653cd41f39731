// SPDX-License-Identifier: GPL-3.0-or-later
#include "correctives/AddShapes.h"

#include "mesh/Parallel.h"
#include "ratios/JointRatios.h"

#include <osgSkin/BendTwist>
#include <osgSkin/GlmTypes>

#include <Eigen/Cholesky>

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>

namespace osgSkin {
namespace {

/// Numbers of sampled bends of a joint: along its main axis and across, or around and outwards.
constexpr int kAlong = 20;
constexpr int kAcross = 3;
constexpr int kAcrossTurned = 5;
constexpr int kAround = 12;
constexpr int kOutwards = 6;
/// The same for a joint that folds in any direction, as its shapes change faster.
constexpr int kAroundRound = 12;
constexpr int kOutwardsRound = 24;

constexpr double kNormalRidge = 1e-6;

/// The largest error of a normal in any bend that is accepted for fewer modes, radians.
constexpr double kMaxNormalError = 2e-2;

/// The least cosine between a normal and its target; skin that has folded over is not followed.
constexpr double kMinCosine = 0.15;

/// In a fold, ratios alone may invert skin that shapes then open. Gradients are limited so that at
/// least this share of the area remains, and tilts correct the rest.
constexpr double kMinArea = 0.1;

bool isHinge(const CorrectiveJoint& joint) {
    return joint.basis == CorrectiveJoint::Basis::Hinge ||
           joint.basis == CorrectiveJoint::Basis::TurnedHinge;
}

std::vector<glm::dvec2> normalSamples(const CorrectiveJoint& joint) {
    std::vector<glm::dvec2> samples;
    if (joint.basis == CorrectiveJoint::Basis::Input)
        for (int i = 1; i <= kOutwards; ++i)
            for (const double end : {joint.low.x, joint.high.x})
                samples.emplace_back(end * i / kOutwards, 0.0);
    if (!samples.empty()) return samples;
    const auto add = [&](const glm::dvec2& xy) {
        if (glm::length(xy) > 1e-3 && glm::length(xy) < 1.0) samples.push_back(xy);
    };
    if (isHinge(joint)) {
        const int across =
            joint.basis == CorrectiveJoint::Basis::TurnedHinge ? kAcrossTurned : kAcross;
        for (int i = 0; i <= kAlong; ++i)
            for (int j = 0; j < across; ++j)
                add(joint.low + (joint.high - joint.low) *
                                    glm::dvec2(double(i) / kAlong, (j + 1.0) / (across + 1.0)));
        return samples;
    }
    const bool isRound = joint.basis == CorrectiveJoint::Basis::Round;
    const int around = isRound ? kAroundRound : kAround;
    const int outwards = isRound ? kOutwardsRound : kOutwards;
    for (int i = 0; i < around; ++i)
        for (int j = 1; j <= outwards; ++j) {
            const double angle = glm::two_pi<double>() * i / around;
            const glm::dvec2 way(std::cos(angle), std::sin(angle));
            add(double(j) / outwards * way *
                glm::dvec2(way.x < 0.0 ? -joint.low.x : joint.high.x,
                           way.y < 0.0 ? -joint.low.y : joint.high.y));
        }
    return samples;
}

/// One joint's correctives on the skin, with the other joints at rest.
class CorrectedSkin {
public:
    CorrectedSkin(const WeldedMesh& mesh, const Binding& binding, std::uint32_t corrective)
        : _mesh(mesh), _binding(binding), _functions(binding.correctives.joints[corrective]),
          _isJoint(_functions.basis != CorrectiveJoint::Basis::Input),
          _joint(binding.joints[_isJoint ? _functions.joint : 0]), _ratios(mesh, binding),
          _posed(mesh.vertexCount()), _areas(mesh.vertexCount()) {
        std::vector<bool> touched(mesh.vertexCount(), false);
        for (std::uint32_t v = 0; v < mesh.weldedOf.size(); ++v) {
            const Correctives& from = binding.correctives;
            for (std::uint32_t i = from.firstEntry[v]; i < from.firstEntry[v + 1]; ++i) {
                if (from.entries[i].joint != corrective || touched[mesh.weldedOf[v]]) continue;
                touched[mesh.weldedOf[v]] = true;
                addVertex(v, from.entries[i].firstShare);
            }
        }
        std::vector<bool> corner(mesh.vertexCount(), false);
        for (const std::array<std::uint32_t, 3>& t : mesh.triangles) {
            if (!touched[t[0]] && !touched[t[1]] && !touched[t[2]]) continue;
            _triangles.push_back(t);
            for (const std::uint32_t v : t) {
                if (!touched[v] && !corner[v]) _others.push_back(v);
                corner[v] = true;
            }
        }
        _turns.resize(_vertices.size());
        _rest = normals(mesh.positions);
    }

    struct Vertex {
        std::uint32_t welded;
        std::size_t firstShare;
        Influence ratios;
        RatioGradient gradient;
    };
    const std::vector<Vertex>& vertices() const { return _vertices; }

    /// The tilt along the skin that each vertex's rest normal needs in a bend.
    /// \param corrected false to use uncorrected rest positions, for the error of the gradients
    std::vector<glm::dvec3> tilts(const glm::dvec2& xy, bool corrected = true) {
        const BendTwist bend = pose(xy, corrected);
        const std::vector<glm::dvec3> wanted = normals(_posed);
        std::vector<glm::dvec3> result;
        for (std::size_t v = 0; v < _vertices.size(); ++v)
            result.push_back(tilt(v, bend, wanted[v]));
        return result;
    }

    /// Shortens gradients that would invert the skin in one of the bends.
    void limitGradients(const std::vector<glm::dvec2>& bends) {
        std::vector<double> least(_vertices.size(), 1.0);
        for (const glm::dvec2& xy : bends) {
            const BendTwist bend = pose(xy, true);
            for (std::size_t v = 0; v < _vertices.size(); ++v)
                least[v] = std::min(least[v], 1.0 + glm::dot(glm::dvec3(_vertices[v].gradient.bend),
                                                             slideOf(v, bend)));
        }
        for (std::size_t v = 0; v < _vertices.size(); ++v)
            if (least[v] < kMinArea)
                _vertices[v].gradient.bend *=
                    static_cast<float>((1.0 - kMinArea) / (1.0 - least[v]));
    }

private:
    /// Bends the joint and sets `_posed` and `_turns`.
    BendTwist pose(const glm::dvec2& xy, bool corrected) {
        BendTwist bend;
        if (const double sine = glm::length(xy); _isJoint) {
            const glm::dvec3 other = glm::cross(_joint.twistAxis, _functions.axis);
            bend.bendAxis = (xy.x * _functions.axis + xy.y * other) / sine;
            bend.bendAngle = 2.0 * std::asin(std::min(sine, 1.0));
        }
        double beta[CorrectiveJoint::kMaxModes] = {};
        if (corrected) _functions.weights(xy, beta);
        for (const std::uint32_t v : _others)
            _posed[v] = turnOf(_ratios.of(v, _isJoint ? _functions.joint : 0), bend) *
                        (_mesh.positions[v] - _joint.centre);
        for (std::size_t v = 0; v < _vertices.size(); ++v) {
            const Vertex& vertex = _vertices[v];
            _turns[v] = turnOf(vertex.ratios, bend);
            _posed[vertex.welded] =
                _turns[v] * (_mesh.positions[vertex.welded] + offset(vertex, beta) - _joint.centre);
        }
        return bend;
    }

    /// The derivative of a vertex's position by its bend ratio, in the vertex's unrotated frame.
    glm::dvec3 slideOf(std::size_t v, const BendTwist& bend) const {
        return glm::conjugate(_turns[v]) *
               (bend.bendAngle * glm::cross(bend.bendAxis, _posed[_vertices[v].welded]));
    }

    void addVertex(std::uint32_t v, std::size_t firstShare) {
        Vertex vertex{_mesh.weldedOf[v], firstShare, {_functions.joint, 0.0f, 0.0f}, {}};
        for (std::uint32_t i = _binding.firstInfluence[v]; i < _binding.firstInfluence[v + 1]; ++i)
            if (_isJoint && _binding.influences[i].joint == _functions.joint) {
                vertex.ratios = _binding.influences[i];
                vertex.gradient = _binding.gradients[i];
            }
        _vertices.push_back(vertex);
    }

    glm::dquat turnOf(const Influence& ratios, const BendTwist& bend) const {
        return partialRotation(bend, _joint.twistAxis, double(ratios.bend), double(ratios.twist));
    }

    glm::dvec3 offset(const Vertex& vertex, const double* beta) const {
        const std::int16_t* share = &_binding.correctives.shares[vertex.firstShare];
        glm::dvec3 sum(0.0);
        for (std::size_t k = 0; k < _functions.modes; ++k, share += 3)
            sum += beta[k] / Correctives::kUnit * glm::dvec3(share[0], share[1], share[2]);
        return sum;
    }

    /// Area-weighted unit normals of the corrected vertices; 0 without triangles.
    std::vector<glm::dvec3> normals(const std::vector<glm::dvec3>& points) {
        for (const Vertex& vertex : _vertices) _areas[vertex.welded] = glm::dvec3(0.0);
        for (const std::array<std::uint32_t, 3>& t : _triangles) {
            const glm::dvec3 area =
                glm::cross(points[t[1]] - points[t[0]], points[t[2]] - points[t[0]]);
            for (const std::uint32_t v : t) _areas[v] += area;
        }
        std::vector<glm::dvec3> result;
        for (const Vertex& vertex : _vertices) {
            const glm::dvec3& area = _areas[vertex.welded];
            const double length = glm::length(area);
            result.push_back(length > 0.0 ? area / length : glm::dvec3(0.0));
        }
        return result;
    }

    /// A tilt d turns the directions u and v along the skin into u - (d . u) n and v - (d . v) n.
    /// Together with the terms of the gradients, these must be perpendicular to the target normal.
    glm::dvec3 tilt(std::size_t index, const BendTwist& bend, const glm::dvec3& wanted) const {
        const glm::dvec3& n = _rest[index];
        if (n == glm::dvec3(0.0) || wanted == glm::dvec3(0.0)) return glm::dvec3(0.0);
        const glm::dvec3 gradient(_vertices[index].gradient.bend);
        const glm::dvec3 slide = slideOf(index, bend);
        const glm::dvec3 target = glm::conjugate(_turns[index]) * wanted;
        const double cosine = std::max(glm::dot(n, target), kMinCosine);
        const glm::dvec3 u = anyPerpendicular(n), v = glm::cross(n, u);
        const auto along = [&](const glm::dvec3& direction) {
            return glm::dot(direction + glm::dot(gradient, direction) * slide, target) / cosine;
        };
        return along(u) * u + along(v) * v;
    }

    const WeldedMesh& _mesh;
    const Binding& _binding;
    const CorrectiveJoint& _functions;
    bool _isJoint;            ///< true for a joint's correctives, false for an input's
    const BoundJoint& _joint; ///< the root for an input
    JointRatios _ratios;
    std::vector<Vertex> _vertices;                        ///< the corrected ones
    std::vector<std::array<std::uint32_t, 3>> _triangles; ///< those with a corrected corner
    std::vector<std::uint32_t> _others;                   ///< their other corners
    std::vector<glm::dvec3> _rest;                        ///< normals of `_vertices`
    std::vector<glm::dquat> _turns;                       ///< of `_vertices`
    std::vector<glm::dvec3> _posed;                       ///< relative to the joint's centre
    std::vector<glm::dvec3> _areas;                       ///< of all vertices, see normals()
};

/// Normal equations of weights X = tilts: modes x coordinates of all vertices.
struct NormalFit {
    Eigen::MatrixXd products; ///< of the modes' weights
    Eigen::MatrixXd sums;     ///< of the tilts, by the weights

    /// X by the first `count` modes.
    Eigen::MatrixXd by(Eigen::Index count) const {
        const Eigen::VectorXd scale =
            products.diagonal().head(count).cwiseSqrt().cwiseMax(1e-12).cwiseInverse();
        Eigen::MatrixXd unit =
            scale.asDiagonal() * products.topLeftCorner(count, count) * scale.asDiagonal();
        unit.diagonal().array() += kNormalRidge;
        return scale.asDiagonal() * unit.ldlt().solve(scale.asDiagonal() * sums.topRows(count));
    }
};

/// X with as few of the first modes for each vertex as kMaxNormalError allows; 0 for the others.
/// \param weights samples x modes
Eigen::MatrixXd fitWithFewest(const Eigen::MatrixXd& weights, const NormalFit& fit) {
    if (fit.sums.cols() == 0) return fit.sums;
    const Eigen::MatrixXd all = fit.by(weights.cols());
    Eigen::MatrixXd modes = all;
    std::vector<bool> open(std::size_t(all.cols() / 3), true);
    for (Eigen::Index count = weights.cols(); count-- > 0;) {
        Eigen::MatrixXd fewer = Eigen::MatrixXd::Zero(all.rows(), all.cols());
        if (count > 0) fewer.topRows(count) = fit.by(count);
        for (std::size_t v = 0; v < open.size(); ++v) {
            if (!open[v]) continue;
            const auto own = fewer.middleCols<3>(Eigen::Index(3 * v));
            const Eigen::MatrixX3d off = weights * (own - all.middleCols<3>(Eigen::Index(3 * v)));
            open[v] = off.rowwise().squaredNorm().maxCoeff() <= kMaxNormalError * kMaxNormalError;
            if (open[v]) modes.middleCols<3>(Eigen::Index(3 * v)) = own;
        }
    }
    return modes;
}

/// Whether two correctives have the same joint, or the same input.
bool areAlike(const CorrectiveJoint& a, const CorrectiveJoint& b) {
    return a.joint == b.joint &&
           (a.basis == CorrectiveJoint::Basis::Input) == (b.basis == CorrectiveJoint::Basis::Input);
}

/// Whether no corrective before this one is alike.
bool isFirst(const Correctives& all, std::size_t j) {
    return std::none_of(
        all.joints.begin(), all.joints.begin() + std::ptrdiff_t(j),
        [&](const CorrectiveJoint& other) { return areAlike(other, all.joints[j]); });
}

/// See addNormalCorrectives().
/// \param shares of all joints; this one's are set
/// \return the joint's normalScales
std::vector<double> addNormals(const WeldedMesh& mesh, std::uint32_t j, Binding& binding,
                               std::vector<std::int16_t>& shares) {
    const Correctives& to = binding.correctives;
    const CorrectiveJoint& joint = to.joints[j];
    CorrectedSkin skin(mesh, binding, j);
    const bool again = !isFirst(to, j); // the gradients' error is corrected only once
    const std::vector<glm::dvec2> samples = normalSamples(joint);
    // Splines follow a bend closely enough to make up for shorter gradients.
    if (isHinge(joint) || joint.basis == CorrectiveJoint::Basis::Round)
        skin.limitGradients(samples);
    const auto rows = Eigen::Index(samples.size()), count = Eigen::Index(joint.modes);
    Eigen::MatrixXd weights(rows, count);
    Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(count, Eigen::Index(3 * skin.vertices().size()));
    for (Eigen::Index s = 0; s < rows; ++s) {
        Eigen::VectorXd beta(Eigen::Index(CorrectiveJoint::kMaxModes));
        joint.weights(samples[std::size_t(s)], beta.data());
        weights.row(s) = beta.head(count);
        std::vector<glm::dvec3> wanted = skin.tilts(samples[std::size_t(s)]);
        if (again) {
            const std::vector<glm::dvec3> without = skin.tilts(samples[std::size_t(s)], false);
            for (std::size_t v = 0; v < wanted.size(); ++v) wanted[v] -= without[v];
        }
        for (std::size_t v = 0; v < wanted.size(); ++v)
            for (int axis = 0; axis < 3; ++axis)
                sums.col(Eigen::Index(3 * v) + axis) += wanted[v][axis] * beta.head(count);
    }
    const Eigen::MatrixXd modes =
        fitWithFewest(weights, {weights.transpose() * weights, std::move(sums)});
    std::vector<double> scale;
    for (std::size_t k = 0; k < joint.modes; ++k) {
        const double most =
            modes.cols() > 0 ? modes.row(Eigen::Index(k)).cwiseAbs().maxCoeff() : 0.0;
        scale.push_back(most > 0.0 ? most : 1.0);
        for (std::size_t v = 0; v < skin.vertices().size(); ++v)
            for (std::size_t axis = 0; axis < 3; ++axis)
                shares[skin.vertices()[v].firstShare + 3 * k + axis] = static_cast<std::int16_t>(
                    std::lrint(Correctives::kUnit *
                               modes(Eigen::Index(k), Eigen::Index(3 * v + axis)) / scale[k]));
    }
    // Copies of a vertex have entries of their own.
    std::vector<const CorrectedSkin::Vertex*> made(mesh.vertexCount(), nullptr);
    for (const CorrectedSkin::Vertex& vertex : skin.vertices()) made[vertex.welded] = &vertex;
    for (std::uint32_t v = 0; v < mesh.weldedOf.size(); ++v) {
        const CorrectedSkin::Vertex* from = made[mesh.weldedOf[v]];
        if (!from) continue;
        for (std::uint32_t i = to.firstEntry[v]; i < to.firstEntry[v + 1]; ++i)
            if (to.entries[i].joint == j)
                std::copy_n(shares.begin() + std::ptrdiff_t(from->firstShare), to.sharesOf(j),
                            shares.begin() + std::ptrdiff_t(to.entries[i].firstShare));
        if (joint.basis == CorrectiveJoint::Basis::Input) continue;
        for (std::uint32_t i = binding.firstInfluence[v]; i < binding.firstInfluence[v + 1]; ++i)
            if (binding.influences[i].joint == joint.joint)
                binding.gradients[i].bend = from->gradient.bend;
    }
    return scale;
}

} // namespace

void addNormalCorrectives(const WeldedMesh& mesh, Binding& binding) {
    Correctives& to = binding.correctives;
    std::vector<std::int16_t> shares(to.shares.size(), 0);
    std::vector<std::vector<double>> scales(to.joints.size());
    // Correctives of one joint follow each other, as they change the same gradients.
    parallelFor(to.joints.size(), [&](std::size_t first) {
        if (!isFirst(to, first)) return;
        for (std::size_t j = first; j < to.joints.size(); ++j)
            if (areAlike(to.joints[j], to.joints[first]))
                scales[j] = addNormals(mesh, static_cast<std::uint32_t>(j), binding, shares);
    });
    for (std::size_t j = 0; j < to.joints.size(); ++j) to.joints[j].normalScales = scales[j];
    to.normalShares = std::move(shares);
}

} // namespace osgSkin
