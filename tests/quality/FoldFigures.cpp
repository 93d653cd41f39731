// SPDX-License-Identifier: MIT
#include "FoldFigures.h"

#include "Report.h"
#include "SkinFigures.h"

#include <osgSkinBind/Bind>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <map>

namespace quality {
namespace {

constexpr double kReach = 4.0; ///< limb radii

/// An elbow or a knee, and the axis it folds about, from its bones or the body's front.
struct Limb {
    std::size_t joint = 0;
    compare::Segment upper, lower; ///< bones at rest
    glm::dvec3 axis{0.0};
    double atRest = 0.0; ///< degrees of flexion
    std::vector<std::uint32_t> vertices;
};

glm::dvec3 childCentre(const Subject& subject, std::size_t joint) {
    for (const osgSkin::RestJoint& other : subject.rig.joints)
        if (other.parent == static_cast<int>(joint)) return other.centre;
    return subject.rig.joints[joint].tip.value_or(subject.rig.joints[joint].centre);
}

Limb limbOf(const Subject& subject, const std::string& name, bool knee) {
    Limb limb;
    limb.joint = static_cast<std::size_t>(subject.joint(name));
    const auto parent = static_cast<std::size_t>(subject.rig.joints[limb.joint].parent);
    const glm::dvec3& centre = subject.rig.joints[limb.joint].centre;
    limb.upper = {subject.rig.joints[parent].centre, centre};
    limb.lower = {centre, childCentre(subject, limb.joint)};
    const glm::dvec3 a = glm::normalize(limb.upper.to - limb.upper.from);
    const glm::dvec3 b = glm::normalize(limb.lower.to - limb.lower.from);
    const glm::dvec3 ahead(0.0, 0.0, 1.0); // bodies face +z
    const glm::dvec3 axis = knee ? glm::cross(b, -ahead) : glm::cross(a, b);
    const glm::dvec3& twist = subject.binding.joints[limb.joint].twistAxis;
    limb.axis = glm::normalize(axis - twist * glm::dot(axis, twist));
    limb.atRest = glm::degrees(std::acos(glm::clamp(glm::dot(a, b), -1.0, 1.0)));

    std::vector<double> across; // of skin beside the joint
    for (const glm::dvec3& p : subject.rest) {
        const glm::dvec3 d = p - centre;
        const double length = glm::length(limb.lower.to - centre);
        if (glm::length(d) < 0.5 * length && std::abs(glm::dot(d, b)) < 0.05 * length)
            across.push_back(glm::length(d - b * glm::dot(d, b)));
    }
    std::sort(across.begin(), across.end());
    const double radius = across.empty() ? 0.0 : across[across.size() / 2];
    for (std::uint32_t v = 0; v < subject.rest.size(); ++v) {
        const std::uint32_t owner = subject.dominantJoint(v);
        if ((owner == limb.joint || owner == parent) &&
            glm::distance(subject.rest[v], centre) < kReach * radius)
            limb.vertices.push_back(v);
    }
    return limb;
}

double distanceTo(const compare::Segment& bone, const glm::dvec3& p) {
    const glm::dvec3 along = bone.to - bone.from;
    const double t = glm::clamp(glm::dot(p - bone.from, along) / glm::dot(along, along), 0.0, 1.0);
    return glm::distance(p, bone.from + t * along);
}

double bulgeOf(const Subject& subject, const Limb& limb, const compare::Points& posed,
               const glm::dmat4& turn) {
    const compare::Segment lower{limb.lower.from,
                                 glm::dvec3(turn * glm::dvec4(limb.lower.to, 1.0))};
    std::vector<double> ratios;
    for (const std::uint32_t v : limb.vertices)
        ratios.push_back(std::min(distanceTo(limb.upper, posed[v]), distanceTo(lower, posed[v])) /
                         std::min(distanceTo(limb.upper, subject.rest[v]),
                                  distanceTo(limb.lower, subject.rest[v])));
    if (ratios.empty()) return 0.0;
    std::sort(ratios.begin(), ratios.end());
    return ratios[static_cast<std::size_t>(0.98 * static_cast<double>(ratios.size() - 1))];
}

std::vector<FoldFigure> measureFolds(const Subject& plain, const Subject& shaped) {
    SelfIntersections intersections(plain);
    std::vector<FoldFigure> figures;
    for (const bool knee : {false, true})
        for (const double flexion : {90.0, 120.0, 140.0}) {
            FoldFigure& figure = figures.emplace_back();
            figure.limb = knee ? "knee" : "elbow";
            figure.flexion = flexion;
            for (const std::string side : {"Left", "Right"}) {
                const std::string name = side + (knee ? "Leg" : "ForeArm");
                if (plain.joint(name) < 0) continue;
                const Limb limb = limbOf(plain, name, knee);
                const auto skinning =
                    singleTurn(plain, limb.joint, limb.axis, glm::radians(flexion - limb.atRest));
                for (int way = 0; way < FoldFigure::Ways; ++way) {
                    const Method method = way == FoldFigure::Linear ? Method::Linear
                                          : way == FoldFigure::DualQuaternion
                                              ? Method::DualQuaternion
                                              : Method::Ours;
                    const PosedSkin posed = deformWithNormals(
                        way == FoldFigure::Shaped ? shaped : plain, method, skinning);
                    const auto i = static_cast<std::size_t>(way);
                    figure.bulge[i] = std::max(
                        figure.bulge[i], bulgeOf(plain, limb, posed.points, skinning[limb.joint]));
                    const NormalError normals = normalError(plain, posed, limb.vertices);
                    NormalError& worst = figure.normals[i];
                    worst.mean = std::max(worst.mean, normals.mean);
                    worst.percentile95 = std::max(worst.percentile95, normals.percentile95);
                    figure.pairs[i] += intersections.beyondRest(posed.points);
                }
            }
        }
    return figures;
}

/// The joints whose skin intersects itself only with shapes, with the numbers of pairs.
std::string newPairs(const Subject& plain, const Subject& shaped, const NamedPose& pose) {
    SelfIntersections intersections(plain);
    const auto pairsOf = [&](const Subject& subject) {
        return intersections.pairs(deform(subject, Method::Ours, pose.skinning));
    };
    const auto before = pairsOf(plain), now = pairsOf(shaped);
    std::vector<std::pair<std::size_t, std::size_t>> added;
    std::set_difference(now.begin(), now.end(), before.begin(), before.end(),
                        std::back_inserter(added));
    std::map<std::string, std::size_t> counts;
    for (const auto& pair : added) {
        const auto jointOf = [&](std::size_t triangle) {
            return plain.rig.joints[plain.dominantJoint(plain.triangles[3 * triangle])].name;
        };
        std::string a = jointOf(pair.first), b = jointOf(pair.second);
        if (b < a) a.swap(b);
        ++counts[a == b ? a : a + "/" + b];
    }
    std::string result;
    for (const auto& [joints, count] : counts) result += format(", %s +%zu", joints.c_str(), count);
    return result;
}

} // namespace

ShapeFigures measureShapes(const Subject& subject, const std::vector<NamedPose>& poses) {
    Subject plain = subject, shaped = subject;
    plain.options->shapes = osgSkin::BindOptions::Shapes::None;
    shaped.options->shapes = osgSkin::BindOptions::Shapes::Fast;
    plain.options->surfaceNormals = shaped.options->surfaceNormals = true;
    const auto seconds = [](Subject& bound) {
        const auto start = std::chrono::steady_clock::now();
        bound.binding = osgSkin::bind(bound.mesh, bound.rig, *bound.options);
        const auto end = std::chrono::steady_clock::now();
        bound.model = modelOf(bound);
        return std::chrono::duration<double>(end - start).count();
    };
    ShapeFigures figures;
    figures.seconds = -seconds(plain);
    figures.seconds += seconds(shaped);
    figures.bytesPerVertex = 2.0 *
                             static_cast<double>(shaped.binding.correctives.shares.size() +
                                                 shaped.binding.correctives.normalShares.size()) /
                             static_cast<double>(subject.rest.size());
    figures.folds = measureFolds(plain, shaped);
    figures.steps = measureShapedBends(shaped);
    figures.clips.plain = measurePoses(plain, poses)[Method::Ours];
    figures.clips.shaped = measurePoses(shaped, poses)[Method::Ours];
    for (std::size_t i = 0; i < poses.size(); ++i) {
        const auto before = static_cast<double>(figures.clips.plain.poses[i].intersections);
        const auto now = static_cast<double>(figures.clips.shaped.poses[i].intersections);
        if (now > 1.02 * before + 2.0)
            figures.clips.worsePoses.push_back(
                format("%s %.0f of %.0f", poses[i].name.c_str(), now, before) +
                newPairs(plain, shaped, poses[i]));
    }
    return figures;
}

void printTable(const ShapeFigures& figures, std::ostream& out) {
    out << format("  %-28s%12s%12s%12s%12s\n", "shapes", "LBS", "DQS", "plain", "shaped");
    for (const FoldFigure& fold : figures.folds) {
        out << format("  %-28s",
                      format("%s %.0f: bulge 98 %%", fold.limb.c_str(), fold.flexion).c_str());
        for (const double bulge : fold.bulge) out << format("%12.3f", bulge);
        out << format("\n  %-28s", "  pairs, both sides");
        for (const std::size_t pairs : fold.pairs) out << format("%12zu", pairs);
        out << format("\n  %-28s", "  normals, mean / 95 %");
        for (const NormalError& error : fold.normals)
            out << format("%12s", format("%.2f / %.1f", error.mean, error.percentile95).c_str());
        out << '\n';
    }
    const auto row = [&](const char* name, const char* pattern, double PoseFigures::*figure) {
        out << format("  %-28s%24s%12s%12s\n", name, "",
                      format(pattern, figures.clips.plain.*figure).c_str(),
                      format(pattern, figures.clips.shaped.*figure).c_str());
    };
    row("clips: edge strain RMS", "%.4f", &PoseFigures::strain);
    row("  99.9 % edge", "%.3f", &PoseFigures::percentile999);
    row("  longest edge", "%.2f", &PoseFigures::longest);
    row("  volume error", "%.4f", &PoseFigures::volumeError);
    row("  bulge of limbs", "%.3f", &PoseFigures::bulge);
    row("  self-intersections", "%.2f", &PoseFigures::intersections);
    out << format("  %-28s%24s%12s%12s\n", "  normals, mean / 95 %", "",
                  format("%.2f / %.2f", figures.clips.plain.normals.mean,
                         figures.clips.plain.normals.percentile95)
                      .c_str(),
                  format("%.2f / %.2f", figures.clips.shaped.normals.mean,
                         figures.clips.shaped.normals.percentile95)
                      .c_str());
    out << format("  worst step of a shaped bend: %.2f x a rigid arc (%s)\n", figures.steps.worst,
                  figures.steps.joint.c_str());
    out << format("  poses with over 2 %% + 2 pairs more: %zu; %.1f bytes a vertex, %.3f s more to "
                  "bind\n",
                  figures.clips.worsePoses.size(), figures.bytesPerVertex, figures.seconds);
    for (const std::string& pose : figures.clips.worsePoses) out << "    " << pose << '\n';
}

} // namespace quality
