// SPDX-License-Identifier: GPL-3.0-or-later
#include "correctives/ShapeFit.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace osgSkin {
namespace {

constexpr double kFitRidge = 1e-3;

/// Shapes smaller than this share of the mean shape's size get no more weight.
constexpr double kFloor = 0.05;

/// phi_i at each sample: samples x functions.
Eigen::MatrixXd functionsAt(const JointShapes& shapes) {
    const std::size_t functions = shapes.functions.functionCount();
    Eigen::MatrixXd phi(Eigen::Index(shapes.samples.size()), Eigen::Index(functions));
    CorrectiveJoint::Functions values;
    for (std::size_t s = 0; s < shapes.samples.size(); ++s) {
        shapes.functions.evaluate(shapes.functions.clamped(shapes.samples[s]), values);
        for (std::size_t i = 0; i < functions; ++i)
            phi(Eigen::Index(s), Eigen::Index(i)) = values[i];
    }
    return phi;
}

/// One row a sample: the coordinates of all vertices.
Eigen::MatrixXd offsetsOf(const JointShapes& shapes) {
    Eigen::MatrixXd offsets(Eigen::Index(shapes.samples.size()),
                            Eigen::Index(3 * shapes.vertices.size()));
    for (std::size_t s = 0; s < shapes.samples.size(); ++s)
        for (std::size_t v = 0; v < shapes.vertices.size(); ++v)
            for (int axis = 0; axis < 3; ++axis)
                offsets(Eigen::Index(s), Eigen::Index(3 * v) + axis) = shapes.offsets[s][v][axis];
    return offsets;
}

/// The functions' coefficients by damped least squares, a column for each vertex and axis.
Eigen::MatrixXd solve(const JointShapes& shapes, const Eigen::MatrixXd& phi,
                      const Eigen::MatrixXd& offsets) {
    const auto damped = [](Eigen::MatrixXd normal) {
        normal.diagonal().array() += kFitRidge;
        return normal.ldlt();
    };
    if (shapes.weights.empty())
        return damped(phi.transpose() * phi).solve(phi.transpose() * offsets);
    Eigen::MatrixXd fit(phi.cols(), offsets.cols());
    Eigen::VectorXd weights(phi.rows());
    for (std::size_t v = 0; v < shapes.vertices.size(); ++v) {
        for (std::size_t s = 0; s < shapes.samples.size(); ++s)
            weights[Eigen::Index(s)] = shapes.weights[s][v];
        const Eigen::MatrixXd weighted = weights.asDiagonal() * phi;
        const auto column = Eigen::Index(3 * v);
        fit.middleCols<3>(column) =
            damped(phi.transpose() * weighted)
                .solve(weighted.transpose() * offsets.middleCols<3>(column));
    }
    return fit;
}

/// Over samples and vertices.
double rootMeanSquare(const Eigen::MatrixXd& offsets) {
    return offsets.size() > 0 ? offsets.norm() / std::sqrt(double(offsets.size()) / 3.0) : 0.0;
}

double longestIn(const Eigen::VectorXd& mode) {
    double longest = 0.0;
    for (Eigen::Index v = 0; v + 2 < mode.size(); v += 3)
        longest = std::max(longest, mode.segment<3>(v).norm());
    return longest;
}

/// The largest absolute weight of each mode at any bend.
std::vector<double> largestWeights(const CorrectiveJoint& joint) {
    constexpr int kGrid = 24;
    std::vector<double> largest(joint.modes, 0.0);
    CorrectiveJoint::Functions phi;
    for (int i = 0; i <= kGrid; ++i)
        for (int j = 0; j <= kGrid; ++j) {
            const glm::dvec2 xy = joint.low + (joint.high - joint.low) *
                                                  glm::dvec2(double(i), double(j)) / double(kGrid);
            joint.evaluate(joint.clamped(xy), phi);
            for (std::size_t k = 0; k < joint.modes; ++k) {
                double weight = 0.0;
                for (std::size_t f = 0; f < joint.functionCount(); ++f)
                    weight += joint.coefficients[k * joint.functionCount() + f] * phi[f];
                largest[k] = std::max(largest[k], std::abs(weight));
            }
        }
    return largest;
}

/// The number of modes that a vertex needs: the others move it negligibly.
std::size_t modesNeeded(const glm::dvec3* vectors, const std::vector<double>& largest,
                        double tolerance) {
    double rest = 0.0;
    for (std::size_t modes = largest.size(); modes > 0; --modes) {
        rest += largest[modes - 1] * glm::length(vectors[modes - 1]);
        if (rest > tolerance) return modes;
    }
    return 0;
}

struct VertexEntry {
    std::uint32_t joint; ///< of the correctives'
    std::size_t first;   ///< in the joint's vectors
    std::size_t modes;   ///< that the vertex needs
};

/// Appends a vertex' entries of `from`, whose joints follow `firstJoint` others.
void append(const Correctives& from, std::size_t vertex, std::size_t firstJoint, Correctives& to) {
    for (std::uint32_t i = from.firstEntry[vertex]; i < from.firstEntry[vertex + 1]; ++i) {
        const Correctives::Entry& entry = from.entries[i];
        to.entries.push_back({static_cast<std::uint32_t>(firstJoint + entry.joint),
                              static_cast<std::uint32_t>(to.shares.size())});
        const auto first = from.shares.begin() + entry.firstShare;
        to.shares.insert(to.shares.end(), first,
                         first + static_cast<std::ptrdiff_t>(from.sharesOf(entry.joint)));
    }
}

} // namespace

