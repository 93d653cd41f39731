// SPDX-License-Identifier: GPL-3.0-or-later
#include "muscles/Muscles.h"
#include "shapes/ShapeFit.h"

#include <Eigen/Cholesky>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace osgSkin {
namespace {

using Heights = MuscleSkin::Heights;

/// The length of a fully shortened muscle, relative to its length at rest.
constexpr double kShortest = 0.6;

/// The moment arm of a muscle about the joint's centre, in limb radii, and the length of its
/// contractile part, in lengths of its bone.
constexpr double kMomentArm = 0.9;
constexpr double kFascicle = 0.5;

/// The largest stretch of a muscle.
constexpr double kMaxStretch = 0.15;

constexpr int kSamples = 48;
constexpr double kRidge = 1e-6;

/// Rounds of calibrate().
constexpr int kRounds = 8;

/// The lowered part of a spindle is scaled by at most this factor relative to the lifted part.
constexpr double kMaxLowered = 2.5;

/// The bend of a flexor's hinge, from straight, at which its growth is given, in degrees.
constexpr double kFlexion = 120.0;

/// The bend at which a muscle's tension is given.
constexpr double kTensedAt = 80.0;

/// The relative length of the contractile part of a muscle that is tensed at constant total length:
/// its tendons stretch.
constexpr double kTensed = 0.75;

/// Negligible displacement, in limb radii.
constexpr double kMinLift = 2e-3;

/// Saturates t smoothly at 1, from 3/4 on.
double softly(double t) {
    return t <= 0.75 ? t : 0.75 + 0.25 * std::tanh((t - 0.75) / 0.25);
}

/// The contraction of a muscle at a bend of its hinge: a = (1 / lambda - 1) / (1 / 0.6 - 1), with
/// its relative length lambda. 0 at rest, 1 if fully shortened, below 0 if stretched.
/// \param psi the hinge's bend from its rest pose, radians; above 0 flexes
double contractionAt(const Muscle& muscle, double psi) {
    const double length = kFascicle * glm::length(muscle.end - muscle.begin);
    const double pulled = muscle.shortens * kMomentArm * muscle.radius * psi / length;
    const double most = pulled > 0.0 ? 1.0 - kShortest : kMaxStretch;
    const double lambda = 1.0 - std::copysign(most * softly(std::abs(pulled) / most), pulled);
    return (1.0 / lambda - 1.0) / (1.0 / kShortest - 1.0);
}

/// contractionAt() as coefficients of the hinge's functions.
std::vector<double> contractionCoefficients(const Muscle& muscle) {
    const CorrectiveJoint& functions = muscle.functions;
    const auto count = Eigen::Index(functions.functionCount());
    Eigen::MatrixXd phi(kSamples + 1, count);
    Eigen::VectorXd wanted(kSamples + 1);
    CorrectiveJoint::Functions values;
    for (int s = 0; s <= kSamples; ++s) {
        const double x =
            functions.low.x + (functions.high.x - functions.low.x) * double(s) / kSamples;
        const glm::dvec2 clamped = functions.clamped({x, 0.0});
        functions.evaluate(clamped, values);
        for (Eigen::Index i = 0; i < count; ++i) phi(s, i) = values[std::size_t(i)];
        wanted[s] =
            contractionAt(muscle, 2.0 * std::asin(std::min(1.0, std::max(-1.0, clamped.x))));
    }
    Eigen::MatrixXd normal = phi.transpose() * phi;
    normal.diagonal().array() += kRidge;
    const Eigen::VectorXd fit = normal.ldlt().solve(phi.transpose() * wanted);
    return {fit.data(), fit.data() + fit.size()};
}

/// A spindle with its lifted part times `up` and its lowered part times `down`.
Heights scaled(const Heights& spindle, double up, double down) {
    Heights result;
    for (const double h : spindle) result.push_back(h > 0.0 ? up * h : down * h);
    return result;
}

Heights sum(Heights a, const Heights& b, double amount) {
    for (std::size_t i = 0; i < a.size(); ++i) a[i] += amount * b[i];
    return a;
}

/// Scales a spindle's lifted part to reach the limb's girth, and its lowered part to keep the
/// limb's volume.
/// \param already other displacement of the skin at the same time
/// \param amount the share of the spindle that is present at that girth, above 0
/// \param girth the limb's girth to reach
/// \return the whole spindle in rest units; empty if the limb has no girth or cannot grow
Heights calibrate(const MuscleSkin& skin, const Heights& spindle, const Heights& already,
                  double amount, double girth) {
    const double before = skin.girth(already), volume = skin.volume(already);
    const double highest =
        spindle.empty() ? 0.0 : *std::max_element(spindle.begin(), spindle.end());
    if (!(before > 0.0) || !(girth > before) || !(highest > 0.0)) return {};
    double up = (girth - before) / highest / amount, down = up;
    for (int round = 0; round < kRounds; ++round) {
        const double grown = skin.girth(sum(already, scaled(spindle, up, down), amount)) - before;
        if (!(grown > 0.0)) return {};
        up *= (girth - before) / grown;
        // The volume is nearly linear in the lowered part.
        const double without = skin.volume(sum(already, scaled(spindle, up, 0.0), amount)) - volume;
        const double lost =
            without + volume - skin.volume(sum(already, scaled(spindle, up, up), amount));
        down = lost > 0.0 ? up * std::min(kMaxLowered, std::max(0.0, without / lost)) : up;
    }
    return scaled(spindle, up, down);
}

struct MadeMuscle {
    Muscle muscle;
    Heights lifted; ///< fully shortened
};

/// A spindle as one mode of these functions; its height goes into their coefficients.
FittedShapes asMode(const MuscleSkin& skin, const Heights& lifted, const Muscle& muscle,
                    const CorrectiveJoint& functions, std::vector<double> coefficients) {
    FittedShapes shape;
    shape.functions = functions;
    shape.functions.modes = 1;
    shape.functions.coefficients = std::move(coefficients);
    shape.vertices = skin.vertices();
    shape.tolerance = kMinLift * muscle.radius;
    double highest = 0.0;
    for (const double h : lifted) highest = std::max(highest, std::abs(h));
    for (std::size_t i = 0; i < lifted.size(); ++i)
        shape.vectors.push_back(lifted[i] / highest * skin.normal(i));
    for (double& c : shape.functions.coefficients) c *= highest;
    return shape;
}

/// The single function of an input, 0 to 1.
CorrectiveJoint functionOf(std::size_t input) {
    CorrectiveJoint functions;
    functions.basis = CorrectiveJoint::Basis::Input;
    functions.joint = static_cast<std::uint32_t>(input);
    functions.high.x = 1.0;
    return functions;
}

} // namespace

