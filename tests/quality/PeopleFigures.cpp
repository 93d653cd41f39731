// SPDX-License-Identifier: MIT
#include "PeopleFigures.h"

#include "Report.h"
#include "SampledSurface.h"

#include <osgSkinBind/Bind>
#include <osgSkinBind/FitSkeleton>

#include <RatioWeights.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace quality {
namespace {

using compare::Points;

/// A joint whose skin is measured if it is bent by more than `least` degrees.
struct MeasuredJoint {
    const char* name;
    const char* joint; ///< behind Left and Right, for those of both sides
    const char* relativeTo;
    const char*
        turned; ///< the joint whose rotation counts; of a hinge, the angle between the bones
    double least;
    bool isHinge;
    double radiusAt; ///< where the limb's radius is measured, along the bone from the joint
    std::vector<std::string> segments;
};
const MeasuredJoint kSideJoints[] = {
    {"elbow", "ForeArm", "Arm", "ForeArm", 40.0, true, 0.0, {"Arm", "ForeArm"}},
    {"knee", "Leg", "UpLeg", "Leg", 60.0, true, 0.0, {"UpLeg", "Leg"}},
    {"shoulder",
     "Arm",
     "Spine1",
     "Arm",
     40.0,
     false,
     0.4,
     {"Shoulder", "Arm", "Spine1", "Neck", "Spine"}},
    {"hip", "UpLeg", "Hips", "UpLeg", 30.0, false, 0.3, {"UpLeg", "HipJoint", "Hips", "LowerBack"}},
    {"wrist", "Hand", "ForeArm", "Hand", 20.0, false, 0.0, {"ForeArm", "Hand"}},
    {"ankle", "Foot", "Leg", "Foot", 20.0, false, 0.0, {"Leg", "Foot"}}};
const MeasuredJoint kMiddleJoints[] = {{"neck",
                                        "Neck",
                                        "Spine1",
                                        "Head",
                                        10.0,
                                        false,
                                        0.5,
                                        {"Neck", "Neck1", "Spine1", "Head", "Shoulder"}},
                                       {"spine",
                                        "Spine",
                                        "Hips",
                                        "Spine1",
                                        8.0,
                                        false,
                                        0.0,
                                        {"Hips", "HipJoint", "LowerBack", "Spine", "Spine1"}}};

/// The skin within one limb's radius of a joint, along and across its bone.
std::vector<std::uint32_t> bandOf(const Subject& subject, const MeasuredJoint& measured,
                                  const std::string& side) {
    const osgSkin::RestSkeleton& rig = subject.rig;
    const int found = rig.find(side + measured.joint);
    if (found < 0) return {};
    std::set<std::uint32_t> segments;
    for (const std::string& name : measured.segments)
        for (const char* prefix : {"", "Left", "Right", "L", "R"})
            if (const bool isOther = !side.empty() && prefix[0] != '\0' && prefix[0] != side[0];
                !isOther && rig.find(prefix + name) >= 0)
                segments.insert(static_cast<std::uint32_t>(rig.find(prefix + name)));
    const auto joint = static_cast<std::size_t>(found);
    const glm::dvec3 centre = rig.joints[joint].centre;
    const glm::dvec3 bone = subject.binding.joints[joint].boneAxis;
    double length = 0.0;
    for (const int child : rig.children(found))
        length = std::max(length, glm::dot(rig.joints[std::size_t(child)].centre - centre, bone));
    std::vector<double> radii;
    std::vector<std::uint32_t> skin;
    for (std::uint32_t v = 0; v < subject.rest.size(); ++v) {
        const std::uint32_t region = subject.binding.regions[v];
        if (segments.count(region) == 0) continue;
        skin.push_back(v);
        const glm::dvec3 from = subject.rest[v] - centre;
        const double along = glm::dot(from, bone);
        if (std::abs(along - measured.radiusAt * length) < 0.02 &&
            (measured.radiusAt == 0.0 || region == joint))
            radii.push_back(glm::length(from - along * bone));
    }
    if (radii.empty()) return {};
    std::nth_element(radii.begin(), radii.begin() + std::ptrdiff_t(radii.size() / 2), radii.end());
    const double reach = glm::root_two<double>() * radii[radii.size() / 2];
    skin.erase(std::remove_if(
                   skin.begin(), skin.end(),
                   [&](std::uint32_t v) { return glm::distance(subject.rest[v], centre) > reach; }),
               skin.end());
    return skin;
}

/// In degrees; of elbows and knees the angle between the bones. 0 if the rig lacks a joint.
double bendOf(const Subject& subject, const MeasuredJoint& measured, const std::string& side,
              const RigidParts::Pose& pose) {
    const int onSide = subject.rig.find(side + measured.relativeTo);
    const int above = onSide >= 0 ? onSide : subject.rig.find(measured.relativeTo);
    const int turned = subject.rig.find(side + measured.turned);
    if (above < 0 || turned < 0) return 0.0;
    const auto a = static_cast<std::size_t>(above), b = static_cast<std::size_t>(turned);
    const glm::dmat3 upper(pose.skinning[a]), lower(pose.skinning[b]);
    if (measured.isHinge) {
        const double cosine = glm::dot(upper * subject.binding.joints[a].boneAxis,
                                       lower * subject.binding.joints[b].boneAxis);
        return glm::degrees(std::acos(glm::clamp(cosine, -1.0, 1.0)));
    }
    return glm::degrees(
        2.0 * std::acos(std::min(std::abs(glm::quat_cast(glm::transpose(upper) * lower).w), 1.0)));
}

/// Mean over some points.
struct WeightedMean {
    double sum = 0.0, weights = 0.0;
    void add(double value, double weight) {
        sum += weight * value;
        weights += weight;
    }
    double value() const { return weights > 0.0 ? sum / weights : 0.0; }
};

/// A skin or a scan, metres, at the person's size at rest.
struct PosedSurface {
    Points points, normals;
    SampledSurface surface;

