// SPDX-License-Identifier: MIT
#include "load/LoadSteps.h"
#include "source/CharacterSource.h"
#include "source/LoadReport.h"

#include <osgSkin/Binding>
#include <osgSkin/Error>
#include <osgSkin/ExpectedNames>
#include <osgSkin/GlmOsg>
#include <osgSkin/SkinModel>
#include <osgSkinBind/Bind>
#include <osgSkinBind/BindReport>
#include <osgSkinBind/BindWeights>
#include <osgSkinCharacter/ReadWeights>
#include <osgSkinImport/ImportMesh>
#include <osgSkinRig/JointRoles>
#include <osgSkinRig/RestSkeleton>

#include <osg/BoundingBox>
#include <osg/Notify>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <locale>
#include <map>
#include <numeric>
#include <set>
#include <sstream>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace osgSkin {
namespace {

/// The mesh file's own weights, vertex by vertex.
///
/// \param file the mesh's, for errors
/// \throw Error where the mesh carries none, or names a bone that the skeleton does not have
VertexWeights meshWeights(const std::string& file, const ImportedMesh& body,
                          const RestSkeleton& skeleton) {
    if (body.weights.empty())
        throw Error(file + ": the mesh carries no weights, expected bones with weights in it, or "
                           "a file of weights named by \"weights\"");
    VertexWeights result(body.mesh.positions.size());
    const std::map<std::string, int> jointOf = skeleton.byName();
    for (const BoneWeights& bone : body.weights) {
        const auto joint = jointOf.find(bone.bone);
        if (joint == jointOf.end())
            throw Error(file + ": bone \"" + bone.bone +
                        "\" has weights, but the skeleton has no such joint" +
                        expectedNames(bone.bone, jointOf));
        for (const BoneWeights::Entry& entry : bone.entries)
            result[entry.vertex].push_back(
                {static_cast<std::uint32_t>(joint->second), entry.weight});
    }
    return result;
}

/// Ratio of lengths above which body and skeleton have different units. Common units differ by
/// factors of 10 (centimetres), 39.4 (inches), 100 and 1000.
constexpr double kMaxRatio = 5.0;

/// The same for joints that weights name: a face's joints are close together.
constexpr double kMaxPaintedRatio = 8.0;
constexpr std::size_t kFewJoints = 3; ///< fewer do not tell a body's size

/// Distance of joints from the body, in its lengths, that is tolerated: in an open jacket's sleeve.
constexpr double kRoom = 0.05;

/// Length of a part of a body, in lengths of the skeleton: less may be another unit, as feet are.
constexpr double kMinPart = 0.45, kMaxPart = 0.8;

/// Rounding of vertices, relative to the body's size, that is not visible.
constexpr double kMaxRounding = 1e-4;

double lengthOf(const osg::BoundingBoxd& box) {
    return box.valid() ? 2.0 * box.radius() : 0.0;
}

osg::BoundingBoxd boxOf(const SkinMesh& mesh) {
    osg::BoundingBoxd result;
    for (const glm::dvec3& position : mesh.positions) result.expandBy(toOsg(position));
    return result;
}

/// Whether a body can be a part of the skeleton's figure, as a shirt is: joints lie elsewhere, too.
bool isPart(const osg::BoundingBoxd& body, const osg::BoundingBoxd& skeleton) {
    const double ratio = lengthOf(body) / lengthOf(skeleton);
    const double room = kRoom * lengthOf(skeleton);
    for (int axis = 0; axis < 3; ++axis)
        if (body._min[axis] < skeleton._min[axis] - room ||
            body._max[axis] > skeleton._max[axis] + room)
            return false;
    return ratio > kMinPart && ratio < kMaxPart;
}

/// \param joints number of joints
/// \param maxRatio largest ratio of lengths in the same unit
/// \param outside number of joints outside the skin
void warnUnitMismatch(CharacterSource& source, const osg::BoundingBoxd& body,
                      const osg::BoundingBoxd& skeleton, std::size_t joints, double maxRatio,
                      std::size_t outside) {
    std::ostringstream note;
    note.imbue(std::locale::classic());
    note.precision(3);
    note << source.file << ": ";
    const double ratio = lengthOf(skeleton) > 0.0 ? lengthOf(body) / lengthOf(skeleton) : 1.0;
    if (ratio > maxRatio || ratio < 1.0 / maxRatio)
        note << "the body is " << ratio
             << " times as long as the skeleton, expected both in the same unit";
    else if (outside > joints - outside && !(outside < joints && isPart(body, skeleton)))
        note << outside << " of " << joints
             << " joints lie outside the skin, expected the skeleton in the body's pose, unit "
                "and place";
    else
        return;
    warn(source.notes, note.str());
}

/// Warns about a skeleton that hardly fits the body: in another unit, with another axis up, or
/// elsewhere. Such a body can be bound, but to the wrong joints.
///
/// \param source with body and rest skeleton; gets a note
/// \param report of its binding by regions
void warnUnitMismatch(CharacterSource& source, const BindReport& report) {
    if (source.skeleton && source.rest.joints.size() == 1) return; // a model without bones
    osg::BoundingBoxd skeleton;
    if (source.rest.joints.size() > 1)
        for (const RestJoint& joint : source.rest.joints) {
            skeleton.expandBy(toOsg(joint.centre));
            if (joint.tip) skeleton.expandBy(toOsg(*joint.tip));
        }
    warnUnitMismatch(source, boxOf(source.body.mesh), skeleton,
                     report.jointsOutside + report.jointsInside, kMaxRatio, report.jointsOutside);
}

/// As above, for a body bound by weights from another file: the joints that they name should lie
/// around its skin.
void warnUnitMismatch(CharacterSource& source, const VertexWeights& weights) {
    std::vector<bool> named(source.rest.joints.size());
    for (const auto& entries : weights)
        for (const JointWeight& entry : entries)
            if (entry.weight > 0.0) named[static_cast<std::size_t>(entry.joint)] = true;
    const osg::BoundingBoxd body = boxOf(source.body.mesh);
    const double room = kRoom * lengthOf(body);
    osg::BoundingBoxd skeleton;
    std::size_t joints = 0, outside = 0;
    for (std::size_t j = 0; j < named.size(); ++j) {
        if (!named[j]) continue;
        const osg::Vec3d centre = toOsg(source.rest.joints[j].centre);
        skeleton.expandBy(centre);
        ++joints;
        for (int axis = 0; axis < 3; ++axis)
            if (centre[axis] < body._min[axis] - room || centre[axis] > body._max[axis] + room) {
                ++outside;
                break;
            }
    }
    if (joints < kFewJoints) return; // a face's one joint may be in its neck
    warnUnitMismatch(source, body, skeleton, joints, kMaxPaintedRatio, outside);
}

/// Warns about a body so far from the origin that single precision changes its shape.
///
/// \param source with a body; gets a note
void warnRounding(CharacterSource& source) {
    double farthest = 0.0;
    for (const glm::dvec3& p : source.body.mesh.positions)
        for (int axis = 0; axis < 3; ++axis) farthest = std::max(farthest, std::abs(p[axis]));
    const double rounding = farthest * double(std::numeric_limits<float>::epsilon()) / 2.0;
    const double size = source.body.mesh.size();
    if (!(rounding > kMaxRounding * size)) return;
    std::ostringstream note;
    note.imbue(std::locale::classic());
    note.precision(3);
    note << source.meshFile << ": the body is " << farthest << " from the origin and " << size
         << " long, so that single precision rounds its vertices by " << rounding
         << "; expected it near the origin, moved by a transform above it";
    warn(source.notes, note.str());
}

constexpr double kWhole = 0.99; ///< share of a shell's weight that counts as painted for one joint
constexpr double kMaxOf = 0.5;  ///< share of a shell's vertices that makes it a head

using Shell = std::vector<std::uint32_t>;

/// The connected pieces of a mesh, with vertices at the same position joined.
std::vector<Shell> shellsOf(const SkinMesh& mesh) {
    std::vector<std::uint32_t> up(mesh.positions.size());
    std::iota(up.begin(), up.end(), 0u);
    const auto top = [&up](std::uint32_t v) {
        while (up[v] != v) v = up[v] = up[up[v]];
        return v;
    };
    std::map<std::tuple<double, double, double>, std::uint32_t> first;
    for (std::uint32_t v = 0; v < up.size(); ++v) {
        const glm::dvec3& p = mesh.positions[v];
        up[v] = first.emplace(std::make_tuple(p.x, p.y, p.z), v).first->second;
    }
    const std::uint32_t* corners = mesh.faceVertices.data();
    for (const std::uint32_t size : mesh.faceSizes) {
        for (std::uint32_t k = 1; k < size; ++k) up[top(corners[k])] = top(corners[0]);
        corners += size;
    }
    std::map<std::uint32_t, Shell> shells;
    for (std::uint32_t v = 0; v < up.size(); ++v) shells[top(v)].push_back(v);
    std::vector<Shell> result;
    result.reserve(shells.size());
    for (auto& [root, shell] : shells) result.push_back(std::move(shell));
    return result;
}

/// For each joint, the topmost hand or head among itself and its ancestors; -1 for none.
std::vector<int> extremities(const RestSkeleton& rest, const JointRoles& roles) {
    std::vector<int> result(rest.joints.size(), -1);
    for (std::size_t j = 1; j < result.size(); ++j) {
        result[j] = result[static_cast<std::size_t>(rest.joints[j].parent)];
        if (result[j] < 0 && (roles.is(j, JointPart::Hand) || roles.is(j, JointPart::Head)))
            result[j] = static_cast<int>(j);
    }
    return result;
}

class RigidShells {
public:
    RigidShells(const CharacterSource& source, const VertexWeights& weights, const Binding& binding)
        : _roles(recogniseJoints(source.rest, source.bind.names)),
          _extremities(extremities(source.rest, _roles)), _weights(weights), _binding(binding) {}

