// SPDX-License-Identifier: MIT
//
// Measures synthetic bodies derived from the available ones: does binding meet its limits on them?
#include "CommandLine.h"
#include "FoldFigures.h"
#include "Report.h"
#include "Subject.h"

#include <CLI/CLI.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>
#include <exception>
#include <functional>
#include <iostream>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace quality {

namespace {

/// Makes bodies from another body: the same faces and painted weights with moved skin and joints.

/// Scale of a bone's skin along the bone and across it.
struct BoneScale {
    double length = 1.0, girth = 1.0;
};

constexpr double kAtExtremities = 0.2;
constexpr int kSmoothings = 4;

/// The value that `side` ("Left", "Right" or neither) has for the joint, by its full name or
/// without the side.
template <typename Value>
const Value* entryOf(const std::map<std::string, Value>& entries, const std::string& joint) {
    if (const auto found = entries.find(joint); found != entries.end()) return &found->second;
    for (const std::string side : {"Left", "Right"})
        if (joint.rfind(side, 0) == 0)
            if (const auto found = entries.find(joint.substr(side.size())); found != entries.end())
                return &found->second;
    return nullptr;
}

/// The painted mean, over a vertex's joints, of the values of `of`.
template <typename Value>
Value paintedMean(const PaintedBody& body, std::size_t vertex,
                  const std::function<Value(std::size_t)>& of) {
    Value sum(0.0);
    double weights = 0.0;
    for (const osgSkin::JointWeight& entry : body.painted[vertex]) {
        sum += entry.weight * of(entry.joint);
        weights += entry.weight;
    }
    return weights > 0.0 ? sum / weights : of(0);
}

/// 1, and less on head, hands and feet.
std::vector<double> shares(const PaintedBody& body) {
    const auto ofJoint = [&](std::size_t joint) {
        for (const char* name : {"Head", "LeftHand", "RightHand", "LeftFoot", "RightFoot"})
            if (const int part = body.rig.find(name);
                part >= 0 && body.rig.isInSubtree(static_cast<int>(joint), part))
                return kAtExtremities;
        return 1.0;
    };
    std::vector<double> result;
    for (std::size_t v = 0; v < body.painted.size(); ++v)
        result.push_back(paintedMean<double>(body, v, ofJoint));
    return result;
}

std::vector<glm::dvec3> smoothNormals(const osgSkin::SkinMesh& mesh) {
    const std::vector<std::uint32_t> triangles = mesh.triangles();
    compare::Points normals = skinNormals(mesh.positions, triangles);
    for (int i = 0; i < kSmoothings; ++i) {
        compare::Points sums = normals;
        for (std::size_t t = 0; t < triangles.size(); ++t)
            sums[triangles[t]] += normals[triangles[t % 3 == 2 ? t - 2 : t + 1]];
        for (std::size_t v = 0; v < sums.size(); ++v)
            if (const double length = glm::length(sums[v]); length > 0.0)
                normals[v] = sums[v] / length;
    }
    return normals;
}

/// Moves every point and joint by the joints' maps; skin by their painted mean.
PaintedBody moved(const PaintedBody& body,
                  const std::function<glm::dvec3(std::size_t, const glm::dvec3&)>& map) {
    PaintedBody result = body;
    for (std::size_t v = 0; v < body.mesh.positions.size(); ++v)
        result.mesh.positions[v] = paintedMean<glm::dvec3>(
            body, v, [&](std::size_t joint) { return map(joint, body.mesh.positions[v]); });
    for (std::size_t j = 0; j < body.rig.joints.size(); ++j) {
        osgSkin::RestJoint& joint = result.rig.joints[j];
        joint.centre = map(j, joint.centre);
        if (joint.tip) joint.tip = map(j, *joint.tip);
    }
    return result;
}

/// The end of a joint's bone: the farthest child, or its tip.
glm::dvec3 boneEnd(const osgSkin::RestSkeleton& rig, std::size_t joint) {
    glm::dvec3 end = rig.joints[joint].tip.value_or(rig.joints[joint].centre);
    for (const int child : rig.children(static_cast<int>(joint))) {
        const glm::dvec3& centre = rig.joints[static_cast<std::size_t>(child)].centre;
        if (glm::distance(centre, rig.joints[joint].centre) >
            glm::distance(end, rig.joints[joint].centre))
            end = centre;
    }
    return end;
}

/// Interpolates or extrapolates from `from` (t = 0) to `to` (t = 1).
/// \pre both have the same faces and the same joints
PaintedBody blended(const PaintedBody& from, const PaintedBody& to, double t) {
    PaintedBody result = from;
    for (std::size_t v = 0; v < result.mesh.positions.size(); ++v)
        result.mesh.positions[v] = glm::mix(from.mesh.positions[v], to.mesh.positions[v], t);
    for (std::size_t j = 0; j < result.rig.joints.size(); ++j) {
        osgSkin::RestJoint& joint = result.rig.joints[j];
        joint.centre = glm::mix(joint.centre, to.rig.joints[j].centre, t);
        if (joint.tip) joint.tip = glm::mix(*joint.tip, *to.rig.joints[j].tip, t);
    }
    return result;
}

/// Moves the skin out by `distance` (in, if negative) along normals that are smoothed so that
/// creases do not cross. Head, hands and feet move by a fifth of it. The joints stay.
PaintedBody thickened(PaintedBody body, double distance) {
    const std::vector<glm::dvec3> normals = smoothNormals(body.mesh);
    const std::vector<double> share = shares(body);
    for (std::size_t v = 0; v < normals.size(); ++v)
        body.mesh.positions[v] += distance * share[v] * normals[v];
    return body;
}

/// Hollows and bumps: moves the skin along its normals by up to `depth`, in waves of `length`.
/// Head, hands and feet move by a fifth of it.
PaintedBody uneven(PaintedBody body, double depth, double length) {
    const std::vector<glm::dvec3> normals = smoothNormals(body.mesh);
    const std::vector<double> share = shares(body);
    const double rate = 2.0 * 3.14159265358979 / length;
    for (std::size_t v = 0; v < normals.size(); ++v) {
        glm::dvec3& p = body.mesh.positions[v];
        const double wave = std::sin(rate * p.x) * std::cos(0.8 * rate * p.y) +
                            std::sin(0.6 * rate * p.y + rate * p.z);
        p += 0.5 * depth * wave * share[v] * normals[v];
    }
    return body;
}

/// Bones of other proportions, by the names of their joints, which may stand for both sides: "Arm"
/// is "LeftArm" and "RightArm". The descendants of a bone move with its end. Other joints keep
/// their girth and length.
PaintedBody proportioned(const PaintedBody& body, const std::map<std::string, BoneScale>& bones) {
    const osgSkin::RestSkeleton& rig = body.rig;
    std::vector<glm::dvec3> centres(rig.joints.size());
    const auto scaled = [&](std::size_t joint, const glm::dvec3& offset) {
        const BoneScale* scale = entryOf(bones, rig.joints[joint].name);
        const glm::dvec3 bone = boneEnd(rig, joint) - rig.joints[joint].centre;
        if (!scale || !(glm::length(bone) > 0.0)) return offset;
        const glm::dvec3 axis = glm::normalize(bone);
        const glm::dvec3 along = axis * glm::dot(axis, offset);
        return scale->length * along + scale->girth * (offset - along);
    };
    for (std::size_t j = 0; j < centres.size(); ++j) {
        const glm::dvec3& centre = rig.joints[j].centre;
        if (rig.joints[j].parent < 0) {
            centres[j] = centre;
            continue;
        }
        const auto parent = static_cast<std::size_t>(rig.joints[j].parent);
        centres[j] = centres[parent] + scaled(parent, centre - rig.joints[parent].centre);
    }
    return moved(body, [&](std::size_t joint, const glm::dvec3& p) {
        return centres[joint] + scaled(joint, p - rig.joints[joint].centre);
    });
}

/// Another rest pose, by linear blending with the painted weights: each named joint is rotated
/// about x, then y, then z through its centre, degrees. A name without a side rotates both sides as
/// mirror images, by the left one's angles.
PaintedBody standing(const PaintedBody& body, const std::map<std::string, glm::dvec3>& turns) {
    const osgSkin::RestSkeleton& rig = body.rig;
    std::vector<glm::dmat4> matrices(rig.joints.size(), glm::dmat4(1.0));
    for (std::size_t j = 0; j < matrices.size(); ++j) {
        const osgSkin::RestJoint& joint = rig.joints[j];
        if (joint.parent >= 0) matrices[j] = matrices[static_cast<std::size_t>(joint.parent)];
        const glm::dvec3* turn = entryOf(turns, joint.name);
        if (!turn) continue;
        const double side = joint.name.rfind("Right", 0) == 0 ? -1.0 : 1.0;
        const glm::dvec3 angles = glm::radians(*turn) * glm::dvec3(1.0, side, side);
        glm::dmat4 rotation(1.0);
        for (const int axis : {2, 1, 0}) {
            glm::dvec3 about(0.0);
            about[axis] = 1.0;
            rotation = glm::rotate(rotation, angles[axis], about);
        }
        matrices[j] *= glm::translate(glm::dmat4(1.0), joint.centre) * rotation *
                       glm::translate(glm::dmat4(1.0), -joint.centre);
    }
    return moved(body, [&](std::size_t joint, const glm::dvec3& p) {
        return glm::dvec3(matrices[joint] * glm::dvec4(p, 1.0));
    });
}

/// Splits each triangle in four, with new vertices in the middle of the edges.
PaintedBody subdivided(const PaintedBody& body) {
    PaintedBody result = body;
    result.mesh.faceSizes.clear();
    result.mesh.faceVertices.clear();
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
        const auto next = static_cast<std::uint32_t>(result.mesh.positions.size());
        const auto [entry, added] = middles.try_emplace(std::minmax(a, b), next);
        if (added) {
            result.mesh.positions.push_back(0.5 *
                                            (body.mesh.positions[a] + body.mesh.positions[b]));
            std::map<std::uint32_t, double> sums;
            for (const std::uint32_t end : {a, b})
                for (const osgSkin::JointWeight& weight : body.painted[end])
                    sums[weight.joint] += 0.5 * weight.weight;
            auto& painted = result.painted.emplace_back();
            for (const auto& [joint, weight] : sums) painted.push_back({joint, weight});
        }
        return entry->second;
    };
    const std::vector<std::uint32_t> corners = body.mesh.triangles();
    for (std::size_t t = 0; t + 2 < corners.size(); t += 3) {
        const std::uint32_t a = corners[t], b = corners[t + 1], c = corners[t + 2];
        const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
        for (const std::uint32_t v : {a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca})
            result.mesh.faceVertices.push_back(v);
        result.mesh.faceSizes.insert(result.mesh.faceSizes.end(), 4, 3);
    }
    return result;
}