    PosedSurface(Points at, const std::vector<std::uint32_t>& triangles)
        : points(std::move(at)), normals(skinNormals(points, triangles)),
          surface(points, triangles) {}
};

/// Vertices and their weights.
using Band = std::map<std::uint32_t, double>;

/// Adds the distances of a band of one surface from the other, and the angles between normals.
void addDistances(const PosedSurface& from, const Band& band, const PosedSurface& to,
                  WeightedMean& distances, WeightedMean& normals) {
    for (const auto& [v, weight] : band) {
        const auto nearest = to.surface.nearest(from.points[v], from.normals[v]);
        distances.add(std::abs(nearest.distance), weight);
        const double cosine = glm::clamp(glm::dot(nearest.normal, from.normals[v]), -1.0, 1.0);
        normals.add(glm::degrees(std::acos(cosine)), weight);
    }
}

/// Mean of a person's distances at a joint; unset if it is never bent.
std::optional<JointDistance> meanAt(const std::vector<JointDistance>& distances,
                                    const std::string& joint) {
    WeightedMean distance, normals;
    for (const JointDistance& entry : distances) {
        if (entry.joint != joint) continue;
        distance.add(entry.distance, 1.0);
        normals.add(entry.normals, 1.0);
    }
    if (!(distance.weights > 0.0)) return std::nullopt;
    return JointDistance{joint, distance.value(), normals.value()};
}

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return 0.5 * (values[values.size() / 2] + values[(values.size() - 1) / 2]);
}

} // namespace

std::vector<std::vector<JointDistance>> measureDistances(const CapturedPerson& person,
                                                         const std::vector<PersonSkin>& skins,
                                                         const Scan& scan,
                                                         const RigidParts::Pose& pose) {
    const Subject& first = skins.front().subject;
    Points points = scan.points;
    for (glm::dvec3& point : points) point /= pose.scale;
    const PosedSurface captured(points, scan.triangles);
    std::vector<PosedSurface> deformed;
    for (const PersonSkin& skin : skins)
        deformed.emplace_back(deform(skin.subject, skin.method, pose.skinning), first.triangles);

    // Area times visibility; the same vertices count for all skins.
    const auto weightsOf = [](const PosedSurface& surface, const Points& sized,
                              const std::vector<std::uint32_t>& triangles) {
        std::vector<double> weights = surface.surface.visibility(surface.points);
        const std::vector<double> areas = vertexAreas(sized, triangles);
        for (std::size_t v = 0; v < areas.size(); ++v) weights[v] *= areas[v];
        return weights;
    };
    const std::vector<double> skinWeights =
        weightsOf(deformed.front(), first.rest, first.triangles);
    const std::vector<double> scanWeights = weightsOf(captured, points, scan.triangles);

    std::vector<std::vector<JointDistance>> result(skins.size());
    const auto measure = [&](const MeasuredJoint& measured, const std::string& side) {
        if (!(bendOf(first, measured, side, pose) > measured.least)) return;
        Band skinBand, scanBand;
        for (const std::uint32_t v : bandOf(first, measured, side)) skinBand[v] = skinWeights[v];
        for (std::size_t p = 0; p < scan.vertexOf.size(); ++p)
            if (skinBand.count(person.rest.vertexOf[p]) > 0)
                scanBand[scan.vertexOf[p]] = scanWeights[scan.vertexOf[p]];
        for (std::size_t s = 0; s < skins.size(); ++s) {
            WeightedMean toScan, toSkin, normals, ignored;
            addDistances(deformed[s], skinBand, captured, toScan, normals);
            addDistances(captured, scanBand, deformed[s], toSkin, ignored);
            result[s].push_back(
                {measured.name, 500.0 * (toScan.value() + toSkin.value()), normals.value()});
        }
    };
    for (const MeasuredJoint& measured : kSideJoints)
        for (const char* side : {"Left", "Right"}) measure(measured, side);
    for (const MeasuredJoint& measured : kMiddleJoints) measure(measured, "");
    return result;
}