    /// The only joint that a shell follows; -1 for none.
    int jointOf(const Shell& shell, bool isLargest) const {
        std::vector<double> shares(_extremities.size(), 0.0);
        double all = 0.0;
        for (const std::uint32_t v : shell) all += addShares(v, shares);
        if (!(all > 0.0) || (_weights.empty() && isLargest)) return -1;
        const auto most = std::max_element(shares.begin(), shares.end());
        const auto joint = static_cast<std::size_t>(most - shares.begin());
        const int extremity = _extremities[joint];
        if (extremity < 0) return -1;
        if (!_weights.empty() && *most >= kWhole * all) return static_cast<int>(joint);
        double under = 0.0, ofChains = 0.0; // such as a tail of hair
        for (std::size_t j = 0; j < shares.size(); ++j) {
            if (_extremities[j] != extremity) continue;
            under += shares[j];
            const auto above = static_cast<std::size_t>(_binding.joints[j].parent);
            if (_roles.roles[j].empty() && _roles.roles[above].empty()) ofChains += shares[j];
        }
        if (_weights.empty() && ofChains > 0.5 * all) return -1;
        const bool isHead = _roles.is(static_cast<std::size_t>(extremity), JointPart::Head);
        return isHead && under > (_weights.empty() ? kMaxOf : kWhole) * all ? extremity : -1;
    }

private:
    /// Adds a vertex's weights; without weights, 1 for its region's joint.
    double addShares(std::uint32_t vertex, std::vector<double>& shares) const {
        double sum = 0.0;
        if (_weights.empty()) {
            shares[_binding.regions[vertex]] += 1.0;
            return 1.0;
        }
        for (const JointWeight& entry : _weights[vertex]) sum += entry.weight;
        if (!(sum > 0.0)) return 0.0;
        for (const JointWeight& entry : _weights[vertex]) shares[entry.joint] += entry.weight / sum;
        return 1.0;
    }