/// A synthetic body, derived from the two available ones.
struct Variation {
    std::string name;
    bool heldOut = false; ///< in the half that must not influence any setting
    std::function<PaintedBody()> make;
};

/// A millimetre in the bodies' unit.
constexpr double kMillimetre = 0.01;

using Change = std::function<PaintedBody(const PaintedBody&)>;
using Bones = std::map<std::string, BoneScale>;
using Turns = std::map<std::string, glm::dvec3>;

struct Named {
    std::string name;
    Change change;
};

void addGirths(std::vector<Named>& all) {
    for (const int mm : {-10, -8, -6, -5, -4, -2, 4, 8, 10, 14})
        all.push_back({format("%+d mm", mm), [mm](const PaintedBody& body) {
                           return thickened(body, mm * kMillimetre);
                       }});
    for (const double girth : {0.7, 0.85, 1.2, 1.4})
        all.push_back({format("limbs %.2f thick", girth), [girth](const PaintedBody& body) {
                           Bones bones;
                           for (const char* name : {"Arm", "ForeArm", "UpLeg", "Leg"})
                               bones[name] = {1.0, girth};
                           return proportioned(body, bones);
                       }});
    for (const double girth : {0.85, 1.15, 1.3})
        all.push_back({format("trunk %.2f thick", girth), [girth](const PaintedBody& body) {
                           Bones bones;
                           for (const char* name : {"LowerBack", "Spine", "Spine1"})
                               bones[name] = {1.0, girth};
                           return proportioned(body, bones);
                       }});
}

