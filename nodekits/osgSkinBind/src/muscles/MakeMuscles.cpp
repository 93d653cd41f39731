// SPDX-License-Identifier: GPL-3.0-or-later
#include "muscles/MakeMuscles.h"

#include "muscles/Calibrate.h"
#include "muscles/Contraction.h"
#include "muscles/FindMuscles.h"
#include "muscles/MuscleSkin.h"
#include "shapes/ShapeFit.h"

#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace osgSkin {
namespace {

using Heights = MuscleSkin::Heights;

/// How far a flexor's hinge is bent from straight where its growth is given, in degrees.
constexpr double kFlexion = 120.0;

/// The same where its tension is.
constexpr double kTensedAt = 80.0;

/// Length over that at rest of the contractile part of a muscle that is tensed but does not get
/// shorter as a whole: its tendons give.
constexpr double kTensed = 0.75;

/// Lifts that make no difference, in radii of the limb.
constexpr double kLeastLift = 2e-3;

struct MadeMuscle {
    Muscle muscle;
    Heights lifted; ///< fully shortened
};

/// A spindle as one mode of these functions; its length goes into their coefficients.
FittedShapes asMode(const MuscleSkin& skin, const Heights& lifted, const Muscle& muscle,
                    const CorrectiveJoint& functions, std::vector<double> coefficients) {
    FittedShapes shape;
    shape.functions = functions;
    shape.functions.modes = 1;
    shape.functions.coefficients = std::move(coefficients);
    shape.vertices = skin.vertices();
    shape.tolerance = kLeastLift * muscle.radius;
    double highest = 0.0;
    for (const double h : lifted) highest = std::max(highest, std::abs(h));
    for (std::size_t i = 0; i < lifted.size(); ++i)
        shape.vectors.push_back(lifted[i] / highest * skin.normal(i));
    for (double& c : shape.functions.coefficients) c *= highest;
    return shape;
}

/// The only function of an input, 0 to 1.
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
            // Its antagonist, which was made before, is stretched meanwhile.
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
        // Tensed halfway through its bend: it is shortened already.
        Heights meanwhile = none;
        if (!lifted.empty() && muscle.isFlexor())
            for (std::size_t i = 0; i < meanwhile.size(); ++i)
                meanwhile[i] =
                    lifted[i] * contractionAt(muscle, glm::radians(kTensedAt) - muscle.flexed);
        const Heights tensed = calibrate(skin, skin.spindle(kTensed), meanwhile, 1.0,
                                         (1.0 + muscle.tension) * skin.girth(meanwhile));
        if (lifted.empty() && tensed.empty()) {
            notes.push_back("muscle " + muscle.name + " is left out: its limb has no skin to lift");
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
