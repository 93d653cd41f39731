// SPDX-License-Identifier: MIT
#include "scene/SceneBind.h"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <utility>
#include <vector>

namespace osgSkin {

namespace {

constexpr double kSize = 0.1;      ///< relative difference of the mesh's size by two bones
constexpr double kDistance = 0.25; ///< relative; poses may change the distance of two bones
constexpr double kTurn = 0.05;     ///< relative to the axes' length

/// A bone with its node, and the transform that they give the mesh.
struct Seat {
    const SourceBone* bone;
    const SourceNode* node;
    glm::dmat4 offset;
    glm::dmat4 toScene; ///< the mesh's transform if the bone is bound where its node is

    double size() const { return std::cbrt(std::abs(glm::determinant(glm::dmat3(toScene)))); }
};

bool isWeighted(const SourceBone& bone) {
    return std::any_of(bone.weights.begin(), bone.weights.end(),
                       [](const SourceBone::Weight& entry) { return entry.weight > 0.0f; });
}

std::vector<Seat> seatsOf(const SourceMesh& mesh, const SceneBind& bind) {
    std::vector<Seat> result;
    for (const SourceBone& bone : mesh.bones) {
        const SourceNode* node = bind.find(bone.name);
        const glm::dmat4 offset = bone.offset;
        const double volume = glm::determinant(glm::dmat3(offset));
        if (node != nullptr && std::isfinite(volume) && volume != 0.0)
            result.push_back({&bone, node, offset, bind.posed(*node) * offset});
    }
    return result;
}

/// Finds weighted bones near any node.
class Neighbours {
public:
    Neighbours(const std::vector<Seat>& weighted, const SceneBind& bind)
        : _weighted(weighted), _bind(bind) {
        for (const Seat& seat : weighted) {
            _at.emplace(seat.node, &seat);
            // Ancestors of a visited node have been visited.
            for (const SourceNode* node = seat.node;
                 node != nullptr && _firstBelow.emplace(node, &seat).second;)
                node = bind.parent(*node);
        }
    }

    /// The nearest weighted bone above, or else the first below, or else the first of all.
    const Seat& of(const Seat& bone) {
        if (const Seat* above = nextAbove(_bind.parent(*bone.node))) return *above;
        const auto below = _firstBelow.find(bone.node);
        return below != _firstBelow.end() ? *below->second : _weighted.front();
    }

private:
    /// The weighted bone at `node`, or the nearest above it. Caches the result for all nodes on the
    /// path.
    const Seat* nextAbove(const SourceNode* node) {
        std::vector<const SourceNode*> path;
        const Seat* result = nullptr;
        for (; node != nullptr; node = _bind.parent(*node)) {
            const auto known = _above.find(node);
            if (known != _above.end()) {
                result = known->second;
                break;
            }
            path.push_back(node);
            const auto here = _at.find(node);
            if (here == _at.end()) continue;
            result = here->second;
            break;
        }
        for (const SourceNode* passed : path) _above[passed] = result;
        return result;
    }

    const std::vector<Seat>& _weighted;
    const SceneBind& _bind;
    std::unordered_map<const SourceNode*, const Seat*> _at, _firstBelow, _above;
};

bool agrees(const Seat& bone, const Seat& other, double size, const SceneBind& bind) {
    if (std::abs(bone.size() - size) > kSize * size) return false;
    const glm::dvec3 bound = glm::inverse(bone.offset)[3] - glm::inverse(other.offset)[3];
    const glm::dvec3 posed = bind.posed(*bone.node)[3] - bind.posed(*other.node)[3];
    const double inMesh = size * glm::length(bound), inScene = glm::length(posed);
    if (std::abs(inMesh - inScene) > kDistance * std::max(inMesh, inScene)) return false;
    if (bone.offset != glm::dmat4(1.0)) return true;
    for (int axis = 0; axis < 3; ++axis)
        if (glm::distance(bone.toScene[axis], other.toScene[axis]) > kTurn * size) return false;
    return true;
}

/// The bones of a mesh whose offset matrices are reliable: the weighted bones, and the unweighted
/// bones that agree with them. Exporters list unweighted helper joints with the identity or with
/// arbitrary matrices; such a bone may be the topmost.
///
/// An unweighted bone agrees if it gives the mesh the same size, and if its distance from a nearby
/// weighted bone matches that of their nodes. If its offset is the identity, the mesh's orientation
/// must match as well.
///
/// \param mesh any
/// \param bind whose nodes and their poses are known already
/// \return bones with a node and an invertible offset matrix; all of them if none is weighted
std::vector<const SourceBone*> reliableInverseBinds(const SourceMesh& mesh, const SceneBind& bind) {
    const std::vector<Seat> seats = seatsOf(mesh, bind);
    std::vector<Seat> weighted;
    std::vector<double> sizes;
    for (const Seat& seat : seats)
        if (isWeighted(*seat.bone)) {
            weighted.push_back(seat);
            sizes.push_back(seat.size());
        }
    double size = 0.0;
    if (!weighted.empty()) {
        const auto middle = sizes.begin() + std::ptrdiff_t(sizes.size() / 2);
        std::nth_element(sizes.begin(), middle, sizes.end());
        size = *middle;
    }
    Neighbours neighbours(weighted, bind);
    std::vector<const SourceBone*> result;
    for (const Seat& seat : seats)
        if (weighted.empty() || isWeighted(*seat.bone) ||
            agrees(seat, neighbours.of(seat), size, bind))
            result.push_back(seat.bone);
    return result;
}

constexpr double kSameScale = 0.01;              ///< relative
constexpr double kSamePosition = 0.01;           ///< relative to the bones' extent
constexpr double kMinPosed = glm::radians(1.0);  ///< minimum rotation of a posed bone
constexpr double kMaxPosed = glm::radians(45.0); ///< above this, probably another up axis
constexpr double kStraight = 1e-3;
constexpr double kFarthestPosed = 0.5; ///< maximum displacement of a posed bone, in extents
constexpr std::size_t kPosesOfClip = 64;

double scaleOf(const glm::dmat4& m) {
    return std::cbrt(std::abs(glm::determinant(glm::dmat3(m))));
}

double angleOf(const glm::dmat3& turn) {
    return std::acos(std::clamp((turn[0][0] + turn[1][1] + turn[2][2] - 1.0) / 2.0, -1.0, 1.0));
}

/// Whether a space's axes are the scene's, possibly swapped: a deliberate choice.
bool isAlongAxes(const glm::dmat4& m) {
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row) {
            const double part = std::abs(m[column][row]) / scaleOf(m);
            if (!(part < kStraight || std::abs(part - 1.0) < kStraight)) return false;
        }
    return true;
}

/// The topmost bone of a skin, beside its bind pose.
struct Topmost {
    const SourceBone& bone;
    const glm::dmat4& byMesh; ///< from the mesh to the scene, if the mesh is bound at its node
    double extent;            ///< of the bones in their bind pose

