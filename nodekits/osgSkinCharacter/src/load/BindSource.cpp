// SPDX-License-Identifier: GPL-3.0-or-later
#include "load/BindSource.h"

#include "load/KeepShells.h"
#include "load/TellMisfit.h"
#include "options/LoadReport.h"
#include "source/MeshWeights.h"

#include <osgSkin/Error>
#include <osgSkinBind/Bind>
#include <osgSkinBind/BindWeights>
#include <osgSkinCharacter/ReadWeights>

#include <osg/Notify>

#include <algorithm>
#include <map>

namespace osgSkin {
namespace {

using Painted = CharacterSource::Painted;

VertexWeights paintedWeights(const CharacterSource& source) {
    if (source.weightsFile.empty()) return meshWeights(source.meshFile, source.body, source.rest);
    return readWeights(source.weightsFile, source.rest, source.body.mesh.positions.size(),
                       source.limits);
}

/// Whether the mesh has weights for joints of the skeleton, which may be another file's.
bool carriesWeights(const CharacterSource& source) {
    const std::vector<BoneWeights>& bones = source.body.weights;
    const std::map<std::string, int> jointOf = source.rest.byName();
    return source.weightsFile.empty() && !bones.empty() &&
           std::all_of(bones.begin(), bones.end(),
                       [&](const BoneWeights& bone) { return jointOf.count(bone.bone) != 0; });
}

/// How many vertices nobody painted.
std::size_t gapsOf(const VertexWeights& weights) {
    return static_cast<std::size_t>(
        std::count_if(weights.begin(), weights.end(), [](const auto& entries) {
            return std::none_of(entries.begin(), entries.end(),
                                [](const JointWeight& entry) { return entry.weight > 0.0; });
        }));
}

/// Tells of vertices that nobody painted, where weights were asked for.
void tellGaps(CharacterSource& source, const VertexWeights& weights) {
    const std::size_t gaps = gapsOf(weights);
    const std::string& file = source.weightsFile.empty() ? source.meshFile : source.weightsFile;
    if (gaps > 0)
        takeNote(source.notes, file + ": " + std::to_string(gaps) + " of " +
                                   std::to_string(weights.size()) +
                                   " vertices have no weights, they take those of the nearest "
                                   "that has");
}

/// Tells where a mesh' own weights are not what its body is bound by.
void tellUnused(CharacterSource& source, const VertexWeights& weights) {
    const std::size_t gaps = gapsOf(weights);
    if (gaps == weights.size()) {
        takeNote(source.notes,
                 source.meshFile + ": no weight is above 0, the body is bound by regions");
        return;
    }
    if (gaps == 0 && source.rest.joints.size() == 1) return; // which all follow either way
    const std::string why = gaps == 0
                                ? "all vertices follow one joint"
                                : std::to_string(gaps) + " of " + std::to_string(weights.size()) +
                                      " vertices have no weights";
    takeNote(source.notes, source.meshFile + ": " + why +
                               ", the body is bound by regions (a .skin file's \"bind\": "
                               "\"weights\" keeps to them)");
}

/// Lets joints own nothing that a well-painted file's own weights never use: IK targets, controls,
/// ends of chains. Twins of joints that are used (the "D" bones of MMD) stay: either may own skin.
void skipUnused(const RestSkeleton& rest, const VertexWeights& weights, BindOptions& options) {
    std::vector<bool> isUsed(rest.joints.size(), false);
    for (const std::vector<JointWeight>& entries : weights)
        for (const JointWeight& entry : entries)
            if (entry.weight > 0.0) isUsed[entry.joint] = true;
    for (std::size_t j = 0; j < rest.joints.size(); ++j) {
        const bool hasTwin =
            std::any_of(rest.joints.begin(), rest.joints.end(), [&](const RestJoint& other) {
                return isUsed[static_cast<std::size_t>(&other - rest.joints.data())] &&
                       other.centre == rest.joints[j].centre;
            });
        if (!isUsed[j] && !hasTwin) options.joints[rest.joints[j].name].skip = true;
    }
}

/// Throws osgSkin::Error where binding would take a minute.
void checkSize(const CharacterSource& source) {
    const std::size_t joints = source.rest.joints.size();
    const std::size_t vertices = source.body.mesh.positions.size();
    if (joints * vertices > source.limits.ratios)
        throw Error(source.file + ": " + std::to_string(joints) + " joints and " +
                    std::to_string(vertices) + " vertices, expected at most " +
                    std::to_string(source.limits.ratios) + " if multiplied (option maxRatios)");
}

} // namespace

Binding bindSource(CharacterSource& source, const Progress& progress, BindReport& report) {
    checkSize(source);
    tellRounding(source);
    BindOptions options = source.bind;
    options.progress = progress;
    if (options.maxInfluences == 0)
        options.maxInfluences = source.limits.influencesOf(source.body.mesh.positions.size());
    VertexWeights weights;
    if (source.painted != Painted::No || carriesWeights(source)) weights = paintedWeights(source);
    const bool byWeights = source.painted == Painted::Yes ||
                           (source.painted == Painted::WhereGood && isWellPainted(weights));
    if (!byWeights && isWellPainted(weights)) skipUnused(source.rest, weights, options);
    Binding binding = namingFile(source.file, [&] {
        return byWeights ? bindWeights(source.body.mesh, source.rest, weights, options, &report)
                         : bind(source.body.mesh, source.rest, options, &report);
    });
    for (const std::string& joint : report.bareJoints)
        takeNote(source.notes, source.file + ": no skin belongs to joint \"" + joint +
                                   "\", whose bone is as long as a limb's");
    if (!source.rigidNote.empty()) report.notes.push_back(source.rigidNote);
    if (source.painted == Painted::Yes) {
        tellGaps(source, weights);
        tellMisfit(source, weights);
    }
    if (source.painted == Painted::WhereGood && !byWeights) tellUnused(source, weights);
    if (!byWeights) {
        tellMisfit(source, report);
        if (const std::size_t kept = keepShells(source, weights, binding))
            report.notes.push_back(std::to_string(kept) +
                                   " shells follow one joint: heads, and what hands hold");
    }
    OSG_INFO << source.file << ": bound by " << (byWeights ? "painted weights" : "regions") << "\n"
             << report.text();
    return binding;
}

} // namespace osgSkin
