// SPDX-License-Identifier: GPL-3.0-or-later
#include <osgSkinBind/FitSkeleton>

#include "fit/place/CheckProportions.h"
#include "fit/place/PlaceArm.h"
#include "fit/place/PlaceHand.h"
#include "fit/place/PlaceLeg.h"
#include "fit/place/PlaceTrunk.h"
#include "fit/place/PushInside.h"
#include "fit/place/Symmetrise.h"

#include <osgSkin/Error>
#include <osgSkin/GlmTypes>

#include <glm/geometric.hpp>

#include <osgSkinRig/JointRoles>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <initializer_list>

namespace osgSkin {
namespace {

/// Fractions of the time that have passed when the steps begin.
constexpr double kFacingBegins = 0.85;
constexpr double kJointsBegin = 0.95;

bool isDirection(const glm::dvec3& d) {
    return isFinite(d) && glm::length(d) > 0.0;
}

/// The landmarks by the names that a fitted skeleton has; those that are not known stay.
std::map<std::string, glm::dvec3> renamed(const std::map<std::string, glm::dvec3>& landmarks) {
    std::vector<std::string> names;
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

void check(const FitOptions& options) {
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

} // namespace

RestSkeleton fitSkeleton(const SkinMesh& mesh, const FitOptions& given, FitReport* report) {
    const auto start = std::chrono::steady_clock::now();
    mesh.validate();
    FitOptions options = given;
    options.landmarks = renamed(given.landmarks);
    check(options);
    const auto tell = [&options](const char* what, double fraction) {
        if (options.progress) options.progress({what, fraction});
    };
    FitReport found;
    tell("surface", 0.0);
    FitBody body(WeldedMesh(mesh), options, areGiven(options, "UpLeg", "Foot"),
                 areGiven(options, "Arm", "Hand"), found.notes);
    tell("facing", kFacingBegins);
    found.facing = body.face(options.facing, leftOf(options, body));
    if (found.facing == "assumed")
        found.notes.push_back("feet, face and elbows do not tell where the body faces: give a "
                              "facing if left and right are exchanged");
    found.height = body.height();
    found.symmetryError = body.symmetryError;

    PlacedJoints placed;
    for (const auto& [name, centre] : options.landmarks)
        placed.addLandmark(name, body.toBody(centre));
    tell("joints", kJointsBegin);
    placeJoints(body, placed, found.notes);
    RestSkeleton skeleton = skeletonOf(body, placed, found);
    found.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (report) *report = found;
    tell("done", 1.0);
    return skeleton;
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
