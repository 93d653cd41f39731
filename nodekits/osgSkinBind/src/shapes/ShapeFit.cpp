// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapes/ShapeFit.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

namespace osgSkin {
namespace {

constexpr double kRidge = 1e-3;

/// Shapes that are smaller than this share of the mean one's size count no more than it.
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

/// Samples x coordinates of all vertices.
Eigen::MatrixXd offsetsOf(const JointShapes& shapes) {
    Eigen::MatrixXd offsets(Eigen::Index(shapes.samples.size()),
                            Eigen::Index(3 * shapes.vertices.size()));
    for (std::size_t s = 0; s < shapes.samples.size(); ++s)
        for (std::size_t v = 0; v < shapes.vertices.size(); ++v)
            for (int axis = 0; axis < 3; ++axis)
                offsets(Eigen::Index(s), Eigen::Index(3 * v) + axis) = shapes.offsets[s][v][axis];
    return offsets;
}

/// The functions' coefficients, a column for each vertex and axis: least squares with a little
/// damping.
Eigen::MatrixXd solve(const JointShapes& shapes, const Eigen::MatrixXd& phi,
                      const Eigen::MatrixXd& offsets) {
    const auto damped = [](Eigen::MatrixXd normal) {
        normal.diagonal().array() += kRidge;
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
    // Slight bends have small shapes but are seen most often: they count more than their size.
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
        {limits.most, CorrectiveJoint::kMostModes, static_cast<std::size_t>(fitted.rows())});
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

} // namespace osgSkin
