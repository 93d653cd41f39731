// SPDX-License-Identifier: GPL-3.0-or-later
#include "bind/RegionBinder.h"
#include "fit/PlaceJoints.h"
#include "fit/PlacedJoints.h"
#include "fit/Proportions.h"
#include "fit/body/FitBody.h"
#include "fit/body/SolidGrid.h"
#include "mesh/RequireSurface.h"
#include "mesh/WeldedMesh.h"

#include <osgSkin/Error>
#include <osgSkin/ExpectedNames>
#include <osgSkin/GlmTypes>
#include <osgSkinBind/FitSkeleton>
#include <osgSkinRig/JointRoles>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <initializer_list>
#include <iomanip>
#include <limits>
#include <numeric>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

namespace osgSkin {

namespace {

/// Cubes along the longest side; a person's wrist is four wide.
constexpr int kCells = 128;

struct Box {
    glm::dvec3 low{std::numeric_limits<double>::infinity()};
    glm::dvec3 high{-low};
    double area = 0.0;
    std::size_t triangles = 0;

    void add(const WeldedMesh& mesh, const std::array<std::uint32_t, 3>& t) {
        for (const std::uint32_t v : t) {
            low = glm::min(low, mesh.positions[v]);
            high = glm::max(high, mesh.positions[v]);
        }
        area += glm::length(glm::cross(mesh.positions[t[1]] - mesh.positions[t[0]],
                                       mesh.positions[t[2]] - mesh.positions[t[0]]));
        ++triangles;
    }
};

Box wholeBox(const WeldedMesh& mesh) {
    Box box;
    for (const auto& t : mesh.triangles) box.add(mesh, t);
    return box;
}

std::vector<Box> shellBoxes(const WeldedMesh& mesh) {
    std::vector<Box> boxes(mesh.shells);
    for (const auto& t : mesh.triangles) boxes[mesh.shellOf[t[0]]].add(mesh, t);
    return boxes;
}

double longest(const Box& box) {
    const glm::dvec3 extent = box.high - box.low;
    return std::max({extent.x, extent.y, extent.z});
}

/// Whether a mesh is a single shell without walls inside.
bool isOneSkin(const WeldedMesh& mesh) {
    if (mesh.shells > 1) return false;
    std::vector<std::array<std::uint32_t, 2>> edges;
    edges.reserve(3 * mesh.triangles.size());
    for (const auto& t : mesh.triangles)
        for (std::size_t k = 0; k < 3; ++k)
            edges.push_back({std::min(t[k], t[(k + 1) % 3]), std::max(t[k], t[(k + 1) % 3])});
    std::sort(edges.begin(), edges.end());
    for (std::size_t i = 2; i < edges.size(); ++i)
        if (edges[i] == edges[i - 2]) return false;
    return true;
}

/// The longest extent of the shell with the largest area over that of all.
double largestShellShare(const WeldedMesh& mesh) {
    if (mesh.triangles.empty()) return 1.0;
    const std::vector<Box> boxes = shellBoxes(mesh);
    const auto largest = std::max_element(
        boxes.begin(), boxes.end(), [](const Box& a, const Box& b) { return a.area < b.area; });
    return longest(*largest) / longest(wholeBox(mesh));
}

/// The volume inside any of the shells.
fit::SolidGrid filledByAll(const WeldedMesh& mesh) {
    const Box whole = wholeBox(mesh);
    fit::SolidGrid grid(whole.low, whole.high, kCells);
    for (const fit::ClosedShell& shell : fit::closedShells(mesh, mesh.triangles)) grid.add(shell);
    grid.fillPockets();
    return grid;
}

/// The largest shells with their sizes and positions, as part of a line.
std::string describeShells(const WeldedMesh& mesh) {
    const std::vector<Box> boxes = shellBoxes(mesh);
    std::vector<std::size_t> order(boxes.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return boxes[a].area > boxes[b].area; });
    constexpr std::size_t kNamed = 4;
    std::ostringstream out;
    out << "measured the union of " << boxes.size() << " shells:";
    for (std::size_t i = 0; i < std::min(kNamed, order.size()); ++i) {
        const Box& box = boxes[order[i]];
        const glm::dvec3 middle = 0.5 * (box.low + box.high), extent = box.high - box.low;
        out << (i > 0 ? ", " : " ") << "one of " << box.triangles << " triangles about ("
            << std::setprecision(3) << middle.x << ", " << middle.y << ", " << middle.z << "), "
            << extent.x << " x " << extent.y << " x " << extent.z << " large";
    }
    if (order.size() > kNamed) out << ", and " << order.size() - kNamed << " smaller ones";
    return out.str();
}

/// The least depth of a joint inside the skin, and how far outside a landmark may be, in heights.
constexpr double kDepth = 0.006;
constexpr double kFarOutside = 0.05;

bool isDeep(const FitBody& body, const glm::dvec3& p) {
    return body.surface.isInside(p) && glm::distance(body.surface.nearest(p), p) >= 0.5 * kDepth;
}

/// Moves a point inside the skin: straight in from the nearest point of the skin, as deep as the
/// body's thickness allows.
bool pushIn(const FitBody& body, glm::dvec3& p) {
    const glm::dvec3 skin = body.surface.nearest(p);
    glm::dvec3 in = body.surface.isInside(p) ? p - skin : skin - p;
    if (!(glm::length(in) > 1e-9)) return false;
    in = glm::normalize(in);
    for (double depth = kDepth; depth > 0.0005; depth *= 0.7) {
        const glm::dvec3 candidate = skin + depth * in;
        if (!body.surface.isInside(candidate)) continue;
        p = candidate;
        return true;
    }
    return false;
}

/// Moves joints that are outside or hardly inside the skin to the nearest position inside.
/// \throw Error if a landmark is far outside
void pushInside(const FitBody& body, PlacedJoints& placed, std::vector<std::string>& notes) {
    for (const FittedJoint& joint : fittedTree()) {
        PlacedJoints::Entry& entry = placed.entries().at(joint.name);
        const bool inside = body.surface.isInside(entry.centre);
        if (entry.isLandmark) {
            if (inside) continue;
            const double away = glm::distance(body.surface.nearest(entry.centre), entry.centre);
            if (away > kFarOutside)
                throw Error("cannot fit a skeleton: landmark " + std::string(joint.name) +
                            ": expected a point inside the skin, found one " +
                            std::to_string(away * body.height()) + " outside");
            notes.push_back("landmark " + std::string(joint.name) + " was outside the skin");
        }
        if (inside && isDeep(body, entry.centre)) continue;
        const glm::dvec3 before = entry.centre;
        if (!pushIn(body, entry.centre) && joint.parent >= 0) {
            // At a sharp edge: move towards the parent, which is inside.
            const glm::dvec3 parent =
                placed.at(fittedTree()[static_cast<std::size_t>(joint.parent)].name);
            for (int step = 1; step <= 32 && !body.surface.isInside(entry.centre); ++step)
                entry.centre = glm::mix(before, parent, step / 32.0);
        }
        if (!body.surface.isInside(entry.centre))
            throw Error("cannot fit a skeleton: found no position inside the skin for " +
                        std::string(joint.name));
        entry.pushed = entry.centre != before;
    }
}

/// Fractions of the whole time at which the steps begin.
constexpr double kFacingBegins = 0.85;
constexpr double kJointsBegin = 0.95;

/// A measured surface is a person if it has this share of the mesh's extents and no greater
/// oddity(); no other surface is tried then. A shell with less than kHardlyAll of the extents is
/// not measured.
constexpr double kReaches = 0.88;
constexpr double kPerson = 0.10;
constexpr double kHardlyAll = 0.6;

bool isDirection(const glm::dvec3& d) {
    constexpr double longest = 1e18; // as coordinates may be
    const double length = glm::length(d);
    return length <= longest && length >= 1.0 / longest; // false for NaN
}

/// The landmarks by the names of the fitted joints; unknown names stay.
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
            throw Error("cannot fit a skeleton: landmark " + name + " is not a CMU joint" +
                        expectedNames(name, names));
        if (!isFinite(centre))
            throw Error("cannot fit a skeleton: landmark " + name +
                        ": expected finite coordinates");
        if (!(outside(centre, mesh) <= mesh.size()))
            throw Error(
                "cannot fit a skeleton: landmark " + name +
                ": expected a point in the body, found one farther from it than its length");
    }
}

