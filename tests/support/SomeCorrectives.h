// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkin/Binding>
#include <osgSkin/Pose>

#include <glm/geometric.hpp>

#include <algorithm>
#include <random>

namespace test {

/// Functions of every basis for one joint, with displacements of about `size`.
inline osgSkin::CorrectiveJoint someFunctions(const osgSkin::Binding& binding, std::uint32_t joint,
                                              osgSkin::CorrectiveJoint::Basis basis, double size,
                                              std::mt19937_64& random, std::size_t roundModes = 1) {
    using Basis = osgSkin::CorrectiveJoint::Basis;
    std::uniform_real_distribution<double> number(-size, size);
    osgSkin::CorrectiveJoint result;
    result.joint = joint;
    result.basis = basis;
    const glm::dvec3& w = binding.joints[joint].twistAxis;
    const glm::dvec3 other = std::abs(w.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    result.axis = glm::normalize(glm::cross(other, w));
    result.low = {-0.5, -0.8};
    result.high = {0.9, 0.7};
    const bool isHinge = basis == Basis::Hinge || basis == Basis::TurnedHinge;
    if (isHinge) result.knots = {-0.5, -0.1, 0.3, 0.6, 0.9};
    if (basis == Basis::Round) result.knots = {0.0, 0.2, 0.5, 0.9};
    result.modes = isHinge ? 3 : basis == Basis::Ball ? 5 : roundModes;
    for (std::size_t i = 0; i < result.modes * result.functionCount(); ++i)
        result.coefficients.push_back(number(random));
    return result;
}

/// Correctives of the joints from 1 on, for about two thirds of the vertices that follow them in
/// part, and of one input, for about one third.
inline osgSkin::Correctives someCorrectives(const osgSkin::Binding& binding, double size,
                                            std::uint64_t seed, bool withNormals = false,
                                            std::size_t roundModes = 1) {
    using Basis = osgSkin::CorrectiveJoint::Basis;
    std::mt19937_64 random(seed);
    std::uniform_int_distribution<int> share(-osgSkin::Correctives::kUnit,
                                             osgSkin::Correctives::kUnit);
    osgSkin::Correctives result;
    for (std::uint32_t joint = 1; joint < binding.joints.size() && joint < 7; ++joint) {
        constexpr Basis kBases[] = {Basis::Hinge, Basis::Ball, Basis::Round, Basis::TurnedHinge};
        result.joints.push_back(
            someFunctions(binding, joint, kBases[joint % 4], size, random, roundModes));
        if (withNormals) result.joints.back().normalScales.assign(result.joints.back().modes, 2.0);
    }
    const auto input = static_cast<std::uint32_t>(result.joints.size());
    result.inputs = {"breath"};
    osgSkin::CorrectiveJoint breath;
    breath.basis = Basis::Input;
    breath.low.x = -0.25;
    breath.high.x = 1.0;
    breath.modes = 2;
    breath.coefficients = {size, -0.5 * size};
    if (withNormals) breath.normalScales = {2.0, 1.0};
    result.joints.push_back(breath);
    const auto addEntry = [&](std::uint32_t joint) {
        result.entries.push_back({joint, static_cast<std::uint32_t>(result.shares.size())});
        for (std::size_t k = 0; k < result.sharesOf(joint); ++k) {
            result.shares.push_back(static_cast<std::int16_t>(share(random)));
            if (withNormals)
                result.normalShares.push_back(static_cast<std::int16_t>(share(random)));
        }
    };
    result.firstEntry.push_back(0);
    for (std::size_t v = 0; v < binding.vertexCount(); ++v) {
        for (std::uint32_t i = binding.firstInfluence[v]; i < binding.firstInfluence[v + 1]; ++i) {
            const std::uint32_t joint = binding.influences[i].joint;
            if (joint < 1 || joint > input || random() % 3 == 0) continue;
            addEntry(joint - 1);
        }
        if (random() % 3 == 0) addEntry(input);
        result.firstEntry.push_back(static_cast<std::uint32_t>(result.entries.size()));
    }
    return result;
}

/// Their displacement of a vertex in a pose, or of its normal, by the formula in
/// osgSkin/Correctives.
inline glm::dvec3 correctionOf(const osgSkin::Binding& binding, const osgSkin::Pose& pose,
                               std::uint32_t vertex, bool ofNormal = false) {
    const osgSkin::Correctives& from = binding.correctives;
    glm::dvec3 sum(0.0);
    for (std::uint32_t i = from.firstEntry[vertex]; i < from.firstEntry[vertex + 1]; ++i) {
        const osgSkin::CorrectiveJoint& joint = from.joints[from.entries[i].joint];
        double beta[osgSkin::CorrectiveJoint::kMaxModes];
        if (joint.basis == osgSkin::CorrectiveJoint::Basis::Input) {
            const double x = double(pose.input(joint.joint));
            for (std::size_t k = 0; k < joint.modes; ++k)
                beta[k] = joint.coefficients[k] * std::min(joint.high.x, std::max(joint.low.x, x));
        } else {
            const osgSkin::BendTwist bend = pose.transform(joint.joint).split;
            joint.weights(joint.coordinates(bend.bendAxis, bend.bendAngle,
                                            binding.joints[joint.joint].twistAxis),
                          beta);
        }
        const std::vector<std::int16_t>& shares = ofNormal ? from.normalShares : from.shares;
        const std::int16_t* u = &shares[from.entries[i].firstShare];
        for (std::size_t k = 0; k < joint.modes; ++k, u += 3)
            sum += beta[k] * (ofNormal ? joint.normalScales[k] : 1.0) / 32767.0 *
                   glm::dvec3(u[0], u[1], u[2]);
    }
    return sum;
}

inline glm::dvec3 normalCorrectionOf(const osgSkin::Binding& binding, const osgSkin::Pose& pose,
                                     std::uint32_t vertex) {
    return correctionOf(binding, pose, vertex, true);
}

} // namespace test
