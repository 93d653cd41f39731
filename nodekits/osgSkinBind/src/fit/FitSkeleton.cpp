// SPDX-License-Identifier: GPL-3.0-or-later
#include <osgSkinBind/FitSkeleton>

#include "fit/Shells.h"
#include "fit/place/CheckProportions.h"
#include "fit/place/PlaceArm.h"
#include "fit/place/PlaceHand.h"
#include "fit/place/PlaceLeg.h"
#include "fit/place/PlaceTrunk.h"
#include "fit/place/PushInside.h"
#include "fit/place/Symmetrise.h"
#include "mesh/WeldedMesh.h"

#include <osgSkin/Error>
#include <osgSkin/GlmTypes>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <osgSkinRig/JointRoles>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <optional>

namespace osgSkin {
namespace {

/// Fractions of the time that have passed when the steps begin.
constexpr double kFacingBegins = 0.85;
constexpr double kJointsBegin = 0.95;

/// A measured surface with so much of the mesh's extents that is no odder is a person, and no other
/// is tried; a shell smaller than this is none.
constexpr double kReaches = 0.88;
constexpr double kPerson = 0.10;
constexpr double kHardlyAll = 0.6;

bool isDirection(const glm::dvec3& d) {
    constexpr double longest = 1e18; // as coordinates may be
    const double length = glm::length(d);
    return length <= longest && length >= 1.0 / longest; // false for NaN
}

/// The landmarks by the names that a fitted skeleton has; those that are not known stay.
std::map<std::string, glm::dvec3> renamed(const std::map<std::string, glm::dvec3>& landmarks) {
    std::vector<std::string> names;
    names.reserve(landmarks.size());
    for (const auto& [name, centre] : landmarks) names.push_back(name);
    const std::map<std::string, std::string> known = fittedNamesOf(names);
    std::map<std::string, glm::dvec3> result;
    for (const auto& [name, centre] : landmarks) {
        const auto found = known.find(name);
        const std::string& own = found == known.end() ? name : found->second;
        if (!result.emplace(own, centre).second)
            throw Error("cannot fit a skeleton: landmark " + name + ": expected one for " + own);
    }
    return result;
}

/// How far a point lies outside the box around a mesh.
double outside(const glm::dvec3& point, const SkinMesh& mesh) {
    glm::dvec3 low = mesh.positions.front(), high = low;
    for (const glm::dvec3& p : mesh.positions) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    const glm::dvec3 beyond = glm::max(glm::max(low - point, point - high), glm::dvec3(0.0));
    return glm::length(beyond);
}

void check(const FitOptions& options, const SkinMesh& mesh) {
    if (!isDirection(options.up))
        throw Error("cannot fit a skeleton: expected an up axis with a length");
    if (options.facing && !isDirection(*options.facing))
        throw Error("cannot fit a skeleton: expected a facing with a length");
    const std::vector<std::string>& names = fittedJointNames();
    for (const auto& [name, centre] : options.landmarks) {
        if (std::find(names.begin(), names.end(), name) == names.end())
            throw Error("cannot fit a skeleton: landmark " + name +
                        ": expected the name of a CMU joint, such as LeftHand or Head");
        if (!isFinite(centre))
            throw Error("cannot fit a skeleton: landmark " + name +
                        ": expected finite coordinates");
        if (!(outside(centre, mesh) <= mesh.size()))
            throw Error(
                "cannot fit a skeleton: landmark " + name +
                ": expected a place in the body, found one further from it than it is long");
    }
}

/// Whether landmarks give a limb's ends, on one side at least.
bool areGiven(const FitOptions& options, const char* from, const char* to) {
    for (const std::string side : {"Left", "Right"})
        if (options.landmarks.count(side + from) > 0 && options.landmarks.count(side + to) > 0)
            return true;
    return false;
}

/// From the body's right to its left, as far as landmarks tell.
std::optional<glm::dvec3> leftOf(const FitOptions& options, const FitBody& body) {
    glm::dvec3 sum(0.0);
    const glm::dvec3 middle = body.toRest(body.branches.trunk.back());
    for (const auto& [name, centre] : options.landmarks) {
        if (mirroredName(name) == name) continue;
        sum += name[0] == 'L' ? centre - middle : middle - centre;
    }
    sum -= glm::dot(sum, options.up) / glm::dot(options.up, options.up) * options.up;
    if (glm::length(sum) < 0.03 * body.height()) return std::nullopt;
    return sum;
}

void requireLimb(const BodyBranches::Path& path, const PlacedJoints& placed,
                 std::initializer_list<std::string> names) {
    for (const std::string& name : names)
        if (path.empty() && !placed.has(name))
            throw Error("cannot fit a skeleton: " + name +
                        " cannot be told from the rest of the body; give a landmark for it");
}

void placeJoints(const FitBody& body, PlacedJoints& placed, std::vector<std::string>& notes) {
    if (body.isSymmetric()) mirrorLandmarks(placed);
    for (const std::size_t side : {0u, 1u}) {
        const std::string& prefix = sidePrefix(side);
        requireLimb(body.branches.legs[side], placed, {prefix + "UpLeg", prefix + "Foot"});
        requireLimb(body.branches.arms[side], placed, {prefix + "Arm", prefix + "Hand"});
        placeLeg(body, side, placed);
    }
    placeTrunk(body, placed);
    for (const std::size_t side : {0u, 1u}) {
        placeArm(body, side, placed);
        placeHand(body, side, placed);
    }
    if (body.isSymmetric()) symmetrise(placed);
    checkProportions(placed);
    pushInside(body, placed, notes);
}

struct Fitted {
    RestSkeleton skeleton;
    FitReport report;
    double odd = 0.0;   ///< oddity()
    double reach = 0.0; ///< least share of the mesh's main extents that the measured surface has
};

RestSkeleton skeletonOf(const FitBody& body, PlacedJoints& placed, FitReport& report) {
    RestSkeleton skeleton;
    for (const FittedJoint& joint : fittedTree()) {
        const PlacedJoints::Entry& entry = placed.entries().at(joint.name);
        RestJoint& added = skeleton.joints.emplace_back();
        added.name = joint.name;
        added.parent = joint.parent;
        added.centre = body.toRest(entry.centre);
        if (entry.tip) added.tip = body.toRest(*entry.tip);
        report.joints.push_back({joint.name, entry.how, entry.pushed});
    }
    skeleton.validate();
    return skeleton;
}

/// Thin extents do not count: a nose, a bag.
double reachOf(const FitBody& body, const WeldedMesh& mesh) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    glm::dvec3 low(kInfinity), high(-kInfinity), wholeLow(kInfinity), wholeHigh(-kInfinity);
    for (const glm::dvec3& p : body.surface.points()) {
        low = glm::min(low, body.toRest(p));
        high = glm::max(high, body.toRest(p));
    }
    for (const auto& t : mesh.triangles)
        for (const std::uint32_t v : t) {
            wholeLow = glm::min(wholeLow, mesh.positions[v]);
            wholeHigh = glm::max(wholeHigh, mesh.positions[v]);
        }
    const glm::dvec3 own = high - low, whole = wholeHigh - wholeLow;
    double reach = 1.0;
    for (int axis = 0; axis < 3; ++axis)
        if (2.0 * whole[axis] > std::max({whole.x, whole.y, whole.z}))
            reach = std::min(reach, own[axis] / whole[axis]);
    return reach;
}

/// \param mesh the body
/// \param filled what all its shells fill; null to measure the largest one
/// \param options names of landmarks are the fit's own
/// \throw Error where that surface is no body's
Fitted fitTo(const WeldedMesh& mesh, const fit::SolidGrid* filled, const FitOptions& options) {
    const auto tell = [&options](const char* what, double fraction) {
        if (options.progress) options.progress({what, fraction});
    };
    Fitted found;
    FitReport& report = found.report;
    tell("surface", 0.0);
    FitBody body(mesh, filled, options, areGiven(options, "UpLeg", "Foot"),
                 areGiven(options, "Arm", "Hand"), report.notes);
    tell("facing", kFacingBegins);
    report.facing = body.face(options.facing, leftOf(options, body));
    if (report.facing == "assumed")
        report.notes.push_back("feet, face and elbows do not tell where the body faces: give a "
                               "facing if left and right are exchanged");
    report.height = body.height();
    report.symmetryError = body.symmetryError;

    PlacedJoints placed;
    for (const auto& [name, centre] : options.landmarks)
        placed.addLandmark(name, body.toBody(centre));
    tell("joints", kJointsBegin);
    placeJoints(body, placed, report.notes);
    found.odd = oddity(placed);
    found.reach = reachOf(body, mesh);
    found.skeleton = skeletonOf(body, placed, report);
    return found;
}

/// The largest shell is the body where it looks like one and reaches as far as all do: eyes, teeth
/// and buttons are others. Else it may be a body in clothes, or clothes with a body in them, or one
/// of a mannequin's parts: what looks most like a person is.
Fitted fitBest(const WeldedMesh& mesh, const FitOptions& options) {
    if (isOneSkin(mesh)) return fitTo(mesh, nullptr, options);
    std::optional<Fitted> best;
    if (largestShellShare(mesh) > kHardlyAll) {
        try {
            best = fitTo(mesh, nullptr, options);
        } catch (const Error&) {
            // The union's complaint says more.
        }
        if (best && best->reach > kReaches && best->odd < kPerson) return *best;
    }
    try {
        const fit::SolidGrid filled = filledByAll(mesh);
        Fitted whole = fitTo(mesh, &filled, options);
        if (!best || whole.odd < best->odd) return whole;
    } catch (const Error& error) {
        if (!best) throw Error(error.what() + ("; " + describeShells(mesh)));
    }
    return *best;
}

} // namespace

