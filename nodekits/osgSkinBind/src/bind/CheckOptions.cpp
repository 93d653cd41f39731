// SPDX-License-Identifier: MIT
#include "bind/CheckOptions.h"

#include <osgSkin/Error>
#include <osgSkin/ExpectedNames>
#include <osgSkin/GlmTypes>
#include <osgSkin/SkinModel>

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>

namespace osgSkin {
namespace {

void checkBoundaries(const std::string& joint, const char* what, const std::optional<double>& upper,
                     const std::optional<double>& lower) {
    const std::string where =
        "bind: " + std::string(what) + " boundaries of joint \"" + joint + "\"";
    if ((upper && !std::isfinite(*upper)) || (lower && !std::isfinite(*lower)))
        throw Error(where + " are not finite, expected numbers in units of the bone's length");
    if (upper && lower && !(*upper < *lower))
        throw Error(where + " are out of order, expected upper < lower (towards the child)");
}

/// The comparisons reject NaN, too.
void checkMuscle(const RestSkeleton& skeleton, const BindOptions::Muscle& muscle) {
    const std::string where = "bind: muscle \"" + muscle.name + "\"";
    if (muscle.name.empty()) throw Error("bind: a muscle has no name");
    if (skeleton.find(muscle.joint) < 0)
        throw Error(where + ": joint \"" + muscle.joint + "\" is not in the skeleton" +
                    expectedNames(muscle.joint, skeleton.byName()));
    if (!(muscle.from >= -0.5 && muscle.from + 0.1 <= muscle.to && muscle.to <= 1.5))
        throw Error(where + " lies from " + std::to_string(muscle.from) + " to " +
                    std::to_string(muscle.to) +
                    ", expected fractions of the bone from -0.5 to 1.5 that are 0.1 apart");
    if (muscle.towards && !(isFinite(*muscle.towards) && glm::length(*muscle.towards) > 0.0))
        throw Error(where + ": invalid direction, expected finite numbers, not all 0");
    for (const double growth : {muscle.growth, muscle.tension})
        if (!(growth >= 0.0 && growth <= 0.5))
            throw Error(where + " grows by " + std::to_string(growth) + ", expected 0 to 0.5");
}

} // namespace

void checkOptions(const RestSkeleton& skeleton, const BindOptions& options) {
    if (!(options.smoothing > 0.0) || !std::isfinite(options.smoothing))
        throw Error("bind: smoothing is " + std::to_string(options.smoothing) +
                    ", expected a finite number above 0");
    if (!(options.cutOff >= 0.0 && options.cutOff < 0.5))
        throw Error("bind: cutOff is " + std::to_string(options.cutOff) +
                    ", expected 0 <= cutOff < 0.5");
    if (options.maxPartialInfluences < 1 ||
        options.maxPartialInfluences > SkinModel::kMaxPartialInfluences)
        throw Error("bind: maxPartialInfluences is " +
                    std::to_string(options.maxPartialInfluences) + ", expected 1 to " +
                    std::to_string(SkinModel::kMaxPartialInfluences));
    std::set<std::string> muscles;
    for (const BindOptions::Muscle& muscle : options.ownMuscles) {
        checkMuscle(skeleton, muscle);
        if (!muscles.insert(muscle.name).second)
            throw Error("bind: two muscles are called \"" + muscle.name + "\"");
    }
    const std::map<std::string, int> jointOf = skeleton.byName();
    for (const auto& [name, joint] : options.joints) {
        if (jointOf.count(name) == 0)
            throw Error("bind: joint \"" + name + "\" is not in the skeleton" +
                        expectedNames(name, jointOf));
        checkBoundaries(name, "bend", joint.bendUpper, joint.bendLower);
        checkBoundaries(name, "twist", joint.twistUpper, joint.twistLower);
    }
}

BindOptions decided(BindOptions options, bool ownRatios) {
    const bool beyondPaper = ownRatios && options.method == BindOptions::Method::Smooth;
    if (!options.shapes)
        options.shapes = beyondPaper ? BindOptions::Shapes::Fast : BindOptions::Shapes::None;
    if (!options.surfaceNormals) options.surfaceNormals = beyondPaper;
    return options;
}

void checkInfluences(const std::vector<PlannedJoint>& joints,
                     const std::vector<std::uint32_t>& regionOf,
                     const std::vector<std::uint32_t>& weldedOf, std::size_t most) {
    if (most == 0) return;
    std::vector<std::size_t> depths(joints.size(), 1);
    for (std::size_t j = 1; j < joints.size(); ++j)
        depths[j] = depths[static_cast<std::size_t>(joints[j].parent)] + 1;
    std::size_t influences = 0, deepest = 0;
    for (const std::uint32_t v : weldedOf) {
        influences += depths[regionOf[v]];
        deepest = std::max(deepest, depths[regionOf[v]]);
    }
    if (influences > most)
        throw Error("bind: " + std::to_string(weldedOf.size()) +
                    " vertices that follow chains of up to " + std::to_string(deepest) +
                    " joints have " + std::to_string(influences) +
                    " influences together, expected at most " + std::to_string(most) +
                    " (option maxInfluences)");
}

} // namespace osgSkin