    double scale() const { return scaleOf(byMesh); }
    glm::dvec3 boundAt() const { return glm::dvec3(byMesh * glm::inverse(bone.offset)[3]); }

    /// The rotation from the bind pose to another one.
    /// \param byBone from the mesh to the scene, if the bone is bound in that pose
    glm::dmat3 turn(const glm::dmat4& byBone) const {
        return glm::dmat3(byBone) / scaleOf(byBone) * glm::inverse(glm::dmat3(byMesh) / scale());
    }
    double distance(const glm::dmat4& byBone) const {
        return glm::distance(boundAt(), glm::dvec3(byBone * glm::inverse(bone.offset)[3]));
    }
    bool isNear(const glm::dmat4& byBone) const {
        return angleOf(turn(byBone)) < kMaxPosed && distance(byBone) < kFarthestPosed * extent;
    }
};

double extentOf(const std::vector<const SourceBone*>& bones, const Topmost& topmost) {
    double result = 0.0;
    for (const SourceBone* bone : bones)
        result = std::max(
            result, glm::distance(topmost.boundAt(),
                                  glm::dvec3(topmost.byMesh * glm::inverse(bone->offset)[3])));
    return result;
}

/// Whether a clip brings the topmost bone near its bind pose: then another pose of its node is one
/// of a clip, and not another up axis or place of the figure.
/// \param above from the space of the bone's node to the scene
bool isNearInAClip(const SourceScene& scene, const Topmost& topmost, const SourceNode& node,
                   const glm::dmat4& above) {
    const NodeTransform still = decompose(node.matrix);
    for (const auto& clip : scene.animations)
        for (const SourceTrack& track : clip->tracks) {
            if (track.node != node.name) continue;
            const std::size_t keys = std::max(track.rotations.size(), track.positions.size());
            const auto at = [keys](const auto& values, std::size_t k) {
                return values[k * (values.size() - 1) / std::max<std::size_t>(1, keys - 1)].value;
            };
            const std::size_t step = 1 + keys / kPosesOfClip;
            for (std::size_t k = 0; k < keys; k += step) {
                const glm::dquat rotation =
                    track.rotations.empty() ? still.rotation : glm::dquat(at(track.rotations, k));
                const glm::dvec3 place = track.positions.empty()
                                             ? still.translation
                                             : glm::dvec3(at(track.positions, k));
                glm::dmat4 local = glm::mat4_cast(rotation);
                for (int axis = 0; axis < 3; ++axis) local[axis] *= still.scale[axis];
                local[3] = glm::dvec4(place, 1.0);
                if (topmost.isNear(above * local * topmost.bone.offset)) return true;
            }
        }
    return false;
}

/// Whether the topmost node is posed, and the bones are bound where the mesh's node is, which
/// happens if an exporter stores a frame of a clip. Other differences between the spaces are not
/// poses: another unit or up axis, a rotated figure, a meaningless mesh node.
///
/// \param scene with its clips
/// \param bones with reliable offsets
/// \param topmost of them
/// \param node of the topmost bone
/// \param above from the space of that node to the scene
/// \param byBone from the mesh to the scene, if the topmost bone's node is not posed
/// \param byMesh the same, if the mesh is bound at its node
bool isPosed(const SourceScene& scene, const std::vector<const SourceBone*>& bones,
             const SourceBone& topmost, const SourceNode& node, const glm::dmat4& above,
             const glm::dmat4& byBone, const glm::dmat4& byMesh) {
    if (!isAlongAxes(above) || !isAlongAxes(byMesh)) return false;
    Topmost bone{topmost, byMesh, 0.0};
    if (!(bone.scale() > 0.0) || !(std::abs(scaleOf(byBone) / bone.scale() - 1.0) < kSameScale))
        return false;
    bone.extent = extentOf(bones, bone);
    const double moved = bone.distance(byBone);
    const glm::dmat3 turn = bone.turn(byBone);
    const double turned = angleOf(turn);
    if (!std::isfinite(turned) || !std::isfinite(moved)) return false;
    if (bone.isNear(byBone)) return turned > kMinPosed;
    // A rotation of the whole figure about the mesh's origin would move the bone.
    const glm::dvec3 arm = bone.boundAt() - glm::dvec3(byMesh[3]);
    if (turned >= kMaxPosed && moved < kSamePosition * bone.extent &&
        glm::distance(turn * arm, arm) > 10.0 * kSamePosition * bone.extent)
        return true;
    return isNearInAClip(scene, bone, node, above);
}

} // namespace

