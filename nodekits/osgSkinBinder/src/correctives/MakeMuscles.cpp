// SPDX-License-Identifier: GPL-3.0-or-later
#include "correctives/Muscles.h"
#include "correctives/ShapeFit.h"

#include <Eigen/Cholesky>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace osgSkin {
namespace {

/// Samples of a contraction: of a hinge along its range; of others around and outwards.
constexpr int kContractionsAlong = 48;
constexpr int kContractionsAround = 24;
constexpr int kContractionsOutwards = 12;
constexpr double kContractionRidge = 1e-6;

/// A muscle that no bend contracts by more has no mode that follows the bend.
constexpr double kMinContraction = 0.2;

/// Negligible displacement, as a share of the largest.
constexpr double kMinSwelling = 0.01;

std::vector<glm::dvec2> contractionSamples(const CorrectiveJoint& functions) {
    std::vector<glm::dvec2> samples;
    if (functions.basis == CorrectiveJoint::Basis::Hinge) {
        for (int i = 0; i <= kContractionsAlong; ++i)
            samples.emplace_back(functions.low.x + (functions.high.x - functions.low.x) *
                                                       double(i) / kContractionsAlong,
                                 0.0);
        return samples;
    }
    for (int i = 0; i < kContractionsAround; ++i)
        for (int j = 1; j <= kContractionsOutwards; ++j) {
            const double angle = glm::two_pi<double>() * i / kContractionsAround;
            samples.push_back(functions.high.x * j / kContractionsOutwards *
                              glm::dvec2(std::cos(angle), std::sin(angle)));
        }
    return samples;
}

/// A muscle's contraction as coefficients of its functions; empty if it is negligible.
std::vector<double> contractionCoefficients(const Muscle& muscle) {
    const CorrectiveJoint& functions = muscle.functions;
    const std::vector<glm::dvec2> samples = contractionSamples(functions);
    Eigen::MatrixXd phi(Eigen::Index(samples.size()), Eigen::Index(functions.functionCount()));
    Eigen::VectorXd wanted(phi.rows());
    CorrectiveJoint::Functions values;
    for (Eigen::Index s = 0; s < phi.rows(); ++s) {
        const glm::dvec2 clamped = functions.clamped(samples[std::size_t(s)]);
        functions.evaluate(clamped, values);
        for (Eigen::Index i = 0; i < phi.cols(); ++i) phi(s, i) = values[std::size_t(i)];
        wanted[s] = muscle.contraction(clamped);
    }
    if (wanted.maxCoeff() < kMinContraction) return {};
    Eigen::MatrixXd normal = phi.transpose() * phi;
    normal.diagonal().array() += kContractionRidge;
    const Eigen::VectorXd fit = normal.ldlt().solve(phi.transpose() * wanted);
    return {fit.data(), fit.data() + fit.size()};
}

/// Swelling skin as one mode of these functions, whose coefficients are for a thickness of 1.
FittedShapes asMode(const MuscleSkin& skin, double thickness, CorrectiveJoint functions) {
    FittedShapes shape;
    shape.functions = std::move(functions);
    shape.functions.modes = 1;
    shape.vertices = skin.vertices();
    double longest = 0.0;
    for (std::size_t i = 0; i < shape.vertices.size(); ++i)
        longest = std::max(longest, glm::length(skin.swelling(i)));
    for (std::size_t i = 0; i < shape.vertices.size(); ++i)
        shape.vectors.push_back(skin.swelling(i) / longest);
    for (double& c : shape.functions.coefficients) c *= thickness * longest;
    shape.tolerance = kMinSwelling * thickness * longest;
    return shape;
}

/// The single function of an input, 0 to 1.
CorrectiveJoint functionOf(std::size_t input) {
    CorrectiveJoint functions;
    functions.basis = CorrectiveJoint::Basis::Input;
    functions.joint = static_cast<std::uint32_t>(input);
    functions.high.x = 1.0;
    functions.coefficients = {1.0};
    return functions;
}

} // namespace

Correctives makeMuscles(const RestSkeleton& skeleton, const std::vector<PlannedJoint>& joints,
                        const WeldedMesh& mesh, const Binding& binding, const BindOptions& options,
                        std::vector<std::string>& notes) {
    const JointRatios ratios(mesh, binding);
    std::vector<FittedShapes> shapes;
    std::vector<std::string> inputs;
    for (const Muscle& muscle : findMuscles(skeleton, joints, binding.joints, options, notes)) {
        // A muscle needs up to two.
        if (binding.correctives.joints.size() + shapes.size() + 2 > Correctives::kMaxJoints) {
            notes.push_back("muscle " + muscle.name + " is left out: a skin has at most " +
                            std::to_string(Correctives::kMaxJoints) + " sets of correctives");
            continue;
        }
        const MuscleSkin skin(mesh, joints, ratios, muscle);
        const auto thicknessFor = [&](double growth) {
            if (muscle.isOfLimb()) return skin.thicknessFor(growth);
            return skin.vertices().empty() ? 0.0 : growth;
        };
        const double grown = thicknessFor(muscle.growth), tensed = thicknessFor(muscle.tension);
        if (!(grown > 0.0) && !(tensed > 0.0)) {
            notes.push_back("muscle " + muscle.name + " is left out: no skin lies over it");
            continue;
        }
        CorrectiveJoint moved = muscle.functions;
        moved.coefficients = contractionCoefficients(muscle);
        if (grown > 0.0 && !moved.coefficients.empty())
            shapes.push_back(asMode(skin, grown, std::move(moved)));
        if (tensed > 0.0) {
            shapes.push_back(asMode(skin, tensed, functionOf(inputs.size())));
            inputs.push_back(muscle.name);
        }
    }
    Correctives result = packShapes(shapes, mesh.weldedOf);
    if (!result.empty()) result.inputs = inputs;
    return result;
}

} // namespace osgSkin