    const JointRoles _roles;
    const std::vector<int> _extremities;
    const VertexWeights& _weights;
    const Binding& _binding;
};

/// Removes correctives from vertices that do not bend.
void dropCorrectives(const std::vector<int>& jointOf, Correctives& correctives) {
    if (correctives.firstEntry.empty()) return;
    std::vector<Correctives::Entry> entries;
    std::vector<std::uint32_t> firsts{0};
    for (std::size_t v = 0; v < jointOf.size(); ++v) {
        if (jointOf[v] < 0)
            entries.insert(entries.end(), correctives.entries.begin() + correctives.firstEntry[v],
                           correctives.entries.begin() + correctives.firstEntry[v + 1]);
        firsts.push_back(static_cast<std::uint32_t>(entries.size()));
    }
    correctives.entries = std::move(entries);
    correctives.firstEntry = std::move(firsts);
}

/// Makes vertices follow one joint and its ancestors fully. [vertex] -1: unchanged.
void follow(const std::vector<int>& jointOf, Binding& binding) {
    std::vector<Influence> influences;
    std::vector<RatioGradient> gradients;
    std::vector<std::uint32_t> firsts{0};
    for (std::size_t v = 0; v < jointOf.size(); ++v) {
        if (jointOf[v] < 0) {
            const std::uint32_t begin = binding.firstInfluence[v];
            const std::uint32_t end = binding.firstInfluence[v + 1];
            influences.insert(influences.end(), binding.influences.begin() + begin,
                              binding.influences.begin() + end);
            if (!binding.gradients.empty())
                gradients.insert(gradients.end(), binding.gradients.begin() + begin,
                                 binding.gradients.begin() + end);
        } else {
            const std::size_t begin = influences.size();
            for (int j = jointOf[v]; j >= 0; j = binding.joints[static_cast<std::size_t>(j)].parent)
                influences.push_back({static_cast<std::uint32_t>(j), 1.0f, 1.0f});
            std::reverse(influences.begin() + static_cast<std::ptrdiff_t>(begin), influences.end());
            binding.regions[v] = static_cast<std::uint32_t>(jointOf[v]);
            if (!binding.gradients.empty()) gradients.resize(influences.size());
        }
        firsts.push_back(static_cast<std::uint32_t>(influences.size()));
    }
    binding.influences = std::move(influences);
    binding.gradients = std::move(gradients);
    binding.firstInfluence = std::move(firsts);
    dropCorrectives(jointOf, binding.correctives);
}

/// Corrects regions of a body of several shells: a held thing belongs to the hand, however near it
/// is to a leg, and a head that is a shell is one rigid piece.
///
/// With painted weights, a shell that is painted wholly for one joint of a hand or a head, at or
/// below it, follows that joint alone; one painted for several joints of a head, the head. Without,
/// a shell most of whose vertices are in a head's region follows the head, but for the largest.
///
/// \param source with its body and its skeleton
/// \param weights of the body's mesh; empty where there are none
/// \param binding of the body, by regions; changed
/// \return the number of shells that were changed
std::size_t bindShellsRigidly(const CharacterSource& source, const VertexWeights& weights,
                              Binding& binding) {
    const std::vector<Shell> shells = shellsOf(source.body.mesh);
    if (shells.size() < 2) return 0;
    std::size_t largest = 0;
    for (const Shell& shell : shells) largest = std::max(largest, shell.size());
    const RigidShells rigid(source, weights, binding);
    std::vector<int> jointOf(binding.vertexCount(), -1);
    std::size_t changed = 0;
    for (const Shell& shell : shells) {
        const int joint = rigid.jointOf(shell, shell.size() == largest);
        if (joint < 0) continue;
        for (const std::uint32_t v : shell) jointOf[v] = joint;
        ++changed;
    }
    if (changed > 0) follow(jointOf, binding);
    return changed;
}

using Painted = CharacterSource::Painted;

VertexWeights paintedWeights(const CharacterSource& source) {
    return withFileContext(source.file, [&] {
        return source.weightsFile.empty()
                   ? meshWeights(source.meshFile, source.body, source.rest)
                   : readWeights(source.weightsFile, source.rest, source.body.mesh.positions.size(),
                                 source.limits);
    });
}

/// Whether the mesh has weights for joints of the skeleton, which may come from another file.
bool carriesWeights(const CharacterSource& source) {
    const std::vector<BoneWeights>& bones = source.body.weights;
    const std::map<std::string, int> jointOf = source.rest.byName();
    return source.weightsFile.empty() && !bones.empty() &&
           std::all_of(bones.begin(), bones.end(),
                       [&](const BoneWeights& bone) { return jointOf.count(bone.bone) != 0; });
}

/// The number of vertices without weights.
std::size_t gapsOf(const VertexWeights& weights) {
    return static_cast<std::size_t>(
        std::count_if(weights.begin(), weights.end(), [](const auto& entries) {
            return std::none_of(entries.begin(), entries.end(),
                                [](const JointWeight& entry) { return entry.weight > 0.0; });
        }));
}

/// The weights without those of shells that have none at all, as a gun beside painted arms.
VertexWeights withoutBareShells(const SkinMesh& mesh, const VertexWeights& weights) {
    if (gapsOf(weights) == 0) return weights;
    VertexWeights result;
    for (const Shell& shell : shellsOf(mesh)) {
        VertexWeights ofShell;
        for (const std::uint32_t v : shell) ofShell.push_back(weights[v]);
        if (gapsOf(ofShell) < ofShell.size())
            result.insert(result.end(), ofShell.begin(), ofShell.end());
    }
    return result;
}

/// Notes vertices without weights, where the method is weights.
void warnUnweighted(CharacterSource& source, const VertexWeights& weights) {
    const std::size_t gaps = gapsOf(weights);
    const std::string& file = source.weightsFile.empty() ? source.meshFile : source.weightsFile;
    if (gaps > 0)
        warn(source.notes, file + ": " + std::to_string(gaps) + " of " +
                               std::to_string(weights.size()) +
                               " vertices have no weights, they take those of the nearest "
                               "that has");
}

/// Notes skin that follows two branches by a quarter or more each, far from where both begin, as
/// the middle of a skirt.
void warnBetweenBranches(CharacterSource& source, const VertexWeights& weights) {
    constexpr double kMuch = 0.25, kFar = 0.35, kOnePlace = 0.01, kMany = 0.01;
    const std::vector<RestJoint>& joints = source.rest.joints;
    const double size = lengthOf(boxOf(source.body.mesh));
    std::map<std::pair<int, int>, std::size_t> vertices; // of pairs of branches' first joints
    std::vector<double> shares(joints.size(), 0.0);      // of subtrees
    std::vector<int> beside(joints.size(), -1);          // by the parent: a child that has much
    for (std::size_t v = 0; v < weights.size(); ++v) {
        double all = 0.0;
        std::vector<int> touched;
        for (const JointWeight& entry : weights[v]) {
            all += entry.weight;
            for (int j = int(entry.joint); j >= 0; j = joints[std::size_t(j)].parent) {
                if (shares[std::size_t(j)] == 0.0) touched.push_back(j);
                shares[std::size_t(j)] += entry.weight;
            }
        }
        for (const int j : touched) {
            const double share = shares[std::size_t(j)];
            const int parent = joints[std::size_t(j)].parent;
            if (parent < 0 || share < kMuch * all || share > (1.0 - kMuch) * all) continue;
            const int other = std::exchange(beside[std::size_t(parent)], j);
            if (other < 0) continue;
            const glm::dvec3 &first = joints[std::size_t(other)].centre,
                             &second = joints[std::size_t(j)].centre;
            const glm::dvec3& place = source.body.mesh.positions[v];
            if (glm::distance(first, second) > kOnePlace * size && // not one bone twice
                glm::distance(place, 0.5 * (first + second)) > kFar * size)
                ++vertices[std::minmax(other, j)];
        }
        for (const int j : touched) {
            shares[std::size_t(j)] = 0.0;
            if (joints[std::size_t(j)].parent >= 0)
                beside[std::size_t(joints[std::size_t(j)].parent)] = -1;
        }
    }
    const auto most =
        std::max_element(vertices.begin(), vertices.end(), [](const auto& one, const auto& other) {
            return one.second < other.second;
        });
    if (most == vertices.end() || double(most->second) < kMany * double(weights.size())) return;
    warn(source.notes,
         source.meshFile + ": " + std::to_string(most->second) + " vertices follow both \"" +
             joints[std::size_t(most->first.first)].name + "\" and \"" +
             joints[std::size_t(most->first.second)].name +
             "\" far below them: where these turn apart, the skin takes the mean of both "
             "rotations and keeps its length, which linear blending shortens");
}

/// Notes skin of which the binding leaves much of the weights out.
void warnLeftOut(CharacterSource& source, const VertexWeights& weights, const Binding& binding) {
    constexpr double kMuch = 0.1, kMany = 0.01;
    std::size_t vertices = 0;
    for (std::size_t v = 0; v < weights.size(); ++v) {
        const auto begin = binding.influences.begin() + binding.firstInfluence[v];
        const auto end = binding.influences.begin() + binding.firstInfluence[v + 1];
        double all = 0.0, out = 0.0;
        for (const JointWeight& entry : weights[v]) {
            all += entry.weight;
            if (std::none_of(begin, end,
                             [&](const Influence& i) { return i.joint == entry.joint; }))
                out += entry.weight;
        }
        if (out > kMuch * all) ++vertices;
    }
    if (double(vertices) > kMany * double(weights.size()))
        warn(source.notes, source.meshFile + ": " + std::to_string(vertices) +
                               " vertices follow more than " +
                               std::to_string(SkinModel::kMaxPartialInfluences) +
                               " joints in part, as between two long chains: the least shares "
                               "are left out, and the skin may tear there");
}

/// Notes that a mesh's own weights are not used.
/// \param weights empty if they are for another skeleton
void warnUnused(CharacterSource& source, const VertexWeights& weights) {
    if (weights.empty()) {
        warn(source.notes, source.meshFile + ": its weights are for bones that the skeleton "
                                             "does not have, the body is bound by regions");
        return;
    }
    const std::size_t gaps = gapsOf(weights);
    if (gaps == weights.size()) {
        warn(source.notes,
             source.meshFile + ": no weight is above 0, the body is bound by regions");
        return;
    }
    if (gaps == 0 && source.rest.joints.size() == 1) return; // all vertices follow it in both cases
    const std::string why = gaps == 0
                                ? "all vertices follow the root joint"
                                : std::to_string(gaps) + " of " + std::to_string(weights.size()) +
                                      " vertices have no weights";
    warn(source.notes, source.meshFile + ": " + why +
                           ", the body is bound by regions (set \"bind\": \"weights\" "
                           "to use them anyway)");
}

/// Skips joints that a well-painted file's own weights never use: IK targets, controls, ends of
/// chains. Joints at the same position as a used one (the "D" bones of MMD) are changed: either may
/// own skin.
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

/// A line with the number of the body's morph targets and the names of the first; empty where there
/// are none.
std::string morphsNote(const ImportedMesh& body) {
    constexpr std::size_t kNamed = 5;
    std::set<std::string> known;
    std::string names;
    for (const MeshPart& part : body.parts)
        for (const MorphTarget& target : part.morphs)
            if (known.insert(target.name).second && known.size() <= kNamed)
                names += (known.size() > 1 ? ", \"" : "\"") + target.name + '"';
    if (known.empty()) return {};
    if (known.size() > kNamed) names += " and " + std::to_string(known.size() - kNamed) + " more";
    return std::to_string(known.size()) +
           (known.size() == 1 ? " morph target: " : " morph targets: ") + names;
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
    warnRounding(source);
    BindOptions options = source.bind;
    options.progress = progress;
    if (options.maxInfluences == 0)
        options.maxInfluences = source.limits.influencesOf(source.body.mesh.positions.size());
    VertexWeights weights;
    if (source.painted == Painted::Yes || carriesWeights(source)) weights = paintedWeights(source);
    const bool isGood = isWellPainted(withoutBareShells(source.body.mesh, weights));
    const bool byWeights =
        source.painted == Painted::Yes || (source.painted == Painted::WhereGood && isGood);
    if (!byWeights && isGood) skipUnused(source.rest, weights, options);
    Binding binding = withFileContext(source.file, [&] {
        return byWeights ? bindWeights(source.body.mesh, source.rest, weights, options, &report)
                         : bind(source.body.mesh, source.rest, options, &report);
    });
    for (const std::string& joint : report.bareJoints)
        warn(source.notes, source.file + ": no skin belongs to joint \"" + joint +
                               "\", whose bone is as long as a limb's");
    if (!source.rigidNote.empty()) report.notes.push_back(source.rigidNote);
    const std::string morphs = morphsNote(source.body);
    if (!morphs.empty()) report.notes.push_back(morphs);
    if (byWeights) {
        warnUnweighted(source, weights);
        warnUnitMismatch(source, weights);
        warnBetweenBranches(source, weights);
        warnLeftOut(source, weights, binding);
    }
    if (source.painted == Painted::WhereGood && !byWeights) warnUnused(source, weights);
    if (!byWeights) {
        warnUnitMismatch(source, report);
        if (const std::size_t changed = bindShellsRigidly(source, weights, binding))
            report.notes.push_back(std::to_string(changed) +
                                   " shells follow one joint: heads, and what hands hold");
    }
    OSG_INFO << source.file << ":\n" << report.text();
    return binding;
}

} // namespace osgSkin
