// SPDX-License-Identifier: GPL-3.0-or-later
#include "correctives/ShapeFit.h"

#include "correctives/ShapedJoint.h"
#include "mesh/CoarseGraph.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace osgSkin {
namespace {

constexpr double kFitRidge = 1e-3;

/// The number of vertices whose equations are made together.
constexpr Eigen::Index kTogether = 64;

/// Squares of singular values below this share of the largest are rounding errors.
constexpr double kRounding = 1e-13;

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

Eigen::MatrixXd damped(Eigen::MatrixXd normal) {
    normal.diagonal().array() += kFitRidge;
    return normal;
}

/// The functions' coefficients by damped least squares, a column for each vertex and axis.
Eigen::MatrixXd solve(const JointShapes& shapes, const Eigen::MatrixXd& phi,
                      const Eigen::MatrixXd& offsets) {
    if (shapes.weights.empty())
        return damped(phi.transpose() * phi).ldlt().solve(phi.transpose() * offsets);
    const Eigen::Index count = phi.cols();
    Eigen::MatrixXd products(phi.rows(), count * (count + 1) / 2); // of two functions each
    for (Eigen::Index i = 0, column = 0; i < count; column += count - i++)
        products.middleCols(column, count - i) = phi.col(i).asDiagonal() * phi.rightCols(count - i);
    Eigen::MatrixXd weights(phi.rows(), offsets.cols() / 3), weighted = offsets;
    for (Eigen::Index s = 0; s < phi.rows(); ++s)
        weights.row(s) = Eigen::Map<const Eigen::RowVectorXd>(shapes.weights[std::size_t(s)].data(),
                                                              weights.cols());
    for (Eigen::Index column = 0; column < offsets.cols(); ++column)
        weighted.col(column).array() *= weights.col(column / 3).array();
    Eigen::MatrixXd fit = phi.transpose() * weighted;
    Eigen::LLT<Eigen::MatrixXd> solver(count); // reads the lower triangle
    Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(count, count), normals;
    for (Eigen::Index v = 0; v < weights.cols(); ++v) {
        if (v % kTogether == 0)
            normals = products.transpose() *
                      weights.middleCols(v, std::min(kTogether, weights.cols() - v));
        for (Eigen::Index i = 0, row = 0; i < count; row += count - i++)
            normal.col(i).tail(count - i) = normals.col(v % kTogether).segment(row, count - i);
        solver.compute(damped(normal));
        solver.solveInPlace(fit.middleCols<3>(3 * v));
    }
    return fit;
}

/// Over samples and vertices.
/// \param squares sum of the coordinates' squares
/// \param count of coordinates
double rootMeanSquare(double squares, Eigen::Index count) {
    return count > 0 ? std::sqrt(std::max(0.0, squares) / (double(count) / 3.0)) : 0.0;
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

    // The fitted shapes phi fit are a matrix of low rank; its right singular vectors are the modes.
    // They are combinations of the rows of `fit`, which are few: with gram = root root', root'
    // phi' phi root has the same singular values.
    const Eigen::MatrixXd gram = fit * fit.transpose();
    const Eigen::VectorXd squares = // of each sample's shape
        (phi * gram).cwiseProduct(phi).rowwise().sum().cwiseMax(0.0);
    // Slight bends have small shapes but are seen most often, so they get more weight.
    const double floor =
        kFloor * std::sqrt(squares.sum() / double(std::max<Eigen::Index>(1, phi.rows())));
    const Eigen::MatrixXd scaled =
        floor > 0.0 ? Eigen::MatrixXd(
                          (squares.cwiseSqrt().array() + floor).rsqrt().matrix().asDiagonal() * phi)
                    : phi;
    const Eigen::MatrixXd overSamples = scaled.transpose() * scaled;
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> rows(gram);
    const Eigen::MatrixXd root =
        rows.eigenvectors() * rows.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> right(root.transpose() * overSamples *
                                                               root);
    double residual = offsets.squaredNorm();
    std::vector<Eigen::VectorXd> vectors;
    const std::size_t modes =
        std::min({limits.most, CorrectiveJoint::kMaxModes, static_cast<std::size_t>(phi.rows()),
                  static_cast<std::size_t>(phi.cols())});
    for (std::size_t k = 0; k < modes; ++k) {
        const Eigen::Index column = phi.cols() - 1 - Eigen::Index(k); // largest last
        const double square = right.eigenvalues()[column];
        if (!(square > kRounding * right.eigenvalues().maxCoeff())) break;
        const Eigen::VectorXd mode =
            fit.transpose() * (overSamples * root * right.eigenvectors().col(column) / square);
        const Eigen::VectorXd functions = fit * mode;
        const Eigen::VectorXd share = phi * functions; // of each sample
        const double longest = longestIn(mode);
        if (share.cwiseAbs().maxCoeff() * longest <= limits.tolerance) break;
        residual += share.squaredNorm() - 2.0 * share.dot(offsets * mode);
        const Eigen::VectorXd coefficients = functions * longest;
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
    result.residual = rootMeanSquare(residual, offsets.size());
    return result;
}

FittedShapes finerShapes(FittedShapes shapes, const CoarseGraph& coarser,
                         const ShapedJoint& joint) {
    const std::size_t modes = shapes.functions.modes;
    std::vector<glm::dvec3> vectors(modes * joint.vertices.size());
    std::vector<double> field(shapes.vertices.size());
    for (std::size_t k = 0; k < modes; ++k)
        for (int axis = 0; axis < 3; ++axis) {
            for (std::size_t v = 0; v < field.size(); ++v)
                field[v] = shapes.vectors[v * modes + k][axis];
            const std::vector<double> fine = coarser.interpolated(field);
            for (std::size_t v = 0; v < fine.size(); ++v)
                if (joint.vertices[v].fade > 0.0) vectors[v * modes + k][axis] = fine[v];
        }
    shapes.vectors = std::move(vectors);
    shapes.vertices.clear();
    for (const ShapedJoint::Vertex& vertex : joint.vertices)
        shapes.vertices.push_back(vertex.index);
    return shapes;
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