void addLengths(std::vector<Named>& all) {
    const auto add = [&all](const char* what, const std::vector<const char*>& joints,
                            double length) {
        all.push_back(
            {format("%s %.2f long", what, length), [joints, length](const PaintedBody& body) {
                 Bones bones;
                 for (const char* joint : joints) bones[joint] = {length, 1.0};
                 return proportioned(body, bones);
             }});
    };
    for (const double length : {0.75, 0.85, 0.9, 1.15, 1.3}) add("forearms", {"ForeArm"}, length);
    for (const double length : {0.85, 1.2}) add("upper arms", {"Arm"}, length);
    for (const double length : {0.8, 1.25}) add("arms", {"Arm", "ForeArm"}, length);
    for (const double length : {0.8, 0.9, 1.15, 1.3}) add("legs", {"UpLeg", "Leg"}, length);
    for (const double length : {0.85, 1.15}) add("collar bones", {"Shoulder"}, length);
    for (const double length : {0.85, 1.2}) add("trunk", {"LowerBack", "Spine", "Spine1"}, length);
}

void addRestPoses(std::vector<Named>& all) {
    const auto add = [&all](const std::string& name, const Turns& turns) {
        all.push_back({name, [turns](const PaintedBody& body) { return standing(body, turns); }});
    };
    for (const double raise : {-25.0, -15.0, 15.0, 30.0, 48.0, 60.0})
        add(format("arms %+.0f degrees", raise), {{"Arm", {0, 0, raise}}});
    add("T with collar bones",
        {{"Shoulder", {0, 0, 10}}, {"Arm", {0, 0, 38}}, {"ForeArm", {0, 40, 0}}});
    add("arms straight", {{"ForeArm", {0, 40, 0}}});
    for (const double apart : {-4.0, 8.0, 15.0})
        add(format("legs %+.0f degrees apart", apart), {{"UpLeg", {0, 0, apart}}});
    for (const double bent : {10.0, 20.0})
        add(format("spine bent by %.0f", bent), {{"LowerBack", {bent / 2, 0, 0}},
                                                 {"Spine", {bent / 2, 0, 0}},
                                                 {"Spine1", {bent, 0, 0}},
                                                 {"Neck", {-bent, 0, 0}},
                                                 {"Head", {-bent, 0, 0}}});
}