SceneBind::SceneBind(const SourceScene& scene) : _scene(scene) {
    std::vector<const SourceNode*> open{&scene.nodes.front()};
    while (!open.empty()) {
        const SourceNode* node = open.back();
        open.pop_back();
        const SourceNode* above = parent(*node);
        _nodes.push_back(node);
        _byName.emplace(node->name, node);
        _depth[node] = above != nullptr ? _depth.at(above) + 1 : 0;
        _isBone[node] = false;
        const glm::dmat4 local = node->matrix;
        _posed[node] = above != nullptr ? _posed.at(above) * local : local;
        for (auto c = node->children.rbegin(); c != node->children.rend(); ++c)
            open.push_back(&child(*c));
    }

    // Skins with higher topmost bones come first: the others follow the bones that they share.
    std::vector<std::vector<const SourceBone*>> bones;
    std::vector<std::pair<int, std::size_t>> skins;
    for (std::size_t m = 0; m < scene.meshes.size(); ++m) {
        const SourceMesh& mesh = *scene.meshes[m];
        for (const SourceBone& bone : mesh.bones)
            if (const SourceNode* node = find(bone.name)) _isBone[node] = true;
        bones.push_back(reliableInverseBinds(mesh, *this));
        if (const SourceBone* top = topmost(bones.back()))
            skins.emplace_back(_depth.at(find(top->name)), m);
    }
    std::sort(skins.begin(), skins.end());
    std::vector<glm::dmat4> shown(scene.meshes.size(), glm::dmat4(0.0)); // at its first node
    for (auto node = _nodes.rbegin(); node != _nodes.rend(); ++node)
        for (const std::size_t mesh : (*node)->meshes) shown[mesh] = _posed.at(*node);
    for (const auto& [depth, m] : skins) bindSkin(bones[m], shown[m], _skins[m]);

    for (const SourceNode* node : _nodes)
        if (_bind.count(node) == 0) _bind[node] = bindFromAbove(*node);
}

const SourceNode* SceneBind::find(const std::string& name) const {
    const auto found = _byName.find(name);
    return found == _byName.end() ? nullptr : found->second;
}

glm::dmat4 SceneBind::mesh(const SourceNode& node, std::size_t meshIndex) const {
    const auto skin = _skins.find(meshIndex);
    return skin == _skins.end() ? _bind.at(&node) : skin->second;
}

const SourceBone* SceneBind::topmost(const std::vector<const SourceBone*>& bones) const {
    const SourceBone* result = nullptr;
    int least = 0;
    for (const SourceBone* bone : bones) {
        const int depth = _depth.at(find(bone->name));
        if (result != nullptr && depth >= least) continue;
        result = bone;
        least = depth;
    }
    return result;
}

glm::dmat4 SceneBind::bindFromAbove(const SourceNode& node) const {
    glm::dmat4 result(1.0);
    const SourceNode* above = &node;
    while (above != nullptr && _bind.count(above) == 0) {
        result = above->matrix * result;
        above = parent(*above);
    }
    return above == nullptr ? result : _bind.at(above) * result;
}

void SceneBind::bindSkin(const std::vector<const SourceBone*>& bones, const glm::dmat4& meshToScene,
                         glm::dmat4& toScene) {
    const SourceBone* reference = topmost(bones);
    for (const SourceBone* bone : bones)
        if (_bind.count(find(bone->name)) != 0) {
            reference = bone;
            break;
        }
    const SourceNode* standing = find(reference->name);
    toScene = bindFromAbove(*standing) * reference->offset;
    const SourceNode* above = parent(*standing);
    if (_bind.count(standing) == 0 &&
        isPosed(_scene, bones, *reference, *standing,
                above != nullptr ? posed(*above) : glm::dmat4(1.0), toScene, meshToScene))
        toScene = meshToScene;
    for (const SourceBone* bone : bones)
        _bind.emplace(find(bone->name), toScene * glm::inverse(bone->offset));
}

} // namespace osgSkin
