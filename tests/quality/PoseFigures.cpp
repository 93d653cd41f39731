// SPDX-License-Identifier: MIT
#include "PoseFigures.h"

#include "SkinFigures.h"

#include <osgSkinBind/Bind>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>

namespace quality {

namespace {

/// Measures that have to be computed from the skin's shape in every pose.
struct ShapeMeasures {
    explicit ShapeMeasures(const Subject& subject) : bulge(subject), intersections(subject) {}
    LimbBulge bulge;
    SelfIntersections intersections;
};

PoseFigures measure(const Subject& subject, Method method, const std::vector<NamedPose>& poses,
                    ShapeMeasures* shape) {
    PoseFigures sum;
    const double volume = compare::enclosedVolume(subject.rest, subject.triangles);
    const auto count = static_cast<double>(poses.size());
    for (const NamedPose& pose : poses) {
        const PosedSkin posed = shape ? deformWithNormals(subject, method, pose.skinning)
                                      : PosedSkin{deform(subject, method, pose.skinning), {}};
        const double posedVolume = compare::enclosedVolume(posed.points, subject.triangles);
        PoseFigure figure;
        figure.name = pose.name;
        figure.strain = compare::edgeStrain(subject.rest, posed.points, subject.edges);
        figure.volumeError = std::abs(posedVolume / volume - 1.0);
        if (shape) {
            figure.normals = normalError(subject, posed);
            figure.bulge = shape->bulge.of(posed.points, pose.skinning);
            figure.intersections = shape->intersections.beyondRest(posed.points);
        }
        sum.strain += figure.strain.rms / count;
        sum.percentile999 += figure.strain.percentile999 / count;
        sum.volumeError += figure.volumeError / count;
        sum.normals.mean += figure.normals.mean / count;
        sum.normals.percentile95 += figure.normals.percentile95 / count;
        sum.bulge += figure.bulge / count;
        sum.intersections += static_cast<double>(figure.intersections) / count;
        if (figure.strain.largest > sum.longest) {
            sum.longest = figure.strain.largest;
            sum.longestIn = figure.name;
        }
        sum.poses.push_back(figure);
    }
    return sum;
}

} // namespace

PoseFigures measureOurs(const Subject& subject, const std::vector<NamedPose>& poses) {
    return measure(subject, Method::Ours, poses, nullptr);
}

PerMethod<PoseFigures> measureStrains(const Subject& subject, const std::vector<NamedPose>& poses) {
    PerMethod<PoseFigures> result;
    for (const Method method : kMethods) result[method] = measure(subject, method, poses, nullptr);
    return result;
}

PerMethod<PoseFigures> measurePoses(const Subject& subject, const std::vector<NamedPose>& poses) {
    ShapeMeasures shape(subject);
    PerMethod<PoseFigures> result;
    for (const Method method : kMethods) result[method] = measure(subject, method, poses, &shape);
    return result;
}

namespace {

/// An edge changes its length if it does so by more than this share; single precision is far more
/// accurate.
constexpr double kMoved = 1e-5;

double movedStrain(const Subject& subject, const compare::Points& posed) {
    double squares = 0.0, count = 0.0;
    for (const compare::Edge& edge : subject.edges) {
        const double length = glm::distance(subject.rest[edge[0]], subject.rest[edge[1]]);
        if (!(length > 0.0)) continue;
        const double strain = glm::distance(posed[edge[0]], posed[edge[1]]) / length - 1.0;
        if (std::abs(strain) < kMoved) continue;
        squares += strain * strain;
        count += 1.0;
    }
    return count > 0.0 ? std::sqrt(squares / count) : 0.0;
}

/// From just below the elbow to just above the wrist.
std::vector<std::vector<EdgePoint>> forearmLoops(const Subject& subject, const glm::dvec3& elbow,
                                                 const glm::dvec3& wrist) {
    std::vector<std::vector<EdgePoint>> loops;
    for (int percent = 10; percent <= 95; percent += 5)
        loops.push_back(crossSection(subject, glm::mix(elbow, wrist, 0.01 * percent),
                                     glm::normalize(wrist - elbow)));
    return loops;
}

void add(const Subject& subject, const std::string& side, std::vector<WristTwist>& twists) {
    const int forearm = subject.joint(side + "ForeArm"), hand = subject.joint(side + "Hand");
    if (forearm < 0 || hand < 0) return;
    const osgSkin::BoundJoint& wrist = subject.binding.joints[static_cast<std::size_t>(hand)];
    const glm::dvec3 elbow = subject.rig.joints[static_cast<std::size_t>(forearm)].centre;
    const CrossSections sections(subject, static_cast<std::size_t>(hand),
                                 forearmLoops(subject, elbow, wrist.centre));
    for (WristTwist& twist : twists) {
        const auto skinning = singleTurn(subject, static_cast<std::size_t>(hand), wrist.twistAxis,
                                         glm::radians(twist.degrees));
        for (const Method method : kMethods) {
            const compare::Points posed = deform(subject, method, skinning);
            twist.strain[method] = std::max(twist.strain[method], movedStrain(subject, posed));
            const CrossSections::Least least = sections.leastAreas(method, skinning, posed);
            CrossSections::Least& worst = twist.leastArea[method];
            worst.ofMethod = std::min(worst.ofMethod, least.ofMethod);
            worst.ofMesh = std::min(worst.ofMesh, least.ofMesh);
        }
    }
}

} // namespace

std::vector<WristTwist> measureWristTwists(const Subject& subject) {
    if (subject.joint("LeftHand") < 0 && subject.joint("RightHand") < 0) return {};
    std::vector<WristTwist> twists;
    for (const double degrees : {60.0, 120.0, 170.0}) twists.push_back({degrees, {}, {}});
    for (const std::string side : {"Left", "Right"}) add(subject, side, twists);
    return twists;
}

namespace {

void compareFigures(const std::string& name, double capped, double uncapped, CappingCost& cost) {
    if (!(uncapped > 0.0) || capped / uncapped - 1.0 <= cost.share) return;
    cost.share = capped / uncapped - 1.0;
    cost.figure = name;
}

} // namespace

CappingCost measureCapping(const Subject& subject, const std::vector<NamedPose>& poses,
                           const PoseFigures& capped, const std::vector<WristTwist>& wrist) {
    CappingCost cost;
    if (!subject.options) return cost; // bound by weights
    Subject free = subject;
    osgSkin::BindOptions options = *subject.options;
    options.maxPartialInfluences = osgSkin::SkinModel::kMaxPartialInfluences;
    free.binding = osgSkin::bind(free.mesh, free.rig, options);
    free.model = modelOf(free);
    const PoseFigures uncapped = measureOurs(free, poses);
    compareFigures("edge strain RMS", capped.strain, uncapped.strain, cost);
    compareFigures("99.9 % edge", capped.percentile999, uncapped.percentile999, cost);
    compareFigures("longest edge", capped.longest, uncapped.longest, cost);
    compareFigures("volume error", capped.volumeError, uncapped.volumeError, cost);
    const std::vector<WristTwist> freeWrist = measureWristTwists(free);
    for (std::size_t i = 0; i < wrist.size(); ++i)
        compareFigures("wrist strain", wrist[i].strain[Method::Ours],
                       freeWrist[i].strain[Method::Ours], cost);
    return cost;
}

} // namespace quality
