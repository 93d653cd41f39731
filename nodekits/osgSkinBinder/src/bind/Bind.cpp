// SPDX-License-Identifier: GPL-3.0-or-later
#include "bind/RegionBinder.h"

#include "bind/CheckOptions.h"
#include "correctives/AddShapes.h"
#include "garments/SkinLayers.h"
#include "joints/JointRegions.h"
#include "mesh/NearestPoints.h"
#include "mesh/RequireSurface.h"
#include "mesh/WeldedMesh.h"
#include "ratios/JointFields.h"
#include "ratios/PaperFields.h"
#include "ratios/RatioFields.h"
#include "regions/BinaryField.h"
#include "regions/Regions.h"

#include <osgSkin/Error>

#include <chrono>
#include <utility>

namespace osgSkin {
namespace {

/// Fractions of the total time at which steps begin, measured at 280,000 vertices.
constexpr double kRegionsBegin = 0.2;
constexpr double kBendsBegin = 0.8;
constexpr double kTwistsBegin = 0.96;
constexpr double kRatiosBegin = 0.98;
constexpr double kShapesBegin = 0.99;

/// For each vertex the one whose ratios it gets: itself, or the nearest vertex of the skin if no
/// face uses it.
std::vector<std::uint32_t> representatives(const WeldedMesh& mesh) {
    std::vector<std::uint32_t> result(mesh.vertexCount()), used, unused;
    for (std::uint32_t v = 0; v < result.size(); ++v) {
        result[v] = v;
        (mesh.shellOf[v] != WeldedMesh::kNoShell ? used : unused).push_back(v);
    }
    if (used.empty() || unused.empty()) return result;
    const std::vector<std::uint32_t> nearest = nearestPoints(mesh.positions, used, unused);
    for (std::size_t i = 0; i < unused.size(); ++i) result[unused[i]] = nearest[i];
    return result;
}

/// Adds each vertex's region and influences to a binding that has only joints. Frees the fields, as
/// those of long chains are large.
void addRatios(const WeldedMesh& mesh, const Regions& regions, JointFields&& bend,
               JointFields&& twist, std::size_t mostPartial, Binding& binding, BindReport& report) {
    const std::vector<std::uint32_t> shown = representatives(mesh);
    const VertexRatios ratios(bend, twist);
    bend = twist = {};
    binding.firstInfluence.push_back(0);
    std::size_t partial = 0;
    for (const std::uint32_t welded : mesh.weldedOf) {
        const std::uint32_t v = shown[welded];
        binding.regions.push_back(regions.jointOf[v]);
        if (packInfluences(ratios.of(v), mostPartial, binding.influences)) ++report.cappedVertices;
        for (std::size_t i = binding.firstInfluence.back(); i < binding.influences.size(); ++i)
            if (binding.influences[i].isFractional()) ++partial;
        binding.firstInfluence.push_back(static_cast<std::uint32_t>(binding.influences.size()));
    }
    report.influencesPerVertex =
        static_cast<double>(partial) / static_cast<double>(mesh.weldedOf.size());
}

/// A bone, or a chain of them, at least this long, over the mesh's size, is reported if its regions
/// are empty.
constexpr double kLimbSize = 0.08;

void reportRegions(const RestSkeleton& skeleton, const std::vector<PlannedJoint>& joints,
                   const Regions& regions, double size, BindReport& report) {
    std::vector<BindReport::Region> all(joints.size());
    for (std::size_t j = 0; j < joints.size(); ++j) {
        // A rigid joint's region includes the seeds of its descendants.
        const std::size_t owner =
            joints[j].rigid >= 0 ? static_cast<std::size_t>(joints[j].rigid) : j;
        all[owner].seeds += regions.seeds[j];
    }
    for (const std::uint32_t joint : regions.jointOf) ++all[joint].vertices;
    std::vector<double> bare(joints.size(), 0.0); // length of a chain without skin, from its top
    for (std::size_t j = 0; j < joints.size(); ++j) {
        if (!joints[j].holdsRegion() && all[j].vertices == 0) continue;
        all[j].joint = skeleton.joints[j].name;
        report.regions.push_back(all[j]);
        if (all[j].vertices > 0) continue;
        report.notes.push_back("region of joint \"" + all[j].joint + "\" is empty");
        if (j == 0 || joints[j].samples.empty()) continue;
        bare[j] = joints[j].boneLength + bare[static_cast<std::size_t>(joints[j].parent)];
        if (bare[j] > kLimbSize * size) report.bareJoints.push_back(all[j].joint);
    }
    report.rejectedEdges = regions.rejectedEdges;
}

std::vector<std::int32_t> seedsOf(const WeldedMesh& mesh, const Regions& regions) {
    std::vector<std::int32_t> result;
    result.reserve(mesh.weldedOf.size());
    for (const std::uint32_t v : mesh.weldedOf) {
        const std::uint32_t seed = regions.seedOf[v];
        result.push_back(seed == Regions::kNone ? -1 : static_cast<std::int32_t>(seed));
    }
    return result;
}

std::vector<BindReport::Boundaries> boundariesOf(const std::vector<PlannedJoint>& joints,
                                                 const std::vector<double>& radii, bool printed) {
    std::vector<BindReport::Boundaries> result(joints.size());
    for (std::size_t j = 1; j < joints.size(); ++j) {
        if (!joints[j].holdsRegion()) continue;
        result[j].bendUpper = joints[j].options.bendUpper;
        result[j].bendLower = joints[j].options.bendLower;
        if (printed) {
            const BoundarySpan bend = paperBendSpan(joints[j], radii[j]);
            result[j].bendUpper = bend.upper;
            result[j].bendLower = bend.lower;
        }
        const auto twist =
            printed ? paperTwistSpan(joints[j], radii[j]) : twistSpan(joints[j], radii[j]);
        if (!twist) continue;
        result[j].twistUpper = twist->upper;
        result[j].twistLower = twist->lower;
    }
    return result;
}

} // namespace

Binding RegionBinder::bind(const SkinMesh& mesh, const RestSkeleton& skeleton,
                           const BindOptions& asked, BindReport* report) const {
    const auto start = std::chrono::steady_clock::now();
    mesh.validate();
    skeleton.validate();
    checkOptions(skeleton, asked);
    const BindOptions options = decided(asked, true);

    const Progress ratiosProgress = subProgress(options.progress, 0.0, kShapesBegin);
    const auto tell = [&ratiosProgress](const std::string& what, double fraction) {
        if (ratiosProgress) ratiosProgress({what, fraction});
    };
    BindReport found;
    tell("welding", 0.0);
    const WeldedMesh skin(mesh);
    requireSurface(skin);
    std::vector<PlannedJoint> joints = planJoints(skeleton, skin, options, found.notes);
    if (options.method == BindOptions::Method::Smooth) findExtremities(skin, joints);
    for (std::size_t j = 0; j < joints.size(); ++j) {
        found.jointsInside += joints[j].isInside() ? 1 : 0;
        found.jointsOutside += joints[j].isOutside(static_cast<int>(j)) ? 1 : 0;
    }
    Regions regions = findRegions(
        skin, joints, subProgress(ratiosProgress, kRegionsBegin, kBendsBegin)); // section 1

    SkinLayers(skin, joints, regions).follow(regions);
    const SkinLayers layers(skin, joints, regions);
    checkInfluences(joints, regions.jointOf, skin.weldedOf, options.maxInfluences);

    // Section 3: the fraction of each joint's rotation for each vertex.
    const BinaryField binary{skin, joints, regions.jointOf, regions.isWhole};
    const std::vector<double> radii = limbRadii(binary);
    JointFields bend, twist;
    if (options.method == BindOptions::Method::Paper) {
        tell("bend and twist between boundaries", kBendsBegin);
        PaperFields printed(binary, radii);
        bend = std::move(printed.bend);
        twist = std::move(printed.twist);
    } else {
        bend = bendFields(binary, radii, options, skeleton,
                          subProgress(ratiosProgress, kBendsBegin, kTwistsBegin));
        tell("twists", kTwistsBegin);
        twist = twistFields(skin, joints, radii, bend);
        layers.follow(bend, twist);
    }

    tell("ratios", kRatiosBegin);
    Binding binding;
    binding.joints = boundJoints(skeleton, joints);
    addRatios(skin, regions, std::move(bend), std::move(twist), options.maxPartialInfluences,
              binding, found);
    addShapes(skeleton, joints, skin, &layers, options,
              subProgress(options.progress, kShapesBegin, 1.0), binding, found.notes);
    binding.validate();

    found.vertices = mesh.positions.size();
    found.weldedVertices = skin.vertexCount();
    found.shells = skin.shells;
    if (options.method == BindOptions::Method::Smooth) found.layeredVertices = layers.size();
    found.openEdges = skin.openEdges;
    found.seeds = seedsOf(skin, regions);
    found.boundaries = boundariesOf(joints, radii, options.method == BindOptions::Method::Paper);
    reportRegions(skeleton, joints, regions, skin.size, found);
    found.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (report) *report = found;
    if (options.progress) options.progress({"done", 1.0});
    return binding;
}

void RegionBinder::completeWeights(const SkinMesh& mesh, const RestSkeleton& skeleton,
                                   const BindOptions& options, Binding& binding,
                                   std::vector<std::string>& notes) const {
    const WeldedMesh skin(mesh, WeldedMesh::kCopies);
    std::vector<std::string> aboutRegions; // not reported, as weights replace regions
    const std::vector<PlannedJoint> joints = planJoints(skeleton, skin, options, aboutRegions);
    addShapes(skeleton, joints, skin, nullptr, options, options.progress, binding, notes);
}

} // namespace osgSkin