/// Thin limbs, hollows, a bent spine.
PaintedBody aged(const PaintedBody& body, double years) {
    const double girth = 1.0 - 0.25 * years;
    PaintedBody old = proportioned(body, {{"Arm", {1.0, girth}},
                                          {"ForeArm", {1.0, girth}},
                                          {"UpLeg", {1.0, girth}},
                                          {"Leg", {1.0, girth}},
                                          {"Neck", {1.0, girth}},
                                          {"Spine", {0.95, girth}}});
    old = uneven(thickened(old, -4.0 * years * kMillimetre), 10.0 * years * kMillimetre, 2.0);
    return standing(old, {{"LowerBack", {8 * years, 0, 0}},
                          {"Spine", {8 * years, 0, 0}},
                          {"Spine1", {12 * years, 0, 0}},
                          {"Neck", {-12 * years, 0, 0}},
                          {"Head", {-12 * years, 0, 0}}});
}

void addOthers(std::vector<Named>& all) {
    for (const double years : {0.5, 0.75, 1.0, 1.25})
        all.push_back({format("old and thin %.2f", years),
                       [years](const PaintedBody& body) { return aged(body, years); }});
    for (const double length : {0.8, 1.2, 2.0, 3.5})
        all.push_back({format("uneven by %.1f", length), [length](const PaintedBody& body) {
                           return uneven(body, 8.0 * kMillimetre, length);
                       }});
    all.push_back({"-6 mm, arms +30", [](const PaintedBody& body) {
                       return standing(thickened(body, -6.0 * kMillimetre), {{"Arm", {0, 0, 30}}});
                   }});
    all.push_back({"-6 mm, arms -15", [](const PaintedBody& body) {
                       return standing(thickened(body, -6.0 * kMillimetre), {{"Arm", {0, 0, -15}}});
                   }});
    all.push_back({"subdivided", subdivided});
}

