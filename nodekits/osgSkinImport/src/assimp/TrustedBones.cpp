// SPDX-License-Identifier: MIT
#include "assimp/TrustedBones.h"

#include "assimp/AssimpScene.h"
#include "assimp/SceneBind.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace osgSkin {
namespace {

constexpr double kSize = 0.1;      ///< of the mesh by one bone against that by another
constexpr double kDistance = 0.25; ///< between two bones: poses may move them
constexpr double kTurn = 0.05;     ///< of the axes' length

/// A bone with its node, and what they say of the mesh.
struct Seat {
    const aiBone* bone;
    const aiNode* node;
    glm::dmat4 offset;
    glm::dmat4 toScene; ///< where the mesh stands if the bone stands as its node

    double size() const { return std::cbrt(std::abs(glm::determinant(glm::dmat3(toScene)))); }
};

bool isWeighted(const aiBone& bone) {
    return std::any_of(bone.mWeights, bone.mWeights + bone.mNumWeights,
                       [](const aiVertexWeight& entry) { return entry.mWeight > 0.0f; });
}

std::vector<Seat> seatsOf(const aiMesh& mesh, const SceneBind& bind) {
    std::vector<Seat> result;
    for (unsigned b = 0; b < mesh.mNumBones; ++b) {
        const aiBone& bone = *mesh.mBones[b];
        const aiNode* node = bind.find(nameOf(bone));
        const glm::dmat4 offset = toGlm(bone.mOffsetMatrix);
        const double volume = glm::determinant(glm::dmat3(offset));
        if (node != nullptr && std::isfinite(volume) && volume != 0.0)
            result.push_back({&bone, node, offset, bind.posed(*node) * offset});
    }
    return result;
}

/// The weighted bones, found from any node.
class Neighbours {
public:
    Neighbours(const std::vector<Seat>& weighted, const SceneBind& bind)
        : _weighted(weighted), _bind(bind) {
        for (const Seat& seat : weighted) {
            _at.emplace(seat.node, &seat);
            // Above a node that is reached all are.
            for (const aiNode* node = seat.node;
                 node != nullptr && _firstBelow.emplace(node, &seat).second;)
                node = bind.parent(*node);
        }
    }

    /// Of the weighted bones the next one above, else the first one below, else the first one.
    const Seat& of(const Seat& bone) {
        if (const Seat* above = nextAbove(_bind.parent(*bone.node))) return *above;
        const auto below = _firstBelow.find(bone.node);
        return below != _firstBelow.end() ? *below->second : _weighted.front();
    }

private:
    /// A weighted bone at `node`, or the next one above; what is found is kept for all on the way.
    const Seat* nextAbove(const aiNode* node) {
        std::vector<const aiNode*> way;
        const Seat* result = nullptr;
        for (; node != nullptr; node = _bind.parent(*node)) {
            const auto known = _above.find(node);
            if (known != _above.end()) {
                result = known->second;
                break;
            }
            way.push_back(node);
            const auto here = _at.find(node);
            if (here == _at.end()) continue;
            result = here->second;
            break;
        }
        for (const aiNode* passed : way) _above[passed] = result;
        return result;
    }

    const std::vector<Seat>& _weighted;
    const SceneBind& _bind;
    std::unordered_map<const aiNode*, const Seat*> _at, _firstBelow, _above;
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

} // namespace

std::vector<const aiBone*> reliableInverseBinds(const aiMesh& mesh, const SceneBind& bind) {
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
    std::vector<const aiBone*> result;
    for (const Seat& seat : seats)
        if (weighted.empty() || isWeighted(*seat.bone) ||
            agrees(seat, neighbours.of(seat), size, bind))
            result.push_back(seat.bone);
    return result;
}

} // namespace osgSkin
