// SPDX-License-Identifier: GPL-3.0-or-later
#include "RiggerFigures.h"

#include "DemandingPoses.h"
#include "Report.h"
#include "SkinFigures.h"

#include <osgSkinBind/Bind>
#include <osgSkinCharacter/ReadWeights>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numeric>

namespace quality {
namespace {

const glm::dvec3 kRight(1.0, 0.0, 0.0), kFront(0.0, 0.0, 1.0);

using VertexShares = std::vector<double>; ///< [vertex]
using osgSkin::BindOptions;

/// The weight that painters (or bone heat) give to a joint and all its descendants.
VertexShares weightsBelow(const Subject& subject, int joint) {
    VertexShares result(subject.rest.size(), 0.0);
    for (std::size_t v = 0; v < result.size(); ++v)
        for (std::uint32_t i = subject.weights.first[v]; i < subject.weights.first[v + 1]; ++i)
            if (subject.rig.isInSubtree(static_cast<int>(subject.weights.entries[i].joint), joint))
                result[v] += subject.weights.entries[i].weight;
    return result;
}

/// How far a skin's vertices follow a joint.
VertexShares ratiosOf(const MeasuredSkin& skin, int joint) {
    if (skin.method != Method::Ours) return weightsBelow(skin.subject, joint);
    const osgSkin::Binding& binding = skin.subject.binding;
    VertexShares result(skin.subject.rest.size(), 0.0);
    for (std::size_t v = 0; v < result.size(); ++v)
        for (std::uint32_t i = binding.firstInfluence[v]; i < binding.firstInfluence[v + 1]; ++i)
            if (binding.joints[binding.influences[i].joint].name ==
                skin.subject.rig.joints[static_cast<std::size_t>(joint)].name)
                result[v] = static_cast<double>(binding.influences[i].bend);
    return result;
}

compare::Points deformed(const MeasuredSkin& skin, const BodyPose& pose) {
    return deform(skin.subject, skin.method, pose.skinning());
}

double percentile(std::vector<double> values, double share) {
    std::sort(values.begin(), values.end());
    const double at = share * static_cast<double>(values.size() - 1);
    const auto low = static_cast<std::size_t>(at);
    return glm::mix(values[low], values[std::min(low + 1, values.size() - 1)],
                    at - static_cast<double>(low));
}

double rms(const std::vector<double>& values) {
    const double sum = std::inner_product(values.begin(), values.end(), values.begin(), 0.0);
    return std::sqrt(sum / static_cast<double>(values.size()));
}

int headOf(const osgSkin::RestSkeleton& rig) {
    for (const char* name : {"Head", "head"})
        if (const int found = rig.find(name); found >= 0) return found;
    return -1;
}

void measureOwnership(const MeasuredSkin& skin, const std::vector<VertexShares>& painted,
                      RiggerFigures& figures) {
    constexpr std::ptrdiff_t kMinVertices = 20; // of a joint that counts
    const std::size_t count = skin.subject.rest.size();
    const int head = headOf(skin.subject.rig);
    std::vector<bool> inside(count, false), outside(count, false);
    for (std::size_t j = 0; j < painted.size(); ++j) {
        const VertexShares& wanted = painted[j];
        const VertexShares ratios = ratiosOf(skin, static_cast<int>(j));
        const bool isHead = static_cast<int>(j) == head;
        const bool isThere =
            std::any_of(ratios.begin(), ratios.end(), [](double a) { return a > 0.0; }) &&
            std::count_if(wanted.begin(), wanted.end(), [](double w) { return w > 0.99; }) >=
                kMinVertices;
        std::size_t missing = 0, own = 0, whole = 0;
        for (std::size_t v = 0; v < count; ++v) {
            const bool isOwn = wanted[v] > 0.99;
            if (isOwn) ++own;
            if (isOwn && ratios[v] > 0.999) ++whole;
            if (!isThere && !isHead) continue;
            if (isOwn && ratios[v] < 0.9) {
                inside[v] = true;
                ++missing;
            }
            if (isThere && wanted[v] < 0.01 && ratios[v] > 0.1) outside[v] = true;
        }
        if (isHead && own > 0)
            figures.headWhole = static_cast<double>(whole) / static_cast<double>(own);
        if (missing > figures.worstCount) {
            figures.worstCount = missing;
            figures.worstJoint = skin.subject.rig.joints[j].name;
        }
    }
    const auto percentOf = [&](const std::vector<bool>& which) {
        return 100.0 * static_cast<double>(std::count(which.begin(), which.end(), true)) /
               static_cast<double>(count);
    };
    figures.inside = percentOf(inside);
    figures.outside = percentOf(outside);
}

/// Area of a skin's cross-section of a bone, in the joint's own frame. `matrix` is the joint's G_j,
/// `region` the vertices that take part, `along` the share of the bone's length from the joint.
double sectionArea(const Subject& subject, const compare::Points& posed, const glm::dmat4& matrix,
                   int joint, const std::vector<bool>& region, double along) {
    const glm::dvec3& centre = subject.rig.joints[static_cast<std::size_t>(joint)].centre;
    const int child = firstChild(subject.rig, joint);
    const glm::dvec3 bone = subject.rig.joints[static_cast<std::size_t>(child)].centre - centre;
    const double length = glm::length(bone);
    const glm::dvec3 axis = bone / length;
    const glm::dvec3 u = glm::normalize(glm::cross(axis, kFront)), v = glm::cross(axis, u);
    const glm::dmat4 back = glm::inverse(matrix);
    const auto local = [&](std::uint32_t i) {
        return glm::dvec3(back * glm::dvec4(posed[i], 1.0)) - centre;
    };
    std::vector<glm::dvec2> cut;
    for (const compare::Edge& edge : subject.edges) {
        if (!region[edge[0]] || !region[edge[1]]) continue;
        const glm::dvec3 a = local(edge[0]), b = local(edge[1]);
        const double from = glm::dot(a, axis) - along * length;
        const double to = glm::dot(b, axis) - along * length;
        if (!(from * to < 0.0)) continue;
        const glm::dvec3 x = glm::mix(a, b, from / (from - to));
        cut.emplace_back(glm::dot(x, u), glm::dot(x, v));
    }
    // Sorted by their angle about the bone.
    std::sort(cut.begin(), cut.end(), [](const glm::dvec2& a, const glm::dvec2& b) {
        return std::atan2(a.y, a.x) < std::atan2(b.y, b.x);
    });
    double area = 0.0;
    for (std::size_t i = 0; i < cut.size(); ++i) {
        const glm::dvec2& a = cut[i];
        const glm::dvec2& b = cut[(i + 1) % cut.size()];
        area += 0.5 * (a.x * b.y - a.y * b.x);
    }
    return std::abs(area);
}

std::optional<double> leastSection(const MeasuredSkin& skin,
                                   const std::vector<VertexShares>& painted,
                                   const std::string& name) {
    const Subject& subject = skin.subject;
    const int joint = subject.rig.find(name);
    if (joint < 0) return std::nullopt;
    std::vector<bool> region;
    for (const double w : painted[static_cast<std::size_t>(joint)]) region.push_back(w > 0.5);
    const glm::dmat4 unit(1.0);
    double least = 1e9;
    for (const double flexion : {60.0, 90.0, 120.0, 140.0}) {
        const BodyPose pose = BodyPose(subject.rig).flex(name, flexion);
        const compare::Points posed = deformed(skin, pose);
        const glm::dmat4 matrix = pose.skinning()[static_cast<std::size_t>(joint)];
        for (const double along : {0.15, 0.25, 0.4})
            least =
                std::min(least, sectionArea(subject, posed, matrix, joint, region, along) /
                                    sectionArea(subject, subject.rest, unit, joint, region, along));
    }
    return least;
}

/// Intersecting pairs of triangles without common vertices, all of whose vertices are in `near`.
std::size_t pairsNear(SelfIntersections& intersections, const Subject& subject,
                      const compare::Points& posed, const std::vector<bool>& near) {
    const auto corner = [&](std::size_t t, std::size_t k) { return subject.triangles[3 * t + k]; };
    const auto isNear = [&](std::size_t t) {
        return near[corner(t, 0)] && near[corner(t, 1)] && near[corner(t, 2)];
    };
    std::size_t count = 0;
    for (const auto& [a, b] : intersections.pairs(posed)) {
        bool shared = false;
        for (std::size_t i = 0; i < 9; ++i) shared = shared || corner(a, i / 3) == corner(b, i % 3);
        if (!shared && isNear(a) && isNear(b)) ++count;
    }
    return count;
}

std::optional<std::size_t> worstFold(const MeasuredSkin& skin, const Subject& painted,
                                     SelfIntersections& intersections, const std::string& name,
                                     const std::string& upper) {
    const Subject& subject = skin.subject;
    const int joint = subject.rig.find(name), above = subject.rig.find(upper);
    if (joint < 0 || above < 0) return std::nullopt;
    const auto centre = [&](int j) {
        return subject.rig.joints[static_cast<std::size_t>(j)].centre;
    };
    const double length =
        std::min(glm::distance(centre(joint), centre(firstChild(subject.rig, joint))),
                 glm::distance(centre(joint), centre(above)));
    std::vector<bool> near;
    for (std::size_t v = 0; v < subject.rest.size(); ++v) {
        double own = 0.0;
        for (std::uint32_t i = painted.weights.first[v]; i < painted.weights.first[v + 1]; ++i)
            if (const int j = static_cast<int>(painted.weights.entries[i].joint);
                j == joint || j == above)
                own += painted.weights.entries[i].weight;
        near.push_back(own > 0.5 && glm::distance(subject.rest[v], centre(joint)) < 0.9 * length);
    }
    const std::size_t atRest = pairsNear(intersections, subject, subject.rest, near);
    std::size_t worst = 0;
    for (const double flexion : {120.0, 132.0, 140.0})
        for (const double turned : {-20.0, -10.0, 0.0, 10.0, 20.0}) {
            BodyPose pose(subject.rig);
            pose.flex(name, flexion).rotate(name, pose.bone(upper), turned).twist(name, -turned);
            const std::size_t pairs = pairsNear(intersections, subject, deformed(skin, pose), near);
            worst = std::max(worst, pairs > atRest ? pairs - atRest : 0);
        }
    return worst;
}

std::optional<double> clavicleVolume(const MeasuredSkin& skin) {
    const Subject& subject = skin.subject;
    if (subject.rig.find("LeftShoulder") < 0) return std::nullopt;
    BodyPose pose(subject.rig);
    pose.rotate("LeftShoulder", kFront, 30.0).rotate("RightShoulder", kFront, -30.0);
    const double volume = compare::enclosedVolume(deformed(skin, pose), subject.triangles);
    return 100.0 * (volume / compare::enclosedVolume(subject.rest, subject.triangles) - 1.0);
}

void measureSitting(const MeasuredSkin& skin, const Subject& painted, RiggerFigures& figures) {
    const Subject& subject = skin.subject;
    std::vector<bool> trunk(subject.rig.joints.size(), false);
    for (const char* name : {"Hips", "LowerBack", "Spine", "Spine1", "LHipJoint", "RHipJoint"})
        if (const int j = subject.rig.find(name); j >= 0) trunk[static_cast<std::size_t>(j)] = true;
    if (subject.rig.find("LeftUpLeg") < 0) return;
    const compare::Points posed = deformed(skin, sittingPose(subject.rig));
    double low = 1e18, high = -1e18;
    for (const glm::dvec3& p : subject.rest) {
        low = std::min(low, p.y);
        high = std::max(high, p.y);
    }
    std::vector<double> moves;
    for (std::size_t v = 0; v < subject.rest.size(); ++v) {
        double own = 0.0;
        for (std::uint32_t i = painted.weights.first[v]; i < painted.weights.first[v + 1]; ++i)
            if (trunk[painted.weights.entries[i].joint]) own += painted.weights.entries[i].weight;
        if (own > 0.999)
            moves.push_back(100.0 * glm::distance(posed[v], subject.rest[v]) / (high - low));
    }
    if (moves.empty()) return;
    figures.sitRms = rms(moves);
    figures.sit99 = percentile(moves, 0.99);
}

/// All fingers of both hands curled.
BodyPose fistPose(const osgSkin::RestSkeleton& rig) {
    BodyPose pose(rig);
    const auto at = [&](const std::string& name) {
        return rig.joints[static_cast<std::size_t>(rig.find(name))].centre;
    };
    for (const std::string side : {"_l", "_r"}) {
        const glm::dvec3 wrist = at("hand" + side);
        // Out of the palm, on the thumb's side.
        glm::dvec3 palm = glm::normalize(
            glm::cross(at("index_01" + side) - wrist, at("pinky_01" + side) - wrist));
        if (glm::dot(at("thumb_03" + side) - wrist, palm) < 0.0) palm = -palm;
        for (const std::string finger : {"index", "middle", "ring", "pinky", "thumb"}) {
            const bool thumb = finger == "thumb";
            const double degrees[3] = {thumb ? 15.0 : 80.0, thumb ? 35.0 : 95.0,
                                       thumb ? 50.0 : 65.0};
            const glm::dvec3 first = pose.bone(finger + "_01" + side);
            const glm::dvec3 across =
                glm::cross(first, thumb ? pose.bone(finger + "_03" + side) : palm);
            for (int i = 0; i < 3; ++i)
                pose.rotate(finger + "_0" + std::to_string(i + 1) + side, across, degrees[i]);
        }
    }
    return pose;
}

} // namespace

std::optional<double> measureFist(const MeasuredSkin& skin) {
    const Subject& subject = skin.subject;
    if (subject.rig.find("index_01_l") < 0 || subject.rig.find("thumb_03_r") < 0)
        return std::nullopt;
    const BodyPose pose = fistPose(subject.rig);
    const std::vector<glm::dmat4> skinning = pose.skinning();
    const compare::Points posed = deformed(skin, pose);
    const auto centre = [&](const char* name) {
        return subject.rig.joints[static_cast<std::size_t>(subject.rig.find(name))].centre;
    };
    const double hand = glm::distance(centre("middle_03_l"), centre("hand_l"));
    std::optional<double> worst;
    for (const std::string finger : {"index", "middle", "ring", "pinky"}) {
        const auto joint = static_cast<std::uint32_t>(subject.rig.find(finger + "_03_l"));
        std::vector<double> distances;
        for (std::size_t v = 0; v < subject.rest.size(); ++v) {
            double own = 0.0;
            for (std::uint32_t i = subject.weights.first[v]; i < subject.weights.first[v + 1]; ++i)
                if (subject.weights.entries[i].joint == joint)
                    own += subject.weights.entries[i].weight;
            if (own > 0.99)
                distances.push_back(glm::distance(
                    posed[v], glm::dvec3(skinning[joint] * glm::dvec4(subject.rest[v], 1.0))));
        }
        if (distances.size() < 4) continue;
        worst = std::max(worst.value_or(0.0), rms(distances) / hand);
    }
    return worst;
}

std::vector<MeasuredSkin> makeSkins(const SubjectFiles& files, const std::string& heat) {
    const PaintedBody body = loadBody(files.body, files.rig, files.weights);
    const auto bound = [&](BindOptions::Shapes shapes) {
        Subject subject = makeSubject(body, files.ratios);
        if (!subject.options) return subject; // bound by weights
        subject.options->shapes = shapes;
        subject.binding =
            osgSkin::bind(subject.mesh, subject.rig, *subject.options, &subject.report);
        subject.model = modelOf(subject);
        return subject;
    };
    const Subject plain = bound(BindOptions::Shapes::None);
    std::vector<MeasuredSkin> skins{{"LBS painted", plain, Method::Linear},
                                    {"DQS painted", plain, Method::DualQuaternion}};
    if (std::filesystem::exists(heat)) {
        PaintedBody heated = body;
        heated.painted = osgSkin::readWeights(heat, heated.rig, heated.mesh.positions.size());
        const Subject subject = makeSubject(heated, Ratios::Painted);
        skins.push_back({"LBS heat", subject, Method::Linear});
        skins.push_back({"DQS heat", subject, Method::DualQuaternion});
    }
    skins.push_back({"paper", plain, Method::Ours});
    skins.push_back({"fast", bound(BindOptions::Shapes::Fast), Method::Ours});
    return skins;
}

std::vector<RiggerFigures> measureRigger(const std::vector<MeasuredSkin>& skins,
                                         const std::vector<NamedPose>& clips) {
    const Subject& painted = skins.front().subject;
    std::vector<VertexShares> weights;
    for (std::size_t j = 0; j < painted.rig.joints.size(); ++j)
        weights.push_back(weightsBelow(painted, static_cast<int>(j)));
    SelfIntersections intersections(painted);
    std::vector<RiggerFigures> result;
    for (const MeasuredSkin& skin : skins) {
        RiggerFigures& figures = result.emplace_back();
        figures.skin = skin.name;
        measureOwnership(skin, weights, figures);
        figures.shinArea = leastSection(skin, weights, "LeftLeg");
        figures.forearmArea = leastSection(skin, weights, "LeftForeArm");
        figures.kneeFolds = worstFold(skin, painted, intersections, "LeftLeg", "LeftUpLeg");
        figures.elbowFolds = worstFold(skin, painted, intersections, "LeftForeArm", "LeftArm");
        figures.clavicleVolume = clavicleVolume(skin);
        figures.fist = measureFist(skin);
        measureSitting(skin, painted, figures);
        for (const NamedPose& pose : clips)
            figures.clipPairs += static_cast<double>(intersections.beyondRest(
                                     deform(skin.subject, skin.method, pose.skinning))) /
                                 static_cast<double>(clips.size());
    }
    return result;
}

void printTable(const std::string& body, const std::vector<RiggerFigures>& skins,
                std::ostream& out) {
    out << format("%s, as a rigger sees it\n  %-28s", body.c_str(), "");
    for (const RiggerFigures& skin : skins) out << format("%12s", skin.skin.c_str());
    out << '\n';
    const auto row = [&](const char* name, const auto& text) {
        out << format("  %-28s", name);
        for (const RiggerFigures& skin : skins) out << format("%12s", text(skin).c_str());
        out << '\n';
    };
    const auto number = [](const auto& figure, const char* pattern) {
        return figure ? format(pattern, static_cast<double>(*figure)) : std::string("-");
    };
    row("head that follows wholly", [&](const auto& s) { return number(s.headWhole, "%.3f"); });
    row("inside, %", [&](const auto& s) { return format("%.2f", s.inside); });
    row("  most of them", [&](const auto& s) { return format("%.11s", s.worstJoint.c_str()); });
    row("outside, %", [&](const auto& s) { return format("%.2f", s.outside); });
    row("least section: shin", [&](const auto& s) { return number(s.shinArea, "%.3f"); });
    row("  forearm", [&](const auto& s) { return number(s.forearmArea, "%.3f"); });
    row("folds off the axis: knee", [&](const auto& s) { return number(s.kneeFolds, "%.0f"); });
    row("  elbow", [&](const auto& s) { return number(s.elbowFolds, "%.0f"); });
    row("clavicles raised: volume, %",
        [&](const auto& s) { return number(s.clavicleVolume, "%+.2f"); });
    row("fist", [&](const auto& s) { return number(s.fist, "%.3f"); });
    row("sitting: trunk, RMS, %", [&](const auto& s) { return number(s.sitRms, "%.3f"); });
    row("  99th percentile, %", [&](const auto& s) { return number(s.sit99, "%.2f"); });
    row("pairs in clips, mean", [&](const auto& s) { return format("%.1f", s.clipPairs); });
    out << '\n';
}

nlohmann::ordered_json toJson(const RiggerFigures& figures) {
    nlohmann::ordered_json json = {{"skin", figures.skin},
                                   {"inside", figures.inside},
                                   {"outside", figures.outside},
                                   {"worstJoint", figures.worstJoint},
                                   {"worstJointVertices", figures.worstCount},
                                   {"clipPairs", figures.clipPairs}};
    const auto add = [&](const char* name, const auto& figure) {
        if (figure) json[name] = *figure;
    };
    add("headWhole", figures.headWhole);
    add("shinArea", figures.shinArea);
    add("forearmArea", figures.forearmArea);
    add("kneeFolds", figures.kneeFolds);
    add("elbowFolds", figures.elbowFolds);
    add("clavicleVolume", figures.clavicleVolume);
    add("fist", figures.fist);
    add("sitRms", figures.sitRms);
    add("sit99", figures.sit99);
    return json;
}

} // namespace quality