/// Variations of two bodies of one topology: between and beyond them, thinner and thicker, of other
/// proportions, in other rest poses, aged. Every second one is held out.
/// \param neutral one of the bodies; the variations refer to both
/// \param male the other
std::vector<Variation> variations(const PaintedBody& neutral, const PaintedBody& male) {
    std::vector<Variation> result;
    const auto add = [&result](const std::string& name, std::function<PaintedBody()> make) {
        result.push_back({name, result.size() % 2 == 1, std::move(make)});
    };
    for (const double t : {-1.0, -0.75, -0.5, -0.25, 0.0, 0.25, 0.5, 0.75, 1.0, 1.25, 1.5})
        add(format("neutral to male %.2f", t),
            [&neutral, &male, t] { return blended(neutral, male, t); });
    std::vector<Named> changes;
    addGirths(changes);
    addLengths(changes);
    addRestPoses(changes);
    addOthers(changes);
    for (const PaintedBody* body : {&neutral, &male})
        for (std::size_t i = 0; i < changes.size(); ++i) {
            const Change& change = changes[i].change;
            result.push_back({(body == &male ? "male, " : "neutral, ") + changes[i].name,
                              i % 2 == 1, [body, change] { return change(*body); }});
        }
    return result;
}

/// One of a pose's longest edges, its l'/l, and the difference of its ends' ratios.
struct WorstEdge {
    compare::Edge edge{};
    std::size_t poses = 0; ///< in which it is among the longest
    double excess = 0.0;   ///< sum over them of l'/l - 1
    double longest = 0.0;  ///< l'/l
    std::string longestIn; ///< that pose's name
};

constexpr double kShare = 1e-3; // beyond the 99.9th percentile

std::vector<glm::dvec2> ratiosOf(const osgSkin::Binding& binding, std::size_t vertex) {
    std::vector<glm::dvec2> ratios(binding.joints.size(), glm::dvec2(0.0));
    for (std::uint32_t i = binding.firstInfluence[vertex]; i < binding.firstInfluence[vertex + 1];
         ++i) {
        const osgSkin::Influence& influence = binding.influences[i];
        ratios[influence.joint] = {influence.bend, influence.twist};
    }
    return ratios;
}

/// The edges beyond the 99.9th percentile in any of the poses, for ours, the largest sum first.
std::vector<WorstEdge> worstEdges(const Subject& subject, const std::vector<NamedPose>& poses) {
    std::map<compare::Edge, WorstEdge> found;
    const auto count =
        static_cast<std::size_t>(kShare * static_cast<double>(subject.edges.size())) + 1;
    for (const NamedPose& pose : poses) {
        const compare::Points posed = deform(subject, Method::Ours, pose.skinning);
        std::vector<std::pair<double, compare::Edge>> all;
        for (const compare::Edge& edge : subject.edges) {
            const double rest = glm::distance(subject.rest[edge[0]], subject.rest[edge[1]]);
            if (rest > 0.0)
                all.emplace_back(glm::distance(posed[edge[0]], posed[edge[1]]) / rest, edge);
        }
        const auto end = all.begin() + static_cast<std::ptrdiff_t>(std::min(count, all.size()));
        std::partial_sort(all.begin(), end, all.end(), std::greater<>());
        for (auto entry = all.begin(); entry != end; ++entry) {
            WorstEdge& worst = found[entry->second];
            worst.edge = entry->second;
            ++worst.poses;
            worst.excess += entry->first - 1.0;
            if (entry->first > worst.longest) {
                worst.longest = entry->first;
                worst.longestIn = pose.name;
            }
        }
    }
    std::vector<WorstEdge> result;
    result.reserve(found.size());
    for (const auto& [edge, worst] : found) result.push_back(worst);
    std::sort(result.begin(), result.end(),
              [](const WorstEdge& a, const WorstEdge& b) { return a.excess > b.excess; });
    return result;
}