FittedShapes fitShapes(const JointShapes& shapes, const ModeLimits& limits) {
    FittedShapes result;
    result.functions = shapes.functions;
    result.vertices = shapes.vertices;
    result.tolerance = limits.tolerance;
    const Eigen::MatrixXd phi = functionsAt(shapes);
    const Eigen::MatrixXd offsets = offsetsOf(shapes);
    const Eigen::MatrixXd fit = solve(shapes, phi, offsets);

    // The fitted shapes are a matrix of low rank; its right singular vectors are the modes.
    const Eigen::MatrixXd fitted = phi * fit;
    // Slight bends have small shapes but are seen most often, so they get more weight.
    Eigen::MatrixXd scaled = fitted;
    const double floor =
        kFloor * fitted.norm() / std::sqrt(double(std::max<Eigen::Index>(1, fitted.rows())));
    if (floor > 0.0)
        for (Eigen::Index s = 0; s < scaled.rows(); ++s)
            scaled.row(s) /= std::sqrt(fitted.row(s).norm() + floor);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> left(scaled * scaled.transpose());
    Eigen::MatrixXd kept = Eigen::MatrixXd::Zero(fitted.rows(), fitted.cols());
    std::vector<Eigen::VectorXd> vectors;
    const std::size_t modes = std::min(
        {limits.most, CorrectiveJoint::kMaxModes, static_cast<std::size_t>(fitted.rows())});
    const double enough =
        std::max(limits.enough, limits.enoughOfResidual * rootMeanSquare(offsets - fitted));
    for (std::size_t k = 0; k < modes; ++k) {
        const Eigen::Index column = fitted.rows() - 1 - Eigen::Index(k); // largest last
        const double singular = std::sqrt(std::max(0.0, left.eigenvalues()[column]));
        if (!(singular > 0.0) || rootMeanSquare(fitted - kept) < enough) break;
        const Eigen::VectorXd mode =
            scaled.transpose() * left.eigenvectors().col(column) / singular;
        const Eigen::VectorXd share = fitted * mode; // of each sample
        const double longest = longestIn(mode);
        if (share.cwiseAbs().maxCoeff() * longest <= limits.tolerance) break;
        kept += share * mode.transpose();
        const Eigen::VectorXd coefficients = fit * mode * longest;
        result.functions.coefficients.insert(result.functions.coefficients.end(),
                                             coefficients.data(),
                                             coefficients.data() + coefficients.size());
        vectors.emplace_back(mode / longest);
    }
    result.functions.modes = vectors.size();
    result.vectors.resize(vectors.size() * shapes.vertices.size());
    for (std::size_t v = 0; v < shapes.vertices.size(); ++v)
        for (std::size_t k = 0; k < vectors.size(); ++k)
            for (int axis = 0; axis < 3; ++axis)
                result.vectors[v * vectors.size() + k][axis] =
                    vectors[k][Eigen::Index(3 * v) + axis];
    result.residual = rootMeanSquare(offsets - kept);
    return result;
}

Correctives packShapes(const std::vector<FittedShapes>& joints,
                       const std::vector<std::uint32_t>& weldedOf) {
    Correctives result;
    std::size_t welded = 0;
    for (const std::uint32_t w : weldedOf) welded = std::max<std::size_t>(welded, w + 1);
    std::vector<std::vector<VertexEntry>> entries(welded);
    std::vector<const FittedShapes*> kept;
    for (const FittedShapes& joint : joints) {
        const std::size_t modes = joint.functions.modes;
        if (modes == 0 || kept.size() == Correctives::kMaxJoints) continue;
        const std::vector<double> largest = largestWeights(joint.functions);
        for (std::size_t v = 0; v < joint.vertices.size(); ++v) {
            const std::size_t needed =
                modesNeeded(&joint.vectors[v * modes], largest, joint.tolerance);
            if (needed > 0)
                entries[joint.vertices[v]].push_back(
                    {static_cast<std::uint32_t>(kept.size()), v * modes, needed});
        }
        kept.push_back(&joint);
        result.joints.push_back(joint.functions);
    }
    if (kept.empty()) return {};
    result.firstEntry.push_back(0);
    for (const std::uint32_t w : weldedOf) {
        for (const VertexEntry& entry : entries[w]) {
            result.entries.push_back(
                {entry.joint, static_cast<std::uint32_t>(result.shares.size())});
            const glm::dvec3* vector = &kept[entry.joint]->vectors[entry.first];
            for (std::size_t k = 0; k < entry.modes; ++k)
                for (int axis = 0; axis < 3; ++axis)
                    result.shares.push_back(static_cast<std::int16_t>(
                        std::lrint(Correctives::kUnit * vector[k][axis])));
            result.shares.resize(result.entries.back().firstShare + result.sharesOf(entry.joint),
                                 0);
        }
        result.firstEntry.push_back(static_cast<std::uint32_t>(result.entries.size()));
    }
    return result.entries.empty() ? Correctives{} : result;
}

Correctives mergeCorrectives(const Correctives& a, const Correctives& b) {
    if (a.empty()) return b;
    if (b.empty()) return a;
    Correctives result;
    result.joints = a.joints;
    result.inputs = a.inputs;
    for (CorrectiveJoint joint : b.joints) {
        if (joint.basis == CorrectiveJoint::Basis::Input)
            joint.joint += static_cast<std::uint32_t>(a.inputs.size());
        result.joints.push_back(joint);
    }
    result.inputs.insert(result.inputs.end(), b.inputs.begin(), b.inputs.end());
    result.firstEntry.push_back(0);
    for (std::size_t v = 0; v + 1 < a.firstEntry.size(); ++v) {
        append(a, v, 0, result);
        append(b, v, a.joints.size(), result);
        result.firstEntry.push_back(static_cast<std::uint32_t>(result.entries.size()));
    }
    return result;
}

} // namespace osgSkin