PersonFigures measurePerson(const CapturedPerson& person, Ratios ratios, Joints joints) {
    PaintedBody body;
    body.name = person.name;
    body.mesh.positions = person.rest.points;
    body.mesh.faceVertices = person.rest.triangles;
    body.mesh.faceSizes.assign(person.rest.triangles.size() / 3, 3);
    body.rig = osgSkin::fitSkeleton(body.mesh);
    body.painted.assign(person.rest.points.size(), {});
    if (joints == Joints::Solved) {
        const osgSkin::Binding binding = osgSkin::bind(body.mesh, body.rig);
        body.rig = RigidParts(person, body.rig, binding.regions).turnedJoints();
    }
    const auto skin = [&](const char* name, Method method, bool isShaped) {
        PersonSkin made{name, makeSubject(body, ratios), method};
        if (!isShaped) {
            made.subject.binding.correctives = {};
            made.subject.model = modelOf(made.subject);
            made.subject.weights = compare::weightsOf(made.subject.binding);
        }
        return made;
    };
    const std::vector<PersonSkin> skins = {
        skin("osgSkin", Method::Ours, true), skin("no shapes", Method::Ours, false),
        skin("LBS", Method::Linear, false), skin("DQS", Method::DualQuaternion, false)};
    const RigidParts parts(person, body.rig, skins.front().subject.binding.regions);
    PersonFigures figures;
    for (const PersonSkin& entry : skins) figures.skins.push_back(entry.name);
    figures.distances.resize(skins.size());
    for (const Scan& scan : person.poses) {
        const auto measured = measureDistances(person, skins, scan, parts.solve(body.rig, scan));
        for (std::size_t s = 0; s < skins.size(); ++s)
            figures.distances[s].insert(figures.distances[s].end(), measured[s].begin(),
                                        measured[s].end());
    }
    return figures;
}

void printTable(const std::vector<PersonFigures>& people, std::ostream& out) {
    const std::vector<std::string>& skins = people.front().skins;
    out << format("%-22s%6s%8s%9s", "joint, bent by more", "cases", "mm", "normals");
    for (std::size_t s = 1; s < skins.size(); ++s) out << format("  / %-10s", skins[s].c_str());
    out << '\n';
    std::vector<double> products(skins.size(), 0.0);
    double rows = 0.0;
    const auto print = [&](const MeasuredJoint& measured) {
        std::vector<double> distances, normals, logarithms(skins.size(), 0.0);
        std::size_t cases = 0;
        for (const PersonFigures& person : people) {
            const auto ours = meanAt(person.distances.front(), measured.name);
            if (!ours) continue;
            distances.push_back(ours->distance);
            normals.push_back(ours->normals);
            for (const JointDistance& entry : person.distances.front())
                cases += entry.joint == measured.name ? 1 : 0;
            for (std::size_t s = 1; s < skins.size(); ++s)
                logarithms[s] +=
                    std::log(ours->distance / meanAt(person.distances[s], measured.name)->distance);
        }
        if (distances.empty()) return;
        rows += 1.0;
        out << format("%-15s%3.0f deg%6zu%8.2f%9.1f", measured.name, measured.least, cases,
                      median(distances), median(normals));
        for (std::size_t s = 1; s < skins.size(); ++s) {
            products[s] += logarithms[s] / double(distances.size());
            out << format("  %-12.3f", std::exp(logarithms[s] / double(distances.size())));
        }
        out << '\n';
    };
    for (const MeasuredJoint& measured : kSideJoints) print(measured);
    for (const MeasuredJoint& measured : kMiddleJoints) print(measured);
    out << format("%-45s", "mean");
    for (std::size_t s = 1; s < skins.size(); ++s)
        out << format("  %-12.3f", std::exp(products[s] / std::max(rows, 1.0)));
    out << '\n';
}

} // namespace quality