Correctives makeMuscles(const RestSkeleton& skeleton, const std::vector<PlannedJoint>& joints,
                        const WeldedMesh& mesh, const Binding& binding, const BindOptions& options,
                        std::vector<std::string>& notes) {
    const JointRatios ratios(mesh, binding);
    std::vector<MadeMuscle> made;
    std::vector<FittedShapes> shapes;
    std::vector<std::string> inputs;
    for (Muscle& muscle : findMuscles(skeleton, joints, binding.joints, options, notes)) {
        const MuscleSkin skin(mesh, ratios, muscle);
        const Heights none(skin.vertices().size(), 0.0);
        Heights already = none;
        double amount = 1.0;
        if (muscle.isFlexor() && muscle.radius > 0.0) {
            const double psi = glm::radians(kFlexion) - muscle.flexed;
            amount = contractionAt(muscle, psi);
            // Its antagonist, which was made before, is stretched at the same time.
            for (const MadeMuscle& other : made)
                if (other.muscle.functions.joint == muscle.functions.joint &&
                    other.muscle.above == muscle.above)
                    for (std::size_t i = 0; i < already.size(); ++i)
                        already[i] += contractionAt(other.muscle, psi) * other.lifted[i];
        }
        const double girth = skin.girth(none);
        const Heights lifted = amount > 0.05 ? calibrate(skin, skin.spindle(kShortest), already,
                                                         amount, (1.0 + muscle.growth) * girth)
                                             : Heights{};
        // A flexor is tensed halfway through the bend, where it is already shortened.
        Heights meanwhile = none;
        if (!lifted.empty() && muscle.isFlexor())
            for (std::size_t i = 0; i < meanwhile.size(); ++i)
                meanwhile[i] =
                    lifted[i] * contractionAt(muscle, glm::radians(kTensedAt) - muscle.flexed);
        const Heights tensed = calibrate(skin, skin.spindle(kTensed), meanwhile, 1.0,
                                         (1.0 + muscle.tension) * skin.girth(meanwhile));
        if (lifted.empty() && tensed.empty()) {
            notes.push_back("muscle " + muscle.name + " is left out: its limb has no skin");
            continue;
        }
        if (!lifted.empty())
            shapes.push_back(
                asMode(skin, lifted, muscle, muscle.functions, contractionCoefficients(muscle)));
        if (!tensed.empty()) {
            shapes.push_back(asMode(skin, tensed, muscle, functionOf(inputs.size()), {1.0}));
            inputs.push_back(muscle.name);
        }
        if (!lifted.empty()) made.push_back({muscle, lifted});
    }
    Correctives result = packShapes(shapes, mesh.weldedOf);
    if (!result.empty()) result.inputs = inputs;
    return result;
}

} // namespace osgSkin