/// Whether landmarks give a limb's ends on one side at least.
bool areGiven(const FitOptions& options, const char* from, const char* to) {
    for (const std::string side : {"Left", "Right"})
        if (options.landmarks.count(side + from) > 0 && options.landmarks.count(side + to) > 0)
            return true;
    return false;
}

/// The direction from the body's right to its left, if landmarks show it.
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
            throw Error(
                "cannot fit a skeleton: " + name +
                " cannot be distinguished from the rest of the body; give a landmark for it");
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
    double reach = 0.0; ///< reachOf()
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

/// The measured surface's least share of the mesh's extents. Thin extents (a nose, a bag) are
/// ignored.
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

/// \param filled the volume inside all shells; null: the largest shell is measured
/// \param options with landmarks by the names of fitted joints
/// \throw Error if the surface is not a body's
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
        report.notes.push_back("feet, face and elbows do not show where the body faces: give a "
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

/// The largest shell is the body if it looks like one and extends as far as all shells: the others
/// are eyes, teeth and buttons. Otherwise it may be a body in clothes, clothes around a body, or a
/// part of a mannequin: then the surface that looks more like a person is taken.
Fitted fitBest(const WeldedMesh& mesh, const FitOptions& options) {
    if (isOneSkin(mesh)) return fitTo(mesh, nullptr, options);
    std::optional<Fitted> best;
    if (largestShellShare(mesh) > kHardlyAll) {
        try {
            best = fitTo(mesh, nullptr, options);
        } catch (const Error&) {
            // The error about the union of all shells says more.
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

RestSkeleton RegionBinder::fit(const SkinMesh& mesh, const FitOptions& given,
                               FitReport* report) const {
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

} // namespace osgSkin