/// One line about it: painted joints, regions and the joints whose ratios differ most along it.
std::string lineOf(const Subject& subject, const WorstEdge& worst) {
    const std::size_t a = worst.edge[0], b = worst.edge[1];
    const auto name = [&](std::size_t joint) { return subject.rig.joints[joint].name; };
    const glm::dvec3 middle = 0.5 * (subject.rest[a] + subject.rest[b]);
    std::string line =
        format("%6.2f in %2zu, %.2f in %s, %.3f long at (%.2f %.2f %.2f), ", worst.excess,
               worst.poses, worst.longest, worst.longestIn.c_str(),
               glm::distance(subject.rest[a], subject.rest[b]), middle.x, middle.y, middle.z);
    line += name(subject.dominantJoint(a)) + "-" + name(subject.dominantJoint(b)) + ", region " +
            name(subject.binding.regions[a]) + "-" + name(subject.binding.regions[b]) + ":";
    const std::vector<glm::dvec2> from = ratiosOf(subject.binding, a);
    const std::vector<glm::dvec2> to = ratiosOf(subject.binding, b);
    for (std::size_t j = 0; j < from.size(); ++j)
        if (std::abs(from[j].x - to[j].x) > 0.05 || std::abs(from[j].y - to[j].y) > 0.05)
            line += format(" %s %.2f/%.2f-%.2f/%.2f", name(j).c_str(), from[j].x, from[j].y,
                           to[j].x, to[j].y);
    return line;
}

} // namespace

} // namespace quality