RestSkeleton fitSkeleton(const SkinMesh& mesh, const FitOptions& given, FitReport* report) {
    const auto start = std::chrono::steady_clock::now();
    mesh.validate();
    FitOptions options = given;
    options.landmarks = renamed(given.landmarks);
    check(options, mesh);
    const WeldedMesh skin(mesh);
    requireSurface(skin);
    Fitted found = fitBest(skin, options);
    found.report.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (report) *report = found.report;
    if (options.progress) options.progress({"done", 1.0});
    return found.skeleton;
}

const std::vector<std::string>& fittedJointNames() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> result;
        for (const FittedJoint& joint : fittedTree()) result.emplace_back(joint.name);
        return result;
    }();
    return names;
}

std::map<std::string, std::string> fittedNamesOf(const std::vector<std::string>& names) {
    static const std::map<std::string, std::string> ofRole = [] {
        std::map<std::string, std::string> result;
        const std::vector<std::string>& own = fittedJointNames();
        const std::vector<std::string> roles = recogniseNames(own);
        for (std::size_t j = 0; j < own.size(); ++j)
            if (!roles[j].empty()) result.emplace(roles[j], own[j]);
        return result;
    }();
    const std::vector<std::string>& fitted = fittedJointNames();
    const auto isOwn = [&](const std::string& name) {
        return std::find(fitted.begin(), fitted.end(), name) != fitted.end();
    };
    // "LeftShoulder" is a collar bone here, and an upper arm beside a "LeftCollar".
    const bool allOwn = std::all_of(names.begin(), names.end(), isOwn);
    const std::vector<std::string> roles = recogniseNames(names);
    std::map<std::string, std::string> result;
    for (std::size_t n = 0; n < names.size(); ++n) {
        const auto found = ofRole.find(roles[n]);
        // Of the several joints of a spine or neck, another's name does not tell which.
        const bool told = found != ofRole.end() && roles[n] != "Spine" && roles[n] != "Neck";
        if (told && !allOwn)
            result[names[n]] = found->second;
        else if (isOwn(names[n]))
            result[names[n]] = names[n];
    }
    return result;
}

} // namespace osgSkin