namespace {

using namespace quality;

struct Options {
    std::string motions = OSGSKIN_SHARED_DATA "/cmu/mb";
    std::vector<std::string> only;
    std::string half = "both";
    std::size_t worst = 0;
    std::string shapes;
};

void define(example::CommandLine& line, Options& options) {
    line.add("--motions", options.motions, "the folder of the CMU motions");
    line.add("--only", options.only, "only variations with any of these in their names");
    line.add("--half", options.half, "only one half of them")
        .oneOf({"both", "tuned", "held-out"})
        .showDefault();
    line.add("--worst", options.worst, "how many of a body's worst edges to list");
    line.add("--shapes", options.shapes,
             "only what shapes do: to pairs of triangles that cut each other, by pose, and to "
             "edges and volumes over the clips")
        .oneOf({"fast", "elastic"});
}

PaintedBody sharedBody(const std::string& shape) {
    const std::string makehuman = OSGSKIN_SHARED_DATA "/makehuman/";
    return loadBody(makehuman + "body/body4k_" + shape + ".obj",
                    makehuman + "rig/cmu_mb_" + shape + ".bvh",
                    makehuman + "weights/body4k_weights_cmu_mb.json");
}

/// Without the sweeps and figures that only pictures need.
Report measure(const Subject& subject, const std::vector<NamedPose>& poses) {
    Report report;
    report.body = subject.name;
    report.vertices = subject.rest.size();
    report.poses = poses.size();
    report.motion = measureStrains(subject, poses);
    report.rigidity = measureRigidity(subject);
    report.wrist = measureWristTwists(subject);
    report.binding = measureBinding(subject);
    report.capping = measureCapping(subject, poses, report.motion[Method::Ours], report.wrist);
    return report;
}

/// The worst and the sum of a figure over a half's bodies, and how many miss its limit.
struct Tally {
    std::string name;
    double worst = 0.0, sum = 0.0;
    std::size_t bodies = 0, missed = 0;
    bool atMost = true;
};

void count(const std::vector<Bar>& all, std::vector<Tally>& tallies) {
    tallies.resize(std::max(tallies.size(), all.size()));
    for (std::size_t i = 0; i < all.size(); ++i) {
        Tally& tally = tallies[i];
        const bool first = tally.bodies++ == 0;
        tally.name = all[i].name;
        tally.atMost = all[i].atMost;
        const bool worse = all[i].atMost ? all[i].value > tally.worst : all[i].value < tally.worst;
        if (first || worse) tally.worst = all[i].value;
        tally.sum += all[i].value;
        if (!all[i].passed()) ++tally.missed;
    }
}

void print(const std::string& half, const std::vector<Tally>& tallies) {
    if (tallies.empty()) return;
    std::cout << format("\n%s: %zu bodies\n  %-28s%10s%10s%8s\n", half.c_str(), tallies[0].bodies,
                        "", "mean", "worst", "missed");
    for (const Tally& tally : tallies)
        std::cout << format("  %-28s%10.4f%10.4f%8zu\n", tally.name.c_str(),
                            tally.sum / static_cast<double>(tally.bodies), tally.worst,
                            tally.missed);
}

bool isWanted(const std::string& name, const std::vector<std::string>& only) {
    return only.empty() || std::any_of(only.begin(), only.end(), [&](const std::string& part) {
               return name.find(part) != std::string::npos;
           });
}

/// Calls `take` with each selected body.
template <typename Take>
void forEachBody(const Options& options, Take take) {
    const PaintedBody neutral = sharedBody("neutral"), male = sharedBody("male");
    for (const Variation& variation : variations(neutral, male)) {
        if (!isWanted(variation.name, options.only)) continue;
        if (options.half == (variation.heldOut ? "tuned" : "held-out")) continue;
        PaintedBody body = variation.make();
        body.name = variation.name;
        const Subject subject = makeSubject(std::move(body));
        take(variation, subject, standardPoses(options.motions, subject));
    }
}

void runShapes(const Options& options) {
    std::size_t bodies = 0, missing = 0, poseCount = 0, worse = 0;
    std::cout << format("%-36s%18s%18s%18s%8s  %s\n", options.shapes.c_str(), "pairs, plain; now",
                        "99.9 %, plain; now", "volume", "bytes", "poses over 2 % + 2 pairs");
    forEachBody(options, [&](const Variation& variation, const Subject& subject,
                             const std::vector<NamedPose>& poses) {
        const ShapeFigures figures = measureShapes(subject, poses, options.shapes);
        const PoseFigures &plain = figures.clips.plain, &now = figures.clips.shaped;
        std::cout << format("%-36s%10.2f%8.2f%10.3f%8.3f%10.4f%8.4f%8.1f  %zu",
                            variation.name.c_str(), plain.intersections, now.intersections,
                            plain.percentile999, now.percentile999, plain.volumeError,
                            now.volumeError, figures.bytesPerVertex,
                            figures.clips.worsePoses.size());
        for (const std::string& pose : figures.clips.worsePoses) std::cout << "; " << pose;
        std::cout << std::endl;
        ++bodies;
        poseCount += poses.size();
        worse += figures.clips.worsePoses.size();
        if (!figures.clips.worsePoses.empty()) ++missing;
    });
    std::cout << format("\n%zu of %zu bodies' poses are over in %zu of %zu\n", missing, bodies,
                        worse, poseCount);
}

void run(const Options& options) {
    std::vector<Tally> tuned, heldOut;
    std::cout << format("%-36s%8s%8s%8s%8s%8s  %s\n", "", "/DQS", "/LBS", "99.9 %", "longest",
                        "volume", "bars missed");
    forEachBody(options, [&](const Variation& variation, const Subject& subject,
                             const std::vector<NamedPose>& poses) {
        const std::vector<Bar> all = bars(measure(subject, poses));
        std::cout << format("%-36s%8.3f%8.3f%8.3f%8.3f%8.4f ", variation.name.c_str(), all[0].value,
                            all[1].value, all[2].value, all[3].value, all[4].value);
        for (const Bar& bar : all)
            if (!bar.passed()) std::cout << format(" %s %.3f;", bar.name.c_str(), bar.value);
        std::cout << std::endl;
        count(all, variation.heldOut ? heldOut : tuned);
        const std::vector<WorstEdge> worst = worstEdges(subject, poses);
        for (std::size_t i = 0; i < std::min(options.worst, worst.size()); ++i)
            std::cout << "  " << lineOf(subject, worst[i]) << '\n';
    });
    print("tuned", tuned);
    print("held out", heldOut);
}

} // namespace

int main(int argc, char** argv) {
    example::CommandLine line(
        "osgskin_variations",
        "Measures bodies made of the two shared ones, beside linear blending and dual "
        "quaternions with painted weights");
    Options options;
    define(line, options);
    return line.run(argc, argv, [&] {
        line.parse(argc, argv);
        options.shapes.empty() ? run(options) : runShapes(options);
        return 0;
    });
}
